# SPDX-License-Identifier: MIT
"""Test bench of passo_line_queue."""

from random import Random

from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import SUBSTEPS_MAX, Clocks, PushBus, begin, read

QUEUE_FULL, BUSY, BAD_VALUE = 7, 8, 9
LAST, ENDLESS = 1, 2


class Queue:
    """The module under test."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self.axes = len(dut.directions)
        self.bus = PushBus(dut, clocks)

    @classmethod
    async def begin(cls, dut: HierarchyObject) -> "Queue":
        """Reset."""
        return cls(dut, await begin(dut, *PushBus.INPUTS, "blocked", "take", "release_line", "flush"))

    def random_line(self, random: Random, control: int | None = None) -> list[int]:
        """Words of a good line."""
        m = random.choice((1, SUBSTEPS_MAX, random.randrange(1, 1 << random.randrange(1, 31))))
        n = [random.choice((0, m, random.randrange(m + 1))) for _ in range(self.axes)]
        if control is None:
            control = random.randrange(1 << self.axes) << 8 | random.choice(
                (0, LAST, ENDLESS, LAST | ENDLESS)
            )
        return [control, m, *n]

    async def strobe(self, name: str) -> None:
        """Raise an input for a clock."""
        getattr(self.dut, name).value = 1
        await self.clocks.wait(1)
        getattr(self.dut, name).value = 0

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

    def check_room(self, room: int) -> None:
        """Check the free places."""
        assert read(self.dut.room) == room
