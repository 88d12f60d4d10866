# SPDX-License-Identifier: MIT
"""What the tests of single modules share: reset, buses, random numbers. Clocks: passo.cocotb.clocks."""

import random
from collections.abc import Sequence
from typing import ClassVar, Self

import cocotb
from cocotb.handle import HierarchyObject
from cocotb.triggers import Timer
from passo.cocotb.clocks import PERIOD, Clocks, Recorder, Signal, read

from cocotb_tests.helpers.runner import seed

SUBSTEPS_MAX = (1 << 30) - 1  # of a line
LIMIT = 3_000_000  # clocks after which a test is taken for endless


def rng(name: str) -> random.Random:
    """Random numbers of one test: they depend on PASSO_SEED and the name only."""
    return random.Random(f"{seed()}/{name}")


def patience(verilator: int, icarus: int) -> int:
    """A number for each simulator: Icarus Verilog is slow."""
    name = getattr(cocotb, "SIM_NAME", "")  # only the simulator has one
    return icarus if name.lower().startswith("icarus") else verilator


async def begin(dut: HierarchyObject, *inputs: str, period: int = PERIOD) -> Clocks:
    """Set these inputs to 0, start the clock and reset; return on the falling edge on which reset ends.

    A module that needs no reset has no `rst`.
    """
    for name in inputs:
        getattr(dut, name).value = 0
    clocks = Clocks(dut.clk, period)
    clocks.start()
    cocotb.start_soon(_watchdog(clocks))
    if hasattr(dut, "rst"):
        dut.rst.value = 1
        await clocks.wait(3)
        dut.rst.value = 0
    else:
        await clocks.wait(1)
    return clocks


async def _watchdog(clocks: Clocks) -> None:
    await Timer(LIMIT * clocks.period, "step")
    assert not clocks.running, f"no end after {LIMIT} clocks"


class Bench:
    """A module under test and its clock; INPUTS are 0 until a test says otherwise."""

    INPUTS: ClassVar[tuple[str, ...]] = ()

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks

    @classmethod
    async def begin(cls, dut: HierarchyObject) -> Self:
        """Reset."""
        return cls(dut, await begin(dut, *cls.INPUTS))

    async def strobe(self, name: str) -> None:
        """Raise an input for a clock."""
        getattr(self.dut, name).value = 1
        await self.clocks.wait(1)
        getattr(self.dut, name).value = 0


class PushBus:
    """The bus of one queue: pushes words as the link does, first to be checked, then to be written."""

    COMMIT_CLOCKS = 3
    INPUTS = ("bus_frame", "bus_commit", "bus_check", "bus_write", "select", "bus_data", "bus_msb")

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self._refusals = Recorder(clocks, dut.refusal)

    async def frame(self, commit: bool = False) -> None:
        """Begin a pass over the payload of a frame: to check it, or to execute it."""
        self.dut.bus_commit.value = commit
        self.dut.bus_frame.value = 1
        await self.clocks.wait(1)
        self.dut.bus_frame.value = 0
        await self.clocks.wait(2)

    async def check(self, words: Sequence[int]) -> list[int]:
        """Have words checked; return the answer to each, which comes one clock later and for one clock."""
        answers: list[int] = []
        for word in words:
            await self._strobe(self.dut.bus_check, word, before=2)
            strobe = self.clocks.now - 1
            answers.append(read(self.dut.refusal))
            await self.clocks.wait(2)
            late = [n for n, answer in self._refusals.changes if n >= strobe and answer and n != strobe + 1]
            assert not late, f"an answer {late} without a question"
        return answers

    async def write(self, words: Sequence[int]) -> None:
        """Execute words, one every 4 clocks."""
        for word in words:
            await self._strobe(self.dut.bus_write, word, before=1)
            await self.clocks.wait(2)

    async def accept(self, words: Sequence[int]) -> None:
        """Check a good frame; `commit` may follow at any time."""
        await self.frame()
        assert set(await self.check(words)) == {0}

    async def commit(self, words: Sequence[int]) -> None:
        """Execute a checked frame; its first word is on the bus after COMMIT_CLOCKS."""
        await self.frame(commit=True)
        await self.write(words)

    async def push(self, words: Sequence[int]) -> None:
        """A good frame: check, then execute."""
        await self.accept(words)
        await self.commit(words)

    async def _strobe(self, signal: Signal, word: int, before: int) -> None:
        # address and data are stable as many clocks before the strobe, and stay there; only a check
        # tells the highest bit
        self.dut.select.value = 1
        self.dut.bus_data.value = word
        self.dut.bus_msb.value = max(0, word.bit_length() - 1) if signal is self.dut.bus_check else 0
        await self.clocks.wait(before)
        signal.value = 1
        await self.clocks.wait(1)
        signal.value = 0
