# SPDX-License-Identifier: MIT
"""A host at the SPI pins of a design, for tests in synchronous code.

    @host_test
    def it_moves(host: Host) -> None:
        driver = Driver(host)
        ...

Such a test is synchronous code in its own thread, because passo.link, passo.host and passo.driver are not
coroutines. Simulated time passes in `run`, `transfer` and the functions built on them.
"""

import functools
from collections.abc import Callable, Coroutine, Sequence
from typing import Any, Self, TypeVar

import cocotb
from cocotb.handle import HierarchyObject
from cocotb.triggers import Timer

from passo.build import Parameters
from passo.cocotb.clocks import Clocks, Recorder, Signal
from passo.cocotb.model import CoreModel
from passo.cocotb.pulses import PinTiming, PulseChecker
from passo.cocotb.spi import SpiMaster
from passo.cocotb.thread import Thread
from passo.pins import INPUTS

LEAD = 4  # clocks from chip select to SCLK and back
PICOSECONDS = 10**12

Engine = TypeVar("Engine")


class DesignHost:
    """What all hosts have: engines for passo.link.Link, passo.host.Channel and passo.driver.Driver.

    The design has `clk`, `rst` and, to be watched, `step` and `dir`.
    """

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self.clock_hz = PICOSECONDS // clocks.period
        self.checker: PulseChecker | None = None
        self._thread = thread

    # time

    @property
    def clock(self) -> int:
        """Clocks up to now."""
        return self.clocks.now

    def run(self, clocks: int) -> int:
        """Let time pass."""
        if clocks > 0:
            self._thread.wait(wait(clocks * self.clocks.period))
        self.compare()
        return clocks

    def run_until(self, condition: Callable[[], object], limit: int, step: int = 64) -> None:
        """Let time pass until a condition is true; it is checked every `step` clocks."""
        end = self.clock + limit
        while not condition():
            assert self.clock < end, f"clock {self.clock}: nothing after {limit} clocks"
            self.run(step)

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin."""

        async def set_pin() -> None:
            getattr(self.dut, pin).value = levels

        self._thread.wait(set_pin())

    def spawn(self, run: Callable[[], Coroutine[Any, Any, None]]) -> None:
        """Start a coroutine that runs beside the test, until its end."""

        async def start() -> None:
            cocotb.start_soon(run())

        self._thread.wait(start())

    # checks

    def compare(self) -> None:
        """Compare all up to now, if there is something to compare with."""

    def watch(self, *timings: PinTiming) -> PulseChecker:
        """Check these pin timings from now on, one per axis, or one for all."""

        async def make() -> PulseChecker:
            own = timings if len(timings) > 1 else timings * len(self.dut.step)
            return PulseChecker(self.clocks, self.dut.step, self.dut.dir, own)

        self.finish_watch()
        self.checker = self._thread.wait(make())
        return self.checker

    def record(self, signal: Signal) -> Recorder:
        """Record every change of a signal from now on."""

        async def make() -> Recorder:
            return Recorder(self.clocks, signal)

        return self._thread.wait(make())

    def finish_watch(self) -> str:
        """Check that no pulse was too short or is unfinished; tell what was seen."""
        told = self.checker.finish() if self.checker is not None else ""
        self.checker = None
        return told

    def told(self) -> list[str]:
        """Finish all checks; tell what was checked."""
        seen = self.finish_watch()
        self.compare()
        return [seen] if seen else []

    def end(self) -> None:
        """Finish all checks and log what was checked."""
        self.dut._log.info("; ".join(self.told()))


class Host(DesignHost):
    """A host at the SPI pins of passo_spi_top."""

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks) -> None:
        super().__init__(dut, thread, clocks)
        self.half_period, self.sclk_high = 2, 2  # clocks
        self.corrupt: Callable[[list[int]], list[int]] = list  # what the wire makes of a frame
        self._spi = SpiMaster(dut, 2 * clocks.period)
        self._model: CoreModel | None = None

    @classmethod
    async def begin(cls, dut: HierarchyObject, thread: Thread) -> Self:
        """Reset; return on the falling edge at its end."""
        dut.rst.value = 1
        set_idle(dut)
        clocks = Clocks(dut.clk)
        clocks.start()
        CoreModel.go_on(clocks)
        host = cls(dut, thread, clocks)
        # chip select resets the SCLK domain by an edge
        dut.spi_cs_n.value = 0
        await clocks.wait(4)
        dut.spi_cs_n.value = 1
        await clocks.wait(4)
        dut.rst.value = 0
        return host

    def transfer(self, mosi: Sequence[int], gap: int = 16) -> list[int]:
        """One chip select: send the words and return those received, then wait for `gap` clocks."""
        bits = self.transfer_bits(mosi, 32 * len(mosi), gap)
        return [int("".join(map(str, bits[n : n + 32])), 2) for n in range(0, len(bits), 32)]

    def transfer_bits(
        self, mosi: Sequence[int], count: int, gap: int = 16, cut_high: bool = False
    ) -> list[int]:
        """One chip select of `count` bits."""
        words = self.corrupt(list(mosi))
        received = self._thread.wait(self._master(gap).transfer_bits(words, count, cut_high=cut_high))
        self.compare()
        return received

    def clock_others(self, bits: int) -> None:
        """SCLK and MOSI move for another slave: chip select stays high."""
        self._thread.wait(self._master(LEAD).clock_others(bits))
        self.compare()

    def _master(self, gap: int) -> SpiMaster:
        spi, period = self._spi, self.clocks.period
        spi.period, spi.high = 2 * self.half_period * period, self.sclk_high * period
        spi.lead = spi.trail = LEAD * period
        spi.gap = gap * period
        return spi

    def follow(self, core: HierarchyObject, parameters: Parameters) -> None:
        """As the first thing of a test: compare this passo_spi_top with the model, from now to the end."""

        async def make() -> CoreModel:
            return CoreModel.of(self.clocks, core, parameters)

        self._model = self._thread.wait(make())

    def compare(self) -> None:
        """Compare all up to now."""
        if self._model is not None:
            self._model.compare()

    def told(self) -> list[str]:
        return [*super().told(), *([self._model.summary()] if self._model is not None else [])]


def set_idle(dut: HierarchyObject) -> None:
    """Set the inputs of a core that a design has, other than clk, rst and those of its link, as if nothing
    were connected."""
    for pin in INPUTS:
        if pin.name != "rst" and not pin.name.startswith("spi_") and hasattr(dut, pin.name):
            signal = getattr(dut, pin.name)
            signal.value = pin.idle * ((1 << len(signal)) - 1)


async def wait(picoseconds: int) -> None:
    """As a coroutine for `Thread.wait`."""
    await Timer(picoseconds, "step")


def plain_test(
    begin: Callable[[HierarchyObject, Thread], Coroutine[Any, Any, Engine]],
    body: Callable[[Engine], None],
    whole: Callable[[Engine], None] | None = None,
) -> Any:
    """Make a cocotb test with the name of `body` from plain code on an engine: `whole`, or else `body`."""

    async def test(dut: HierarchyObject) -> None:
        thread = Thread()
        engine = await begin(dut, thread)
        await thread.run(lambda: (whole or body)(engine))

    for name in functools.WRAPPER_ASSIGNMENTS:
        setattr(test, name, getattr(body, name))
    return cocotb.test(test)


def host_test(body: Callable[[Host], None]) -> Any:
    """Make a cocotb test from plain code."""

    def whole(host: Host) -> None:
        body(host)
        host.end()

    return plain_test(Host.begin, body, whole)
