# SPDX-License-Identifier: MIT
"""The driver (stm32_bridge/driver/passo.h) on the C model: every call, and its errors."""

from dataclasses import replace

import pytest
from passo import frame
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.native import ffi, planner
from passo.plan import sigmoid_table
from passo.registers import Cause, State, Verdict

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    PARAMETERS,
    Q32,
    Wire,
    answer_reads,
    by_speed,
    configure,
    error_of,
    finish,
    open_driver,
    path,
    poll,
    struct,
)

TURN = 3200
LONG = by_speed([40_000, 0, 0, 0])
VERSION = r.VERSION_MAJOR_RESET << r.VERSION_MAJOR_LSB | r.VERSION_MINOR_RESET << r.VERSION_MINOR_LSB


def straight(**axes: object) -> object:
    limits = [{"steps_per_mm": 80 * Q32, "speed": 200 * Q32, "acceleration": 90_000 * Q32}] * 8
    return struct("move_straight", distance=[10 * Q32, -5 * Q32], limits=limits, feed=150 * Q32)


MOVES = {
    "in_time": ([300, -200], dict(profile=1, total_clocks=CLOCK_HZ // 50, ramp_clocks=CLOCK_HZ // 200)),
    "by_speed": ([300, -200, 1, 7], dict(profile=3, speed=50_000 * Q32, acceleration=3_000_000 * Q32)),
    "below_speed": ([300, 0, -1], dict(profile=0, total_clocks=CLOCK_HZ // 50, speed=40_000 * Q32)),
    "at_speed": ([-300], dict(profile=1, speed=40_000 * Q32, ramp_clocks=CLOCK_HZ // 500)),
    "axes": ([50, 30, -20, 1], dict(start_speed=1000 * Q32, speed=20_000 * Q32, ramp_clocks=CLOCK_HZ // 500)),
    "sigmoid": (
        [400, 1],
        dict(
            start_speed=400 * Q32,
            speed=30_000 * Q32,
            stop_speed=400 * Q32,
            accelerate_clocks=CLOCK_HZ // 400,
            decelerate_clocks=CLOCK_HZ // 400,
            alpha=5 * 4096,
        ),
    ),
    "jerk": ([900, -3], dict(speed=30_000 * Q32, acceleration=9_000_000 * Q32, jerk=3_000_000_000 * Q32)),
}


@pytest.mark.parametrize("method", MOVES)
def test_moves(driver: Driver, wire: Wire, method: str) -> None:
    """Each method makes its steps, once, and none of another axis."""
    steps, fields = MOVES[method]
    driver.call(f"move_{method}", struct(f"move_{method}", steps=steps, **fields))
    assert driver.is_moving
    finish(driver)
    steps = steps + [0] * (4 - len(steps))
    assert driver.positions() == steps
    assert wire.counted() == ([abs(n) for n in steps], steps)
    assert not any(driver.counters.refused)


def test_turn_and_straight(driver: Driver, wire: Wire) -> None:
    """Angles and millimeters, there and read back."""
    turn = struct("move_turn", axis=1, steps_per_turn=TURN, angle=-90 * Q32, rpm=900 * Q32)
    turn.acceleration = 3_000_000 * Q32
    driver.call("move_turn", turn)
    finish(driver)
    degrees = ffi().new("int64_t *")
    driver.call("angle", 1, TURN, degrees)
    assert degrees[0] == -90 * Q32
    driver.call("zero")
    assert driver.positions() == [0, 0, 0, 0]

    driver.call("move_straight", straight())
    finish(driver)
    assert driver.positions() == [800, -400, 0, 0]
    units = ffi().new("int64_t *")
    assert error_of(driver, "position_units", 0, units) == "UNITS"
    config = struct("axis_config", steps_per_unit=80 * Q32, step_high_ns=1000)
    driver.call("configure_axis", 0, config)
    driver.call("configure_axis", 1, struct("axis_config", steps_per_unit=3 * Q32))
    driver.call("position_units", 0, units)
    assert units[0] == 10 * Q32
    driver.call("position_units", 1, units)
    assert units[0] == -round(400 * Q32 / 3)
    move = straight()
    move.limits[0].steps_per_mm = move.limits[1].steps_per_mm = 0  # those of the axes
    driver.call("move_straight", move)
    finish(driver)
    assert driver.positions() == [1600, -415, 0, 0]


def test_moves_are_queued_until_it_is_full(driver: Driver) -> None:
    """Moves follow each other; one that finds no room leaves nothing behind."""
    accepted = 0
    while (name := error_of(driver, "move_by_speed", by_speed([2000, -1000, 3, 0]))) == "OK":
        accepted += 1
    assert name == "FULL" and accepted >= 4
    assert error_of(driver, "zero") == "MOVING"
    finish(driver)
    assert driver.positions() == [2000 * accepted, -1000 * accepted, 3 * accepted, 0]
    assert driver.state == State.IDLE
    assert not any(driver.counters.refused)


def test_blocking(driver: Driver) -> None:
    """passo_wait() returns at the end, or after the timeout, when the motion continues."""
    driver.call("move_by_speed", LONG)
    with pytest.raises(DriverError, match="TIMEOUT"):
        driver.wait(0.01)
    assert driver.engine.clock / CLOCK_HZ < 0.02
    driver.wait(1)
    assert driver.positions()[0] == 40_000 and not driver.is_moving


def test_hold_and_override(driver: Driver, wire: Wire) -> None:
    """The same pulses later; the override survives a hold; the speed reading accounts for both."""
    rpm = ffi().new("uint64_t *")
    driver.call("configure_motion", 72000, 72000, 0)
    driver.call("move_by_speed", LONG)
    wire.run(CLOCK_HZ // 20)
    driver.call("rpm", TURN, rpm)
    assert rpm[0] / Q32 == pytest.approx(100_000 * 60 / TURN, rel=1e-3)
    driver.call("hold")
    wire.run(CLOCK_HZ // 500)
    there = driver.positions()
    assert driver.snapshot().rate == 0
    driver.call("override", 25)
    wire.run(CLOCK_HZ // 100)
    assert driver.positions() == there
    driver.call("resume")
    wire.run(CLOCK_HZ // 100)
    assert driver.snapshot().rate == 1 << 14
    driver.call("rpm", TURN, rpm)
    assert rpm[0] / Q32 == pytest.approx(25_000 * 60 / TURN, rel=1e-3)
    for call in ("hold", "resume"):
        driver.call(call)
        wire.run(CLOCK_HZ // 100)
    assert driver.snapshot().rate == 1 << 14
    driver.call("override", 100)
    finish(driver)
    assert wire.counted()[0] == [40_000, 0, 0, 0] and driver.positions()[0] == 40_000
    for percent in (0, 101, 2**32 - 1):
        assert error_of(driver, "override", percent) == "ARGUMENT"


@pytest.mark.parametrize("how", ["stop", "abort"])
def test_stop(driver: Driver, wire: Wire, how: str) -> None:
    """After a stop no move is accepted until clear; then the position is known."""
    driver.call("configure_motion", 360000, 360000, 0)
    for _ in range(3):
        driver.call("move_by_speed", LONG)
    wire.run(CLOCK_HZ // 10)
    driver.call(how)
    assert error_of(driver, "move_by_speed", LONG) == "STOPPED"
    if how == "stop":
        assert error_of(driver, "clear") == "MOVING"
    finish(driver)
    assert driver.cause == (Cause.STOP if how == "stop" else Cause.ABORT)
    assert error_of(driver, "move_by_speed", LONG) == "STOPPED"
    driver.call("clear")
    at = driver.positions()
    assert wire.counted()[1] == at and 5_000 < at[0] < 40_000
    driver.call("move_by_speed", by_speed([-at[0], 5, 0, 0]))
    finish(driver)
    assert driver.positions() == [0, 5, 0, 0] and driver.c.fault == 0


WAYS = [(-2, 0, 1), (0, -3, 0), (-1, 0, 0), (0, 0, 1), (2, 0, 0), (0, -1, -1), (3, 0, 0), (-1, 2, 0)]
TURNS = [3, 2, 1, 0]  # of the axes: of the signs, without zeros, from + on


@pytest.mark.parametrize("how", ["moves", "stream"])
def test_an_axis_that_stands_does_not_turn(driver: Driver, wire: Wire, how: str) -> None:
    """DIR changes only where the next step goes the other way, whatever the line says of a stationary one."""
    if how == "moves":
        for way in WAYS:
            driver.call("move_by_speed", by_speed(way))
    else:
        _, ramps = path(10)
        lines = [
            struct(
                "line",
                substeps=25,
                steps=[abs(n) for n in way],
                directions=sum((n < 0 or (n == 0 and k % 2)) << axis for axis, n in enumerate(way)),
                last=k == len(WAYS) - 1,
            )[0]
            for k, way in enumerate(WAYS)
        ]
        driver.stream(Source(lines, ramps))
        driver.call("stream_start")
    finish(driver)
    assert driver.positions()[:3] == [sum(way[axis] for way in WAYS) for axis in range(3)]
    assert wire.turns[:4].tolist() == TURNS


def test_turning_without_end(driver: Driver, wire: Wire) -> None:
    """Start, change of speed, stop; no other move is accepted in between."""
    rpm = ffi().new("uint64_t *")
    turning = struct("turning", axis=2, steps_per_turn=TURN, backward=True)
    turning.top_rpm, turning.acceleration = 1200 * Q32, 5_000_000 * Q32
    assert error_of(driver, "turn_speed", Q32) == "NOT_TURNING"
    driver.call("turn_start", turning, 600 * Q32)
    assert error_of(driver, "move_by_speed", LONG) == "MOVING"
    assert error_of(driver, "turn_start", turning, Q32) == "MOVING"
    wire.run(CLOCK_HZ // 20)
    driver.call("rpm", TURN, rpm)
    assert rpm[0] / Q32 == pytest.approx(600, rel=1e-3)
    assert error_of(driver, "turn_speed", 1300 * Q32) == "ABOVE_TOP"
    driver.call("turn_speed", 1000 * Q32)
    wire.run(CLOCK_HZ // 160)  # the ramp from 600 rpm takes 4.3 ms, one from rest would take 10.7
    driver.call("rpm", TURN, rpm)
    assert rpm[0] / Q32 == pytest.approx(1000, rel=1e-3)
    wire.run(CLOCK_HZ // 20)
    driver.call("turn_stop")
    assert error_of(driver, "turn_speed", Q32) == "NOT_TURNING"
    finish(driver)
    turned = driver.positions()
    assert turned[2] < -3000 and wire.counted()[1] == turned
    driver.call("move_by_speed", by_speed([0, 0, -turned[2], 0]))
    finish(driver)
    assert driver.positions() == [0, 0, 0, 0]


def test_a_turn_that_has_ended_takes_no_speed(driver: Driver, wire: Wire) -> None:
    """The rotation was ended over the link: nothing rotates any more."""
    turning = struct("turning", axis=2, steps_per_turn=TURN)
    turning.top_rpm, turning.acceleration = 1200 * Q32, 5_000_000 * Q32
    driver.call("turn_start", turning, 600 * Q32)
    wire.run(CLOCK_HZ // 20)
    last_now = 0b11
    ramp = ffi().new("uint32_t[]", [last_now, 0, 100, (1 << 48) // 100 >> 32, (1 << 48) // 100 & 0xFFFFFFFF])
    address = r.ADDRESS_CHANNEL_BASE + r.CHANNEL_RAMP
    assert planner().passo_host_push(driver.host, address, ramp, 5) == 0
    wire.run(CLOCK_HZ // 20)
    for call, arguments in (("turn_speed", (900 * Q32,)), ("turn_stop", ())):
        assert error_of(driver, call, *arguments) == "NOT_TURNING"
    finish(driver)
    assert driver.positions() == wire.counted()[1]
    driver.call("move_by_speed", by_speed([5, 5, 5, 5]))
    finish(driver)


def test_one_motor(driver: Driver, wire: Wire) -> None:
    """All functions of passo_motor.h."""
    lib, motor = planner(), struct("motor")
    degrees, rpm = ffi().new("int64_t *"), ffi().new("uint64_t *")
    assert lib.passo_motor_start(motor) == lib.PASSO_ERROR_NOT_OPEN
    assert lib.passo_motor_init(motor, driver.c, 0, 0, 0, Q32) == lib.PASSO_ERROR_ARGUMENT_STEPS_PER_TURN
    assert lib.passo_motor_init(motor, driver.c, 0, TURN, 10 * Q32, 60_000 * Q32) == 0
    assert lib.passo_motor_set_target(motor, -180 * Q32, 600 * Q32) == 0
    assert lib.passo_motor_start(motor) == 0 and lib.passo_motor_is_turning(motor)
    finish(driver)
    assert not lib.passo_motor_is_turning(motor)
    assert lib.passo_motor_angle(motor, degrees) == 0 and degrees[0] == -180 * Q32
    assert lib.passo_motor_start(motor) == 0 and not lib.passo_motor_is_turning(motor)  # there already
    assert lib.passo_motor_set_angle(motor, 45 * Q32, 600 * Q32) == 0
    for end in (-135, -90):
        assert lib.passo_motor_start(motor) == 0
        finish(driver)
        assert lib.passo_motor_angle(motor, degrees) == 0 and degrees[0] == end * Q32
    assert lib.passo_motor_start_endless(motor, False, 300 * Q32, 900 * Q32) == 0
    wire.run(CLOCK_HZ // 20)
    assert lib.passo_motor_set_speed(motor, 900 * Q32) == 0
    wire.run(CLOCK_HZ // 20)
    assert lib.passo_motor_speed(motor, rpm) == 0
    assert rpm[0] / Q32 == pytest.approx(900, rel=1e-3)
    assert lib.passo_motor_stop(motor) == 0
    finish(driver)
    assert lib.passo_motor_set_speed(motor, 30 * Q32) == 0 and motor.rpm == 30 * Q32
    assert lib.passo_motor_set_target(motor, 360 * Q32, 900 * Q32) == 0
    assert lib.passo_motor_start(motor) == 0
    wire.run(CLOCK_HZ // 100)
    assert lib.passo_motor_stop(motor) == 0
    finish(driver)
    assert error_of(driver, "clear") == "OK"


def test_tables(driver: Driver, wire: Wire) -> None:
    """A table is loaded only if a move needs it, and never during a motion."""

    def loads(call: str, *arguments: object) -> int:
        wire.requests.clear()
        driver.call(call, *arguments)
        finish(driver)
        return sum(request[0] & 0xFFF >= r.ADDRESS_COSINE_BASE for request in wire.requests)

    steps, fields = MOVES["sigmoid"]
    move = struct("move_sigmoid", steps=steps, **fields)
    assert loads("move_sigmoid", move) == 0
    move.alpha = 3 * 4096
    assert loads("move_sigmoid", move) == 5
    assert loads("move_sigmoid", move) == 0
    driver.call("move_by_speed", LONG)
    move.alpha = 4 * 4096
    assert error_of(driver, "move_sigmoid", move) == "TABLE"
    finish(driver)
    table = ffi().new("uint16_t[]", [k * k for k in range(256)])
    shape = struct("user_shape", bank=1, table=table)
    user = by_speed([100, 0, 0, 0])
    assert loads("move_user_by_speed", user, shape) == 5
    assert loads("move_user_by_speed", user, shape) == 0
    table[200] += 1
    assert loads("move_user_by_speed", user, shape) == 5
    in_time = struct("move_in_time", steps=[100], total_clocks=CLOCK_HZ // 50, ramp_clocks=CLOCK_HZ // 200)
    assert loads("move_user_in_time", in_time, shape) == 0
    in_time.profile = 1  # the cosine's own table has gone
    assert loads("move_in_time", in_time) == 5
    points = list(sigmoid_table(3 * 4096))
    assert loads("load_table", 2, points) == 5
    assert loads("load_table", 2, ffi().NULL) == 5
    assert loads("load_table", 2, ffi().NULL) == 0
    assert error_of(driver, "load_table", 0, points) == "ARGUMENT"
    assert error_of(driver, "load_table", 1, points[::-1]) == "ARGUMENT"
    positions = driver.positions()
    assert wire.counted()[1] == positions


def test_a_host_that_was_reset_does_not_trust_tables(driver: Driver, wire: Wire) -> None:
    """Tables cannot be read back: a second host loads what it needs."""
    driver.call("load_table", 1, list(sigmoid_table(3 * 4096)))
    second = open_driver(wire)
    wire.requests.clear()
    steps, fields = MOVES["in_time"]
    second.call("move_in_time", struct("move_in_time", steps=steps, **fields))
    assert sum(request[0] & 0xFFF >= r.ADDRESS_COSINE_BASE for request in wire.requests) == 5


@pytest.mark.parametrize(
    ("call", "arguments", "which"),
    [
        ("positions", (ffi().NULL,), "POINTER"),
        ("move_by_speed", (by_speed([0, 0, 0, 0, 1]),), "AXIS"),
        ("enable", (4, True), "AXIS"),
        ("lost_steps", (4, ffi().new("uint32_t *")), "AXIS"),
        ("move_to_by_speed", (16, by_speed([1])), "AXIS"),
        ("configure_axis", (0, struct("axis_config", dir_hold_ns=910_300)), "PIN_TIME"),
        ("configure_motion", (0, 0, 0x80000001), "DRAIN_VELOCITY"),
        ("override", (101,), "RATE"),
        ("rpm", (0, ffi().new("uint64_t *")), "STEPS_PER_TURN"),
        ("load_table", (0, ffi().NULL), "SHAPE"),
        ("move_plan", (struct("plan"), ffi().NULL), "PLAN"),
    ],
)
def test_the_error_says_which_argument(driver: Driver, call: str, arguments: tuple, which: str) -> None:
    """Each argument that can be wrong has a code of its own."""
    assert driver.attempt(call, *arguments) == getattr(planner(), f"PASSO_ERROR_ARGUMENT_{which}")


def test_what_is_refused(driver: Driver, wire: Wire) -> None:
    """Bad arguments change nothing in the core."""
    before = wire.frames
    null = ffi().NULL
    assert error_of(driver, "move_by_speed", null) == "ARGUMENT"
    assert error_of(driver, "move_by_speed", by_speed([0, 0, 0, 0, 1])) == "ARGUMENT"
    assert error_of(driver, "move_by_speed", by_speed([0])) == "NO_STEPS"
    assert error_of(driver, "move_by_speed", by_speed([1], 40_000_000)) == "TOO_FAST"
    assert error_of(driver, "move_by_speed", by_speed([9999], 600_000, 4_000_000_000)) == "PINS_TOO_SLOW"
    assert error_of(driver, "move_straight", struct("move_straight", distance=[0] * 7 + [1])) == "ARGUMENT"
    for axis in (4, 255):
        assert error_of(driver, "enable", axis, True) == "ARGUMENT"
        assert error_of(driver, "configure_axis", axis, struct("axis_config")) == "ARGUMENT"
        assert error_of(driver, "lost_steps", axis, ffi().new("uint32_t *")) == "ARGUMENT"
    assert error_of(driver, "configure_axis", 0, struct("axis_config", step_high_ns=910_300)) == "ARGUMENT"
    assert error_of(driver, "configure_motion", 0, 0, 0x80000001) == "ARGUMENT"
    assert error_of(driver, "stream", struct("source")) == "ARGUMENT"
    assert error_of(driver, "stream_start") == "NOT_PREPARED"
    assert error_of(driver, "positions", null) == "ARGUMENT"
    assert error_of(driver, "override_q16", 0x10001) == "ARGUMENT"
    assert wire.frames == before
    closed = ffi().new("struct passo *")
    lib = planner()
    for name, arguments in {
        **{"poll": (), "move_by_speed": (LONG,), "hold": (), "wait": (0,)},
        **{"turn_stop": (), "turn_speed": (Q32,), "read_thread": (null,)},
    }.items():
        assert getattr(lib, f"passo_{name}")(closed, *arguments) == lib.PASSO_ERROR_NOT_OPEN
        assert getattr(lib, f"passo_{name}")(null, *arguments) == lib.PASSO_ERROR_ARGUMENT
    assert lib.passo_fault(closed) == lib.PASSO_ERROR_NOT_OPEN
    driver.call("move_by_speed", LONG)
    assert error_of(driver, "configure_axis", 0, struct("axis_config")) == "MOVING"
    assert error_of(driver, "zero") == "MOVING"
    finish(driver)
    assert driver.positions() == [40_000, 0, 0, 0]


def test_pin_times(driver: Driver, wire: Wire) -> None:
    """Nanoseconds become clocks, rounded up, at least one; the drive stays enabled."""
    config = struct("axis_config", step_high_ns=13, step_low_ns=14, dir_setup_ns=0, dir_hold_ns=910_208)
    config.both_edges = config.direction_inverted = True
    driver.call("configure_axis", 3, config)
    words = wire.requests[-1]
    assert words[0] & 0xFFF == 0x100 + 0x80 + 3 * 8
    assert words[1:4] == [0b10100, 1 << 16 | 2, 1 << 16 | 65535]
    assert wire.engine.drain()["enable"][-1] == 0b1111


def test_an_axis_that_is_not_configured_makes_no_steps(wire: Wire) -> None:
    """Pin times and polarities cannot be read back, not even after a reset of the core."""
    driver = Driver(wire)
    assert error_of(driver, "move_by_speed", by_speed([5, 5, 0, 0])) == "NOT_CONFIGURED"
    driver.call("configure_axis", 0, struct("axis_config"))
    assert error_of(driver, "move_by_speed", by_speed([5, 5, 0, 0])) == "NOT_CONFIGURED"
    driver.call("move_by_speed", by_speed([5, 0, 0, 0]))
    finish(driver)
    driver.stream(Source(*path(30)))
    with pytest.raises(DriverError, match="NOT_CONFIGURED"):
        finish(driver)
    finish(driver)
    driver.call("clear")
    assert wire.counted()[0] == [5, 0, 0, 0]


def enabled(wire: Wire) -> int:
    """Level of the EN pins."""
    wire.collect()
    return wire.enable


@pytest.mark.parametrize(
    ("call", "arguments"),
    [("enable", (0, False)), ("zero", ()), ("configure_axis", (1, struct("axis_config"))), ("clear", ())],
)
def test_steps_that_leave_the_pins_are_waited_for(
    driver: Driver, wire: Wire, call: str, arguments: tuple
) -> None:
    """A channel is IDLE before its last steps have been made."""
    slow = struct("axis_config", step_high_ns=1000, step_low_ns=1000, dir_setup_ns=900_000)
    for axis in range(4):
        driver.call("configure_axis", axis, slow)
    driver.call("move_by_speed", by_speed([-3, 0, 0, 0], 400_000, 4_000_000_000))
    while driver.snapshot().state != State.IDLE:
        pass
    assert not driver.snapshot().quiet and wire.counted()[0][0] < 3
    driver.call(call, *arguments)
    assert wire.counted() == ([3, 0, 0, 0], [-3, 0, 0, 0]) and driver.snapshot().quiet
    finish(driver)
    assert driver.positions()[0] == (0 if call == "zero" else -3)


def test_a_stop_is_over_when_the_last_step_has_left_the_pins(driver: Driver, wire: Wire) -> None:
    """Until then the channel is moving; then its positions are final."""
    driver.call("configure_axis", 0, struct("axis_config", step_high_ns=1000, dir_setup_ns=900_000))
    driver.call("move_by_speed", by_speed([-3, 0, 0, 0], 400_000, 4_000_000_000))
    while driver.snapshot().state != State.IDLE:
        pass
    driver.call("stop")
    while driver.state != State.STOPPED:
        wire.run(1000)
        poll(driver)
    assert wire.counted()[0][0] < 3 and driver.is_moving
    finish(driver)
    assert wire.counted()[1] == [-3, 0, 0, 0] == driver.positions()
    driver.call("clear")


def test_a_drive_is_switched_off_at_rest(driver: Driver, wire: Wire) -> None:
    """Not while a motion is running or queued; immediately after an abort."""
    driver.call("enable", 0, False)
    assert enabled(wire) == 0b1110
    driver.call("enable", 0, True)
    assert enabled(wire) == 0b1111

    driver.call("wait_for_sync", True)
    driver.call("move_by_speed", LONG)
    assert error_of(driver, "enable", 2, False) == "MOVING"
    driver.call("wait_for_sync", False)
    driver.call("move_by_speed", LONG)
    wire.run(CLOCK_HZ // 50)
    assert error_of(driver, "enable", 0, False) == "MOVING"
    driver.call("enable", 3, True)
    driver.call("abort")
    driver.call("enable", 0, False)
    assert enabled(wire) == 0b1110
    at = wire.counted()
    wire.run(CLOCK_HZ // 50)
    assert wire.counted() == at and driver.positions() == at[1]


def test_slews(driver: Driver, wire: Wire) -> None:
    """Times of holds and stops become slews."""
    driver.call("configure_motion", 72000, 0, 77)
    assert wire.requests[-1][1:4] == [65536 * 128 * 1000 // CLOCK_HZ, 65536, 77]
    driver.call("configure_motion", (2**32 - 1) * 72, 72, 0)
    assert wire.requests[-1][1:3] == [1, 65536] and wire.requests[-1][0] >> 12 & 0xFF == 2


def test_steps_too_fast_for_the_pins(driver: Driver) -> None:
    """In a stream the core detects the overrun; the driver reports it once."""
    line = struct("line", last=True, substeps=100_000, steps=[100_000])[0]
    ramps = [struct("ramp", velocity_end=1 << 47)[0], struct("ramp", ticks=2000, last=True)[0]]
    ramps[1].progress_step = (1 << 48) // 2000
    driver.stream(Source([line], ramps))
    with pytest.raises(DriverError, match="STEP_OVERRUN"):
        finish(driver)
    assert driver.cause == Cause.STEP_OVERRUN and driver.c.snapshot.overrun == 1
    lost = ffi().new("uint32_t *")
    driver.call("lost_steps", 0, lost)
    assert lost[0] > 0
    poll(driver)
    assert not driver.is_moving
    driver.call("clear")
    driver.call("move_by_speed", by_speed([100, 0, 0, 0]))
    finish(driver)


def test_sync(driver: Driver, wire: Wire) -> None:
    """A motion waits, prepared, for the sync input."""
    driver.call("wait_for_sync", True)
    driver.call("move_by_speed", by_speed([50, 0, 0, 0]))
    wire.run(CLOCK_HZ // 100)
    assert driver.snapshot().state == State.ARMED and wire.counted()[0][0] == 0
    wire.engine.sync(True)
    finish(driver)
    driver.call("wait_for_sync", False)
    driver.call("move_by_speed", by_speed([50, 0, 0, 0]))
    finish(driver)
    assert driver.positions()[0] == 100


def test_channels() -> None:
    """Two channels of a core on one link."""
    wire = Wire(Parameters(channels=2, axes=2, line_queue_log2=6))
    first = open_driver(wire)
    lib, second = planner(), ffi().new("struct passo *")
    options = struct("options", clock_hz=CLOCK_HZ, channel=1)
    assert lib.passo_open_channel(second, first.host, options) == 0
    for axis in range(2):
        assert lib.passo_configure_axis(second, axis, struct("axis_config", step_high_ns=1000)) == 0
    options.channel = 2
    assert lib.passo_open_channel(ffi().new("struct passo *"), first.host, options) == (
        lib.PASSO_ERROR_PARAMETERS
    )
    source = Source(*path(500))
    assert lib.passo_stream(second, source.c) == 0
    other = Source(*path(400))
    first.stream(other)
    while first.is_moving or lib.passo_is_moving(second):
        first.poll()
        assert lib.passo_poll(second) == 0
        wire.run(500)
    positions = ffi().new("int32_t[8]")
    assert lib.passo_positions(second, positions) == 0
    assert list(positions[0:2]) == [500 * 2, -500] and first.positions() == [400 * 2, -400]
    assert not any(first.counters.refused)


# ----------------------------------------------------------------------------------------------- streams ----


@pytest.mark.parametrize("parameters", [PARAMETERS, Parameters(line_queue_log2=2, ramp_queue_log2=2)])
def test_streams(parameters: Parameters) -> None:
    """A path much longer than the queues is executed without a gap, and no frame is refused."""
    wire = Wire(parameters)
    driver = open_driver(wire)
    lines, ramps = path(3000) if parameters is PARAMETERS else path(100, 200)
    driver.stream(Source(lines, ramps))
    assert error_of(driver, "move_by_speed", LONG) == "STREAMING"
    began = wire.clock
    if parameters is PARAMETERS:
        finish(driver)
        length = sum(ramp.ticks for ramp in ramps) * 128
        assert wire.clock - began < length + CLOCK_HZ // 200
    else:
        while driver.is_moving:  # a main loop of half a microsecond: the queue holds 220 us
            poll(driver)
            wire.run(CLOCK_HZ // 2_000_000)
    assert driver.positions()[:2] == [2 * len(lines), -len(lines)]
    assert wire.counted()[0][:2] == [2 * len(lines), len(lines)]
    assert not any(driver.counters.refused) and driver.counters.retries == 0


def test_a_stream_starts_when_it_is_told(driver: Driver, wire: Wire) -> None:
    """Before that it waits for more."""
    lines, ramps = path(300)
    driver.stream(Source([*lines[:100], *[None] * 60, *lines[100:]], ramps))
    for _ in range(60):
        poll(driver)
        wire.run(CLOCK_HZ // 20_000)
    assert driver.snapshot().state == State.IDLE and wire.counted()[0][0] == 0
    driver.call("stream_start")
    finish(driver)
    assert driver.positions() == [600, -300, 0, 0]


def test_a_source_that_is_late(driver: Driver) -> None:
    """The core stops; the driver reports that and drops the rest of the path."""
    lines, ramps = path(600)
    source = Source([*lines[:100], *[None] * 10_000, *lines[100:]], ramps)
    driver.stream(source)
    for _ in range(20):
        poll(driver)
    driver.call("stream_start")
    with pytest.raises(DriverError, match="LINE_UNDERRUN"):
        finish(driver)
    assert not driver.is_moving and not driver.is_streaming
    assert driver.positions()[0] == 200
    assert error_of(driver, "move_by_speed", LONG) == "STOPPED"
    driver.call("clear")
    driver.call("move_by_speed", by_speed([-200, 0, 0, 0]))
    finish(driver)
    assert driver.positions()[0] == 0


@pytest.mark.parametrize("bad", ["substeps", "length", "steps", "axis", "velocity", "now"])
def test_a_source_that_is_wrong(driver: Driver, wire: Wire, bad: str) -> None:
    """A frame with an invalid item is not sent; the motion is stopped with a soft stop."""
    driver.call("configure_motion", 14400, 14400, 0)
    lines, ramps = path(3000)
    if bad == "substeps":
        lines[1500].substeps = 0
    elif bad == "length":
        lines[1500].substeps = 1 << 30
    elif bad == "steps":
        lines[1500].steps[3] = 21
    elif bad == "axis":
        lines[1500].directions = 16
    elif bad == "now":
        ramps[3].now = True
    else:
        ramps[3].velocity_end = (1 << 47) + 1
    driver.stream(Source(lines, ramps))
    with pytest.raises(DriverError, match="SUPPLY"):
        finish(driver)
    assert error_of(driver, "move_by_speed", LONG) == "BROKEN"
    for _ in range(3):
        poll(driver)
        wire.run(CLOCK_HZ // 1000)
    assert driver.state == State.STOPPED and driver.cause == Cause.STOP
    assert driver.positions() == wire.counted()[1]
    driver.call("clear")
    driver.call("move_by_speed", by_speed([5, 5, 5, 5]))
    finish(driver)
    assert not any(driver.counters.refused)


def test_the_longest_line(driver: Driver, wire: Wire) -> None:
    """The core takes it, and makes it until it is told to stop."""
    driver.call("configure_motion", 72, 72, 0)
    ramps = path(3000)[1]
    line = struct("line", substeps=(1 << 30) - 1, steps=[1 << 29], last=True)[0]
    driver.stream(Source([line], ramps))
    while driver.snapshot().state != State.RUN:
        poll(driver)
        wire.run(100)
    wire.run(10_000)
    driver.call("stop")
    finish(driver)
    assert driver.positions()[0] == wire.counted()[1][0] > 50
    assert not any(driver.counters.refused)


def test_a_stopped_stream_is_over(driver: Driver, wire: Wire) -> None:
    """Stop while it is prepared, and while it runs."""
    for wait in (0, 100):
        driver.stream(Source(*path(3000)))
        for _ in range(30 + wait):
            poll(driver)
            wire.run(100)
        driver.call("stop")
        finish(driver)
        assert driver.state == State.STOPPED
        driver.call("clear")
        assert driver.positions() == wire.counted()[1]
    driver.stream(Source(*path(100)))
    at = driver.positions()
    finish(driver)
    assert [b - a for a, b in zip(at, driver.positions(), strict=True)] == [200, -100, 0, 0]


# -------------------------------------------------------------------------------------------------- open ----


@pytest.mark.parametrize(("level", "name"), [(0, "STUCK_LOW"), (1, "STUCK_HIGH")])
def test_no_core(wire: Wire, level: int, name: str) -> None:
    """The number of tries on a dead link is limited."""
    wire.stuck = level
    with pytest.raises(DriverError, match=name):
        Driver(wire)
    assert wire.frames == 8
    with pytest.raises(DriverError, match=name):
        Driver(wire, tries=3)
    assert wire.frames == 11


def changed(wanted: int, word: int) -> object:
    return lambda address, actual: word if address == wanted else actual


@pytest.mark.parametrize(
    ("address", "word", "name"),
    [
        (r.ADDRESS_IDENTIFICATION, 0x5041534E, "NOT_PASSO"),
        (r.ADDRESS_VERSION, VERSION + (1 << r.VERSION_MAJOR_LSB), "VERSION"),
        (r.ADDRESS_VERSION, VERSION + (1 << r.VERSION_MINOR_LSB), "VERSION"),
        (r.ADDRESS_PARAMETERS, 0x04080741, "OK"),
        (r.ADDRESS_PARAMETERS, 0x04080751, "PARAMETERS"),
        (r.ADDRESS_PARAMETERS, 0x04080742, "PARAMETERS"),
        (r.ADDRESS_PARAMETERS, 0x04080841, "PARAMETERS"),
    ],
)
def test_another_core(wire: Wire, address: int, word: int, name: str) -> None:
    """Another device, another version, other parameters than the program expects."""
    answer_reads(wire, changed(address, word))
    if name == "OK":
        Driver(wire, parameters=PARAMETERS)
        return
    with pytest.raises(DriverError, match=name):
        Driver(wire, parameters=PARAMETERS)
    assert all(request[0] >> 28 == r.Operation.READ for request in wire.requests)


@pytest.mark.parametrize(
    ("told", "expected", "outcome"),
    [
        (0, CLOCK_HZ, CLOCK_HZ),  # a core that does not tell it
        (CLOCK_HZ, CLOCK_HZ, CLOCK_HZ),
        (48_000_000, 0, 48_000_000),
        (48_000_000, CLOCK_HZ, f"CLOCK: the core runs at 48000000 Hz, not {CLOCK_HZ} Hz"),
        (0, 0, "CLOCK_UNKNOWN: the core does not tell its clock"),
    ],
)
def test_clock_is_that_of_the_core(told: int, expected: int, outcome: int | str) -> None:
    """What is expected must match; nothing is written before that."""
    wire = Wire(replace(PARAMETERS, clock_hz=told), told or CLOCK_HZ)
    driver = open_driver(wire)
    driver.options.clock_hz = expected
    wire.requests.clear()
    if isinstance(outcome, str):
        with pytest.raises(DriverError, match=outcome):
            driver.open()
        assert all(request[0] >> 28 == r.Operation.READ for request in wire.requests)
    else:
        driver.open()
        assert driver.c.machine.clock_hz == outcome


def test_a_patch_does_not_matter(wire: Wire) -> None:
    answer_reads(wire, changed(r.ADDRESS_VERSION, VERSION | 0xFF))
    Driver(wire)


def test_any_parameters(wire: Wire) -> None:
    """A program without expectations accepts any core; additional axes are not an error."""
    for parameters in (Parameters(channels=3, axes=1), Parameters(axes=8, tick_log2=9)):
        driver = Driver(Wire(parameters))
        assert (driver.c.machine.axes, driver.c.machine.tick_log2) == (parameters.axes, parameters.tick_log2)
    with pytest.raises(DriverError, match="ARGUMENT"):
        Driver(wire, channel=8)
    with pytest.raises(DriverError, match="PARAMETERS"):
        Driver(wire, channel=1)


def test_a_refusal_is_told(driver: Driver) -> None:
    """Verdicts have names of their own, and are counted."""
    lib = planner()
    words = ffi().new("uint32_t[]", 2)
    for address, verdict in [(0, Verdict.READ_ONLY), (0xFF, Verdict.UNKNOWN_ADDRESS), (0x101, 0)]:
        words[0] = 0x10001
        expected = lib.PASSO_ERROR_REFUSED + (verdict or Verdict.BAD_VALUE)
        assert lib.passo_host_write(driver.host, address, words, 1) == expected
        assert driver.counters.refused[expected - lib.PASSO_ERROR_REFUSED] == 1
    assert lib.passo_host_write(driver.host, 0, words, 61) == lib.PASSO_ERROR_ARGUMENT_LENGTH
    assert lib.passo_host_write(driver.host, 0, words, 0) == lib.PASSO_ERROR_ARGUMENT_LENGTH


def test_every_error_has_a_sentence() -> None:
    lib = planner()
    codes = [*range(lib.PASSO_ERROR_COUNT), *(lib.PASSO_ERROR_REFUSED + v for v in range(2, 10))]
    codes += [lib.PASSO_ERROR_PLAN + e for e in range(1, 29)]
    codes += range(lib.PASSO_ERROR_ARGUMENT, lib.PASSO_ERROR_ARGUMENT_END)
    texts = {ffi().string(lib.passo_error_text(code)) for code in codes}
    names = {ffi().string(lib.passo_error_name(code)) for code in codes}
    assert len(texts) == len(codes) and b"UNKNOWN" not in names
    for code in (lib.PASSO_ERROR_COUNT, 0x10A, 0x2FF, lib.PASSO_ERROR_ARGUMENT_END):
        assert ffi().string(lib.passo_error_name(code)) == b"UNKNOWN"


def test_the_payload_of_a_frame_may_be_in_place() -> None:
    """The codec builds a frame around words that stand in it already."""
    words = [7, 8, 9]
    buffer = ffi().new("uint32_t[]", [0, *words, 0, 0, 0])
    assert planner().passo_frame_push(buffer, 5, 0x120, buffer + 1, 3) == 7
    assert list(buffer) == frame.push_frame(5, 0x120, words)


def test_configured_again_after_open(driver: Driver, wire: Wire) -> None:
    """Opening again keeps the position."""
    driver.call("move_by_speed", by_speed([123, 0, 0, 0]))
    finish(driver)
    driver.open()
    configure(driver)
    driver.call("move_by_speed", by_speed([-23, 0, 0, 0]))
    finish(driver)
    assert driver.positions()[0] == 100 and wire.counted()[0][0] == 146


def test_why_it_is_not_open(driver: Driver, wire: Wire) -> None:
    """Calls are NOT_OPEN; the fault repeats what went wrong when it was opened."""
    for level, name in enumerate(("STUCK_LOW", "STUCK_HIGH")):
        wire.stuck = level
        with pytest.raises(DriverError, match=name):
            driver.open()
        assert error_of(driver, "move_by_speed", LONG) == "NOT_OPEN" and driver.fault == name
    wire.stuck = None
    driver.open()
    assert driver.fault == "OK"
