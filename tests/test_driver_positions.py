# SPDX-License-Identifier: MIT
"""Positions of the driver: set for one axis, absolute moves, distance to go, units."""

import pytest
from passo.driver import Driver
from passo.native import ffi, planner
from passo.plan import sigmoid_table
from passo.registers import Operation

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, finish, struct
from tests.test_driver import LONG, MOVES, TURN, straight

X, Y, Z = 1, 2, 4
TOP = 2**31 - 1


def read(driver: Driver, call: str) -> list[int]:
    """Four signed words."""
    words = ffi().new("int32_t[8]")
    driver.call(call, words)
    return list(words[0:4])


def test_the_position_of_one_axis(driver: Driver, wire: Wire) -> None:
    """Homing x keeps y; the core's own count, and what it is compared with, stay."""
    driver.call("move_by_speed", by_speed([300, -200, 7, 0]))
    assert error_of(driver, "set_position", 0, 0) == "MOVING"
    finish(driver)
    driver.call("set_position", 0, 0)
    assert driver.positions() == [0, -200, 7, 0] == read(driver, "target")
    driver.call("set_position", 1, 1_000_000)
    driver.call("move_by_speed", by_speed([5, 5, 0, -5]))
    finish(driver)
    assert driver.positions() == [5, 1_000_005, 7, -5] and driver.fault == "OK"
    assert wire.counted()[1] == [305, -195, 7, -5]
    degrees = ffi().new("int64_t *")
    driver.call("angle", 2, 360, degrees)
    assert degrees[0] == 7 * Q32
    driver.call("zero")
    assert driver.positions() == [0, 0, 0, 0] == read(driver, "target")
    for axis in (4, 255):
        assert error_of(driver, "set_position", axis, 0) == "ARGUMENT"


def test_what_keeps_the_offsets(driver: Driver, wire: Wire) -> None:
    """Abort and clear keep them; opening takes the positions of the core."""
    driver.call("set_position", 0, 1000)
    driver.call("move_by_speed", LONG)
    wire.run(CLOCK_HZ // 20)
    driver.call("abort")
    assert error_of(driver, "set_position", 0, 0) == "STOPPED"
    driver.call("clear")
    made = wire.counted()[1][0]
    assert driver.positions() == [1000 + made, 0, 0, 0]
    driver.open()
    assert driver.positions() == [made, 0, 0, 0]


@pytest.mark.parametrize("method", MOVES)
def test_absolute_moves(driver: Driver, wire: Wire, method: str) -> None:
    """They end where they say, counted from the end of the moves queued before; other axes stay."""
    steps, fields = MOVES[method]
    ends = steps + [0] * (4 - len(steps))
    move = struct(f"move_{method}", steps=steps, **fields)
    driver.call(f"move_{method}", move)
    driver.call(f"move_to_{method}", 15, move)  # there already: nothing is queued
    move.steps = [ends[0] + 150, 12345, 6, 0]
    driver.call(f"move_to_{method}", X | Z, move)
    assert read(driver, "target") == [ends[0] + 150, ends[1], 6, ends[3]]
    move.steps = ends
    driver.call(f"move_to_{method}", 15, move)
    assert read(driver, "target") == ends
    finish(driver)
    assert driver.positions() == ends == wire.counted()[1]
    assert wire.counted()[0][0] == abs(ends[0]) + 300


def test_absolute_moves_with_a_shape(driver: Driver) -> None:
    """The user's own shape."""
    points = ffi().new("uint16_t[]", list(sigmoid_table(4 * 4096)))
    shape = struct("user_shape", bank=1, table=points)
    for method in ("in_time", "by_speed"):
        steps, fields = MOVES[method]
        move = struct(f"move_{method}", steps=[n * 2 for n in steps], **fields)
        driver.call(f"move_to_user_{method}", X, move, shape)
        finish(driver)
        assert driver.positions() == [600, 0, 0, 0]


def test_millimetres_and_degrees(driver: Driver, wire: Wire) -> None:
    """Ends are rounded to steps, so ten tenths are one; positions are those of one instant."""
    for axis, scale in enumerate((80 * Q32, 100 * Q32 // 3)):
        driver.call("configure_axis", axis, struct("axis_config", steps_per_unit=scale, step_high_ns=1000))
    move = straight()
    for limits in move.limits:
        limits.steps_per_mm = 0
    for tenth in range(1, 11):
        move.distance = [tenth * Q32 // 10, -tenth * Q32 // 10, 77 * Q32]
        driver.call("move_to_straight", X | Y, move)
        finish(driver)
        assert driver.positions() == [8 * tenth, -round(tenth * 10 / 3), 0, 0]
    assert error_of(driver, "move_to_straight", Z, move) == "NO_SCALE"
    steps, units = ffi().new("int32_t[8]"), ffi().new("int64_t[8]")
    driver.call("positions_units", steps, units)
    assert list(steps[0:4]) == [80, -33, 0, 0] and units[0] == Q32
    assert units[1] == pytest.approx(-0.99 * Q32) and units[2] == units[3] == -(2**63)
    driver.call("positions_units", ffi().NULL, units)
    driver.call("to_units", 0, -40, units)
    assert units[0] == -Q32 // 2
    assert error_of(driver, "to_units", 2, 1, units) == "UNITS"

    turn = struct("move_turn", axis=2, steps_per_turn=TURN, rpm=900 * Q32, acceleration=3_000_000 * Q32)
    for degrees in (-90, 30, 450, 450, 0):
        turn.angle = degrees * Q32
        driver.call("move_to_turn", turn)
        assert read(driver, "target")[2] == round(degrees * TURN / 360)
    finish(driver)
    assert driver.positions()[2] == 0 and wire.counted()[0][2] == 800 + (800 + 267) + (4000 - 267) + 4000


def test_the_way_wraps(driver: Driver) -> None:
    """In the shorter direction around 2^32 steps."""
    driver.call("set_position", 0, TOP - 10)
    driver.call("set_position", 1, -TOP)
    driver.call("move_to_by_speed", X | Y, by_speed([-TOP + 20, TOP]))
    finish(driver)
    assert driver.positions() == [-TOP + 20, TOP, 0, 0] and driver.fault == "OK"
    assert error_of(driver, "move_to_by_speed", X, by_speed([0])) == "TOO_MANY_STEPS"


def test_distance_to_go(driver: Driver, wire: Wire) -> None:
    """What is left of all queued moves; after a stop nothing, from the place where the axes are."""
    driver.call("configure_motion", 360000, 360000, 0)
    driver.call("set_position", 0, -500)
    driver.call("move_by_speed", LONG)
    driver.call("move_by_speed", by_speed([-10_000, 30, 0, 0]))
    assert read(driver, "target") == [29_500, 30, 0, 0]
    wire.run(CLOCK_HZ // 20)
    left = read(driver, "distance_to_go")
    assert left[1] == 30 and 0 <= driver.positions()[0] - (29_500 - left[0]) < 200
    driver.call("stop")
    assert error_of(driver, "distance_to_go", ffi().new("int32_t[8]")) == "STOPPED"
    assert error_of(driver, "move_to_by_speed", X, LONG) == "STOPPED"
    finish(driver)
    assert error_of(driver, "target", ffi().new("int32_t[8]")) == "STOPPED"
    driver.call("clear")
    at = driver.positions()
    assert at[0] == wire.counted()[1][0] - 500 and read(driver, "target") == at
    assert read(driver, "distance_to_go") == [0, 0, 0, 0]
    driver.call("move_to_by_speed", X | Y, by_speed([at[0] + 9, 0]))
    finish(driver)
    assert driver.positions() == [at[0] + 9, 0, 0, 0]


def test_no_end_in_rotation(driver: Driver, wire: Wire) -> None:
    """The target is known again when it has ended."""
    turning = struct("turning", axis=0, steps_per_turn=TURN, top_rpm=900 * Q32, acceleration=5_000_000 * Q32)
    driver.call("turn_start", turning, 600 * Q32)
    wire.run(CLOCK_HZ // 50)
    for call in ("target", "distance_to_go"):
        assert error_of(driver, call, ffi().new("int32_t[8]")) == "MOVING"
    assert error_of(driver, "move_to_by_speed", X, LONG) == "MOVING"
    driver.call("turn_stop")
    assert error_of(driver, "target", ffi().new("int32_t[8]")) == "MOVING"
    finish(driver)
    assert read(driver, "target") == driver.positions()
    driver.call("move_to_by_speed", X, by_speed([0]))
    finish(driver)
    assert driver.positions() == [0, 0, 0, 0] == wire.counted()[1]


def is_write(request: list[int]) -> bool:
    return request[0] >> 28 == Operation.WRITE


@pytest.mark.parametrize("arrives", [False, True])
def test_zero_on_a_dying_wire(driver: Driver, wire: Wire, arrives: bool) -> None:
    """Executed or not: the driver counts from 0, and absolute moves agree with it."""
    driver.call("move_by_speed", by_speed([300, -200, 7, 0]))
    finish(driver)
    driver.call("set_position", 1, 50)
    if arrives:
        wire.back = lambda words: [0] * len(words) if is_write(wire.requests[-1]) else words
    else:
        wire.there = lambda words: None if is_write(words) else words
    assert error_of(driver, "zero") == "STUCK_LOW"
    wire.there = wire.back = list
    driver.call("move_to_by_speed", X | Y, by_speed([10, 20]))
    finish(driver)
    assert driver.positions() == [10, 20, 0, 0] and driver.fault == "OK"
    assert wire.counted()[1] == [310, -180, 7, 0]


def test_what_is_refused(driver: Driver, wire: Wire) -> None:
    """Bad arguments send nothing."""
    before, null = wire.frames, ffi().NULL
    for call, arguments in {
        "move_to_by_speed": (X, null),
        "move_to_straight": (X, null),
        "move_to_turn": (null,),
        "positions_units": (null, null),
        "target": (null,),
        "distance_to_go": (null,),
        "to_units": (0, 1, null),
    }.items():
        assert error_of(driver, call, *arguments) == "ARGUMENT", call
        closed = ffi().new("struct passo *")
        if call != "move_to_turn":
            lib = planner()
            assert getattr(lib, f"passo_{call}")(closed, *arguments) == lib.PASSO_ERROR_NOT_OPEN
    for axes in (0, 16, 255):
        assert error_of(driver, "move_to_by_speed", axes, LONG) == "ARGUMENT"
    assert error_of(driver, "move_to_turn", struct("move_turn", axis=4)) == "ARGUMENT"
    assert wire.frames == before
