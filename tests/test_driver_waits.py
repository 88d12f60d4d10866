# SPDX-License-Identifier: MIT
"""The driver's waits: for a trigger, for an end, for a host that is late; what it does meanwhile."""

from typing import Any

import numpy as np
import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, Source
from passo.link import Hardware
from passo.machine import Switch
from passo.native import ffi, planner
from passo.registers import State, TriggerAction, TriggerSource

from tests.helpers.driver_wire import (
    CLOCK_HZ,
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
from tests.test_driver_goto import go
from tests.test_driver_goto import run as run_goto
from tests.test_driver_home import driver_of, machine_of
from tests.test_driver_sessions import PARAMETERS

MS = CLOCK_HZ // 1000
STATE = r.ADDRESS_CHANNEL_BASE + r.CHANNEL_STATE
SHORT = Parameters(channels=2, line_queue_log2=4, ramp_queue_log2=4)


class Waiting(Hardware):
    """Hardware that notes how long it is told to wait."""

    def __init__(self, engine: Any, tries: int = 0, clock_hz: int = 0):
        self.waits: list[int] = []
        super().__init__(engine, tries, clock_hz)

    def _wait(self, context: Any, microseconds: int) -> None:
        self.waits.append(microseconds)
        super()._wait(context, microseconds)


def waiting(driver: Driver) -> list[int]:
    """The waits of a driver from now on, microseconds."""
    driver.hardware = Waiting(driver.engine, 0, CLOCK_HZ)
    driver.host.hardware = driver.hardware.c[0]
    return driver.hardware.waits


class Trace(Wire):
    """A wire that keeps the clocks of the steps of axis 0."""

    def __init__(self, parameters: Parameters = Parameters()) -> None:  # noqa: B008
        self.clocks: list[int] = []
        super().__init__(parameters)

    def collect(self) -> None:
        """Note the steps."""
        drain = self.engine.drain
        self.engine.drain = self._noted  # type: ignore[method-assign]
        try:
            super().collect()
        finally:
            self.engine.drain = drain  # type: ignore[method-assign]

    def _noted(self) -> Any:
        events = type(self.engine).drain(self.engine)
        step = np.concatenate([[int(self._step) & 1], events["step"].astype(np.int64) & 1])
        self.clocks += events["clock"][np.flatnonzero(np.diff(step) == 1)].tolist()
        return events

    def steepest(self) -> float:
        """The greatest change of the speed, steps/s^2, between two spans of some steps."""
        self.collect()
        steps = min(40, len(self.clocks) // 4)
        clocks = np.array(self.clocks, dtype=float) / CLOCK_HZ
        at = clocks[::steps]
        speeds, middles = steps / np.diff(at), (at[1:] + at[:-1]) / 2
        return float(np.abs(np.diff(speeds) / np.diff(middles)).max())


# -------------------------------------------------------------------------------------------- waiting ----


@pytest.mark.parametrize("action", [TriggerAction.HARD_STOP, TriggerAction.SOFT_STOP])
def test_a_wait_for_a_trigger_that_stops(action: TriggerAction) -> None:
    """It looks once in a millisecond, and the stop of the trigger is what it waits for."""
    switch = Switch("home", 0, 900, above=True)
    driver = driver_of(machine_of(switch))
    waits = waiting(driver)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.HOME, action=action))
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0], speed=20_000))
    report, frames = struct("trigger_report"), driver.counters.frames
    driver.call("wait_for_trigger", CLOCK_HZ, report)
    assert report.fired and report.positions[0] == pytest.approx(switch.edges[0][0], abs=1)
    assert 30 < len(waits) < 60 and set(waits) == {1000}
    assert driver.counters.frames - frames <= 3 * len(waits) + 3


def test_a_wait_for_a_trigger_ends_with_another_stop() -> None:
    """A limit on the way is reported."""
    driver = driver_of(machine_of(Switch("limit_high", 0, 500, above=True)), limit_soft=False)
    waiting(driver)
    driver.call("arm_trigger", struct("trigger_config", source=TriggerSource.PROBE))
    driver.call("move_by_speed", by_speed([5000, 0, 0, 0], speed=20_000))
    assert error_of(driver, "wait_for_trigger", CLOCK_HZ, struct("trigger_report")) == "LIMIT"


def test_a_wait_is_for_some_time(driver: Driver) -> None:
    """Never for none, and no longer than what is left of the timeout."""
    waits = waiting(driver)
    driver.call("move_by_speed", by_speed([3000, 0, 0, 0], speed=20_000))
    assert error_of(driver, "wait", 1500 * CLOCK_HZ // 1_000_000) == "TIMEOUT"
    assert sum(waits) <= 1500
    driver.wait(1)
    assert min(waits) > 0 and max(waits) <= 1000


def test_an_idle_time_ends_when_a_poll_reads(driver: Driver) -> None:
    """Before it a poll sends nothing; it is a millisecond at most."""
    driver.call("move_by_speed", by_speed([20_000, 0, 0, 0], speed=20_000))
    poll(driver)
    for _ in range(5):
        left, frames = driver.idle_microseconds, driver.engine.frames
        assert 0 < left <= 1000
        driver.engine.run((left // 2) * 72)
        assert left // 2 - 2 <= driver.idle_microseconds <= left - left // 2
        poll(driver)
        assert driver.engine.frames == frames
        driver.engine.run((left - left // 2 + 1) * 72)
        assert driver.idle_microseconds == 0
        poll(driver)
        assert driver.engine.frames == frames + 1
    driver.call("abort")


def test_a_channel_that_is_not_open_has_no_idle_time() -> None:
    """There is nothing to wait for."""
    assert planner().passo_idle_time(ffi().new("struct passo *")) == 0


def test_one_reading_is_no_end(driver: Driver, wire: Wire) -> None:
    """Words of a read are of different clocks: a rest needs two in a row."""
    forged = [False]
    idle = {
        STATE: 1 << r.CHANNEL_STATE_QUIET_LSB,
        STATE + 2: driver.c.line_places << 16 | driver.c.ramp_places,
    }
    answer_reads(wire, lambda at, word: idle.get(at, word) if forged[0] else word)
    driver.call("move_by_speed", by_speed([3000, 0, 0, 0], speed=20_000))
    for n in range(20):
        forged[0] = n % 2 == 0
        wire.run(MS + 72)
        driver.poll()
        assert driver.is_moving
    forged[0] = False
    finish(driver)
    assert driver.fault == "OK" and driver.positions()[0] == 3000


def test_unknown_inputs_at_rest_are_no_error() -> None:
    """Nothing waits for them: an idle driver only reads its state."""
    driver = driver_of(machine_of())
    driver.call("configure_filter", 65535)
    for n in range(600):
        driver.engine.set("home", n % 2)
        driver.engine.run(MS // 2)
        frames = driver.counters.frames
        driver.poll()
        assert driver.counters.frames - frames <= 1
    assert driver.fault == "OK"


def test_the_fault_of_a_probe_that_finds_is_none() -> None:
    """In no poll, though its trigger stops the channel, and steps are at the pins for milliseconds."""
    driver = driver_of(machine_of(Switch("probe", 0, 50, above=True)))
    times = ("step_high_ns", "step_low_ns", "dir_setup_ns", "dir_hold_ns")
    driver.call("configure_axis", 0, struct("axis_config", **dict.fromkeys(times, 900_000)))
    probe = struct("probe", steps=[200, 0, 0, 0], speed=300 * Q32, acceleration=500_000 * Q32)
    driver.call("probe", probe)
    while driver.is_moving:
        driver.engine.run(MS // 10)
        driver.poll()
        assert driver.fault == "OK"
    assert driver.positions()[0] >= 50


# ---------------------------------------------------------------------------------- a host that is late ----


def turning(driver: Driver, rpm: int = 600) -> None:
    """A shaft of 1600 steps per turn."""
    fields = {"axis": 0, "steps_per_turn": 1600, "top_rpm": 1200 * Q32, "acceleration": 20_000 * Q32}
    driver.call("turn_start", struct("turning", **fields), rpm * Q32)


@pytest.fixture
def shaft(wire: Wire) -> Driver:
    """It turns."""
    driver = open_driver(wire)
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    turning(driver)
    driver.engine.run(CLOCK_HZ)
    driver.poll()
    return driver


def test_a_host_that_is_always_late_gives_up(shaft: Driver) -> None:
    """After three tries; the speed stays."""
    wire = shaft.engine
    wire.before_frame = lambda _: wire.engine.run(3 * MS)
    frames = wire.frames
    assert error_of(shaft, "turn_speed", 700 * Q32) == "LATE"
    assert wire.frames - frames <= 6
    wire.before_frame = lambda _: None
    before = wire.counted()[1][0]
    wire.run(CLOCK_HZ // 10)
    assert wire.counted()[1][0] - before == pytest.approx(1600, abs=2)
    shaft.call("turn_stop")
    finish(shaft)


def test_a_host_that_gets_slower_stops_by_a_ramp(shaft: Driver) -> None:
    """Each frame takes half as long again as the one before; it gets twice the time of the last try."""
    wire, delay = shaft.engine, [2.0 * MS]

    def slower(_: int) -> None:
        wire.engine.run(int(delay[0]))
        delay[0] *= 1.2

    wire.before_frame = slower
    shaft.call("turn_stop")
    wire.before_frame = lambda _: None
    finish(shaft)
    assert shaft.fault == "OK" and shaft.state == State.IDLE


@pytest.mark.parametrize("after", [60, 120, 300])
@pytest.mark.parametrize("rpm", [0, 60, 300, 599, 900])
def test_no_change_of_a_speed_is_steep(after: int, rpm: int) -> None:
    """Whenever it comes, the shaft has its acceleration."""
    driver = open_driver(Trace())
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    turning(driver)
    driver.engine.run(after * MS)
    driver.poll()
    driver.call("turn_speed", rpm * Q32) if rpm else driver.call("turn_stop")
    driver.engine.run(CLOCK_HZ)
    if rpm:
        driver.call("turn_stop")
    finish(driver)
    assert driver.engine.steepest() <= 20_000 * 1.05


def test_a_stop_that_comes_with_the_first_step_is_not_steep() -> None:
    """At its sync edge the shaft begins with a jump, which was not there yet: the ramp is long enough."""
    wire, acceleration, minimum = Trace(), 10_000_000, 8000
    driver = open_driver(wire)
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    fields = {"top_rpm": 60_000 * Q32, "minimum_rpm": minimum * Q32, "acceleration": acceleration * Q32}
    driver.call("wait_for_sync", True)
    driver.call("turn_start", struct("turning", axis=0, steps_per_turn=60, **fields), 40_000 * Q32)
    pushed = wire.frames + 2

    def begin(number: int) -> None:
        if number == pushed:
            wire.engine.set("sync", 1)
            wire.engine.run(MS * 4 // 5)

    wire.before_frame = begin
    driver.call("turn_stop")
    finish(driver)
    wire.collect()
    times = np.diff(np.array(wire.clocks) / CLOCK_HZ)
    speeds = 1 / times
    assert speeds.max() > 1.5 * minimum
    slopes = np.diff(speeds) * 2 / (times[1:] + times[:-1])
    assert np.abs(slopes).max() <= 1.1 * acceleration


@pytest.mark.parametrize("difference", range(-60, 61, 12))
def test_the_ramp_to_a_speed_nearby_is_long_enough(wire: Wire, difference: int) -> None:
    """From the speed that the shaft has, which still rises, to one just above or below it."""
    driver = open_driver(wire)
    turning(driver)
    driver.engine.run(150 * MS)
    unit = driver.c.oversampling / CLOCK_HZ * 2**48  # of a velocity, in steps/s
    before = (driver.snapshot().velocity << 16) / unit
    rpm = (before + difference) * 60 / 1600
    wire.requests.clear()
    wire.before_frame = lambda _: wire.engine.run(2 * MS // 5)
    driver.call("turn_speed", int(rpm * Q32))
    wire.before_frame = lambda _: None
    (pushed,) = (request for request in wire.requests if request[0] >> 28 == r.Operation.PUSH)
    seconds = pushed[3] * 128 / CLOCK_HZ
    # when the ramp arrives, it is 16 steps/s faster, or a bit more
    assert seconds * 20_000 >= (16 - difference if difference < 16 else difference - 28) - 0.2
    driver.call("turn_stop")
    finish(driver)


# --------------------------------------------------------------------------------------- a nearer target ----


@pytest.mark.parametrize("nearer", [1, 100, 300])
def test_a_target_too_near_is_left_soon(wire: Wire, nearer: int) -> None:
    """It stops as soon as it can and comes back, whatever the target before was."""
    driver = open_driver(wire)
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    driver.call("goto", go(30_000, 20_000))
    run_goto(driver, 300)
    here = wire.counted()[1][1]
    driver.call("goto", go(here + nearer, 20_000))
    farthest = here
    while driver.is_moving:
        driver.poll()
        wire.run(MS)
        farthest = max(farthest, wire.counted()[1][1])
    assert farthest - here < 20_000**2 / (2 * 200_000) + 20_000 * 0.005
    assert driver.positions()[1] == here + nearer


def test_a_target_too_near_after_one_behind(wire: Wire) -> None:
    """It slows down as the last call says, though it is coming to rest already."""
    driver = open_driver(wire)
    driver.call("configure_motion", 50 * MS, 50 * MS, 0)
    driver.call("goto", go(30_000, 20_000))
    run_goto(driver, 300)
    driver.call("goto", go(wire.counted()[1][1] - 1000, 20_000))
    here = wire.counted()[1][1]
    driver.call("goto", go(here + 70, 20_000, acceleration=2_000_000 * Q32))
    farthest = here
    while driver.is_moving:
        driver.poll()
        wire.run(MS)
        farthest = max(farthest, wire.counted()[1][1])
    assert farthest - here < 20_000**2 / (2 * 2_000_000) + 20_000 * 0.005
    assert driver.positions()[1] == here + 70


# ---------------------------------------------------------------------------------------- other motions ----


def test_a_stream_after_a_thread_has_the_cores_clock() -> None:
    """The spindle is at rest."""
    driver = open_driver(Wire(PARAMETERS))
    driver.call("configure_motion", 2 * MS, 2 * MS, 0)
    thread = {"encoder": 2, "counts": 1000, "top_speed": 10_000 * Q32, "steps": [500]}
    driver.call("thread", struct("thread", **thread))
    driver.call("abort")
    driver.engine.run(MS)
    driver.call("clear")
    driver.stream(Source(*path(50)))
    finish(driver)
    assert driver.positions()[:2] == [100, -50]


def test_a_stream_may_wait_for_its_source(driver: Driver) -> None:
    """As long as it likes, behind its gate; a poll has something to do as long as there are items."""
    lines, ramps = path(20)
    driver.stream(Source([*lines[:5], *[None] * 3000, *lines[5:]], ramps))
    assert driver.idle_microseconds == 0
    for _ in range(300):
        driver.poll()
        driver.engine.run(MS)
    assert driver.fault == "OK" and driver.engine.counted()[0] == [0, 0, 0, 0]
    finish(driver)
    assert driver.positions()[:2] == [40, -20]


def test_a_damaged_reply_is_no_reason_not_to_start() -> None:
    """The states of the channels are read again."""
    wire = Wire(Parameters(channels=2, axes=2))
    first = open_driver(wire)
    drivers = [first, Driver(wire, channel=1, beside=first)]
    for driver in drivers:
        configure(driver)
        driver.call("wait_for_sync", True)
        driver.call("move_by_speed", by_speed([100, 0]))
    wire.run(MS)
    bad = [0]

    def back(words: list[int]) -> list[int]:
        bad[0] += 1
        return [word ^ 0x55 for word in words] if bad[0] % 2 else words

    wire.back = back
    assert planner().passo_start_together([driver.c for driver in drivers], 2) == 0
    wire.back = list
    for driver in drivers:
        finish(driver)
        assert driver.positions() == [100, 0]
