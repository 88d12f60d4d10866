# SPDX-License-Identifier: MIT
"""Python binding of the frame codec (c_model/protocol/passo_frame.h)."""

from collections.abc import Sequence
from typing import Any

from passo.failure import Failure
from passo.native import ffi, planner
from passo.registers import Verdict

PAYLOAD_MAX = 60
OVERHEAD = 4
DATA = 3
CRC_START = 0xFFFFFFFF


class FrameError(Failure):
    """The reply is not valid, so it is unknown whether the frame was executed."""


class NoAnswerError(FrameError):
    """MISO never changed."""


class NoAckError(FrameError):
    """The core sent its status instead of the ack."""


class DamagedReplyError(FrameError):
    """The ack or the data failed their check."""


class WrongSequenceError(FrameError):
    """The ack belongs to another frame."""


def crc(words: Sequence[int], start: int = CRC_START) -> int:
    """CRC-32/MPEG-2 over 32-bit words."""
    return planner().passo_crc(start, list(words), len(words))


def write_frame(sequence: int, address: int, words: Sequence[int]) -> list[int]:
    """A frame that writes 1 to 60 consecutive registers."""
    return _build(planner().passo_frame_write, sequence, address, list(words), len(words))


def push_frame(sequence: int, address: int, words: Sequence[int]) -> list[int]:
    """A frame that writes 1 to 60 words to one register."""
    return _build(planner().passo_frame_push, sequence, address, list(words), len(words))


def read_frame(sequence: int, address: int, length: int) -> list[int]:
    """A frame that reads 1 to 60 consecutive registers."""
    frame = ffi().new("uint32_t[]", length + OVERHEAD)
    return list(frame[0 : planner().passo_frame_read(frame, sequence, address, length)])


def write_verdict(mosi: Sequence[int], miso: Sequence[int]) -> Verdict:
    """Verdict on a write or push; raises FrameError if the reply is not valid."""
    return _verdict(planner().passo_frame_write_reply, mosi, miso)


def read_verdict(mosi: Sequence[int], miso: Sequence[int]) -> Verdict:
    """Verdict on a read; if OK, its data start at miso[DATA]. Raises FrameError."""
    return _verdict(planner().passo_frame_read_reply, mosi, miso)


def line_words(line: Any, axes: int) -> list[int]:
    """Payload words of a `struct passo_line`."""
    words = ffi().new("uint32_t[]", 2 + axes)
    return list(words[0 : planner().passo_line_words(words, ffi().addressof(line), axes)])


def ramp_words(ramp: Any) -> list[int]:
    """Payload words of a `struct passo_ramp`."""
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
