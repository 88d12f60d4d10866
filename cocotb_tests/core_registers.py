# SPDX-License-Identifier: MIT
"""All bits of the registers of a channel, verified by their effect on motion and by reading."""

from passo import registers as r
from passo.host import RATE_ONE
from passo.registers import Cause

from cocotb_tests.helpers.bench import SUBSTEPS_MAX
from cocotb_tests.helpers.core_bench import ONE, V_MAX, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_expected import due
from cocotb_tests.helpers.core_moves import check_stopped

LOW_BITS = 0x07FF  # of a slew: it takes enough ticks for a read of the rate meanwhile
HIGH_BITS = 0xF800  # two ticks, seen in the pulses


def jog(core: Core, channel: CoreChannel, velocity: int) -> None:
    """Start an endless motion at a velocity."""
    channel.rest()
    channel.lines(Line(1, (1, -1, 0)[: core.axes], endless=True))
    channel.ramps(Ramp(velocity, 0))
    channel.start()
    core.run_until(core.is_running, 1000)


def read_word(channel: CoreChannel, register: int) -> int:
    """A register of the channel."""
    return channel.link.read(channel.base + register, 1)[0]


def check_slowing(core: Core, channel: CoreChannel, slew: int) -> None:
    """Check that the rate decreases by one slew per slew tick; it is read on the way if there is time."""
    begin, seen = core.clock, RATE_ONE
    while seen > 12 * slew:
        before = core.clock
        rate = read_word(channel, r.CHANNEL_RATE)
        count, rest = divmod(RATE_ONE - rate, slew)
        assert rest == 0 and rate < seen
        assert (before - begin) // core.tick <= count <= (core.clock - begin) // core.tick + 4
        seen = rate
    core.run((seen // slew + 2) * core.tick)
    pulses = core.steps(0)
    core.run(500)
    assert core.steps(0) == pulses


@core_test
def rate_slew_in_all_its_bits(core: Core) -> None:
    """A hold by each slew takes as many ticks as there are slews in 1.0."""
    channel = core.channel()
    core.watch(PinTiming())
    jog(core, channel, V_MAX)
    for slew in (LOW_BITS, HIGH_BITS):
        core.link.write(channel.base + r.CHANNEL_RATE_SLEW, slew)
        channel.set_rate(0)
        check_slowing(core, channel, slew)
        assert read_word(channel, r.CHANNEL_RATE) == 0
        core.link.write(channel.base + r.CHANNEL_RATE_SLEW, RATE_ONE)
        channel.set_rate(RATE_ONE)
        core.run(3 * core.tick)
        assert read_word(channel, r.CHANNEL_RATE) == RATE_ONE
    channel.abort()


@core_test
def stop_slew_in_all_its_bits(core: Core) -> None:
    """The same of a soft stop."""
    channel = core.channel()
    core.watch(PinTiming())
    for slew in (LOW_BITS, HIGH_BITS):
        core.link.write(channel.base + r.CHANNEL_STOP_SLEW, slew)
        jog(core, channel, V_MAX)
        channel.stop()
        check_slowing(core, channel, slew)
        check_stopped(core, channel, Cause.STOP)
        channel.clear()


@core_test
def rate_and_velocity_are_read_in_all_their_bits(core: Core) -> None:
    """The present values, to the last bit of the register."""
    channel = core.channel()
    core.watch(PinTiming())
    core.link.write(channel.base + r.CHANNEL_RATE_SLEW, RATE_ONE)
    jog(core, channel, V_MAX)
    for velocity, rate in (
        (V_MAX, 0xFFFF),
        (V_MAX - 1, 0x5555),
        (ONE // 3, RATE_ONE),
        (ONE // 6, 0xAAAA),
        (ONE // 5, 0),
    ):
        channel.set_rate(RATE_ONE)
        channel.ramps(Ramp(velocity, 0, now=True))
        core.run(5 * core.tick)
        channel.set_rate(rate)
        core.run(3 * core.tick)
        assert read_word(channel, r.CHANNEL_VELOCITY) == velocity >> 16
        assert read_word(channel, r.CHANNEL_RATE) == rate
    channel.abort()


@core_test
def step_counts_in_all_their_bits(core: Core) -> None:
    """Long lines in which a step less than N would put the first step a substep later."""
    channel = core.channel()
    checker = core.watch(PinTiming())
    ramps = [Ramp(ONE // 20, 0), Ramp(ONE // 20, 30), Ramp(0, 0, last=True)]
    for m, n in ((SUBSTEPS_MAX, 1 << 29), (SUBSTEPS_MAX - 1, (1 << 29) - 1), (SUBSTEPS_MAX, 1 << 29)):
        line = Line(m, (n, -n, n)[: core.axes], last=True)
        since = core.clock
        channel.lines(line)
        channel.ramps(*ramps)
        channel.start()
        core.run_until(core.is_running, 1000)
        core.run(2 * core.tick)
        channel.abort()
        core.run(100)
        begin = core.motions(0, since)[0][0]
        for axis, expected in enumerate(due([line], ramps, core.tick)):
            steps = [clock - begin for clock in core.steps(axis, since)]
            assert steps == expected[: len(steps)] and len(steps) > 10
        channel.clear()
        channel.rest()
    assert channel.positions() == checker.positions
