# SPDX-License-Identifier: MIT
"""Plays a case with the sources on PYTHONPATH, and prints hashes of all edges and steps; see play.py.

python benchmarks/play_case.py CASE LINES MACHINE.toml FOLDER

A case imports what it needs: the rest takes longer to load than some of them to play.
"""

import hashlib
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from passo.ending import ended

RADIUS, WAVES = 30, ((12, 5.03), (4, 17.0))  # mm, of the rosette, and waves per turn
SLOW = 1500  # mm/min


def rosette(lines: int) -> str:
    """Lines of half a millimeter at a feed of 25 mm/s, in all axes."""
    rows = ["G21 G90 G94", f"G1 F{SLOW}"]
    for k in range(1, lines + 1):
        turn = 0.012 * k
        r = RADIUS + sum(size * math.sin(waves * turn) for size, waves in WAVES)
        x, y, z = r * math.cos(turn), r * math.sin(turn), 0.5 * math.sin(3 * turn)
        rows.append(f"G1 X{x:.3f} Y{y:.3f} Z{z:.3f}")
    return "\n".join([*rows, "M2", ""])


def zigzag(lines: int) -> str:
    """Lines of 50 mm as fast as the axes can."""
    rows = [f"G0 X{50 * (k % 2)} Y{k % 40}" for k in range(1, lines + 1)]
    return "\n".join(["G21 G90", *rows, "M2", ""])


def circles(lines: int) -> str:
    """Full circles at a feed of 50 mm/s."""
    rows = [f"G2 X0 Y0 I{5 + k % 10} J0" for k in range(lines)]
    return "\n".join(["G21 G90 G94", "G1 F3000", *rows, "M2", ""])


@dataclass(frozen=True)
class Made:
    """What left the pins: of each motor; `edges` is whatever tells them apart."""

    edges: Sequence[Any]
    steps: Sequence[Any]


def run(text: str, machine: Path, folder: Path, engine: str = "model") -> Made:
    """`passo run`."""
    from passo import cli
    from passo import part_command as command

    part_command: Any = command  # of which a function is replaced
    played: list[Any] = []
    plays = part_command.play_part

    def kept(*arguments: Any) -> Any:
        played.append(plays(*arguments))
        return played[0]

    part_command.play_part = kept
    program = folder / "program.nc"
    program.write_text(text)
    words = ["run", program, "--machine", machine, "--engine", engine, "--out", folder / "results"]
    assert cli.main([str(word) for word in words]) == 0  # as of any commit
    own = played[0]
    return Made([*own.clocks, *own.positions, own.motions], own.positions)


def paths(lines: int, _machine: Path, _folder: Path) -> Made:
    """Paths of the tests: polls at 1800 Hz, and corners of all kinds."""
    from passo.driver import DriverError
    from passo.path import PathAxis, PathSettings

    from tests.helpers.path_player import play

    settings = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)), polls=1800)
    made: list[Any] = []
    steps: list[np.ndarray] = []
    for bend in range(2, lines + 2):
        course = [
            ((20 * math.sin(k / bend), 20 * math.cos(k / bend), k / 400), 20.0 + k % 50) for k in range(200)
        ]
        try:
            played = play(course, settings, loop=settings.clock_hz // settings.polls)
        except DriverError as error:
            made.append(str(error))
        else:
            made += [*played.clocks, *played.steps, played.motions]
            steps += played.steps
    return Made(made, [np.sum(own) for own in steps])


def campaign(lines: int, _machine: Path, _folder: Path) -> Made:
    """Cases of a campaign: refusals, faults and counts of each."""
    from passo import campaign_play
    from passo.campaign_moves import draw

    outcomes = (campaign_play.play(draw(1, number), "model") for number in range(lines))
    made = [(own.refused.partition(":")[0], own.fault, sorted(own.counts.items())) for own in outcomes]
    return Made(made, [(bool(refused), counts) for refused, _, counts in made])


def program(text: Callable[[int], str]) -> Callable[[int, Path, Path], Made]:
    """The case of a program of G-code."""
    return lambda lines, machine, folder: run(text(lines), machine, folder)


CASES = {
    "rosette": program(rosette),
    "zigzag": program(zigzag),
    "circles": program(circles),
    "paths": paths,
    "rtl": lambda lines, machine, folder: run(zigzag(lines), machine, folder, "rtl"),
    "campaign": campaign,
}


def main() -> None:
    """Of the command."""
    case, lines, machine, folder = sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]), Path(sys.argv[4])
    made = CASES[case](lines, machine, folder)
    print(hash_of(made.edges), hash_of(made.steps))


def hash_of(values: Sequence[Any]) -> str:
    """Of arrays and of what has a text."""
    seen = hashlib.sha256()
    for one in values:
        seen.update(one.tobytes() if isinstance(one, np.ndarray) else repr(one).encode())
    return seen.hexdigest()


if __name__ == "__main__":
    sys.exit(ended(main))
