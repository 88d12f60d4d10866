# SPDX-License-Identifier: MIT
"""The clock of a test and its count, and recorders of signals.

Conventions. Clock `n` is the n-th rising edge after the clock was started; an output "of clock n" is the
value of a register after that edge. Tests write inputs and read outputs on falling edges, so that neither
races the rising edge: a value written after clock n acts like a register that changed with clock n.
"""

from collections.abc import Callable

import cocotb
from cocotb.clock import Clock
from cocotb.handle import LogicArrayObject, LogicObject
from cocotb.triggers import FallingEdge, Timer, ValueChange
from cocotb.utils import get_sim_time

Signal = LogicObject | LogicArrayObject

PERIOD = 10_000  # ps


def read(signal: Signal) -> int:
    """Value of a signal as unsigned integer; ValueError if a bit is X or Z.

    Straight from the bits of the simulator: by way of cocotb's types it takes several times as long.
    """
    return int(signal._handle.get_signal_val_binstr(), 2)


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
        if self.now < clock:
            await self.fall
        await self._more(clock - self.now)

    async def wait(self, clocks: int) -> None:
        """Wait for as many falling edges."""
        if clocks > 0:
            await self.fall
        await self._more(clocks - 1)

    async def _more(self, clocks: int) -> None:
        """On a falling edge: wait for as many more, most of them in one piece."""
        if clocks > 1:
            await Timer(clocks * self.period - self.period // 2, "step")
        if clocks > 0:
            await self.fall


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
