# SPDX-License-Identifier: MIT
"""What the tests of single modules share: the clock and its count, reset, recorders, random numbers.

Conventions. Clock `n` is the n-th rising edge after the clock was started; an output "of clock n" is what a
register shows after that edge. Tests write inputs and look at outputs on falling edges, so that neither races
the rising edge: what is written after clock n counts like a register that changed with clock n.
"""

import random
from collections.abc import Callable, Sequence
from typing import ClassVar, Self

import cocotb
from cocotb.clock import Clock
from cocotb.handle import HierarchyObject, LogicArrayObject, LogicObject
from cocotb.triggers import FallingEdge, Timer, ValueChange
from cocotb.utils import get_sim_time

from cocotb_tests.helpers.runner import seed

Signal = LogicObject | LogicArrayObject

PERIOD = 10_000  # ps
SUBSTEPS_MAX = (1 << 30) - 1  # of a line
LIMIT = 3_000_000  # clocks after which a test is taken for endless


def rng(name: str) -> random.Random:
    """Random numbers of one test: they depend on PASSO_SEED and the name only."""
    return random.Random(f"{seed()}/{name}")


def patience(verilator: int, icarus: int) -> int:
    """A number for each simulator: Icarus Verilog is slow."""
    return verilator if cocotb.SIM_NAME.lower().startswith("verilator") else icarus


def read(signal: Signal) -> int:
    """Value of a signal as unsigned integer; ValueError if a bit is X or Z."""
    return int(signal.value) if isinstance(signal, LogicObject) else signal.value.to_unsigned()


class Clocks:
    """Drives a clock and counts it."""

    def __init__(self, clk: LogicObject, period: int = PERIOD) -> None:
        self.period = period
        self.fall = FallingEdge(clk)
        self.running = False
        self._clock = Clock(clk, period, unit="step", impl="gpi")
        self._origin = 0

    def start(self) -> None:
        """Start the clock low; its first rising edge is clock 0."""
        self._clock.start(start_high=False)
        self.running = True
        self._origin = get_sim_time("step") + self.period // 2

    def stop(self) -> None:
        """Stop the clock and all recorders, so that `begin` can be called again in the same test."""
        self._clock.stop()
        self.running = False

    @property
    def now(self) -> int:
        """Number of the last rising edge."""
        return (get_sim_time("step") - self._origin) // self.period

    def edge(self) -> int:
        """Number of the rising edge that is right now; ValueError at any other time."""
        clock, off = divmod(get_sim_time("step") - self._origin, self.period)
        if off:
            raise ValueError(f"change {off} ps after clock {clock}")
        return clock

    async def until(self, clock: int) -> None:
        """Wait for the falling edge after a clock."""
        while self.now < clock:
            await self.fall

    async def wait(self, clocks: int) -> None:
        """Wait for as many falling edges."""
        for _ in range(clocks):
            await self.fall


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


class Recorder:
    """Records every change of a signal as (clock, value), from now to `stop` or the end of the test."""

    def __init__(self, clocks: Clocks, signal: Signal) -> None:
        self.changes: list[tuple[int, int]] = []
        self._clocks = clocks
        self._signal = signal
        self._task = cocotb.start_soon(self._watch())

    def stop(self) -> None:
        """Record no more."""
        self._task.cancel()

    async def _watch(self) -> None:
        change = ValueChange(self._signal)
        while True:
            await change
            if not self._clocks.running:
                return
            clock = self._clocks.edge()
            # a vector may change bit by bit, at the same time
            if self.changes and self.changes[-1][0] == clock:
                self.changes.pop()
            self.changes.append((clock, read(self._signal)))

    def clocks_where(self, condition: Callable[[int], object], last: int) -> list[int]:
        """Clocks up to `last` after which the value met a condition."""
        found: list[int] = []
        ends = [*[clock for clock, _ in self.changes], last + 1][1:]
        for (clock, value), end in zip(self.changes, ends, strict=True):
            if condition(value):
                found.extend(range(clock, end))
        return found


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
        # address and data stand on the bus as many clocks before the strobe, and stay there; only a check
        # tells the highest bit
        self.dut.select.value = 1
        self.dut.bus_data.value = word
        self.dut.bus_msb.value = max(0, word.bit_length() - 1) if signal is self.dut.bus_check else 0
        await self.clocks.wait(before)
        signal.value = 1
        await self.clocks.wait(1)
        signal.value = 0
