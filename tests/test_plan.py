# SPDX-License-Identifier: MIT
"""The planner against an independent derivation.

What the core makes of a plan is worked out here from the recurrences of docs/architecture.md: in Python
integers, in numpy's 64-bit integers or, where ramps have millions of ticks, in closed form. What a plan must
be is worked out in exact fractions. PASSO_SEED is the seed of the random moves, PASSO_MOVES their number.
"""

import importlib.util
import math
import os
import random
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import numpy as np
import pytest
from passo.native import ffi, load
from passo.toolchain import paths

SEED = int(os.environ.get("PASSO_SEED", "1"))
MOVES = int(os.environ.get("PASSO_MOVES", "2000"))

ONE = 1 << 48  # velocities and progress
HALF = 1 << 47
UNIT = 1 << 32  # speeds and accelerations
AXES = 8
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
LINEAR, COSINE, SIGMOID, JERK = range(4)
SHAPE_OF_PROFILE = {LINEAR: 0, COSINE: 1, SIGMOID: 2, JERK: 3}

DISTANCE_TOLERANCE = Fraction(1, 5)  # substeps; the core bears 1/4
LONG_RAMPS = 32  # see progress_bound()
EXACT_TICKS = 1 << 18  # longer ramps are not summed tick by tick
MOVE_CLOCKS = 1 << 44
PHASE_TICKS = 1 << 32


# ------------------------------------------------------------------------------------------------ the planner ----


@pytest.fixture(scope="module")
def c() -> Iterator[Any]:
    """The planner, built so that every use of undefined behaviour is fatal."""
    directory = paths.build / "tests"
    directory.mkdir(parents=True, exist_ok=True)
    library = directory / f"plan-{os.getpid()}.so"
    flags = "-std=c11 -O2 -Wall -Wextra -Wconversion -Werror -fPIC -shared -fsanitize=undefined"
    sources = [paths.c_model / "passo_plan.c", paths.c_model / "passo_math.c"]
    subprocess.run(["gcc", *flags.split(), "-fno-sanitize-recover=all", "-o", library, *sources], check=True)
    yield load(library)
    library.unlink()


@dataclass(frozen=True)
class Machine:
    clock_hz: int = 100_000_000
    tick_log2: int = 7

    @property
    def tick(self) -> int:
        return 1 << self.tick_log2


@dataclass(frozen=True)
class InTime:
    steps: tuple[int, ...]
    profile: int
    total_clocks: int
    ramp_clocks: int


@dataclass(frozen=True)
class BySpeed:
    """Speeds and accelerations in UQ32.32."""

    steps: tuple[int, ...]
    profile: int
    speed: int
    start_speed: int = 0
    stop_speed: int = 0
    acceleration: int = 0
    deceleration: int = 0
    ramp_clocks: int = 0


@dataclass(frozen=True)
class Ramp:
    ticks: int
    shape: int
    mirror: bool
    velocity_start: int
    velocity_end: int
    progress_step: int


@dataclass(frozen=True)
class Plan:
    machine: Machine
    c: Any = field(repr=False)

    @property
    def substeps(self) -> int:
        return self.c.line.substeps

    @property
    def steps(self) -> list[int]:
        return list(self.c.line.steps)

    @property
    def ticks(self) -> int:
        return self.c.accelerate_ticks + self.c.cruise_ticks + self.c.decelerate_ticks

    @property
    def ramps(self) -> list[Ramp]:
        """The ramps with the velocities they start from."""
        result, velocity = [], 0
        for ramp in self.c.ramps[0 : self.c.ramp_count]:
            end = ramp.velocity_end
            result.append(Ramp(ramp.ticks, ramp.shape, ramp.mirror, velocity, end, ramp.progress_step))
            velocity = end
        return result


class PlanError(Exception):
    """The planner refused; the text is the error's name."""


def make_plan(c: Any, machine: Machine, move: InTime | BySpeed) -> Plan:
    ours = ffi().new("struct passo_machine *", (machine.clock_hz, machine.tick_log2, len(move.steps)))
    kind = "in_time" if isinstance(move, InTime) else "by_speed"
    values = {**vars(move), "steps": list(move.steps)}
    plan = ffi().new("struct passo_plan *")
    size = ffi().sizeof("struct passo_plan")
    ffi().memmove(plan, b"\xa5" * size, size)
    error = getattr(c, f"passo_plan_{kind}")(ours, ffi().new(f"struct passo_move_{kind} *", values), plan)
    if error:
        assert bytes(ffi().buffer(plan)) == b"\xa5" * size, "a refused plan was touched"
        raise PlanError(ffi().string(c.passo_plan_error_name(error)).decode())
    return Plan(machine, plan)


# -------------------------------------------------------------------------------------------- what the core does ----


def load_generator() -> Any:
    spec = importlib.util.spec_from_file_location("generate_shapes", paths.tools / "generate_shapes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def tables() -> list[list[int]]:
    """Points of banks 0 .. 3, 0 .. 256; bank 0 is not used."""
    return [[0] * 257, *([*table, 65536] for table in load_generator().banks().values())]


def shape(bank: int, x: int) -> int:
    """s for a progress x, both UQ1.24."""
    if bank == 0:
        return x
    k, f = x >> 16, x & 0xFFFF
    if k == 256:
        return 1 << 24
    t = tables()[bank]
    return (t[k] << 8) + (((t[k + 1] - t[k]) * f + 128) >> 8)


def velocity_of_tick(ramp: Ramp, tick: int) -> int:
    """The ramp recurrence, in plain integers."""
    u = (ramp.progress_step >> 1) + tick * ramp.progress_step
    assert u < ONE
    x = (u + (1 << 23)) >> 24
    s = (1 << 24) - shape(ramp.shape, (1 << 24) - x) if ramp.mirror else shape(ramp.shape, x)
    return ramp.velocity_start + ((ramp.velocity_end - ramp.velocity_start) * s >> 24)


def velocities_of_ticks(ramp: Ramp) -> np.ndarray:
    """All of them, in 64-bit integers."""
    u = (ramp.progress_step >> 1) + np.arange(ramp.ticks, dtype=np.int64) * ramp.progress_step
    x = (u + (1 << 23)) >> 24
    if ramp.mirror:
        x = (1 << 24) - x
    if ramp.shape:
        t = np.array([*tables()[ramp.shape], 65536], dtype=np.int64)
        k, f = x >> 16, x & 0xFFFF
        x = (t[k] << 8) + (((t[k + 1] - t[k]) * f + 128) >> 8)
    if ramp.mirror:
        x = (1 << 24) - x
    change = ramp.velocity_end - ramp.velocity_start
    return ramp.velocity_start + (change >> 24) * x + ((change & 0xFFFFFF) * x >> 24)


def exact_sum(values: np.ndarray) -> int:
    return (int((values >> 24).sum()) << 24) + int((values & 0xFFFFFF).sum())


def mean_shape(ramp: Ramp) -> Fraction:
    """Mean of the ideal shape over the ticks' progress, which ends at c instead of 1."""
    du, ticks = Fraction(ramp.progress_step, ONE), ramp.ticks
    if ramp.shape < 3:
        return du * ticks / 2
    mean_square = du * du * (Fraction(ticks * ticks, 3) - Fraction(1, 12))
    return du * ticks - mean_square if ramp.mirror else mean_square


def distance(plan: Plan) -> Fraction:
    """Substeps under the ramps, summed tick by tick unless ramps are very long."""
    ramps = plan.ramps
    exact = all(ramp.ticks <= EXACT_TICKS or ramp.velocity_start == ramp.velocity_end for ramp in ramps)
    total = Fraction(0)
    for ramp in ramps:
        change = ramp.velocity_end - ramp.velocity_start
        if change == 0 or not exact:
            total += ramp.ticks * (ramp.velocity_start + change * (mean_shape(ramp) if ramp.ticks else 0))
        elif ramp.ticks:
            total += exact_sum(velocities_of_ticks(ramp))
    return total * plan.machine.tick / ONE


# -------------------------------------------------------------------------------------------- what a plan must be ----


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
    assert line.substeps == p.oversampling * longest < 1 << 32

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
        assert ramp.velocity_start != ramp.velocity_end or ramp.shape == 0

    # jump, accelerate, cruise, decelerate, jump
    expected = []
    if p.velocity_start:
        expected.append((0, p.velocity_start, False, 0))
    middle = [
        (p.accelerate_ticks, p.velocity_start, p.velocity_peak),
        (p.cruise_ticks, p.velocity_peak, p.velocity_peak),
        (p.decelerate_ticks, p.velocity_peak, p.velocity_stop),
    ]
    for ticks, start, end in middle:
        if ticks and start == end and (ticks, start) == middle[1][:2]:
            expected.append((ticks, end, False, 0))
        elif ticks and move.profile == JERK:
            assert ticks % 2 == 0
            expected += [(ticks // 2, (start + end) // 2, False, 3), (ticks // 2, end, True, 3)]
        elif ticks:
            expected.append((ticks, end, False, SHAPE_OF_PROFILE[move.profile]))
    if p.velocity_stop:
        expected.append((0, 0, False, 0))
    assert [(ramp.ticks, ramp.velocity_end, ramp.mirror, ramp.shape) for ramp in ramps] == expected
    if p.accelerate_ticks == 0:
        assert p.velocity_start == p.velocity_peak
    if p.decelerate_ticks == 0:
        assert p.velocity_stop == p.velocity_peak


def progress_bound(plan: Plan) -> Fraction:
    """How far the core's 24 bits of progress and of shape can move the end, in substeps.

    Equal ramps cancel out. Others need hundreds of millions of clocks at full velocity to get beyond the
    tolerance, even though this bound, 2^-24 in every tick, does so earlier.
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
    fit = min(clocks // (2 * longest), (2**32 - 1) // longest)
    assert p.oversampling == (fit if fit < 2 else fit - fit % 2)
    # f_max = n / (total - ramp), to the nearest 2^-48
    assert abs(p.velocity_peak - Fraction(plan.substeps * ONE, clocks)) <= Fraction(1, 2)


@dataclass(frozen=True)
class Ideal:
    """A move by speed without ticks and rounding. Times in clocks, speeds as in BySpeed."""

    peak: float
    peak_tolerance: float  # the planner reckons with whole clocks from rest to the speed
    accelerate: float
    cruise: float
    decelerate: float

    @property
    def clocks(self) -> float:
        return self.accelerate + self.cruise + self.decelerate


def ideal_move(machine: Machine, move: BySpeed) -> Ideal:
    """The quickest move within the limits."""

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

    # Speed, start and stop speed are never exceeded; ramps start and end at them but for rounding down to 2^-48.
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

    # As quick as that allows: each phase may lose what rounding up to ticks takes, and a little for rounding.
    # Quicker it can only be by what progress lacks at the end of very long ramps.
    ideal = ideal_move(machine, move)
    spare = 6 if move.profile == JERK else 4
    lack = max(p.accelerate_ticks, p.decelerate_ticks) / ONE
    assert plan.ticks >= ideal.clocks / machine.tick * (1 - 1e-9 - lack)
    assert plan.ticks <= ideal.clocks / machine.tick * (1 + 1e-4) + spare

    # K as large as peak and M allow.
    longest = max(map(abs, move.steps))
    highest = ideal.peak * (1 + ideal.peak_tolerance)
    more = p.oversampling + (1 if p.oversampling == 1 else 2)
    assert more * longest >= 1 << 32 or more * highest / UNIT > machine.clock_hz / 2


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


# ---------------------------------------------------------------------------------------------------- random moves ----


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def some_machine(rng: random.Random) -> Machine:
    clock_hz = rng.choice(
        (72_000_000, 100_000_000, 50_000_000, 12_000_000, 99_999_989, 1_000_000, 4_294_967_295)
    )
    return Machine(clock_hz, rng.choice((7, 7, 7, 8, 10, 12, 16)))


def some_steps(rng: random.Random, longest: int) -> tuple[int, ...]:
    axes = rng.randint(1, AXES)
    steps = [rng.choice((0, 1, longest, int(log_uniform(rng, 1, longest + 1)))) for _ in range(axes)]
    steps[rng.randrange(axes)] = longest
    return tuple(min(n, longest) * rng.choice((1, -1)) for n in steps)


def some_in_time(rng: random.Random, machine: Machine) -> InTime:
    total = int(log_uniform(rng, machine.tick, min(2**40, MOVE_CLOCKS - 1)))
    ramp = rng.choice((0, total // 2, rng.randint(0, total // 2), int(log_uniform(rng, 1, total + 1)) // 2))
    fastest = max(1, (total - ramp - 2 * machine.tick) // 2)
    longest = min(2**31 - 1, rng.choice((1, fastest, int(log_uniform(rng, 1, fastest + 1)))))
    return InTime(some_steps(rng, longest), rng.randrange(4), total, ramp)


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
    longest = min(2**31 - 1, max(1, int(speed * duration / UNIT)))
    ramps = rng.choice(
        (
            {"acceleration": acceleration()},
            {"acceleration": acceleration(), "deceleration": acceleration()},
            {"ramp_clocks": int(log_uniform(rng, 1, 1e3 * machine.clock_hz))},
            {"ramp_clocks": int(log_uniform(rng, 1, 1e3 * machine.clock_hz)), "deceleration": acceleration()},
        )
    )
    profile = rng.randrange(4)
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
