# SPDX-License-Identifier: MIT
"""Jerk-limited moves in up to seven phases."""

import math
import random
from typing import Any

import numpy as np
import pytest

from tests.helpers.core_steps import step_errors
from tests.helpers.jerk_checks import check_jerk, ramp_parts
from tests.helpers.plans import (
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

GOOD = {
    "steps": (200_000, -3),
    "start_speed": q32(500),
    "speed": q32(40_000),
    "stop_speed": q32(300),
    "acceleration": q32(200_000),
    "jerk": q32(4_000_000),
}


def jerk(c: Any, machine: Machine, **changes: Any) -> Plan:
    return make_move(c, machine, "jerk", {**GOOD, **changes})


def ramp_seconds(change: float, acceleration: float, jerk: float) -> float:
    if change >= acceleration**2 / jerk:
        return change / acceleration + acceleration / jerk
    return 2 * math.sqrt(change / jerk)


def quickest(fields: dict) -> float:
    """Seconds of the ideal move, by bisection in floating point."""
    v0, v, v1, a, j = (
        fields[name] / UNIT for name in ("start_speed", "speed", "stop_speed", "acceleration", "jerk")
    )
    length = max(map(abs, fields["steps"]))

    def way(peak: float) -> float:
        return sum(
            (peak + end) / 2 * ramp_seconds(max(0.0, peak - end), a, j) for end in (v0, v1) if peak > end
        )

    peak = v
    if way(v) > length:
        low, high = max(v0, v1), v
        if way(low) > length:
            return math.nan  # it jumps to, or from, less: not looked at here
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if way(middle) < length else (low, middle)
        peak = low
    seconds = sum(ramp_seconds(max(0.0, peak - end), a, j) for end in (v0, v1))
    return seconds + max(0.0, length - way(peak)) / peak


def test_seven_phases(c: Any) -> None:
    """t_j = a / j, t_total = dv / a + a / j, in whole ticks; the curve is kept."""
    machine = Machine(16_000_000)
    plan = jerk(c, machine)
    check_jerk(plan, GOOD)
    up, down = ramp_parts(plan)
    assert len(up) == len(down) == 3 and plan.c.ramp_count == 9 and plan.c.cruise_ticks > 0
    ease = math.ceil(200_000 / 4_000_000 * machine.clock_hz / 128)
    assert [part.ticks for part in up] == [ease, math.ceil(39_500 / 200_000 * 125_000) - ease, ease]
    error = np.abs(step_errors(plan)).max()
    frequencies = {500: plan.c.velocity_start, 40_000: plan.c.velocity_peak, 300: plan.c.velocity_stop}
    ppm = [float(speed_of(plan, v) / f - 1) * 1e6 for f, v in frequencies.items()]
    print(f"steps within {error:.5f} of the curve;", ", ".join(f"{value:+.4f} ppm" for value in ppm))
    assert error < 0.01


@pytest.mark.parametrize(
    ("changes", "parts", "cruise"),
    [
        ({}, (3, 3), True),
        ({"steps": (5000,)}, (3, 3), False),  # the speed is not reached
        ({"steps": (40,)}, (2, 2), False),  # nor the acceleration
        ({"speed": q32(2000)}, (2, 2), True),  # the acceleration is not reached, the speed is
        ({"start_speed": q32(40_000)}, (0, 3), True),
        ({"stop_speed": q32(40_000)}, (3, 0), True),
        ({"start_speed": q32(40_000), "stop_speed": q32(40_000)}, (0, 0), True),
        ({"start_speed": q32(30_000), "steps": (100,)}, (0, 2), False),  # too short to slow down from 30 kHz
        ({"stop_speed": q32(30_000), "steps": (100,)}, (2, 0), False),
        ({"jerk": 2**64 - 1}, (3, 3), True),
        ({"acceleration": 2**63}, (2, 2), True),
    ],
)
def test_fewer_phases(c: Any, changes: dict, parts: tuple[int, int], cruise: bool) -> None:
    machine, fields = Machine(16_000_000), {**GOOD, **changes}
    plan = jerk(c, machine, **changes)
    check_jerk(plan, fields)
    assert tuple(map(len, ramp_parts(plan))) == parts
    if cruise:
        assert plan.c.cruise_ticks > 0
    ideal = quickest(fields)
    if not math.isnan(ideal):
        seconds = plan.ticks * 128 / 16_000_000
        assert ideal * (1 - 1e-9) <= seconds <= ideal * 1.001 + 8 * 128 / 16_000_000


def test_random_moves(c: Any) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} jerk")
    worst, slowest, made, kinds = 0.0, 0.0, 0, set()
    while made < 3 * MOVES:
        machine = some_machine(rng)
        speed = log_uniform(rng, 1 / 60, machine.clock_hz / 2.01)
        acceleration = speed / log_uniform(rng, 1e-5, 1e2)
        jerk_limit = acceleration / log_uniform(rng, 1e-5, 1e2)
        steps = max(1, min(SUBSTEPS_MAX, int(speed * log_uniform(rng, 1e-4, 1e3))))
        fields = {
            "steps": some_steps(rng, steps),
            "start_speed": rng.choice((0, 0, q32(speed), q32(speed * rng.random() ** 3))),
            "speed": q32(speed),
            "stop_speed": rng.choice((0, 0, q32(speed), q32(speed * rng.random() ** 3))),
            "acceleration": max(1, min(2**64 - 1, int(acceleration * UNIT))),
            "jerk": max(1, min(2**64 - 1, int(jerk_limit * UNIT))),
        }
        try:
            plan = jerk(c, machine, **fields)
        except PlanError as error:
            assert str(error) == "TOO_LONG", fields
            continue
        try:
            worst = max(worst, check_jerk(plan, fields))
            ideal = quickest(fields)
            seconds = plan.ticks * machine.tick / machine.clock_hz
            if not math.isnan(ideal):
                assert seconds >= ideal * (1 - 1e-6)
                spare = 10 * machine.tick / machine.clock_hz
                slowest = max(slowest, (seconds - spare) / ideal - 1)
        except AssertionError as error:
            error.add_note(f"{machine} {fields}")
            raise
        kinds.add((*map(len, ramp_parts(plan)), plan.c.cruise_ticks > 0))
        made += 1
    print(f"{made} moves of {len(kinds)} kinds, distance to {worst:.6f} substeps", end=", ")
    print(f"at most {slowest * 100:.3f} % longer than the ideal and 10 ticks")
    assert slowest < 0.002
    assert len(kinds) >= 10


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"jerk": 0}, "NO_JERK"),
        ({"acceleration": 0}, "NO_ACCELERATION"),
        ({"speed": 0}, "NO_SPEED"),
        ({"speed": 2**64 - 1}, "TOO_FAST"),
        ({"start_speed": q32(40_001)}, "START_ABOVE_SPEED"),
        ({"stop_speed": q32(40_001)}, "STOP_ABOVE_SPEED"),
        ({"jerk": 1}, "TOO_LONG"),
        ({"acceleration": 1}, "TOO_LONG"),
        ({"steps": (0, 0)}, "NO_STEPS"),
    ],
)
def test_refusals(c: Any, changes: dict, name: str) -> None:
    assert refused(c, lambda c: jerk(c, Machine(), **changes)) == name


@pytest.mark.parametrize("ends", [("start_speed",), ("stop_speed",), ("start_speed", "stop_speed")])
def test_a_move_that_is_fast_already(c: Any, ends: tuple[str, ...]) -> None:
    """It begins or ends at its speed, and has it all the way between: only the other end has a ramp."""
    plan = jerk(c, Machine(), **{"start_speed": 0, "stop_speed": 0, **dict.fromkeys(ends, GOOD["speed"])})
    assert float(speed_of(plan, plan.c.velocity_peak)) == pytest.approx(40_000, rel=1e-4)
    assert (plan.c.accelerate_ticks == 0) == ("start_speed" in ends)
    assert (plan.c.decelerate_ticks == 0) == ("stop_speed" in ends)
