# SPDX-License-Identifier: MIT
"""The frame codec against an independent CRC and the word layouts of spec/passo.rdl."""

import random
from itertools import product

import pytest
from passo import frame
from passo.native import ffi, planner
from passo.registers import Operation, Shape, Verdict

RANDOM = random.Random(1)


def crc_of_bytes(data: bytes) -> int:
    """CRC-32/MPEG-2, bit by bit."""
    crc = 0xFFFFFFFF
    for byte in data:
        for bit in range(7, -1, -1):
            carry = crc >> 31 ^ byte >> bit & 1
            crc = crc << 1 & 0xFFFFFFFF ^ (0x04C11DB7 if carry else 0)
    return crc


def crc_of_words(words: list[int]) -> int:
    return crc_of_bytes(b"".join(word.to_bytes(4, "big") for word in words))


def some_words(count: int) -> list[int]:
    return [RANDOM.getrandbits(32) for _ in range(count)]


def ack(sequence: int, verdict: int) -> int:
    upper = sequence << 8 | verdict
    return upper << 16 | upper ^ 0xFFFF


STATUS = 0x80FF0410


def test_known_crc() -> None:
    assert crc_of_bytes(b"123456789") == 0x0376E6E7
    assert frame.crc([0x31323334, 0x35363738]) == crc_of_bytes(b"12345678")
    assert frame.crc([]) == 0xFFFFFFFF


@pytest.mark.parametrize("length", [1, 2, 7, 59, 60])
def test_crc_of_words(length: int) -> None:
    words = some_words(length)
    assert frame.crc(words) == crc_of_words(words)
    assert frame.crc(words[1:], frame.crc(words[:1])) == crc_of_words(words)


@pytest.mark.parametrize("length", [1, 30, 60])
@pytest.mark.parametrize(
    ("operation", "build"), [(Operation.WRITE, frame.write_frame), (Operation.PUSH, frame.push_frame)]
)
def test_write_and_push(operation: Operation, build: object, length: int) -> None:
    payload = some_words(length)
    words = build(0xA5, 0x1F3, payload)
    assert words[0] == operation << 28 | 0xA5 << 20 | length << 12 | 0x1F3
    assert words[1:-3] == payload
    assert words[-3] == crc_of_words(words[:-3])
    assert words[-2:] == [0, 0]


def test_read() -> None:
    words = frame.read_frame(255, 0xFFF, 60)
    assert words[0] == 1 << 28 | 255 << 20 | 60 << 12 | 0xFFF
    assert words[1] == crc_of_words(words[:1])
    assert words[2:] == [0] * 62


@pytest.mark.parametrize("verdict", Verdict)
def test_write_replies(verdict: Verdict) -> None:
    mosi = frame.write_frame(7, 3, some_words(2))
    assert frame.write_verdict(mosi, [STATUS] * 5 + [ack(7, verdict)]) == verdict


def test_useless_write_replies() -> None:
    mosi = frame.write_frame(7, 3, some_words(2))
    status = [STATUS] * 5
    for level, name in ((0, "low"), (0xFFFFFFFF, "high")):
        with pytest.raises(frame.NoAnswerError, match=name):
            frame.write_verdict(mosi, [level] * 6)
    with pytest.raises(frame.NoAckError):
        frame.write_verdict(mosi, [*status, STATUS])
    with pytest.raises(frame.WrongSequenceError, match="8 instead of 7"):
        frame.write_verdict(mosi, [*status, ack(8, 0)])
    with pytest.raises(frame.DamagedReplyError):
        frame.write_verdict(mosi, [*status, ack(7, 10)])  # there is no such verdict
    for bit in range(32):
        with pytest.raises(frame.DamagedReplyError):
            frame.write_verdict(mosi, [*status, ack(7, 0) ^ 1 << bit])


def test_read_replies() -> None:
    mosi, data = frame.read_frame(9, 0x140, 3), some_words(3)
    good = [STATUS] * 3 + data + [crc_of_words([mosi[0], *data])]
    assert frame.read_verdict(mosi, good) == Verdict.OK
    for word in range(3, 7):
        for bit in range(32):
            damaged = list(good)
            damaged[word] ^= 1 << bit
            with pytest.raises(frame.FrameError):
                frame.read_verdict(mosi, damaged)


def test_useless_read_replies() -> None:
    mosi = frame.read_frame(9, 0x140, 3)
    refused = ack(9, Verdict.UNKNOWN_ADDRESS)
    assert frame.read_verdict(mosi, [STATUS] * 3 + [refused] * 4) == Verdict.UNKNOWN_ADDRESS
    with pytest.raises(frame.DamagedReplyError):
        frame.read_verdict(mosi, [STATUS] * 3 + [ack(9, Verdict.OK)] * 4)
    with pytest.raises(frame.NoAnswerError):
        frame.read_verdict(mosi, [0] * 7)
    with pytest.raises(frame.WrongSequenceError):
        frame.read_verdict(mosi, [STATUS] * 3 + [ack(8, Verdict.UNKNOWN_ADDRESS)] * 4)


def test_shifted_replies_are_damaged() -> None:
    """A clock lost or doubled within a frame: the ack of one verdict must not be taken for another.

    The ack is repeated if the core decoded the request as a read: it was one, or the clock error came before
    its operation field.
    """
    write, read = frame.write_frame(1, 0x140, [1, 2]), frame.read_frame(1, 0x140, 2)
    kinds = (
        (frame.write_frame, frame.write_verdict, 1),
        (frame.write_frame, frame.write_verdict, len(write) - frame.DATA),
        (frame.read_frame, frame.read_verdict, len(read) - frame.DATA),
    )
    for sequence, verdict, shift, (build, judge, acks) in product(range(256), Verdict, (-1, 1), kinds):
        sent = (sequence << 1 if shift < 0 else sequence >> 1) & 0xFF
        mosi = build(sent, 0x140, [1, 2] if build is frame.write_frame else 2)
        reply = [STATUS | 1] * (len(mosi) - acks) + [ack(sequence, verdict)] * acks
        bits = "".join(f"{word:032b}" for word in reply)
        bits = bits[1:] + bits[-32] if shift < 0 else bits[0] + bits[:-1]
        # the first word is on the wire before the clock that went wrong
        words = [reply[0], *(int(bits[n : n + 32], 2) for n in range(32, len(bits), 32))]
        with pytest.raises(frame.FrameError):
            judge(mosi, words)


def status_of(reply: list[int]) -> int | None:
    status = ffi().new("uint32_t *")
    return status[0] if planner().passo_host_status_of(reply, len(reply), status) else None


@pytest.mark.parametrize("count", range(1, 8))
def test_status_is_what_most_words_repeat(count: int) -> None:
    """Replies with errors in any words: at least three, and more than half, must be equal."""
    for damaged in product((False, True), repeat=count):
        alike = [STATUS ^ 4 if bad else STATUS for bad in damaged]
        good, bad = damaged.count(False), damaged.count(True)
        believed = STATUS if good > bad else STATUS ^ 4
        assert status_of(alike) == (believed if 2 * max(good, bad) > count and max(good, bad) >= 3 else None)
        each_its_own = [STATUS ^ 1 << place if bad else STATUS for place, bad in enumerate(damaged)]
        assert status_of(each_its_own) == (STATUS if 2 * good > count and good >= 3 else None)


@pytest.mark.parametrize("word", [0, 0xFFFFFFFF, STATUS & ~(1 << 31)])
def test_what_is_no_status_is_not_believed(word: int) -> None:
    assert status_of([word] * 7) is None


def test_line_words() -> None:
    line = ffi().new("struct passo_line *")
    line.last, line.endless, line.directions, line.substeps = True, True, 0x81, 0x3FFFFFFF
    for axis in range(8):
        line.steps[axis] = 0x08000000 * axis + 1
    expected = [0x8103, 0x3FFFFFFF, *(0x08000000 * axis + 1 for axis in range(8))]
    assert frame.line_words(line[0], 8) == expected
    assert frame.line_words(line[0], 3) == expected[:5]
    line.last = line.endless = False
    assert frame.line_words(line[0], 1)[0] == 0x8100


def test_ramp_words() -> None:
    ramp = ffi().new("struct passo_ramp *")
    ramp.velocity_end, ramp.ticks, ramp.progress_step = 0x7FFF12345678, 0xFEDCBA98, 0xFFFF89ABCDEF
    for last in (0, 1):
        for now in (0, 1):
            for mirror in (0, 1):
                for shape in Shape:
                    ramp.last, ramp.now, ramp.mirror, ramp.shape = last, now, mirror, shape
                    control = 0x7FFF0000 | shape << 4 | mirror << 2 | now << 1 | last
                    expected = [control, 0x12345678, 0xFEDCBA98, 0x0000FFFF, 0x89ABCDEF]
                    assert frame.ramp_words(ramp[0]) == expected
