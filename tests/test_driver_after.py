# SPDX-License-Identifier: MIT
"""What the driver takes on while or after something else: nothing of that is left."""

from typing import Any

import pytest
from passo.driver import Driver
from passo.native import ffi, planner
from passo.registers import ADDRESS_CHANNEL_BASE, CHANNEL_TRIGGER

from tests.helpers.driver_wire import CLOCK_HZ, Q32, Wire, by_speed, error_of, finish, open_driver, struct
from tests.test_driver_sessions import PARAMETERS, again, moves

MS = CLOCK_HZ // 1000


def jog(**fields: int) -> object:
    return struct("jog", speed=20_000 * Q32, acceleration=2_000_000 * Q32, **fields)


@pytest.fixture
def driver(wire: Wire) -> Driver:
    """With soft stops of 2 ms."""
    made = open_driver(wire)
    made.call("configure_motion", 2 * MS, 2 * MS, 0)
    return made


@pytest.mark.parametrize("steps", [0, 20_000])
def test_nothing_is_queued_behind_a_jog(driver: Driver, steps: int) -> None:
    """Endless or not: a move, a second jog, a position or a zero must wait for its end."""
    driver.call("jog", jog(steps=steps))
    driver.engine.run(MS)
    for call, *arguments in (
        ("move_by_speed", by_speed([5, 0, 0, 0])),
        ("jog", jog(steps=7)),
        ("set_position", 0, 3),
        ("zero",),
    ):
        assert error_of(driver, call, *arguments) == "MOVING", call
    driver.call("jog_cancel")
    finish(driver)
    driver.call("move_by_speed", by_speed([5, 0, 0, 0]))


def test_nothing_but_moves_is_taken_during_a_move(driver: Driver) -> None:
    """They queue; the positions stay what they are."""
    driver.call("move_by_speed", by_speed([9000, 0, 0, 0]))
    driver.call("move_by_speed", by_speed([500, 0, 0, 0]))
    for call, *arguments in (("jog", jog(steps=7)), ("zero",), ("set_position", 0, 3)):
        assert error_of(driver, call, *arguments) == "MOVING", call
    finish(driver)
    assert driver.positions()[0] == 9500


def test_a_jog_whose_end_nobody_has_seen(driver: Driver, wire: Wire) -> None:
    """The next move sees it, and is exact."""
    driver.call("jog", jog(steps=700))
    wire.run(CLOCK_HZ // 5)
    driver.call("move_by_speed", by_speed([300, 0, 0, 0]))
    finish(driver)
    assert not driver.is_moving and driver.fault == "OK"
    assert driver.positions() == wire.counted()[1] == [1000, 0, 0, 0]


def test_a_session_after_an_override_is_at_full_speed() -> None:
    """And its lines have the levels that the outputs have."""
    first = open_driver(Wire(PARAMETERS))
    first.call("configure_motion", 2 * MS, 2 * MS, 0)
    first.call("configure_probe", False)
    first.call("set_levels", 5)
    first.call("override", 25)
    first.engine.run(10 * MS)
    second = again(first)
    assert second.snapshot().rate == 1 << 16
    moves(second)
    state = struct("outputs_state")
    second.call("read_outputs", state)
    assert state.levels == 5


def test_a_plan_of_an_endless_line_has_no_target(driver: Driver, wire: Wire) -> None:
    """Its ramps end it: nobody knows where before it is there."""
    lib, plan = planner(), struct("plan")
    course = struct("course", speed=20_000 * Q32, top_speed=20_000 * Q32, acceleration=2_000_000 * Q32)
    assert lib.passo_plan_course(lib.passo_machine(driver.c), course, 1000, plan) == 0
    driver.call("move_plan", plan, ffi().NULL)
    target = ffi().new("int32_t[8]")
    assert error_of(driver, "target", target) == "MOVING"
    finish(driver)
    driver.call("target", target)
    assert driver.positions() == wire.counted()[1] == list(target[0:4]) == [1000, 0, 0, 0]
    assert driver.fault == "OK"


@pytest.fixture
def motor(driver: Driver) -> Any:
    """Of 1600 steps per turn, which gains 600 rpm in a second."""
    made = struct("motor")
    assert planner().passo_motor_init(made, driver.c, 0, 1600, 0, 600 * Q32) == 0
    return made


def test_a_motor_that_was_aborted_in_rotation_stops_in_a_move(driver: Driver, motor: Any) -> None:
    """How it was started before does not matter."""
    lib, wire = planner(), driver.engine
    assert lib.passo_motor_start_endless(motor, False, 60 * Q32, 60 * Q32) == 0
    wire.run(20 * MS)
    driver.call("abort")
    finish(driver)
    driver.call("clear")
    assert lib.passo_motor_set_angle(motor, 3600 * Q32, 60 * Q32) == 0
    assert lib.passo_motor_start(motor) == 0
    wire.run(100 * MS)
    assert lib.passo_motor_set_speed(motor, 30 * Q32) == 0 and motor.rpm == 30 * Q32
    assert lib.passo_motor_stop(motor) == 0
    wire.run(10 * MS)
    stopped = wire.counted()[1]
    wire.run(100 * MS)
    assert wire.counted()[1] == stopped and 0 < stopped[0] < 1600
    finish(driver)
    driver.call("clear")
    assert driver.positions() == stopped


def test_a_motor_that_is_stopped_twice_keeps_its_ramp(driver: Driver, motor: Any) -> None:
    """The second call changes nothing: it comes to rest in 0.1 s, and needs no clear."""
    lib, wire = planner(), driver.engine
    assert lib.passo_motor_start_endless(motor, False, 60 * Q32, 60 * Q32) == 0
    wire.run(200 * MS)
    begin = wire.counted()[1][0]
    for _ in range(2):
        assert lib.passo_motor_stop(motor) == 0
        assert lib.passo_motor_set_speed(motor, 30 * Q32) == 0 and motor.rpm == 30 * Q32
        wire.run(10 * MS)
    finish(driver)
    assert 80 <= wire.counted()[1][0] - begin <= 84  # 1600 steps/s, down to 0 in 0.1 s
    assert lib.passo_motor_start(motor) == lib.PASSO_ERROR_PLAN + lib.PASSO_PLAN_NO_STEPS
    assert driver.fault == "OK"


@pytest.mark.parametrize(("lost", "told"), [("arm", "STUCK_LOW"), ("disarm", "SWITCH_MISSED")])
def test_no_trigger_of_a_probe_stops_a_move(lost: str, told: str) -> None:
    """Where its frame is lost on the way, or its reply, nothing moves before a clear."""
    for arrives in (False, True):
        driver = open_driver(Wire(PARAMETERS))
        wire = driver.engine
        driver.call("configure_motion", 2 * MS, 2 * MS, 0)
        driver.call("configure_probe", False)

        def cut(words: list[int], wire: Wire = wire) -> list[int] | None:
            header, command = wire.requests[-1][:2]
            is_it = header & 0xFFF == ADDRESS_CHANNEL_BASE + CHANNEL_TRIGGER
            return None if is_it and (command == 0) == (lost == "disarm") else words

        if arrives:
            wire.back = lambda words, cut=cut: cut(words) or [0] * len(words)
        else:
            wire.there = cut
        probe = struct("probe", steps=[500, 0, 0], speed=20_000 * Q32, acceleration=2_000_000 * Q32)
        error = error_of(driver, "probe", probe)
        assert (error if lost == "arm" else error_of(driver, "wait", CLOCK_HZ)) == told
        wire.there = wire.back = list
        assert error_of(driver, "move_by_speed", by_speed([3000, 0, 0])) == "BROKEN"
        driver.call("clear")
        driver.call("move_by_speed", by_speed([3000, 0, 0]))
        wire.run(MS)
        wire.engine.set("probe", 1)
        driver.wait(1)
        assert driver.positions()[0] == wire.counted()[1][0] == 3000 + 500 * (lost == "disarm")


@pytest.mark.parametrize("call", ["turn_stop", "jog_cancel"])
def test_an_end_behind_a_hold_that_is_not_acknowledged(driver: Driver, wire: Wire, call: str) -> None:
    """It is not forgotten: a resume does not turn on."""
    driver.call("jog", jog())
    wire.run(20 * MS)
    wire.there = lambda _: None
    assert error_of(driver, "hold") == "STUCK_LOW"
    assert error_of(driver, call) == "NOT_HELD" and driver.fault == "NOT_STOPPED"
    wire.there = list
    finish(driver)
    driver.call("resume")
    wire.run(20 * MS)
    assert error_of(driver, "move_by_speed", by_speed([5, 0, 0, 0])) == "STOPPED"
    driver.call("clear")
    assert driver.positions() == wire.counted()[1]
    driver.call("move_by_speed", by_speed([5, 0, 0, 0]))


def test_a_move_behind_a_hold_that_is_not_acknowledged_has_no_such_end(driver: Driver, wire: Wire) -> None:
    """It continues with the resume, as without the call."""
    driver.call("move_by_speed", by_speed([9000, 0, 0, 0]))
    wire.run(5 * MS)
    wire.there = lambda _: None
    assert error_of(driver, "hold") == "STUCK_LOW"
    assert error_of(driver, "jog_cancel") == "NOT_HELD" and driver.fault == "NOT_HELD"
    wire.there = list
    driver.call("resume")
    finish(driver)
    assert driver.positions() == wire.counted()[1] == [9000, 0, 0, 0]
