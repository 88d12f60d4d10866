# SPDX-License-Identifier: MIT
"""The planner at the smallest of what it takes: one axis, a ramp of one clock."""

from typing import Any

import pytest

from tests.helpers.plan_checks import check_plan
from tests.helpers.plans import LINEAR, Machine, make, make_move, q32, refused

AXIS = {"steps_per_mm": q32(80), "speed": q32(200), "acceleration": q32(1000)}


@pytest.mark.parametrize("axes", range(1, 9))
def test_a_straight_line_of_any_number_of_axes(c: Any, axes: int) -> None:
    """From one to eight; none and nine are refused."""
    fields = {"distance": [q32(10)] * axes, "limits": [AXIS] * axes, "feed": q32(50)}
    plan = make(c, Machine(), axes, "straight", "passo_move_straight", fields)
    check_plan(plan, (800,) * axes)
    for wrong in (0, 9):
        assert refused(c, make, Machine(), wrong, "straight", "passo_move_straight", fields) == "BAD_AXES"


@pytest.mark.parametrize("clocks", [1, 2, 127, 128, 129])
def test_a_ramp_of_a_few_clocks(c: Any, clocks: int) -> None:
    """Takes a tick; only none at all needs an acceleration."""
    fields = {"steps": (1000,), "profile": LINEAR, "speed": q32(10_000), "ramp_clocks": clocks}
    plan = make_move(c, Machine(), "by_speed", fields)
    check_plan(plan, (1000,))
    assert plan.c.accelerate_ticks == plan.c.decelerate_ticks == -(-clocks // 128)
    assert refused(c, make_move, Machine(), "by_speed", {**fields, "ramp_clocks": 0}) == "NO_ACCELERATION"


@pytest.mark.parametrize("clocks", [128, 191, 192, 12_800 + 63, 12_800 + 64, 12_927])
def test_a_time_is_that_of_the_nearest_tick(c: Any, clocks: int) -> None:
    """Of 128 clocks; half a tick more is the next one."""
    fields = {"steps": (1,), "profile": LINEAR, "total_clocks": clocks, "ramp_clocks": 0}
    plan = make_move(c, Machine(), "in_time", fields)
    ticks = sum(plan.c.ramps[n].ticks for n in range(plan.c.ramp_count))
    assert ticks == (clocks + 64) // 128
