# SPDX-License-Identifier: MIT
"""Several channels: started together, otherwise independent."""

from collections.abc import Callable

from passo import registers as r
from passo.cocotb.clocks import read
from passo.host import RATE_ONE
from passo.registers import Cause, Operation, State, Verdict

from cocotb_tests.helpers.core_bench import ONE, V_MAX, Core, Line, PinTiming, Ramp, Shape, core_test
from cocotb_tests.helpers.core_expected import distance, due, totals
from cocotb_tests.helpers.core_frames import GAP, ack, request
from cocotb_tests.helpers.core_moves import a_motion

ROOM_SHOWN = 255  # at most, in the status word


def motion(core: Core, shape: Shape, speed: int, ticks: int) -> tuple[list[Line], list[Ramp]]:
    """Two lines under two ramps of a shape."""
    ramps = [Ramp(speed, ticks, shape), Ramp(0, ticks + 1, shape, mirror=True, last=True)]
    total = distance(ramps, core.tick)
    first = total // 3
    return [
        Line(first, (first, -(first // 2))[: core.axes]),
        Line(total - first, (-3, total - first)[: core.axes], last=True),
    ], ramps


def check_steps(core: Core, channel: int, lines: list[Line], ramps: list[Ramp], begin: int) -> None:
    """Check that the steps of a channel come on their clocks, whatever the others do."""
    for axis, clocks in enumerate(due(lines, ramps, core.tick)):
        steps = [clock - begin for clock in core.steps(channel * core.axes + axis, begin)]
        assert steps == clocks


def prepare(
    core: Core, number: int, shape: Shape, speed: int, ticks: int = 4
) -> tuple[list[Line], list[Ramp]]:
    """Queue a motion of a channel."""
    lines, ramps = motion(core, shape, speed, ticks)
    channel = core.channel(number)
    channel.lines(*lines)
    channel.ramps(*ramps)
    return lines, ramps


def every(core: Core) -> int:
    """Mask with a bit per channel."""
    return (1 << core.parameters.channels) - 1


def start_together(core: Core, start: Callable[[], None], first: int) -> None:
    """Arm all channels, each with a different shape; `start` must start them on the same clock."""
    since = core.clock
    before = [core.channel(number).positions() for number in range(core.parameters.channels)]
    core.link.write(r.ADDRESS_RUN, every(core) << r.RUN_WAIT_SYNC_LSB | every(core))
    shapes = [Shape.COSINE, Shape.LINEAR, Shape.SIGMOID, Shape.EASE] * 3
    motions = [
        prepare(core, number, shapes[number + first], ONE // (9 + number)) for number in range(len(before))
    ]
    core.run(300)
    assert {core.channel(number).state().state for number in range(len(before))} == {State.ARMED}
    start()
    core.run(9 * core.tick + 500)
    begins = [core.motions(number, since)[0][0] for number in range(len(before))]
    assert len(set(begins)) == 1
    for number, (lines, ramps) in enumerate(motions):
        check_steps(core, number, lines, ramps, begins[number])
        moved = [a - b for a, b in zip(core.channel(number).positions(), before[number], strict=True)]
        assert moved == totals(lines)


@core_test
def channels_start_on_the_same_clock(core: Core) -> None:
    """The sync pin, or one write that clears WAIT_SYNC, starts all armed channels together."""
    core.watch(PinTiming())
    start_together(core, lambda: core.sync(True), 0)
    start_together(core, lambda: core.link.write(r.ADDRESS_RUN, every(core)), 2)


@core_test
def channels_do_not_disturb_each_other(core: Core) -> None:
    """All shapes and tables simultaneously; one channel is held or stopped, and the other continues."""
    core.watch(PinTiming())
    first, second = core.channel(0), core.channel(1)
    first.link.write(first.base + r.CHANNEL_RATE_SLEW, RATE_ONE)
    for shape in (Shape.COSINE, Shape.SIGMOID, Shape.EASE):
        since = core.clock
        core.link.write(r.ADDRESS_RUN, 0)
        lines, ramps = prepare(core, 1, shape, ONE // 20, 12)
        prepare(core, 0, shape, ONE // 8, 12)
        core.link.write(r.ADDRESS_RUN, every(core))
        if shape == Shape.COSINE:
            first.set_rate(0)
        elif shape == Shape.SIGMOID:
            first.abort()
        else:
            first.stop()
        core.run(25 * core.tick)
        ((begin, end),) = core.motions(1, since)
        assert end - begin == 25 * core.tick
        check_steps(core, 1, lines, ramps, begin)
        assert second.state().state == State.IDLE
        if shape == Shape.COSINE:
            assert first.state().state == State.RUN
            first.set_rate(RATE_ONE)
            core.run(25 * core.tick)
            assert first.state().state == State.IDLE
        else:
            assert first.state().state == State.STOPPED
            first.clear()


@core_test
def each_channel_has_its_own_registers(core: Core) -> None:
    """Positions, faults, commands, room; STATUS_CHANNEL chooses whose room the status word shows."""
    core.watch(PinTiming())
    channels = [core.channel(number) for number in range(core.parameters.channels)]
    depth = 1 << core.parameters.line_queue_log2
    lines, ramps = a_motion(core, 2)
    channels[1].lines(*lines)
    channels[1].ramps(*ramps)
    for number, room in ((0, depth), (1, depth - 3)):
        core.link.write(r.ADDRESS_RUN, number << r.RUN_STATUS_CHANNEL_LSB)
        core.link.read(0, 1)
        assert core.link.status >> 8 & 0xFF == min(room, ROOM_SHOWN)
        assert core.link.status >> 24 & 7 == number
    channels[0].abort()
    assert channels[0].state().cause == Cause.ABORT
    assert channels[1].state().cause == Cause.NONE
    channels[1].start()
    core.wait_end(1)
    assert channels[1].positions() == totals(lines)
    assert channels[0].positions() == [0] * core.axes
    assert channels[0].state().cause == Cause.ABORT
    channels[0].clear()
    channels[0].link.write(channels[0].base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB)
    assert channels[1].positions() == totals(lines)


@core_test
def the_status_word_shows_any_channel(core: Core) -> None:
    """Its number, the room in its two queues, 255 for more; RUN and WAIT_SYNC of each are read back."""
    depths = core.parameters.line_queue_log2, core.parameters.ramp_queue_log2
    for number in range(core.parameters.channels):
        channel = core.channel(number)
        other = (number + 1) % core.parameters.channels
        run = number << r.RUN_STATUS_CHANNEL_LSB | 1 << r.RUN_WAIT_SYNC_LSB + other | 1 << number
        core.link.write(r.ADDRESS_RUN, run)
        assert core.link.read(r.ADDRESS_RUN, 1) == [run]
        for queued in range(3):
            if queued == 1:
                channel.lines(Line(1, (1,) * core.axes), Line(1, (1,) * core.axes))
            elif queued == 2:
                core.link.write(r.ADDRESS_RUN, run & ~0xFF)
                channel.ramps(Ramp(0, 1))
            core.link.read(0, 1)
            rooms = [(1 << depths[0]) - 2 * (queued > 0), (1 << depths[1]) - (queued > 1)]
            assert channel.room() == tuple(rooms)
            shown = [min(room, ROOM_SHOWN) for room in rooms]
            assert core.link.status & 0x0700FFFF == number << 24 | shown[0] << 8 | shown[1]
        channel.abort()
        channel.clear()
        assert channel.room() == (1 << depths[0], 1 << depths[1])


@core_test
def every_channel_answers_for_itself(core: Core) -> None:
    """Each refuses what it must; positions and pins are its own."""
    count = core.parameters.channels
    channels = [core.channel(number) for number in range(count)]
    ramps = [Ramp(V_MAX, 0), Ramp(V_MAX, 1), Ramp(0, 0, last=True)]
    for number, channel in enumerate(channels):
        channel.lines(Line(number + 1, (-number - 1,) * core.axes, last=True))
        channel.ramps(*ramps)
        reasons = (
            (Verdict.READ_ONLY, r.CHANNEL_STATE, 0),
            (Verdict.BAD_VALUE, r.CHANNEL_RATE_TARGET, RATE_ONE + 1),
        )
        for verdict, register, word in reasons:
            write = request(Operation.WRITE, 0x70 + number, 1, channel.base + register, [word])
            assert ack(core.transfer(write, GAP)) == (0x70 + number, verdict)
    core.link.write(r.ADDRESS_RUN, every(core))
    core.run(3 * core.tick)
    for number, channel in enumerate(channels):
        assert channel.positions() == [-number - 1] * core.axes
    for number, channel in enumerate(channels):
        core.link.write(channel.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB)
        assert channel.positions() == [0] * core.axes
        other = (number + 1) % count
        assert channels[other].positions() == [0 if other < number else -other - 1] * core.axes
        for level in (1, 0):
            core.link.write(channel.axis_base(0) + r.AXIS_ENABLE, level)
            core.run(4)
            assert read(core.dut.enable) == level << number * core.axes


@core_test
def both_channels_at_full_speed(core: Core) -> None:
    """Every axis of every channel steps every second clock."""
    checker = core.watch(PinTiming())
    ramps = [Ramp(V_MAX, 0), Ramp(V_MAX, 8), Ramp(0, 0, last=True)]
    count = 4 * core.tick
    for number in range(core.parameters.channels):
        channel = core.channel(number)
        channel.lines(Line(count, (count, -count)[: core.axes], last=True))
        channel.ramps(*ramps)
    core.link.write(r.ADDRESS_RUN, every(core))
    core.run(8 * core.tick + 500)
    begin = core.motions()[0][0]
    for bit in range(core.axes * core.parameters.channels):
        assert [clock - begin for clock in core.steps(bit)] == [2 * k for k in range(1, count + 1)]
        assert abs(checker.positions[bit]) == count
