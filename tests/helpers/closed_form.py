# SPDX-License-Identifier: MIT
"""When each step of a motion is due, from the recurrences of docs/architecture.md in Python integers.

For a motion at rate 1.0 whose pins never make a step wait. Nothing here is shared with the C model: the shape
tables come from their formulas, and a substep's clock is a division instead of a sum clock by clock.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import cos, exp, log1p, pi, sin

from passo.registers import Shape

ONE = 1 << 48
HALF = 1 << 47
SHAPE_ONE = 1 << 24
LINEAR, COSINE, SIGMOID, EASE = Shape.LINEAR, Shape.COSINE, Shape.SIGMOID, Shape.EASE


@dataclass(frozen=True)
class Line:
    """`steps` per axis, with sign, while `substeps` pass."""

    substeps: int
    steps: tuple[int, ...]
    last: bool = False
    endless: bool = False


@dataclass(frozen=True)
class Ramp:
    """The velocity (UQ0.48) goes to `velocity_end` in `ticks`."""

    velocity_end: int
    ticks: int
    shape: int = LINEAR
    mirror: bool = False
    last: bool = False
    now: bool = False

    @property
    def progress_step(self) -> int:
        """du, as the contract says."""
        if self.ticks == 0:
            return 0
        if self.ticks > SHAPE_ONE:
            return ONE // self.ticks
        return min((2 * ONE + self.ticks) // (2 * self.ticks), ONE - 1)


def _logistic(x: float) -> float:
    return 1 / (1 + exp(-x))


def _cosine(u: float) -> tuple[float, float]:
    """The shape, and the area below it from 0 to u."""
    return (1 - cos(pi * u)) / 2, (u - sin(pi * u) / pi) / 2


def _sigmoid(u: float) -> tuple[float, float]:
    low, high = _logistic(-5), _logistic(5)
    area = log1p(exp(5 * (2 * u - 1))) - log1p(exp(-5))
    return (_logistic(5 * (2 * u - 1)) - low) / (high - low), (area / 10 - low * u) / (high - low)


def loaded_table(shape: Shape) -> list[int]:
    """The 257 points of a shape after configuration."""
    if shape == Shape.EASE:
        return [k * k for k in range(257)]
    curve = {Shape.COSINE: _cosine, Shape.SIGMOID: _sigmoid}[shape]
    table: list[int] = []
    for k in range(129):
        value, area = curve(k / 256)
        # the area below the lines: all points so far, less half of the last
        table.append(round(65536 * (256 * area + value / 2)) - sum(table))
    table[128] = 32768
    return table + [65536 - point for point in reversed(table[:128])]


Tables = Mapping[int, Sequence[int]]  # of the points of each shape, with the last one, which is 2^16

SHAPES = tuple(Shape)
TABLES: Tables = {shape: loaded_table(shape) for shape in SHAPES if shape != LINEAR}


def shape(number: int, progress: int, tables: Tables = TABLES) -> int:
    """s (UQ1.24) for a progress (UQ0.49)."""
    if number == LINEAR:
        return (progress + (1 << 24)) >> 25
    k, rest = progress >> 41, progress & (1 << 41) - 1
    f = (rest + (1 << 16)) >> 17
    point, point_next = tables[number][k : k + 2]
    return (point * (SHAPE_ONE - f) + point_next * f + (1 << 15)) >> 16


def velocities(ramps: Sequence[Ramp], tables: Tables = TABLES) -> Iterator[int]:
    """The velocity of each tick."""
    start = 0
    for ramp in ramps:
        for tick in range(ramp.ticks):
            # u = du / 2 in the first tick, and then a du more in each; in units of 2^-49
            u = (2 * tick + 1) * ramp.progress_step
            if ramp.mirror:
                back = start - ramp.velocity_end
                yield ramp.velocity_end + (back * shape(ramp.shape, 2 * ONE - 1 - u, tables) >> 24)
            else:
                yield start + ((ramp.velocity_end - start) * shape(ramp.shape, u, tables) >> 24)
        start = ramp.velocity_end


def substep_clocks(ramps: Sequence[Ramp], tick_log2: int, tables: Tables = TABLES) -> list[int]:
    """For each substep the number of enabled clocks until the phase carries; the first clock is 1."""
    clocks: list[int] = []
    phase, length = ONE // 4, 1 << tick_log2
    for tick, velocity in enumerate(velocities(ramps, tables)):
        first = len(clocks) + 1
        carried = (phase + length * velocity) // ONE + len(clocks) - first + 1
        for k in range(1, carried + 1):
            clocks.append((tick << tick_log2) - (phase - k * ONE) // velocity)
        phase += length * velocity - carried * ONE
    return clocks


def line_steps(line: Line, axis: int) -> Iterator[int]:
    """The substep of the line, from 1, on which each step of the axis is made."""
    n, m = abs(line.steps[axis]), line.substeps
    return (-((m // 2 - k * m) // n) for k in range(1, n + 1))


def step_clocks(
    lines: Sequence[Line], ramps: Sequence[Ramp], tick_log2: int, axis: int
) -> list[tuple[int, int]]:
    """All steps of an axis: clocks from the rise of `running` to the rise of STEP, and direction 1 or -1."""
    clocks = substep_clocks(ramps, tick_log2)
    steps: list[tuple[int, int]] = []
    before = 0
    for line in lines:
        direction = -1 if line.steps[axis] < 0 else 1
        for substep in line_steps(line, axis):
            if before + substep > len(clocks):
                return steps
            steps.append((clocks[before + substep - 1], direction))
        before += line.substeps
    return steps
