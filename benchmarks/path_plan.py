# SPDX-License-Identifier: MIT
"""Plans a path without a core: all lines at hand, and a host that takes all that the planner gives."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from passo.build import Parameters
from passo.native import planner
from passo.path import Path, PathSettings
from passo.path_rounding import Line


@dataclass(frozen=True)
class Planned:
    """The lines and ramps of a path, in one motion."""

    path: Path
    lines: list[Any]
    ramps: list[Any]
    words: list[int]  # of all of them, in the order in which they were handed out

    @property
    def clocks(self) -> int:
        """Duration of all ramps."""
        return sum(ramp.ticks for ramp in self.ramps) << self.path.parameters.tick_log2

    @property
    def seconds(self) -> float:
        """The same."""
        return self.clocks / self.path.settings.clock_hz


def plan(
    lines: Sequence[Line],
    settings: PathSettings,
    look_ahead: int,
    parameters: Parameters | None = None,
    pace: tuple[int, int, int] | None = None,
) -> Planned:
    """Plan a path as one motion; `pace` are the arguments of passo_path_pace()."""
    path = Path(settings, parameters or Parameters(), look_ahead)
    if pace:
        planner().passo_path_pace(path.c, *pace)
    made = Planned(path, [], [], [])

    def take() -> None:
        while (line := path.next_line()) is not None:
            made.lines.append(line)
            made.words.extend((line.substeps, line.directions, *line.steps[0 : len(settings.scales)]))
        while (ramp := path.next_ramp()) is not None:
            made.ramps.append(ramp)
            made.words.extend((ramp.ticks, ramp.velocity_end & 0xFFFFFFFF, ramp.velocity_end >> 32))

    for target, feed in lines:
        if path.room == 0:
            take()
        path.add(target, feed)
    path.end()
    take()
    assert made.lines[-1].last and made.ramps[-1].last
    return made
