# SPDX-License-Identifier: MIT
"""What the core makes of a plan, from the recurrences of docs/architecture.md: in Python integers, in numpy's
64-bit integers or, where ramps have millions of ticks, in closed form; and the ideal curve.
"""

import importlib.util
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from passo.registers import Shape
from passo.toolchain import paths

from benchmarks.ideal import shape_area
from tests.helpers.plans import AXES, EASE, LINEAR, ONE, Plan, Ramp

SIGMOID_ALPHA = 5
EXACT_TICKS = 1 << 21  # longer ramps are not summed tick by tick


def load_generator() -> Any:
    spec = importlib.util.spec_from_file_location("generate_shapes", paths.spec / "generate_shapes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def tables() -> list[list[int]]:
    """Points of banks 0 .. 3, 0 .. 256; bank 0 is not used."""
    return [[0] * 257, *([*table, 65536] for table in load_generator().banks().values())]


def shape(bank: int, u: int) -> int:
    """s (UQ1.24) for a progress u (UQ0.49)."""
    if bank == LINEAR:
        return (u + (1 << 24)) >> 25
    k, f = u >> 41, ((u & (1 << 41) - 1) + (1 << 16)) >> 17
    t = [*tables()[bank], 65536]
    return (t[k] * ((1 << 24) - f) + t[k + 1] * f + (1 << 15)) >> 16


def velocity_of_tick(ramp: Ramp, tick: int) -> int:
    """The ramp recurrence, in plain integers."""
    u = (2 * tick + 1) * ramp.progress_step
    assert u < 2 * ONE
    change = ramp.velocity_end - ramp.velocity_start
    if ramp.mirror:
        return ramp.velocity_end + (-change * shape(ramp.shape, 2 * ONE - 1 - u) >> 24)
    return ramp.velocity_start + (change * shape(ramp.shape, u) >> 24)


def velocities_of_ticks(ramp: Ramp, first: int, last: int) -> np.ndarray:
    """Those of the ticks from first to before last, in 64-bit integers."""
    u = (2 * np.arange(first, last, dtype=np.int64) + 1) * ramp.progress_step
    start, end = ramp.velocity_start, ramp.velocity_end
    if ramp.mirror:
        u, start, end = 2 * ONE - 1 - u, end, start
    if ramp.shape:
        t = np.array([*tables()[ramp.shape], 65536], dtype=np.int64)
        k, f = u >> 41, ((u & (1 << 41) - 1) + (1 << 16)) >> 17
        s = (t[k] * ((1 << 24) - f) + t[k + 1] * f + (1 << 15)) >> 16
    else:
        s = (u + (1 << 24)) >> 25
    change = end - start
    return start + (change >> 24) * s + ((change & 0xFFFFFF) * s >> 24)


def sum_of_velocities(ramp: Ramp, chunk: int = 1 << 16) -> int:
    total = 0
    for first in range(0, ramp.ticks, chunk):
        velocities = velocities_of_ticks(ramp, first, min(first + chunk, ramp.ticks))
        total += (int((velocities >> 24).sum()) << 24) + int((velocities & 0xFFFFFF).sum())
    return total


def mean_shape(ramp: Ramp) -> Fraction:
    """Mean of the ideal shape over the ticks' progress, which ends at c instead of 1."""
    du, ticks = Fraction(ramp.progress_step, ONE), ramp.ticks
    if ramp.shape != EASE:
        return du * ticks / 2
    mean_square = du * du * (Fraction(ticks * ticks, 3) - Fraction(1, 12))
    return du * ticks - mean_square if ramp.mirror else mean_square


def distance(plan: Plan) -> Fraction:
    """Substeps under the ramps, summed tick by tick unless ramps are very long."""
    ramps = plan.ramps
    exact = all(ramp.ticks <= EXACT_TICKS or ramp.velocity_start == ramp.velocity_end for ramp in ramps)
    total = Fraction(0)
    for ramp in ramps:
        change = ramp.velocity_end - ramp.velocity_start
        if change == 0 or not exact:
            total += ramp.ticks * (ramp.velocity_start + change * (mean_shape(ramp) if ramp.ticks else 0))
        elif ramp.ticks:
            total += sum_of_velocities(ramp)
    return total * plan.machine.tick / ONE


def step_substeps(substeps: int, steps: int) -> np.ndarray:
    """The substeps, 1 .. M, in which an axis makes its steps: closed form of the DDA."""
    k = np.arange(1, steps + 1, dtype=np.int64)
    return -((substeps // 2 - k * substeps) // steps)


def tick_velocities(plan: Plan) -> np.ndarray:
    return np.concatenate([velocities_of_ticks(ramp, 0, ramp.ticks) for ramp in plan.ramps if ramp.ticks])


def substep_clocks(plan: Plan, substeps: np.ndarray) -> np.ndarray:
    """The clocks, counted from 1, in which these substeps are made: closed form of the path."""
    velocities = tick_velocities(plan)
    moved = velocities << plan.machine.tick_log2
    upper, lower = np.cumsum(moved >> 24), np.cumsum(moved & 0xFFFFFF)
    upper, lower = upper + (lower >> 24) + (1 << 22), lower & 0xFFFFFF  # a motion starts with phase 1/4
    whole, fraction = upper >> 24, (upper & 0xFFFFFF) << 24 | lower
    tick = np.searchsorted(whole, substeps)
    assert tick.max() < len(velocities), "substeps are missing"
    before = np.concatenate(([0], whole))[tick], np.concatenate(([1 << 46], fraction))[tick]
    missing = ((substeps - before[0]) << 48) - before[1]
    return (tick << plan.machine.tick_log2) - (-missing // velocities[tick])


def run_clock_by_clock(plan: Plan) -> list[list[int]]:
    """The contract's recurrences, literally: the clocks in which each axis makes its steps."""
    line = plan.c.line
    phase, made, clock = ONE // 4, 0, 0
    errors = [line.substeps // 2] * AXES
    steps = [[] for _ in range(AXES)]
    for ramp in plan.ramps:
        for tick in range(ramp.ticks):
            velocity = velocity_of_tick(ramp, tick)
            for _ in range(plan.machine.tick):
                clock += 1
                phase += velocity
                if phase < ONE or made == line.substeps:
                    continue
                phase -= ONE
                made += 1
                for axis in range(AXES):
                    errors[axis] += line.steps[axis]
                    if errors[axis] >= line.substeps:
                        errors[axis] -= line.substeps
                        steps[axis].append(clock)
    assert made == line.substeps
    assert errors == [line.substeps // 2] * AXES
    return steps


def shape_integral(ramp_shape: int, mirror: bool, u: np.ndarray) -> np.ndarray:
    """Integral of the ideal shape from 0 to u."""
    name = Shape(ramp_shape).name.lower()
    if not mirror:
        return shape_area(name, SIGMOID_ALPHA, u)
    return u - (shape_area(name, SIGMOID_ALPHA, np.ones_like(u)) - shape_area(name, SIGMOID_ALPHA, 1 - u))


def ideal_path(plan: Plan, clocks: np.ndarray) -> np.ndarray:
    """Substeps covered at these times by the ideal curve: no tables, no ticks."""
    path = np.zeros(len(clocks))
    start = 0
    for ramp in plan.ramps:
        if not ramp.ticks:
            continue
        length = ramp.ticks * plan.machine.tick
        u = np.clip((clocks - start) / length, 0, 1)
        change = (ramp.velocity_end - ramp.velocity_start) / ONE
        path += length * (ramp.velocity_start / ONE * u + change * shape_integral(ramp.shape, ramp.mirror, u))
        start += length
    return path


@cache
def table_deviation(ramp_shape: int) -> float:
    """How far the integral of the interpolated table strays from that of its shape."""
    if ramp_shape == LINEAR:
        return 0.0
    fine = 64
    s = np.interp(np.arange(256 * fine + 1) / fine, np.arange(257), tables()[ramp_shape]) / 65536
    integral = np.concatenate(([0], np.cumsum((s[1:] + s[:-1]) / 2))) / (256 * fine)
    return float(
        np.abs(integral - shape_integral(ramp_shape, False, np.arange(256 * fine + 1) / (256 * fine))).max()
    )


@cache
def steepest(ramp_shape: int) -> float:
    """The steepest that a shape may be, by its table, whose points are rounded."""
    points = tables()[ramp_shape]
    return 1.0 if ramp_shape == LINEAR else max(b - a + 1 for a, b in pairwise(points)) / 256


def curve_deviation(plan: Plan) -> float:
    """How far, in substeps, the core's path can stray from the ideal curve.

    Its velocity has ticks, which shows most in the middle of one and hardly at its ends; its shapes have 256
    points, its progress 24 bits.
    """
    total = staircase = 0.0
    for ramp in plan.ramps:
        if ramp.ticks:
            change = abs(ramp.velocity_end - ramp.velocity_start) / ONE
            staircase = max(staircase, change * plan.machine.tick / ramp.ticks * steepest(ramp.shape) / 6)
            total += change * ramp.ticks * plan.machine.tick * (table_deviation(ramp.shape) + 2**-24)
    return total + staircase


def step_errors(plan: Plan) -> np.ndarray:
    """How far the ideal curve is beyond its place when each step of the longest axis is made, in steps."""
    steps = max(plan.steps)
    clocks = substep_clocks(plan, step_substeps(plan.substeps, steps))
    due = (np.arange(1, steps + 1) - 0.5) * plan.substeps / steps
    return (ideal_path(plan, clocks.astype(float)) - due) / plan.c.oversampling
