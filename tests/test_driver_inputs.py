# SPDX-License-Identifier: MIT
"""Inputs of the driver (stm32_bridge/driver/passo_inputs.h): settings, readings, triggers, stops."""

from typing import Any

import pytest
from passo.driver import Driver, DriverError
from passo.machine import Switch
from passo.native import ffi
from passo.registers import Cause, State, TriggerSource

from tests.helpers.driver_wire import CLOCK_HZ, Wire, by_speed, error_of, open_driver, struct
from tests.test_driver_home import driver_of, jog, machine_of, report_of

UNIT = 1 << 16


def readings(driver: Driver) -> Any:
    now = struct("readings")
    driver.call("read_inputs", now)
    return now


def test_a_core_without_inputs() -> None:
    """Each call says so."""
    driver = open_driver(Wire())
    assert error_of(driver, "configure_filter", 5) == "NO_INPUTS"
    assert error_of(driver, "configure_inputs", 0, struct("input_config")) == "NO_INPUTS"
    assert error_of(driver, "configure_watchdog", UNIT, 0) == "NO_INPUTS"
    assert error_of(driver, "clear_estop") == error_of(driver, "disarm_trigger") == "NO_INPUTS"
    assert error_of(driver, "read_inputs", struct("readings")) == "NO_INPUTS"


def test_settings_that_contradict() -> None:
    """Each has its error."""
    driver = driver_of(machine_of())
    driver.call("configure_filter", 65535)
    assert error_of(driver, "configure_filter", 65536) == "FILTER_TOO_LONG"
    assert error_of(driver, "configure_filter", 1 << 32) == "FILTER_TOO_LONG"
    driver.call("configure_watchdog", 1023 * UNIT, 1023 * UNIT)
    assert error_of(driver, "configure_watchdog", 1023 * UNIT + 1, 0) == "WATCHDOG_TOO_LONG"
    assert error_of(driver, "configure_watchdog", UNIT, 2**64 - 1) == "WATCHDOG_TOO_LONG"
    assert error_of(driver, "configure_watchdog", 0, UNIT) == "ARGUMENT"
    assert error_of(driver, "configure_inputs", 4, struct("input_config")) == "ARGUMENT"
    assert error_of(driver, "arm_trigger", struct("trigger_config")) == "NO_SOURCE"
    assert error_of(driver, "arm_trigger", struct("trigger_config", source=6)) == "ARGUMENT"
    assert error_of(driver, "arm_trigger", struct("trigger_config", source=1, axis=4)) == "ARGUMENT"
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0]))
    assert error_of(driver, "configure_inputs", 0, struct("input_config")) == "MOVING"


def test_levels_and_flags() -> None:
    """What is active, and what was."""
    machine = machine_of()
    driver = driver_of(machine, home_inverted=True)
    machine.set("limit_low", 2)
    machine.set("home", 7)
    machine.set("probe", 1)
    machine.run(10_000)
    now = readings(driver)
    assert (now.limit_low, now.home, now.probe, now.alarm, now.estop) == (2, 8, True, 0, False)
    machine.set("limit_low", 0)
    machine.set("probe", 0)
    machine.run(10_000)
    now = readings(driver)
    assert (now.limit_low, now.was_limit_low, now.probe, now.was_probe) == (0, 2, False, True)
    driver.call("clear_flags")
    now = readings(driver)
    assert (now.was_limit_low, now.was_probe, now.was_home) == (0, False, 8)


def test_trigger_latches_and_is_waited_for() -> None:
    """The position of the edge; only once; the move continues."""
    switch = Switch("home", 0, 500, above=True)
    driver = driver_of(machine_of(switch))
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.HOME))
    driver.call("move_by_speed", by_speed([2000, 0, 0, 0], speed=20_000))
    report = struct("trigger_report")
    driver.call("wait_for_trigger", 0, report)
    assert report.positions[0] == pytest.approx(switch.edges[0][0], abs=1)
    assert report.fired and not report.armed
    driver.wait(1)
    assert driver.positions()[0] == 2000 and driver.state == State.IDLE
    driver.call("disarm_trigger")
    assert not report_of(driver).fired
    assert error_of(driver, "wait_for_trigger", 0, report) == "NO_SOURCE"
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE))
    assert error_of(driver, "wait_for_trigger", CLOCK_HZ // 100, report) == "TIMEOUT"


def test_timeout_longer_than_the_clock_counts() -> None:
    """The microseconds wrap at 2^32, 71 minutes; a timeout of hours does not."""
    driver = driver_of(machine_of(Switch("home", 0, 500, above=True)))
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.HOME))
    now, waits = 0, 0

    def wait(_: Any, __: int) -> None:
        nonlocal now, waits
        now, waits = now + (1 << 31), waits + 1

    clock = ffi().callback("uint32_t(void *)", lambda _: now & 0xFFFFFFFF)
    waiting = ffi().callback("void(void *, uint32_t)", wait)
    driver.host.hardware.microseconds, driver.host.hardware.wait = clock, waiting
    hours = (10 << 32) * CLOCK_HZ // 10**6
    assert error_of(driver, "wait_for_trigger", hours, struct("trigger_report")) == "TIMEOUT"
    assert waits == 20
    waits = 0
    driver.call("jog", jog())
    assert error_of(driver, "wait", hours) == "TIMEOUT"
    assert waits == 20


def test_alarm_keeps_it_stopped() -> None:
    """Its name, its axis; clear says so until it is over; then nothing moves."""
    machine = machine_of()
    driver = driver_of(machine, alarm_disables=True)
    driver.call("jog", jog(axis=1))
    machine.run(CLOCK_HZ // 50)
    machine.set("alarm", 4)
    with pytest.raises(DriverError, match="ALARM"):
        driver.wait(1)
    there = machine.positions.tolist()
    assert machine.enable == 0b1011 and readings(driver).axes == 4
    assert error_of(driver, "clear") == "ALARM" and driver.cause == Cause.ALARM
    machine.set("alarm", 0)
    machine.run(10_000)
    driver.call("clear")
    machine.run(CLOCK_HZ // 100)
    driver.poll()
    assert machine.positions.tolist() == there == [0, driver.positions()[1], 0, 0]


@pytest.mark.parametrize("pin", ["estop_n", "alarm"])
def test_stuck_at_power_up(pin: str) -> None:
    """The channel opens stopped, can be configured, and continues when that is over."""
    machine = machine_of()
    machine.set(pin, 0 if pin == "estop_n" else 15)
    name = "ESTOP" if pin == "estop_n" else "ALARM"
    driver = Driver.__new__(Driver)
    with pytest.raises(DriverError, match=name):
        driver.__init__(machine)  # type: ignore[misc]
    assert driver.fault == name
    assert error_of(driver, "move_by_speed", by_speed([1, 0, 0, 0])) == "STOPPED"
    inverted = struct("input_config", alarm_inverted=pin == "alarm")
    for axis in range(4):
        driver.call("configure_inputs", axis, inverted)
    machine.set("estop_n", 1)
    machine.run(10_000)
    if pin == "estop_n":
        driver.call("clear_estop")
    driver.call("clear")
    assert driver.fault == "OK" and driver.state == State.IDLE


def test_a_limit_switch_stuck_at_power_up() -> None:
    """It stops nothing at rest, makes no step toward it, and lets the axis go away."""
    machine = machine_of()
    machine.set("limit_high", 1)
    driver = driver_of(machine)
    assert driver.fault == "OK" and driver.state == State.IDLE
    driver.call("move_by_speed", by_speed([50, 0, 0, 0]))
    machine.run(CLOCK_HZ // 10)
    with pytest.raises(DriverError, match="LIMIT"):
        driver.poll()
    assert machine.positions.tolist() == driver.positions()[:4] == [0, 0, 0, 0]
    driver.call("clear")
    driver.call("move_by_speed", by_speed([-50, 0, 0, 0]))
    machine.run(CLOCK_HZ)
    driver.poll()
    assert machine.positions.tolist() == [-50, 0, 0, 0]


@pytest.mark.parametrize("high", [1, 2])
def test_a_switch_that_flickers_on_every_clock(high: int) -> None:
    """The filter lets no level pass: no stop, no flag, no edge for the trigger."""
    machine = machine_of()
    driver = driver_of(machine)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.HOME))
    driver.call("move_by_speed", by_speed([100, 0, 0, 0]))
    for clock in range(20_000):
        machine.engine.set("home", int(clock % (high + 1) < high))
        machine.engine.set("limit_high", int(clock % (high + 1) < high))
        machine.engine.run(1)
    for pin in ("home", "limit_high"):
        machine.engine.set(pin, 0)
    driver.wait(1)
    assert driver.positions()[0] == 100 and not report_of(driver).fired
    assert not readings(driver).was_home and not readings(driver).was_limit_high


def test_watchdog() -> None:
    """On after open; a silent host: a soft stop, with a name and an exact position; off if told so."""
    machine = machine_of()
    driver = driver_of(machine)
    driver.call("configure_watchdog", 20 * UNIT, 0)
    driver.call("jog", jog(axis=0))
    machine.run(40 * UNIT)
    there = int(machine.positions[0])
    machine.run(40 * UNIT)
    assert machine.positions[0] == there
    with pytest.raises(DriverError, match="WATCHDOG"):
        driver.wait(1)
    driver.call("clear")
    assert driver.positions()[0] == there and machine.enable == 15
    driver.options.watchdog_clocks = 2**64 - 1
    driver.open()
    assert error_of(driver, "configure_watchdog", 0, 0) == "OK"


def test_the_watchdog_is_on_by_default() -> None:
    """Half a second."""
    machine = machine_of()
    driver = driver_of(machine)
    driver.call("jog", jog(axis=0))
    machine.run(CLOCK_HZ // 2)
    there = int(machine.positions[0])
    machine.run(3 * UNIT)
    stopped = int(machine.positions[0])
    machine.run(10 * UNIT)
    assert there < stopped == machine.positions[0]
