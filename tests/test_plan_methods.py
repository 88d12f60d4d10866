# SPDX-License-Identifier: MIT
"""The planning methods that are built on the first two forms: exact time with a highest speed, several axes,
and what all methods refuse.

Plans are checked with exact fractions; their execution by the core is summed tick by tick.
"""

import math
import random
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from passo.native import ffi

from tests.helpers.core_steps import step_errors, step_substeps
from tests.helpers.plan_checks import check_plan, round_half_up
from tests.helpers.plans import (
    JERK,
    PROFILES,
    SUBSTEPS_MAX,
    UNIT,
    Machine,
    Plan,
    PlanError,
    make_move,
    q32,
    refused,
    speed_of,
)
from tests.helpers.random_plans import MOVES, SEED, log_uniform, some_machine, some_steps

ZERO = (0,) * 8


# ---------------------------------------------------------------- exact time and distance, highest speed ----


def check_below_speed(plan: Plan, fields: dict) -> None:
    """t_ramp = t_total - n / f, to the tick, and f never exceeded."""
    machine, p = plan.machine, plan.c
    steps = max(map(abs, fields["steps"]))
    total = round_half_up(Fraction(fields["total_clocks"], machine.tick))
    speed = Fraction(fields["speed"], UNIT)
    assert plan.ticks == total
    assert speed_of(plan, p.velocity_peak) <= speed
    exact = total - Fraction(steps * machine.clock_hz, machine.tick) / speed
    assert p.accelerate_ticks == p.decelerate_ticks <= exact
    unit = 2 if fields["profile"] == JERK else 1
    assert p.accelerate_ticks > min(exact, Fraction(total, 2)) - 2 * unit


def check_at_speed(plan: Plan, fields: dict) -> None:
    """t_total = n / f + t_ramp, to two ticks, and f never exceeded."""
    machine, p = plan.machine, plan.c
    steps = max(map(abs, fields["steps"]))
    speed = Fraction(fields["speed"], UNIT)
    assert speed_of(plan, p.velocity_peak) <= speed
    exact = Fraction(steps * machine.clock_hz) / speed + fields["ramp_clocks"]
    assert exact <= plan.ticks * machine.tick < exact + (3 if fields["profile"] == JERK else 2) * machine.tick
    assert 0 <= p.accelerate_ticks * machine.tick - fields["ramp_clocks"] < 2 * machine.tick


@pytest.mark.parametrize("clock_hz", [16_000_000, 100_000_000])
def test_longest_ramp(c: Any, clock_hz: int) -> None:
    """3200 steps in 0.4 s at 19200 Hz leave 0.23 s: more than half, so the ramps are 0.2 s, the peak 16 kHz.
    In 0.5 s they leave 0.33 s; at 8400 Hz there is a cruise."""
    machine = Machine(clock_hz)
    clocks = c.passo_longest_ramp(clock_hz, 3200, clock_hz * 4 // 10, q32(19200))
    assert 0 <= Fraction(4, 10) - Fraction(3200, 19200) - Fraction(clocks, clock_hz) < Fraction(1, clock_hz)
    assert c.passo_longest_ramp(clock_hz, 3200, clock_hz // 10, q32(19200)) == 0
    for seconds, speed in ((0.4, 19200), (0.5, 19200), (0.4, 8400), (0.4, 8000)):
        for profile in PROFILES:
            total = round(seconds * clock_hz)
            fields = {
                "steps": (3200, -7),
                "profile": profile,
                "total_clocks": total,
                "speed": q32(speed),
            }
            plan = make_move(c, machine, "below_speed", fields)
            check_below_speed(plan, fields)
            check_plan(plan, fields["steps"], profile)
            ramp = min(Fraction(total, clock_hz) - Fraction(3200, speed), Fraction(total, 2 * clock_hz))
            assert abs(Fraction(plan.c.accelerate_ticks * 128, clock_hz) - ramp) < Fraction(256, clock_hz)


@pytest.mark.parametrize("form", ["below_speed", "at_speed"])
def test_random_times_and_speeds(c: Any, form: str) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} {form}")
    worst = Fraction(0)
    made = 0
    while made < MOVES:
        machine = some_machine(rng)
        flat = log_uniform(rng, machine.tick, 2**38)  # clocks at full speed
        longest = max(1, min(SUBSTEPS_MAX, int(log_uniform(rng, 1, flat / 2 + 1))))
        speed = int(longest * machine.clock_hz / flat * UNIT * (1 + 2**-30))
        ramp = rng.choice((0, int(flat), rng.randint(0, int(flat))))
        fields = {"steps": some_steps(rng, longest), "profile": rng.choice(PROFILES), "speed": speed}
        if form == "below_speed":
            fields["total_clocks"] = int(flat) + ramp + rng.randint(0, 2 * machine.tick)
        else:
            fields["ramp_clocks"] = ramp
        try:
            plan = make_move(c, machine, form, fields)
        except PlanError as error:
            assert str(error) in ("TOO_LONG", "TOO_FAST", "SPEED_TOO_LOW", "RAMP_TOO_LONG"), fields
            continue
        (check_below_speed if form == "below_speed" else check_at_speed)(plan, fields)
        worst = max(worst, abs(check_plan(plan, fields["steps"], fields["profile"])))
        made += 1
    print(f"{made} moves, distance to {float(worst):.6f} substeps")


def test_ramps_from_none_to_half(c: Any) -> None:
    """Any ramp time from 0 to n / f gives that ramp; the curve is kept to a fiftieth of a step."""
    machine, worst = Machine(16_000_000), 0.0
    for profile in PROFILES:
        for part in (0, 0.001, 0.25, 0.5, 0.999, 1):
            ramp = int(part * 16_000_000 * 3200 / 20_000)
            fields = {"steps": (3200,), "profile": profile, "speed": q32(20_000), "ramp_clocks": ramp}
            plan = make_move(c, machine, "at_speed", fields)
            check_at_speed(plan, fields)
            check_plan(plan, (3200,), profile)
            worst = max(worst, float(np.abs(step_errors(plan)).max()))
    print(f"curve kept to {worst:.5f} steps")
    assert worst < 0.02


# ------------------------------------------------------------------------------------------ several axes ----


def test_fifty_thirty_twenty(c: Any) -> None:
    """50, 30 and 20 kHz on three axes: at every step of the first, the others are where 5 : 3 : 2 puts them,
    to half a step; and the speeds are in that ratio exactly."""
    machine = Machine(16_000_000)
    fields = {
        "steps": (50_000, 30_000, -20_000),
        "start_speed": q32(1000),
        "speed": q32(50_000),
        "ramp_clocks": 1_600_000,
    }
    plan = make_move(c, machine, "axes", fields)
    check_plan(plan, fields["steps"])
    p = plan.c
    assert p.accelerate_ticks == p.decelerate_ticks == 1_600_000 // 128
    assert 50_000 * (1 - 1e-4) < speed_of(plan, p.velocity_peak) <= 50_000
    assert abs(speed_of(plan, p.velocity_start) - 1000) < Fraction(1, 1000)
    assert p.velocity_start == p.velocity_stop
    made = [step_substeps(plan.substeps, abs(n)) for n in fields["steps"]]
    for axis, share in ((1, Fraction(3, 5)), (2, Fraction(2, 5))):
        count = np.searchsorted(made[axis], made[0], side="right")
        first = np.arange(1, 50_001)
        assert np.abs(count - (first - 0.5) * float(share)).max() <= 0.5 + 1e-9
    for start in (0, 12_345, 49_995):  # every five steps of the first
        window = made[0][start], made[0][start + 4] + plan.c.oversampling
        inside = [int(((m >= window[0]) & (m < window[1])).sum()) for m in made]
        assert inside == [5, 3, 2]
    print(f"start speed {float(speed_of(plan, p.velocity_start) / 1000 - 1) * 1e6:+.4f} ppm,", end=" ")
    print(f"speed {float(speed_of(plan, p.velocity_peak) / 50_000 - 1) * 1e6:+.4f} ppm")


def test_a_short_move_is_a_triangle(c: Any) -> None:
    """t = (sqrt(4 v0^2 + 4 a L) - 2 v0) / (2 a), with the acceleration of the full ramp."""
    machine, v0, speed, seconds, length = Machine(), 1000, 50_000, 0.5, 1500
    a = (speed - v0) / seconds
    fields = {
        "steps": (3, -length, 17, 0, 0, 1),
        "start_speed": q32(v0),
        "speed": q32(speed),
        "ramp_clocks": round(seconds * machine.clock_hz),
    }
    plan = make_move(c, machine, "axes", fields)
    check_plan(plan, fields["steps"])
    up = (math.sqrt(4 * v0**2 + 4 * a * length) - 2 * v0) / (2 * a)
    assert plan.c.accelerate_ticks == plan.c.decelerate_ticks == math.ceil(up * machine.clock_hz / 128)
    assert plan.c.cruise_ticks == 0
    assert abs(step_errors(plan)).max() < 0.01


# ------------------------------------------------------------------------------------------------ errors ----


GOOD = {
    "below_speed": {"steps": (5, -3), "profile": 1, "total_clocks": 1_000_000, "speed": q32(1000)},
    "at_speed": {"steps": (5, -3), "profile": 1, "speed": q32(1000), "ramp_clocks": 1000},
    "axes": {"steps": (5, -3), "start_speed": 0, "speed": q32(1000), "ramp_clocks": 1000},
}
REFUSED = [
    ("below_speed", {"total_clocks": 400_000}, "SPEED_TOO_LOW"),
    ("below_speed", {"speed": 1}, "SPEED_TOO_LOW"),
    ("below_speed", {"speed": 0}, "NO_SPEED"),
    ("below_speed", {"total_clocks": 127}, "NO_TIME"),
    ("below_speed", {"total_clocks": 2**64 - 1}, "TOO_LONG"),
    ("below_speed", {"profile": len(PROFILES)}, "BAD_PROFILE"),
    ("below_speed", {"steps": (0, 0)}, "NO_STEPS"),
    ("below_speed", {"steps": (600_000,), "speed": 2**64 - 1}, "TOO_FAST"),
    ("at_speed", {"speed": 0}, "NO_SPEED"),
    ("at_speed", {"ramp_clocks": 600_000}, "RAMP_TOO_LONG"),
    ("at_speed", {"ramp_clocks": 2**64 - 1}, "RAMP_TOO_LONG"),
    ("at_speed", {"speed": 1}, "TOO_LONG"),
    ("at_speed", {"speed": 2**64 - 1, "ramp_clocks": 0, "steps": (100,)}, "TOO_FAST"),
    ("at_speed", {"steps": (-SUBSTEPS_MAX - 1,)}, "TOO_MANY_STEPS"),
    ("below_speed", {"steps": (1, SUBSTEPS_MAX + 1)}, "TOO_MANY_STEPS"),
    ("axes", {"steps": (1, -(2**31))}, "TOO_MANY_STEPS"),
    ("axes", {"speed": 0}, "NO_SPEED"),
    ("axes", {"start_speed": q32(1001)}, "START_ABOVE_SPEED"),
    ("axes", {"ramp_clocks": 0}, "NO_ACCELERATION"),
    ("axes", {"speed": q32(5e7) + 1}, "TOO_FAST"),
    ("axes", {"steps": ZERO}, "NO_STEPS"),
]


@pytest.mark.parametrize("method", GOOD)
def test_good_moves_are_planned(c: Any, method: str) -> None:
    check_plan(
        make_move(c, Machine(), method, GOOD[method]), GOOD[method]["steps"], GOOD[method].get("profile", 0)
    )


@pytest.mark.parametrize(("method", "changes", "name"), REFUSED)
def test_refusals(c: Any, method: str, changes: dict, name: str) -> None:
    assert refused(c, make_move, Machine(), method, {**GOOD[method], **changes}) == name


def test_every_error_of_the_methods_is_known() -> None:
    """What is refused above has a code; tests/test_plan.py checks the name and sentence of each."""
    errors = ffi().typeof("enum passo_plan_error").relements
    assert {"PASSO_PLAN_" + name for _, _, name in REFUSED} <= set(errors)
