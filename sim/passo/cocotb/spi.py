# SPDX-License-Identifier: MIT
"""SPI master for the pins of the core; passo.frame encodes the frames and decodes the replies.

spi = SpiMaster(dut, half_period=27_778)
mosi = frame.read_frame(1, ADDRESS_PARAMETERS, 1)
miso = await spi.transfer(mosi)
assert frame.read_verdict(mosi, miso) == Verdict.OK
"""

from collections.abc import Sequence

from cocotb.handle import HierarchyObject
from cocotb.triggers import Timer

from passo.cocotb.clocks import read


class SpiMaster:
    """SPI master, mode 0, MSB first, 32-bit words, one frame per chip select.

    Drives `spi_sclk`, `spi_mosi` and `spi_cs_n` of a dut without regard to its clock, and samples `spi_miso`
    just before each rising edge. All times are in ps. `high` makes SCLK asymmetric: it is the high time, and
    what is left of two half periods is the low time. `lead` is from chip select to the first rising edge,
    `trail` from the last falling edge to chip select, `gap` from one frame to the next.
    """

    def __init__(
        self,
        dut: HierarchyObject,
        half_period: int,
        *,
        high: int | None = None,
        lead: int | None = None,
        trail: int | None = None,
        gap: int | None = None,
    ) -> None:
        self.dut = dut
        self.period = 2 * half_period
        self.high = half_period if high is None else high
        self.lead = 4 * half_period if lead is None else lead
        self.trail = 2 * half_period if trail is None else trail
        self.gap = 8 * half_period if gap is None else gap
        dut.spi_sclk.value = 0
        dut.spi_mosi.value = 0
        dut.spi_cs_n.value = 1

    async def transfer(self, words: Sequence[int]) -> list[int]:
        """One frame; return the words received."""
        bits = await self.transfer_bits(words, 32 * len(words))
        return [int("".join(map(str, bits[n : n + 32])), 2) for n in range(0, len(bits), 32)]

    async def transfer_bits(self, words: Sequence[int], count: int, *, cut_high: bool = False) -> list[int]:
        """One frame that ends after `count` bits; return the bits received.

        With `cut_high` chip select rises while SCLK is still high in the last bit.
        """
        sclk, mosi, miso, cs_n = self.dut.spi_sclk, self.dut.spi_mosi, self.dut.spi_miso, self.dut.spi_cs_n
        low, high = Timer(self.period - self.high, "step"), Timer(self.high, "step")
        received: list[int] = []
        cs_n.value = 0
        wait, level = Timer(self.lead, "step"), None
        for n in range(count):
            bit = words[n // 32] >> (31 - n % 32) & 1
            if bit != level:
                mosi.value = level = bit
            await wait
            wait = low
            received.append(read(miso))
            sclk.value = 1
            await high
            if not (cut_high and n == count - 1):
                sclk.value = 0
        await Timer(self.trail, "step")
        cs_n.value = 1
        await high
        sclk.value = 0
        await Timer(self.gap, "step")
        return received

    async def clock_others(self, bits: int) -> None:
        """SCLK and MOSI move for another slave: chip select stays high."""
        half = Timer(self.period // 2, "step")
        for n in range(bits):
            self.dut.spi_mosi.value = n & 1
            await half
            self.dut.spi_sclk.value = 1
            await half
            self.dut.spi_sclk.value = 0
        await Timer(self.gap, "step")
