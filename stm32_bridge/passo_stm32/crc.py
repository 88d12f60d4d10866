# SPDX-License-Identifier: MIT
"""The CRC unit: CRC-32/MPEG-2 over words."""

from passo_stm32.bus import WORD, Peripheral, Register

POLYNOMIAL = 0x04C11DB7


def _byte(index: int) -> int:
    crc = index << 24
    for _ in range(8):
        crc = crc << 1 ^ POLYNOMIAL if crc >> 31 else crc << 1
        crc &= WORD
    return crc


TABLE = [_byte(index) for index in range(256)]


class Crc(Peripheral):
    """Each word written to DR updates the CRC."""

    name = "CRC"
    base = 0x40023000
    registers = (
        Register("DR", 0x00, WORD, WORD),
        Register("IDR", 0x04, 0xFF),
        Register("CR", 0x08, 1),
    )

    def write_dr(self, value: int) -> None:
        """Add a word."""
        crc = self.value["DR"] ^ value
        for _ in range(4):
            crc = (crc << 8 ^ TABLE[crc >> 24]) & WORD
        self.value["DR"] = crc

    def write_cr(self, value: int) -> None:
        """RESET restores the start value; IDR is not affected."""
        if value & 1:
            self.value["DR"] = WORD
