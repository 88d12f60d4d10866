# SPDX-License-Identifier: MIT
"""Channels that start together: one write of RUN, one clock at the pins."""

import numpy as np
import pytest
from passo.build import Parameters
from passo.driver import Driver, Source
from passo.native import ffi, planner
from passo.registers import ADDRESS_RUN, State

from tests.helpers.driver_wire import CLOCK_HZ, Wire, by_speed, configure, error_of, finish, open_driver, path

PARAMETERS = Parameters(channels=3, axes=2)
MOVE = by_speed([300, -100])
MILLISECOND = CLOCK_HZ // 1000


class Scope(Wire):
    """The wire, and everything that the pins did."""

    def __init__(self) -> None:
        self.events: list[np.ndarray] = []
        super().__init__(PARAMETERS)

    def collect(self) -> None:
        """Store what the pins did."""
        self.events.append(self.engine.drain())

    def starts(self, name: str, stride: int) -> list[int | None]:
        """Clock at which a pin of each channel rose first."""
        self.collect()
        events = np.concatenate(self.events)
        found: list[int | None] = []
        for channel in range(PARAMETERS.channels):
            high = events[name].astype(np.uint64) >> np.uint64(stride * channel) & np.uint64(1) != 0
            found.append(int(events["clock"][high][0]) if high.any() else None)
        return found

    @property
    def run_words(self) -> list[int]:
        """The values written to RUN so far."""
        return [request[1] for request in self.requests if is_run(request)]


def is_run(request: list[int]) -> bool:
    return request[0] & 0xFFF == ADDRESS_RUN and request[0] >> 28 != 0


@pytest.fixture
def wire() -> Scope:
    return Scope()


@pytest.fixture
def drivers(wire: Scope) -> list[Driver]:
    """One of each channel; motions wait."""
    first = open_driver(wire, tries=3)
    made = [first, *(Driver(wire, channel=channel, beside=first) for channel in (1, 2))]
    for driver in made:
        configure(driver)
        driver.call("wait_for_sync", True)
        assert planner().passo_waits_for_sync(driver.c)
    return made


def queue(drivers: list[Driver], wire: Scope) -> None:
    """A move for each, at different times."""
    for driver in drivers:
        driver.call("move_by_speed", MOVE)
        wire.run(MILLISECOND)
    wire.requests.clear()


def start(drivers: list[Driver]) -> str:
    """passo_start_together(); return the name of its error."""
    lib = planner()
    error = lib.passo_start_together([driver.c for driver in drivers], len(drivers))
    return ffi().string(lib.passo_error_name(error)).decode()


def test_one_write_starts_all_on_one_clock(drivers: list[Driver], wire: Scope) -> None:
    """Their first steps leave the pins on the same clock."""
    queue(drivers, wire)
    assert start(drivers) == "OK"
    (word,) = wire.run_words
    assert word & 0xFF == 7 and word >> 8 & 0xFF == 0
    assert not any(planner().passo_waits_for_sync(driver.c) for driver in drivers)
    for driver in drivers:
        finish(driver)
        assert driver.positions() == [300, -100]
    for name, stride in (("running", 1), ("step", 2)):
        (clock,) = set(wire.starts(name, stride))
        assert clock is not None


def test_others_wait_on(drivers: list[Driver], wire: Scope) -> None:
    """Only the channels that were named and counted start; the other one does with the next call."""
    queue(drivers, wire)
    lib = planner()
    assert lib.passo_start_together([drivers[n].c for n in (2, 0, 1)], 2) == lib.PASSO_OK
    assert lib.passo_waits_for_sync(drivers[1].c) and not lib.passo_waits_for_sync(drivers[0].c)
    wire.run(50 * MILLISECOND)
    early = wire.starts("running", 1)
    assert early[0] == early[2] is not None and early[1] is None
    assert start([drivers[1]]) == "OK"
    finish(drivers[1])
    assert wire.starts("running", 1)[1] is not None


def test_a_motion_queued_just_now_starts_with_the_others(drivers: list[Driver], wire: Scope) -> None:
    """The call waits until it is ready."""
    for driver in drivers:
        driver.call("move_by_speed", MOVE)
    assert start(drivers) == "OK"
    wire.run(MILLISECOND)
    assert len(set(wire.starts("running", 1))) == 1


def test_streams_start_together(drivers: list[Driver], wire: Scope) -> None:
    """Not before their queues are filled."""
    sources = [Source(*path(500)) for _ in drivers]
    for driver, source in zip(drivers, sources, strict=True):
        driver.stream(source)
    assert start(drivers) == "NOT_PREPARED"
    while any(driver.state != State.ARMED for driver in drivers):
        for driver in drivers:
            driver.poll()
        wire.run(500)
    assert start(drivers) == "OK"
    while any(driver.is_moving for driver in drivers):
        for driver in drivers:
            driver.poll()
        wire.run(500)
    assert [driver.positions() for driver in drivers] == [[1000, -500]] * 3
    assert len(set(wire.starts("running", 1))) == 1


def test_what_is_not_prepared_starts_nothing(drivers: list[Driver], wire: Scope) -> None:
    """A channel with nothing queued, one in motion, one that is stopped, one that does not wait."""
    one, two, three = drivers
    two.call("move_by_speed", MOVE)
    assert start([one, two]) == "NOT_PREPARED"
    one.call("wait_for_sync", False)
    one.call("move_by_speed", by_speed([30_000, 0]))
    assert start([one, two]) == "NOT_PREPARED"
    one.call("wait_for_sync", True)
    assert start([one, two]) == "NOT_PREPARED"
    three.call("abort")
    assert start([two, three]) == "STOPPED"
    other = open_driver(Scope())
    assert start([two, other]) == "ARGUMENT"
    lib = planner()
    assert lib.passo_start_together(ffi().NULL, 1) == lib.PASSO_ERROR_ARGUMENT_POINTER
    assert lib.passo_start_together([two.c, ffi().NULL], 2) == lib.PASSO_ERROR_ARGUMENT_POINTER
    for count in (0, 9):
        assert lib.passo_start_together([two.c] * 9, count) == lib.PASSO_ERROR_ARGUMENT_CHANNEL
    wire.run(MILLISECOND)
    assert wire.starts("running", 1)[1] is None


@pytest.mark.parametrize("executed", [False, True])
def test_a_lost_start_starts_all_or_none(drivers: list[Driver], wire: Scope, executed: bool) -> None:
    """The request or its reply gets lost each time: then the motions that have not started wait on."""
    queue(drivers, wire)
    if executed:
        wire.back = lambda miso: [0] * len(miso) if is_run(wire.requests[-1]) else miso
    else:
        wire.there = lambda mosi: None if is_run(mosi) else mosi
    assert start(drivers) != "OK"
    wire.back, wire.there = list, list
    assert drivers[1].fault == "NOT_HELD"
    for _ in range(3):
        for driver in drivers:
            driver.poll()
    assert drivers[1].fault == "OK"
    wire.run(50 * MILLISECOND)
    clocks = set(wire.starts("running", 1))
    assert len(clocks) == 1 and (clocks != {None}) == executed
    assert error_of(drivers[0], "read_state", ffi().new("struct passo_snapshot *")) == "OK"
    assert start(drivers) == ("NOT_PREPARED" if executed else "OK")
