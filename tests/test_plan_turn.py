# SPDX-License-Identifier: MIT
"""Rotation by angle and rpm, continuous rotation, and conversion of readings."""

import random
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from passo.build import Parameters
from passo.engine import Engine, model_engine
from passo.host import Channel
from passo.link import Link
from passo.moves import PinTiming
from passo.native import ffi

from tests.helpers.core_steps import step_errors
from tests.helpers.plan_checks import check_plan, round_half_up
from tests.helpers.plans import (
    ONE,
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

# 200 full steps, 8 microsteps
GOOD = {
    "axis": 1,
    "steps_per_turn": 1600,
    "angle": q32(-720),
    "rpm": q32(120),
    "minimum_rpm": q32(10),
    "acceleration": q32(20_000),
}
TURNING = {"axis": 0, "steps_per_turn": 1600, "top_rpm": q32(300), "minimum_rpm": q32(6)} | {
    "acceleration": q32(20_000),
    "backward": False,
}


def turn(c: Any, machine: Machine, axes: int = 3, **changes: int) -> Plan:
    return make(c, machine, axes, "turn", "passo_move_turn", {**GOOD, **changes})


def steps_of(axis: int, steps: int) -> tuple[int, ...]:
    return tuple(steps if i == axis else 0 for i in range(3))


@pytest.mark.parametrize("clock_hz", [16_000_000, 72_000_000])
def test_the_same_speeds_at_the_same_positions(c: Any, clock_hz: int) -> None:
    """v_k^2 = v_min^2 + 2 a k, the reference's recurrence, in exact arithmetic. Whole ticks stretch the ramp,
    so ours is never above it, and below it by less than a tick of ramp and of cruise allow."""
    machine = Machine(clock_hz)
    plan = turn(c, machine, angle=q32(7200), rpm=q32(300))
    check_plan(plan, steps_of(1, 32_000))
    p = plan.c
    start, peak = speed_of(plan, p.velocity_start), speed_of(plan, p.velocity_peak)
    seconds = Fraction(p.accelerate_ticks * machine.tick, clock_hz)
    a, wanted = (peak - start) / seconds, 20_000
    n_accelerate = int((peak**2 - start**2) / (2 * a))
    assert 0 <= 1600 * Fraction(10, 60) - start < Fraction(1, 10**6)
    v_squared = Fraction(1600 * 10, 60) ** 2
    worst = 0.0
    for k in range(n_accelerate):
        ours = start**2 + 2 * a * k  # the speed in linear motion after k steps
        assert ours <= v_squared
        worst = max(worst, 1 - float(ours / v_squared) ** 0.5)
        v_squared += 2 * wanted
    print(
        f"{n_accelerate} steps of ramp: speeds at most {worst * 1e6:.2f} ppm below the reference's", end=", "
    )
    limit = Fraction(1, p.accelerate_ticks) + Fraction(1, p.cruise_ticks)
    assert worst < limit
    error = np.abs(step_errors(plan)).max()
    print(f"steps within {error:.5f} of the curve")
    assert error < 0.01
    assert -peak + 8000 < 8000 * limit


def test_random_turns(c: Any) -> None:
    """The nearest step to the angle; no limit exceeded."""
    print(f"seed {SEED}")
    rng = random.Random(f"{SEED} turn")
    worst, made = 0.0, 0
    while made < MOVES:
        machine = some_machine(rng)
        per_turn = int(log_uniform(rng, 1, 2**20))
        angle = int(log_uniform(rng, 0.01, 2**30) * UNIT) * rng.choice((1, -1))
        rpm = int(log_uniform(rng, 0.01, 10_000) * UNIT)
        minimum = rng.choice((0, rpm, rng.randint(0, rpm)))
        acceleration = int(log_uniform(rng, 1, 1e9) * UNIT)
        fields = {"axis": rng.randrange(3), "steps_per_turn": per_turn, "angle": angle, "rpm": rpm}
        fields |= {"minimum_rpm": minimum, "acceleration": acceleration}
        steps = round_half_up(Fraction(abs(angle) * per_turn, 360 * UNIT)) * (1 if angle > 0 else -1)
        try:
            plan = turn(c, machine, **fields)
        except PlanError as error:
            assert str(error) in ("TOO_LONG", "TOO_FAST", "NO_STEPS", "TOO_MANY_STEPS", "NO_SPEED"), fields
            assert (str(error) == "TOO_MANY_STEPS") == (abs(steps) > SUBSTEPS_MAX)
            assert (str(error) == "NO_STEPS") == (steps == 0)
            continue
        worst = max(worst, abs(float(check_plan(plan, steps_of(fields["axis"], steps)))))
        p, scale = plan.c, Fraction(per_turn, 60 * UNIT)
        assert speed_of(plan, p.velocity_peak) <= rpm * scale
        if p.accelerate_ticks:
            assert speed_of(plan, p.velocity_start) <= minimum * scale
            rise = speed_of(plan, p.velocity_peak - p.velocity_start - 1)
            assert rise * machine.clock_hz <= Fraction(acceleration * p.accelerate_ticks * machine.tick, UNIT)
        made += 1
    print(f"{made} turns, distance to {worst:.6f} substeps")


def test_a_telescope(c: Any) -> None:
    """One revolution of the sky: 360 degrees in a sidereal day, 6 million steps."""
    rpm = round(2**32 / (86164.0905 / 60))
    plan = turn(c, Machine(100_000_000, 12), steps_per_turn=6_000_000, angle=q32(360), rpm=rpm, minimum_rpm=0)
    check_plan(plan, (0, 6_000_000, 0))
    assert abs(plan.ticks * 4096 / 1e8 - 86164.0905) < 1


REFUSED = [
    ({"axis": 3}, "BAD_AXIS"),
    ({"axis": 255}, "BAD_AXIS"),
    ({"steps_per_turn": 0}, "NO_STEPS_PER_TURN"),
    ({"minimum_rpm": q32(120) + 1}, "MINIMUM_ABOVE_SPEED"),
    ({"rpm": 0, "minimum_rpm": 0}, "NO_SPEED"),
    ({"angle": 0}, "NO_STEPS"),
    ({"angle": q32(0.1)}, "NO_STEPS"),
    ({"angle": -(2**63), "steps_per_turn": 2**32 - 1}, "TOO_MANY_STEPS"),
    ({"acceleration": 0}, "NO_ACCELERATION"),
    ({"rpm": 2**64 - 1}, "TOO_FAST"),
    ({"acceleration": 1, "angle": 2**59}, "TOO_LONG"),
]


@pytest.mark.parametrize(("changes", "name"), REFUSED)
def test_refused_turns(c: Any, changes: dict, name: str) -> None:
    assert refused(c, lambda c, **more: turn(c, Machine(), **changes)) == name


def test_as_far_as_a_line_goes(c: Any) -> None:
    """The largest number of steps, and the angle that rounds to one more."""
    too_far = SUBSTEPS_MAX * UNIT + UNIT // 2  # degrees, at a step each
    fast = {"steps_per_turn": 360, "rpm": q32(1e6), "acceleration": q32(1e6)}
    for sign in (1, -1):
        fast["angle"] = sign * (too_far - 1)
        plan = turn(c, Machine(), **fast)
        check_plan(plan, steps_of(1, sign * SUBSTEPS_MAX))
        fast["angle"] = sign * too_far
        assert refused(c, lambda c: turn(c, Machine(), **fast)) == "TOO_MANY_STEPS"


# ----------------------------------------------------------------------------------- continuous rotation ----


def turning(c: Any, machine: Machine, what: str, *arguments: int, **changes: int) -> Plan:
    """The plan that starts (rpm), changes (velocity, rpm) or stops (velocity) it."""
    ours = ffi().new("struct passo_machine *", (machine.clock_hz, machine.tick_log2, 2))
    plan = ffi().new("struct passo_plan *")
    wanted = ffi().new("struct passo_turning *", {**TURNING, **changes})
    error = getattr(c, f"passo_plan_turning_{what}")(ours, wanted, *arguments, plan)
    if error:
        raise PlanError(ffi().string(c.passo_plan_error_name(error)).decode())
    return Plan(machine, plan)


def check_change(plan: Plan, ramp: Any, start: int, end: int) -> None:
    """The acceleration is as given, with the ramp rounded up to ticks."""
    change = Fraction(abs(end - start) * plan.machine.clock_hz, ONE * plan.c.oversampling)
    ticks = change / 20_000 * plan.machine.clock_hz / plan.machine.tick
    assert ramp.velocity_end == end
    assert ticks <= ramp.ticks < ticks + 1 + Fraction(1, 100)


def test_turning_changing_and_stopping_on_the_core(c: Any) -> None:
    """60 rpm, then 300, then 30, then stop: speeds by the steps of the core, and by readings."""
    clock_hz = 1_280_000
    machine, parameters = Machine(clock_hz), Parameters(axes=2)
    first = turning(c, machine, "start", q32(60))
    at_60 = first.c.velocity_peak
    faster = turning(c, machine, "speed", at_60, q32(300))
    at_300 = faster.c.velocity_peak
    slower = turning(c, machine, "speed", at_300, q32(30))
    at_30 = slower.c.velocity_peak
    stop = turning(c, machine, "stop", at_30)
    minimum = first.c.velocity_start
    check_change(first, first.c.ramps[1], minimum, at_60)
    check_change(faster, faster.c.ramps[0], at_60, at_300)
    check_change(slower, slower.c.ramps[0], at_300, at_30)
    check_change(stop, stop.c.ramps[0], at_30, minimum)
    for plan, rpm in ((first, 60), (faster, 300), (slower, 30)):
        back = c.passo_rpm_of(plan.c.velocity_peak, plan.c.oversampling, clock_hz, 1600)
        assert 0 <= rpm - Fraction(back, UNIT) < Fraction(1, 1000)

    with model_engine(parameters, clock_hz) as engine:
        channel = Channel(Link(engine), parameters)
        for axis in range(2):
            channel.configure_axis(axis, PinTiming())
        channel.push_lines([first.c.line])
        channel.push_ramps(first.c.ramps[0 : first.c.ramp_count])
        channel.start()
        rates = []
        for plan in (faster, slower, stop):
            rates.append(measured(engine, channel, clock_hz))
            channel.push_ramps(plan.c.ramps[0 : plan.c.ramp_count])
        engine_run(engine, clock_hz // 2)
        state, positions = channel.state(), channel.positions()
    assert state.state.name == "IDLE" and state.cause.name == "NONE"
    for rate, rpm in zip(rates, (60, 300, 30), strict=True):
        assert abs(rate - rpm * 1600 / 60) <= 4, rates  # steps in a quarter of a second, times 4
    assert positions[1] == 0
    angle = Fraction(c.passo_angle_of(positions[0], 1600), UNIT)
    assert abs(angle - Fraction(positions[0] * 360, 1600)) < Fraction(1, UNIT)


def engine_run(engine: Engine, clocks: int) -> None:
    while clocks:
        clocks -= engine.run(clocks)
        engine.drain()


def measured(engine: Engine, channel: Channel, clock_hz: int) -> int:
    """Steps per second, after half a second to get there."""
    engine_run(engine, clock_hz // 2)
    before, clock = channel.positions()[0], engine.clock
    engine_run(engine, clock_hz // 4)
    return (channel.positions()[0] - before) * clock_hz // (engine.clock - clock)


def test_backward_and_without_minimum(c: Any) -> None:
    machine = Machine()
    plan = turning(c, machine, "start", q32(60), backward=True, minimum_rpm=0, axis=1)
    line = plan.c.line
    assert line.endless and not line.last and line.directions == 2
    assert line.steps[1] * plan.c.oversampling == line.substeps <= SUBSTEPS_MAX
    assert line.substeps > SUBSTEPS_MAX - plan.c.oversampling, "as many steps as a line takes"
    assert [ramp.velocity_end for ramp in plan.ramps] == [plan.c.velocity_peak]
    stop = turning(c, machine, "stop", plan.c.velocity_peak, minimum_rpm=0)
    assert stop.c.ramp_count == 1 and stop.c.ramps[0].now and stop.c.ramps[0].last
    assert (stop.c.ramps[0].velocity_end, stop.c.steps_to_stop) == (0, stop.c.steps_to_stop)
    at_rest = turning(c, machine, "stop", 0)
    assert at_rest.c.ramp_count == 1 and at_rest.c.ramps[0].ticks == 0 and at_rest.c.ramps[0].last
    same = turning(c, machine, "speed", plan.c.velocity_peak, q32(60))
    assert same.c.ramps[0].ticks == 0 and same.c.ramps[0].now and not same.c.ramps[0].last


@pytest.mark.parametrize(
    ("what", "arguments", "changes", "name"),
    [
        ("start", (q32(5),), {}, "BELOW_MINIMUM"),
        ("start", (q32(301),), {}, "ABOVE_TOP"),
        ("start", (0,), {}, "NO_SPEED"),
        ("start", (q32(60),), {"acceleration": 0}, "NO_ACCELERATION"),
        ("start", (q32(60),), {"acceleration": 1}, "TOO_LONG"),
        ("start", (q32(60),), {"axis": 2}, "BAD_AXIS"),
        ("start", (q32(60),), {"steps_per_turn": 0}, "NO_STEPS_PER_TURN"),
        ("start", (q32(60),), {"top_rpm": 0}, "NO_SPEED"),
        ("start", (q32(60),), {"top_rpm": 2**64 - 1}, "TOO_FAST"),
        ("speed", (0, q32(301)), {}, "ABOVE_TOP"),
        ("speed", (ONE // 2 + 1, q32(60)), {}, "ABOVE_TOP"),
        ("speed", (0, q32(5)), {}, "BELOW_MINIMUM"),
        ("stop", (2**64 - 1,), {}, "ABOVE_TOP"),
        ("stop", (0,), {"axis": 9}, "BAD_AXIS"),
    ],
)
def test_refused_turning(c: Any, what: str, arguments: tuple, changes: dict, name: str) -> None:
    assert refused(c, lambda c: turning(c, Machine(), what, *arguments, **changes)) == name


# ------------------------------------------------------------------------------------------ reading back ----


def test_reading_back_is_exact(c: Any) -> None:
    rng = random.Random(f"{SEED} read")
    for _ in range(2000):
        position = rng.choice((0, 1, -1, 2**31 - 1, -(2**31), rng.randint(-(2**31), 2**31 - 1)))
        per_turn = rng.choice((1, 200, 1600, 2**32 - 1, rng.randint(1, 2**32 - 1)))
        exact = abs(position) * 360 * UNIT // per_turn
        sign = -1 if position < 0 else 1
        assert c.passo_angle_of(position, per_turn) == sign * min(exact, 2**63 - 1)
        velocity, oversampling = rng.randrange(2**47 + 1), rng.randint(1, 2**32 - 1)
        clock_hz = rng.randint(1, 2**32 - 1)
        rpm = Fraction(velocity * clock_hz * 60, oversampling * per_turn * 2**16)
        got = c.passo_rpm_of(velocity, oversampling, clock_hz, per_turn)
        assert got == 2**64 - 1 if rpm >= 2**64 else rpm - 60 - 1 < got <= rpm
    assert (c.passo_angle_of(5, 0), c.passo_rpm_of(5, 5, 5, 0), c.passo_rpm_of(5, 0, 5, 5)) == (0, 0, 0)
