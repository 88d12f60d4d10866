# SPDX-License-Identifier: MIT
"""A ramp queue of maximum depth: every entry, every number of ramps, NOW in any of them."""

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.ramp_queue import QUEUE_FULL, WORDS, Queue, random_ramp


@cocotb.test()
async def every_place_keeps_its_ramp(dut: HierarchyObject) -> None:
    """Filled from any entry on, after checking a frame with one ramp too many; twice around."""
    random = rng("deep ramps")
    queue = await Queue.begin(dut)
    for count in (queue.depth // 3, queue.depth, queue.depth):
        ramps = [random_ramp(random) for _ in range(count)]
        words = [word for ramp in ramps for word in ramp]
        if count == queue.depth:
            await queue.bus.frame()
            answers = await queue.bus.check(words + ramps[0])
            assert answers == [0] * len(words) + [QUEUE_FULL] * WORDS
        await queue.bus.push(words)
        await queue.take_all(ramps)


@cocotb.test()
async def now_is_found_in_any_place(dut: HierarchyObject) -> None:
    """Behind 2^k - 1 others it becomes the oldest ramp, and in the last and the first place of the memory."""
    random = rng("deep ramps, now")
    queue = await Queue.begin(dut)
    for others in (*((1 << k) - 1 for k in range(queue.depth.bit_length())), 0, 0):
        ramps = [random_ramp(random, n == others) for n in range(others + 1)]
        await queue.bus.push([word for ramp in ramps for word in ramp])
        await queue.check(ramps, now_pending=True)
        await queue.strobe("take_now")
        await queue.check(ramps[-1:])
        await queue.strobe("take")
        await queue.check([])
