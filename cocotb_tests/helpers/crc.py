# SPDX-License-Identifier: MIT
"""The CRC of frames, bit by bit: independent of the codec."""

from collections.abc import Iterable

POLYNOMIAL = 0x04C11DB7


def crc_of_bytes(data: bytes, crc: int = 0xFFFFFFFF) -> int:
    """CRC-32/MPEG-2 over bytes."""
    for byte in data:
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ POLYNOMIAL if crc >> 31 else crc << 1) & 0xFFFFFFFF
    return crc


def crc_of_words(words: Iterable[int]) -> int:
    """CRC-32/MPEG-2 over 32-bit words."""
    return crc_of_bytes(b"".join(word.to_bytes(4, "big") for word in words))
