# SPDX-License-Identifier: MIT
"""Refused frames: each verdict has its cause and is counted, and nothing else changes."""

import itertools
from collections.abc import Sequence

from passo import frame
from passo import registers as r
from passo.registers import Operation, Verdict

from cocotb_tests.helpers.bench import SUBSTEPS_MAX, rng
from cocotb_tests.helpers.core_bench import V_MAX, Core, Line, PinTiming, Ramp, Shape, core_test
from cocotb_tests.helpers.core_expected import due, totals
from cocotb_tests.helpers.core_frames import GAP, ack, everything, frames, refusals, request
from cocotb_tests.helpers.core_moves import a_motion


def refuse(core: Core, mosi: Sequence[int], verdict: Verdict) -> None:
    """Send a frame and check that it is refused with this verdict."""
    miso = core.transfer(mosi, GAP)
    assert ack(miso) == (mosi[0] >> 20 & 0xFF, verdict), f"{mosi[0]:08X}"


def check_refusals(core: Core, cases: Sequence[tuple[Verdict, list[int]]]) -> None:
    """Check that each frame is refused with its verdict and counted, and that nothing else changes."""
    before, counts = everything(core), refusals(core)
    for verdict, mosi in cases:
        refuse(core, mosi, verdict)
        counts[verdict] += 1
    assert everything(core) == before
    assert refusals(core) == {verdict: count % 256 for verdict, count in counts.items()}


@core_test
def damaged_frames(core: Core) -> None:
    """A bit error anywhere is BAD_CRC, whatever else is wrong; invalid lengths are BAD_LENGTH."""
    random = rng("damaged_frames")
    channel, line, ramp, _ = frames(core)
    good = request(Operation.PUSH, 200, core.axes + 2, line, Line(9, (9,) * core.axes).words())
    cases = []
    for word in range(core.axes + 4):
        bit = random.randrange(20 if word == 0 else 32)  # operation and length are others' cases
        if word == 0 and bit >= 12:
            bit -= 12
        mosi = list(good)
        mosi[word] ^= 1 << bit
        cases.append((Verdict.BAD_CRC, mosi))
    bad = request(9, 200, 1, 0xCCC, [0])
    bad[2] ^= 1
    cases.append((Verdict.BAD_CRC, bad))
    words = [*Line(9, (9,) * core.axes).words()]
    cases += [
        (Verdict.BAD_LENGTH, request(Operation.WRITE, 201, 0, channel)),
        (Verdict.BAD_LENGTH, request(Operation.PUSH, 202, 61, ramp, [0] * 61)),
        (Verdict.BAD_LENGTH, request(Operation.PUSH, 203, len(words) - 1, line, words[:-1])),
        (Verdict.BAD_LENGTH, request(Operation.PUSH, 204, len(words) + 1, line, [*words, 0])),
        (Verdict.BAD_LENGTH, request(Operation.PUSH, 205, 4, ramp, Ramp(0, 1).words()[:4])),
        (Verdict.BAD_LENGTH, request(Operation.PUSH, 206, 6, ramp, [*Ramp(0, 1).words(), 0])),
        (Verdict.BAD_LENGTH, request(Operation.READ, 207, 0, 0)),
    ]
    check_refusals(core, cases)


def hole(block: str, first: int) -> int:
    """The first word of a block, from one on, that is no register."""
    registers = [register for register in r.TABLE if register.block == block]
    words = {register.word + n for register in registers for n in range(register.count)}
    return next(word for word in itertools.count(first) if word not in words)


@core_test
def wrong_operations_and_addresses(core: Core) -> None:
    """Unknown operations, operations that a register does not support, holes, read-only registers."""
    channel, line, ramp, axis = frames(core)
    words = Line(9, (9,) * core.axes).words()
    beyond = r.ADDRESS_CHANNEL_BASE + core.parameters.channels * r.ADDRESS_CHANNEL_STRIDE
    no_axis = axis + core.axes * r.CHANNEL_AXIS_STRIDE
    write, push, read = Operation.WRITE, Operation.PUSH, Operation.READ
    last = r.CHANNEL_DRAIN_VELOCITY
    before_tables = min(register.word for register in r.TABLE if register.count == 256) - 1
    holes = (
        *(hole("CORE", 0), 0x0FF, channel + hole("CHANNEL", 0), channel + hole("CHANNEL", r.CHANNEL_RAMP)),
        # a register of a part that this core lacks
        *(no_axis, axis + r.AXIS_TRACKER_SPEED, beyond, 0xA00, before_tables),
    )
    cases = [
        *((Verdict.BAD_OPERATION, request(number, 100, 1, r.ADDRESS_RUN, [1])) for number in (0, 4, 7, 15)),
        (Verdict.BAD_OPERATION, request(push, 101, 1, r.ADDRESS_RUN, [1])),
        (Verdict.BAD_OPERATION, request(push, 101, 1, channel + r.CHANNEL_RATE_TARGET, [0])),
        (Verdict.BAD_OPERATION, request(push, 101, 1, axis, [1])),
        (Verdict.BAD_OPERATION, request(push, 101, 1, r.ADDRESS_COSINE_BASE, [1])),
        (Verdict.BAD_OPERATION, request(write, 102, len(words), line, words)),
        (Verdict.BAD_OPERATION, request(write, 102, 5, ramp, Ramp(0, 1).words())),
        *(
            (Verdict.BAD_OPERATION, request(read, 103, 1, address))
            for address in (channel, channel + r.CHANNEL_STOP_SLEW, line, ramp, axis, r.ADDRESS_EASE_BASE)
        ),
        *((Verdict.UNKNOWN_ADDRESS, request(write, 104, 1, address, [0])) for address in holes),
        (Verdict.UNKNOWN_ADDRESS, request(read, 105, 1, channel + hole("CHANNEL", r.CHANNEL_STATE))),
        (Verdict.UNKNOWN_ADDRESS, request(push, 105, 5, ramp + 1, Ramp(0, 1).words())),
        # the last of several words has no register
        (Verdict.UNKNOWN_ADDRESS, request(write, 106, 2, channel + last, [77, 77])),
        *(
            (Verdict.READ_ONLY, request(write, 107, 1, address, [0]))
            for address in (
                r.ADDRESS_IDENTIFICATION,
                r.ADDRESS_PARAMETERS,
                r.ADDRESS_REFUSALS_1,
                channel + r.CHANNEL_STATE,
                channel + r.CHANNEL_POSITION_BASE,
                axis + r.AXIS_LOST_STEPS,
            )
        ),
        # PINS and both timings are good, LOST_STEPS is not
        (Verdict.READ_ONLY, request(write, 108, 4, axis, [2, 0x50005, 0x50005, 0])),
        (Verdict.READ_ONLY, request(write, 109, 2, r.ADDRESS_PARAMETERS, [0, 1])),
    ]
    check_refusals(core, cases)
    # the first refusal counts
    both = request(write, 110, 2, channel + last, [1 << 31 | 1, 0])
    refuse(core, both, Verdict.BAD_VALUE)
    check_pins_are_as_after_reset(core)


def check_pins_are_as_after_reset(core: Core) -> None:
    """Check by a motion the settings that cannot be read."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    lines, ramps = a_motion(core, 2)
    channel.rest()
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()
    core.wait_end()
    ((begin, end),) = core.motions(0, core.started)
    assert end - begin == 6 * core.tick
    assert [clock - begin for clock in core.steps(0, begin)] == due(lines, ramps, core.tick)[0]
    assert checker.positions[: core.axes] == totals(lines)


@core_test
def bad_values(core: Core) -> None:
    """Invalid values of registers and queues; an invalid last word makes the whole frame refused."""
    channel, line, ramp, axis = frames(core)
    good = Line(9, (9,) * core.axes)
    write, push = Operation.WRITE, Operation.PUSH
    spoilt = Ramp(0, 1).words()
    spoilt[3] = 1 << 16

    def line_words(index: int, word: int) -> list[int]:
        words = good.words()
        words[index] = word
        return words

    lines = [
        line_words(0, 4),
        line_words(0, 0x80),
        line_words(0, 1 << (8 + core.axes)),
        line_words(0, 1 << 31),
        line_words(1, 0),
        line_words(1, SUBSTEPS_MAX + 1),
        *(line_words(2 + i, 10) for i in range(core.axes)),
        line_words(1 + core.axes, 0xFFFFFFFF),
        [*good.words(), *good.words(), *line_words(2, 10)],
    ]
    ramps = [
        *([1 << bit, 0, 1, 0, 1] for bit in range(16) if not r.RAMP_CONTROL_DEFINED >> bit & 1),
        [0x8000 << 16, 1, 1, 0, 1],
        [0x8001 << 16, 0, 1, 0, 1],
        [0xFFFF << 16, 0, 1, 0, 1],
        spoilt,
        [*Ramp(0, 1).words(), *spoilt],
    ]
    writes = [
        (channel + r.CHANNEL_RATE_TARGET, [0x10001]),
        (channel + r.CHANNEL_RATE_TARGET, [0xFFFFFFFF]),
        (channel + r.CHANNEL_RATE_TARGET, [0, 0, 0x10001]),
        (channel + r.CHANNEL_RATE_SLEW, [0x20000]),
        (channel + r.CHANNEL_STOP_SLEW, [0x10001]),
        (channel + r.CHANNEL_DRAIN_VELOCITY, [0x80000001]),
        (channel + r.CHANNEL_COMMAND, [1 << 4]),
        (channel + r.CHANNEL_COMMAND, [1 << 31 | 2]),
        (channel + r.CHANNEL_DRAIN_VELOCITY, [0]),
        (axis, [1 << 5]),
        (axis, [1]),
        (axis, [0x102]),
        (axis + r.AXIS_ENABLE, [2]),
        (axis + r.AXIS_ENABLE, [1 << 31]),
        (r.ADDRESS_RUN, [1 << 19]),
        (r.ADDRESS_RUN, [1 << core.parameters.channels]),
        (r.ADDRESS_RUN, [1 << 8 + core.parameters.channels]),
        (r.ADDRESS_COSINE_BASE, [0x10000]),
        (r.ADDRESS_EASE_BASE + 250, [1, 2, 3, 4, 5, 1 << 31]),
    ]
    if core.parameters.channels < 8:
        writes.append((r.ADDRESS_RUN, [core.parameters.channels << r.RUN_STATUS_CHANNEL_LSB]))
    cases = [(Verdict.BAD_VALUE, request(push, 30 + i, len(w), line, w)) for i, w in enumerate(lines)]
    cases += [(Verdict.BAD_VALUE, request(push, 60 + i, len(w), ramp, w)) for i, w in enumerate(ramps)]
    cases += [(Verdict.BAD_VALUE, request(write, 90 + i, len(w), a, w)) for i, (a, w) in enumerate(writes)]
    check_refusals(core, cases)
    check_pins_are_as_after_reset(core)


@core_test
def greatest_values(core: Core) -> None:
    """The largest valid values are accepted."""
    channel = core.channel()
    channel.lines(Line(SUBSTEPS_MAX, (SUBSTEPS_MAX, -SUBSTEPS_MAX, 0)[: core.axes]))
    channel.ramps(Ramp(V_MAX, 0xFFFFFFFF, Shape.EASE, mirror=True))
    core.link.write(channel.base + r.CHANNEL_RATE_TARGET, 0x10000, 0x10000, 0x10000, 0x80000000)
    channel.start()
    core.run(2000)
    assert channel.state().drained == 0
    channel.abort()


@core_test
def full_queues(core: Core) -> None:
    """A frame without enough room is refused as a whole; one that just fits is accepted."""
    _, line, ramp, _ = frames(core)
    host = core.channel()
    words = Line(9, (9,) * core.axes).words()
    for address, item, depth_log2 in (
        (line, words, core.parameters.line_queue_log2),
        (ramp, Ramp(0, 1).words(), core.parameters.ramp_queue_log2),
    ):
        per_frame = frame.PAYLOAD_MAX // len(item)
        room = 1 << depth_log2
        while room >= per_frame:
            core.link.push(address, item * per_frame)
            room -= per_frame
        if room:
            too_many = item * (room + 1)
            if room < per_frame:
                check_refusals(
                    core,
                    [(Verdict.QUEUE_FULL, request(Operation.PUSH, 7, len(too_many), address, too_many))],
                )
            core.link.push(address, item * room)
        # bad in its last word, but there is no room for its first
        bad = [*item[:-1], 0xFFFFFFFF]
        check_refusals(
            core,
            [
                (Verdict.QUEUE_FULL, request(Operation.PUSH, 8, len(item), address, item)),
                (Verdict.QUEUE_FULL, request(Operation.PUSH, 9, len(item), address, bad)),
            ],
        )
    assert host.room() == (0, 0)
    assert core.link.status & 0xFFFF == 0
    host.abort()
    assert host.room() == (1 << core.parameters.line_queue_log2, 1 << core.parameters.ramp_queue_log2)


@core_test
def busy(core: Core) -> None:
    """Queues of a stopped channel; tables, ZERO and CLEAR while a motion runs."""
    channel, line, ramp, axis = frames(core)
    host = core.channel()
    host.abort()
    words = Line(9, (9,) * core.axes).words()
    write, push = Operation.WRITE, Operation.PUSH
    check_refusals(
        core,
        [
            (Verdict.BUSY, request(push, 150, len(words), line, words)),
            (Verdict.BUSY, request(push, 151, 10, ramp, Ramp(0, 1).words() * 2)),
        ],
    )
    host.clear()
    host.lines(Line(9, (9,) * core.axes, endless=True))
    host.ramps(Ramp(0, 0))
    host.start()
    core.run(300)
    check_refusals(
        core,
        [
            (Verdict.BUSY, request(write, 152, 1, r.ADDRESS_SIGMOID_BASE, [1])),
            (Verdict.BUSY, request(write, 153, 3, r.ADDRESS_EASE_BASE + 253, [1, 2, 3])),
            (Verdict.BUSY, request(write, 154, 1, channel, [1 << r.CHANNEL_COMMAND_ZERO_LSB])),
            (Verdict.BUSY, request(write, 155, 1, channel, [1 << r.CHANNEL_COMMAND_CLEAR_LSB])),
            (Verdict.BUSY, request(write, 156, 1, channel, [0xC])),
            (Verdict.BUSY, request(write, 157, 1, axis, [0])),
            (Verdict.BUSY, request(write, 158, 3, axis, [2, 0x50005, 0x50005])),
        ],
    )
    host.abort()
