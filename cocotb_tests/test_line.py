# SPDX-License-Identifier: MIT
"""passo_line: the number of its substeps, in all bits."""

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import read

from cocotb_tests.helpers.bench import Bench
from cocotb_tests.helpers.runner import run

BITS = 30  # of M


def test_line(simulator: str) -> None:
    run(__name__, "passo_line", {"AXES": 2}, simulator)


class Counter(Bench):
    """The module with one line."""

    INPUTS = (
        *("start", "stop", "substep", "next_valid"),
        *("last", "endless", "last_substep", "current_directions"),
    )

    async def begin_line(self, substeps: int, at: int) -> None:
        """A LAST line of so much, of which `at` substeps are made: it would take minutes to make them."""
        self.dut.next_valid.value = 1
        await self.strobe("start")
        self.dut.next_valid.value = 0
        self.dut.last.value = 1
        self.dut.last_substep.value = substeps - 1
        self.dut.substep_number.value = at
        await self.clocks.wait(3)

    async def substeps(self) -> int:
        """Make substeps to the end of the line; return their number."""
        made = 0
        while not read(self.dut.ended):
            await self.strobe("substep")
            made += 1
            await self.clocks.wait(2)
        return made


@cocotb.test()
async def a_line_ends_with_its_last_substep(dut: HierarchyObject) -> None:
    """Of any length: each bit of the number is carried into and compared."""
    counter = await Counter.begin(dut)
    for bit in range(1, BITS):
        power = 1 << bit
        for substeps in (power - 1, power, power + 1, power + 2):
            at = max(0, power - 4)
            await counter.begin_line(substeps, at)
            assert await counter.substeps() == substeps - at
