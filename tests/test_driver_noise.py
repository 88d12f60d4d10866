# SPDX-License-Identifier: MIT
"""The driver on a wire that fails: every move arrives exactly once, or an error tells, nothing is half done.

The C model is the core; pulses are counted at its pins. That a poll is at most one frame is always checked.
"""

import random
from typing import Any

import pytest
from driver_wire import (
    CLOCK_HZ,
    PARAMETERS,
    Noise,
    Wire,
    by_speed,
    configure,
    error_of,
    finish,
    open_driver,
    poll,
)
from passo.driver import Driver, DriverError, Source
from passo.registers import State
from test_driver import path

SEED = 1
MOVES = 220
WIRE_ERRORS = {"STUCK_LOW", "STUCK_HIGH", "NO_ACK", "DAMAGED", "SEQUENCE", "BAD_CRC"}


@pytest.fixture
def wire() -> Wire:
    return Wire()


def moved(before: list[int], steps: list[int]) -> list[int]:
    return [a + b for a, b in zip(before, steps, strict=True)]


def random_steps(rng: random.Random) -> list[int]:
    steps = [rng.randrange(-60, 61) for _ in range(4)]
    steps[rng.randrange(4)] = rng.choice([-1, 1]) * rng.randrange(20, 120)
    return steps


@pytest.mark.parametrize(("rate", "worse"), [(1e-4, 0.0), (1e-4, 0.05), (1e-3, 0.0)])
def test_noise(wire: Wire, rate: float, worse: float) -> None:
    """Flipped bits, bursts and missing words cost retries, nothing else."""
    rng = random.Random(f"{SEED} {rate} {worse}")
    noise = Noise(rng, rate, worse)
    noise.on(wire)
    driver = Driver(wire, tries=60)
    configure(driver)
    at, pulses, made = [0] * 4, [0] * 4, 0
    while made < MOVES:
        for _ in range(rng.choice([1, 1, 2])):
            steps = random_steps(rng)
            driver.call("move_by_speed", by_speed(steps))
            at, pulses = moved(at, steps), moved(pulses, [abs(n) for n in steps])
            made += 1
        finish(driver)
        assert wire.counted() == (pulses, at)
    assert driver.positions() == at
    counters = driver.counters
    assert noise.flips > 20 and counters.retries > 5 and counters.failed == 0
    assert not worse or (noise.bursts > 20 and noise.cuts > 10)
    print(f"{made} moves, {counters.frames} frames, {counters.retries} retries, {noise.flips} bits flipped")


def test_noise_on_a_stream(wire: Wire) -> None:
    """A long path over a disturbed wire, with the small queue of ramps."""
    rng = random.Random(SEED)
    noise = Noise(rng, 1e-4, 0.01)
    driver = Driver(wire, tries=30)
    configure(driver)
    noise.on(wire)
    lines, ramps = path(1500)
    driver.stream(Source(lines, ramps))
    finish(driver)
    assert wire.counted() == ([3000, 1500, 0, 0], [3000, -1500, 0, 0])
    assert driver.counters.retries > 5 and noise.flips > 20


def recover(driver: Driver, wire: Wire) -> list[int]:
    """What a program does after an error: stop, wait, clear; open again if that is what it takes."""
    if driver.host.lost:
        try:
            driver.open()
        except DriverError as error:
            assert error.name == "MOVING"
        configure_when_possible = not driver.c.broken
        if configure_when_possible:
            configure(driver)
            return driver.positions()
    driver.call("abort")
    wire.run(CLOCK_HZ // 1000)
    driver.call("clear")
    assert driver.snapshot().state == State.IDLE
    return driver.positions()


@pytest.mark.parametrize("level", [0, 1])
def test_a_wire_that_is_pulled_out(wire: Wire, level: int) -> None:
    """At any frame of a move the wire dies: the error names it; the move was made, or nothing of it."""
    rng = random.Random(f"{SEED} {level}")
    driver = open_driver(wire, tries=4)
    at = [0] * 4
    outcomes = {"made": 0, "not made": 0, "error": 0}
    for _ in range(60):
        steps = random_steps(rng)
        first = wire.frames + 1  # it looks, then come the ramps, then the line
        dies = first + rng.randrange(5)

        def die(frame: int, dies: int = dies) -> None:
            if frame == dies:
                wire.stuck = level

        wire.before_frame = die
        name = error_of(driver, "move_by_speed", by_speed(steps))
        if name == "OK":
            try:
                finish(driver, 0.2)
            except DriverError as error:
                name = error.name
        wire.before_frame, wire.stuck = lambda _: None, None
        assert name in ("OK", "STUCK_HIGH" if level else "STUCK_LOW"), name
        outcomes["error"] += name != "OK"
        if dies - first in (1, 2):
            assert name != "OK" and driver.c.broken
            assert error_of(driver, "move_by_speed", by_speed(steps)) == "BROKEN"
        wire.run(CLOCK_HZ // 50)
        net = wire.counted()[1]
        assert net in (at, moved(at, steps)), "half a move"
        outcomes["made" if net != at else "not made"] += 1
        at = net
        assert recover(driver, wire) == at
    assert outcomes["error"] > 20 and outcomes["made"] > 5 and outcomes["not made"] > 5, outcomes
    steps = [10, -20, 30, -40]
    driver.call("move_by_speed", by_speed(steps))
    finish(driver)
    assert wire.counted()[1] == moved(at, steps)


def test_an_ack_that_gets_lost(wire: Wire) -> None:
    """The core has executed every frame, but each first reply is lost: nothing is made twice."""
    driver = open_driver(wire)
    odd: list[Any] = []

    def back(miso: list[int]) -> list[int]:
        odd.append(0)
        return [0] * len(miso) if len(odd) % 2 else miso

    wire.back = back
    for steps in ([50, -20, 0, 0], [-50, 0, 9, 0]):
        driver.call("move_by_speed", by_speed(steps))
        finish(driver)
    assert wire.counted() == ([100, 20, 9, 0], [0, -20, 9, 0])
    assert driver.counters.refused[1] >= 4  # duplicates


def reset_at(wire: Wire, number: int) -> None:
    """The core is reset before a frame."""

    def before(frame: int) -> None:
        if frame == number:
            wire.reset_core()

    wire.before_frame = before


@pytest.mark.parametrize("garbled", [False, True])
@pytest.mark.parametrize("frames", range(1, 9))
def test_the_core_is_reset(wire: Wire, frames: int, garbled: bool) -> None:
    """At any frame of a move, even if the reply to that frame is lost: the driver says so; nothing moves."""
    driver = open_driver(wire)
    driver.call("move_by_speed", by_speed([5, 0, 0, 0]))
    finish(driver)
    number = wire.frames + frames
    reset_at(wire, number)
    if garbled:
        wire.back = lambda miso: [0xFFFFFFFF] * len(miso) if wire.frames == number else miso
    name = error_of(driver, "move_by_speed", by_speed([40, -30, 20, 10]))
    if name == "OK":
        with pytest.raises(DriverError) as caught:
            finish(driver)
        name = caught.value.name
    assert name == "CORE_RESET" and wire.frames <= number + 3
    at_reset = wire.counted()
    wire.run(CLOCK_HZ // 100)
    assert wire.counted() == at_reset
    for call, arguments in (("move_by_speed", (by_speed([1]),)), ("hold", ()), ("poll", ()), ("stop", ())):
        assert error_of(driver, call, *arguments) == "CORE_RESET"
    wire.back = list
    driver.open()
    configure(driver)
    before = wire.counted()[1]
    driver.call("move_by_speed", by_speed([7, 8, 9, 10]))
    finish(driver)
    assert driver.positions() == [7, 8, 9, 10]
    assert wire.counted()[1] == moved(before, [7, 8, 9, 10])


@pytest.mark.parametrize("frames", [2, 12, 30, 31, 60, 100])
@pytest.mark.parametrize("garbled", [False, True])
def test_the_core_is_reset_during_a_stream(wire: Wire, frames: int, garbled: bool) -> None:
    """It never goes on with half a path."""
    driver = open_driver(wire)
    number = wire.frames + frames
    reset_at(wire, number)
    if garbled:
        wire.back = lambda miso: [0] * len(miso) if wire.frames == number else miso
    with pytest.raises(DriverError, match="CORE_RESET"):
        driver.stream(Source(*path(3000)))
        finish(driver)
    at_reset = wire.counted()
    assert not driver.is_streaming and wire.frames <= number + 4
    wire.run(CLOCK_HZ // 50)
    assert wire.counted() == at_reset
    with pytest.raises(DriverError, match="CORE_RESET"):
        poll(driver)


def test_another_host_writes(wire: Wire) -> None:
    """A core that takes commands from somebody else as well is not trusted any more."""
    driver = open_driver(wire)
    Driver(wire)
    assert error_of(driver, "hold") == "CORE_RESET"


@pytest.mark.parametrize("polls", [3, 20, 45, 60, 200])
def test_the_host_is_reset(wire: Wire, polls: int) -> None:
    """A new host finds a path half prepared, or running: it stops it, and goes on from where the core is."""
    first = open_driver(wire)
    first.stream(Source(*path(3000)))
    for _ in range(polls):
        poll(first)
    moves = first.snapshot().state == State.RUN
    if moves:
        with pytest.raises(DriverError, match="MOVING"):
            Driver(wire)
    second = Driver.__new__(Driver)
    try:
        second.__init__(wire)
    except DriverError as error:
        assert error.name == "MOVING" and moves
        assert error_of(second, "move_by_speed", by_speed([1])) == "BROKEN"
        at = second.positions()
        wire.run(1000)
        assert second.positions() != at
        assert error_of(second, "clear") == "MOVING"
        second.call("stop")
        wire.run(CLOCK_HZ // 100)
        second.call("clear")
    assert moves == (polls > 44), polls
    configure(second)
    at = second.positions()
    assert at == wire.counted()[1]
    second.call("move_by_speed", by_speed([9, -9, 9, -9]))
    finish(second)
    assert wire.counted()[1] == moved(at, [9, -9, 9, -9]) == second.positions()


def test_a_wrong_position_is_told(wire: Wire) -> None:
    """The end of a motion is compared with what was commanded."""
    driver = open_driver(wire)
    driver.call("move_by_speed", by_speed([30, 0, 0, 0]))
    driver.c.axis[0].expected += 1
    with pytest.raises(DriverError, match="POSITION"):
        finish(driver)
    assert not driver.is_moving
    driver.call("move_by_speed", by_speed([30, 0, 0, 0]))
    finish(driver)
    driver.call("clear")
    assert driver.c.fault == 0


def test_tries_are_bounded(wire: Wire) -> None:
    """A frame is sent so often and no more; polls tell after as many misses."""
    driver = open_driver(wire, tries=5)
    wire.stuck = 0
    before = wire.frames
    assert error_of(driver, "hold") == "STUCK_LOW"
    assert wire.frames == before + 5
    for _ in range(4):
        wire.run(CLOCK_HZ // 900)
        poll(driver)
    wire.run(CLOCK_HZ // 900)
    with pytest.raises(DriverError, match="STUCK_LOW"):
        poll(driver)
    wire.stuck = None
    driver.call("hold")
    driver.call("resume")
    assert driver.counters.failed == 1 and driver.counters.stuck == 10
    assert PARAMETERS.axes == driver.c.machine.axes


def test_a_frame_given_up_is_not_made_later(wire: Wire) -> None:
    """The wire comes back after a failed command: only what is commanded from then on happens."""
    driver = open_driver(wire, tries=3)
    driver.call("configure_motion", 0, 0, 0)
    driver.call("move_by_speed", by_speed([4000, 0, 0, 0]))
    wire.run(CLOCK_HZ // 100)
    wire.there = lambda _: None
    assert error_of(driver, "hold") == "STUCK_LOW"
    wire.there = list
    assert driver.snapshot().rate == 1 << 16
    finish(driver)
    assert driver.positions()[0] == 4000
