# SPDX-License-Identifier: MIT
"""Tests of machine.v: every pulse is timed right and comes on the clock that the C model says."""

from fractions import Fraction

from passo.build import Parameters
from passo.cocotb.host import Host, host_test
from passo.cocotb.pulses import PinTiming, PulseChecker
from passo.driver import Driver
from passo.moves import MoveInTime
from passo.registers import Cause

PINS = PinTiming(high=20, low=20, setup=50, hold=20)  # clocks of 10 ns
MOVE = MoveInTime((40, -30), "cosine", total_time=Fraction(60, 10**6), ramp_time=Fraction(20, 10**6))


def power_up(host: Host) -> tuple[Driver, PulseChecker]:
    host.set("door_open", 0)
    host.follow(host.dut.core, Parameters(axes=2, inputs=1))
    driver = Driver(host)
    for axis in range(2):
        driver.configure_axis(axis, PINS.pins())
    return driver, host.watch(PINS)


@host_test
def a_move_has_its_steps_and_its_time(host: Host) -> None:
    driver, pulses = power_up(host)
    lamp = host.record(host.dut.lamp)
    driver.move(MOVE)
    host.run_until(lambda: len(lamp.changes) == 2, 10_000)
    (begin, _), (end, _) = lamp.changes
    assert abs(end - begin - 6000) <= 64  # half a tick of 128 clocks
    assert pulses.positions == [40, -30]
    assert all(begin < clock < end for axis in range(2) for clock, _ in pulses.steps(axis))


@host_test
def the_door_stops_it(host: Host) -> None:
    driver, pulses = power_up(host)
    driver.move(MOVE)
    host.run_until(lambda: pulses.positions[0] >= 10, 10_000)
    host.set("door_open", 1)
    host.run(100)
    assert host.dut.lamp.value == 0 and host.dut.enable.value == 0
    assert driver.snapshot().cause == Cause.ESTOP
