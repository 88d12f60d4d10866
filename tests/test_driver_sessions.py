# SPDX-License-Identifier: MIT
"""What passo_open() finds and does: each row of the tables in docs/driver.md, "A new session".

`verify/soak/endings` lets the host die in any frame of any operation.
"""

from typing import Any

import pytest
from passo.build import Parameters
from passo.driver import Driver, Source
from passo.link import Hardware
from passo.native import ffi
from passo.registers import Cause, State, TriggerAction, TriggerSource

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    Q32,
    Wire,
    by_speed,
    configure,
    error_of,
    open_driver,
    path,
    struct,
)

MS = CLOCK_HZ // 1000
PARAMETERS = Parameters(axes=3, inputs=1, encoders=1, outputs=1, raster=1, compare=1)


@pytest.fixture
def first() -> Driver:
    """A session with soft stops of 2 ms and a probe."""
    driver = open_driver(Wire(PARAMETERS))
    driver.call("configure_motion", 2 * MS, 2 * MS, 0)
    driver.call("configure_probe", False)
    driver.engine.run(MS)
    return driver


def again(first: Driver, result: str = "OK") -> Driver:
    """Another host, which knows nothing of the first."""
    second = object.__new__(Driver)
    second.engine, second.clock_hz, second.lib, second._source = first.engine, CLOCK_HZ, first.lib, None
    second.hardware = Hardware(first.engine, 0, CLOCK_HZ)
    second.host, second.c = ffi().new("struct passo_host *"), ffi().new("struct passo *")
    second.options = first.options
    assert error_of(second, "open", second.host, second.hardware.c, second.options) == result
    return second


def moves(driver: Driver, steps: int = 300) -> None:
    """One move, exact and without a fault, while the probe acts."""
    wire = driver.engine
    configure(driver)
    before = wire.counted()[1][0]
    driver.call("move_by_speed", by_speed([steps, 0, 0]))
    wire.run(MS // 4)
    wire.engine.set("probe", 1)
    driver.wait(1)
    wire.engine.set("probe", 0)
    assert wire.counted()[1][0] - before == steps
    assert driver.positions() == wire.counted()[1] and driver.fault == "OK"


def jog(driver: Driver, **fields: Any) -> None:
    driver.call("jog", struct("jog", speed=20_000 * Q32, acceleration=2_000_000 * Q32, **fields))


def test_a_core_that_was_reset() -> None:
    """It is as it is."""
    wire = Wire(PARAMETERS)
    driver = Driver(wire)
    wire.collect()
    assert wire.enable == 0 and driver.positions() == [0, 0, 0]
    moves(driver)


def test_a_core_at_rest(first: Driver) -> None:
    """Positions, drives and levels stay, homes do not; an axis must be configured before it moves."""
    first.call("set_levels", 5)
    first.c.axis[0].homed = True
    moves(first)
    second = again(first)
    assert second.positions() == [300, 0, 0] and first.engine.enable == 7
    assert not second.lib.passo_is_homed(second.c, 0)
    state = struct("outputs_state")
    second.call("read_outputs", state)
    assert state.levels == 5
    assert error_of(second, "move_by_speed", by_speed([1, 0, 0])) == "NOT_CONFIGURED"
    moves(second)


@pytest.mark.parametrize("action", [TriggerAction.SOFT_STOP, TriggerAction.HARD_STOP])
def test_an_armed_trigger(first: Driver, action: TriggerAction) -> None:
    """It stops nothing of the new session."""
    first.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE, action=action))
    second = again(first)
    report = struct("trigger_report")
    second.call("read_trigger", report)
    assert not report.armed and not report.arming and not report.fired
    moves(second)


def test_armed_compare_points(first: Driver) -> None:
    """No pulse comes out."""
    wire = first.engine
    first.call("arm_compare", struct("compare_config", axis=0, position=1, interval=1, width=20))
    second = again(first)
    configure(second)
    second.call("move_by_speed", by_speed([100, 0, 0]))
    wire.engine.run(5 * MS)
    assert not wire.engine.drain()["compare"].any()


def test_raster_values_and_power(first: Driver) -> None:
    """The queue is empty, the power of later moves 0."""
    taken = struct("outputs_state")
    count = ffi().new("size_t *")
    first.call("push_raster", bytes([255] * 40), 40, count)
    first.call("set_output", struct("output", power=30000))
    second = again(first)
    second.call("read_outputs", taken)
    assert taken.raster_room == 1024 and second.c.output.power == 0
    moves(second)


def test_a_thread_and_its_encoder(first: Driver) -> None:
    """Motions have the core's clock, and no following error of the first session stops them."""
    for axis in range(3):
        config = struct("encoder_config", ratio=1 << 16, limit=1, stop=2)
        first.call("configure_encoder", axis, config)
    thread = struct("thread", encoder=2, steps=[100, 0, 0], counts=1000, top_speed=10_000 * Q32)
    thread.wait_index = True
    first.call("thread", thread)
    first.engine.run(MS)
    second = again(first)  # it waited for its index
    moves(second)


@pytest.mark.parametrize("what", ["sync", "closed", "stream"])
def test_a_motion_that_has_not_begun(first: Driver, what: str) -> None:
    """It never does."""
    wire = first.engine
    if what == "sync":
        first.call("wait_for_sync", True)
        first.call("move_by_speed", by_speed([500, 0, 0]))
    elif what == "closed":
        first.call("configure_filter", 60_000)
        first.call("move_by_speed", by_speed([500, 0, 0]))
    else:
        first.stream(Source(*path(200)))
        first.poll()
        first.poll()
    second = again(first)
    for level in (1, 0, 1):
        wire.engine.set("sync", level)
        wire.run(5 * MS)
    assert wire.counted()[0] == [0, 0, 0] and second.state == State.IDLE
    moves(second)


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("way", ["end", "stop", "abort"])
def test_a_motion_that_runs(first: Driver, way: str, held: bool) -> None:
    """It continues as commanded, what is queued behind it waits; then the channel is taken over."""
    wire = first.engine
    first.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE, action=1))
    first.call("move_by_speed", by_speed([2000, 0, 0]))
    first.call("move_by_speed", by_speed([2000, 0, 0]))
    first.engine.run(5 * MS)
    if held:
        first.call("hold")
        first.engine.run(5 * MS)
    second = again(first, "MOVING")
    assert error_of(second, "move_by_speed", by_speed([1, 0, 0])) == "BROKEN"
    if way == "end":
        second.call("resume")
    else:
        second.call(way)
    second.wait(1)
    second.call("clear")
    made = wire.counted()[1][0]
    assert made == 2000 if way == "end" else 0 < made < 2000
    assert second.positions()[0] == made
    moves(second)


def test_the_trigger_of_a_home_that_runs_is_left_to_it(first: Driver) -> None:
    """Otherwise the axis would run into its end."""
    wire = first.engine
    first.call("configure_watchdog", 0, 0)
    probe = struct("probe", steps=[5000, 0, 0], speed=20_000 * Q32, acceleration=2_000_000 * Q32)
    first.call("probe", probe)
    wire.run(10 * MS)
    second = again(first, "MOVING")
    wire.engine.set("probe", 1)
    wire.run(10 * MS)
    made = wire.counted()[1][0]
    assert 0 < made < 1000
    assert error_of(second, "wait", CLOCK_HZ) == "TRIGGER"
    second.call("clear")
    wire.engine.set("probe", 0)
    moves(second)


@pytest.mark.parametrize("name", ["stop", "abort"])
def test_a_stopped_core(first: Driver, name: str) -> None:
    """It is cleared."""
    jog(first)
    first.engine.run(10 * MS)
    first.call(name)
    first.engine.run(10 * MS)
    second = again(first)
    assert second.state == State.IDLE and second.cause == Cause.NONE
    moves(second)


@pytest.mark.parametrize("name", ["ESTOP", "ALARM"])
def test_a_core_that_is_kept_stopped(first: Driver, name: str) -> None:
    """It is open, and continues when that is over."""
    pin, active, idle = ("estop_n", 0, 1) if name == "ESTOP" else ("alarm", 1, 0)
    first.engine.engine.set(pin, active)
    first.engine.run(MS)
    second = again(first, name)
    assert error_of(second, "clear") == name
    first.engine.engine.set(pin, idle)
    first.engine.run(MS)
    if name == "ESTOP":
        second.call("clear_estop")
    second.call("clear")
    moves(second)


def test_override_and_hold_at_rest(first: Driver) -> None:
    """The rate is full."""
    first.call("override", 10)
    first.call("hold")
    first.engine.run(5 * MS)
    second = again(first)
    second.engine.run(5 * MS)
    assert second.snapshot().rate == 1 << 16
    moves(second)


def test_the_polarity_of_a_probe_outlives_cleared_flags(first: Driver) -> None:
    """The driver does not know it before it is configured."""
    readings = struct("readings")
    first.call("configure_probe", True)
    first.engine.run(MS)
    second = again(first)
    second.call("clear_flags")
    first.engine.run(MS)
    second.call("read_inputs", readings)
    assert readings.probe and not readings.unknown
    second.call("configure_probe", False)
    second.call("clear_flags")
    first.engine.run(MS)
    second.call("read_inputs", readings)
    assert not readings.probe and not readings.was_probe


def test_another_host(first: Driver) -> None:
    """It is taken over; the other one is notified with its next frame."""
    jog(first, steps=100)
    first.wait(1)
    second = again(first)
    moves(second)
    assert error_of(first, "move_by_speed", by_speed([1, 0, 0])) == "CORE_RESET"
    first.c.axis[0].homed = True
    assert not first.lib.passo_is_homed(first.c, 0)
