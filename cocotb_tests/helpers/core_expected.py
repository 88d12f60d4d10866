# SPDX-License-Identifier: MIT
"""When the steps of a motion are due, from the recurrences of docs/architecture.md, clock by clock."""

from collections.abc import Iterable, Iterator, Sequence

from cocotb_tests.helpers.core_bench import ONE, Line, Ramp
from cocotb_tests.helpers.ramps import velocities


def substeps(ramps: Iterable[Ramp], tick: int) -> Iterator[int]:
    """The enabled clock of each substep; the first clock of a motion is 1."""
    phase, clock = ONE // 4, 0
    for velocity in velocities(ramps):
        for _ in range(tick):
            clock += 1
            phase += velocity
            if phase >= ONE:
                phase -= ONE
                yield clock


def distance(ramps: Iterable[Ramp], tick: int) -> int:
    """Substeps of a profile."""
    return sum(1 for _ in substeps(ramps, tick))


def due(lines: Sequence[Line], ramps: Iterable[Ramp], tick: int) -> list[list[int]]:
    """For each axis the enabled clocks of its steps."""
    clocks = substeps(ramps, tick)
    steps: list[list[int]] = [[] for _ in lines[0].steps]
    for line in lines:
        m = line.substeps
        e = [m // 2] * len(steps)
        for _, clock in zip(range(m), clocks, strict=False):
            for axis, n in enumerate(line.steps):
                e[axis] += abs(n)
                if e[axis] >= m:
                    e[axis] -= m
                    steps[axis].append(clock)
    return steps


def totals(lines: Sequence[Line]) -> list[int]:
    """For each axis the change of its position."""
    return [sum(steps) for steps in zip(*(line.steps for line in lines), strict=True)]
