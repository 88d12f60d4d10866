# SPDX-License-Identifier: MIT
"""Encoders: counts and index through the pins, the following error and its stops, threading by a spindle."""

from collections.abc import Iterator
from itertools import pairwise
from math import ceil
from random import Random

import pytest
from passo import registers as r
from passo.host import RATE_ONE
from passo.link import RefusedError
from passo.registers import Cause, State, Verdict

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_moves import a_motion, check_stopped, clear_and_move
from cocotb_tests.helpers.core_shaft import Shafts, encoder_address, error, follow_word, positions

SPINDLE = 2  # the axis with its encoder
PER_TURN = 64
RATIO_ONE = 1 << 16
SOFT = 1 << r.ENCODER_SETUP_STOP_SOFT_LSB
HARD = 1 << r.ENCODER_SETUP_STOP_HARD_LSB
ZERO = 1 << r.CHANNEL_COMMAND_ZERO_LSB
FILTER = r.CHANNEL_ENCODER_FILTER_FILTER_RESET
# pin of an encoder to STEP: 7 + filter to the clock enable, 7 from there
LATENCY = 14 + FILTER


def compare_with_encoder(channel: CoreChannel, ratio: int, limit: int, action: int, axes: int = 3) -> None:
    """Set up the following error of some axes."""
    for axis in range(axes):
        channel.link.write(encoder_address(channel, axis, r.ENCODER_SETUP), action, ratio, limit)


def move(core: Core, channel: CoreChannel) -> None:
    """Start the standard motion."""
    lines, ramps = a_motion(core)
    channel.rest()
    channel.lines(*lines)
    channel.ramps(*ramps)
    channel.start()


@core_test
def an_encoder_that_follows_stops_nothing(core: Core) -> None:
    """2 counts per step, behind by the time they take: the error ends at 0."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core)
    compare_with_encoder(channel, 2 * RATIO_ONE, 16, HARD)
    for axis in range(core.axes):
        shafts.follow_steps(axis, 2, FILTER + 1)
    move(core, channel)
    core.wait_end()
    core.run(200)
    assert channel.state().cause == Cause.NONE
    made = channel.positions()
    assert positions(channel) == [2 * n for n in made] == shafts.at
    for axis in range(core.axes):
        assert error(channel, axis) == 0
        greatest, index = channel.link.read(encoder_address(channel, axis, r.ENCODER_GREATEST), 2)
        assert 2 <= greatest < 16
        state = r.EncoderIndexWord.unpack(index)
        assert state.illegal == 0
        if made[axis] * 2 >= 64:
            assert state.latch % 64 == 0 and state.indexes >= made[axis] * 2 // 64


@core_test
def a_lost_step_is_seen_within_the_limit(core: Core) -> None:
    """A shaft that slips by each 9th step: the channel is stopped as soon as the error is there, softly."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core)
    compare_with_encoder(channel, 2 * RATIO_ONE, 12, SOFT, 1)
    channel.link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE // 2)
    shafts.follow_steps(0, 2, FILTER + 1, slip=9)
    channel.lines(Line(10, (10, 3, 0), endless=True))
    channel.ramps(Ramp(ONE // 20, 2))
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 20_000)
    check_stopped(core, channel, Cause.FOLLOWING_ERROR)
    made = channel.positions()[0]
    # 6 lost steps are the limit, less what is on its way; the stop takes some more
    assert made >= 9 * 3 and error(channel, 0) == 2 * (made // 9) >= 8
    channel.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
    core.watch(PinTiming())
    channel.link.write(encoder_address(channel, 0, r.ENCODER_SETUP), 0)
    clear_and_move(core, channel)


@core_test
def an_encoder_that_is_not_connected_is_a_hard_stop(core: Core) -> None:
    """After as many steps as the limit, no step later than 9 clocks; recovery is ZERO, then CLEAR."""
    channel = core.channel()
    core.watch(PinTiming())
    compare_with_encoder(channel, RATIO_ONE, 20, HARD, 1)
    for _ in range(2):
        since = core.clock
        move(core, channel)
        core.run_until(lambda: core.dut.irq.value == 1, 20_000)
        check_stopped(core, channel, Cause.FOLLOWING_ERROR)
        steps = core.steps(0, since)
        assert steps[-1] <= steps[19] + 9
        # with CLEAR alone the next motion stops before its first step
        channel.clear()
        move(core, channel)
        core.run_until(lambda: core.dut.irq.value == 1, 2000)
        check_stopped(core, channel, Cause.FOLLOWING_ERROR)
        assert core.steps(0, since) == steps
        channel.link.write(channel.base + r.CHANNEL_COMMAND, ZERO)
        core.watch(PinTiming())
        assert channel.state().state == State.STOPPED and error(channel, 0) == 0
        channel.clear()
    channel.link.write(encoder_address(channel, 0, r.ENCODER_SETUP), 0)
    clear_and_move(core, channel)
    (greatest,) = channel.link.read(encoder_address(channel, 0, r.ENCODER_GREATEST), 1)
    assert r.EncoderGreatestWord.unpack(greatest).exceeded == (channel.positions()[0] >= 20)


@core_test
def lines_that_flicker_count_nothing(core: Core) -> None:
    """Noise on all lines at every clock, some clocks long: nothing is counted, a motion runs as always."""
    channel = core.channel()
    core.watch(PinTiming())
    random = rng("core, flicker")

    async def flicker() -> None:
        dut = core.dut
        for _ in range(6000):
            for pin in (dut.encoder_a, dut.encoder_b, dut.encoder_index):
                pin.value = random.randrange(8)
            await core.clocks.fall
            for pin in (dut.encoder_a, dut.encoder_b, dut.encoder_index):
                pin.value = 0
            for _ in range(random.randrange(1, FILTER)):
                await core.clocks.fall

    core.spawn(flicker)
    clear_and_move(core, channel)
    assert positions(channel) == [0, 0, 0]
    for axis in range(3):
        assert channel.link.read(encoder_address(channel, axis, r.ENCODER_INDEX), 1) == [0]


def spindle(random: Random, counts: int, clocks: int = 40) -> Iterator[tuple[int, int]]:
    """The counts, at a speed that varies by 30 %."""
    time = 0.0
    period = float(clocks)
    for _ in range(counts):
        period = min(clocks * 1.43, max(clocks / 1.3, period + random.uniform(-1, 1)))
        time += period
        yield int(time), 1
        time -= int(time)


def thread(channel: CoreChannel, per_count: int, ticks: int, tick: int) -> int:
    """Push a thread of axis 0 that lasts for some ticks of counts; return its steps."""
    steps = (ONE // 4 + per_count * ticks * tick) // ONE
    channel.lines(Line(steps, (steps, 0, 0), last=True))
    channel.ramps(Ramp(per_count, 0), Ramp(per_count, ticks, last=True))
    return steps


@core_test
def a_thread_has_its_pitch_and_its_phase_in_every_pass(core: Core) -> None:
    """Each step at its count after the index, to the clock, however the spindle wanders."""
    channel = core.channel()
    core.watch(PinTiming())
    random = rng("core, thread")
    shafts = Shafts(core, PER_TURN)
    shafts.turn(SPINDLE, spindle(random, 100_000))
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(SPINDLE, wait_index=True), 1 << 30)
    per_count = ONE * 3 // 7 + 12345
    for _ in range(3):
        since = core.clock
        channel.rest()
        steps = thread(channel, per_count, 4, core.tick)
        channel.start()
        core.wait_end(limit=200_000)
        made = core.steps(0, since)
        begin = core.motions(0, since)[-1][0]
        counts = shafts.counts[SPINDLE]
        index = max(clock for clock, at in counts if at % PER_TURN == 0 and clock < begin)
        after = [clock for clock, _ in counts if clock > index]
        due = [ceil((k - 0.25) * ONE / per_count) for k in range(1, steps + 1)]
        assert made == [after[n - 1] + LATENCY - 1 for n in due]
        (state,) = channel.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)
        assert r.ChannelFollowStateWord.unpack(state).behind == 0
    assert positions(channel)[SPINDLE] > 3 * 4 * core.tick


@core_test
def a_thread_waits_for_sync_and_then_for_the_index(core: Core) -> None:
    """However far they are apart; an index before sync starts nothing, and sync alone neither."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    shafts.turn(SPINDLE, ((40, 1) for _ in range(100_000)))
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(SPINDLE, wait_index=True), 1 << 30)
    turn = 40 * PER_TURN
    for phase in range(5):
        core.sync(False)
        channel.rest()
        thread(channel, ONE // 3, 2, core.tick)
        core.link.write(r.ADDRESS_RUN, 1 | 1 << r.RUN_WAIT_SYNC_LSB)
        core.run(2 * turn + phase * turn // 5)
        assert channel.state().state == State.ARMED
        edge = core.clock
        core.sync(True)
        core.run(50)
        core.sync(False)  # the edge counts, not the level
        core.started = edge
        core.wait_end()
        at_index = [clock for clock, at in shafts.counts[SPINDLE] if at % PER_TURN == 0 and clock > edge]
        assert 0 < core.began() - at_index[0] <= 2 * LATENCY, phase
    # an edge before the motion is prepared is none of its own
    channel.rest()
    core.sync(True)
    thread(channel, ONE // 3, 2, core.tick)
    core.link.write(r.ADDRESS_RUN, 1 | 1 << r.RUN_WAIT_SYNC_LSB)
    core.run(3 * turn)
    assert channel.state().state == State.ARMED


@core_test
def a_spindle_that_turns_back_repeats_nothing(core: Core) -> None:
    """The path waits until the spindle is where it was, then continues with the same counts."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    there_and_back = [1] * 200 + [-1] * 150 + [1] * 400 + [-1] * 30 + [1] * 800
    shafts.turn(1, ((20, n) for n in there_and_back))
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(1), 1 << 31)
    per_count = ONE // 5
    steps = thread(channel, per_count, 6, core.tick)
    channel.start()
    core.wait_end(limit=200_000)
    made = core.steps(0)
    assert len(made) == steps == channel.positions()[0]
    began, counts = core.began(), shafts.counts[1]
    first = next(n for n, (clock, _) in enumerate(counts) if clock + 7 + FILTER > began - 7 - 1)
    origin = counts[first - 1][1] if first else 0
    for k, clock in enumerate(made):
        place = ceil((k + 0.75) * ONE / per_count)
        reached = next(at_clock for at_clock, at in counts[first:] if at - origin == place)
        assert abs(clock - reached - LATENCY) <= 1, k


@core_test
def a_hold_keeps_the_phase(core: Core) -> None:
    """What was owed is made at the limit, with the flag; after that each step is at its count again."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    shafts.turn(SPINDLE, ((40, 1) for _ in range(100_000)))
    follow = follow_word(SPINDLE, wait_index=True)
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow, ONE // 20 >> 16)
    channel.link.write(channel.base + r.CHANNEL_RATE_SLEW, RATE_ONE)
    per_count = ONE * 2 // 5
    steps = thread(channel, per_count, 8, core.tick)
    channel.start()
    core.run_until(core.is_running, 20_000)
    core.run(4000)
    channel.set_rate(0)
    core.run(300)
    held = core.clock
    core.run(3000)
    assert not [clock for clock in core.steps(0) if clock > held]
    (state,) = channel.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)
    word = r.ChannelFollowStateWord.unpack(state)
    assert word.behind and not word.lost and word.owed > 60
    channel.set_rate(RATE_ONE)
    core.wait_end(limit=200_000)
    made = core.steps(0)
    began, counts = core.began(), shafts.counts[SPINDLE]
    index = max(clock for clock, at in counts if at % PER_TURN == 0 and clock < began)
    after = [clock for clock, _ in counts if clock > index]
    due = [after[ceil((k - 0.25) * ONE / per_count) - 1] for k in range(1, steps + 1)]
    late = [clock - on_time - LATENCY + 1 for clock, on_time in zip(made, due, strict=True)]
    assert min(late) == 0 and max(late) > 3000 and late[-100:] == [0] * 100
    # caught up with at the limit: a count in 20 clocks, so a step in 50
    assert min(b - a for a, b in pairwise(made)) >= 40


@core_test
def a_count_can_be_several_clocks(core: Core) -> None:
    """With scale 3 a count is worth 8: more than one step per count, spread at the limit."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    shafts.turn(SPINDLE, ((50, 1) for _ in range(100_000)))
    follow = follow_word(SPINDLE, scale=3, wait_index=True)
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow, ONE // 5 >> 16)
    per_count = ONE * 3 // 16  # 1.5 steps
    steps = thread(channel, per_count, 4, core.tick)
    channel.start()
    core.wait_end(limit=200_000)
    made = core.steps(0)
    began, counts = core.began(), shafts.counts[SPINDLE]
    index = max(clock for clock, at in counts if at % PER_TURN == 0 and clock < began)
    after = [clock for clock, _ in counts if clock > index]
    assert len(made) == steps
    for k, clock in enumerate(made, 1):
        advances = ceil((k - 0.25) * ONE / per_count)
        counted = after[(advances - 1) // 8]
        assert 0 <= clock - counted - LATENCY + 1 < 50, k


@core_test
def stops_of_a_motion_that_follows(core: Core) -> None:
    """STOP and ABORT, while it runs and while it waits for an index that never comes."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    channel.link.write(channel.base + r.CHANNEL_STOP_SLEW, RATE_ONE // 8)
    follow = channel.base + r.CHANNEL_FOLLOW
    # nothing is connected: it waits, at the index or at the first count
    for wait_index in (True, False):
        for stop, cause in ((channel.stop, Cause.STOP), (channel.abort, Cause.ABORT)):
            channel.rest()
            channel.link.write(follow, follow_word(SPINDLE, wait_index=wait_index))
            thread(channel, ONE // 3, 40, core.tick)
            channel.start()
            core.run(2000)
            assert channel.state().state == (State.ARMED if wait_index else State.RUN)
            with pytest.raises(RefusedError) as refusal:
                channel.link.write(follow, 0)
            assert refusal.value.verdict == Verdict.BUSY
            stop()
            core.run(1500)
            check_stopped(core, channel, cause)
            assert channel.positions()[0] == 0
            channel.clear()
    shafts.turn(SPINDLE, ((15, 1) for _ in range(100_000)))
    for stop, cause in ((channel.stop, Cause.STOP), (channel.abort, Cause.ABORT)):
        channel.rest()
        thread(channel, ONE // 3, 40, core.tick)
        channel.start()
        core.run(3000)
        assert channel.state().state == State.RUN
        stop()
        core.run(1500)
        check_stopped(core, channel, cause)
        channel.clear()
    # the axis of an encoder that does not exist, and back to the ramps
    channel.rest()
    channel.link.write(follow, follow_word(7))
    thread(channel, ONE // 3, 4, core.tick)
    channel.start()
    core.run(3000)
    assert channel.state().state == State.RUN
    channel.abort()
    check_stopped(core, channel, Cause.ABORT)
    channel.link.write(follow, 0)
    clear_and_move(core, channel)


@core_test
def a_lost_phase_is_a_stop(core: Core) -> None:
    """2^22 owed: the soft stop of a following error, and the flag stays until the next motion."""
    channel = core.channel()
    core.watch(PinTiming())
    shafts = Shafts(core, PER_TURN)
    shafts.turn(SPINDLE, ((FILTER + 1, 1) for _ in range(100_000)))
    channel.link.write(channel.base + r.CHANNEL_FOLLOW, follow_word(SPINDLE, scale=7), 1 << 20)
    thread(channel, ONE // 3, 40, core.tick)
    channel.start()
    core.run_until(lambda: core.dut.irq.value == 1, 200_000, 512)
    check_stopped(core, channel, Cause.FOLLOWING_ERROR)
    (state,) = channel.link.read(channel.base + r.CHANNEL_FOLLOW_STATE, 1)
    word = r.ChannelFollowStateWord.unpack(state)
    assert (word.owed, word.behind, word.lost) == (0, 1, 1)


@core_test
def resets_at_any_time(core: Core) -> None:
    """Shafts that turn through resets: the counts start again, and so does what follows them."""
    channel = core.channel()
    core.watch(PinTiming())
    random = rng("core, encoder resets")
    shafts = Shafts(core, 16)
    for axis in range(3):
        shafts.turn(axis, ((random.randint(1, 30), random.choice((1, 1, 1, -1, 2))) for _ in range(3000)))
    for _ in range(6):
        core.run(random.randint(100, 3000))
        core.reset(random.randint(1, 4))
        core.run(5)
        assert all(abs(n) < 100 for n in positions(channel))
