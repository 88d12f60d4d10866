# SPDX-License-Identifier: MIT
"""passo_ramp_queue: order, refusals, room, NOW."""

from collections import deque

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from cocotb.triggers import ReadOnly
from passo import registers as r
from passo.cocotb.clocks import read

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.ramp_queue import BAD_VALUE, BUSY, QUEUE_FULL, WORDS, Queue, random_ramp
from cocotb_tests.helpers.runner import run

DEPTH_LOG2 = 2
DEPTH = 1 << DEPTH_LOG2


@pytest.mark.sample(1)
def test_ramp_queue(simulator: str) -> None:
    run(__name__, "passo_ramp_queue", {"DEPTH_LOG2": DEPTH_LOG2}, simulator)


def test_deep_ramp_queue(simulator: str) -> None:
    run("cocotb_tests.deep_ramps", "passo_ramp_queue", {"DEPTH_LOG2": 8}, simulator)


@cocotb.test()
async def ramps_come_out_whole_and_in_order(dut: HierarchyObject) -> None:
    """Random pushes of one or more ramps and takes, for many rounds of the memory."""
    random = rng("ramp queue")
    queue = await Queue.begin(dut)
    ramps: deque[list[int]] = deque()
    for _ in range(150):
        await queue.check(ramps)
        count = random.randrange(1, 4)
        if random.random() < 0.6 and count <= DEPTH - len(ramps):
            new = [random_ramp(random) for _ in range(count)]
            await queue.bus.push([word for ramp in new for word in ramp])
            ramps.extend(new)
        elif ramps:
            await queue.strobe("take")
            ramps.popleft()


@cocotb.test()
async def take_now_drops_the_ramps_before_it(dut: HierarchyObject) -> None:
    """now_pending rises with a ramp with NOW and falls with take_now; the last one of several counts."""
    random = rng("ramp queue, now")
    queue = await Queue.begin(dut)
    for _ in range(40):
        kinds = [random.random() < 0.5 for _ in range(random.randrange(1, DEPTH + 1))]
        ramps = [random_ramp(random, now) for now in kinds]
        for n, ramp in enumerate(ramps):
            await queue.bus.push(ramp)
            await queue.check(ramps[: n + 1], now_pending=any(kinds[: n + 1]))
        if any(kinds):
            last_now = max(n for n, now in enumerate(kinds) if now)
            await queue.strobe("take_now")
            ramps = ramps[last_now:]
        await queue.take_all(ramps)


@cocotb.test()
async def a_check_changes_nothing(dut: HierarchyObject) -> None:
    """A frame that is checked and not executed, whole or in part, leaves no trace; not even its NOW."""
    random = rng("ramp queue, check")
    queue = await Queue.begin(dut)
    for length in range(1, 2 * WORDS + 1):
        words = (random_ramp(random, True) + random_ramp(random, True))[:length]
        await queue.bus.accept(words)
        assert read(dut.incomplete) == (length % WORDS != 0)
        await queue.check([])
    ramp = random_ramp(random)
    await queue.bus.push(ramp)
    assert read(dut.incomplete) == 0
    await queue.check([ramp])


@cocotb.test()
async def bad_values_are_refused(dut: HierarchyObject) -> None:
    """Every reserved bit and every velocity above 1/2, in the first and in the second ramp of a frame."""
    random = rng("ramp queue, values")
    queue = await Queue.begin(dut)
    cases: list[tuple[list[int], int | None]] = []
    for bit in range(16):
        cases.append(([1 << bit, 0, 0, 0, 0], None if r.RAMP_CONTROL_DEFINED >> bit & 1 else 0))
    for high, low, at in (
        (0x8000, 0, None),
        (0x7FFF, 0xFFFFFFFF, None),
        (0x8000, 1, 1),
        (0x8000, 0x80000000, 1),
        (0x8001, 0, 0),
        (0xFFFF, 0, 0),
    ):
        cases.append(([high << 16, low, 0xFFFFFFFF, 0, 0], at))
    for bit in range(32):
        cases.append(([0, 0, 0, 1 << bit, 0xFFFFFFFF], 3 if bit >= 16 else None))
    for ramp, at in cases:
        for before in ([], random_ramp(random)):
            await queue.bus.frame()
            answers = await queue.bus.check(before + ramp)
            expected = [0] * len(before + ramp)
            if at is not None:
                expected[len(before) + at] = BAD_VALUE
            assert answers == expected, [hex(word) for word in ramp]
    await queue.check([])


@cocotb.test()
async def a_frame_needs_room_for_all_its_ramps(dut: HierarchyObject) -> None:
    """QUEUE_FULL from the first word of a ramp without room; BUSY of a stopped channel has priority."""
    random = rng("ramp queue, room")
    queue = await Queue.begin(dut)
    ramps: list[list[int]] = []
    for room in range(DEPTH, -1, -1):
        words = [word for _ in range(DEPTH + 1) for word in random_ramp(random)]
        for _ in range(2):
            await queue.bus.frame()
            answers = await queue.bus.check(words)
            assert answers[: room * WORDS] == [0] * (room * WORDS)
            assert answers[room * WORDS] == QUEUE_FULL
        dut.blocked.value = 1
        await queue.bus.frame()
        assert set(await queue.bus.check([0xFFFFFFFF] * WORDS)) == {BUSY}
        dut.blocked.value = 0
        await queue.check(ramps)
        if room:
            ramps.append(random_ramp(random))
            await queue.bus.push(ramps[-1])


@cocotb.test()
async def room_is_taken_when_a_frame_is_accepted(dut: HierarchyObject) -> None:
    """For all its ramps together, before the first is written."""
    random = rng("ramp queue, accepted")
    queue = await Queue.begin(dut)
    ramps = [random_ramp(random) for _ in range(DEPTH)]
    for count in (1, DEPTH - 1, DEPTH):
        words = [word for ramp in ramps[:count] for word in ramp]
        await queue.bus.accept(words)
        assert read(dut.room) == DEPTH
        await queue.bus.frame(commit=True)
        assert read(dut.room) == DEPTH - count
        await queue.bus.write(words)
        assert read(dut.room) == DEPTH - count
        await queue.take_all(ramps[:count])


@cocotb.test()
async def a_ramp_with_now_says_what_it_needs(dut: HierarchyObject) -> None:
    """Asserted only with the strobe that checks its control word."""
    random = rng("ramp queue, needs")
    queue = await Queue.begin(dut)
    for now in (False, True, False, True):
        await queue.bus.frame()
        for index, word in enumerate(random_ramp(random, now)):
            checking = cocotb.start_soon(queue.bus.check([word]))
            needs = []
            while not checking.done():
                await ReadOnly()
                needs.append(read(dut.needs_motion))
                await queue.clocks.fall
            assert sum(needs) == (now and index == 0), (now, index)


@cocotb.test()
async def flush_empties_the_queue(dut: HierarchyObject) -> None:
    """For as long as it is high whatever is written is dropped, NOW as well; afterwards all is as ever."""
    random = rng("ramp queue, flush")
    queue = await Queue.begin(dut)
    for now in (False, True):
        for _ in range(3):
            await queue.bus.push(random_ramp(random, now))
        dut.flush.value = 1
        await queue.clocks.wait(2)
        # a replay in progress continues
        await queue.bus.frame()
        await queue.bus.write(random_ramp(random, now))
        dut.flush.value = 0
        await queue.check([])
        ramp = random_ramp(random)
        await queue.bus.push(ramp)
        await queue.check([ramp])
        await queue.strobe("take")
        await queue.check([])
