# SPDX-License-Identifier: MIT
"""Sigmoid S-curves by three frequencies and two ramp times, and the tables for any alpha."""

import math
import random
from decimal import Decimal, localcontext
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from passo.native import ffi

from tests.helpers import core_steps
from tests.helpers.core_steps import step_errors
from tests.helpers.plan_checks import check_plan
from tests.helpers.plans import (
    SIGMOID,
    SUBSTEPS_MAX,
    Machine,
    Plan,
    PlanError,
    make_move,
    q32,
    refused,
    speed_of,
)
from tests.helpers.random_plans import MOVES, SEED, log_uniform, some_machine, some_steps

ALPHA = 4096
GOOD = {
    "steps": (8000,),
    "start_speed": q32(400),
    "speed": q32(5000),
    "stop_speed": q32(400),
    "accelerate_clocks": 16_000_000,
    "decelerate_clocks": 16_000_000,
    "alpha": 5 * ALPHA,
}


def table_of(c: Any, alpha: int) -> list[int]:
    table = ffi().new("uint16_t[256]")
    assert c.passo_sigmoid_table(alpha, table) == 0
    return list(table)


def exact_curve(alpha: int) -> list[tuple[Decimal, Decimal]]:
    """At each point, with fifty decimals: the scaled logistic function, and its integral in points."""
    with localcontext() as context:
        context.prec = 50
        a = Decimal(alpha) / ALPHA

        def logistic(x: Decimal) -> Decimal:
            return 1 / (1 + (-x).exp())

        low, high = logistic(-a), logistic(a)
        curve = []
        for k in range(257):
            u = Decimal(k) / 256
            x = a * (2 * u - 1)
            area = ((1 + x.exp()).ln() - (1 + (-a).exp()).ln()) / (2 * a)
            curve.append(
                ((logistic(x) - low) / (high - low) * 65536, (area - low * u) / (high - low) * 65536 * 256)
            )
        return curve


def test_tables(c: Any) -> None:
    """Every point of every alpha is within 2 of the curve, the area below the lines to it within 1.5
    units of a point (0.002 of 6,400 steps), and the table is symmetric; alpha 5 is the table after reset."""
    rng = random.Random(f"{SEED} alpha")
    assert table_of(c, 5 * ALPHA) == core_steps.tables()[SIGMOID][:256]
    for alpha in {3 * ALPHA, 4 * ALPHA, 5 * ALPHA, *(rng.randint(3 * ALPHA, 5 * ALPHA) for _ in range(40))}:
        table = [*table_of(c, alpha), 65536]
        area = 0.0
        for k, (value, wanted) in enumerate(exact_curve(alpha)):
            area += (table[k - 1] + table[k]) / 2 if k else 0
            assert abs(table[k] - value) < 2 and abs(area - float(wanted)) < 1.5, (alpha, k)
        assert all(table[k] + table[256 - k] == 65536 for k in range(257))
    for alpha in range(3 * ALPHA, 5 * ALPHA + 1, 7):
        table = table_of(c, alpha)
        assert table[0] == 0 and all(a < b for a, b in pairwise(table))
    for alpha in (0, 3 * ALPHA - 1, 5 * ALPHA + 1, 2**32 - 1):
        error = c.passo_sigmoid_table(alpha, ffi().new("uint16_t[256]"))
        assert ffi().string(c.passo_plan_error_name(error)) == b"BAD_ALPHA"


def sigmoid(c: Any, machine: Machine, **changes: Any) -> Plan:
    return make_move(c, machine, "sigmoid", {**GOOD, **changes})


@pytest.mark.parametrize("alpha", [3 * ALPHA, 4 * ALPHA + 1, 5 * ALPHA])
def test_400_hz_to_5_khz_and_back(c: Any, monkeypatch: pytest.MonkeyPatch, alpha: int) -> None:
    """One second each way; the frequencies, the way to stop and each step's place, whatever the alpha."""
    machine = Machine(16_000_000)
    plan = sigmoid(c, machine, alpha=alpha)
    assert plan.c.sigmoid_alpha == alpha
    with monkeypatch.context() as patched:
        tables = list(core_steps.tables())
        tables[SIGMOID] = [*table_of(c, alpha), 65536]
        patched.setattr(core_steps, "tables", lambda: tables)
        original = core_steps.shape_integral
        patched.setattr(
            core_steps,
            "shape_integral",
            lambda s, m, u: integral(alpha / ALPHA, u) if s == SIGMOID else original(s, m, u),
        )
        check_plan(plan, (8000,), SIGMOID)
        error = np.abs(step_errors(plan)).max()
    p = plan.c
    assert p.accelerate_ticks == p.decelerate_ticks == 16_000_000 // 128
    # 2 x 2700 steps in the ramps, 2600 at full speed
    assert abs(p.steps_to_stop - 2700) <= 1
    wanted = {400: p.velocity_start, 5000: p.velocity_peak, -400: p.velocity_stop}
    ppm = {f: float(speed_of(plan, v) / abs(f) - 1) * 1e6 for f, v in wanted.items()}
    print(f"alpha {alpha / ALPHA:.4f}: steps within {error:.5f} of the curve,", end=" ")
    print(", ".join(f"{abs(f)} Hz {value:+.4f} ppm" for f, value in ppm.items()))
    assert all(-10 < value <= 0 for value in ppm.values())
    assert error < 0.02


def integral(a: float, u: np.ndarray) -> np.ndarray:
    """Of the scaled logistic function, from 0 to u."""
    low, high = 1 / (1 + math.exp(a)), 1 / (1 + math.exp(-a))
    area = (np.logaddexp(0, a * (2 * u - 1)) - np.logaddexp(0, -a)) / (2 * a)
    return (area - u * low) / (high - low)


def test_separate_ramps(c: Any) -> None:
    """0.25 s up, 2 s down, from 200 to 800 Hz: three frequencies, two times."""
    machine = Machine(4_000_000)
    plan = sigmoid(
        c,
        machine,
        steps=(20_000, -3),
        start_speed=q32(200),
        stop_speed=q32(800),
        accelerate_clocks=1_000_000,
        decelerate_clocks=8_000_000,
    )
    check_plan(plan, (20_000, -3), SIGMOID)
    p = plan.c
    assert (p.accelerate_ticks, p.decelerate_ticks) == (math.ceil(1e6 / 128), 8_000_000 // 128)
    assert abs(p.steps_to_stop - (5000 + 800) / 2 * 2) < 2
    for velocity, speed in ((p.velocity_start, 200), (p.velocity_peak, 5000), (p.velocity_stop, 800)):
        assert speed * (1 - Fraction(1, 50_000)) < speed_of(plan, velocity) <= speed


def test_random_moves(c: Any) -> None:
    """Also those too short for their ramps: no frequency is exceeded, nor the ramps' mean acceleration."""
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} sigmoid")
    worst, made, short = 0.0, 0, 0
    while made < MOVES:
        machine = some_machine(rng)
        speed = log_uniform(rng, 0.1, machine.clock_hz / 2.01)
        up, down = (log_uniform(rng, 1e-5, 100) for _ in range(2))
        steps = max(1, min(SUBSTEPS_MAX, int(speed * log_uniform(rng, 1e-5, 300))))
        fields = {
            "steps": some_steps(rng, steps),
            "start_speed": rng.choice((0, q32(speed), q32(speed * rng.random()))),
            "speed": q32(speed),
            "stop_speed": rng.choice((0, q32(speed), q32(speed * rng.random()))),
            "accelerate_clocks": int(up * machine.clock_hz) + 1,
            "decelerate_clocks": int(down * machine.clock_hz) + 1,
            "alpha": 5 * ALPHA,
        }
        try:
            plan = sigmoid(c, machine, **fields)
        except PlanError as error:
            assert str(error) == "TOO_LONG", fields
            continue
        worst = max(worst, abs(float(check_plan(plan, fields["steps"], SIGMOID))))
        p = plan.c
        assert speed_of(plan, p.velocity_peak) <= Fraction(fields["speed"], 1 << 32)
        if p.accelerate_ticks:
            change = speed_of(plan, p.velocity_peak - p.velocity_start - 1) * (1 << 32)
            full = fields["speed"] - fields["start_speed"]
            assert change / full <= Fraction(p.accelerate_ticks * machine.tick, fields["accelerate_clocks"])
        short += p.cruise_ticks == 0
        made += 1
    print(f"{made} moves, {short} without cruise, distance to {worst:.6f} substeps")
    assert short > made // 20


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"alpha": 3 * ALPHA - 1}, "BAD_ALPHA"),
        ({"alpha": 5 * ALPHA + 1}, "BAD_ALPHA"),
        ({"accelerate_clocks": 0}, "NO_ACCELERATION"),
        ({"decelerate_clocks": 0}, "NO_ACCELERATION"),
        ({"start_speed": q32(5001)}, "START_ABOVE_SPEED"),
        ({"stop_speed": q32(5001)}, "STOP_ABOVE_SPEED"),
        ({"speed": 0}, "NO_SPEED"),
        ({"speed": 2**64 - 1}, "TOO_FAST"),
        ({"decelerate_clocks": 2**64 - 1}, "TOO_LONG"),
        ({"steps": (0,)}, "NO_STEPS"),
    ],
)
def test_refusals(c: Any, changes: dict, name: str) -> None:
    assert refused(c, lambda c: sigmoid(c, Machine(), **changes)) == name
