# SPDX-License-Identifier: MIT
"""Calls of the driver at the edges of what they take: the greatest values, none at all, the wrong motion."""

import pytest
from passo.driver import Source
from passo.native import ffi, planner
from passo.registers import Shape, TriggerAction, TriggerSource

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    Q32,
    Wire,
    by_speed,
    error_of,
    finish,
    open_driver,
    path,
    struct,
)
from tests.test_driver_goto import go
from tests.test_driver_home import Switch, driver_of, home, homes, machine_of, run_home

MOST = (1 << 30) - 1  # substeps of a line
MS = CLOCK_HZ // 1000
TURN = 1600


@pytest.mark.parametrize("distance", [MOST, -MOST])
def test_a_home_may_be_as_long_as_a_line(distance: int) -> None:
    """A step more is refused, either way."""
    driver = driver_of(machine_of())
    farther = distance + (1 if distance > 0 else -1)
    assert error_of(driver, "home", homes(home(distance=farther)), 1) == "TOO_MANY_STEPS"
    assert error_of(driver, "home", homes(home(distance=-(1 << 31))), 1) == "TOO_MANY_STEPS"
    assert error_of(driver, "home", homes(home(distance=distance)), 1) == "TOO_LONG"  # at this speed


@pytest.mark.parametrize("field", ["back_off", "pull_off"])
def test_a_way_off_a_switch_may_be_a_quarter_of_a_line(field: str) -> None:
    """Each of the two; a step more is refused."""
    driver = driver_of(machine_of())
    assert error_of(driver, "home", homes(home(**{field: MOST // 4 + 1})), 1) == "TOO_MANY_STEPS"
    driver.call("home", homes(home(**{field: MOST // 4})), 1)


@pytest.mark.parametrize("pull_off", [1, 2])
def test_a_home_ends_off_its_switch(pull_off: int) -> None:
    """By as many steps as asked for, a single one too."""
    driver = driver_of(machine_of(Switch("home", 0, -700)))
    assert run_home(driver, home(pull_off=pull_off, position=40)) == "OK"
    assert driver.positions()[0] == 40 + pull_off
    assert driver.engine.positions[0] == pytest.approx(-700 + pull_off, abs=1)


def test_a_trigger_that_stops_the_motion_is_waited_for() -> None:
    """The report tells the place."""
    switch = Switch("home", 0, 500, above=True)
    driver = driver_of(machine_of(switch))
    config = struct("trigger_config", source=TriggerSource.HOME, action=TriggerAction.SOFT_STOP)
    driver.call("arm_trigger", config)
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0], speed=20_000))
    report = struct("trigger_report")
    driver.call("wait_for_trigger", CLOCK_HZ, report)
    assert report.fired and report.positions[0] == pytest.approx(switch.edges[0][0], abs=1)


def test_what_turns_is_not_jogged() -> None:
    """Nor the other way round, nor a motion with a target."""
    driver = open_driver(Wire())
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    assert (
        error_of(driver, "jog_speed", 1000 * Q32) == error_of(driver, "turn_speed", 9 * Q32) == "NOT_TURNING"
    )
    turning = struct("turning", axis=0, steps_per_turn=TURN, top_rpm=60 * Q32, acceleration=100_000 * Q32)
    driver.call("turn_start", turning, 30 * Q32)
    assert error_of(driver, "jog_speed", 1000 * Q32) == "NOT_TURNING"
    driver.call("turn_speed", 40 * Q32)
    driver.call("turn_stop")
    finish(driver)
    driver.call("goto", go(50_000))
    assert error_of(driver, "turn_speed", 40 * Q32) == error_of(driver, "turn_stop") == "NOT_TURNING"


def test_a_change_may_be_as_late_as_can_be() -> None:
    """More than 2^30 us is taken for that."""
    driver = open_driver(Wire())
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    driver.call("goto", go(5000, late_clocks=1 << 40))
    assert driver.c.late == 1 << 30


def test_a_table_is_loaded_at_rest_alone() -> None:
    """Not in a motion, not while one is under way or stopped, not behind the gate of a stream."""
    driver = open_driver(Wire())
    driver.call("configure_motion", MS, MS, 0)
    load = "load_table", Shape.EASE, [n << 8 for n in range(256)]
    driver.call("move_by_speed", by_speed([3000, 0, 0, 0], speed=20_000))
    assert error_of(driver, *load) == "TABLE"
    driver.call("stop")
    driver.engine.run(10 * MS)
    assert error_of(driver, *load) == "STOPPED"
    driver.call("clear")
    driver.call("goto", go(5000))
    assert error_of(driver, *load) == "UNDER_WAY"
    driver.call("jog_cancel")
    finish(driver)
    driver.stream(Source(*path(9)))
    frames = driver.engine.frames
    assert error_of(driver, *load) == "STREAMING" and driver.engine.frames == frames
    finish(driver)
    driver.call(*load)
    assert driver.engine.frames - frames >= 5


def test_no_place_for_an_angle() -> None:
    """Nor a scale, nor an axis."""
    driver = open_driver(Wire())
    degrees = ffi().new("int64_t *")
    assert error_of(driver, "angle", 0, TURN, ffi().NULL) == "ARGUMENT"
    assert error_of(driver, "angle", 0, 0, ffi().NULL) == "ARGUMENT"
    assert error_of(driver, "angle", 0, 0, degrees) == "ARGUMENT"
    assert error_of(driver, "angle", 4, TURN, degrees) == "ARGUMENT"


@pytest.mark.parametrize("steps_per_turn", [1, 1600, 51_200])
def test_the_acceleration_of_a_motor_is_by_the_minute(steps_per_turn: int) -> None:
    """Of rpm in a second; a motor counts steps/s^2."""
    motor = struct("motor")
    driver = open_driver(Wire())
    assert not planner().passo_motor_init(motor, driver.c, 0, steps_per_turn, 0, 6000 * Q32)
    assert motor.acceleration == 100 * steps_per_turn * Q32
