# SPDX-License-Identifier: MIT
"""Long and slow, short and quick: 1 to 2^30 - 1 steps, one step per minute to half the clock, for hours."""

from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.jerk_checks import check_jerk
from tests.helpers.plan_checks import check_plan
from tests.helpers.plans import SUBSTEPS_MAX, Machine, make_move, q32, speed_of

HOUR = 3600
STEPS = (1, 2, 3, 1000, 2**20 + 1, SUBSTEPS_MAX)


@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("hours", [1, 12])
def test_hours(c: Any, steps: int, hours: int) -> None:
    """In exact time; the ramps, as long as a highest speed allows, may take all of it."""
    machine = Machine(72_000_000, 10)
    total = hours * HOUR * machine.clock_hz
    for part in (1.0001, 1.5, 1.9999, 3):
        speed = q32(part * steps / (hours * HOUR))
        fields = {"steps": (steps, -1), "profile": 1, "total_clocks": total, "speed": speed}
        plan = make_move(c, machine, "below_speed", fields)
        check_plan(plan, fields["steps"], 1)
        assert abs(plan.ticks * machine.tick - total) <= machine.tick // 2
        assert speed_of(plan, plan.c.velocity_peak) <= Fraction(speed, 1 << 32)


@pytest.mark.parametrize("steps", STEPS)
def test_one_step_per_minute(c: Any, steps: int) -> None:
    """As long as 2^44 clocks allow: two days at 100 MHz, three weeks at 8 MHz."""
    machine = Machine(8_000_000, 16)
    fields = {"steps": (min(steps, 25_000),), "profile": 1, "speed": q32(1 / 60), "ramp_clocks": 8_000_000}
    check_plan(make_move(c, machine, "at_speed", fields), fields["steps"], 1)
    jerk = {
        "steps": (min(steps, 20_000),),
        "start_speed": 0,
        "speed": q32(1 / 60),
        "stop_speed": q32(1 / 90),
        "acceleration": q32(1 / 1000),
        "jerk": q32(1 / 10_000),
    }
    check_jerk(make_move(c, machine, "jerk", jerk), jerk)


@pytest.mark.parametrize("steps", STEPS)
def test_half_the_clock(c: Any, steps: int) -> None:
    machine = Machine()
    speed = machine.clock_hz * 2**32 // 2
    fields = {"steps": (steps, 1), "profile": 2, "speed": speed, "ramp_clocks": min(steps * 2, 10**8)}
    check_plan(make_move(c, machine, "at_speed", fields), fields["steps"], 2)
    axes = {"steps": (steps, -steps), "start_speed": speed, "speed": speed, "ramp_clocks": 0}
    check_plan(make_move(c, machine, "axes", axes), axes["steps"])
    jerk = {"steps": (steps,), "start_speed": 0, "speed": speed, "stop_speed": speed // 3}
    jerk |= {"acceleration": q32(4e9), "jerk": 2**64 - 1}
    check_jerk(make_move(c, machine, "jerk", jerk), jerk)
