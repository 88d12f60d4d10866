# SPDX-License-Identifier: MIT
"""The planner against an independent derivation.

helpers/core_steps.py computes how the core executes a plan; the requirements of a plan are checked with exact
fractions here and in helpers/plan_checks.py. PASSO_SEED is the seed of the random moves, PASSO_MOVES their
number.
"""

import math
import random
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from passo import random_cases
from passo.native import ffi

from tests.helpers.core_steps import (
    curve_deviation,
    ideal_path,
    load_generator,
    run_clock_by_clock,
    step_substeps,
    substep_clocks,
    tables,
)
from tests.helpers.plan_checks import check_distance, check_structure, round_half_up
from tests.helpers.plans import (
    COSINE,
    EASE,
    GOOD_BY_SPEED,
    GOOD_IN_TIME,
    JERK,
    LINEAR,
    MOVE_CLOCKS,
    ONE,
    PROFILES,
    SIGMOID,
    SUBSTEPS_MAX,
    UNIT,
    BySpeed,
    InTime,
    Machine,
    Plan,
    PlanError,
    make_plan,
    q32,
    refused,
)
from tests.helpers.random_plans import SEED, log_uniform, some_machine, some_steps

MOVES = random_cases.moves(2000)
PHASE_TICKS = 1 << 32


# ---------------------------------------------------------------------------- requirements of a plan ----


def check_in_time(plan: Plan, move: InTime) -> None:
    p, machine = plan.c, plan.machine
    total = round_half_up(Fraction(move.total_clocks, machine.tick))
    ramp = round_half_up(Fraction(move.ramp_clocks, machine.tick))
    if move.profile == JERK:
        ramp += ramp % 2
    while 2 * ramp > total:
        ramp -= 2 if move.profile == JERK else 1
    assert (p.accelerate_ticks, p.decelerate_ticks) == (ramp, ramp)
    assert plan.ticks == total

    clocks = (total - ramp) * machine.tick
    longest = max(map(abs, move.steps))
    fit = min(clocks // (2 * longest), SUBSTEPS_MAX // longest)
    assert p.oversampling == (fit if fit < 2 else fit - fit % 2)
    # f_max = n / (total - ramp), to the nearest 2^-48
    assert abs(p.velocity_peak - Fraction(plan.substeps * ONE, clocks)) <= Fraction(1, 2)


@dataclass(frozen=True)
class Ideal:
    """A move by speed without ticks and rounding. Times in clocks, speeds as in BySpeed."""

    peak: float
    peak_tolerance: float  # the planner rounds the ramp time to whole clocks
    accelerate: float
    cruise: float
    decelerate: float

    @property
    def clocks(self) -> float:
        return self.accelerate + self.cruise + self.decelerate


def ideal_move(machine: Machine, move: BySpeed) -> Ideal:
    """The fastest move within the limits."""

    def slope(acceleration: int, change: int) -> float:
        """Change of speed per clock."""
        if change == 0:
            return math.inf
        return acceleration / machine.clock_hz if acceleration else change / move.ramp_clocks

    f, f0, f1 = map(float, (move.speed, move.start_speed, move.stop_speed))
    a = slope(move.acceleration, move.speed - move.start_speed)
    d = slope(move.deceleration or move.acceleration, move.speed - move.stop_speed)
    length = float(max(map(abs, move.steps)) * machine.clock_hz * UNIT)

    def way(change_from: float, peak: float, slope: float) -> float:
        return (peak - change_from) * (peak + change_from) / 2 / slope

    def reach(a: float, d: float, f0: float, f1: float, limit: float) -> float:
        if way(f0, limit, a) + way(f1, limit, d) <= length:
            return limit
        return math.sqrt((2 * length + f0 * f0 / a + f1 * f1 / d) / (1 / a + 1 / d))

    peak = reach(a, d, f0, f1, f)
    if peak < f0:
        f0 = peak = reach(math.inf, d, 0, f1, f0)
    elif peak < f1:
        f1 = peak = reach(a, math.inf, f0, 0, f1)
    rest = max(0.0, length - way(f0, peak, a) - way(f1, peak, d))
    tolerance = 1e-4 + 2 / (1 + f / a + f / d)
    return Ideal(peak, tolerance, (peak - f0) / a, rest / peak, (peak - f1) / d)


def check_by_speed(plan: Plan, move: BySpeed) -> None:
    p, machine = plan.c, plan.machine
    scale = Fraction(p.oversampling * (ONE // UNIT), machine.clock_hz)  # speed -> velocity

    # Speed, start and stop speed are never exceeded; ramps start and end at them, rounded down to 2^-48.
    assert p.velocity_peak <= move.speed * scale
    for velocity, ticks, limit in (
        (p.velocity_start, p.accelerate_ticks, move.start_speed),
        (p.velocity_stop, p.decelerate_ticks, move.stop_speed),
    ):
        assert velocity <= limit * scale
        if ticks:
            assert limit * scale - 1 < velocity <= p.velocity_peak

    # Acceleration neither; its ramp may gain the 2^-48 that its lower end was rounded down.
    for velocity, ticks, limit, acceleration in (
        (p.velocity_start, p.accelerate_ticks, move.start_speed, move.acceleration),
        (p.velocity_stop, p.decelerate_ticks, move.stop_speed, move.deceleration or move.acceleration),
    ):
        if ticks:
            change = move.speed - limit
            slope = (
                Fraction(acceleration, machine.clock_hz)
                if acceleration
                else Fraction(change, move.ramp_clocks)
            )
            assert p.velocity_peak - velocity < slope * ticks * machine.tick * scale + 1

    # With a clear cruise phase, the ramps are the exact ones, rounded up.
    ideal = ideal_move(machine, move)
    if ideal.cruise > 1 + ideal.clocks * 1e-6:
        for ticks, limit, acceleration in (
            (p.accelerate_ticks, move.start_speed, move.acceleration),
            (p.decelerate_ticks, move.stop_speed, move.deceleration or move.acceleration),
        ):
            change = move.speed - limit
            clocks = Fraction(change * machine.clock_hz, acceleration) if acceleration else move.ramp_clocks
            exact = math.ceil(clocks / Fraction(machine.tick)) if change else 0
            if ticks or p.velocity_peak >= limit * scale:
                assert ticks == exact + (exact % 2 if move.profile == JERK else 0)

    # As fast as that allows: each phase may be longer by rounding up to ticks, and slightly by other
    # rounding. It can be faster only by what progress lacks at the end of very long ramps.
    spare = 6 if move.profile == JERK else 4
    lack = max(p.accelerate_ticks, p.decelerate_ticks) / ONE
    assert plan.ticks >= ideal.clocks / machine.tick * (1 - 1e-9 - lack)
    assert plan.ticks <= ideal.clocks / machine.tick * (1 + 1e-4) + spare

    # K as large as peak and M allow.
    longest = max(map(abs, move.steps))
    highest = ideal.peak * (1 + ideal.peak_tolerance)
    more = p.oversampling + (1 if p.oversampling == 1 else 2)
    assert more * longest > SUBSTEPS_MAX or more * highest / UNIT > machine.clock_hz / 2


def check(plan: Plan, move: InTime | BySpeed) -> Fraction:
    check_structure(plan, move)
    if isinstance(move, InTime):
        check_in_time(plan, move)
    else:
        check_by_speed(plan, move)
    return check_distance(plan)


def length(machine: Machine, move: InTime | BySpeed) -> float:
    """How long a move is, as a part of what is too long: a phase of 2^32 ticks or a move of 2^44 clocks."""
    if isinstance(move, InTime):
        total, ramp = (clocks / machine.tick for clocks in (move.total_clocks, move.ramp_clocks))
        phases = [ramp, total - 2 * ramp]
    else:
        ideal = ideal_move(machine, move)
        total, *phases = (
            clocks / machine.tick
            for clocks in (ideal.clocks, ideal.accelerate, ideal.cruise, ideal.decelerate)
        )
    return max(max(phases) / PHASE_TICKS, total * machine.tick / MOVE_CLOCKS)


def plan_and_check(c: Any, machine: Machine, move: InTime | BySpeed) -> Fraction:
    try:
        return check(make_plan(c, machine, move), move)
    except (AssertionError, PlanError) as error:
        error.add_note(f"{machine}\n{move}")
        raise


# ------------------------------------------------------------------------------------------ random moves ----


def some_in_time(rng: random.Random, machine: Machine) -> InTime:
    total = int(log_uniform(rng, machine.tick, min(2**40, MOVE_CLOCKS - 1)))
    ramp = rng.choice((0, total // 2, rng.randint(0, total // 2), int(log_uniform(rng, 1, total + 1)) // 2))
    fastest = max(1, (total - ramp - 2 * machine.tick) // 2)
    longest = min(SUBSTEPS_MAX, rng.choice((1, fastest, int(log_uniform(rng, 1, fastest + 1)))))
    return InTime(some_steps(rng, longest), rng.choice(PROFILES), total, ramp)


def some_by_speed(rng: random.Random, machine: Machine) -> BySpeed:
    speed = rng.choice(
        (int(log_uniform(rng, 1 / 60, machine.clock_hz / 2) * UNIT), machine.clock_hz * UNIT // 2)
    )

    def end_speed() -> int:
        return rng.choice((0, 0, speed, rng.randint(0, speed), int(log_uniform(rng, 1, speed))))

    def acceleration() -> int:
        seconds = log_uniform(rng, 1e-7, 1e3)  # from rest to speed
        return max(1, min(2**64 - 1, int(speed / seconds)))

    duration = log_uniform(rng, 1e-6, 1e3)
    longest = min(SUBSTEPS_MAX, max(1, int(speed * duration / UNIT)))
    ramps = rng.choice(
        (
            {"acceleration": acceleration()},
            {"acceleration": acceleration(), "deceleration": acceleration()},
            {"ramp_clocks": int(log_uniform(rng, 1, 1e3 * machine.clock_hz))},
            {"ramp_clocks": int(log_uniform(rng, 1, 1e3 * machine.clock_hz)), "deceleration": acceleration()},
        )
    )
    profile = rng.choice(PROFILES)
    return BySpeed(some_steps(rng, longest), profile, speed, end_speed(), end_speed(), **ramps)


@pytest.mark.parametrize("form", ["in_time", "by_speed"])
def test_random_moves(c: Any, form: str) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} {form}")
    some = some_in_time if form == "in_time" else some_by_speed
    errors = []
    while len(errors) < MOVES:
        machine = some_machine(rng)
        move = some(rng, machine)
        if length(machine, move) > 1.001:
            with pytest.raises(PlanError, match="TOO_LONG"):
                make_plan(c, machine, move)
        elif length(machine, move) < 0.999:
            errors.append(abs(float(plan_and_check(c, machine, move))))
    errors.sort()
    print(f"distance errors of {MOVES} moves in substeps:")
    for part in (50, 90, 99, 99.9, 100):
        print(f"  {part:5} % up to {errors[math.ceil(part / 100 * MOVES) - 1]:.6f}")


# ---------------------------------------------------------------------------------------- directed moves ----


def test_ramps_of_half_the_time(c: Any) -> None:
    """For any times and ticks, the ramps fit and the time is exact."""
    machine = Machine()
    for profile, total in product(PROFILES, range(machine.tick, 20 * machine.tick, 5)):
        for ramp in {total // 2, total // 2 - 1, total // 3, 0}:
            plan_and_check(c, machine, InTime((3,), profile, total, max(0, ramp)))


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("ticks", [2**24 - 2, 2**24, 2**24 + 2, 2**25 + 4, 2**32 - 2])
@pytest.mark.parametrize("steps", [1, 12_345_678])
def test_long_equal_ramps(c: Any, steps: int, ticks: int, profile: int) -> None:
    machine = Machine()
    move = InTime((steps, 1), profile, 3 * ticks * machine.tick, ticks * machine.tick)
    assert abs(plan_and_check(c, machine, move)) < Fraction(1, 100)


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("seconds", [0.01, 0.1, 1.0])
def test_unequal_ramps(c: Any, seconds: float, profile: int) -> None:
    """Full speed is half the clock, so the error in substeps is as large as it gets."""
    machine = Machine()
    speed = q32(machine.clock_hz / 2 / 2)
    up, down = int(speed / seconds), int(speed / seconds * 0.7)
    move = BySpeed((SUBSTEPS_MAX // 2, 1), profile, speed, q32(1000), 0, up, down)
    error = plan_and_check(c, machine, move)
    print(f"{seconds} s: {float(error):.6f} substeps")


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("steps", [1, SUBSTEPS_MAX])
def test_two_days(c: Any, steps: int, profile: int) -> None:
    machine = Machine(tick_log2=16)
    total = MOVE_CLOCKS - machine.tick
    for ramp in (0, total // 3, total // 2):
        plan_and_check(c, machine, InTime((steps,), profile, total, ramp))


def test_half_the_clock(c: Any) -> None:
    machine, longest = Machine(), SUBSTEPS_MAX
    jump = InTime((longest, -longest, 1), LINEAR, 2**31, 0)
    assert abs(plan_and_check(c, machine, jump)) < Fraction(1, 1000)
    assert make_plan(c, machine, jump).c.oversampling == 1
    speed = machine.clock_hz * UNIT // 2
    for profile, start, acceleration in product(PROFILES, (0, speed // 2, speed), (q32(1e5), q32(4e9))):
        for steps in (1, 64, 65, 1_000_000, longest):
            plan_and_check(c, machine, BySpeed((steps,), profile, speed, start, start, acceleration))
    for steps, name in ((64, ""), (65, "TOO_FAST")):
        assert refused(c, make_plan, machine, InTime((steps,), LINEAR, machine.tick, 0)) == name
    assert refused(c, make_plan, machine, BySpeed((9,), LINEAR, speed + 1, acceleration=1)) == "TOO_FAST"


def test_one_step_per_minute(c: Any) -> None:
    for clock_hz, profile, steps in product((1_000_000, 100_000_000), PROFILES, (1, 5, 60)):
        speed = q32(1 / 60)
        for ends in (0, speed // 2, speed):
            move = BySpeed((steps, 1, 0), profile, speed, ends, ends, acceleration=q32(1e-3))
            plan_and_check(c, Machine(clock_hz, 10), move)


def test_short_moves(c: Any) -> None:
    """A few steps, a few ticks: cases in which rounding to ticks could invert the ramps."""
    machine = Machine()
    seen = set()
    for profile, speed, acceleration, deceleration in product(
        PROFILES,
        (1_000, 200_000, 30_000_000),
        (50_000, 10_000_000, 4_000_000_000),
        (0, 70_000, 4_000_000_000),
    ):
        for start, stop, steps in product((0, 1, 0.3, 0.999, 1), (0, 0.5, 1), (1, 2, 3, 7, 20, 100)):
            ends = q32(speed * start), q32(speed * stop)
            move = BySpeed((steps,), profile, q32(speed), *ends, q32(acceleration), q32(deceleration))
            plan = make_plan(c, machine, move)
            check(plan, move)
            seen.add(
                tuple(n > 0 for n in (plan.c.accelerate_ticks, plan.c.cruise_ticks, plan.c.decelerate_ticks))
            )
    assert len(seen) == 7, "all phases, alone and together"


def test_triangle_has_no_cruise(c: Any) -> None:
    """f_p^2 = (2 a d L + d f_0^2 + a f_1^2) / (a + d)"""
    machine, a, d, f0, f1, length = Machine(), 200_000, 100_000, 500, 300, 4_000
    move = BySpeed((length, 17), COSINE, q32(1e6), q32(f0), q32(f1), q32(a), q32(d))
    plan = make_plan(c, machine, move)
    check(plan, move)
    peak = math.sqrt((2 * a * d * length + d * f0**2 + a * f1**2) / (a + d))
    assert plan.c.accelerate_ticks == math.ceil((peak - f0) / a * machine.clock_hz / machine.tick)
    assert plan.c.decelerate_ticks == math.ceil((peak - f1) / d * machine.clock_hz / machine.tick)
    assert plan.c.cruise_ticks == 0


def test_ramp_time_instead_of_acceleration(c: Any) -> None:
    machine = Machine()
    speed, ramp = q32(100_000), 3_000_000
    by_time = BySpeed((50_000,), LINEAR, speed, ramp_clocks=ramp)
    by_acceleration = BySpeed((50_000,), LINEAR, speed, acceleration=speed * machine.clock_hz // ramp)
    plans = [make_plan(c, machine, move) for move in (by_time, by_acceleration)]
    for plan, move in zip(plans, (by_time, by_acceleration), strict=True):
        check(plan, move)
    assert plans[0].ramps == plans[1].ramps
    assert plans[0].c.accelerate_ticks == math.ceil(ramp / machine.tick)
    # Too short for full ramps: the same acceleration, less of it.
    short = BySpeed((500,), LINEAR, speed, ramp_clocks=ramp)
    plan = make_plan(c, machine, short)
    check(plan, short)
    assert plan.c.accelerate_ticks < ramp / machine.tick / 2


# ------------------------------------------------------------------------------------------------ errors ----


REFUSED = {
    "BAD_CLOCK": [{"clock_hz": 0}, {"tick_log2": 6}, {"tick_log2": 17}, {"tick_log2": 255}],
    "BAD_PROFILE": [{"profile": len(PROFILES)}, {"profile": 2**32 - 1}],
    "NO_STEPS": [{"steps": (0,)}, {"steps": (0,) * 8}],
    "TOO_MANY_STEPS": [
        {"steps": (SUBSTEPS_MAX + 1,)},
        {"steps": (-SUBSTEPS_MAX - 1,)},
        {"steps": (1, -SUBSTEPS_MAX - 1)},
        {"steps": (2**31 - 1,)},
        {"steps": (1, -(2**31))},
    ],
    "NO_TIME": [{"total_clocks": 0, "ramp_clocks": 0}, {"total_clocks": 127, "ramp_clocks": 0}],
    "RAMP_TOO_LONG": [{"ramp_clocks": 50_001}, {"total_clocks": 2**64 - 1, "ramp_clocks": 2**63}],
    "TOO_LONG": [
        {"total_clocks": 2**44, "tick_log2": 16},
        {"total_clocks": 2**39 + 128, "ramp_clocks": 0},
        {"total_clocks": 2**64 - 1, "ramp_clocks": 0},
        {"total_clocks": 2**64 - 1, "ramp_clocks": 2**63 - 1, "tick_log2": 16},
        {"speed": 1, "start_speed": 0, "stop_speed": 0},
        {"speed": q32(1 / 60), "start_speed": 0, "stop_speed": 0, "steps": (SUBSTEPS_MAX,)},
        {"acceleration": 1, "deceleration": 0},
        {"acceleration": q32(0.01), "steps": (10**9,)},
        {"deceleration": q32(0.01), "steps": (10**9,)},
        {"deceleration": 1},
        {"start_speed": q32(1000) - 1, "stop_speed": q32(1000), "acceleration": 46},
        {"acceleration": 0, "deceleration": 0, "ramp_clocks": 2**64 - 1},
    ],
    "TOO_FAST": [{"total_clocks": 128, "ramp_clocks": 0, "steps": (65,)}, {"speed": q32(5e7) + 1}],
    "NO_SPEED": [{"speed": 0}, {"speed": 0, "start_speed": 0, "stop_speed": 0}],
    "NO_ACCELERATION": [
        {"acceleration": 0, "deceleration": 0},
        {"acceleration": 0, "stop_speed": q32(1000)},
        {"acceleration": 0, "deceleration": 0, "start_speed": q32(1000)},
    ],
    "START_ABOVE_SPEED": [{"start_speed": q32(1000) + 1}, {"start_speed": 2**64 - 1}],
    "STOP_ABOVE_SPEED": [{"stop_speed": q32(1000) + 1}, {"stop_speed": 2**64 - 1}],
}


def test_good_moves_are_planned(c: Any) -> None:
    for move in (GOOD_IN_TIME, GOOD_BY_SPEED):
        plan_and_check(c, Machine(), move)


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(c: Any, name: str) -> None:
    """Each error is returned by every form that can cause it."""
    for changes in REFUSED[name]:
        machine = Machine(**{key: value for key, value in changes.items() if key in vars(Machine())})
        changes = {key: value for key, value in changes.items() if key not in vars(machine)}
        form = None
        if "total_clocks" in changes or name == "RAMP_TOO_LONG":
            form = InTime
        elif {"speed", "start_speed", "stop_speed", "acceleration", "deceleration"} & set(changes):
            form = BySpeed
        for good in (GOOD_IN_TIME, GOOD_BY_SPEED):
            if form in (None, type(good)):
                assert refused(c, make_plan, machine, replace(good, **changes)) == name, (
                    machine,
                    good,
                    changes,
                )


def test_axes_out_of_range(c: Any) -> None:
    for axes in (0, 9, 255):
        machine = ffi().new("struct passo_machine *", (100_000_000, 7, axes))
        in_time = ffi().new("struct passo_move_in_time *", vars(GOOD_IN_TIME))
        by_speed = ffi().new("struct passo_move_by_speed *", vars(GOOD_BY_SPEED))
        assert c.passo_plan_in_time(machine, in_time, ffi().NULL) == c.PASSO_PLAN_BAD_AXES
        assert c.passo_plan_by_speed(machine, by_speed, ffi().NULL) == c.PASSO_PLAN_BAD_AXES


def test_error_names_and_texts(c: Any) -> None:
    errors = ffi().typeof("enum passo_plan_error").relements
    tested = {"PASSO_PLAN_" + name for name in [*REFUSED, "BAD_AXES", "OK"]}
    assert tested <= set(errors), "every error of the first two forms is provoked above"
    texts = set()
    for constant, value in errors.items():
        name = ffi().string(c.passo_plan_error_name(value)).decode()
        text = ffi().string(c.passo_plan_error_text(value)).decode()
        assert constant == "PASSO_PLAN_" + name
        assert text[0].isupper() and text.endswith(".") and len(text) < 80
        texts.add(text)
    assert len(texts) == len(errors)
    for value in (len(errors), 2**32 - 1):
        assert ffi().string(c.passo_plan_error_name(value)) == b"UNKNOWN"
        assert ffi().string(c.passo_plan_error_text(value))


# -------------------------------------------------------------------------------------------- every step ----


def small_move(rng: random.Random, machine: Machine, ticks: int, steps: int) -> InTime | BySpeed:
    """A move of up to `ticks` and `steps`."""
    if rng.random() < 0.5:
        total = int(log_uniform(rng, machine.tick, ticks * machine.tick))
        ramp = rng.choice((0, total // 2, rng.randint(0, total // 2)))
        longest = max(1, min(int(log_uniform(rng, 1, steps)), (total - ramp - 2 * machine.tick) // 2))
        return InTime(some_steps(rng, longest), rng.choice(PROFILES), total, ramp)
    speed = log_uniform(rng, machine.clock_hz / machine.tick / 100, machine.clock_hz / 2)
    seconds = log_uniform(rng, machine.tick, ticks * machine.tick / 6) / machine.clock_hz
    longest = max(1, min(steps, int(speed * seconds)))
    acceleration, deceleration = (q32(speed / seconds * log_uniform(rng, 0.5, 10)) for _ in range(2))
    ends = (q32(speed * rng.choice((0, rng.random(), 1))) for _ in range(2))
    ramps = (min(2**64 - 1, n) for n in (acceleration, deceleration))
    return BySpeed(some_steps(rng, longest), rng.choice(PROFILES), q32(speed), *ends, *ramps)


def test_closed_forms_are_the_recurrences(c: Any) -> None:
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} recurrences")
    for _ in range(60):
        machine = Machine(100_000_000, rng.choice((7, 8)))
        move = small_move(rng, machine, ticks=60, steps=2000)
        plan = make_plan(c, machine, move)
        check(plan, move)
        for axis, clocks in enumerate(run_clock_by_clock(plan)):
            assert len(clocks) == plan.steps[axis]
            if clocks:
                closed = substep_clocks(plan, step_substeps(plan.substeps, plan.steps[axis]))
                assert clocks == closed.tolist(), move


def test_steps_follow_the_curve(c: Any) -> None:
    """Each step of each axis is made when the ideal curve is midway between two steps.

    On the longest axis with even K to a quarter of a substep. Steps of the other axes are made on the next
    substep, up to one substep later; so are all steps with K = 1, where the midpoint is half a substep away.
    """
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} curve")
    limits = {"longest, K even": (-0.25, 0.25), "longest, K = 1": (0.25, 0.75), "others": (-0.25, 1.25)}
    found = dict.fromkeys(limits, (math.inf, -math.inf))
    steps_checked, in_steps = 0, 0.0
    for _ in range(400):
        machine = Machine(100_000_000, rng.choice((7, 7, 9)))
        move = small_move(rng, machine, ticks=1 << 15, steps=20_000)
        plan = make_plan(c, machine, move)
        check(plan, move)
        deviation = curve_deviation(plan) + 0.01  # and rounding of velocities
        for steps in filter(None, plan.steps):
            clocks = substep_clocks(plan, step_substeps(plan.substeps, steps))
            due = (np.arange(1, steps + 1) - 0.5) * plan.substeps / steps
            late = ideal_path(plan, clocks.astype(float)) - due
            kind = "others"
            if steps == max(plan.steps):
                kind = "longest, K even" if plan.c.oversampling > 1 else "longest, K = 1"
            low, high = limits[kind]
            assert low - deviation < late.min() and late.max() < high + deviation, (machine, move)
            if deviation < 0.1:
                found[kind] = min(found[kind][0], late.min()), max(found[kind][1], late.max())
                if kind == "longest, K even":
                    in_steps = max(in_steps, float(np.abs(late).max()) / plan.c.oversampling)
            steps_checked += steps
    print(f"{steps_checked} steps. Where ticks and tables make less than 0.1 substep, substeps late:")
    for kind, (low, high) in found.items():
        print(f"  {kind}: {low:.3f} .. {high:.3f}")
    print(f"  longest, K even: at most {in_steps:.3f} steps")


# ------------------------------------------------------------------------------------------ shape tables ----


def test_tables_are_fresh() -> None:
    for path, text in load_generator().files().items():
        assert path.read_text() == text, f"{path.name} is out of date: run 'make generate'"


def test_table_values() -> None:
    def logistic(x: float) -> float:
        return 1 / (1 + math.exp(-x))

    low, high = logistic(-5), logistic(5)
    shapes = {
        COSINE: lambda u: (1 - math.cos(math.pi * u)) / 2,
        SIGMOID: lambda u: (logistic(10 * u - 5) - low) / (high - low),
        EASE: lambda u: u * u,
    }
    for bank, function in shapes.items():
        for k, point in enumerate(tables()[bank]):
            # the points of S-curves are chosen by the area below them
            assert abs(point - function(k / 256) * 65536) <= (0.5 if bank == EASE else 2) + 1e-9
    for bank in (COSINE, SIGMOID):
        t = tables()[bank]
        assert all(t[k] + t[256 - k] == 65536 for k in range(257))
