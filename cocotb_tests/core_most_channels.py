# SPDX-License-Identifier: MIT
"""A core of 8 channels with all parts that have pins: each channel has its own pins and refusals."""

from passo import registers as r
from passo.cocotb.clocks import read
from passo.host import RATE_ONE
from passo.registers import Cause, LineOutputWord, TriggerSource, Verdict

from cocotb_tests.core_inputs import trigger_state
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_frames import verdict
from cocotb_tests.helpers.core_shaft import Shafts, error, positions

FULL = LineOutputWord(raster=False, proportional=False, levels=0x3C, power=0xFFFF)
ROOM_SHOWN = 255  # at most, in the status word
LINES_IN_FRAME = 15


def channels(core: Core) -> list[CoreChannel]:
    """All of them."""
    return [core.channel(number) for number in range(core.parameters.channels)]


@core_test
def inputs_are_those_of_their_channel(core: Core) -> None:
    """Levels, the probe, an alarm; no other channel sees them."""
    every = channels(core)
    pins = ("limit_low", "limit_high", "home", "alarm", "probe")
    for number, channel in enumerate(every):
        for name in pins:
            core.set(name, 1 << number)
        core.run(20)
        levels = [core.link.read(other.base + r.CHANNEL_INPUT_LEVELS, 1)[0] for other in every]
        assert levels == [0x01010101 if other is channel else 0 for other in every]
        assert [trigger_state(other).probe for other in every] == [other is channel for other in every]
        for name in pins:
            core.set(name, 0)
        causes = [other.state().cause for other in every]
        assert causes == [Cause.ALARM if other is channel else Cause.NONE for other in every]
        channel.clear()


@core_test
def encoders_are_those_of_their_channel(core: Core) -> None:
    """Each turns by another number of counts, and its index is latched."""
    every = channels(core)
    shafts = Shafts(core, per_turn=8)
    for number in range(len(every)):
        shafts.turn(number, [(6, 1)] * (10 + number) + [(6, -1)] * 2)
    core.run(200)
    for number, channel in enumerate(every):
        assert positions(channel) == [8 + number]
        assert error(channel, 0) == -8 - number
        word = channel.link.read(channel.base + r.CHANNEL_ENCODER_BASE + r.ENCODER_INDEX, 1)[0]
        assert r.EncoderIndexWord.unpack(word).indexes > 0


@core_test
def outputs_are_those_of_their_channel(core: Core) -> None:
    """Levels, power and compare pulses; those of the others stay low."""
    core.watch(PinTiming())
    for number, channel in enumerate(channels(core)):
        channel.link.write(channel.base + r.CHANNEL_OUTPUT_LEVELS, 0xC3)
        core.run(10)
        assert read(core.dut.outputs) == 0xC3 << 8 * number
        channel.link.write(channel.base + r.CHANNEL_COMPARE_PULSE, 4, 5, 5)
        since = core.clock
        channel.lines(Line(20, (20,), last=True), outputs=[FULL])
        channel.ramps(Ramp(ONE // 16, 0), Ramp(ONE // 16, 3), Ramp(0, 0, last=True))
        channel.start()
        core.wait_end(number)
        assert read(core.dut.outputs) == FULL.levels << 8 * number
        channel.link.write(channel.base + r.CHANNEL_OUTPUT_LEVELS, 0)
        core.run(10)
        steps = core.steps(number, since)
        assert len(steps) == 20
        ((_, end),) = core.motions(number, since)
        assert core.changes("power", number, since) == [(steps[0], 1), (end, 0)]
        rises = [clock for clock, level in core.changes("compare", number, since) if level]
        assert rises == steps[4::5]
        for other in set(range(core.parameters.channels)) - {number}:
            assert not core.changes("power", other, since) and not core.changes("compare", other, since)


@core_test
def each_channel_refuses_for_itself(core: Core) -> None:
    """Values that it does not take, what does not fit into its queue, and what comes while it is stopped."""
    line = [*Line(9, (9,) * core.axes).words(), 0]
    bad_line = [*Line(9, (10,) * core.axes).words(), 0]
    depth = 1 << core.parameters.line_queue_log2
    trigger = r.ChannelTriggerWord(source=TriggerSource.HOME, axis=core.axes, falling=False, arm=True).pack()
    for number, channel in enumerate(channels(core)):
        core.link.write(r.ADDRESS_RUN, number << r.RUN_STATUS_CHANNEL_LSB)
        assert verdict(channel, r.CHANNEL_TRIGGER, trigger) == Verdict.BAD_VALUE
        assert verdict(channel, r.CHANNEL_COMPARE_PULSE, core.axes << 16) == Verdict.BAD_VALUE
        assert verdict(channel, r.CHANNEL_RATE_TARGET, RATE_ONE + 1) == Verdict.BAD_VALUE
        assert verdict(channel, r.CHANNEL_LINE, *bad_line, push=True) == Verdict.BAD_VALUE
        room = depth
        while room >= LINES_IN_FRAME:
            assert verdict(channel, r.CHANNEL_LINE, *line * LINES_IN_FRAME, push=True) == Verdict.OK
            room -= LINES_IN_FRAME
            if number == 0:
                core.link.read(0, 1)
                assert core.link.status >> 8 & 0xFF == min(room, ROOM_SHOWN)
        assert verdict(channel, r.CHANNEL_LINE, *line * (room + 1), push=True) == Verdict.QUEUE_FULL
        assert channel.room()[0] == room
        channel.abort()
        assert verdict(channel, r.CHANNEL_LINE, *line, push=True) == Verdict.BUSY
        channel.clear()
        assert channel.room()[0] == depth


@core_test
def the_ramps_of_a_full_queue_are_counted(core: Core) -> None:
    """The status word and ROOM tell the same."""
    channel = core.channel(core.parameters.channels - 1)
    core.link.write(r.ADDRESS_RUN, channel.number << r.RUN_STATUS_CHANNEL_LSB)
    depth = 1 << core.parameters.ramp_queue_log2
    for queued in range(12, depth, 12):
        channel.ramps(*[Ramp(0, 1)] * 12)
        core.link.read(0, 1)
        assert core.link.status & 0xFF == min(depth - queued, ROOM_SHOWN)
        assert channel.room()[1] == depth - queued
    channel.abort()
    channel.clear()
    assert channel.room()[1] == depth
