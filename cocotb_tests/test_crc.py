# SPDX-License-Identifier: MIT
"""passo_crc: CRC-32/MPEG-2 over words, one bit per clock."""

from collections.abc import Iterable
from random import Random

import cocotb
from cocotb.handle import HierarchyObject
from passo.cocotb.clocks import Clocks, read

from cocotb_tests.helpers.bench import begin, rng
from cocotb_tests.helpers.crc import crc_of_bytes, crc_of_words
from cocotb_tests.helpers.runner import run


def test_crc(simulator: str) -> None:
    run(__name__, "passo_crc", simulator=simulator)


async def restart(dut: HierarchyObject, clocks: Clocks) -> None:
    """Begin a new CRC."""
    dut.restart.value = 1
    await clocks.wait(1)
    dut.restart.value = 0


async def add(dut: HierarchyObject, clocks: Clocks, words: Iterable[int], pause: int = 0) -> None:
    """Add words, with `pause` clocks before each bit."""
    for word in words:
        for bit in range(31, -1, -1):
            if pause:
                dut.shift.value = 0
                dut.data.value = ~word >> bit & 1
                await clocks.wait(pause)
            dut.shift.value = 1
            dut.data.value = word >> bit & 1
            await clocks.wait(1)
    dut.shift.value = 0


async def rotate(dut: HierarchyObject, clocks: Clocks, random: Random) -> int:
    """Return the CRC as 32 clocks of `rotate` show it; `data` does not matter meanwhile."""
    crc = 0
    dut.rotate.value = 1
    dut.shift.value = 1
    for _ in range(32):
        crc = crc << 1 | read(dut.top)
        dut.data.value = random.randrange(2)
        await clocks.wait(1)
    dut.rotate.value = 0
    dut.shift.value = 0
    return crc


@cocotb.test()
async def known_values_come_out(dut: HierarchyObject) -> None:
    """Results of the CRC unit of an STM32, and the catalog check value for the reference."""
    random = rng("crc, known")
    assert crc_of_bytes(b"123456789") == 0x0376E6E7
    clocks = await begin(dut, "restart", "shift", "rotate", "data")
    for words, expected in (
        ([], 0xFFFFFFFF),
        ([0x00000000], 0xC704DD7B),
        ([0xFFFFFFFF], 0x00000000),
        ([0x12345678], 0xDF8A8A2B),
        ([0x31323334, 0x35363738], crc_of_bytes(b"12345678")),
    ):
        await restart(dut, clocks)
        await add(dut, clocks, words)
        assert await rotate(dut, clocks, random) == expected == crc_of_words(words)


@cocotb.test()
async def it_goes_on_after_it_was_shown(dut: HierarchyObject) -> None:
    """Any words with any pauses; shifting the CRC out does not change it."""
    random = rng("crc")
    clocks = await begin(dut, "restart", "shift", "rotate", "data")
    for _ in range(30):
        await restart(dut, clocks)
        words: list[int] = []
        for _ in range(random.randrange(1, 6)):
            words.append(random.randrange(1 << 32))
            await add(dut, clocks, words[-1:], pause=random.randrange(3))
            assert await rotate(dut, clocks, random) == crc_of_words(words)


@cocotb.test()
async def restart_wins_over_a_shift(dut: HierarchyObject) -> None:
    """A restart within a word, or together with a bit, discards everything before."""
    random = rng("crc, restart")
    clocks = await begin(dut, "restart", "shift", "rotate", "data")
    for at in range(32):
        for _ in range(at):
            dut.shift.value = 1
            dut.data.value = random.randrange(2)
            await clocks.wait(1)
        dut.shift.value = at % 2
        dut.rotate.value = at % 3 == 0
        await restart(dut, clocks)
        dut.rotate.value = 0
        await add(dut, clocks, [0x12345678])
        assert await rotate(dut, clocks, random) == 0xDF8A8A2B
