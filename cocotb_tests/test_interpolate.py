# SPDX-License-Identifier: MIT
"""passo_interpolate: a + floor((b - a) * f), for velocities, and for the points of a table before it."""

from itertools import product

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.runner import run
from cocotb_tests.helpers.shapes import ONE, POINTS, PROGRESS_ONE, Shape, evaluate, loaded_table

HALF = 1 << 47
VELOCITY_BITS, POINT_BITS, PIPELINE = 48, 17, 2
INPUTS = (
    "clear", "result_move", "moving", "shaping", "load_fraction", "linear", "progress", "load_points",
    "point", "point_next", "point_is_last", "a_bit", "b_bit",
)  # fmt: skip

# u in units of 2^-49: its ends, between two points, and where its fraction rounds up to the next point
U_POINT = PROGRESS_ONE // POINTS
EDGES = [0, 1, (1 << 24) - 1, 1 << 24]
EDGES += [PROGRESS_ONE - offset for offset in (1 << 24, (1 << 16) + 1, 1)]
for _k in (1, 2, 41, 127, 128, 129, 200, 254, 255):
    EDGES += [_k * U_POINT + offset for offset in (-(1 << 25), -1, 0, 1 << 16, U_POINT // 2)]


def test_interpolate(simulator: str) -> None:
    run(__name__, "passo_interpolate", simulator=simulator)


class Bench:
    """The module under test, driven as the ramp does."""

    def __init__(self, dut: HierarchyObject) -> None:
        self.dut, self.clocks = dut, Clocks(dut.clk)
        for name in INPUTS:
            getattr(dut, name).value = 0
        self.clocks.start()

    @classmethod
    async def begin(cls, dut: HierarchyObject) -> "Bench":
        """A few clocks at rest, instead of a reset."""
        bench = cls(dut)
        await bench.clocks.wait(3)
        return bench

    async def clock(self, **inputs: int) -> None:
        """One clock with these inputs, all others 0."""
        for name in INPUTS:
            getattr(self.dut, name).value = inputs.get(name, 0)
        await self.clocks.fall

    async def shape(self, progress: int, table: list[int]) -> None:
        """Interpolate between the points of a table beside a progress (UQ0.49)."""
        k = progress // U_POINT
        seen = {"result_move": 1, "moving": 1, "shaping": 1, "progress": progress >> 16}
        # what follows the last point means nothing
        point_next = table[k + 1] if k < POINTS - 1 else 0xA5A5
        points = {"point": table[k], "point_next": point_next, "point_is_last": k == POINTS - 1}
        await self.clock(clear=1, result_move=1, load_points=1, **points)
        for _ in range(POINT_BITS + PIPELINE):
            await self.clock(**seen)

    async def scale(self, a: int, b: int, fraction: int | None = None) -> int:
        """Interpolate by F and r (25 bits), or None: by what the points gave."""
        given = {"linear": fraction is not None, "progress": (fraction or 0) << 8}
        for bit in range(VELOCITY_BITS):
            first = {"clear": 1, "load_fraction": 1, **given} if bit == 0 else {}
            await self.clock(result_move=1, moving=1, a_bit=a >> bit & 1, b_bit=b >> bit & 1, **first)
        for _ in range(PIPELINE):
            await self.clock(result_move=1, moving=1)
        return read(self.dut.result)

    async def check_scale(self, a: int, b: int, fraction: int) -> None:
        """Compare with the formula; the result stays while nothing is moved."""
        expected = a + ((b - a) * ((fraction + 1) >> 1) >> 24)
        for result in (await self.scale(a, b, fraction), read(self.dut.result)):
            assert result == expected, f"{a=:#x} {b=:#x} {fraction=:#x}"
            await self.clock()

    async def check_shape(self, progress: int, table: list[int]) -> None:
        """Compare s with its formula, by the velocity that lies there between 0 and 1/2."""
        await self.shape(progress, table)
        s = await self.scale(0, HALF) >> 23
        assert s == evaluate(progress, table), f"u = {progress:#x} * 2^-49"


@cocotb.test()
async def the_ends_are_exact(dut: HierarchyObject) -> None:
    """f = 0 gives a, f = 1.0 gives b, for all extremes of both; what lies between is floored."""
    bench = await Bench.begin(dut)
    velocities = (0, 1, (1 << 24) - 1, 1 << 24, HALF - 1, HALF)
    for a, b in product(velocities, velocities):
        for fraction in (0, 1, 2, ONE, 2 * ONE - 2, 2 * ONE - 1):
            await bench.check_scale(a, b, fraction)


@cocotb.test()
async def random_velocities_match_the_formula(dut: HierarchyObject) -> None:
    """Velocities and fractions of all magnitudes, rising and falling; even above 1/2."""
    random = rng("interpolate")
    bench = await Bench.begin(dut)
    for _ in range(300):
        a, b = (random.randrange(1 << random.randrange(1, 49)) for _ in range(2))
        await bench.check_scale(a, b, random.randrange(1 << random.randrange(1, 26)))


@cocotb.test()
@cocotb.parametrize(shape=[shape for shape in Shape if shape != Shape.LINEAR])
async def every_shape_follows_its_formula(dut: HierarchyObject, shape: Shape) -> None:
    """Tables as loaded; 0 at u = 0, 1.0 at the end of u."""
    bench = await Bench.begin(dut)
    random = rng(f"shape, {shape.name}")
    table = loaded_table(shape)
    assert evaluate(0, table) == 0 and evaluate(PROGRESS_ONE - 1, table) == ONE
    for progress in [*EDGES, *(random.randrange(PROGRESS_ONE) for _ in range(60))]:
        await bench.check_shape(progress, table)


@cocotb.test()
async def tables_may_rise_and_fall(dut: HierarchyObject) -> None:
    """Any points: between the steepest rise and the steepest fall the interpolation stays exact."""
    bench = await Bench.begin(dut)
    random = rng("shape, tables")
    table = [*(random.choice((0, 65535, random.randrange(65536))) for _ in range(POINTS)), 65536]
    for progress in [*EDGES, *(random.randrange(PROGRESS_ONE) for _ in range(150))]:
        await bench.check_shape(progress, table)


@cocotb.test()
async def what_the_points_gave_counts_for_any_velocities(dut: HierarchyObject) -> None:
    """Both uses one after the other; at the end of the last table step exactly b."""
    bench = await Bench.begin(dut)
    random = rng("shape and scale")
    table = loaded_table(Shape.COSINE)
    for progress in [PROGRESS_ONE - 1, *(random.randrange(PROGRESS_ONE) for _ in range(60))]:
        a, b = (random.randrange(HALF + 1) for _ in range(2))
        await bench.shape(progress, table)
        s = evaluate(progress, table)
        assert await bench.scale(a, b) == a + ((b - a) * s >> 24)
        assert s != ONE or read(dut.result) == b
