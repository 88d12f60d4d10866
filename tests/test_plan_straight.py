# SPDX-License-Identifier: MIT
"""Straight lines in millimeters with limits of speed, acceleration and jerk on each axis."""

import math
import random
from fractions import Fraction
from typing import Any

import pytest

from tests.helpers.plan_checks import check_distance, check_steps_to_stop, round_half_up
from tests.helpers.plans import (
    EASE,
    SUBSTEPS_MAX,
    UNIT,
    Machine,
    Plan,
    PlanError,
    make,
    q32,
    refused,
    speed_of,
)
from tests.helpers.random_plans import MOVES, SEED, log_uniform, some_machine

XY = {"steps_per_mm": q32(80), "speed": q32(500), "acceleration": q32(3000), "jerk": q32(60_000)}
Z = {"steps_per_mm": q32(400), "speed": q32(12), "acceleration": q32(100), "jerk": q32(2000)}
GOOD = {"distance": (q32(100), q32(-40), q32(1)), "limits": (XY, XY, Z), "feed": q32(150)}


def straight(c: Any, machine: Machine, **changes: Any) -> Plan:
    fields = {**GOOD, **changes}
    return make(c, machine, len(fields["distance"]), "straight", "passo_move_straight", fields)


def check(plan: Plan, fields: dict) -> float:
    """Steps to the nearest; each axis within its own limits and the path within the feed, in fractions."""
    p, machine = plan.c, plan.machine
    steps = [
        round_half_up(Fraction(abs(d) * own["steps_per_mm"], UNIT**2))
        for d, own in zip(fields["distance"], fields["limits"], strict=True)
    ]
    assert plan.steps[: len(steps)] == steps
    negative = [axis for axis, d in enumerate(fields["distance"]) if d < 0 and steps[axis]]
    assert p.line.directions == sum(1 << axis for axis in negative)
    longest = max(steps)
    speed = speed_of(plan, p.velocity_peak)
    length = math.sqrt(sum((d / UNIT) ** 2 for d in fields["distance"]))
    assert float(speed / longest) * length <= fields["feed"] / UNIT * (1 + 1e-12)
    unit = speed_of(plan, 2)
    jerks = [own["jerk"] for own, n in zip(fields["limits"], steps, strict=True) if n]
    for own, n in zip(fields["limits"], steps, strict=True):
        share, scale = Fraction(n, longest), Fraction(own["steps_per_mm"], UNIT**2)
        assert speed * share <= own["speed"] * scale
        for ramp in plan.ramps:
            if not ramp.ticks:
                continue
            change = (speed_of(plan, abs(ramp.velocity_end - ramp.velocity_start)) - unit) * share
            seconds = Fraction(ramp.ticks * machine.tick, machine.clock_hz)
            assert (ramp.shape == EASE) == any(jerks) or ramp.shape == 0
            slope = 2 if ramp.shape == EASE else 1
            assert slope * change <= own["acceleration"] * scale * seconds
            if own["jerk"] and ramp.shape == EASE:
                assert slope * change <= own["jerk"] * scale * seconds**2
    check_steps_to_stop(plan)
    return float(abs(check_distance(plan)))


def test_the_tightest_axis_decides(c: Any) -> None:
    """The feed, then x, then z; and how close the move gets to that limit."""
    machine = Machine(16_000_000)
    cases = (
        ({}, 150),  # the feed
        (
            {"distance": (q32(1000), q32(-400), q32(1)), "feed": q32(5000)},
            math.sqrt(1000**2 + 400**2 + 1) / 2,
        ),  # x
        ({"distance": (q32(100), q32(-40), q32(20)), "feed": q32(5000)}, 12 * math.sqrt(12_000) / 20),  # z
    )
    for changes, path_speed in cases:
        fields = {**GOOD, **changes}
        plan = straight(c, machine, **changes)
        check(plan, fields)
        length = math.sqrt(sum((d / UNIT) ** 2 for d in fields["distance"]))
        got = float(speed_of(plan, plan.c.velocity_peak)) * length / max(plan.steps)
        print(f"path speed {got:.6f} of {path_speed:.6f} mm/s: {(got / path_speed - 1) * 1e6:+.1f} ppm")
        assert path_speed * (1 - 1e-3) < got <= path_speed * (1 + 1e-9)


def test_without_jerk_it_is_a_trapezoid(c: Any) -> None:
    limits = tuple({**own, "jerk": 0} for own in (XY, XY, Z))
    plan = straight(c, Machine(16_000_000), limits=limits)
    check(plan, {**GOOD, "limits": limits})
    assert plan.c.ramp_count == 3
    one = ({**XY, "jerk": 0}, XY, {**Z, "jerk": 0})  # one limit of jerk is enough
    plan = straight(c, Machine(16_000_000), limits=one)
    check(plan, {**GOOD, "limits": one})
    assert plan.c.ramp_count == 7


def test_random_lines(c: Any) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} straight")
    worst, made, errors = 0.0, 0, set()
    while made < MOVES:
        machine = some_machine(rng)
        axes = rng.randint(1, 8)
        limits = []
        for _ in range(axes):
            speed = log_uniform(rng, 0.01, 10_000)
            acceleration = speed / log_uniform(rng, 1e-3, 10)
            jerk = rng.choice((0, acceleration / log_uniform(rng, 1e-3, 10)))
            own = {"steps_per_mm": q32(log_uniform(rng, 0.01, 10_000)), "speed": q32(speed)}
            limits.append({**own, "acceleration": q32(acceleration), "jerk": q32(jerk)})
        distance = [
            rng.choice((0, 1, 1, 1)) * rng.choice((1, -1)) * q32(log_uniform(rng, 0.001, 10_000))
            for _ in range(axes)
        ]
        fields = {"distance": distance, "limits": limits, "feed": q32(log_uniform(rng, 0.01, 20_000))}
        try:
            plan = straight(c, machine, **fields)
        except PlanError as error:
            errors.add(str(error))
            assert str(error) in ("TOO_LONG", "TOO_FAST", "NO_STEPS"), fields
            continue
        try:
            worst = max(worst, check(plan, fields))
        except AssertionError as error:
            error.add_note(f"{machine} {fields}")
            raise
        made += 1
    print(f"{made} lines, distance to {worst:.6f} substeps")


def test_far_and_near(c: Any) -> None:
    """The largest number of steps, eight axes together, what rounds to one more, and a distance below half a
    step."""
    machine = Machine(4_000_000_000)
    own = {"steps_per_mm": q32(1), "speed": q32(1e9), "acceleration": q32(4e9), "jerk": 0}
    too_far = SUBSTEPS_MAX * UNIT + UNIT // 2
    fields = {"distance": (too_far - 1,) * 8, "limits": (own,) * 8, "feed": 2**64 - 1}
    plan = straight(c, machine, **fields)
    check(plan, fields)
    assert plan.steps == [SUBSTEPS_MAX] * 8
    for distance in (too_far, -too_far, 2**63 - 2**32):
        fields["distance"] = (*(UNIT,) * 7, distance)
        assert refused(c, lambda c: straight(c, machine, **fields)) == "TOO_MANY_STEPS"
    short = {"distance": (q32(100), q32(0.006)), "limits": (XY, XY), "feed": q32(100)}
    plan = straight(c, machine, **short)
    assert plan.steps[:2] == [8000, 0]
    assert refused(c, lambda c: straight(c, machine, **{**short, "distance": (q32(0.006), 0)})) == "NO_STEPS"


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"feed": 0}, "NO_FEED"),
        ({"distance": (0, 0, 0)}, "NO_STEPS"),
        ({"distance": (q32(1), -(2**63), 0)}, "TOO_MANY_STEPS"),
        ({"limits": ({**XY, "steps_per_mm": 0}, XY, Z)}, "NO_SCALE"),
        ({"limits": (XY, {**XY, "speed": 0}, Z)}, "NO_AXIS_SPEED"),
        ({"limits": (XY, XY, {**Z, "acceleration": 0})}, "NO_AXIS_ACCELERATION"),
        ({"limits": (XY, XY, {**Z, "jerk": 1, "steps_per_mm": UNIT - 1})}, "NO_JERK"),
        ({"limits": (XY, XY, {**Z, "speed": 1, "steps_per_mm": UNIT - 1})}, "NO_SPEED"),
        ({"limits": ({**XY, "steps_per_mm": 1000 * XY["steps_per_mm"]}, XY, Z), "feed": q32(1e6)}, ""),
    ],
)
def test_refusals(c: Any, changes: dict, name: str) -> None:
    assert refused(c, lambda c: straight(c, Machine(), **changes)) == name


def test_an_axis_that_rests_needs_no_limits(c: Any) -> None:
    fields = {"distance": (q32(10), 0), "limits": (XY, dict.fromkeys(XY, 0)), "feed": q32(50)}
    check(straight(c, Machine(), **fields), fields)
