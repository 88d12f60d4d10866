# SPDX-License-Identifier: MIT
"""What the tests of single modules share: the clock and its count, reset, recorders, random numbers.

Conventions. Clock `n` is the n-th rising edge after `Clocks.start`; an output "of clock n" is what a register shows
after that edge. Tests write inputs and look at outputs on falling edges, so neither side races the rising edge: what is
written then counts like the output of a register that changed at the rising edge before.
"""

import os
import random

import cocotb
from cocotb.clock import Clock
from cocotb.handle import HierarchyObject, LogicArrayObject, LogicObject
from cocotb.triggers import FallingEdge, ValueChange
from cocotb.utils import get_sim_time

from cocotb_tests.runner import seed

Signal = LogicObject | LogicArrayObject

PERIOD = 10_000  # ps


def rng(name: str) -> random.Random:
    """Random numbers of one test: they depend on PASSO_SEED and its name only."""
    return random.Random(f"{seed()}/{name}")


def value(signal: Signal) -> int:
    """Value of a signal as unsigned integer; ValueError if a bit is X or Z."""
    return int(signal.value) if isinstance(signal, LogicObject) else signal.value.to_unsigned()


class Clocks:
    """Drives a clock and counts it."""

    def __init__(self, clk: LogicObject, period: int = PERIOD) -> None:
        self.clk = clk
        self.period = period
        self.fall = FallingEdge(clk)
        self._origin = 0

    def start(self) -> None:
        """Start the clock; its first rising edge, clock 0, comes one period from now."""
        self._origin = get_sim_time("step") + self.period
        Clock(self.clk, self.period, unit="step", impl="gpi", set_action=None).start(start_high=False)

    @property
    def now(self) -> int:
        """Number of the last rising edge."""
        return (get_sim_time("step") - self._origin) // self.period

    def edge(self) -> int:
        """Number of the rising edge that is right now; ValueError at any other time."""
        clock, off = divmod(get_sim_time("step") - self._origin, self.period)
        if off:
            raise ValueError(f"{off} ps after clock {clock}")
        return clock

    async def until(self, clock: int) -> None:
        """Wait for the falling edge after a clock; that of the present one may be over."""
        while self.now < clock:
            await self.fall


async def begin(dut: HierarchyObject, period: int = PERIOD) -> Clocks:
    """Set all inputs to 0, start the clock and reset; return on the falling edge on which reset ended."""
    for signal in dut:
        if isinstance(signal, LogicObject | LogicArrayObject) and signal._name != "clk":
            pass
    clocks = Clocks(dut.clk, period)
    clocks.start()
    dut.rst.value = 1
    await clocks.until(3)
    dut.rst.value = 0
    return clocks
