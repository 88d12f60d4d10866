# SPDX-License-Identifier: MIT
"""passo_crc: CRC-32/MPEG-2 over words, one bit per clock."""

from collections.abc import Iterable

import cocotb
from cocotb.handle import HierarchyObject

from cocotb_tests.bench import Clocks, begin, read, rng
from cocotb_tests.runner import run
from cocotb_tests.spi import crc_of_bytes, crc_of_words


def test_crc(simulator: str) -> None:
    run(__name__, "passo_crc", simulator=simulator)


async def restart(dut: HierarchyObject, clocks: Clocks) -> None:
    """Begin a new CRC."""
    dut.restart.value = 1
    await clocks.wait(1)
    dut.restart.value = 0


async def add(dut: HierarchyObject, clocks: Clocks, words: Iterable[int], pause: int = 0) -> int:
    """Add words and return the CRC; checks that busy lasts 32 clocks."""
    for word in words:
        dut.word.value = word
        dut.start.value = 1
        await clocks.wait(1)
        dut.start.value = 0
        dut.word.value = 0
        for _ in range(32):
            assert read(dut.busy) == 1
            await clocks.wait(1)
        assert read(dut.busy) == 0
        await clocks.wait(pause)
    return read(dut.crc)


@cocotb.test()
async def known_values_come_out(dut: HierarchyObject) -> None:
    """What the CRC unit of an STM32 gives, and the check value of the catalogue for the reference."""
    assert crc_of_bytes(b"123456789") == 0x0376E6E7
    clocks = await begin(dut, "restart", "start", "word")
    for words, expected in (
        ([0x00000000], 0xC704DD7B),
        ([0xFFFFFFFF], 0x00000000),
        ([0x12345678], 0xDF8A8A2B),
        ([0x31323334, 0x35363738], crc_of_bytes(b"12345678")),
    ):
        await restart(dut, clocks)
        assert read(dut.crc) == 0xFFFFFFFF
        assert await add(dut, clocks, words) == expected
        assert crc_of_words(words) == expected


@cocotb.test()
async def a_word_equal_to_the_crc_leads_to_zero(dut: HierarchyObject) -> None:
    """How a frame with its CRC at the end is recognised; restart may come together with start."""
    random = rng("crc")
    clocks = await begin(dut, "restart", "start", "word")
    for _ in range(30):
        words = [random.randrange(1 << 32) for _ in range(random.randrange(1, 8))]
        dut.restart.value = 1
        dut.word.value = words[0]
        dut.start.value = 1
        await clocks.wait(1)
        dut.restart.value = 0
        dut.start.value = 0
        await clocks.wait(32)
        crc = await add(dut, clocks, words[1:], pause=random.randrange(3))
        assert crc == crc_of_words(words)
        assert await add(dut, clocks, [crc]) == 0


@cocotb.test()
async def restart_ends_a_shift(dut: HierarchyObject) -> None:
    """A restart in the middle of a word, the next word any time later: as if the first had never been."""
    clocks = await begin(dut, "restart", "start", "word")
    for at in range(0, 34):
        dut.word.value = 0xDEADBEEF
        dut.start.value = 1
        await clocks.wait(1)
        dut.start.value = 0
        await clocks.wait(at)
        await restart(dut, clocks)
        await clocks.wait(at % 5)
        assert read(dut.crc) == 0xFFFFFFFF
        assert await add(dut, clocks, [0x12345678]) == 0xDF8A8A2B


@cocotb.test()
async def restart_wins_over_a_shift(dut: HierarchyObject) -> None:
    """A restart and a new start in the middle of a word: as if the word had never been."""
    clocks = await begin(dut, "restart", "start", "word")
    for at in range(0, 34, 3):
        dut.word.value = 0xDEADBEEF
        dut.start.value = 1
        await clocks.wait(1)
        dut.start.value = 0
        await clocks.wait(at)
        dut.restart.value = 1
        dut.word.value = 0x12345678
        dut.start.value = 1
        await clocks.wait(1)
        dut.restart.value = 0
        dut.start.value = 0
        await clocks.wait(32)
        assert (read(dut.busy), read(dut.crc)) == (0, 0xDF8A8A2B)
