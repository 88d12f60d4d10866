# SPDX-License-Identifier: MIT
"""The driver with exchanges in two halves: while one frame is on the wire, the next one is prepared.

What is prepared may have to wait or to be forgotten: every line is made exactly once, or not after a stop.
"""

import random

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.registers import Cause, Operation

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    Dma,
    Noise,
    Wire,
    by_speed,
    configure,
    error_of,
    finish,
    open_driver,
    path,
    poll,
)

STREAM = 1500  # lines
COMMAND, RATE = r.ADDRESS_CHANNEL_BASE + r.CHANNEL_COMMAND, r.ADDRESS_CHANNEL_BASE + r.CHANNEL_RATE_TARGET
ALL = [2 * STREAM, STREAM, 0, 0], [2 * STREAM, -STREAM, 0, 0]


@pytest.fixture(autouse=True)
def dma(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("passo.driver.Hardware", Dma)


@pytest.fixture
def wire() -> Wire:
    return Wire()


def is_ahead(driver: Driver) -> bool:
    """A frame is on the wire, and the next one is prepared."""
    return driver.hardware.on_wire and driver.c.packed_lines + driver.c.packed_ramps > 0


def stream_until_ahead(driver: Driver, moving: bool = False) -> None:
    """A stream that fills the queues; or one that moves, faster than lines arrive, so that there is room."""
    driver.stream(Source(*path(STREAM, clocks=24 if moving else 72)))
    while not (is_ahead(driver) and (driver.c.stream == driver.lib.PASSO_STREAM_RUNS) == moving):
        assert driver.is_streaming
        poll(driver)
        driver.engine.run(driver.idle_microseconds * (CLOCK_HZ // 1_000_000))


def requests(wire: Wire) -> list[tuple[int, int]]:
    """Operation and address of the frames so far."""
    return [(words[0] >> 28, words[0] & 0xFFF) for words in wire.requests]


def sequences(wire: Wire) -> list[int]:
    """Numbers of the writes and pushes so far."""
    return [words[0] >> 20 & 0xFF for words in wire.requests if words[0] >> 28 != Operation.READ]


def test_the_wire_is_hardly_ever_idle(wire: Wire) -> None:
    """While lines are streamed, a poll that ends a frame begins the next."""
    driver = open_driver(wire)
    stream_until_ahead(driver)
    frames = polls = 0
    for _ in range(20):
        poll(driver)
        polls += 1
        frames += driver.hardware.on_wire
    assert frames == polls
    finish(driver)
    assert wire.counted() == ALL


def test_a_command_goes_before_what_is_prepared(wire: Wire) -> None:
    """Hold, resume and override wait for the frame on the wire only; what is prepared gets another number."""
    driver = open_driver(wire)
    driver.stream(Source(*path(STREAM)))
    ahead = 0
    while driver.c.stream != driver.lib.PASSO_STREAM_RUNS:
        poll(driver)
        if not is_ahead(driver):
            continue
        ahead += 1
        wire.requests.clear()
        for call, arguments in (("hold", ()), ("resume", ()), ("override", (100,))):
            driver.call(call, *arguments)
        assert requests(wire)[1:] == [(Operation.WRITE, RATE)] * 3
        while len(wire.requests) == 4:
            poll(driver)
        assert requests(wire)[4][0] == Operation.PUSH
        assert sequences(wire)[4] == sequences(wire)[3] % 255 + 1
    finish(driver)
    assert wire.counted() == ALL and driver.counters.retries == 0
    assert ahead > 3


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("how", ["stop", "abort"])
def test_a_stop_forgets_what_is_prepared(wire: Wire, how: str, moving: bool) -> None:
    """The stop waits for the frame on the wire only; the next stream begins with its own lines.

    In a soft stop the path continues, with what is prepared.
    """
    driver = open_driver(wire)
    stream_until_ahead(driver, moving)
    goes_on = how == "stop" and moving
    wire.requests.clear()
    driver.call(how)
    assert driver.is_streaming == goes_on
    assert [operation for operation, _ in requests(wire)] == [Operation.PUSH, Operation.WRITE]
    assert requests(wire)[1][1] == COMMAND
    finish(driver)
    assert not driver.is_streaming
    assert any(operation == Operation.PUSH for operation, _ in requests(wire)[1:]) == goes_on
    assert driver.cause == (Cause.ABORT if how == "abort" else Cause.STOP)
    driver.call("clear")
    at = driver.positions()
    assert at == wire.counted()[1]
    before = wire.counted()[0]
    driver.stream(Source(*path(STREAM)))
    finish(driver)
    assert [b - a for a, b in zip(before, wire.counted()[0], strict=True)] == ALL[0]
    assert driver.positions() == wire.counted()[1]


def test_a_stop_while_the_frame_on_the_wire_gets_lost(wire: Wire) -> None:
    """The wire is cut below the frame and below the stop: a poll brings the stop, and nothing else."""
    driver = open_driver(wire)
    stream_until_ahead(driver, moving=True)
    wire.stuck = 0
    assert error_of(driver, "stop") == "STUCK_LOW"
    wire.stuck = None
    wire.requests.clear()
    finish(driver)
    pushes = [request for request in requests(wire) if request[0] == Operation.PUSH]
    assert requests(wire)[0] == (Operation.WRITE, COMMAND) and not pushes
    driver.call("clear")
    assert driver.positions() == wire.counted()[1]


@pytest.mark.parametrize("garbled", ["request", "reply"])
def test_a_lost_frame_is_sent_again_before_the_next(wire: Wire, garbled: str) -> None:
    """With the same number, until it is acknowledged; the frame that is prepared waits."""
    driver = open_driver(wire)
    stream_until_ahead(driver)
    bad = [1, 1, 1]

    def garble(words: list[int]) -> list[int]:
        return [word ^ 0x00010000 for word in words] if bad and bad.pop() else words

    setattr(wire, "there" if garbled == "request" else "back", garble)
    wire.requests.clear()
    while len(sequences(wire)) < 6:
        poll(driver)
    first = sequences(wire)[0]
    assert sequences(wire)[:5] == [first] * 4 + [first % 255 + 1]
    finish(driver)
    assert wire.counted() == ALL and driver.counters.retries == 3


def test_it_is_opened_again_while_a_frame_is_on_the_wire(wire: Wire) -> None:
    """The exchange is waited for; nothing of the old stream follows."""
    driver = open_driver(wire)
    stream_until_ahead(driver)
    driver.open()
    assert not driver.hardware.on_wire and not driver.is_streaming
    configure(driver)
    driver.call("move_by_speed", by_speed([7, 8, 9, 10]))
    finish(driver)
    assert wire.counted()[1] == driver.positions() == [7, 8, 9, 10]


def test_channels_that_share_a_core(wire: Wire) -> None:
    """Two streams over a noisy wire: frames are not mixed up, each line is made once."""
    wire = Wire(Parameters(channels=2, axes=2))
    first = open_driver(wire, tries=30)
    second = Driver(wire, channel=1, beside=first)
    configure(second)
    Noise(random.Random(1), 1e-4, 0.01).on(wire)
    first.stream(Source(*path(300)))
    second.stream(Source(*path(200)))
    while first.is_moving or second.is_moving:
        poll(first)
        poll(second)
        if first.idle_microseconds and second.idle_microseconds:
            wire.run(CLOCK_HZ // 100_000)
    assert first.positions() == [600, -300] and second.positions() == [400, -200]


def test_no_channel_is_opened_while_another_prepares(wire: Wire) -> None:
    """It would be in the way of what is prepared; the stream continues, and then it opens."""
    wire = Wire(Parameters(channels=2, axes=2))
    first = open_driver(wire)
    stream_until_ahead(first)
    with pytest.raises(DriverError, match="STREAMING"):
        Driver(wire, channel=1, beside=first)
    finish(first)
    assert first.positions() == [2 * STREAM, -STREAM]
    second = Driver(wire, channel=1, beside=first)
    configure(second)
    second.stream(Source(*path(50)))
    finish(second)
    assert second.positions() == [100, -50]
