# SPDX-License-Identifier: MIT
"""Requirements of a jerk-limited plan."""

from fractions import Fraction

from tests.helpers.plan_checks import check_distance, check_steps_to_stop
from tests.helpers.plans import EASE, HALF, LINEAR, SUBSTEPS_MAX, UNIT, Plan, Ramp, speed_of


def ramp_parts(plan: Plan) -> tuple[list[Ramp], list[Ramp]]:
    """The parts of the acceleration and of the deceleration ramp."""
    moving = [ramp for ramp in plan.ramps if ramp.ticks and ramp.velocity_start != ramp.velocity_end]
    up = [ramp for ramp in moving if ramp.velocity_end > ramp.velocity_start]
    return up, [ramp for ramp in moving if ramp.velocity_end < ramp.velocity_start]


def check_limits(plan: Plan, fields: dict) -> None:
    """Speed, acceleration and jerk in exact fractions; velocities are rounded to 2^-48, which may add it."""
    p, clock_hz = plan.c, plan.machine.clock_hz
    acceleration, jerk = (Fraction(fields[name], UNIT) for name in ("acceleration", "jerk"))
    assert speed_of(plan, p.velocity_peak) <= Fraction(fields["speed"], UNIT)
    unit = speed_of(plan, 2)
    for ramp in plan.ramps:
        if not ramp.ticks:
            continue
        change = speed_of(plan, abs(ramp.velocity_end - ramp.velocity_start))
        seconds = Fraction(ramp.ticks * plan.machine.tick, clock_hz)
        if ramp.shape == EASE:  # v = j t^2 / 2
            assert 2 * (change - unit) <= acceleration * seconds
            assert 2 * (change - unit) <= jerk * seconds**2
        else:
            assert change - unit <= acceleration * seconds


def check_structure(plan: Plan, fields: dict) -> None:
    """Ease, linear and mirrored ease, with equal slopes where they meet; symmetric."""
    p, ramps = plan.c, plan.ramps
    longest = max(map(abs, fields["steps"]))
    assert p.line.substeps == p.oversampling * longest <= SUBSTEPS_MAX
    assert plan.steps[: len(fields["steps"])] == [abs(n) for n in fields["steps"]]
    assert 1 <= p.ramp_count <= 9 and ramps[-1].velocity_end == 0
    assert [ramp.last for ramp in p.ramps[0 : p.ramp_count]] == [False] * (p.ramp_count - 1) + [True]
    assert sum(ramp.ticks for ramp in ramps) == plan.ticks
    velocity = max(ramp.velocity_end for ramp in ramps)
    assert velocity == p.velocity_peak <= HALF
    for parts, ticks in zip(ramp_parts(plan), (p.accelerate_ticks, p.decelerate_ticks), strict=True):
        if not parts:
            continue
        assert sum(part.ticks for part in parts) == ticks or len(parts) < 2
        if len(parts) == 3:
            assert [(part.shape, part.mirror) for part in parts] == [(EASE, 0), (LINEAR, 0), (EASE, 1)]
            first, middle, last = (abs(part.velocity_end - part.velocity_start) for part in parts)
            assert first == last and parts[0].ticks == parts[2].ticks
            # the slope at the end of an ease is twice its mean
            slope = Fraction(middle, parts[1].ticks)
            assert abs(Fraction(2 * first, parts[0].ticks) - slope) <= Fraction(4, parts[0].ticks) + Fraction(
                4, parts[1].ticks
            )
        elif len(parts) == 2:
            assert [(part.shape, part.mirror) for part in parts] == [(EASE, 0), (EASE, 1)]
            assert parts[0].ticks == parts[1].ticks
    check_steps_to_stop(plan)


def check_jerk(plan: Plan, fields: dict) -> float:
    check_structure(plan, fields)
    check_limits(plan, fields)
    return float(abs(check_distance(plan)))
