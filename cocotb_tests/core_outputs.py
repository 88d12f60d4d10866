# SPDX-License-Identifier: MIT
"""Outputs bound to the path, seen from the pins: with the steps, in proportion to the speed, off at rest."""

from collections.abc import Sequence
from itertools import pairwise

import pytest
from passo import registers as r
from passo.host import RATE_ONE
from passo.registers import Cause, LineOutputWord, State, Verdict

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_frames import verdict

FULL = 65535
AT_ONCE = RATE_ONE
PERIOD = 1 << 24  # of the PWM, in units of PWM_STEP
SETTINGS = range(r.CHANNEL_OUTPUT_LEVELS, r.CHANNEL_COMPARE_INTERVAL + 1)


def output(
    levels: int = 0, power: int = 0, *, proportional: bool = False, raster: bool = False
) -> LineOutputWord:
    """The output word of a line."""
    return LineOutputWord(levels=levels, power=power, proportional=proportional, raster=raster)


def begin(core: Core, **settings: int) -> CoreChannel:
    """A channel with fast pins and these settings of its outputs."""
    channel = core.channel()
    core.watch(PinTiming())
    channel.configure_motion(AT_ONCE, AT_ONCE, 1 << 28)
    for name, value in settings.items():
        set_output(channel, name, value)
    return channel


def set_output(channel: CoreChannel, name: str, value: int) -> None:
    """Write a register of the outputs."""
    channel.link.write(channel.base + getattr(r, f"CHANNEL_{name.upper()}"), value % (1 << 32))


def move(channel: CoreChannel, lines: Sequence[Line], outputs: Sequence[LineOutputWord], ticks: int) -> int:
    """Make lines at full speed, in this time or until they end; return the clock before they began."""
    core = channel.core
    since = core.clock
    channel.lines(*lines, outputs=outputs)
    channel.ramps(Ramp(ONE // 2, 0), Ramp(ONE // 2, ticks), Ramp(0, 0, last=True))
    channel.start()
    core.wait_end()
    channel.rest()
    return since


def wait_stopped(channel: CoreChannel) -> None:
    """Until the channel has stopped."""
    channel.core.run_until(lambda: channel.state().state == State.STOPPED, 60_000)
    channel.core.run(20)


def levels_at(core: Core, signal: str, bit: int, since: int, clocks: Sequence[int]) -> list[int]:
    """Levels of an output after these clocks."""
    changes = core.changes(signal, bit, since)
    before = core.changes(signal, bit)
    start = before[-len(changes) - 1][1] if len(before) > len(changes) else 0
    found = []
    for clock in clocks:
        past = [level for at, level in changes if at <= clock]
        found.append(past[-1] if past else start)
    return found


def high_clocks(core: Core, signal: str, since: int, until: int) -> int:
    """For how many of these clocks an output is high."""
    edges = [(since, levels_at(core, signal, 0, since - 1, [since])[0])]
    edges += [(at, level) for at, level in core.changes(signal, 0, since) if at < until]
    ends = [at for at, _ in edges[1:]] + [until]
    return sum(end - at for (at, level), end in zip(edges, ends, strict=True) if level)


@core_test
def outputs_change_with_the_first_step_of_their_line(core: Core) -> None:
    """On the clock of the STEP pin plus the lag, whatever the length of the lines: also of one substep."""
    random = rng("core outputs, lag")
    for lag in (0, 1, 5, 40, 3000):
        channel = begin(core, output_lag=lag)
        sizes = [random.choice((1, 1, 2, 3, 20)) for _ in range(15)]
        words = [output(random.randrange(256)) for _ in sizes]
        lines = [Line(m, (m, 0, 0), last=i == 14) for i, m in enumerate(sizes)]
        since = move(channel, lines, words, 1 + 2 * sum(sizes) // core.tick)
        core.run(lag + 20)
        steps = core.steps(0, since)
        assert len(steps) == sum(sizes)
        firsts = [steps[sum(sizes[:i])] for i in range(len(sizes))]
        for bit in range(8):
            wanted = [word.levels >> bit & 1 for word in words]
            expected, now = [], levels_at(core, "outputs", bit, since, [since])[0]
            for clock, level in zip(firsts, wanted, strict=True):
                if level != now:
                    expected.append((clock + lag, level))
                now = level
            assert core.changes("outputs", bit, since) == expected
        assert channel.state().quiet


@core_test
def power_begins_with_the_first_step_and_ends_with_the_motion(core: Core) -> None:
    """On the clock of the STEP pin; off between; with power 0 in the middle."""
    channel = begin(core)
    lines = [Line(50, (50, 0, 0)), Line(50, (50, 0, 0)), Line(60, (60, 0, 0), last=True)]
    since = move(channel, lines, [output(power=FULL), output(), output(power=FULL)], 3)
    steps = core.steps(0, since)
    ((_, end),) = core.motions(0, since)
    assert core.changes("power", 0, since) == [(steps[0], 1), (steps[50], 0), (steps[100], 1), (end, 0)]
    # no power from the last motion in the next one
    since = move(channel, [Line(50, (50, 0, 0), last=True)], [output()], 1)
    assert core.changes("power", 0, since) == []


@core_test
def power_is_off_with_every_stop_on_its_clock(core: Core) -> None:
    """Abort, underrun, step overrun, and a soft stop at its end."""
    for cause in (Cause.ABORT, Cause.STOP, Cause.LINE_UNDERRUN, Cause.STEP_OVERRUN, Cause.RAMP_UNDERRUN):
        channel = begin(core)
        if cause == Cause.STEP_OVERRUN:
            core.finish_watch()
            channel.pins(PinTiming(40, 40, 1, 1))
        line = Line(400, (200, 0, 0), endless=cause in (Cause.ABORT, Cause.STOP), last=False)
        if cause == Cause.RAMP_UNDERRUN:
            line = Line(100_000, (50_000, 0, 0), last=True)
        since = core.clock
        channel.lines(line, outputs=[output(5, FULL)])
        channel.ramps(Ramp(ONE // 8, 0), Ramp(ONE // 8, 30 if cause == Cause.RAMP_UNDERRUN else 300))
        channel.start()
        if cause in (Cause.ABORT, Cause.STOP):
            core.run(3000)
            channel.abort() if cause == Cause.ABORT else channel.stop()
        wait_stopped(channel)
        assert channel.state().cause == cause
        ((_, end),) = core.motions(0, since)
        (_, on), (off, off_level) = core.changes("power", 0, since)
        assert (on, off, off_level) == (1, end, 0)
        core.run(2000)
        assert len(core.changes("power", 0, since)) == 2
        assert channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)[0] & 0xFF == 5
        channel.rest()
        channel.clear()
        channel.pins(PinTiming())
        set_output(channel, "output_levels", 0)


@core_test
def power_is_off_in_a_hold(core: Core) -> None:
    """In both modes, until the motion continues."""
    channel = begin(core)
    for proportional in (False, True):
        since = core.clock
        channel.lines(
            Line(10, (10, 0, 0), endless=True), outputs=[output(power=FULL, proportional=proportional)]
        )
        channel.ramps(Ramp(ONE // 2, 0), Ramp(ONE // 2, 4000))
        channel.start()
        core.run(5000)
        for _ in range(2):
            channel.set_rate(0)
            core.run(600)
            held = core.clock
            core.run(3000)
            assert core.steps(0, held) == [] and core.changes("power", 0, held) == []
            assert levels_at(core, "power", 0, since, [core.clock]) == [0]
            channel.set_rate(RATE_ONE)
            core.run(2000)
            assert levels_at(core, "power", 0, since, [core.clock]) == [1]
        channel.abort()
        core.run(50)
        channel.rest()
        channel.clear()


@core_test
def energy_per_step_is_the_same_at_every_speed(core: Core) -> None:
    """Clocks with power per step: within 1 % from 5 % to 100 % of the speed, through holds."""
    channel = begin(core, pwm_step=PERIOD // 50, power_reference=1 << 31)
    channel.configure_motion(1600, AT_ONCE, 1 << 28)
    channel.lines(Line(10, (10, 0, 0), endless=True), outputs=[output(power=50_000, proportional=True)])
    channel.ramps(Ramp(ONE // 2, 20), Ramp(ONE // 2, 1 << 20))
    channel.start()
    core.run(10_000)
    ideal = 2 * 50_001 / 65536

    def energy(since: int) -> float:
        steps = core.steps(0, since)
        return high_clocks(core, "power", steps[0], steps[-1]) / (len(steps) - 1)

    for percent in (100, 50, 23, 5):
        channel.set_rate(RATE_ONE * percent // 100)
        core.run(6000)
        since = core.clock
        core.run(20_000 if percent > 20 else 60_000)
        assert energy(since) == pytest.approx(ideal, rel=0.01), percent
    # down to a hold, up again, several times: slews of 41 ticks
    since = core.clock
    for _ in range(3):
        channel.set_rate(RATE_ONE)
        core.run(12_000)
        channel.set_rate(0)
        core.run(12_000)
    channel.set_rate(RATE_ONE)
    core.run(12_000)
    assert energy(since) == pytest.approx(ideal, rel=0.01)
    channel.set_rate(RATE_ONE)
    channel.ramps(Ramp(ONE // 40, 200, now=True), Ramp(ONE // 40, 1 << 20))
    core.run(1000)
    since = core.clock
    core.run(24_000)
    assert energy(since) == pytest.approx(ideal, rel=0.01)
    core.run(10_000)
    since = core.clock
    core.run(60_000)
    assert energy(since) == pytest.approx(ideal, rel=0.01)
    channel.abort()


@core_test
def raster_values_change_on_their_exact_step(core: Core) -> None:
    """Every substep a step: value k with the step k * pitch; a line begins a word."""
    random = rng("core outputs, raster")
    channel = begin(core)
    for pitch in (1, 2, 3, 7):
        set_output(channel, "raster_pitch", pitch)
        rows = [[random.choice((0, 255)) for _ in range(random.randrange(1, 14))] for _ in range(6)]
        words = []
        for row in rows:
            padded = bytes(row + [255] * (-len(row) % 4))
            words += [int.from_bytes(padded[i : i + 4], "little") for i in range(0, len(padded), 4)]
        channel.link.push(channel.base + r.CHANNEL_RASTER, words)
        sizes = [pitch * len(row) - random.randrange(pitch) for row in rows]
        lines = [Line(m, (m, 0, 0), last=i == 5) for i, m in enumerate(sizes)]
        outputs = [output(i, raster=True) for i in range(6)]
        since = move(channel, lines, outputs, 1 + 2 * sum(sizes) // core.tick)
        steps = core.steps(0, since)
        assert len(steps) == sum(sizes)
        values = [row[n // pitch] for row, m in zip(rows, sizes, strict=True) for n in range(m)]
        assert levels_at(core, "power", 0, since, steps) == [value // 255 for value in values]
        (state,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
        # the last word has a place until another line begins
        assert state >> r.CHANNEL_OUTPUT_STATE_RASTER_ROOM_LSB == 256 - (len(rows[-1]) % 4 != 0)
        assert not state >> r.CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB & 1


@core_test
def an_empty_raster_never_stalls(core: Core) -> None:
    """Power 0 and a flag, all steps in time."""
    channel = begin(core, raster_pitch=2)
    channel.link.push(channel.base + r.CHANNEL_RASTER, [0xFFFFFFFF])
    since = move(channel, [Line(60, (60, 0, 0), last=True)], [output(raster=True)], 1)
    steps = core.steps(0, since)
    assert [b - a for a, b in pairwise(steps)] == [2] * 59
    assert levels_at(core, "power", 0, since, steps) == [1] * 8 + [0] * 52
    (state,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    assert state >> r.CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB & 1
    channel.clear()
    (state,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    assert not state >> r.CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB & 1


@core_test
def compare_pulses_with_the_step_onto_its_point(core: Core) -> None:
    """On the clock of the STEP pin; there and back, each point once."""
    channel = begin(core, compare_pulse=1 << 16 | 3, compare_distance=4, compare_interval=5)
    lines = [Line(20, (20, 10, 0)), Line(20, (-20, -20, 0)), Line(60, (60, 60, 0), last=True)]
    since = move(channel, lines, [], 2)
    position, points = 0, [4 + 5 * n for n in range(11)]
    edges = iter(core.steps(1, since))
    expected = []
    for step in [1] * 10 + [-1] * 20 + [1] * 60:
        clock = next(edges)
        position += step
        if position == points[0]:
            expected.append(clock)
            del points[0]
    assert position == 50
    rises = [clock for clock, level in core.changes("compare", 0, since) if level]
    falls = [clock for clock, level in core.changes("compare", 0, since) if not level]
    assert rises == expected and falls == [clock + 3 for clock in expected]


@core_test
def bad_settings_are_refused(core: Core) -> None:
    """With BAD_VALUE; with BUSY what needs a quiet channel; and a bad output word with its line."""
    channel = begin(core)
    bad = {
        r.CHANNEL_OUTPUT_LEVELS: (256,),
        r.CHANNEL_OUTPUT_LAG: (65536,),
        r.CHANNEL_PWM_STEP: (0, (1 << 23) + 1, 1 << 24),
        r.CHANNEL_POWER_REFERENCE: (0, (1 << 31) + 1),
        r.CHANNEL_RASTER_PITCH: (0, 1 << 30),
        r.CHANNEL_COMPARE_PULSE: (core.axes << 16, 1 << 19),
        r.CHANNEL_COMPARE_INTERVAL: (0,),
    }
    for address, values in bad.items():
        for value in values:
            assert verdict(channel, address, value) == Verdict.BAD_VALUE, (address, value)
    line = Line(9, (9, 0, 0), last=True).words()
    for word in (1 << 26, 1 << 25 | 1, 1 << 25 | 1 << 15, 1 << 31):
        assert verdict(channel, r.CHANNEL_LINE, *line, word, push=True) == Verdict.BAD_VALUE
    assert verdict(channel, r.CHANNEL_LINE, *line, push=True) == Verdict.BAD_LENGTH
    channel.lines(Line(9, (9, 0, 0), endless=True), outputs=[output(power=9)])
    channel.ramps(Ramp(ONE // 4, 3), Ramp(ONE // 4, 100_000))
    channel.start()
    core.run(1000)
    for address in SETTINGS:
        busy = address in (
            *(r.CHANNEL_OUTPUT_LEVELS, r.CHANNEL_OUTPUT_LAG),
            *(r.CHANNEL_COMPARE_PULSE, r.CHANNEL_COMPARE_DISTANCE),
        )
        assert verdict(channel, address, 1) == (Verdict.BUSY if busy else Verdict.OK), address
    for n in range(5):
        wanted = Verdict.QUEUE_FULL if n == 4 else Verdict.OK
        assert verdict(channel, r.CHANNEL_RASTER, *[0] * 60, push=True) == wanted
    channel.abort()
    core.run(20)
    assert verdict(channel, r.CHANNEL_RASTER, 0, push=True) == Verdict.BUSY
    channel.clear()
    assert verdict(channel, r.CHANNEL_RASTER, 0, push=True) == Verdict.OK


@core_test
def a_motion_has_the_outputs_of_its_own_lines(core: Core) -> None:
    """With a lag longer than the lines, and the next motion queued: nothing of the last one comes in it."""
    random = rng("core outputs, own lines")
    lag = 2000
    channel = begin(core, output_lag=lag)
    before = 0
    for number in range(8):
        words = [output(random.randrange(256), random.choice((0, FULL))) for _ in range(6)]
        since = core.clock
        for first in range(0, 6, 3):  # two motions of 3 lines
            channel.lines(*[Line(40, (40, 0, 0), last=i == 2) for i in range(3)], outputs=words[first:][:3])
            channel.ramps(Ramp(ONE // 2, 0), Ramp(ONE // 2, 2 + 20 * (number % 2)), Ramp(0, 0, last=True))
        channel.start()
        core.run_until(lambda began=since: len(core.motions(0, began)) == 2, 30_000)
        channel.rest()
        core.run(lag + 300)
        assert channel.state().quiet
        steps = core.steps(0, since)
        for first, (begins, ends) in zip((0, 3), core.motions(0, since), strict=True):
            own = [step + lag for step in steps if begins <= step <= ends][::40]
            at = [begins, *(clock for clock in own if clock < ends)]
            levels = [before, *(word.levels for word in words[first:][:3])]
            powers = [0, *(int(word.power > 0) for word in words[first:][:3])]
            for begin_of, end_of, level, power in zip(at, [*at[1:], ends], levels, powers, strict=False):
                clocks = [begin_of, end_of - 1]
                shown = [levels_at(core, "outputs", bit, since, clocks) for bit in range(8)]
                assert shown == [[level >> bit & 1] * 2 for bit in range(8)]
                assert high_clocks(core, "power", begin_of, end_of) == power * (end_of - begin_of)
            before = words[first + 2].levels


@core_test
def levels_are_set_at_rest(core: Core) -> None:
    """Immediately; a line then changes them; a reset clears them."""
    channel = begin(core)
    set_output(channel, "output_levels", 0xA5)
    core.run(10)
    (state,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    assert state & 0xFF == 0xA5
    move(channel, [Line(9, (9, 0, 0), last=True)], [output(0x5A)], 1)
    (state,) = channel.link.read(channel.base + r.CHANNEL_OUTPUT_STATE, 1)
    assert state & 0xFF == 0x5A
    core.reset(3)
    core.run(5)
    assert [levels_at(core, "outputs", bit, 0, [core.clock]) for bit in range(8)] == [[0]] * 8


@core_test
def anything_at_any_time_is_as_in_the_model(core: Core) -> None:
    """Random lines, outputs, settings, holds and stops; every clock of all pins is compared."""
    random = rng("core outputs, random")
    channel = begin(core)
    for _ in range(15):
        for address in SETTINGS:
            if random.random() < 0.5:
                value = random.choice((1, 2, 50, random.getrandbits(random.randrange(1, 24))))
                verdict(channel, address, value)
        verdict(channel, r.CHANNEL_RASTER, *[random.getrandbits(32) for _ in range(9)], push=True)
        sizes = [random.choice((1, 2, 7, 100, 500)) for _ in range(random.randrange(1, 9))]
        lines, words = [], []
        for i, m in enumerate(sizes):
            steps = tuple(random.choice((-1, 1)) * random.randrange(m + 1) for _ in range(core.axes))
            lines.append(Line(m, steps, last=i == len(sizes) - 1))
            raster = random.random() < 0.3
            power = 0 if raster else random.choice((0, FULL, random.randrange(65536)))
            proportional = random.random() < 0.5
            words.append(output(random.randrange(256), power, proportional=proportional, raster=raster))
        channel.lines(*lines, outputs=words)
        speed = ONE // random.choice((2, 3, 20))
        ticks = random.randrange(5), random.randrange(40)
        channel.ramps(Ramp(speed, ticks[0]), Ramp(speed, ticks[1]), Ramp(0, 5, last=True))
        channel.start()
        for _ in range(random.randrange(4)):
            core.run(random.randrange(3000))
            act = random.random()
            if act < 0.5:
                channel.set_rate(random.choice((0, RATE_ONE // 3, RATE_ONE)))
            elif act < 0.6:
                channel.abort()
            elif act < 0.7:
                channel.stop()
            else:
                verdict(channel, random.choice(SETTINGS), random.getrandbits(20))
        channel.set_rate(RATE_ONE)
        core.run(20_000)
        channel.abort()
        core.run(300)
        channel.rest()
        verdict(channel, r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_CLEAR_LSB)
