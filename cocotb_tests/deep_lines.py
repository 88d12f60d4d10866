# SPDX-License-Identifier: MIT
"""A line queue of maximum depth: every entry, every number of lines."""

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import read

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.line_queue import ENDLESS, LAST, QUEUE_FULL, Queue


@cocotb.test()
async def every_place_keeps_its_line(dut: HierarchyObject) -> None:
    """Filled from any entry on, after checking a frame with one line too many; many times around.

    Each entry has each kind of line once, so that all bits of its control word are set and cleared.
    """
    random = rng("deep lines")
    queue = await Queue.begin(dut)
    depth = 1 << len(dut.room) - 1
    place = 0
    for turn, count in enumerate((depth // 3, depth, depth, depth, depth)):
        places = [(place + n) % depth for n in range(count)]
        place = (place + count) % depth
        controls = [(0, LAST, ENDLESS)[(n + turn) % 3] | (n + turn) % 2 << 8 for n in places]
        lines = [queue.random_line(random, control) for control in controls]
        words = [word for line in lines for word in line]
        if count == depth:
            await queue.bus.frame()
            answers = await queue.bus.check(words + lines[0])
            assert answers == [0] * len(words) + [QUEUE_FULL] * len(lines[0])
        await queue.bus.push(words)
        for taken, line in enumerate(lines):
            await queue.clocks.wait(2)
            queue.check_room(depth - count + taken)
            await queue.take(line)
            await queue.strobe("release_line")
        await queue.check_settled(None, depth)


@cocotb.test()
async def the_lines_of_a_frame_are_counted_to_the_last_place(dut: HierarchyObject) -> None:
    """With 2^k free entries, the line after 2^k is refused."""
    random = rng("deep lines, room")
    queue = await Queue.begin(dut)
    depth = 1 << len(dut.room) - 1
    room = depth
    while room > 1:
        fill = [word for _ in range(room // 2) for word in queue.random_line(random)]
        await queue.bus.push(fill)
        room -= room // 2
        lines = [queue.random_line(random) for _ in range(room + 1)]
        await queue.bus.frame()
        answers = await queue.bus.check([word for line in lines for word in line])
        words = room * len(lines[0])
        assert answers == [0] * words + [QUEUE_FULL] * len(lines[0])
        assert read(dut.room) == room
