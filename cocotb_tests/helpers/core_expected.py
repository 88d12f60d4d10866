# SPDX-License-Identifier: MIT
"""When the steps of a motion are due."""

from collections.abc import Sequence

from cocotb_tests.helpers.core_bench import Line, Ramp
from tests.helpers.closed_form import step_clocks, substep_clocks


def distance(ramps: Sequence[Ramp], tick: int) -> int:
    """Substeps of a profile; `tick` in clocks."""
    return len(substep_clocks(ramps, tick.bit_length() - 1))


def due(lines: Sequence[Line], ramps: Sequence[Ramp], tick: int) -> list[list[int]]:
    """For each axis the enabled clocks of its steps; the first clock of a motion is 1."""
    axes, tick_log2 = len(lines[0].steps), tick.bit_length() - 1
    return [[clock for clock, _ in step_clocks(lines, ramps, tick_log2, axis)] for axis in range(axes)]


def totals(lines: Sequence[Line]) -> list[int]:
    """For each axis the change of its position."""
    return [sum(steps) for steps in zip(*(line.steps for line in lines), strict=True)]
