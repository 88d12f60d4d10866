# SPDX-License-Identifier: MIT
"""Random moves, planned and raw, with random pins, chained, held and overridden: all steps, in time.

PASSO_SEED is the seed, SESSIONS the number of sessions of 25 motions.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from random import Random

from passo import registers as r
from passo.host import RATE_ONE
from passo.link import RefusedError
from passo.move_forms import PROFILES
from passo.moves import MoveBySpeed, MoveInTime
from passo.plan import PlanError, plan_move
from passo.registers import Cause, State

from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.core_bench import (
    V_MAX,
    Core,
    CoreChannel,
    Line,
    PinTiming,
    Ramp,
    Shape,
    core_test,
    planned,
)
from cocotb_tests.helpers.core_expected import distance

SESSIONS = int(os.environ.get("SESSIONS", "4"))
MOTIONS = 25
MANY = 24  # substeps of a line, so that it lasts until the next one has arrived


@dataclass
class Motion:
    """Lines and ramps of a motion, and its expected result."""

    lines: list[Line]
    ramps: list[Ramp]
    moves: int
    drained: int = 0
    disturbed: bool = False

    @property
    def ticks(self) -> int:
        """Length of its profile."""
        return sum(ramp.ticks for ramp in self.ramps)


@dataclass
class Axes:
    """A channel as the random host sees it."""

    channel: CoreChannel
    timings: list[PinTiming]
    velocity: int  # substeps per clock that the pins can follow
    pending: list[Motion] = field(default_factory=list)
    up: list[int] = field(default_factory=list)
    down: list[int] = field(default_factory=list)
    drained: int = 0

    def has_room_for(self, motion: Motion) -> bool:
        """Whether the queues can accept it, whatever is still in them."""
        parameters = self.channel.parameters
        motions = [*self.pending, motion]
        lines = sum(len(each.lines) for each in motions)
        ramps = sum(len(each.ramps) for each in motions)
        return lines <= 1 << parameters.line_queue_log2 and ramps <= 1 << parameters.ramp_queue_log2


class Session:
    """A host that makes random motions on all channels of a core."""

    def __init__(self, core: Core, random: Random):
        self.core, self.random = core, random
        self.moves = 0
        self.axes = [self._set_up(number) for number in range(core.parameters.channels)]
        timings = [timing for axes in self.axes for timing in axes.timings]
        self.checker = core.watch(*timings)
        self.before = [0] * len(timings)
        self.batch = core.clock
        self.go(every=True)

    def _set_up(self, number: int) -> Axes:
        random, core = self.random, self.core
        channel = core.channel(number)
        if random.random() < 0.3:
            timings = [PinTiming()] * core.axes
        else:
            timings = [self._timing() for _ in range(core.axes)]
        channel.pins(*timings)
        # the steps of a line that find the axis turning must not be more than its queue can hold
        busiest = max(timing.busy for timing in timings)
        turning = max(timing.busy + timing.setup + timing.hold for timing in timings)
        velocity = int(V_MAX * 2 * min(0.45, 0.9 / busiest, 2.5 / turning))
        slew = random.choice([RATE_ONE, random.randint(3000, RATE_ONE)])
        drain = random.randint(velocity >> 20, velocity >> 16)
        core.link.write(channel.base + r.CHANNEL_RATE_SLEW, slew, slew, drain)
        return Axes(channel, timings, velocity, up=[0] * core.axes, down=[0] * core.axes)

    def _timing(self) -> PinTiming:
        random = self.random
        most = random.choice([2, 5, 12])
        return PinTiming(
            *(random.randint(1, most) for _ in range(4)),
            both_edges=random.random() < 0.3,
            step_inverted=random.random() < 0.3,
            direction_inverted=random.random() < 0.3,
        )

    def go(self, every: bool) -> None:
        """Set or clear RUN of all channels."""
        self.core.link.write(r.ADDRESS_RUN, (1 << self.core.parameters.channels) - 1 if every else 0)

    # motions

    def raw(self, axes: Axes, shortest: int) -> Motion | None:
        """Random ramps, and lines that use up their distance."""
        random, core = self.random, self.core
        ramps = [self._ramp(axes.velocity, random.choice([0, 1, random.randint(1, 12)]))]
        for _ in range(random.choice([0, 0, 1, 1, 2])):
            ramps.append(self._ramp(axes.velocity, random.choice([0, 1, 2, random.randint(1, 12)])))
        end = self._ramp(0, random.choice([0, random.randint(1, 9)]))
        ramps.append(replace(end, velocity_end=0, last=True))
        total = distance(ramps, core.tick)
        motion = Motion([], ramps, 1)
        if random.random() < 0.15:
            motion.drained = random.randint(1, 30)
        elif random.random() < 0.15:
            total -= min(total, random.randint(1, 30))
        total += motion.drained
        if total < shortest:
            return None
        most = min(random.choice([1, 2, 4, 8]), 1 << core.parameters.line_queue_log2, total // shortest)
        lengths: list[int] = []
        for left in range(random.randint(1, most), 1, -1):
            spare = total - sum(lengths) - left * shortest
            lengths.append(shortest + random.choice([0, random.randint(0, spare), spare // left]))
        lengths.append(total - sum(lengths))
        motion.lines = [
            Line(m, tuple(self._steps(m) for _ in range(core.axes)), last=i == len(lengths) - 1)
            for i, m in enumerate(lengths)
        ]
        return motion

    def _ramp(self, velocity: int, ticks: int) -> Ramp:
        random = self.random
        end = random.choice(
            [velocity, random.randint(0, velocity), random.getrandbits(random.randint(1, 40))]
        )
        shape = random.choice(tuple(Shape))
        return Ramp(min(velocity, end), ticks, shape, random.random() < 0.5)

    def _steps(self, substeps: int) -> int:
        random = self.random
        steps = random.choice([0, 1, substeps, random.randint(0, substeps), random.randint(0, substeps)])
        return random.choice([-1, 1]) * steps

    def plan(self, axes: Axes, shortest: int) -> Motion | None:
        """A move of the planner, or two of them one after the other."""
        count = self.random.choice([1, 1, 2])
        found = [self._plan_one(axes) for _ in range(count)]
        moves = [planned(plan, self.core.axes) for plan in found if plan is not None]
        if not moves:
            return None
        lines = [replace(line, last=False) for line, _ in moves]
        lines[-1] = replace(lines[-1], last=True)
        ramps = [replace(ramp, last=False) for _, ramps in moves for ramp in ramps]
        ramps[-1] = replace(ramps[-1], last=True)
        if len(ramps) > 1 << self.core.parameters.ramp_queue_log2:
            return None
        return Motion(lines, ramps, len(moves))

    def _plan_one(self, axes: Axes) -> object | None:
        random, core = self.random, self.core
        speed = int(core.clock_hz * axes.velocity / (2 * V_MAX) * random.choice([1, random.random()])) + 200
        seconds = Fraction(random.randint(8, 30) * core.tick, core.clock_hz)
        longest = max(1, int(speed * seconds / 2))
        steps = [random.choice([0, 1, longest, random.randint(0, longest)]) for _ in range(core.axes)]
        steps = tuple(random.choice([-1, 1]) * n for n in steps)
        profile = random.choice(PROFILES)
        ramp = seconds * random.randint(0, 8) / 20
        if random.random() < 0.5:
            move = MoveInTime(steps, profile, seconds, ramp)
        else:
            start, stop = (Fraction(random.choice([0, random.randint(0, speed)])) for _ in range(2))
            acceleration = Fraction(speed * random.randint(50, 500))
            by_time = random.random() < 0.3
            move = MoveBySpeed(
                *(steps, profile, start, Fraction(speed), stop),
                *(
                    (Fraction(0), Fraction(0), ramp)
                    if by_time
                    else (acceleration, acceleration / 2, Fraction(0))
                ),
            )
        try:
            plan = plan_move(move, core.clock_hz, core.parameters)
        except PlanError:
            return None
        return plan if plan.clocks < 50 * core.tick else None

    # making them

    def make(self, axes: Axes, motion: Motion) -> None:
        """Send a motion, which starts when the previous one has ended. Then sometimes interfere."""
        axes.channel.ramps(*motion.ramps)
        axes.channel.lines(*motion.lines)
        axes.pending.append(motion)
        axes.drained += motion.drained
        self.moves += motion.moves
        for axis in range(self.core.axes):
            steps = [line.steps[axis] for line in motion.lines]
            axes.up[axis] += sum(max(0, n) for n in steps)
            axes.down[axis] += sum(max(0, -n) for n in steps)
        if self.random.random() < 0.25:
            self.interfere(axes)

    def interfere(self, axes: Axes) -> None:
        """Hold, resume, override, at any time."""
        random = self.random
        for motion in axes.pending:
            motion.disturbed = True
        for _ in range(random.randint(1, 2)):
            self.core.run(random.randint(0, 700))
            axes.channel.set_rate(random.choice([0, random.randint(0, RATE_ONE), RATE_ONE // 2]))
        self.core.run(random.randint(0, 700))
        axes.channel.set_rate(RATE_ONE)

    def settle(self) -> None:
        """Wait for the end of all motions, and check their results."""
        core = self.core
        for number, axes in enumerate(self.axes):

            def ended(number: int = number, count: int = len(axes.pending)) -> bool:
                return len(core.motions(number, self.batch)) >= count

            core.run_until(ended, 200_000, step=200)
        core.run(150)
        for number, axes in enumerate(self.axes):
            made = core.motions(number, self.batch)
            for (begin, end), motion in zip(made, axes.pending, strict=True):
                if not motion.disturbed and not motion.drained:
                    assert end - begin == motion.ticks * core.tick, motion
            state = axes.channel.state()
            assert (state.state, state.cause) == (State.IDLE, Cause.NONE)
            assert state.drained == axes.drained & 0x7FFF
            for axis in range(core.axes):
                steps = self.checker.steps(number * core.axes + axis)
                up = sum(direction > 0 for _, direction in steps)
                assert (up, len(steps) - up) == (axes.up[axis], axes.down[axis])
            assert axes.channel.positions() == self.positions(number)
            axes.pending.clear()
        self.batch = core.clock

    def positions(self, number: int) -> list[int]:
        """Positions of the axes of a channel according to the pins."""
        axes = self.core.axes
        return self.checker.positions[number * axes : (number + 1) * axes]

    def wild(self, axes: Axes) -> None:
        """Inconsistent lines and ramps: whatever happens, the position equals the pulses."""
        random, core = self.random, self.core
        self.settle()
        number = axes.channel.number
        fast = replace(axes, velocity=V_MAX)
        motion = self.raw(fast, 1)
        if motion is None:
            return
        if random.random() < 0.5:
            motion.lines[-1] = replace(motion.lines[-1], last=False, endless=random.random() < 0.5)
        if random.random() < 0.5:
            motion.ramps[-1] = replace(motion.ramps[-1], last=False, velocity_end=random.randint(0, V_MAX))
        actions: list[Callable[[], None]] = [
            axes.channel.stop,
            axes.channel.abort,
            lambda: axes.channel.ramps(self._ramp(V_MAX, random.randint(0, 5))),
            lambda: axes.channel.ramps(replace(self._ramp(V_MAX, random.randint(0, 5)), now=True, last=True)),
            lambda: axes.channel.lines(Line(random.randint(1, 99), (0,) * core.axes, last=True)),
            lambda: core.run(random.randint(1, 900)),
        ]
        for action in (
            lambda: axes.channel.ramps(*motion.ramps),
            lambda: axes.channel.lines(*motion.lines),
            *random.choices(actions, k=random.randint(0, 4)),
        ):
            try:
                action()
            except RefusedError:
                break
        core.run(random.randint(1, 6 * core.tick))
        axes.channel.abort()
        core.run(400)
        assert axes.channel.state().state == State.STOPPED
        assert axes.channel.positions() == self.positions(number)
        axes.channel.clear()
        for axis in range(core.axes):
            steps = self.checker.steps(number * core.axes + axis)
            axes.up[axis] = sum(direction > 0 for _, direction in steps)
            axes.down[axis] = len(steps) - axes.up[axis]
        axes.drained = axes.channel.state().drained
        self.batch = core.clock


def session(core: Core, number: int) -> None:
    """Some motions; in between everything is checked."""
    random = rng(f"core_random/{number}")
    host = Session(core, random)
    made = 0
    while made < patience(MOTIONS, 6):
        axes = random.choice(host.axes)
        if random.random() < 0.03:
            host.wild(axes)
            continue
        if len(axes.pending) > 3 or random.random() < 0.1:
            host.settle()
        make = random.choice([host.raw, host.plan])
        motion = make(axes, random.choice([1, *[MANY] * 4]))
        if motion is None:
            continue
        if not axes.has_room_for(motion):
            host.settle()
        if any(line.substeps < MANY for line in motion.lines):
            # all of it has to be there before it starts
            host.settle()
            host.go(every=False)
            host.make(axes, motion)
            host.go(every=True)
        else:
            host.make(axes, motion)
        made += 1
    host.settle()
    core.dut._log.info(f"{host.moves} moves, {host.checker.positions}")


for _number in range(SESSIONS):

    def _body(core: Core, number: int = _number) -> None:
        """Random motions."""
        session(core, number)

    _body.__name__ = _body.__qualname__ = f"session_{_number}"
    globals()[_body.__name__] = core_test(_body)
