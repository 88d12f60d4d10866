# SPDX-License-Identifier: MIT
"""The frame codec (protocol/passo_frame.h) for Python."""

from collections.abc import Sequence
from typing import Any

from passo.native import ffi, planner
from passo.registers import Verdict

PAYLOAD_MAX = 60
OVERHEAD = 4
DATA = 3
CRC_START = 0xFFFFFFFF


class FrameError(Exception):
    """The reply does not tell what became of the frame."""


class NoAnswerError(FrameError):
    """MISO never moved."""


class NoAckError(FrameError):
    """The core sent its status in place of the ack."""


class DamagedReplyError(FrameError):
    """The ack or the data do not agree with their check."""


class WrongSequenceError(FrameError):
    """The ack belongs to another frame."""


def crc(words: Sequence[int], start: int = CRC_START) -> int:
    """CRC-32/MPEG-2 over words."""
    return planner().passo_crc(start, list(words), len(words))


def write_frame(sequence: int, address: int, words: Sequence[int]) -> list[int]:
    """A frame that writes consecutive registers."""
    return _build(planner().passo_frame_write, sequence, address, list(words), len(words))


def push_frame(sequence: int, address: int, words: Sequence[int]) -> list[int]:
    """A frame that writes all words to one register."""
    return _build(planner().passo_frame_push, sequence, address, list(words), len(words))


def read_frame(sequence: int, address: int, length: int) -> list[int]:
    """A frame that reads consecutive registers."""
    frame = ffi().new("uint32_t[]", length + OVERHEAD)
    return list(frame[0 : planner().passo_frame_read(frame, sequence, address, length)])


def write_verdict(mosi: Sequence[int], miso: Sequence[int]) -> Verdict:
    """What became of a write or push; raises a FrameError when the reply does not tell."""
    return _verdict(planner().passo_frame_write_reply, mosi, miso)


def read_verdict(mosi: Sequence[int], miso: Sequence[int]) -> Verdict:
    """Whether the words of `miso` from DATA on are what was asked for."""
    return _verdict(planner().passo_frame_read_reply, mosi, miso)


def line_words(line: Any, axes: int) -> list[int]:
    """Payload of a `struct passo_line`."""
    words = ffi().new("uint32_t[]", 2 + axes)
    return list(words[0 : planner().passo_line_words(words, ffi().addressof(line), axes)])


def ramp_words(ramp: Any) -> list[int]:
    """Payload of a `struct passo_ramp`."""
    words = ffi().new("uint32_t[5]")
    return list(words[0 : planner().passo_ramp_words(words, ffi().addressof(ramp))])


def _build(make: Any, sequence: int, address: int, words: list[int], length: int) -> list[int]:
    frame = ffi().new("uint32_t[]", length + OVERHEAD)
    return list(frame[0 : make(frame, sequence, address, words, length)])


def _verdict(judge: Any, mosi: Sequence[int], miso: Sequence[int]) -> Verdict:
    c = planner()
    verdict = ffi().new("enum passo_verdict *")
    reply = judge(list(mosi), list(miso), len(mosi), verdict)
    if reply == c.PASSO_REPLY_STUCK:
        raise NoAnswerError(f"MISO stays {'high' if miso[0] else 'low'}")
    if reply == c.PASSO_REPLY_NO_ACK:
        raise NoAckError("the core saw an incomplete frame")
    if reply == c.PASSO_REPLY_DAMAGED:
        raise DamagedReplyError("the reply failed its check")
    if reply == c.PASSO_REPLY_SEQUENCE:
        raise WrongSequenceError(f"sequence {miso[-1] >> 24} instead of {mosi[0] >> 20 & 0xFF}")
    return Verdict(verdict[0])
