# SPDX-License-Identifier: MIT
"""Unusual frames, and the state of the core as seen through frames."""

from collections.abc import Sequence

from passo import frame
from passo import registers as r
from passo.link import RefusedError
from passo.registers import Operation, Verdict

from cocotb_tests.helpers.core_bench import Core, CoreChannel

GAP = 64
COUNTED = [verdict for verdict in Verdict if verdict not in (Verdict.OK, Verdict.DUPLICATE)]


def request(
    operation: int, sequence: int, length: int, address: int, payload: Sequence[int] = ()
) -> list[int]:
    """A frame with a valid CRC and any header, with the length in its header."""
    header = operation << 28 | sequence << 20 | length << 12 | address
    words = [header, *payload]
    if operation == Operation.READ:
        return [header, frame.crc([header]), 0, *[0] * length, 0]
    return [*words, frame.crc(words), 0, 0]


def ack(words: Sequence[int]) -> tuple[int, Verdict]:
    """Sequence and verdict of an acknowledgement, which is checked."""
    word = words[-1]
    assert word >> 16 ^ word & 0xFFFF == 0xFFFF, hex(word)
    return word >> 24, Verdict(word >> 16 & 0xFF)


def verdict(channel: CoreChannel, address: int, *words: int, push: bool = False) -> Verdict:
    """Of a write or push to a register of the channel."""
    try:
        if push:
            channel.link.push(channel.base + address, words)
        else:
            channel.link.write(channel.base + address, *words)
    except RefusedError as error:
        return error.verdict
    return Verdict.OK


def refusals(core: Core) -> dict[Verdict, int]:
    """The counters."""
    words = core.link.read(r.ADDRESS_REFUSALS_0, 2)
    counts = [word >> shift & 0xFF for word in words for shift in (0, 8, 16, 24)]
    return dict(zip(COUNTED, counts, strict=True))


def everything(core: Core) -> list[list[int]]:
    """All readable registers of the core except the refusal counters."""
    channel = r.ADDRESS_CHANNEL_BASE
    axis = channel + r.CHANNEL_AXIS_BASE
    places = [
        (r.ADDRESS_IDENTIFICATION, 4),
        (channel + r.CHANNEL_STATE, 4),
        (channel + r.CHANNEL_POSITION_BASE, core.axes),
        *((axis + i * r.CHANNEL_AXIS_STRIDE + r.AXIS_LOST_STEPS, 1) for i in range(core.axes)),
    ]
    return [core.link.read(address, length) for address, length in places]


def frames(core: Core) -> tuple[int, int, int, int]:
    """Addresses of channel 0: the channel, its line queue, its ramp queue, its first axis."""
    channel = r.ADDRESS_CHANNEL_BASE
    return channel, channel + r.CHANNEL_LINE, channel + r.CHANNEL_RAMP, channel + r.CHANNEL_AXIS_BASE
