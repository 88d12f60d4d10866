# SPDX-License-Identifier: MIT
"""Test bench of passo_line_queue."""

from random import Random

from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import SUBSTEPS_MAX, Bench, PushBus

QUEUE_FULL, BUSY, BAD_VALUE = 7, 8, 9
LAST, ENDLESS = 1, 2


class Queue(Bench):
    """The module under test."""

    INPUTS = (*PushBus.INPUTS, "blocked", "take", "release_line", "flush")

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.axes = len(dut.directions)
        self.bus = PushBus(dut, clocks)

    def random_line(self, random: Random, control: int | None = None) -> list[int]:
        """Words of a good line."""
        m = random.choice((1, SUBSTEPS_MAX, random.randrange(1, 1 << random.randrange(1, 31))))
        n = [random.choice((0, m, random.randrange(m + 1))) for _ in range(self.axes)]
        if control is None:
            control = random.randrange(1 << self.axes) << 8 | random.choice(
                (0, LAST, ENDLESS, LAST | ENDLESS)
            )
        return [control, m, *n]

    def check_next(self, line: list[int] | None) -> None:
        """Check that this line can be taken, or that there is none."""
        assert read(self.dut.next_valid) == (line is not None)

    def check_current(self, line: list[int]) -> None:
        """Check all of the current line."""
        assert read(self.dut.last) == line[0] & 1
        assert read(self.dut.endless) == line[0] >> 1 & 1
        assert read(self.dut.directions) == line[0] >> 8
        assert read(self.dut.last_substep) == line[1] - 1
        steps = read(self.dut.steps)
        assert [steps >> 30 * axis & SUBSTEPS_MAX for axis in range(self.axes)] == line[2:]

    async def take(self, line: list[int]) -> None:
        """Take the line that is offered, which is this one."""
        self.check_next(line)
        await self.strobe("take")
        await self.clocks.wait(1)
        self.check_current(line)

    async def check_settled(self, line: list[int] | None, room: int) -> None:
        """Check what can be taken and the free places, which follow by two clocks."""
        await self.clocks.wait(2)
        self.check_next(line)
        self.check_room(room)

    def check_room(self, room: int) -> None:
        """Check the free places."""
        assert read(self.dut.room) == room
