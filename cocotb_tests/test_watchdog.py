# SPDX-License-Identifier: MIT
"""passo_watchdog: the times of its two stages, to the longest ones."""

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Recorder, read

from cocotb_tests.helpers.bench import Bench, patience
from cocotb_tests.helpers.runner import run

UNIT = 1 << 9  # ticks; here a tick is a clock
LATE = 4  # clocks, at most
LONGEST = (1 << 10) - 1


def test_watchdog(simulator: str) -> None:
    run(__name__, "passo_watchdog", {"UNIT_LOG2": 9}, simulator)


class Watchdog(Bench):
    """The module with a tick in every clock, and when its outputs rose."""

    INPUTS = ("tick", "write", "bus_data", "feed", "moving")

    async def configure(self, stop_after: int, disable_after: int) -> None:
        """Write the register WATCHDOG, which feeds it, too."""
        self.dut.tick.value = 1
        self.dut.bus_data.value = disable_after << 10 | stop_after
        self.dut.feed.value = 1
        await self.strobe("write")
        self.dut.feed.value = 0


@cocotb.test()
async def both_stages_come_after_their_times(dut: HierarchyObject) -> None:
    """Not earlier; a unit is 2^UNIT_LOG2 ticks. The next frame ends both."""
    watchdog = await Watchdog.begin(dut)
    times = ((1, 1), (2, LONGEST // 3), (LONGEST, 1))
    dut.moving.value = 1
    for stop_after, disable_after in times[: patience(3, 1)]:
        await watchdog.configure(stop_after, disable_after)
        begin = watchdog.clocks.now
        stop = Recorder(watchdog.clocks, dut.stop)
        disable = Recorder(watchdog.clocks, dut.disable_drives)
        await watchdog.clocks.wait(UNIT * (stop_after + disable_after) + 4 * LATE)
        ((stopped, _),), ((disabled, _),) = stop.changes, disable.changes
        assert 0 <= stopped - begin - UNIT * stop_after <= LATE
        assert 0 <= disabled - stopped - UNIT * disable_after <= LATE
        stop.stop()
        disable.stop()
        await watchdog.strobe("feed")
        assert read(dut.stop) == read(dut.disable_drives) == 0


@cocotb.test()
async def nothing_comes_without_a_time_or_a_motion(dut: HierarchyObject) -> None:
    """With stop_after 0 it is off, with disable_after 0 the drives stay enabled; at rest it only waits."""
    watchdog = await Watchdog.begin(dut)
    for stop_after, disable_after, moving, stops in ((0, 1, 1, 0), (1, 0, 1, 1), (1, 1, 0, 0)):
        dut.moving.value = moving
        await watchdog.configure(stop_after, disable_after)
        await watchdog.clocks.wait(4 * UNIT)
        assert (read(dut.stop), read(dut.disable_drives)) == (stops, 0)
    dut.moving.value = 1
    await watchdog.clocks.wait(2)
    assert (read(dut.stop), read(dut.disable_drives)) == (1, 0)
