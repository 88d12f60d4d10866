# SPDX-License-Identifier: MIT
"""Test bench of passo_ramp_queue."""

from collections.abc import Sequence
from random import Random

from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read
from passo.registers import Shape

from cocotb_tests.helpers.bench import Bench, PushBus

QUEUE_FULL, BUSY, BAD_VALUE = 7, 8, 9
WORDS = 5
MIRROR = 4
UNUSED = 6  # half word


def random_ramp(random: Random, now: bool = False) -> list[int]:
    """Words of a good ramp."""
    velocity = random.choice((0, 1 << 47, random.randrange(1 << 47)))
    control = random.choice((0, 1)) | now << 1 | random.randrange(2) << 2 | random.choice(tuple(Shape)) << 4
    step = random.randrange(1 << 48)
    return [
        velocity >> 32 << 16 | control,
        velocity & 0xFFFFFFFF,
        random.randrange(1 << 32),
        step >> 32,
        step & 0xFFFFFFFF,
    ]


def inverted(ramp: list[int], word: int) -> int:
    """What the half words of a word are inverted by: T always is, du if the ramp is mirrored."""
    return 0xFFFF if word == 2 or (word > 2 and ramp[0] & MIRROR) else 0


class Queue(Bench):
    """The module under test."""

    INPUTS = (*PushBus.INPUTS, "blocked", "take", "take_now", "flush", "half_index")

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.depth = 1 << len(dut.room) - 1
        self.bus = PushBus(dut, clocks)

    async def check(self, ramps: Sequence[list[int]], now_pending: bool = False) -> None:
        """Check the outputs, and all half words of the oldest ramp, each two clocks after its index."""
        await self.clocks.wait(2)  # valid is that of two clocks ago
        dut = self.dut
        assert read(dut.room) == self.depth - len(ramps)
        assert read(dut.valid) == bool(ramps)
        assert read(dut.now_pending) == now_pending
        if ramps:
            for index in range(2 * WORDS):
                dut.half_index.value = index
                await self.clocks.wait(3)
                word = ramps[0][index // 2]
                half = word & 0xFFFF if index % 2 else word >> 16
                assert index == UNUSED or read(dut.half) == half ^ inverted(ramps[0], index // 2), index

    async def take_all(self, ramps: Sequence[list[int]]) -> None:
        """Take all that are queued, one after the other, each checked before."""
        for taken in range(len(ramps)):
            await self.check(ramps[taken:])
            await self.strobe("take")
        await self.check([])
