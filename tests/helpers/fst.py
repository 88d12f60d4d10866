# SPDX-License-Identifier: MIT
"""Reader of what the tests need of an FST file: its time range and the names of its signals."""

import gzip
from dataclasses import dataclass
from pathlib import Path

HEADER, HIERARCHY_GZIP, HIERARCHY_LZ4 = 0, 4, 6
SCOPE, UPSCOPE, ATTRIBUTE, ATTRIBUTE_END = 254, 255, 252, 253


@dataclass
class Fst:
    """Times are in units of 10^exponent s; names have the range of a vector."""

    begin: int
    end: int
    exponent: int
    names: set[str]


def read_fst(path: Path) -> Fst:
    """Read it."""
    data, at, times, names = path.read_bytes(), 0, (0, 0, 0), None
    while at < len(data):
        kind, length = data[at], int.from_bytes(data[at + 1 : at + 9], "big")
        body = data[at + 9 : at + 1 + length]
        if kind == HEADER:
            exponent = int.from_bytes(body[64:65], "big", signed=True)
            times = (int.from_bytes(body[:8], "big"), int.from_bytes(body[8:16], "big"), exponent)
        elif kind == HIERARCHY_GZIP:
            names = _names(gzip.decompress(body[8:]))
        elif kind == HIERARCHY_LZ4:
            names = _names(_lz4(body[8:]))
        at += 1 + length
    assert names is not None
    return Fst(*times, names)


def _lz4(data: bytes) -> bytes:
    """A block of LZ4."""
    made, at = bytearray(), 0

    def more(length: int) -> int:
        nonlocal at
        while length >= 15:
            length += data[at]
            at += 1
            if data[at - 1] != 255:
                break
        return length

    while at < len(data):
        token = data[at]
        at += 1
        length = more(token >> 4)
        made += data[at : at + length]
        at += length
        if at == len(data):
            break
        back = int.from_bytes(data[at : at + 2], "little")
        at += 2
        for _ in range(more(token & 15) + 4):
            made.append(made[-back])
    return bytes(made)


def _names(data: bytes) -> set[str]:
    scopes: list[str] = []
    found, at = set(), 0

    def text() -> str:
        nonlocal at
        end = data.index(0, at)
        word, at = data[at:end].decode(), end + 1
        return word

    def number() -> int:
        nonlocal at
        value = shift = 0
        while True:
            value |= (data[at] & 127) << shift
            shift += 7
            at += 1
            if data[at - 1] < 128:
                return value

    while at < len(data):
        tag = data[at]
        at += 1
        if tag == SCOPE:
            at += 1
            scopes.append(text())
            text()
        elif tag == UPSCOPE:
            scopes.pop()
        elif tag == ATTRIBUTE:
            at += 2
            text()
            number()
        elif tag != ATTRIBUTE_END:  # a signal
            at += 1
            found.add(".".join([*scopes, text().replace(" [", "[")]))
            number()
            number()
    return found
