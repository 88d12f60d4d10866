# SPDX-License-Identifier: MIT
"""Adversarial paths as short recipes, which a search can draw and shrink, and a file can keep.

A path is made of pieces by a pen that moves and turns: each line of a piece takes the next of its sizes,
bends and feeds, in turn. Arcs of all radii, fans of nearly collinear lines, zigzags, feeds that
alternate, and chords of a micrometer beside lines of a meter are a few numbers each.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from passo.output import write_text
from passo.path import Motors, PathAxis, PathSettings
from passo.path_rounding import Line

LINES_MAX = 1500
RAPID = 0.0  # a feed that is none


@dataclass(frozen=True)
class Piece:
    """`lines` lines; angles in degrees, feeds in mm/min as in G-code."""

    count: int
    sizes: tuple[float, ...]  # mm
    bends: tuple[float, ...] = (0.0,)  # before each line
    feeds: tuple[float, ...] = (RAPID,)
    slopes: tuple[float, ...] = (0.0,)  # of the third axis, per mm of the others


MACHINES: dict[str, PathSettings] = {
    "router": PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)), acceleration=0),
    "soft": PathSettings(
        (PathAxis(1600, jerk=50_000), PathAxis(1600, jerk=50_000), PathAxis(1600, 12, 100, jerk=5000))
    ),
    "laser": PathSettings((PathAxis(160, 500, 8000), PathAxis(160, 500, 4000), PathAxis(400, 10, 50))),
    "fine": PathSettings((PathAxis(1600), PathAxis(1600), PathAxis(1600, 12, 100))),
    "fast": PathSettings((PathAxis(400, 1000, 20_000, jerk=2_000_000),) * 3),
}
# Machines whose motors are not their axes; those of corexy_weak and corexy_fast are the weaker ones.
XY, XZ = ((1, 1, 0), (1, -1, 0), (0, 0, 1)), ((1, 0, 1), (0, 1, 0), (1, 0, -1))
MOTORS: dict[str, PathSettings] = {
    "ganged": PathSettings(
        (PathAxis(), PathAxis(), PathAxis(400, 12, 100)),
        motors=Motors(((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 0))),
    ),
    "corexy": PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)), motors=Motors(XY)),
    "corexz": PathSettings((PathAxis(160), PathAxis(), PathAxis(160, 20, 400)), motors=Motors(XZ)),
    "corexy_laser": PathSettings(
        (PathAxis(160, 500, 8000), PathAxis(160, 500, 4000), PathAxis(400, 10, 50)), motors=Motors(XY)
    ),
    "corexy_weak": PathSettings(
        (PathAxis(160, 300, 5000), PathAxis(160, 300, 5000), PathAxis(400, 10, 50)),
        motors=Motors(XY, PathAxis(0, 250, 3000)),
    ),
    "corexy_soft": replace(MACHINES["soft"], motors=Motors(XY)),
    "corexy_fast": replace(MACHINES["fast"], motors=Motors(XY, PathAxis(0, 800, 15_000, jerk=1_500_000))),
}
JERKS = ("soft", "fast")  # machines that are drawn with profile jerk
JERKS_OF_MOTORS = ("corexy_soft", "corexy_fast")


@dataclass(frozen=True)
class Case:
    """A path on a machine, and how the host feeds it."""

    machine: str
    pieces: tuple[Piece, ...]
    profile: str = "linear"
    look_ahead: int = 48
    polls: int = 1000  # per second
    heading: float = 0.0  # degrees

    @property
    def settings(self) -> PathSettings:
        """Of the planner."""
        return replace({**MACHINES, **MOTORS}[self.machine], profile=self.profile, polls=self.polls)

    @property
    def lines(self) -> list[Line]:
        """All lines, from the origin."""
        lines: list[Line] = []
        x = y = z = 0.0
        heading = self.heading
        for piece in self.pieces:
            for k in range(piece.count):
                size, bend, feed, slope = (
                    values[k % len(values)]
                    for values in (piece.sizes, piece.bends, piece.feeds, piece.slopes)
                )
                heading += bend
                x += size * math.cos(math.radians(heading))
                y += size * math.sin(math.radians(heading))
                z += size * slope
                lines.append(((x, y, z), feed / 60 if feed else None))
        return lines[:LINES_MAX]

    def to_json(self) -> dict[str, Any]:
        """For a file of cases."""
        return asdict(self)


def case_of(data: dict[str, Any]) -> Case:
    """A case from a file."""
    pieces = tuple(
        Piece(**{k: tuple(v) if isinstance(v, list) else v for k, v in piece.items()})
        for piece in data["pieces"]
    )
    return Case(**{**data, "pieces": pieces})


def read_cases(path: Path) -> dict[str, Case]:
    """The kept cases by name."""
    return {name: case_of(data) for name, data in json.loads(path.read_text(encoding="utf-8")).items()}


def write_cases(path: Path, cases: dict[str, Case]) -> None:
    """A case in a line."""
    rows = ",\n".join(f"  {json.dumps(name)}: {json.dumps(case.to_json())}" for name, case in cases.items())
    write_text(path, "{\n" + rows + "\n}\n")


def lengths_of(lines: Sequence[Line]) -> list[float]:
    """Of the lines of a path from the origin, mm."""
    begin = [(0.0,) * len(lines[0][0]), *(target for target, _ in lines[:-1])]
    return [math.dist(before, target) for before, (target, _) in zip(begin, lines, strict=True)]


def seconds_at_feed(lines: Sequence[Line], settings: PathSettings) -> float:
    """How long the path takes at its feeds, without acceleration."""
    top = min(float(axis.speed) for axis in settings.axes[:2])
    feeds = (min(feed or top, top) for _, feed in lines)
    return sum(length / feed for length, feed in zip(lengths_of(lines), feeds, strict=True))
