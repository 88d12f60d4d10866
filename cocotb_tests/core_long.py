# SPDX-License-Identifier: MIT
"""Tests that take hundreds of thousands of clocks: the longest pin timings and a counter that wraps."""

from passo import registers as r
from passo.registers import Cause, State

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import V_MAX, Core, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_expected import distance

TIME_MAX = 0xFFFF
COUNTED = 1 << 15  # drained substeps, modulo


@core_test
def pin_timings_in_all_their_bits(core: Core) -> None:
    """Each bit of each of the four times of each axis, set and not set, at a step and one back."""
    random = rng("pin_timings_in_all_their_bits")
    channel = core.channel()
    numbers = [(random.getrandbits(16), random.getrandbits(16)) for _ in range(core.axes)]
    direction = 1
    for inverted in (0, TIME_MAX):
        timings = [
            PinTiming(a ^ inverted, a ^ inverted ^ TIME_MAX, b ^ inverted, b ^ inverted ^ TIME_MAX)
            for a, b in numbers
        ]
        channel.pins(*timings)
        channel.rest()
        channel.lines(
            Line(1, (direction,) * core.axes),
            Line(1, (-direction,) * core.axes, last=True),
        )
        channel.ramps(Ramp(V_MAX, 0), Ramp(V_MAX, 1), Ramp(0, 0, last=True))
        since = core.clock
        channel.start()
        core.wait_end()
        core.run(2 * TIME_MAX)
        for axis, timing in enumerate(timings):
            first, second = core.steps(axis, since)
            falls = [clock for clock, level in core.changes("step", axis, since) if not level]
            ((turn, _),) = core.changes("dir", axis, since)
            assert falls[0] - first == timing.high
            assert turn - falls[0] == timing.low + timing.hold
            assert second - turn == timing.setup
        channel.times(PinTiming())  # the second pulse ends soon
        core.run(100)
        direction = -direction
    assert channel.positions() == [0] * core.axes


@core_test
def drained_substeps_are_counted_modulo_32768(core: Core) -> None:
    """A line that lacks this many: all are made at drain_velocity, every second clock, with their steps."""
    channel = core.channel()
    core.watch(PinTiming())
    core.link.write(channel.base + r.CHANNEL_DRAIN_VELOCITY, 1 << 31)
    ramps = [Ramp(V_MAX, 0), Ramp(V_MAX, 2), Ramp(0, 0, last=True)]
    missing = COUNTED + 1234
    total = distance(ramps, core.tick) + missing
    line = Line(total, (total // 3, -7, 1)[: core.axes], last=True)
    channel.lines(line)
    channel.ramps(*ramps)
    channel.start()
    core.run_until(core.is_running, 1000)
    for _ in range(4):
        core.run(COUNTED // 2)
        selected = core.clock
        state = channel.state()
        # chip select, request and the rest of the frame lie between
        made = (selected - core.began()) // 2 - distance(ramps, core.tick)
        assert state.state == State.DRAIN
        assert 0 < (state.drained - made) % COUNTED < 1000
    core.run_until(lambda: not core.is_running(), 3 * COUNTED)
    core.run(200)
    state = channel.state()
    assert (state.state, state.cause, state.drained) == (State.IDLE, Cause.NONE, missing % COUNTED)
    assert channel.positions() == list(line.steps)
