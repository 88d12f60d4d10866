# SPDX-License-Identifier: MIT
"""The same moves with Passo's planner and the recurrences of docs/architecture.md."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from cffi import FFI
from passo import compiler, moves
from passo.build import Parameters
from passo.move_forms import SHAPED, USER
from passo.plan import ALPHA_ONE, ALPHA_RESET, Q48, Plan, plan_move
from passo.registers import Shape

from benchmarks import sources
from benchmarks.ideal import Ideal, Phase, by_speed, in_time, shape_area, shape_value
from benchmarks.sources import MILLISECONDS, Cosine, MultiAxis, Pulses, Sigmoid, Trapezoid

CLOCK_HZ = 100_000_000
PARAMETERS = Parameters(axes=4)
TICK_SECONDS = (1 << PARAMETERS.tick_log2) / CLOCK_HZ

SHAPES = [shape.name.lower() for shape in Shape]  # by enum passo_shape

SOURCE = Path(__file__).with_name("steps.c")
DECLARATIONS = """
struct ramp { uint64_t velocity_end, progress_step; uint32_t ticks, shape, mirror; };
uint32_t substep_clocks(const struct ramp *ramps, uint32_t ramp_count, uint32_t tick_log2,
    const uint32_t tables[][257], const uint64_t *due, uint32_t count, uint64_t *clocks);
"""


# ------------------------------------------------------------------------------------- the ideal motion ----


def wanted_steps(move: sources.Move) -> tuple[int, ...]:
    """Steps of each axis; an angle is rounded to nearest."""
    if isinstance(move, Trapezoid):
        return (round(Fraction(move.degrees) * Trapezoid.UPDATES / 2 / 360),)
    return move.steps if isinstance(move, MultiAxis) else (move.steps,)


def wanted_curve(move: sources.Move) -> Ideal:
    """The ideal curve of a move."""
    steps = wanted_steps(move)[0]
    match move:
        case Trapezoid():
            low, high = (rpm * Trapezoid.UPDATES / 2 / 60 for rpm in (move.rpm_min, move.rpm))
            seconds = (high - low) / (Trapezoid.ACCELERATION / 2)
            return by_speed(steps, low, high, low, seconds, seconds)
        case Sigmoid():
            up, down = move.up_ms / MILLISECONDS, move.down_ms / MILLISECONDS
            return by_speed(steps, move.start, move.run, move.stop, up, down, ("sigmoid", move.alpha))
        case MultiAxis():
            low, high = move.v0 * MILLISECONDS, move.vmax * MILLISECONDS
            seconds = move.t_acc / MILLISECONDS
            return by_speed(steps, low, high, low, seconds, seconds)
        case Cosine():
            return in_time(steps, move.total_ms / MILLISECONDS, move.ramp_ms / MILLISECONDS, "cosine")


def passo_move(move: sources.Move) -> moves.Move:
    """The move in the corresponding form of the planner."""
    steps = wanted_steps(move)
    match move:
        case Trapezoid():
            return moves.MoveTurn(
                axes=1,
                axis=0,
                steps_per_turn=Trapezoid.UPDATES // 2,
                angle=Fraction(move.degrees),
                rpm=Fraction(move.rpm),
                minimum_rpm=Fraction(move.rpm_min),
                acceleration=Fraction(Trapezoid.ACCELERATION, 2),
            )
        case Sigmoid():
            speeds = (Fraction(hertz) for hertz in (move.start, move.run, move.stop))
            times = (Fraction(ms, MILLISECONDS) for ms in (move.up_ms, move.down_ms))
            return moves.MoveSigmoid(steps, *speeds, *times, alpha=Fraction(move.alpha))
        case MultiAxis():
            start, speed = (Fraction(pulses * MILLISECONDS) for pulses in (move.v0, move.vmax))
            return moves.MoveAxes(steps, start, speed, Fraction(move.t_acc, MILLISECONDS))
        case Cosine():
            total, ramp = (Fraction(ms, MILLISECONDS) for ms in (move.total_ms, move.ramp_ms))
            return moves.MoveInTime(steps, "cosine", total, ramp)


# --------------------------------------------------------------------------------------------- the core ----


@cache
def library() -> tuple[FFI, Any]:
    """steps.c, compiled once per version."""
    own = FFI()
    own.cdef(DECLARATIONS)
    return own, own.dlopen(str(compiler.library("steps", (), [SOURCE], "-std=gnu11", "-O3")))


def _points(shape: str, alpha: float) -> np.ndarray:
    """A bank as defined in docs/architecture.md: S-curves by area, the first half of the bank mirrored."""
    u = np.arange(257) / 256
    value = shape_value(shape, alpha, u)
    if shape == "ease":
        return np.rint(65536 * value)
    # sum of the points up to each: the area below the lines, in points, and half of the last
    sums = np.rint(65536 * (256 * shape_area(shape, alpha, u) + value / 2))
    half = np.diff(sums[:128], prepend=0)
    return np.concatenate([half, [32768], 65536 - half[::-1]])


@cache
def tables(alpha: float) -> np.ndarray:
    """Banks 1 to 3, 257 points each; the sigmoid for any alpha."""
    return np.array([_points(shape, alpha) for shape in SHAPES[1:]], dtype=np.uint32)


def step_substeps(substeps: int, steps: int) -> np.ndarray:
    """The substeps, from 1, on which an axis makes its steps: the DDA in closed form."""
    k = np.arange(1, steps + 1, dtype=np.int64)
    return -((substeps // 2 - k * substeps) // max(steps, 1))


def alpha_of(plan: Plan) -> float:
    """Alpha of the plan's sigmoid."""
    return (plan.c.sigmoid_alpha or ALPHA_RESET) / ALPHA_ONE


def banks_of(plan: Plan) -> np.ndarray:
    """Contents of the banks for a plan: the standard shapes, or a user-defined one in the sigmoid bank."""
    banks = tables(alpha_of(plan))
    if plan.move.profile in (USER, SHAPED):
        banks = banks.copy()
        banks[SHAPES.index("sigmoid") - 1] = [*plan.table, 65536]
    return banks


def step_clocks(plan: Plan) -> tuple[list[np.ndarray], int]:
    """Clocks from the start to each step, for each axis, and the number of missing substeps.

    Includes the last substep of the line, which completes it.
    """
    own, c = library()
    ramps = own.new("struct ramp[]", [
        (ramp.velocity_end, ramp.progress_step, ramp.ticks, ramp.shape, ramp.mirror) for ramp in plan.ramps
    ])  # fmt: skip
    substeps = plan.line.substeps
    axes = [step_substeps(substeps, abs(steps)) for steps in plan.move.steps]
    due, inverse = np.unique(np.concatenate([*axes, [substeps]]), return_inverse=True)
    banks = banks_of(plan)
    due, clocks = due.astype(np.uint64), np.zeros(len(due), np.uint64)
    made = c.substep_clocks(
        ramps, len(ramps), plan.tick_log2, own.from_buffer("uint32_t[][257]", banks),
        own.from_buffer("uint64_t[]", due), len(due), own.from_buffer("uint64_t[]", clocks),
    )  # fmt: skip
    every = clocks.astype(np.int64)[inverse]
    ends = np.cumsum([len(axis) for axis in axes])
    reached = inverse < made
    parts = zip(np.split(every, ends)[:-1], np.split(reached, ends)[:-1], strict=True)
    steps = [part[ok] for part, ok in parts]
    return steps, len(due) - made


# --------------------------------------------------------------------------------------------- combined ----


@dataclass(frozen=True)
class Made:
    """A move as planned and executed."""

    plan: Plan
    pulses: Pulses
    planned: Ideal  # the curve with phases of whole ticks
    missing: int  # substeps that the ramps do not reach


def planned_curve(plan: Plan, user: str = "") -> Ideal:
    """The curve of a plan's ramps without tables and rounding; `user` names a user-defined shape."""
    hertz = CLOCK_HZ / Q48 / plan.c.oversampling
    phases, velocity = [], 0
    for ramp in plan.ramps:
        start, end, shape = velocity * hertz, ramp.velocity_end * hertz, SHAPES[ramp.shape]
        if shape == "sigmoid" and user:
            shape = user
        phases.append(Phase(ramp.ticks * TICK_SECONDS, start, end, shape, alpha_of(plan), ramp.mirror))
        velocity = ramp.velocity_end
    return Ideal(*phases)


def make(move: sources.Move) -> Made:
    """Plan a move and compute its steps."""
    plan = plan_move(passo_move(move), CLOCK_HZ, PARAMETERS)
    clocks, missing = step_clocks(plan)
    planned = planned_curve(plan)
    main, *followers = (axis / CLOCK_HZ for axis in clocks)
    pulses = Pulses(main, plan.clocks / CLOCK_HZ, planned.start, planned.run, planned.stop, tuple(followers))
    return Made(plan, pulses, planned, missing)
