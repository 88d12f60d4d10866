# SPDX-License-Identifier: MIT
"""The motions of a G-code program, in mm and machine coordinates, from any interpreter."""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

PLANES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}
NOWHERE = 0.01  # mm; random lines are longer
AXES = 6  # of an end


@dataclass(frozen=True)
class Outputs:
    """Of spindle, coolant, and M62 to M68."""

    turns: int = 0  # 1 clockwise, -1 the other way
    rpm: float = 0
    flood: bool = False
    mist: bool = False
    digital: int = 0  # a bit for each P
    analog: float = 0  # Q of E0

    def differs(self, other: "Outputs") -> bool:
        """Speeds are those of a spindle that turns; E0 is seen while it does not."""
        apart = abs(self.rpm - other.rpm) > 0.02 if self.turns else abs(self.analog - other.analog) > 0.002
        return apart or replace(self, rpm=0, analog=0) != replace(other, rpm=0, analog=0)


@dataclass(frozen=True)
class Motion:
    """A line, an arc, a probe, or a dwell, in mm and machine coordinates."""

    label: int  # of its line, from 1 on
    end: tuple[float, ...] = ()
    feed: float = 0  # mm/min; 0: rapid
    center: tuple[float, float] | None = None  # of an arc, in its plane
    plane: tuple[int, int, int] = PLANES["XY"]
    clockwise: bool = False
    dwell: float | None = None  # s
    probes: bool = False
    outputs: Outputs = field(default_factory=Outputs)
    tolerance: float = 0  # mm, of G64
    unit: float = 1  # mm: the coarsest one that a figure before was printed in


@dataclass(frozen=True)
class Played:
    """What a program does, up to a line that is refused."""

    motions: list[Motion]
    refused: int = 0  # label; 0: none
    why: str = ""


def labelled(program: Sequence[str]) -> list[str]:
    """With a number before each line, by which rs274 names what it does."""
    return [line if line.startswith("N") else f"N{label} {line}" for label, line in enumerate(program, 1)]


def moving(motions: Sequence[Motion]) -> Iterator[Motion]:
    """Without lines that go nowhere: rs274 calls one for a G1 without axis words."""
    at = (0.0,) * AXES
    for motion in motions:
        if motion.dwell is not None or motion.center is not None or math.dist(motion.end, at) > NOWHERE:
            yield motion
        at = motion.end or at


def difference(a: Motion, b: Motion) -> str:
    """What two motions do not share; empty: nothing."""
    near = 4e-4 * max(a.unit, b.unit)
    if (
        a.label != b.label
        or (a.dwell is None) != (b.dwell is None)
        or (a.center is None) != (b.center is None)
        or a.probes != b.probes
    ):
        return "kind"
    if a.outputs.differs(b.outputs):
        return "outputs"
    if abs(a.tolerance - b.tolerance) > near:
        return "tolerance"
    if a.dwell is not None and b.dwell is not None:
        return "dwell" if abs(a.dwell - b.dwell) > 1e-4 else ""
    if math.dist(a.end, b.end) > near:
        return "target"
    if (a.feed == 0) != (b.feed == 0) or abs(a.feed - b.feed) > near + 1e-4 * a.feed:
        return "feed"
    if a.center is not None and b.center is not None:
        if (a.plane, a.clockwise) != (b.plane, b.clockwise):
            return "way round"
        if math.dist(a.center, b.center) > near:
            return "center"
    return ""


def verdict(ours: Played, theirs: Played) -> str:
    """The first difference, with the number of its line; empty: there is none."""
    first = min((played.refused for played in (ours, theirs) if played.refused), default=sys.maxsize)
    mine, other = (
        [motion for motion in moving(played.motions) if motion.label < first] for played in (ours, theirs)
    )
    for a, b in zip(mine, other, strict=False):
        if found := difference(a, b):
            return f"line {min(a.label, b.label)}: {found}: {a} {b}"
    if len(mine) != len(other):
        return f"{len(mine)} motions are {len(other)}"
    if ours.refused != theirs.refused:
        return f"line {first}: refused by one: {ours.why}{theirs.why}"
    return ""
