# SPDX-License-Identifier: MIT
"""passo_axis_registers: selection of the axis, writes and reads."""

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import begin, rng
from cocotb_tests.helpers.runner import run

AXES = 8
PINS, STEP_TIMING, DIR_TIMING, LOST_STEPS, ENABLE = range(5)
WRITABLE = {
    PINS: "write_pins",
    STEP_TIMING: "write_step_timing",
    DIR_TIMING: "write_dir_timing",
    ENABLE: "write_enable",
}
INPUTS = (
    "bus_write", "bus_read", "select_axis", "select_position", "bus_address", "bus_data", "lost",
)  # fmt: skip


def test_axis_registers(simulator: str) -> None:
    run(__name__, "passo_axis_registers", {"AXES": AXES}, simulator)


def choose(dut: HierarchyObject, place: tuple[str, int, int]) -> None:
    """Address a register: `place` is the block's input, its axis, the address in it."""
    block, axis, address = place
    dut.select_axis.value = 1 << axis if block == "select_axis" else 0
    dut.select_position.value = block == "select_position"
    dut.bus_address.value = address


async def strobe(
    dut: HierarchyObject, clocks: Clocks, name: str, place: tuple[str, int, int], data: int = 0
) -> None:
    """Access a register."""
    choose(dut, place)
    dut.bus_data.value = data
    await clocks.wait(1)
    getattr(dut, name).value = 1
    await clocks.wait(1)
    getattr(dut, name).value = 0


def places() -> list[tuple[str, int, int]]:
    """All registers and holes of all axes, and an address outside."""
    found = [("select_axis", axis, address) for axis in range(AXES) for address in range(8)]
    found += [("select_position", axis, axis) for axis in range(AXES)]
    return [*found, ("nobody", 0, PINS), ("nobody", 0, LOST_STEPS)]


@cocotb.test()
async def every_read_has_its_answer(dut: HierarchyObject) -> None:
    """The lost steps of the addressed axis, all bits; whether the response is a position."""
    random = rng("axis registers, reads")
    clocks = await begin(dut, *INPUTS)
    for _ in range(4):
        lost = random.getrandbits(4 * AXES)
        dut.lost.value = lost
        for place in places():
            block, axis, address = place
            await strobe(dut, clocks, "bus_read", place)
            is_lost = block == "select_axis" and address == LOST_STEPS
            position = block == "select_position"
            assert read(dut.read_data) == (lost >> 4 * axis & 0xF if is_lost else 0), place
            assert read(dut.answers_position) == position
            await clocks.wait(1)
            assert (read(dut.read_data), read(dut.answers_position)) == (0, 0)


@cocotb.test()
async def every_write_reaches_its_axis(dut: HierarchyObject) -> None:
    """A strobe for the addressed axis and register; which halves of the data are 0 or 1."""
    random = rng("axis registers, writes")
    clocks = await begin(dut, *INPUTS)
    for place in places() * 2:
        block, axis, address = place
        halves = [random.choice((0, 1, 2, 1 << random.randrange(16))) for _ in range(2)]
        choose(dut, place)
        dut.bus_data.value = halves[0] << 16 | halves[1]
        for level in (0, 1):
            dut.bus_write.value = level
            await clocks.wait(1)
            for register, name in WRITABLE.items():
                meant = level and block == "select_axis" and address == register
                assert read(getattr(dut, name)) == (1 << axis if meant else 0), place
            if level:
                assert (read(dut.timing_place) & 1, read(dut.timing)) == (1, max(1, halves[0]))
                assert read(dut.timing_is_minimal) == (halves[0] < 2)
                dut.bus_write.value = 0
                await clocks.wait(1)
                step = address == STEP_TIMING
                assert (read(dut.timing_place), read(dut.timing)) == (2 if step else 0, max(1, halves[1]))
                assert read(dut.timing_is_minimal) == (halves[1] < 2)
