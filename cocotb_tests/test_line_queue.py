# SPDX-License-Identifier: MIT
"""passo_line_queue: order, refusals, room."""

from collections import deque

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import read

from cocotb_tests.helpers.bench import SUBSTEPS_MAX, rng
from cocotb_tests.helpers.line_queue import BAD_VALUE, BUSY, ENDLESS, LAST, QUEUE_FULL, Queue
from cocotb_tests.helpers.runner import run

DEPTH_LOG2 = 2
DEPTH = 1 << DEPTH_LOG2


@pytest.mark.parametrize("register", [0, 1])
@pytest.mark.parametrize("axes", [1, 8])
def test_line_queue(simulator: str, axes: int, register: int) -> None:
    parameters = {"AXES": axes, "DEPTH_LOG2": DEPTH_LOG2, "STEPS_REGISTER": register}
    run(__name__, "passo_line_queue", parameters, simulator)


@pytest.mark.parametrize("depth_log2", [5, 8])
def test_deep_line_queue(simulator: str, depth_log2: int) -> None:
    run("cocotb_tests.deep_lines", "passo_line_queue", {"AXES": 1, "DEPTH_LOG2": depth_log2}, simulator)


@cocotb.test()
async def lines_come_out_whole_and_in_order(dut: HierarchyObject) -> None:
    """Random pushes and takes, many rounds of the memory; a place is free when the next line is taken."""
    random = rng("line queue")
    queue = await Queue.begin(dut)
    waiting: deque[list[int]] = deque()
    current: list[int] | None = None
    for _ in range(200):
        await queue.clocks.wait(4)
        queue.check_room(DEPTH - len(waiting) - (current is not None))
        queue.check_next(waiting[0] if waiting else None)
        if current:
            queue.check_current(current)
        if random.random() < 0.55:
            count = random.randrange(1, DEPTH + 1)
            if read(dut.room) < count:
                continue
            lines = [queue.random_line(random) for _ in range(count)]
            await queue.bus.push([word for line in lines for word in line])
            waiting.extend(lines)
        elif waiting:
            current = waiting.popleft()
            await queue.strobe("take")
            await queue.clocks.wait(1)
            queue.check_current(current)
            queue.check_next(waiting[0] if waiting else None)
        elif current:
            # the motion is over
            await queue.strobe("release_line")
            current = None


@cocotb.test()
async def the_next_line_is_ready_two_clocks_after_a_take(dut: HierarchyObject) -> None:
    """Takes on every second clock, as lines of one substep make them."""
    random = rng("line queue, fast")
    queue = await Queue.begin(dut)
    lines = [queue.random_line(random) for _ in range(DEPTH)]
    await queue.bus.push([word for line in lines for word in line])
    for n, line in enumerate(lines):
        await queue.take(line)
        queue.check_room(DEPTH - (DEPTH - n))
    queue.check_next(None)


@cocotb.test()
async def a_check_changes_nothing(dut: HierarchyObject) -> None:
    """A frame that is checked and not executed, whole or in part, leaves no trace."""
    random = rng("line queue, check")
    queue = await Queue.begin(dut)
    line = queue.random_line(random)
    for length in range(1, 2 * len(line)):
        words = (queue.random_line(random) + queue.random_line(random))[:length]
        await queue.bus.accept(words)
        assert read(dut.incomplete) == (length % len(line) != 0)
        queue.check_next(None)
        queue.check_room(DEPTH)
    await queue.bus.push(line)
    await queue.check_settled(line, DEPTH - 1)


@cocotb.test()
async def bad_values_are_refused(dut: HierarchyObject) -> None:
    """Every reserved control bit, M = 0 or too large, N above M, in a frame's first and second line."""
    random = rng("line queue, values")
    queue = await Queue.begin(dut)
    good = queue.random_line(random)
    bad: list[tuple[int, list[int]]] = []
    for bit in range(32):
        line = [1 << bit, 1000, *[1000] * queue.axes]
        known = bit < 2 or 8 <= bit < 8 + queue.axes
        bad.append((-1 if known else 0, line))
    bad += [(1, [0, m, *[0] * queue.axes]) for m in (0, SUBSTEPS_MAX + 1, 1 << 31, 0xFFFFFFFF)]
    for axis in range(queue.axes):
        half, top = 1 << 29, SUBSTEPS_MAX
        for m, n in ((1, 2), (half - 1, half), (top, top + 1), (top, (1 << 31) + 1), (1000, 1001)):
            line = [0, m, *[m] * queue.axes]
            line[2 + axis] = n
            bad.append((2 + axis, line))
    for at, line in bad:
        for before in ([], good):
            await queue.bus.frame()
            answers = await queue.bus.check(before + line)
            expected = [0] * len(before + line)
            if at >= 0:
                expected[len(before) + at] = BAD_VALUE
            assert answers == expected, line
    queue.check_room(DEPTH)


@cocotb.test()
async def a_frame_needs_room_for_all_its_lines(dut: HierarchyObject) -> None:
    """QUEUE_FULL from the first word of the line that finds no place; what was checked before counts."""
    random = rng("line queue, room")
    queue = await Queue.begin(dut)
    for room in range(DEPTH, -1, -1):
        queue.check_room(room)
        lines = [queue.random_line(random) for _ in range(DEPTH + 1)]
        for _ in range(2):
            await queue.bus.frame()
            answers = await queue.bus.check([word for line in lines for word in line])
            words = room * len(lines[0])
            assert answers[:words] == [0] * words
            assert answers[words] == QUEUE_FULL
        if room:
            await queue.bus.push(lines[0])
            await queue.clocks.wait(2)


@cocotb.test()
async def room_is_taken_when_a_frame_is_accepted(dut: HierarchyObject) -> None:
    """For all its lines together, before the first is written; entries freed meanwhile count."""
    random = rng("line queue, accepted")
    queue = await Queue.begin(dut)
    await queue.bus.push(queue.random_line(random) + queue.random_line(random))
    await queue.strobe("take")
    words = [word for _ in range(2) for word in queue.random_line(random)]
    for delay in range(-2, 3):
        room = read(dut.room)
        await queue.bus.accept(words)
        queue.check_room(room)
        accept, free = queue.clocks.now + 3, queue.clocks.now + 3 + delay
        dut.bus_commit.value = 1
        for _ in range(8):
            dut.bus_frame.value = queue.clocks.now == accept
            dut.take.value = queue.clocks.now == free
            await queue.clocks.wait(1)
        queue.check_room(room - 2 + 1)
        await queue.bus.write(words)
        queue.check_room(room - 2 + 1)
        await queue.strobe("take")
        await queue.clocks.wait(2)
        queue.check_room(room - 2 + 2)


@cocotb.test()
async def a_stopped_channel_refuses_lines(dut: HierarchyObject) -> None:
    """BUSY goes before QUEUE_FULL and BAD_VALUE; other registers are no business of the queue."""
    queue = await Queue.begin(dut)
    dut.blocked.value = 1
    await queue.bus.frame()
    assert set(await queue.bus.check([0, 5, *[5] * queue.axes])) == {BUSY}
    assert (await queue.bus.check([0xFFFFFFFF]))[0] == BUSY
    dut.blocked.value = 0
    dut.select.value = 0
    dut.bus_data.value = 0xFFFFFFFF
    for name in ("bus_check", "bus_write"):
        await queue.strobe(name)
        assert read(dut.refusal) == 0
    await queue.clocks.wait(3)
    queue.check_room(DEPTH)
    queue.check_next(None)


@cocotb.test()
async def the_end_of_a_motion_leaves_the_next_motion_alone(dut: HierarchyObject) -> None:
    """release_line gives back the LAST line's place only, although an ENDLESS line waits behind it."""
    random = rng("line queue, release")
    queue = await Queue.begin(dut)
    last, endless = queue.random_line(random, LAST), queue.random_line(random, ENDLESS)
    await queue.bus.push(last + endless)
    await queue.clocks.wait(2)
    await queue.strobe("take")
    await queue.clocks.wait(3)
    await queue.strobe("release_line")
    await queue.check_settled(endless, DEPTH - 1)


@cocotb.test()
async def flush_empties_the_queue(dut: HierarchyObject) -> None:
    """For as long as it is high whatever is written is dropped; afterwards lines are as good as ever."""
    random = rng("line queue, flush")
    queue = await Queue.begin(dut)
    for taken in range(3):
        lines = [queue.random_line(random) for _ in range(3)]
        await queue.bus.push([word for line in lines for word in line])
        for _ in range(taken):
            await queue.strobe("take")
            await queue.clocks.wait(1)
        dut.flush.value = 1
        await queue.clocks.wait(2)
        # a replay in progress continues
        await queue.bus.frame()
        await queue.bus.write(queue.random_line(random))
        dut.flush.value = 0
        await queue.check_settled(None, DEPTH)
        line = queue.random_line(random)
        await queue.bus.push(line)
        await queue.clocks.wait(2)
        await queue.take(line)
        await queue.strobe("release_line")
        await queue.clocks.wait(2)
