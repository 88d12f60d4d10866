# SPDX-License-Identifier: MIT
"""User-defined shapes, symmetric or not, and the check of their tables."""

import math
import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from passo.native import ffi
from passo.registers import Shape

from tests.helpers.plan_checks import DISTANCE_TOLERANCE
from tests.helpers.plans import (
    COSINE,
    EASE,
    GOOD_BY_SPEED,
    GOOD_IN_TIME,
    HALF,
    SIGMOID,
    UNIT,
    BySpeed,
    InTime,
    Machine,
    Plan,
    make,
    q32,
    refused,
    speed_of,
)
from tests.helpers.random_plans import MOVES, SEED, log_uniform, some_steps

SHAPES: dict[str, Callable[[float], float]] = {
    "linear": lambda u: u,
    "cubic": lambda u: u**3,
    "root": math.sqrt,
    "smooth": lambda u: u * u * (3 - 2 * u),
    "late": lambda u: max(0.0, 8 * u - 7),
    "early": lambda u: min(1.0, 8 * u),
    "step": lambda u: float(u > 0.3),
    "stairs": lambda u: math.floor(5 * u) / 5,
}


def points(shape: Callable[[float], float]) -> list[int]:
    return [min(65535, round(65536 * shape(k / 256))) for k in range(256)]


def mean(table: list[int]) -> Fraction:
    """Of the straight lines between the points."""
    whole = [*table, 65536]
    return Fraction(sum(whole[:-1]) + sum(whole[1:]), 2 * 256 * 65536)


@pytest.mark.parametrize("name", SHAPES)
def test_facts(c: Any, name: str) -> None:
    facts = ffi().new("struct passo_table_facts *")
    table = points(SHAPES[name])
    assert c.passo_table_check(table, facts) == 0
    assert Fraction(facts.mean, 2**24) == mean(table)
    whole = [*table, 65536]
    assert facts.symmetric == all(whole[k] + whole[256 - k] == 65536 for k in range(257))


def test_random_facts(c: Any) -> None:
    rng = random.Random(f"{SEED} facts")
    facts = ffi().new("struct passo_table_facts *")
    for _ in range(200):
        table = [0, *sorted(rng.randrange(65536) for _ in range(255))]
        assert c.passo_table_check(table, facts) == 0
        assert Fraction(facts.mean, 2**24) == mean(table)
        assert not facts.symmetric
        k = rng.randrange(2, 256)
        table[k] = table[k - 1] - 1 if table[k - 1] else 0
        falls = table[k] < table[k - 1]
        error = c.passo_table_check(table, facts)
        assert ffi().string(c.passo_plan_error_name(error)) == (b"TABLE_FALLS" if falls else b"OK")
        assert facts.worst == (k if falls else 0)
    error = c.passo_table_check([1, *[5] * 255], facts)
    assert ffi().string(c.passo_plan_error_name(error)) == b"TABLE_START"


def plan_user(
    c: Any,
    machine: Machine,
    move: InTime | BySpeed,
    table: list[int],
    bank: int = SIGMOID,
    forward: bool = False,
) -> Plan:
    kind = "in_time" if isinstance(move, InTime) else "by_speed"
    kept = ffi().new("uint16_t[256]", table)
    shape = ffi().new("struct passo_user_shape *", {"bank": bank, "table": kept, "forward": forward})
    fields = {**vars(move), "steps": list(move.steps)}
    return make(c, machine, len(move.steps), f"user_{kind}", f"passo_move_{kind}", fields, shape)


def distance(plan: Plan, table: list[int]) -> Fraction:
    """Substeps under the ramps as the core makes them with this table, summed tick by tick."""
    whole, total = [*table, 65536], 0

    def value(u: int) -> int:
        k, f = u >> 41, ((u & (1 << 41) - 1) + (1 << 16)) >> 17
        return ((whole[k] << 24) + (whole[k + 1] - whole[k]) * f + (1 << 15)) >> 16

    for ramp in plan.ramps:
        if ramp.shape == 0:
            total += ramp.ticks * ramp.velocity_end
            continue
        for tick in range(ramp.ticks):
            u, start, end = (2 * tick + 1) * ramp.progress_step, ramp.velocity_start, ramp.velocity_end
            if ramp.mirror:
                u, start, end = (1 << 49) - 1 - u, end, start
            total += start + ((end - start) * value(u) >> 24)
    return Fraction(total * plan.machine.tick, 1 << 48)


def check(plan: Plan, table: list[int], bank: int = SIGMOID, forward: bool = False) -> float:
    """The ramps cover M; acceleration follows the shape, deceleration its mirror image, or the shape too."""
    p = plan.c
    for ramp in plan.ramps:
        change = ramp.velocity_end - ramp.velocity_start
        assert ramp.mirror == (ramp.shape != 0 and change < 0 and not forward)
        assert ramp.shape == (bank if ramp.ticks and change else ramp.shape)
    assert max(ramp.velocity_end for ramp in plan.ramps) == p.velocity_peak <= HALF
    error = abs(distance(plan, table) - plan.substeps)
    assert error < DISTANCE_TOLERANCE, float(error)
    return float(error)


@pytest.mark.parametrize("name", SHAPES)
def test_exact_time_and_distance(c: Any, name: str) -> None:
    """Whatever the shape, from one tick to thousands: n steps in the time, to a fifth of a substep."""
    machine, table, worst = Machine(), points(SHAPES[name]), 0.0
    for ramp in (1, 2, 3, 7, 50, 127, 128, 129, 255, 256, 257, 1000, 4096, 5000):
        for cruise in (0, 1, 300):
            ticks = 2 * ramp + cruise
            move = InTime((3 * ticks, -1), 0, ticks * 128, ramp * 128)
            if mean(table) < Fraction(1, 10) and ramp < 50:  # hardly anything under the ramps
                continue
            plan = plan_user(c, machine, move, table)
            assert plan.ticks == ticks and plan.c.accelerate_ticks == plan.c.decelerate_ticks == ramp
            worst = max(worst, check(plan, table))
            m = mean(table)
            f_max = Fraction(3 * ticks * machine.clock_hz) / ((cruise + 2 * ramp * m) * 128)
            if ramp >= 1000:
                assert abs(speed_of(plan, plan.c.velocity_peak) / f_max - 1) < 1e-3
    print(f"{name}: mean {float(mean(table)):.6f}, distance to {worst:.6f} substeps")


def test_mirrored_ramps_are_mirror_images(c: Any) -> None:
    table = points(SHAPES["cubic"])
    plan = plan_user(c, Machine(), InTime((4000,), 0, 200_000, 80_000), table)
    up, _, down = plan.ramps
    assert (up.ticks, down.ticks) == (625, 625) and down.mirror and not up.mirror
    assert plan.c.steps_to_stop == round(
        float(up.velocity_end * 625 * 128 * mean(table)) / 2**48 / plan.c.oversampling
    )


@pytest.mark.parametrize("name", SHAPES)
def test_forward_ramps_are_exact_too(c: Any, name: str) -> None:
    """Both ramps follow the table; the number of steps, the time and the limits are kept."""
    table = points(SHAPES[name])
    for ramp in (50, 255, 256, 1000):
        plan = plan_user(c, Machine(), InTime((9 * ramp,), 0, 640 * ramp, 128 * ramp), table, forward=True)
        assert plan.ticks == 5 * ramp
        check(plan, table, forward=True)
    for steps in (300, 20_000):
        move = BySpeed((steps,), 0, q32(10_000), acceleration=q32(100_000))
        plan = plan_user(c, Machine(), move, table, forward=True)
        check(plan, table, forward=True)
        assert speed_of(plan, plan.c.velocity_peak) <= 10_000


def test_random_moves_by_speed(c: Any) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} user")
    worst = 0.0
    for _ in range(MOVES // 3):
        machine = Machine(100_000_000, rng.choice((7, 8)))
        table = points(SHAPES[rng.choice(list(SHAPES))])
        if rng.random() < 0.5:
            table = [0, *sorted(rng.randrange(65536) for _ in range(255))]
        bank = rng.choice((COSINE, SIGMOID, EASE))
        speed = log_uniform(rng, 1000, 4e7)
        ends = [q32(speed * rng.choice((0, 0.1, rng.random(), 1))) for _ in range(2)]
        ramp = int(log_uniform(rng, 100, 400_000))
        steps = max(1, int(speed * log_uniform(rng, 1e-6, 2e-2)))
        move = BySpeed(some_steps(rng, steps), 0, q32(speed), *ends, ramp_clocks=ramp)
        plan = plan_user(c, machine, move, table, bank)
        try:
            worst = max(worst, check(plan, table, bank))
            assert speed_of(plan, plan.c.velocity_peak) <= Fraction(move.speed, UNIT)
        except AssertionError as error:
            error.add_note(f"{machine} {move}")
            raise
    print(f"distance to {worst:.6f} substeps")


@pytest.mark.parametrize(
    ("bank", "table", "name"),
    [
        (0, points(SHAPES["cubic"]), "BAD_BANK"),
        (len(Shape), points(SHAPES["cubic"]), "BAD_BANK"),
        (2, [1] * 256, "TABLE_START"),
        (2, [0, 2, 1, *[5] * 253], "TABLE_FALLS"),
    ],
)
def test_refusals(c: Any, bank: int, table: list[int], name: str) -> None:
    for move in (GOOD_IN_TIME, GOOD_BY_SPEED):
        assert refused(c, lambda c, move=move: plan_user(c, Machine(), move, table, bank)) == name


def integral(table: list[int], end: Fraction) -> Fraction:
    """Of the straight lines between the points, from 0 to `end`."""
    whole, place = [*table, 65536], end * 256
    k = min(math.floor(place), 255)
    part = place - k
    value = whole[k] + (whole[k + 1] - whole[k]) * part
    area = Fraction(sum(whole[:k]) + sum(whole[1 : k + 1]), 2) + (whole[k] + value) / 2 * part
    return area / (256 * 65536)


@pytest.mark.parametrize("name", ["linear", "cubic", "root"])
@pytest.mark.parametrize("ticks", [2**20 + 1, 2**24 - 1, 2**24 + 1, 2**25 + 1, 2**31])
def test_long_ramps(c: Any, name: str, ticks: int) -> None:
    """Their progress does not end at exactly 1, which the weight of the peak must allow for."""
    table = points(SHAPES[name])
    plan = plan_user(c, Machine(), InTime((12_345_678,), 0, 2 * ticks * 128, ticks * 128), table)
    (up, down), peak = plan.ramps, plan.c.velocity_peak
    assert (up.ticks, down.ticks) == (ticks, ticks)
    end = Fraction(ticks * up.progress_step, 1 << 48)
    # The last ticks may be beyond 1, where the shape goes on as straight as it came.
    beyond = max(Fraction(0), end - 1)
    rising = integral(table, end - beyond) + beyond
    mirrored = end - beyond - mean(table) + integral(table, 1 - end + beyond) + beyond
    weight = (rising + end - mirrored) / end * ticks
    assert abs(peak * weight * 128 / 2**48 - plan.substeps) < Fraction(1, 5)
