# SPDX-License-Identifier: MIT
"""cocotb tests of the tops in examples/integration: a move has its steps, and the e-stop acts."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from cocotb.handle import HierarchyObject
from cocotbext.wishbone.driver import WBOp, WishboneMaster
from passo.build import Parameters
from passo.cocotb.clocks import PERIOD, Clocks, Recorder, read
from passo.cocotb.host import Host, plain_test, set_idle, wait
from passo.cocotb.thread import Thread
from passo.driver import Driver
from passo.moves import MoveInTime, PinTiming
from passo.registers import Cause

PARAMETERS = Parameters(axes=3, inputs=1)
STEPS = (20, -15, 3)
MOVE = MoveInTime(STEPS, "cosine", total_time=Fraction(40, 10**6), ramp_time=Fraction(15, 10**6))
CLOCKS = 4000  # that it takes, of 10 ns
TIMING = PinTiming(20, 20, 50, 20)
OFF = 0b111  # active low
BASE, SELECT, WORD = 0x3000_0000, 0, 4  # of motion_litex.py


class Bus:
    """An engine for passo.driver on the Wishbone bus."""

    clock_hz = 100_000_000

    def __init__(self, dut: HierarchyObject, thread: Thread, clocks: Clocks):
        names = ("cyc", "stb", "we", "adr", "sel", "ack", "err")
        signals = {name: name for name in names} | {"datwr": "dat_w", "datrd": "dat_r"}
        self.dut, self.clocks, self._thread = dut, clocks, thread
        self._master = WishboneMaster(dut, "wb", dut.clk, signals_dict=signals, timeout=1000)

    @property
    def clock(self) -> int:
        """Clocks up to now."""
        return self.clocks.now

    def _access(self, register: int, *written: int) -> int:
        operation = WBOp(BASE + register, *written)
        (result,) = self._thread.wait(self._master.send_cycle([operation]))
        assert result.ack == 1
        return 0 if written else result.datrd.to_unsigned()

    def transfer(self, mosi: Sequence[int], gap: int = 64) -> list[int]:
        """One frame, then `gap` clocks."""
        miso = []
        self._access(SELECT, 1)
        for word in mosi:
            miso.append(self._access(WORD))
            self._access(WORD, word)
        self._access(SELECT, 0)
        self.run(gap)
        return miso

    def run(self, clocks: int) -> int:
        """Let time pass."""
        self._thread.wait(wait(clocks * PERIOD))
        return clocks

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin."""

        async def set_pin() -> None:
            getattr(self.dut, pin).value = levels

        self._thread.wait(set_pin())


async def _begin(dut: HierarchyObject, thread: Thread) -> Host | Bus:
    if hasattr(dut, "spi_sclk"):
        return await Host.begin(dut, thread)
    set_idle(dut)
    for name in ("cyc", "stb", "we", "adr", "sel", "dat_w", "cti", "bte"):
        getattr(dut, f"wb_{name}").value = 0
    dut.rst.value = 1
    clocks = Clocks(dut.clk)
    clocks.start()
    await clocks.wait(8)
    dut.rst.value = 0
    await clocks.wait(2)
    return Bus(dut, thread, clocks)


def motion_test(body: Any) -> Any:
    """Make a cocotb test of plain code."""
    return plain_test(_begin, body)


@motion_test
def a_move_has_its_steps_and_its_time(host: Any) -> None:
    host.run(8)
    assert read(host.dut.enable) == OFF
    step, direction = Recorder(host.clocks, host.dut.step), Recorder(host.clocks, host.dut.dir)
    driver = Driver(host, parameters=PARAMETERS)
    for axis in range(3):
        driver.configure_axis(axis, TIMING, enable_inverted=True)
    assert read(host.dut.enable) == 0
    driver.move(MOVE)
    host.run(2 * CLOCKS)  # `driver.wait` looks every millisecond, which is 25 times as long
    assert driver.snapshot().quiet
    made = [0, 0, 0]
    before, clocks = 0, []
    for clock, levels in step.changes:
        down = max(((at, level) for at, level in direction.changes if at <= clock), default=(0, 0))[1]
        for axis in range(3):
            if levels & ~before & 1 << axis:
                made[axis] += -1 if down >> axis & 1 else 1
                clocks.append(clock)
        before = levels
    assert tuple(made) == STEPS
    assert tuple(driver.positions()) == STEPS
    assert CLOCKS / 2 < clocks[-1] - clocks[0] < CLOCKS


@motion_test
def the_estop_acts(host: Any) -> None:
    driver = Driver(host, parameters=PARAMETERS)
    for axis in range(3):
        driver.configure_axis(axis, TIMING, enable_inverted=True)
    host.set("estop_n", 0)
    host.run(100)
    assert read(host.dut.enable) == OFF
    assert driver.snapshot().cause == Cause.ESTOP
