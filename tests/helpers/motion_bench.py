# SPDX-License-Identifier: MIT
"""cocotb tests of the tops in examples/integration: a move has its steps, and the e-stop acts."""

from fractions import Fraction
from typing import Any

from cocotb.handle import HierarchyObject
from passo.build import Parameters
from passo.cocotb.bus import AxiLite, BusHost, Wishbone
from passo.cocotb.clocks import Recorder, read
from passo.cocotb.host import Host, plain_test
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
BASE = 0x3000_0000  # of motion_litex.py


async def _begin(dut: HierarchyObject, thread: Thread) -> Host | BusHost:
    if hasattr(dut, "spi_sclk"):
        return await Host.begin(dut, thread)
    if hasattr(dut, "s_axil_awvalid"):
        return await BusHost.begin(dut, thread, AxiLite)
    return await BusHost.begin(dut, thread, Wishbone, 0 if hasattr(dut, "wb_cyc_i") else BASE)


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
