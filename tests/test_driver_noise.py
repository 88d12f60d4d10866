# SPDX-License-Identifier: MIT
"""The driver on a faulty link: every move is made exactly once, or not at all with an error reported.

The C model is the core; pulses are counted at its pins. Every poll is checked to take at most one frame.
"""

import random
from typing import Any

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, DriverError, Source
from passo.native import ffi, planner
from passo.registers import Cause, State

from tests.helpers.driver_wire import (
    CLOCK_HZ,
    PARAMETERS,
    Q32,
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
    struct,
)

SEED = 1
MOVES = 220
WIRE_ERRORS = {"STUCK_LOW", "STUCK_HIGH", "NO_ACK", "DAMAGED", "SEQUENCE", "BAD_CRC"}


# of tests that count polls: each of them is a whole frame
WAITS = pytest.mark.parametrize("wire", ["waits"], indirect=True)


@pytest.fixture(params=["waits", "dma"])
def wire(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Wire:
    """A wire to a host that waits for each frame, or that continues while frames are on it."""
    if request.param == "dma":
        monkeypatch.setattr("passo.driver.Hardware", Dma)
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


def is_broken(driver: Driver) -> bool:
    """Whether the driver does not know the effect of a command."""
    return driver.c.assumed >= driver.lib.PASSO_ASSUMED_BROKEN


def recover(driver: Driver, wire: Wire) -> list[int]:
    """Recovery after an error: stop, wait, clear; open again if necessary."""
    if driver.host.lost:
        try:
            driver.open()
        except DriverError as error:
            assert error.name == "MOVING"
        configure_when_possible = not is_broken(driver)
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
    """The link fails at any frame of a move: it is reported; the move is made completely or not at all."""
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
            assert name != "OK" and is_broken(driver)
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
    """At any frame of a move, even if its reply is lost: the driver reports it; nothing moves."""
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
    """It never continues with part of a path."""
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
    """A core that another host writes to is reported as CORE_RESET."""
    driver = open_driver(wire)
    Driver(wire)
    assert error_of(driver, "hold") == "CORE_RESET"


@WAITS
@pytest.mark.parametrize("polls", [3, 20, 45, 60, 200])
def test_the_host_is_reset(wire: Wire, polls: int) -> None:
    """A new host finds a path in preparation or running, stops it and continues from its position."""
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


@WAITS
def test_tries_are_bounded(wire: Wire) -> None:
    """The tries of a frame are limited; polls report an error after as many misses or tries."""
    driver = open_driver(wire, tries=5)
    wire.stuck = 0

    def polls_until_told(name: str) -> None:
        for _ in range(4):
            wire.run(CLOCK_HZ // 900)
            poll(driver)
        wire.run(CLOCK_HZ // 900)
        with pytest.raises(DriverError, match=name):
            poll(driver)

    before = wire.frames
    assert error_of(driver, "resume") == "STUCK_LOW"
    assert wire.frames == before + 5
    for _ in range(2):
        polls_until_told("NOT_HELD")
    assert wire.frames == before + 15
    wire.stuck = None
    poll(driver)
    wire.stuck = 0
    polls_until_told("STUCK_LOW")
    assert wire.frames == before + 21
    assert driver.counters.failed == 3 and driver.counters.stuck == 20
    wire.stuck = None
    driver.call("hold")
    driver.call("resume")
    assert PARAMETERS.axes == driver.c.machine.axes


# ----------------------------------------------------------------------------- unacknowledged commands ----


def eight_moves(driver: Driver, wire: Wire, steps: int = 400) -> None:
    """Eight moves are queued (of at most two ramps each), the first of them runs."""
    for _ in range(8):
        move = struct(
            "move_in_time",
            steps=[steps, 0, 0, 0],
            total_clocks=CLOCK_HZ // 50,
            ramp_clocks=CLOCK_HZ // 100,
        )
        driver.call("move_in_time", move)
    wire.run(CLOCK_HZ // 100)


def polls(driver: Driver, wire: Wire, count: int) -> None:
    """Poll without looking at errors."""
    for _ in range(count):
        error_of(driver, "poll")
        wire.run(CLOCK_HZ // 5000)


@WAITS
@pytest.mark.parametrize("cut", ["both ways", "replies"])
@pytest.mark.parametrize("level", [0, 1])
@pytest.mark.parametrize("how", ["stop", "abort"])
def test_a_stop_that_was_not_acknowledged(wire: Wire, how: str, level: int, cut: str) -> None:
    """Every poll resends it until it is acknowledged; until then NOT_STOPPED is reported."""
    stuck = "STUCK_HIGH" if level else "STUCK_LOW"
    driver = open_driver(wire)
    driver.call("configure_motion", 72000, 72000, 0)
    eight_moves(driver, wire)
    if cut == "replies":
        wire.back = lambda miso: [0xFFFFFFFF * level] * len(miso)
    else:
        wire.stuck = level
    assert error_of(driver, how) == stuck
    assert driver.fault == "NOT_STOPPED" and driver.is_moving
    assert driver.idle_microseconds == 0
    assert error_of(driver, "move_by_speed", by_speed([5])) == "NOT_STOPPED"
    assert error_of(driver, "clear") == "NOT_STOPPED"
    for call in ("resume", "zero", "hold"):
        assert error_of(driver, call) == "NOT_STOPPED"
    polls(driver, wire, 3)
    assert driver.fault == "NOT_STOPPED"
    before = wire.counted()[0][0]
    assert before < 8 * 400

    wire.stuck, wire.back = None, list
    wire.requests.clear()
    poll(driver)
    assert wire.requests[0][1] == 1 << (r.CHANNEL_COMMAND_ABORT_LSB if how == "abort" else 0)
    poll(driver)  # the proof that it is the same core
    assert driver.fault == "NOT_HELD"  # of the hold that came after it
    poll(driver)
    assert driver.fault == "OK"
    finish(driver)
    at = wire.counted()[0][0]
    assert at <= before + 200 and driver.state == State.STOPPED
    assert driver.cause == (Cause.ABORT if how == "abort" else Cause.STOP)
    assert error_of(driver, "move_by_speed", by_speed([5])) == "STOPPED"
    driver.call("clear")
    driver.call("resume")
    assert driver.positions()[0] == at == wire.counted()[0][0]
    driver.call("move_by_speed", by_speed([5, 0, 0, 0]))
    finish(driver)
    assert driver.positions()[0] == at + 5


@pytest.mark.parametrize("frames", [0, 1])
def test_an_end_of_turning_that_was_not_acknowledged(wire: Wire, frames: int) -> None:
    """A soft stop replaces it, whichever frame the link failed at."""
    driver = open_driver(wire)
    turning = struct("turning", axis=2, steps_per_turn=3200, backward=True)
    turning.top_rpm, turning.acceleration = 1200 * Q32, 5_000_000 * Q32
    driver.call("turn_start", turning, 600 * Q32)
    wire.run(CLOCK_HZ // 20)
    number = wire.frames + frames

    def before(frame: int) -> None:
        wire.stuck = 0 if frame > number else None

    wire.before_frame = before
    assert error_of(driver, "turn_stop") == "STUCK_LOW" and driver.fault == "NOT_STOPPED"
    wire.before_frame, wire.stuck = lambda _: None, None
    finish(driver)
    assert driver.state == State.STOPPED
    driver.call("clear")
    assert driver.positions() == wire.counted()[1]


def test_a_clear_gets_the_stop_through_first(wire: Wire) -> None:
    """No poll is needed between a stop that failed and the clear."""
    driver = open_driver(wire)
    eight_moves(driver, wire)
    wire.stuck = 0
    assert error_of(driver, "stop") == "STUCK_LOW"
    wire.stuck = None
    assert error_of(driver, "clear") in ("OK", "MOVING")
    finish(driver)
    driver.call("clear")
    at = driver.positions()
    assert 0 < at[0] < 8 * 400 and wire.counted()[1] == at
    wire.run(CLOCK_HZ // 10)
    assert wire.counted()[1] == at


def test_an_abort_takes_the_place_of_a_stop(wire: Wire) -> None:
    """Only the abort is sent; a stop does not weaken it."""
    driver = open_driver(wire)
    eight_moves(driver, wire)
    wire.stuck = 0
    for how in ("hold", "stop", "abort", "stop"):
        assert error_of(driver, how) in ("STUCK_LOW", "NOT_STOPPED")
        poll(driver)
    wire.stuck = None
    wire.requests.clear()
    finish(driver)
    writes = [(q[0] & 0xF, q[1]) for q in wire.requests if q[0] >> 28 == r.Operation.WRITE]
    abort = (r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ABORT_LSB)
    assert writes == [abort, (r.CHANNEL_RATE_TARGET, 0)] and driver.cause == Cause.ABORT


@WAITS
@pytest.mark.parametrize(("before", "how"), [("hold", "stop"), ("hold", "abort"), ("stop", "abort")])
def test_the_most_urgent_goes_first(wire: Wire, before: str, how: str) -> None:
    """Even if another frame is being retried."""
    driver = open_driver(wire)
    eight_moves(driver, wire)
    wire.stuck = 0
    assert error_of(driver, before) == "STUCK_LOW"
    poll(driver)
    wire.stuck = None
    wire.requests.clear()
    driver.call(how)
    bit = r.CHANNEL_COMMAND_STOP_LSB if how == "stop" else r.CHANNEL_COMMAND_ABORT_LSB
    assert wire.requests[0][0] & 0xF == r.CHANNEL_COMMAND and wire.requests[0][1] == 1 << bit


def fail_pushes(driver: Driver, wire: Wire) -> None:
    """From now on pushes fail; returns while a frame of the stream is being retried."""

    def before(_: int) -> None:
        wire.stuck = 0 if wire.requests[-1][0] >> 28 == r.Operation.PUSH else None

    wire.before_frame = before
    while driver.c.post != planner().PASSO_POST_ITEMS:
        wire.run(CLOCK_HZ // 20_000)
        poll(driver)


@WAITS
def test_a_stop_goes_before_a_frame_of_the_stream(wire: Wire) -> None:
    """A frame that is being retried is abandoned for it."""
    driver = open_driver(wire)
    driver.stream(Source(*path(3000)))
    while driver.snapshot().state != State.RUN:
        poll(driver)

    fail_pushes(driver, wire)
    wire.requests.clear()
    driver.call("stop")
    assert wire.requests[0][1] == 1 << r.CHANNEL_COMMAND_STOP_LSB and len(wire.requests) == 1
    finish(driver)
    driver.call("clear")
    assert driver.positions() == wire.counted()[1]


def test_a_frame_of_a_cleared_stream_is_forgotten(wire: Wire) -> None:
    """Its result does not affect the next stream."""
    driver = open_driver(wire, tries=3)
    driver.stream(Source(*path(300)))

    fail_pushes(driver, wire)
    driver.call("clear")
    wire.before_frame = lambda _: None
    driver.stream(Source(*path(30)))
    finish(driver)
    assert wire.counted()[1] == [60, -30, 0, 0] == driver.positions()


@pytest.mark.parametrize("cut", ["both ways", "replies"])
def test_a_hold_that_was_not_acknowledged(wire: Wire, cut: str) -> None:
    """It takes effect later; a resume replaces it."""
    driver = open_driver(wire)
    driver.call("configure_motion", 0, 0, 0)
    eight_moves(driver, wire)

    def dead(yes: bool) -> None:
        wire.back = (lambda miso: [0] * len(miso)) if yes and cut == "replies" else list
        wire.stuck = 0 if yes and cut == "both ways" else None

    dead(True)
    assert error_of(driver, "hold") == "STUCK_LOW"
    assert driver.fault == "NOT_HELD"
    assert error_of(driver, "move_by_speed", by_speed([5])) == "NOT_HELD"
    polls(driver, wire, 3)
    dead(False)
    poll(driver)
    poll(driver)
    assert driver.fault == "OK"
    wire.run(1000)
    at = wire.counted()
    wire.run(CLOCK_HZ // 10)
    assert wire.counted() == at and at[0][0] < 8 * 400
    dead(True)
    assert error_of(driver, "hold") == "STUCK_LOW"
    dead(False)
    driver.call("resume")
    finish(driver)
    assert driver.positions()[0] == 8 * 400 == wire.counted()[0][0]


@pytest.mark.parametrize("cut", ["both ways", "replies"])
def test_a_resume_that_was_not_acknowledged_is_not_made_later(wire: Wire, cut: str) -> None:
    """If it was executed, the hold is restored. A slower override comes later, a faster one does not."""
    driver = open_driver(wire)
    driver.call("configure_motion", 0, 0, 0)
    eight_moves(driver, wire)

    def fails(call: str, *arguments: object) -> int:
        wire.back = (lambda miso: [0] * len(miso)) if cut == "replies" else list
        wire.stuck = 0 if cut == "both ways" else None
        assert error_of(driver, call, *arguments) == "STUCK_LOW"
        wire.back, wire.stuck = list, None
        poll(driver)
        wire.run(1000)
        return driver.snapshot().rate

    driver.call("override", 50)
    driver.call("hold")
    assert fails("resume") == 0
    driver.call("resume")
    assert driver.snapshot().rate == 1 << 15
    assert fails("override", 100) == 1 << 15
    assert fails("override", 25) == 1 << 14
    driver.call("override", 100)
    finish(driver)
    assert driver.positions()[0] == 8 * 400


def test_numbers_of_frames_are_not_used_twice(wire: Wire) -> None:
    """After as many failures as there are sequence numbers, a command is not taken for a duplicate."""
    driver = open_driver(wire, tries=2)
    driver.call("configure_motion", 0, 0, 0)
    eight_moves(driver, wire)
    for failures in range(250, 260):
        wire.stuck = 0
        for _ in range(failures):
            assert error_of(driver, "resume") == "STUCK_LOW"
        wire.stuck = None
        driver.call("hold")
        wire.run(1000)
        assert driver.snapshot().rate == 0
        driver.call("resume")
        wire.run(1000)
        assert driver.snapshot().rate == 1 << 16


def test_another_channels_stop_does_not_wait_long() -> None:
    """Two channels on a dead link: both stops get through after recovery, with at most one frame per poll."""
    wire = Wire(Parameters(channels=2, axes=2))
    first = open_driver(wire, tries=3)
    second = Driver.__new__(Driver)
    second.__dict__.update(first.__dict__)
    second.c = ffi().new("struct passo *")
    options = struct("options", clock_hz=CLOCK_HZ, channel=1)
    assert planner().passo_open_channel(second.c, first.host, options) == 0
    configure(second)
    for driver in (first, second):
        driver.call("move_by_speed", by_speed([30_000, 10_000]))
    wire.run(CLOCK_HZ // 100)
    wire.stuck = 0
    for driver in (first, second):
        assert error_of(driver, "stop") == "STUCK_LOW"
    for _ in range(4):
        for driver in (first, second):
            error_of(driver, "poll")
    wire.stuck = None
    for _ in range(3):
        for driver in (first, second):
            poll(driver)
    assert first.fault == second.fault == "OK"
    wire.run(CLOCK_HZ // 20)
    at = wire.counted()
    wire.run(CLOCK_HZ // 20)
    assert wire.counted() == at and max(at[0]) < 30_000
    for driver in (first, second):
        driver.call("clear")
