# SPDX-License-Identifier: MIT
"""Frames of the driver: how many, how long they are, and what they leave alone."""

from typing import Any

import pytest
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, Source
from passo.link import Hardware
from passo.native import ffi, planner
from passo.registers import Operation, Shape, TriggerAction

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
    struct,
)
from tests.test_driver_sessions import PARAMETERS, again

MS = CLOCK_HZ // 1000
BASE = r.ADDRESS_CHANNEL_BASE
SHORT = Parameters(line_queue_log2=2, ramp_queue_log2=2)
CANARY = 0x5AFEC0DE


def frames(driver: Driver, call: str, *arguments: Any, error: str = "OK") -> list[list[int]]:
    """Requests of a call."""
    before = len(driver.engine.requests)
    assert error_of(driver, call, *arguments) == error
    return driver.engine.requests[before:]


def lengths(requests: list[list[int]], operation: Operation, address: int) -> list[int]:
    """Words of the payloads of an operation at an address."""
    return [
        request[0] >> 12 & 0x3F
        for request in requests
        if request[0] >> 28 == operation and request[0] & 0xFFF == address
    ]


def streamed(driver: Driver, lines: list, ramps: list) -> list[list[int]]:
    """Requests of a stream."""
    before = len(driver.engine.requests)
    driver.stream(Source(lines, ramps))
    finish(driver)
    assert driver.fault == "OK"
    return driver.engine.requests[before:]


# ------------------------------------------------------------------------------------------ how many ----


def test_a_position_takes_three_frames(driver: Driver) -> None:
    """To set it, as passo.h says; one axis, the others stay."""
    assert len(frames(driver, "set_position", 1, 77)) == 3
    assert driver.positions() == [0, 77, 0, 0]


def test_a_shaft_that_turns_is_no_rest(driver: Driver) -> None:
    """It is seen immediately, though nothing is queued behind its last ramp."""
    driver.call("jog", struct("jog", speed=10_000 * Q32, acceleration=1_000_000 * Q32))
    driver.engine.run(100 * MS)
    assert driver.snapshot().ramp_room == driver.c.ramp_places
    for call, *arguments in (("set_position", 0, 1), ("zero",), ("clear",), ("enable", 0, False)):
        assert len(frames(driver, call, *arguments, error="MOVING")) <= 3, call
    driver.call("jog_cancel")
    finish(driver)


def even(lines: int, ramps: int, clocks: int) -> tuple[list, list]:
    """A path at one speed, in many ramps."""
    made, _ = path(lines)
    ticks = lines * 20 * clocks // 128 // ramps
    velocity = (1 << 48) // clocks
    lengths = [*[ticks] * (ramps - 1), 2 * ticks]
    ends = [struct("ramp", velocity_end=velocity)[0]]
    for n, length in enumerate(lengths, 1):
        fields = {"velocity_end": velocity, "ticks": length, "progress_step": 2**48 // length}
        ends.append(struct("ramp", last=n == ramps, **fields)[0])
    return made, ends


def test_ramps_fill_their_frames(driver: Driver) -> None:
    """Twelve of five words."""
    sent = lengths(streamed(driver, *even(60, 23, 72)), Operation.PUSH, BASE + r.CHANNEL_RAMP)
    assert sent[0] == 60


def test_the_status_is_that_of_the_channel_that_moves() -> None:
    """It tells the room of the queues of the channel whose gate was written last."""
    first = open_driver(Wire(Parameters(channels=2, line_queue_log2=4)))
    second = Driver(first.engine, channel=1, beside=first)
    configure(second)
    for driver, channel in ((second, 1), (first, 0), (second, 1)):
        driver.stream(Source(*path(5)))
        finish(driver)
        assert r.StatusWord.unpack(driver.host.status).channel == channel


def test_streams_side_by_side() -> None:
    """Neither takes the room of the other for its own."""
    first = open_driver(Wire(Parameters(channels=2, line_queue_log2=4, ramp_queue_log2=4)))
    drivers = [first, Driver(first.engine, channel=1, beside=first)]
    configure(drivers[1])
    for driver, length in zip(drivers, (150, 40), strict=True):
        driver.stream(Source(*even(length, length, 4000)))
    while any(driver.is_moving for driver in drivers):
        for driver in drivers:
            driver.poll()
        first.engine.run(500)
    assert first.counters.refused[r.Verdict.QUEUE_FULL] == 0
    assert [driver.positions()[0] for driver in drivers] == [300, 80]


def test_short_queues_are_not_overrun() -> None:
    """Of many items, none is sent that has no place."""
    driver = open_driver(Wire(SHORT))
    streamed(driver, *even(60, 40, 2000))
    assert driver.counters.refused[r.Verdict.QUEUE_FULL] == 0
    assert driver.engine.counted()[1][:2] == driver.positions()[:2] == [120, -60]


# ------------------------------------------------------------------------------- what they leave alone ----


def test_the_room_of_the_status_is_never_too_large(driver: Driver) -> None:
    """After each push: of lines and of ramps."""
    driver.call("wait_for_sync", True)
    for _ in range(3):
        driver.call("move_by_speed", by_speed([100, 0, 0, 0]))
        line_room, ramp_room = driver.host.line_room, driver.host.ramp_room
        room = r.ChannelRoomWord.unpack(driver_read(driver, r.CHANNEL_ROOM))
        assert line_room <= min(room.line_room, 255) and ramp_room <= min(room.ramp_room, 255)


def driver_read(driver: Driver, register: int) -> int:
    """A register of the channel, read beside the driver."""
    words = ffi().new("uint32_t[1]")
    assert planner().passo_host_read(driver.host, BASE + register, words, 1) == 0
    return words[0]


def test_the_distance_of_axes_that_are_there(driver: Driver) -> None:
    """[0 .. axes - 1]: what is behind these is not written."""
    driver.call("move_by_speed", by_speed([900, -90, 0, 9]))
    steps = ffi().new("int32_t[5]", [CANARY] * 5)
    driver.call("distance_to_go", steps)
    assert steps[4] == CANARY and 0 < steps[0] <= 900 and -90 <= steps[1] < 0
    finish(driver)
    driver.call("distance_to_go", steps)
    assert list(steps) == [0, 0, 0, 0, CANARY]


def test_words_of_a_user_are_all_that_is_read(driver: Driver) -> None:
    """A table is its 256 points; the bank holds them, whatever follows them."""
    points = [min(65535, k * 256) for k in range(256)]
    first, second = (ffi().new("uint16_t[257]", [*points, more]) for more in (0, 1))
    assert len(frames(driver, "load_table", Shape.EASE, first)) >= 5
    made = frames(driver, "load_table", Shape.EASE, second)
    assert [request for request in made if request[0] >> 28 == Operation.WRITE] == []


def test_ramps_of_a_plan_are_all_that_is_read(driver: Driver) -> None:
    """What follows them in its array needs no table."""
    plan = struct("plan")
    assert (
        planner().passo_plan_by_speed(planner().passo_machine(driver.c), by_speed([500, 0, 0, 0]), plan) == 0
    )
    plan.ramps[plan.ramp_count].shape = Shape.SIGMOID
    plan.sigmoid_alpha = 3 << 20
    made = frames(driver, "move_plan", plan, ffi().NULL)
    assert not [request for request in made if request[0] & 0xFFF >= r.ADDRESS_COSINE_BASE]
    finish(driver)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_an_encoder_of_the_session_before(axis: int) -> None:
    """It stops no axis of the next one."""
    first = open_driver(Wire(PARAMETERS))
    config = struct("encoder_config", ratio=1 << 16, limit=10, stop=planner().PASSO_FOLLOWING_HARD)
    first.call("configure_encoder", axis, config)
    second = again(first)
    configure(second)
    second.call("move_by_speed", by_speed([100, 100, 100]))
    finish(second)
    assert second.fault == "OK" and second.positions() == [100] * 3


def test_an_adopted_position_leaves_the_limit() -> None:
    """One word is written, the ratio."""
    driver = open_driver(Wire(PARAMETERS))
    config = struct("encoder_config", ratio=1 << 16, limit=1 << 10, stop=planner().PASSO_FOLLOWING_SOFT)
    driver.call("configure_encoder", 1, config)
    ratio = BASE + r.CHANNEL_ENCODER_BASE + r.CHANNEL_ENCODER_STRIDE + r.ENCODER_RATIO
    assert lengths(frames(driver, "adopt_encoder", 1), Operation.WRITE, ratio) == [1]


def test_a_mark_is_a_word(driver: Driver) -> None:
    """So is the read that tells the last number after many lost writes."""
    driver.open()
    opened = driver.engine.requests
    assert set(lengths(opened, Operation.WRITE, r.ADDRESS_IDENTIFICATION)) == {1}


# --------------------------------------------------------------------------------- a link that is lost ----


class Cut:
    """A host whose requests do not arrive, as long as it is cut."""

    def __init__(self, tries: int) -> None:
        self.wire, self.cut = Wire(Parameters(channels=8, axes=1)), False
        self.wire.there = lambda words: None if self.cut else list(words)
        self.hardware = Hardware(self.wire, tries)
        self.host = ffi().new("struct passo_host *")
        assert planner().passo_host_open(self.host, self.hardware.c) == 0

    def write(self, word: int) -> int:
        """The error of a write to RUN."""
        words = ffi().new("uint32_t[1]", [word])
        return planner().passo_host_write(self.host, r.ADDRESS_RUN, words, 1)

    def read(self) -> int:
        """RUN as it is in the core."""
        words = ffi().new("uint32_t[2]", [0, CANARY])
        assert planner().passo_host_read(self.host, r.ADDRESS_RUN, words, 1) == 0
        assert words[1] == CANARY
        return words[0]


@pytest.mark.parametrize("lost", [1, 253, 254, 255, 256, 600])
def test_a_write_after_lost_ones(lost: int) -> None:
    """It is executed, however many were lost, and what is read in between is a word."""
    link = Cut(tries=1)
    for n in range(lost):
        link.cut = True
        assert link.write(n % 256) != 0
        link.cut = False
        if planner().passo_host_is_unsure(link.host):
            assert n >= 253
    link.wire.requests.clear()
    assert link.write(77) == 0
    assert set(lengths(link.wire.requests, Operation.READ, r.ADDRESS_IDENTIFICATION)) <= {1}
    assert link.read() == 77
    assert not planner().passo_host_is_unsure(link.host)


def test_a_read_ends_doubts() -> None:
    """After it a frame can be posted."""
    link = Cut(tries=1)
    link.cut = True
    while not planner().passo_host_is_unsure(link.host):
        assert link.write(5) != 0
    link.cut = False
    link.read()
    assert not planner().passo_host_is_unsure(link.host)
    result = ffi().new("enum passo_error *")
    assert planner().passo_host_post_write(link.host, r.ADDRESS_RUN, 9, result) == 0
    while planner().passo_host_step(link.host):
        pass
    assert result[0] == 0 and link.read() == 9


@pytest.mark.parametrize("tries", [2, 3])
def test_a_frame_that_is_given_up_counts(tries: int) -> None:
    """One that fails, however often it was tried."""
    link = Cut(tries)
    link.cut = True
    words = ffi().new("uint32_t[1]")
    assert planner().passo_host_read(link.host, 0, words, 1) != 0
    assert link.host.counters.failed == 1 and link.host.counters.retries == tries - 1
    assert link.write(1) != 0
    assert link.host.counters.failed == 2


def test_a_status_needs_a_majority() -> None:
    """Of the words that arrived, whatever the others are."""
    status = ffi().new("uint32_t *")
    good = Wire().transfer([0, 0, 0, 0, 0])[0]
    assert planner().passo_host_status_of([good] * 3 + [1, 2], 5, status) and status[0] == good
    for words in ([good] * 2 + [1, 2, 3], [good] * 3 + [1, 2, 3], [1, good, 2, good, 3, good, 4]):
        assert not planner().passo_host_status_of(words, len(words), status), words


# ------------------------------------------------------------------------------------- odd arguments ----


def test_no_values_for_a_raster() -> None:
    """It is an error, not a crash; so is no place for their number."""
    driver = open_driver(Wire(PARAMETERS))
    taken = ffi().new("size_t *")
    values = ffi().new("uint8_t[4]")
    assert error_of(driver, "push_raster", ffi().NULL, 4, taken) == "ARGUMENT"
    assert error_of(driver, "push_raster", values, 4, ffi().NULL) == "ARGUMENT"
    driver.call("push_raster", values, 4, taken)
    assert taken[0] == 4


def test_an_encoder_that_is_faster_than_a_number() -> None:
    """It has no speed; the same backward."""
    for way in (1, -1):
        wire = Wire(PARAMETERS)
        driver = open_driver(wire)
        counts = [0]
        address = BASE + r.CHANNEL_ENCODER_POSITION_BASE
        answer_reads(wire, lambda at, word, a=address, c=counts: c[0] & 0xFFFFFFFF if at == a else word)
        reading = struct("encoder_reading")
        driver.call("read_encoder", 0, reading)
        counts[0] = way * (2**31 - 1)
        driver.call("read_encoder", 0, reading)
        assert reading.counts == counts[0] and reading.speed == -(2**63)


def test_a_trigger_action_that_is_none() -> None:
    """The last one is the greatest."""
    driver = open_driver(Wire(PARAMETERS))
    driver.call("configure_probe", False)
    for action, error in ((TriggerAction.END_ENDLESS, "OK"), (TriggerAction.END_ENDLESS + 1, "ARGUMENT")):
        config = struct("trigger_config", source=r.TriggerSource.PROBE, action=action)
        assert error_of(driver, "arm_trigger", config) == error
