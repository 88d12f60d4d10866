# SPDX-License-Identifier: MIT
"""`passo heightmap` on plates with a closed form: `python -m benchmarks.height_map`.

A program of lines and arcs in all modes follows a map of 100 by 80 mm that is probed every 10 mm. At 20
points of each motion the depth of cut is compared with that of the program. The exit status is 1 if it
differs by more than the bound of a plate.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from passo.console import cancelable, each
from passo.ending import ended
from passo.expand.expander import Options, expand_file
from passo.expand.follow import follow
from passo.expand.height_map import ERROR, HeightMap
from passo.gcode import NANOMETERS, Gcode, GcodeSettings
from passo.native import planner

RAPID = (1 << 64) - 1
DEPTH = 0.2  # mm
FINE = Options(GcodeSettings(axes=3, arc_tolerance=0.0001))
# By name: height at x and y, and the bound, in mm.
PLATES: dict[str, tuple[Callable[[float, float], float], float]] = {
    "bowed by 0.5 mm": (lambda x, y: 0.5 * (1 - ((x / 50 - 1) ** 2 + (y / 40 - 1) ** 2) / 2), 0.01),
    "twisted": (lambda x, y: (x - 30) * (y - 50) / 5000, ERROR + 0.0002),
    "tilted": (lambda x, y: x / 100 - y / 50, ERROR + 0.0002),
}
PROGRAM = """G21 G90
G0 Z5
G0 X5 Y5
G1 Z-.2 F300 (down)
X95 Y75
X20
G3 X20 Y75 I12 J-15
G3 X80 Y60 R42
G91 G1 X-50 Y-40
G3 X10 Y10 R8
G90 G20 G1 X1 Y2
G93 X3 F2
G94 G21 F100 M3 S100 X90 (on)
G17 G0 Z5
X0 Y0
M2
"""


class Cut(NamedTuple):
    """A plate that was cut."""

    worst: float  # mm that the depth is off
    points: int
    lines: int


def plate(surface: Callable[[float, float], float], step: float = 10) -> HeightMap:
    """100 by 80 mm, probed exactly."""
    x, y = (tuple(k * step for k in range(round(size / step) + 1)) for size in (100, 80))
    return HeightMap(x, y, tuple(tuple(surface(a, b) for a in x) for b in y))


def followed(folder: Path, text: str, height_map: HeightMap, options: Options = FINE) -> list[str]:
    """The lines of a text that follow a map."""
    path = folder / "part.ngc"
    path.write_text(text)
    return [line.text for line in follow(expand_file(path, options), height_map, options)]


def places(lines: list[str]) -> Iterator[tuple[bool, float, float, float]]:
    """Points along all motions, on the way at the feed or at rapid, in mm."""
    gcode, at = Gcode(FINE.gcode), (0.0, 0.0, 0.0)
    for line in lines:
        gcode.execute(line)
        for action in gcode.actions():
            if action.kind == planner().PASSO_GCODE_LINE:
                end = tuple(n / NANOMETERS for n in action.target[0:3])
                for k in range(1, 21):
                    yield action.feed != RAPID, *(a + (b - a) * k / 20 for a, b in zip(at, end, strict=True))
                at = end


def cut(folder: Path, name: str, step: float = 10) -> Cut:
    """The program on a plate, probed every `step` mm, from where it is deep enough on."""
    surface, bound = PLATES[name]
    lines = followed(folder, PROGRAM, plate(surface, step))
    found = [(x, y, z) for at_feed, x, y, z in places(lines) if at_feed]
    down = next(index for index, (_, _, z) in enumerate(found) if z < surface(5, 5) - DEPTH + bound)
    return Cut(max(abs(z - surface(x, y) + DEPTH) for x, y, z in found[down:]), len(found), len(lines))


def main() -> int:
    """Cut all plates and print."""
    good = True
    with tempfile.TemporaryDirectory() as folder, cancelable() as work:
        for name, (_, bound) in each("plates", PLATES.items()):
            made = cut(Path(folder), name)
            good = good and made.worst < bound
            of = f"{made.points:,} points, {made.lines} lines of {len(PROGRAM.splitlines())}"
            print(f"{name}: depth of cut within {made.worst:.4f} mm (bound {bound:g}), {of}")
    return work.canceled or not good


if __name__ == "__main__":
    sys.exit(ended(main))
