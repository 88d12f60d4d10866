# SPDX-License-Identifier: MIT
"""passo_tables: contents, bus accesses, and service of the channels."""

from random import Random
from typing import Any

import cocotb
import pytest
from cocotb.handle import HierarchyObject
from passo import registers as r
from passo.cocotb.clocks import Clocks, read
from passo.registers import Shape

from cocotb_tests.helpers.bench import Bench, rng
from cocotb_tests.helpers.runner import run
from tests.helpers.closed_form import loaded_table

POINTS = 256
TABLES = [shape for shape in Shape if shape != Shape.LINEAR]

# Only configuration of the FPGA initializes the tables, not reset: tests that need the initial contents come
# first.


@pytest.mark.parametrize("channels", [1, 8])
def test_tables(simulator: str, channels: int) -> None:
    run(__name__, "passo_tables", {"CHANNELS": channels}, simulator)


class Tables(Bench):
    """The module under test; the last channel is the one that asks."""

    INPUTS = (
        "bus_frame", "bus_commit", "bus_check", "bus_write", "select", "bus_address", "bus_data",
        "request", "address",
    )  # fmt: skip

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        super().__init__(dut, clocks)
        self.channels = len(dut.served)

    async def fetch(self, shape: Shape, k: int) -> tuple[int, int]:
        """Ask for a point and get it and the next one."""
        channel = self.channels - 1
        self.dut.request.value = 1 << channel
        self.dut.address.value = (shape - 1 << 8 | k) << 10 * channel
        asked = self.clocks.now
        while not read(self.dut.served) >> channel & 1:
            await self.clocks.fall
            assert self.clocks.now - asked <= 2 * self.channels + 4
        points = read(self.dut.point), read(self.dut.point_next)
        self.dut.request.value = 0
        await self.clocks.wait(2 * self.channels + 5)  # a second answer to the same question is over
        return points

    async def check_table(self, shape: Shape, points: list[int], step: int = 1) -> None:
        """Compare every `step`-th point; the point after the last one is undefined."""
        for k in range(0, POINTS, step):
            point, point_next = await self.fetch(shape, k)
            assert point == points[k]
            assert k == POINTS - 1 or point_next == points[k + 1]

    async def write_table(self, shape: Shape, points: list[int]) -> None:
        """Write a whole table, word by word like the link."""
        dut = self.dut
        first = getattr(r, f"ADDRESS_{shape.name}_BASE") % (1 << len(dut.bus_address))
        dut.select.value = 1
        for k, point in enumerate(points):
            dut.bus_address.value = first + k
            dut.bus_data.value = point
            dut.bus_write.value = 1
            await self.clocks.wait(1)
            dut.bus_write.value = 0
            await self.clocks.wait(1)
        dut.select.value = 0

    async def write_random_tables(self, random: Random) -> dict[Shape, list[int]]:
        """Write all tables; return their points."""
        tables = {shape: _random_table(random) for shape in TABLES}
        for shape, points in tables.items():
            await self.write_table(shape, points)
        return tables


@cocotb.test()
@cocotb.parametrize(shape=TABLES)
async def all_points_are_right_after_loading(dut: HierarchyObject, shape: Shape) -> None:
    """Every point of the table, and the one after it."""
    bench = await Tables.begin(dut)
    await bench.check_table(shape, loaded_table(shape))


@cocotb.test()
async def rewritten_tables_are_as_written(dut: HierarchyObject) -> None:
    """Each bank by itself."""
    bench = await Tables.begin(dut)
    random = rng("tables, rewritten")
    tables = await bench.write_random_tables(random)
    for shape in TABLES:
        await bench.check_table(shape, tables[shape], 3)


@cocotb.test()
async def a_frame_that_writes_tables_says_so(dut: HierarchyObject) -> None:
    """From the first check of a point until the next frame begins, also while it is executed."""
    bench = await Tables.begin(dut)

    async def pulse(signal: Any, selected: int = 1) -> int:
        dut.select.value = selected
        signal.value = 1
        await bench.clocks.wait(1)
        signal.value = 0
        await bench.clocks.wait(1)
        return read(dut.wanted)

    assert not await pulse(dut.bus_check, selected=0)
    assert await pulse(dut.bus_check)
    dut.bus_commit.value = 1
    assert await pulse(dut.bus_frame)
    assert await pulse(dut.bus_write)
    dut.bus_commit.value = 0
    assert not await pulse(dut.bus_frame)


@cocotb.test()
async def every_channel_is_served_in_time_with_its_own_points(dut: HierarchyObject) -> None:
    """All channels ask at random: each gets its point and the one after it within 2 * CHANNELS + 4 clocks."""
    bench = await Tables.begin(dut)
    random = rng("tables, channels")
    tables = await bench.write_random_tables(random)
    asked: dict[int, tuple[int, int]] = {}  # channel: clock, address
    waits: list[int] = []
    while len(waits) < 500:
        await bench.clocks.fall
        now, who = bench.clocks.now, read(dut.served)
        assert who & (who - 1) == 0
        for channel in range(bench.channels):
            if who >> channel & 1 and channel in asked:
                clock, address = asked.pop(channel)
                bank, k = divmod(address, POINTS)
                table = tables[Shape(bank + 1)]
                assert read(dut.point) == table[k]
                if k + 1 < POINTS:
                    assert read(dut.point_next) == table[k + 1]
                waits.append(now - clock)
            elif channel not in asked and who == 0 and random.random() < 0.3:
                # not on the clock after an answer: that may be a late one to the old question
                asked[channel] = (now, random.randrange(len(TABLES) * POINTS))
        dut.request.value = sum(1 << channel for channel in asked)
        dut.address.value = sum(address << 10 * channel for channel, (_, address) in asked.items())
        assert all(now - clock <= 2 * bench.channels + 4 for clock, _ in asked.values())
    assert max(waits) <= 2 * bench.channels + 4
    dut._log.info(f"{len(waits)} points, after {min(waits)} to {max(waits)} clocks")


def _random_table(random: Random) -> list[int]:
    return [random.choice((0, 65535, random.randrange(65536))) for _ in range(POINTS)]
