# SPDX-License-Identifier: MIT
"""Courses against the fastest motion in continuous time: exact end, all limits, as fast as ticks allow.

Speeds are in steps/s, times in seconds, as exact fractions.
"""

import random
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt
from typing import Any

import pytest

from tests.helpers.plans import ONE, UNIT, Machine, Plan, PlanError, make, q32, refused, speed_of
from tests.helpers.random_plans import MOVES, SEED, log_uniform, some_machine

LONGEST_RAMP, LONGEST_CRUISE = 1 << 22, (1 << 32) - 1  # ticks
GOOD = {"axis": 1, "top_speed": q32(20_000), "speed": q32(10_000), "acceleration": q32(50_000)}
RATIO = Fraction(1, 10_000)  # that a plan may be slower: an isqrt, a velocity that is rounded down
TICKS = 4  # and what whole ticks of its ramps and its cruise cost


@dataclass(frozen=True)
class Motion:
    """Straight ramps: their ends (steps/s) and times, from the speed before the first."""

    begin: Fraction
    ramps: list[tuple[Fraction, Fraction]]

    @property
    def seconds(self) -> Fraction:
        return sum((time for _, time in self.ramps), Fraction(0))

    @property
    def steps(self) -> Fraction:
        """Its length."""
        speeds = [self.begin, *(speed for speed, _ in self.ramps)]
        return sum(
            ((a + b) / 2 * time for a, b, (_, time) in zip(speeds, speeds[1:], self.ramps, strict=False)),
            Fraction(0),
        )

    def keeps(self, acceleration: Fraction, rounding: Fraction) -> bool:
        """None of its ramps is steeper; `rounding` is of speeds."""
        speeds = [self.begin, *(speed for speed, _ in self.ramps)]
        ramps = zip(speeds, speeds[1:], self.ramps, strict=False)
        return all(abs(b - a) <= acceleration * time + rounding for a, b, (_, time) in ramps)


def root(value: Fraction) -> Fraction:
    """Square root, to 2^-80 of it or better."""
    shift = max(0, 200 - (value.numerator // value.denominator).bit_length())
    return Fraction(isqrt((value.numerator << 2 * shift) // value.denominator), 1 << shift)


def motion_of(plan: Plan, begin: Fraction = Fraction(0)) -> Motion:
    """What the core makes of its ramps."""
    tick = Fraction(plan.machine.tick, plan.machine.clock_hz)
    return Motion(begin, [(speed_of(plan, ramp.velocity_end), ramp.ticks * tick) for ramp in plan.ramps])


@dataclass(frozen=True)
class Fastest:
    """Over `way` from `begin`, with a first ramp that must also do for the lower speed `low`."""

    begin: Fraction
    low: Fraction
    way: Fraction
    speed: Fraction
    acceleration: Fraction

    @property
    def peak(self) -> Fraction:
        if self.speed < self.begin:
            return self.speed
        # (peak - low) (peak + begin) / 2a + peak^2 / 2a = way
        spread = self.begin - self.low
        product = 2 * self.acceleration * self.way + self.low * self.begin
        return min(self.speed, (root(spread**2 + 8 * product) - spread) / 4)

    @property
    def ramps(self) -> tuple[Fraction, Fraction]:
        """Seconds of the first and of the last."""
        peak = self.peak
        first = max(abs(peak - self.low), abs(peak - self.begin)) / self.acceleration
        return first, peak / self.acceleration

    @property
    def seconds(self) -> Fraction:
        (first, last), peak = self.ramps, self.peak
        cruised = self.way - (self.begin + peak) / 2 * first - peak / 2 * last
        return first + last + max(Fraction(0), cruised) / peak


def some_course(rng: random.Random, machine: Machine) -> dict[str, int]:
    top = int(log_uniform(rng, 1, machine.clock_hz / 4) * UNIT)
    speed = rng.choice((top, int(log_uniform(rng, 1, top + 1))))
    acceleration = int(log_uniform(rng, 1, 2**64 - 1))
    if rng.random() < 0.8:  # ramps of some ticks to some seconds
        acceleration = min(2**64 - 1, int(speed / log_uniform(rng, machine.tick / machine.clock_hz, 20)))
    fields = {"axis": rng.randrange(3), "backward": rng.random() < 0.5, "top_speed": top, "speed": speed}
    return {**fields, "acceleration": max(1, acceleration)}


def check_ramps(plan: Plan, motion: Motion, fields: dict[str, int]) -> None:
    """Order, flags, rest at the end, and the phases that the plan tells."""
    p, ramps = plan.c, plan.ramps
    assert [ramp.last for ramp in p.ramps[0 : p.ramp_count]] == [False] * (len(ramps) - 1) + [True]
    assert all(ramp.shape == 0 and not ramp.mirror for ramp in ramps)
    assert all(ramp.ticks <= LONGEST_RAMP for ramp in (ramps[0], ramps[-1]))
    assert ramps[-1].velocity_end == 0
    assert plan.ticks == sum(ramp.ticks for ramp in ramps)
    assert p.oversampling >= 2 and p.oversampling % 2 == 0
    assert Fraction(fields["top_speed"] * p.oversampling, UNIT) <= Fraction(plan.machine.clock_hz, 2)


@pytest.mark.parametrize("batch", range(4))
def test_random_courses(c: Any, batch: int) -> None:
    """From rest: exactly the steps, and as fast as limits and ticks allow."""
    rng = random.Random(f"{SEED} course {batch}")
    made = 0
    while made < MOVES:
        machine, steps = some_machine(rng), min(2**32 - 1, int(log_uniform(rng, 1, 2**32)))
        fields = some_course(rng, machine)
        speed, acceleration = Fraction(fields["speed"], UNIT), Fraction(fields["acceleration"], UNIT)
        optimum = Fastest(Fraction(0), Fraction(0), Fraction(steps), speed, acceleration)
        tick = Fraction(machine.tick, machine.clock_hz)
        try:
            plan = make(c, machine, 3, "course", "passo_course", fields, steps)
        except PlanError as error:
            if str(error) == "TOO_LONG":
                assert optimum.ramps[0] > (LONGEST_RAMP - 1) * tick or optimum.seconds > LONGEST_CRUISE * tick
            else:
                assert str(error) == "NO_SPEED" and speed * 2**48 < machine.clock_hz * 2**31
            continue
        p, motion, one = plan.c, motion_of(plan), 2 * speed_of(plan, 1)
        check_ramps(plan, motion, fields)
        assert p.line.endless and p.line.directions == fields["backward"] << fields["axis"]
        per_step = plan.substeps // plan.steps[fields["axis"]]
        assert per_step == p.oversampling and plan.substeps + per_step > (1 << 30) - 1 >= plan.substeps
        assert [n > 0 for n in plan.steps] == [axis == fields["axis"] for axis in range(8)]
        assert p.velocity_start == 0 and p.velocity_peak == max(ramp.velocity_end for ramp in plan.ramps)
        # the phase begins at 1/4 substep
        left = steps * per_step - Fraction(1, 4) - motion.steps * per_step
        assert 0 <= left <= Fraction(plan.ticks * machine.tick, ONE), "the last step"
        assert motion.keeps(acceleration, one)
        assert speed_of(plan, p.velocity_peak) <= speed + one
        rounding = RATIO + Fraction(2, p.velocity_peak)
        assert motion.seconds <= optimum.seconds * (1 + rounding) + TICKS * tick
        made += 1


@pytest.mark.parametrize("batch", range(4))
def test_random_changes(c: Any, batch: int) -> None:
    """While it moves, at any speed within the bounds: within way and limits, and no slower than these."""
    rng = random.Random(f"{SEED} change {batch}")
    made = 0
    while made < MOVES:
        machine = some_machine(rng)
        fields = some_course(rng, machine)
        high = rng.choice((fields["speed"], int(log_uniform(rng, 1, fields["top_speed"] + 1))))
        low = rng.choice((high, int(high * (1 - log_uniform(rng, 1e-6, 1))), int(rng.random() * high)))
        speed, acceleration = Fraction(fields["speed"], UNIT), Fraction(fields["acceleration"], UNIT)
        slow, fast = Fraction(low, UNIT), Fraction(high, UNIT)
        braking = fast**2 / (2 * acceleration)
        way = rng.choice((0, int(float(braking * 2**16) * log_uniform(rng, 0.5, 1000)), rng.getrandbits(64)))
        way = min(way, 2**64 - 1)
        tick = Fraction(machine.tick, machine.clock_hz)
        try:
            plan = make(c, machine, 3, "course_change", "passo_course", fields, low, high, way)
        except PlanError as error:
            if str(error) == "TOO_LONG":
                assert fast / acceleration > (LONGEST_RAMP - 1) * tick
            elif str(error) == "TOO_NEAR":
                assert way < (braking + 2 * fast * tick) * 2**16 * (1 + RATIO) + 1
            else:
                assert str(error) == "NO_SPEED" and speed * 2**48 < machine.clock_hz * 2**31
            continue
        p, motion, one = plan.c, motion_of(plan, fast), 2 * speed_of(plan, 1)
        check_ramps(plan, motion, fields)
        assert [ramp.now for ramp in p.ramps[0 : p.ramp_count]] == [True] + [False] * (p.ramp_count - 1)
        assert motion.keeps(acceleration, one) and motion_of(plan, slow).keeps(acceleration, one)
        assert max(end for end, _ in motion.ramps) <= max(fast, speed) + one
        assert p.velocity_start == max(p.velocity_start, p.velocity_peak if p.ramp_count == 1 else 0)
        assert abs(speed_of(plan, p.velocity_start) - fast) <= one
        made += 1
        if way == 0:
            assert p.ramp_count == 1
        steps = Fraction(way, 1 << 16)
        if way:
            assert motion.steps <= steps
        optimum = Fastest(fast, slow, steps, speed, acceleration)
        enough = steps - ((fast - slow) * fast + fast**2 / 2) / acceleration
        if enough > 4 * fast * tick and max(optimum.ramps) < (LONGEST_RAMP - 1) * tick:
            rounding = RATIO + Fraction(2, max(1, p.velocity_peak))
            assert motion.seconds <= optimum.seconds * (1 + rounding) + TICKS * tick
            left = steps - motion.steps - one * motion.ramps[0][1]
            assert left <= 2 * tick * speed_of(plan, p.velocity_peak) or p.cruise_ticks == LONGEST_CRUISE
        elif p.ramp_count == 1:  # one ramp to rest
            assert motion.seconds <= fast / acceleration + TICKS * tick


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"axis": 3}, "BAD_AXIS"),
        ({"speed": q32(20_001)}, "ABOVE_TOP"),
        ({"speed": 0}, "NO_SPEED"),
        ({"top_speed": 0, "speed": 0}, "NO_SPEED"),
        ({"top_speed": q32(25_000_001)}, "TOO_FAST"),
        ({"top_speed": q32(25_000_000)}, ""),
        ({"top_speed": q32(25_000_000), "speed": 1}, "NO_SPEED"),
        ({"acceleration": 0}, "NO_ACCELERATION"),
        ({"acceleration": q32(1e-3)}, "TOO_LONG"),
    ],
)
def test_what_is_refused(c: Any, changes: dict[str, int], error: str) -> None:
    """By both functions."""
    fields = {**GOOD, **changes}
    assert refused(c, make, Machine(), 3, "course", "passo_course", fields, 1000) == error
    change = ("course_change", "passo_course", fields, q32(100), q32(100), 0)
    assert refused(c, make, Machine(), 3, *change) == error
    assert refused(c, make, Machine(), 3, "course", "passo_course", GOOD, 0) == "NO_STEPS"
    assert refused(c, make, Machine(), 0, "course", "passo_course", GOOD, 1) == "BAD_AXIS"
    assert refused(c, make, Machine(tick_log2=4), 3, "course", "passo_course", GOOD, 1) == "BAD_CLOCK"
