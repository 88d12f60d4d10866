# SPDX-License-Identifier: MIT
"""passo_shape and passo_tables: shapes against their formula, the tables' bus and their service."""

from random import Random

import cocotb
import pytest
from cocotb.handle import HierarchyObject

from cocotb_tests.bench import Clocks, Recorder, begin, read, rng
from cocotb_tests.runner import run
from cocotb_tests.shapes import ONE, POINTS, Shape, evaluate, loaded_table

TABLES = [shape for shape in Shape if shape != Shape.LINEAR]
INPUTS = ("start", "progress", "shape", "mirror", "request", "address")
BUS_INPUTS = (
    "bus_check",
    "bus_write",
    "bus_read",
    "bus_push",
    "select",
    "bus_address",
    "bus_data",
    "occupied",
)
BAD_OPERATION, BUSY, BAD_VALUE = 4, 8, 9

# Only loading the FPGA sets the tables, reset does not: tests that need them fresh come first.

# u in units of 2^-48, where rounding and mirror change over, between points, and at ties of odd differences
U_ONE = 1 << 48
U_POINT = U_ONE // POINTS
EDGES = [0, 1, (1 << 23) - 1, 1 << 23, (1 << 24) - 1, U_ONE - (1 << 23) - 1, U_ONE - (1 << 23), U_ONE - 1]
for _k in (1, 2, 41, 127, 128, 129, 200, 254, 255):
    EDGES += [_k * U_POINT + offset for offset in (-(1 << 24), -1, 0, 1 << 23, 128 << 24)]


@pytest.mark.parametrize("channels", [1, 8])
def test_shape(simulator: str, channels: int) -> None:
    run(__name__, "passo_shape_top", {"CHANNELS": channels}, simulator)


class Bench:
    """The modules under test."""

    def __init__(self, dut: HierarchyObject, clocks: Clocks) -> None:
        self.dut, self.clocks = dut, clocks
        self.channels = len(dut.served)
        self.done = Recorder(clocks, dut.done)
        self.tables: dict[Shape, list[int] | None] = {Shape.LINEAR: None}
        self.waits: list[int] = []

    @classmethod
    async def begin(cls, dut: HierarchyObject) -> "Bench":
        """Reset."""
        return cls(dut, await begin(dut, *INPUTS, *BUS_INPUTS))

    async def evaluate(self, progress: int, shape: Shape, mirror: bool) -> int:
        """Start, and return s; checks that it takes the time it is to take and stays."""
        dut, start = self.dut, self.clocks.now
        dut.progress.value = progress >> 23
        dut.shape.value = shape
        dut.mirror.value = mirror
        dut.start.value = 1
        await self.clocks.fall
        dut.start.value = 0
        asked = served = None
        while not read(dut.done):
            if asked is None and read(dut.shape_request):
                asked = self.clocks.now
            if served is None and read(dut.served) >> (self.channels - 1) & 1:
                served = self.clocks.now
            assert self.clocks.now < start + 100, "never done"
            await self.clocks.fall
        took = self.clocks.now - start
        if asked is None:
            assert took == 3
        else:
            self.waits.append(served - asked)
            assert took <= 21 + 2 * self.channels + 3
        result = read(dut.s)
        await self.clocks.wait(1 + progress % 3)
        assert read(dut.done) == 0 and read(dut.s) == result
        return result

    async def write_table(self, shape: Shape, points: list[int]) -> None:
        """Write a whole table, word by word like the link; point 256 stays 1.0."""
        self.tables[shape] = [*points, 1 << 16]
        dut = self.dut
        dut.select.value = 1
        for k, point in enumerate(points):
            dut.bus_address.value = shape << 8 | k
            dut.bus_data.value = point
            dut.bus_write.value = 1
            await self.clocks.wait(1)
            dut.bus_write.value = 0
            await self.clocks.wait(1)
        dut.select.value = 0

    async def check_shape(self, shape: Shape, random: Random, count: int) -> None:
        """Compare s with the formula at the edges and at random points, mirrored and not."""
        for progress in [*EDGES, *(random.randrange(U_ONE) for _ in range(count))]:
            for mirror in (False, True):
                s = await self.evaluate(progress, shape, mirror)
                expected = evaluate(progress, self.tables[shape], mirror and shape != Shape.LINEAR)
                assert s == expected, f"{shape.name}, u = {progress:#014x} * 2^-48, {mirror=}"


@cocotb.test()
@cocotb.parametrize(shape=list(Shape))
async def every_shape_follows_its_formula(dut: HierarchyObject, shape: Shape) -> None:
    """Tables as loaded, both ends exact: 0 at u = 0, 1.0 at u = 1."""
    bench = await Bench.begin(dut)
    if shape != Shape.LINEAR:
        bench.tables[shape] = loaded_table(shape)
    for mirror in (False, True):
        assert await bench.evaluate(0, shape, mirror) == 0
        assert await bench.evaluate(U_ONE - 1, shape, mirror) == ONE
    await bench.check_shape(shape, rng(f"shape, {shape.name}"), 150)


@cocotb.test()
@cocotb.parametrize(shape=TABLES)
async def all_points_are_right_after_loading(dut: HierarchyObject, shape: Shape) -> None:
    """Every point of the table, and the middle between it and the next one."""
    bench = await Bench.begin(dut)
    bench.tables[shape] = table = loaded_table(shape)
    for k in range(POINTS):
        assert await bench.evaluate(k << 40, shape, False) == table[k] << 8
        half = await bench.evaluate(k << 40 | 1 << 39, shape, False)
        assert half == (table[k] + table[k + 1]) << 7


@cocotb.test()
async def cosine_and_sigmoid_are_odd_symmetric_to_the_bit(dut: HierarchyObject) -> None:
    """shape(u) + shape(1 - u) = 1, rounding included; that makes such a ramp cover the mean of its ends."""
    bench = await Bench.begin(dut)
    random = rng("shape, symmetry")
    for shape in (Shape.COSINE, Shape.SIGMOID):
        for k in range(0, POINTS, 5):
            low = await bench.evaluate(k << 40, shape, False)
            high = await bench.evaluate((POINTS - k << 40) - 1, shape, False)
            assert low + high == ONE
        # the second ones are ties where the table rises by an odd number
        for x in [random.randrange(1, ONE) for _ in range(100)] + [
            k << 16 | 128 for k in range(0, POINTS, 3)
        ]:
            pair = [await bench.evaluate(at << 24, shape, False) for at in (x, ONE - x)]
            assert sum(pair) == ONE


@cocotb.test()
async def rewritten_tables_may_rise_and_fall(dut: HierarchyObject) -> None:
    """Any points: between the steepest rise and the steepest fall the interpolation stays exact."""
    bench = await Bench.begin(dut)
    random = rng("shape, tables")
    for shape in TABLES:
        await bench.write_table(
            shape, [random.choice((0, 65535, random.randrange(65536))) for _ in range(POINTS)]
        )
    for shape in TABLES:
        await bench.check_shape(shape, random, 150)


@cocotb.test()
async def the_tables_bus_refuses_what_it_must(dut: HierarchyObject) -> None:
    """Refusals come one clock after the strobe; a check changes nothing."""
    bench = await Bench.begin(dut)
    await bench.write_table(Shape.COSINE, [3 * k for k in range(POINTS)])
    await bench.write_table(Shape.EASE, [5 * k for k in range(POINTS)])
    cases = [
        # strobe, occupied, push, data, expected
        ("bus_check", 0, 0, 0x1234, 0),
        ("bus_check", 0, 0, 0xFFFF, 0),
        ("bus_check", 0, 0, 0x10000, BAD_VALUE),
        ("bus_check", 0, 0, 0x80000000, BAD_VALUE),
        ("bus_check", 1, 0, 0x1234, BUSY),
        ("bus_check", 0, 1, 0x1234, BAD_OPERATION),
        ("bus_read", 0, 0, 0x1234, BAD_OPERATION),
    ]
    for strobe, occupied, push, data, expected in cases:
        for address in (0x100, 0x1FF, 0x300):
            for selected in (1, 0):
                dut.select.value = selected
                dut.bus_address.value = address
                dut.bus_data.value = data
                dut.occupied.value = occupied
                dut.bus_push.value = push
                getattr(dut, strobe).value = 1
                await bench.clocks.wait(1)
                getattr(dut, strobe).value = 0
                assert read(dut.refusal) == (expected if selected else 0), (strobe, occupied, push, hex(data))
                await bench.clocks.wait(1)
                assert read(dut.refusal) == 0
    for shape in (Shape.COSINE, Shape.EASE):
        for k in range(0, POINTS, 17):
            assert await bench.evaluate(k << 40, shape, False) == bench.tables[shape][k] << 8


@cocotb.test()
async def every_channel_is_served_in_time_with_its_own_points(dut: HierarchyObject) -> None:
    """All channels ask at random: each gets its point and the one after it within 2 * CHANNELS + 3 clocks."""
    bench = await Bench.begin(dut)
    random = rng("tables, channels")
    others = bench.channels - 1
    tables = {shape: [random.randrange(65536) for _ in range(POINTS)] for shape in TABLES}
    for shape in TABLES:
        await bench.write_table(shape, tables[shape])
    asked: dict[int, tuple[int, int]] = {}  # channel: clock, address
    served = 0

    async def serve() -> None:
        nonlocal served
        while True:
            await bench.clocks.fall
            now, who = bench.clocks.now, read(dut.served)
            assert who & (who - 1) == 0
            for channel in range(others):
                if who >> channel & 1 and channel in asked:
                    clock, address = asked.pop(channel)
                    bank, k = divmod(address, POINTS)
                    table = tables[Shape(bank + 1)]
                    assert read(dut.point) == table[k]
                    if k + 1 < POINTS:
                        assert read(dut.point_next) == table[k + 1]
                    assert now - clock <= 2 * bench.channels + 3
                    served += 1
                elif channel not in asked and who == 0 and random.random() < 0.3:
                    # not on the clock after an answer: that may be a late one to the old question
                    asked[channel] = (now, random.randrange(768))
            dut.request.value = sum(1 << channel for channel in asked)
            dut.address.value = sum(address << 10 * channel for channel, (_, address) in asked.items())
            assert all(now - clock <= 2 * bench.channels + 3 for clock, _ in asked.values())

    cocotb.start_soon(serve())
    for shape in TABLES:
        await bench.check_shape(shape, random, 100)
    assert max(bench.waits) <= 2 * bench.channels + 3
    dut._log.info(
        f"{served} points for other channels; the shape waited {min(bench.waits)} to {max(bench.waits)}"
    )
