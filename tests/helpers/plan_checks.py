# SPDX-License-Identifier: MIT
"""Requirements of every plan, checked with exact fractions."""

import math
from dataclasses import dataclass
from fractions import Fraction

from tests.helpers.core_steps import distance, mean_shape
from tests.helpers.plans import (
    AXES,
    EASE,
    HALF,
    JERK,
    LINEAR,
    ONE,
    SHAPE_OF_PROFILE,
    SUBSTEPS_MAX,
    BySpeed,
    InTime,
    Plan,
)

DISTANCE_TOLERANCE = Fraction(1, 5)  # substeps; the core tolerates 1/4
LONG_RAMPS = 32  # see progress_bound()


def round_half_up(value: Fraction) -> int:
    return math.floor(value + Fraction(1, 2))


def check_structure(plan: Plan, move: InTime | BySpeed) -> None:
    """Line, K, order and completeness of the ramps; every number in its range."""
    p, line, ramps = plan.c, plan.c.line, plan.ramps
    steps = [*move.steps, *[0] * (AXES - len(move.steps))]
    longest = max(map(abs, steps))
    assert line.last and not line.endless
    assert plan.steps == [abs(n) for n in steps]
    assert line.directions == sum(1 << axis for axis, n in enumerate(steps) if n < 0)
    assert p.oversampling == 1 or (p.oversampling > 0 and p.oversampling % 2 == 0)
    assert line.substeps == p.oversampling * longest <= SUBSTEPS_MAX

    assert 1 <= p.ramp_count <= 7
    flags = [(ramp.last, ramp.now) for ramp in p.ramps[0 : p.ramp_count]]
    assert flags == [(False, False)] * (p.ramp_count - 1) + [(True, False)]
    assert ramps[-1].velocity_end == 0
    assert max(ramp.velocity_end for ramp in ramps) == p.velocity_peak <= HALF
    assert sum(ramp.ticks for ramp in ramps) == plan.ticks > 0
    for ramp in ramps:
        if ramp.ticks == 0:
            assert (ramp.shape, ramp.mirror) == (0, False)
        elif ramp.ticks <= 1 << 24:
            exact = Fraction(ONE, ramp.ticks)
            assert ramp.progress_step == min(round_half_up(exact), ONE - 1)
        else:
            assert ramp.progress_step == ONE // ramp.ticks

    def change(start: int, end: int, ticks: int) -> list[tuple[int, int, bool, int]]:
        if move.profile == JERK:
            assert ticks % 2 == 0
            return [(ticks // 2, (start + end) // 2, False, EASE), (ticks // 2, end, True, EASE)]
        return [(ticks, end, False, SHAPE_OF_PROFILE[move.profile])]

    expected = []
    if p.velocity_start:
        expected.append((0, p.velocity_start, False, LINEAR))
    if p.accelerate_ticks:
        expected += change(p.velocity_start, p.velocity_peak, p.accelerate_ticks)
    if p.cruise_ticks:
        expected.append((p.cruise_ticks, p.velocity_peak, False, LINEAR))
    if p.decelerate_ticks:
        expected += change(p.velocity_peak, p.velocity_stop, p.decelerate_ticks)
    if p.velocity_stop:
        expected.append((0, 0, False, LINEAR))
    assert [(ramp.ticks, ramp.velocity_end, ramp.mirror, ramp.shape) for ramp in ramps] == expected
    if p.accelerate_ticks == 0:
        assert p.velocity_start == p.velocity_peak
    if p.decelerate_ticks == 0:
        assert p.velocity_stop == p.velocity_peak


def progress_bound(plan: Plan) -> Fraction:
    """Bound of the end position error, in substeps, due to the core's 24 bits of progress and of shape.

    Equal ramps cancel out. Others need hundreds of millions of clocks at full velocity to exceed the
    tolerance, although this bound of 2^-24 per tick does so earlier.
    """
    p = plan.c
    up, down = p.velocity_peak - p.velocity_start, p.velocity_peak - p.velocity_stop
    if p.accelerate_ticks == p.decelerate_ticks:
        sensitive = p.accelerate_ticks * abs(up - down)
    else:
        sensitive = p.accelerate_ticks * up + p.decelerate_ticks * down
    return Fraction(sensitive * plan.machine.tick, ONE << 24)


def check_distance(plan: Plan) -> Fraction:
    """The ramps cover M substeps; return the error."""
    error = distance(plan) - plan.substeps
    long = progress_bound(plan) > LONG_RAMPS * DISTANCE_TOLERANCE
    assert abs(error) < (progress_bound(plan) if long else DISTANCE_TOLERANCE)
    return error


@dataclass(frozen=True)
class Shown:
    """What check_structure() needs to know of a move."""

    steps: tuple[int, ...]
    profile: int


def check_plan(plan: Plan, steps: tuple[int, ...], profile: int = LINEAR) -> Fraction:
    """Structure and distance; return the error of the distance in substeps."""
    check_structure(plan, Shown(steps, profile))
    check_steps_to_stop(plan)
    return check_distance(plan)


def check_steps_to_stop(plan: Plan) -> None:
    """The distance of the deceleration ramps, rounded to the nearest step."""
    ticks, substeps = 0, 0.0
    for ramp in reversed(plan.ramps):
        if ticks >= plan.c.decelerate_ticks:
            break
        if ramp.ticks:
            change = ramp.velocity_end - ramp.velocity_start
            substeps += ramp.ticks * (ramp.velocity_start + change * float(mean_shape(ramp)))
            ticks += ramp.ticks
    wanted = substeps * plan.machine.tick / ONE / plan.c.oversampling
    assert abs(plan.c.steps_to_stop - wanted) < 0.5 + 1e-3 + wanted * 1e-9
