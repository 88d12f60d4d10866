# SPDX-License-Identifier: MIT
"""Frames at the pins: valid ones are executed exactly once, whatever happens on the link."""

from dataclasses import replace

from passo import registers as r
from passo.frame import PAYLOAD_MAX
from passo.link import Link, LinkError
from passo.registers import Operation, Verdict

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import V_MAX, Core, CoreChannel, Line, PinTiming, Ramp, Shape, core_test
from cocotb_tests.helpers.core_expected import due, totals
from cocotb_tests.helpers.core_frames import GAP, ack, everything, frames, refusals, request
from cocotb_tests.helpers.core_moves import a_motion
from tests.helpers.closed_form import loaded_table

SNAPSHOT_CLOCKS = 68  # at most, from the fall of chip select to the clock that the positions are of


@core_test
def reads(core: Core) -> None:
    """Holes in a read are 0; the status word shows queues, state and sequence number."""
    depth = 1 << core.parameters.line_queue_log2, 1 << core.parameters.ramp_queue_log2
    words = core.link.read(0, 20)
    assert words[0] == r.IDENTIFICATION_RESET
    assert words[6:] == [0] * 14
    host = core.channel()
    host.lines(Line(5, (1,) * core.axes), Line(5, (1,) * core.axes))
    core.link.read(0, 1)
    status = core.link.status
    assert status >> 30 == 2
    assert status >> 24 & 0x3F == 0
    assert status & 0xFFFF == (depth[0] - 2) << 8 | depth[1]
    # reads do not count as accepted
    last = status >> 16 & 0xFF
    core.link.read(0, 1)
    assert core.link.status >> 16 & 0xFF == last
    host.abort()
    core.link.read(0, 1)
    assert core.link.status >> 28 & 3 == 2
    host.clear()
    host.ramps(Ramp(0, 0))
    host.lines(Line(5, (1,) * core.axes))
    host.start()
    core.link.read(0, 1)
    assert core.link.status >> 28 & 3 == 1
    assert core.link.read(r.ADDRESS_RUN, 1) == [1]


@core_test
def positions_are_of_one_moment(core: Core) -> None:
    """All positions of a read are sampled on one clock shortly after chip select falls, during motion."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.lines(Line(7, (7, -7, 7)[: core.axes], endless=True))
    channel.ramps(Ramp(V_MAX, 0), Ramp(V_MAX, 100))
    channel.start()
    core.run_until(core.is_running, 1000)
    for wait in (1, 2, 3, 4):
        core.run(wait)
        selected = core.clock
        positions = channel.positions()
        assert len({abs(position) for position in positions}) == 1
        seen = len([clock for clock in core.steps(0) if clock <= selected])
        assert 0 <= positions[0] - seen <= SNAPSHOT_CLOCKS // 2
    channel.abort()


@core_test
def duplicates_are_executed_once(core: Core) -> None:
    """A write or push with the sequence number of the last accepted one is acknowledged but not executed."""
    _, line, ramp, _ = frames(core)
    words = Line(5, (1,) * core.axes).words()
    host = core.channel()
    lines, ramps = host.room()
    push = request(Operation.PUSH, 42, len(words), line, words)
    assert ack(core.transfer(push, GAP)) == (42, Verdict.OK)
    for again in (push, push, request(Operation.PUSH, 42, 5, ramp, Ramp(0, 1).words())):
        assert ack(core.transfer(again, GAP)) == (42, Verdict.DUPLICATE)
    assert host.room() == (lines - 1, ramps)
    # a refused frame does not take its number
    bad = request(Operation.WRITE, 43, 1, 0, [0])
    assert ack(core.transfer(bad, GAP)) == (43, Verdict.READ_ONLY)
    assert ack(core.transfer(push, GAP)) == (42, Verdict.DUPLICATE)
    good = request(Operation.PUSH, 43, len(words), line, words)
    assert ack(core.transfer(good, GAP)) == (43, Verdict.OK)
    assert ack(core.transfer(push, GAP)) == (42, Verdict.OK)
    assert host.room() == (lines - 3, ramps)
    assert not any(count for verdict, count in refusals(core).items() if verdict != Verdict.READ_ONLY)


@core_test
def sequence_numbers_are_compared_in_all_their_bits(core: Core) -> None:
    """Numbers that differ in one bit are new, the same one again is a duplicate; the status word shows it."""
    for sequence in [0x55, *(0x55 ^ 1 << bit for bit in range(8)), 0xAA, 0xFF, 0x00]:
        write = request(Operation.WRITE, sequence, 1, r.ADDRESS_RUN, [0])
        assert ack(core.transfer(write, GAP)) == (sequence, Verdict.OK)
        status, *words = core.transfer(write, GAP)
        assert ack(words) == (sequence, Verdict.DUPLICATE)
        assert status >> 16 & 0xFF == sequence
        if sequence.bit_count() != 4:
            write = request(Operation.WRITE, 0x55, 1, r.ADDRESS_RUN, [0])
            assert ack(core.transfer(write, GAP)) == (0x55, Verdict.OK)


@core_test
def frames_that_are_cut_short(core: Core) -> None:
    """A frame cut anywhere before its CRC has no effect; one cut after its verdict is executed."""
    random = rng("frames_that_are_cut_short")
    _, line, _, _ = frames(core)
    host = core.channel()
    words = Line(5, (1,) * core.axes).words()
    push = request(Operation.PUSH, 77, len(words), line, words)
    needed = 32 * (len(words) + 2)
    before, counts = everything(core), refusals(core)
    cuts = [0, 1, 31, 32, 33, 63, 64, needed - 32, needed - 1, *(random.randrange(needed) for _ in range(4))]
    for count in cuts:
        core.transfer_bits(push, count, GAP, cut_high=bool(count) and random.random() < 0.5)
    assert everything(core) == before
    # the link needs 74 clocks and some more to bring the verdict
    core.transfer_bits(push, needed + random.randrange(20, 30), GAP)
    lines, _ = host.room()
    assert lines == (1 << core.parameters.line_queue_log2) - 1
    assert ack(core.transfer(push, GAP)) == (77, Verdict.DUPLICATE)
    # reads too
    read = request(Operation.READ, 5, 3, 0)
    for count in (40, 64, 100, 130, 32 * len(read) - 1):
        core.transfer_bits(read, count, GAP)
    assert core.link.read(0, 1) == [r.IDENTIFICATION_RESET]
    assert refusals(core) == counts


@core_test
def every_shape_of_sclk(core: Core) -> None:
    """SCLK slow and fast, with short high or low times; other slaves use the bus too."""
    for half_period, high in ((2, 1), (2, 2), (2, 3), (3, 1), (3, 5), (7, 7)):
        core.half_period, core.sclk_high = half_period, high
        assert core.link.read(0, 1) == [r.IDENTIFICATION_RESET]
        core.link.write(r.ADDRESS_RUN, 0)
        core.clock_others(37)
    core.half_period = core.sclk_high = 2


@core_test
def tables_can_be_rewritten(core: Core) -> None:
    """A ramp follows rewritten points, and the original shape after they are restored."""
    channel = core.channel()
    core.watch(PinTiming())
    lines, ramps = a_motion(core, 3)
    steps = []
    # the cosine becomes straight: u = k / 256
    for points in ([256 * k for k in range(256)], None, loaded_table(Shape.COSINE)[:256]):
        if points is not None:
            for k in range(0, 256, 32):
                core.link.write(r.ADDRESS_COSINE_BASE + k, *points[k : k + 32])
        for used in (ramps, [replace(ramp, shape=Shape.LINEAR) for ramp in ramps]):
            channel.rest()
            channel.lines(*lines)
            channel.ramps(*used)
            channel.start()
            core.wait_end()
            begin, _ = core.motions()[-1]
            steps.append([clock - begin for clock in core.steps(0, begin)])
    straight, linear = steps[0], steps[1]
    assert straight == linear == steps[2] == steps[3] == steps[5]
    assert steps[4] != linear
    assert steps[4][: len(due(lines, ramps, core.tick)[0])] == due(lines, ramps, core.tick)[0]


@core_test
def noise_on_the_wire(core: Core) -> None:
    """Bits of MOSI are flipped at random; with the host's retries every move is made exactly once."""
    random = rng("noise_on_the_wire")
    flipped = 0

    def noise(words: list[int]) -> list[int]:
        nonlocal flipped
        if random.random() < 0.4:
            for _ in range(random.choice([1, 1, 2, 5])):
                words[random.randrange(len(words))] ^= 1 << random.randrange(32)
            flipped += 1
        return words

    checker = core.watch(PinTiming())
    core.link = Link(core, tries=30)
    channel = CoreChannel(core, 0)
    expected = [0] * core.axes
    core.corrupt = noise
    for _ in range(4):
        lines, ramps = a_motion(core, 2)
        if random.random() < 0.5:
            lines = [replace(lines[-1], substeps=sum(line.substeps for line in lines))]
        try:
            channel.rest()
            channel.lines(*lines)
            channel.ramps(*ramps)
            channel.start()
        except LinkError as error:
            raise AssertionError(f"the host gave up: {error}") from error
        core.run_until(lambda: not core.is_running(), 4000)
        core.run(1000)
        expected = [a + b for a, b in zip(expected, totals(lines), strict=True)]
        assert checker.positions == expected
    core.corrupt = list
    assert flipped > 5 and core.link.retries > 3
    assert len(core.motions()) == 4
    assert channel.positions() == expected


@core_test
def frames_that_are_too_long(core: Core) -> None:
    """Of any length above 60: refused after all their words."""
    channel, _, _, _ = frames(core)
    before, counts = everything(core), refusals(core)
    for sequence, length in enumerate((61, 64, 127, 128, 255)):
        write = request(Operation.WRITE, sequence, length, channel + r.CHANNEL_RATE_TARGET, [0] * length)
        assert ack(core.transfer(write, GAP)) == (sequence, Verdict.BAD_LENGTH)
    assert everything(core) == before
    assert refusals(core) == counts | {Verdict.BAD_LENGTH: counts[Verdict.BAD_LENGTH] + 5}


@core_test
def a_frame_may_follow_immediately(core: Core) -> None:
    """It waits while a long frame before it is executed; both are acknowledged."""
    _, line, ramp, _ = frames(core)
    one = Line(5, (1,) * core.axes).words()
    lines = one * (PAYLOAD_MAX // len(one))
    host = core.channel()
    depth = host.room()
    for gap in (2, 3, 5, 8, 13):
        push = request(Operation.PUSH, 0x20 + gap, len(lines), line, lines)
        bad = request(Operation.PUSH, 0x40 + gap, 4, ramp, [0] * 4)
        good = request(Operation.PUSH, 0x60 + gap, 5, ramp, Ramp(0, 1).words())
        assert ack(core.transfer(push, gap)) == (0x20 + gap, Verdict.OK)
        assert ack(core.transfer(bad, gap)) == (0x40 + gap, Verdict.BAD_LENGTH)
        assert ack(core.transfer(good, gap)) == (0x60 + gap, Verdict.OK)
        assert host.room() == (depth[0] - PAYLOAD_MAX // len(one), depth[1] - 1)
        host.abort()
        host.clear()
