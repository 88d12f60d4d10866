# SPDX-License-Identifier: MIT
"""passo_scale: v_start + floor((v_end - v_start) * s), in 53 clocks."""

from itertools import product

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.bench import Clocks, Recorder, begin, read, rng
from cocotb_tests.runner import run

LATENCY = 53
HALF = 1 << 47
ONE = 1 << 24


def test_scale(simulator: str) -> None:
    run(__name__, "passo_scale", simulator=simulator)


async def scale(dut: HierarchyObject, clocks: Clocks, v_start: int, v_end: int, s: int) -> None:
    """Start once and check the result, its clock, and that it stays."""
    done = Recorder(clocks, dut.done)
    start = clocks.now
    dut.v_start.value = v_start
    dut.v_end.value = v_end
    dut.s.value = s
    dut.start.value = 1
    await clocks.wait(1)
    dut.start.value = 0
    await clocks.wait(LATENCY - 1)
    expected = v_start + ((v_end - v_start) * s >> 24)
    assert read(dut.velocity) == expected, f"{v_start=:#x} {v_end=:#x} {s=:#x}"
    await clocks.wait(2)
    assert done.clocks_where(bool, clocks.now) == [start + LATENCY]
    assert read(dut.velocity) == expected
    done.stop()


@cocotb.test()
async def the_ends_are_exact(dut: HierarchyObject) -> None:
    """s = 0 gives v_start, s = 1.0 gives v_end, for all extremes of both; what lies between is floored."""
    clocks = await begin(dut, "start", "v_start", "v_end", "s")
    velocities = (0, 1, (1 << 24) - 1, 1 << 24, HALF - 1, HALF)
    for v_start, v_end in product(velocities, velocities):
        for s in (0, 1, ONE // 2, ONE - 1, ONE):
            await scale(dut, clocks, v_start, v_end, s)


@cocotb.test()
async def random_scales_match_the_formula(dut: HierarchyObject) -> None:
    """Velocities and s of all magnitudes, rising and falling; even above 1/2."""
    random = rng("scale")
    clocks = await begin(dut, "start", "v_start", "v_end", "s")
    for _ in range(400):
        v_start, v_end = (random.randrange(1 << random.randrange(1, 49)) for _ in range(2))
        await scale(dut, clocks, v_start, v_end, random.randrange(1 << random.randrange(1, 25)))
        await clocks.wait(random.randrange(3))


@cocotb.test()
async def reset_stops_it(dut: HierarchyObject) -> None:
    """A reset at any moment: no done comes, and the next start is right."""
    clocks = await begin(dut, "start", "v_start", "v_end", "s")
    for at in range(1, LATENCY - 1, 3):
        done = Recorder(clocks, dut.done)
        dut.start.value = 1
        await clocks.wait(1)
        dut.start.value = 0
        await clocks.wait(at)
        dut.rst.value = 1
        await clocks.wait(1)
        dut.rst.value = 0
        await clocks.wait(60)
        assert not done.clocks_where(bool, clocks.now)
        done.stop()
        await scale(dut, clocks, 12345, HALF - at, ONE // 3)
