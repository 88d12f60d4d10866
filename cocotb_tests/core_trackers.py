# SPDX-License-Identifier: MIT
"""The second hand on every axis: trackers alone, and beside the path. The model agrees on every clock."""

import math
from dataclasses import dataclass

from passo import registers as r
from passo.registers import Cause, State

from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, CoreChannel, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_moves import clear_and_move

STEP = 1 << 32  # UQ0.32
TURN = 32  # clocks
LATE = 3  # ticks above the optimum, at most


@dataclass
class Trackers:
    """The trackers of a channel."""

    channel: CoreChannel

    @property
    def tick(self) -> int:
        """Clocks."""
        return TURN * (8 if self.channel.core.axes > 4 else 4)

    def limit(self, axis: int, speed: int, acceleration: int) -> None:
        """Set the limits of an axis, in 2^-32 steps per tick (and per tick)."""
        address = self.channel.axis_base(axis) + r.AXIS_TRACKER_SPEED
        self.channel.link.write(address, speed, acceleration)

    def go(self, *targets: int, backlash: int = 0) -> None:
        """Set the targets of the first axes; going down the axis goes `backlash` further."""
        link, base = self.channel.link, self.channel.base
        link.write(base + r.CHANNEL_TRACKER_TARGET_BASE, *(target % STEP for target in targets))
        down = [(target - backlash) % STEP for target in targets]
        link.write(base + r.CHANNEL_TRACKER_TARGET_DOWN_BASE, *down)

    def enable(self, axes: int = 0xFF) -> None:
        """Enable the trackers of some axes, as bits."""
        self.channel.link.write(self.channel.base + r.CHANNEL_TRACKER_ENABLE, axes)

    def state(self) -> r.ChannelTrackerStateWord:
        """Read TRACKER_STATE."""
        (word,) = self.channel.link.read(self.channel.base + r.CHANNEL_TRACKER_STATE, 1)
        return r.ChannelTrackerStateWord.unpack(word)

    def positions(self) -> list[int]:
        """Read the steps that are the trackers'."""
        core = self.channel.core
        words = self.channel.link.read(self.channel.base + r.CHANNEL_TRACKER_POSITION_BASE, core.axes)
        return [word - (word >> 31 << 32) for word in words]

    def wait(self, clocks: int = 400_000) -> None:
        """Wait until all pins rest."""
        self.channel.core.run_until(lambda: self.channel.state().quiet, clocks)


def begin(core: Core, timing: PinTiming = PinTiming()) -> Trackers:  # noqa: B008
    """Enabled drives with these timings."""
    channel = core.channel()
    core.watch(timing)
    channel.pins(timing)
    return Trackers(channel)


def ticks_of(distance: int, speed: int, acceleration: int) -> float:
    """Ticks of the fastest way, in steps of 2^-32."""
    if distance * acceleration < speed * speed:
        return 2 * math.sqrt(distance / acceleration)
    return distance / speed + speed / acceleration


@core_test
def lands_on_its_target(core: Core) -> None:
    """Alone, an axis makes exactly its steps, in nearly the shortest time, and never more."""
    trackers, random = begin(core), rng("lands_on_its_target")
    positions = [0] * core.axes
    for _ in range(16):
        axis = random.randrange(core.axes)
        acceleration = int(2 ** random.uniform(22, 31))
        speed = min(STEP - 1, int(acceleration * 2 ** random.uniform(0, 7)))
        steps = random.choice([1, -1]) * int(2 ** random.uniform(0, 7))
        if ticks_of(abs(steps) * STEP, speed // acceleration * acceleration, acceleration) > 1000:
            continue
        trackers.limit(axis, speed, acceleration)
        was = positions[axis]
        positions[axis] += steps
        trackers.enable(0)
        trackers.go(*positions)
        begun = core.clock
        trackers.enable(1 << axis)
        trackers.wait()
        state = trackers.state()
        assert (state.moves, state.at_target >> axis & 1) == (0, 1)
        assert trackers.positions() == trackers.channel.positions() == positions
        edges = core.steps(axis, begun)
        assert len(edges) == abs(steps), (was, steps)
        top = speed // acceleration * acceleration
        most = (ticks_of(abs(steps) * STEP, top, acceleration) + LATE) * trackers.tick
        assert edges[-1] - edges[0] <= most


@core_test
def rests_below_its_acceleration(core: Core) -> None:
    """With a speed that no multiple of the acceleration fits into, wherever it rests and is to go."""
    trackers, random = begin(core), rng("rests_below_its_acceleration")
    for _ in range(20):
        speed = random.randrange(1 << 28, 1 << 30)
        trackers.limit(0, speed, speed // random.randrange(1, 5))
        at = trackers.positions()[0]
        trackers.go(at + random.choice((20, -20)))
        trackers.enable(1)
        core.run(random.randrange(4000))
        trackers.enable(0)
        trackers.wait()
        since, rest = core.clock, trackers.positions()[0]
        acceleration = random.randrange(1 << 31, 1 << 32)
        trackers.limit(0, random.choice((0, 1, acceleration - 1)), acceleration)
        for target in (rest, rest + 1, rest - 1):
            trackers.go(target)
            trackers.enable(1)
            core.run(6 * trackers.tick)
            trackers.enable(0)
        assert core.steps(0, since) == []


@core_test
def follows_targets_that_jump(core: Core) -> None:
    """Targets change at any time; at the end each axis is at its last one."""
    trackers, random = begin(core), rng("follows_targets_that_jump")
    for axis in range(core.axes):
        trackers.limit(axis, STEP // 3, STEP // 100)
    trackers.enable()
    targets = [0] * core.axes
    for _ in range(60):
        targets[random.randrange(core.axes)] = random.randint(-300, 300)
        trackers.go(*targets, backlash=random.choice([0, 3]))
        core.run(int(2 ** random.uniform(4, 13)))
        if random.random() < 0.1:
            trackers.enable(random.randrange(8))
            core.run(random.randrange(3000))
            trackers.enable()
    trackers.go(*targets)
    trackers.wait()
    assert trackers.positions() == trackers.channel.positions() == targets


@core_test
def joins_the_path(core: Core) -> None:
    """Path and trackers move the axes together: positions are the sums."""
    timing = PinTiming(high=6, low=6, setup=9, hold=5)
    trackers, random = begin(core, timing), rng("joins_the_path")
    channel = trackers.channel
    for axis in range(core.axes):
        trackers.limit(axis, STEP // 2, STEP // 50)
    targets = [0] * core.axes
    path = [0] * core.axes
    trackers.enable()
    for _ in range(5):
        substeps = random.randint(200, 2000)
        lines = []
        for last in (False, False, True):
            steps = tuple(
                random.choice([0, substeps, -substeps, substeps // 3, -substeps // 7]) for _ in path
            )
            lines.append(Line(substeps, steps, last=last))
            path = [was + step for was, step in zip(path, steps, strict=True)]
        ticks = 3 * substeps * random.choice([30, 60, 200]) // core.tick + 1
        channel.lines(*lines)
        velocity = 3 * substeps * ONE // (ticks * core.tick)
        channel.ramps(Ramp(velocity, 0), Ramp(velocity, ticks, last=True))
        channel.start()
        core.run_until(lambda: bool(core.is_running()) or channel.state().state == State.STOPPED, 4000)
        while core.is_running():
            targets[random.randrange(core.axes)] = random.randint(-200, 200)
            trackers.go(*targets)
            core.run(int(2 ** random.uniform(6, 12)))
        core.run_until(lambda: channel.state().state == State.IDLE, 400_000)
        trackers.wait()
        assert channel.state().cause == Cause.NONE
        assert trackers.positions() == targets
        assert channel.positions() == [a + b for a, b in zip(path, targets, strict=True)]
    assert core.checker is not None
    assert core.checker.positions == channel.positions()


@core_test
def takes_up_backlash(core: Core) -> None:
    """When the path turns an axis, its tracker goes by the backlash; the path does not stop."""
    trackers = begin(core, PinTiming(high=4, low=4, setup=5, hold=3))
    channel = trackers.channel
    trackers.limit(0, STEP // 4, STEP // 40)
    trackers.go(0, backlash=7)
    trackers.enable(1)
    zeros = (0,) * (core.axes - 1)
    for substeps, expected in ((100, 100), (-50, 50 - 7), (-10, 40 - 7), (30, 70)):
        channel.lines(Line(abs(substeps), (substeps, *zeros), last=True))
        ticks = abs(substeps) * 100 // core.tick
        velocity = abs(substeps) * ONE // (ticks * core.tick)
        channel.ramps(Ramp(velocity, 0), Ramp(velocity, ticks, last=True))
        channel.start()
        core.run_until(lambda: channel.state().state == State.IDLE, 400_000)
        trackers.wait()
        assert channel.positions()[0] == expected


@core_test
def stops_with_the_channel(core: Core) -> None:
    """A soft stop slows the tracker down, a hard one ends it; it moves no more until it is enabled again."""
    trackers, random = begin(core, PinTiming(high=4, low=4)), rng("stops_with_the_channel")
    channel = trackers.channel
    trackers.limit(0, STEP // 4, STEP // 400)
    target = 0
    for _ in range(10):
        target += 500
        trackers.go(target)
        trackers.enable(1)
        core.run(random.randrange(500, 40_000))
        hard = random.random() < 0.5
        (channel.abort if hard else channel.stop)()
        core.run_until(lambda: channel.state().state == State.STOPPED, 400_000)
        stopped = core.clock
        assert channel.state().cause == (Cause.ABORT if hard else Cause.STOP)
        core.run(20_000)
        assert not core.steps(0, stopped + 100)
        assert trackers.state().enabled == 0
        channel.clear()
        core.run(20_000)
        assert not core.steps(0, stopped + 100)
        assert channel.state().quiet
        off = abs(channel.positions()[0] - trackers.positions()[0])
        assert off <= (7 if hard else 0)
        channel.link.write(channel.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB)
        core.run(2000)
        assert channel.positions()[0] == trackers.positions()[0] == 0
        target = 0
    clear_and_move(core, channel)
