# SPDX-License-Identifier: MIT
"""Trackers as judge: each step in its tick, from the recurrence of docs/architecture.md in Python integers.

Targets, speeds and enables that change at any time, stops of all kinds, beside a path and without one.
"""

import random
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import RATE_ONE
from passo.registers import Cause, State, Verdict

from tests.helpers.closed_form import ONE, Line, Ramp, substep_clocks
from tests.test_register_table import Core as Table
from verify.mutants import registers_judge
from verify.mutants.engine_judge import Check
from verify.mutants.motions_judge import FRAME, TIME, Steps, all_substeps
from verify.mutants.trackers_due import HALF, LATE, STEP, Due, Hand, either_way, joined, nearest
from verify.mutants.trackers_host import Host, phases

MODULES = ("passo_tracker", "passo_tracker_program", "passo_trackers", "passo_tracker_join")
FAR = HALF - 5000  # nearly half of all positions away: a target beyond is behind
ABOVE = 3  # ticks above the fastest motion
DROPPED = 7  # steps of a tracker, at most, by a hard stop
NOT_MADE = 3  # steps when an axis has no room: one is lost, two that wait for it are dropped
OWN = re.compile("TRACKER|COMMAND|TRIGGER")  # registers that do something to a tracker
SHAPES = re.compile("COSINE|SIGMOID|EASE")
POINTS = 40  # of the shapes that are written
SLOWEST = STEP // 8  # that is drawn: nothing takes long

# Clocks by which a tracker's step counts before it is at the pins: those that fit the core itself.
leads: dict[Parameters, set[int]] = {}


class Trackers(Host):
    """A core whose trackers are judged."""

    def measure(self) -> None:
        """When steps leave the pins, as it is in the core itself."""
        self.limit(0, STEP // 2, STEP // 8)
        self.go(0, 6)
        self.enable(1)
        self.settle()
        clock, _ = self.steps(self.channel, 0)[-1]
        phases.setdefault(self.parameters, (clock - self.origin) % self.period)
        self.alone()
        self.enable(0)
        self.alone()

    def limits(self, longest: float = 31) -> tuple[int, int]:
        """A speed and an acceleration: motions are short and long ones."""
        acceleration = int(2 ** self.rng.uniform(22, longest))
        return min(STEP - 1, max(SLOWEST, int(acceleration * 2 ** self.rng.uniform(0, 6)))), acceleration

    def elsewhere(self) -> None:
        """What is written to other registers of the channel is not for its trackers."""
        table = Table(self.link, self.parameters)
        points = [one for one in table.registers if SHAPES.search(one[1].name)]
        others = [
            (address, register)
            for address, register in table.registers
            if register.block == "CHANNEL" and "w" in register.access and not OWN.search(register.name)
        ]
        for address, register in [*others, *self.rng.sample(points, POINTS)]:
            assert table.write(address, register.reset) == Verdict.OK, register.name

    def lands(self) -> None:
        """All axes together, from rest to rest; in nearly the shortest time."""
        rng = self.rng
        limits = [self.limits() for _ in range(self.axes)]
        distances = [rng.choice((-1, 1)) * int(2 ** rng.uniform(0, 6.5)) for _ in range(self.axes)]
        distances[0] = rng.choice((-1, 1)) * rng.randint(20, 90)  # it moves for some frames
        for axis in range(self.axes):
            self.limit(axis, *limits[axis])
            self.go(axis, self.position(axis) + distances[axis])
        self.elsewhere()
        self.alone()
        everyone = (1 << self.axes) - 1
        self.enable(everyone)
        assert not self.channel.state().quiet, "a tracker that moves is not quiet"
        assert self.state().moves, "a tracker that moves says so"
        self.settle()
        for axis, (speed, a) in enumerate(limits):
            made, steps = self.steps(self.channel, axis), abs(distances[axis])
            assert len(made) == steps, f"steps of axis {axis}"
            top = speed // a * a
            far = steps * STEP * a >= top * top
            best = steps * STEP / top + top / a if far else 2 * (steps * STEP / a) ** 0.5
            # from half a step after its beginning to half a step before its end
            most = (best + ABOVE) * self.period + TIME * 4
            assert made[-1][0] - made[0][0] <= most, f"axis {axis} is at its target in time"
        self.alone()
        self.check_rest(everyone)
        self.enable(0)
        self.alone()
        self.check_rest(0)

    def distances(self) -> None:
        """At rest a tracker is at its target, and not at any other, however far."""
        for bit in range(32):
            places = [self.position(axis) for axis in range(self.axes)]
            axis = self.rng.randrange(self.axes)
            for distance in (1 << bit, -1 << bit, 0):
                self.go(axis, places[axis] + distance)
                self.engine.run(4 * self.period)
                state = self.state()
                assert bool(state.at_target >> axis & 1) == (distance == 0), f"{distance} steps away: {state}"
        self.alone()

    def jumps(self, rounds: int = 40) -> None:
        """Targets, speeds and enables change at any time."""
        rng = self.rng
        for axis in range(self.axes):
            self.limit(axis, *self.limits(longest=29))
        self.alone()
        self.enable((1 << self.axes) - 1)
        for _ in range(rounds):
            axis = rng.randrange(self.axes)
            kind = rng.randrange(8)
            if kind < 4:
                target = rng.choice((rng.randint(-60, 60), rng.randint(-FAR, FAR), -FAR, FAR))
                self.go(axis, target, rng.choice((0, 0, target - rng.randint(-FAR, FAR))))
            elif kind == 4:
                self.limit(axis, rng.choice((0, 1, STEP - 1, rng.getrandbits(32))))
            elif kind == 5:
                self.enable(rng.choice((0xFF, rng.getrandbits(8))))
            elif kind == 6:
                begun, positions = self.engine.clock, self.read()
                self.shown.append((begun, self.engine.clock, positions))
            self.engine.run(rng.randrange(int(2 ** rng.uniform(5, 12))))
        for axis in range(self.axes):
            self.limit(axis, STEP - 1)
            self.go(axis, rng.randint(-50, 50))
        everyone = (1 << self.axes) - 1
        self.enable(everyone)
        self.settle()
        self.alone()
        self.check_rest(everyone)
        for hands in self.hands:
            assert all(hand.position == hand.target * STEP for hand in hands), "at the targets"
        self.enable(0)
        self.alone()

    def torn(self) -> None:
        """A target is taken as a whole, in whatever clock it is written."""
        axis = self.rng.randrange(self.axes)
        speed = STEP // 8 * 7  # a tick with another target is a step
        self.go(axis, -1)
        self.limit(axis, speed, speed)
        self.alone()
        self.enable(1 << axis)
        self.settle()
        place = self.channel.base + r.CHANNEL_TRACKER_TARGET_BASE + axis
        if self.down[axis]:
            place += r.CHANNEL_TRACKER_TARGET_DOWN_BASE - r.CHANNEL_TRACKER_TARGET_BASE
        for n in range(self.period):
            at = self.engine.clock
            target = 0 if n % 2 == 0 else -1
            self.link.write(place, target % STEP)
            self.tell(axis, target=target)
            self.engine.run((1 + at - self.engine.clock) % self.period + 3 * self.period)
            if n % 16 == 15:
                self.alone()
        self.targets[axis] = (-1, -1)
        self.enable(0)
        self.alone()

    def away(self) -> None:
        """Trackers move, all in any direction; they will do so for long."""
        self.apart = self.of_path()
        for axis in range(self.axes):
            self.limit(axis, *self.limits(longest=28))
            self.go(axis, self.position(axis) + self.rng.choice((-1, 1)) * self.rng.randint(2000, 30_000))
        self.alone()
        self.enable((1 << self.axes) - 1)
        self.engine.run(self.rng.randint(6000, 20_000))

    def until_stopped(self, cause: Cause) -> None:
        """Wait; it is stopped then, for this cause."""
        for _ in range(2000):
            if self.channel.state().state == State.STOPPED:
                break
            self.engine.run(1000)
        state = self.channel.state()
        assert (state.state, state.cause) == (State.STOPPED, cause), f"{state}"

    def stops(self, hard: bool) -> None:
        """A stop without a motion slows all down, or ends all; nothing moves until it is enabled again."""
        self.away()
        (self.channel.abort if hard else self.channel.stop)()
        at = self.engine.clock
        if not hard:
            for axis in range(self.axes):
                self.tell(axis, follows=0)
        self.until_stopped(Cause.ABORT if hard else Cause.STOP)
        stopped = at if hard else self.engine.clock
        # while it is stopped, this does nothing
        self.link.write(self.channel.base + r.CHANNEL_TRACKER_ENABLE, self.rng.getrandbits(8))
        self.engine.run(8 * self.period)
        assert self.state().enabled == 0, "a stop clears TRACKER_ENABLE"
        self.channel.clear()
        self.engine.run(8 * self.period)
        self.see()
        self.check_dropped(stopped, DROPPED if hard else 1)
        if not hard:
            self.alone()
            assert all(hand.v == 0 for hands in self.hands for hand in hands), "STOPPED when all are at rest"
            self.check_rest(0)
        self.zero()

    def check_dropped(self, until: int, most: int) -> None:
        """No step later; positions are what left the pins, and nearly what the trackers say."""
        made = [self.steps(self.channel, axis) for axis in range(self.axes)]
        last = max((clock for axis in made for clock, _ in axis), default=0)
        assert last <= until + 2 * TIME, "no step after a stop"
        apart = self.of_path()
        off = [a - b for a, b in zip(apart, self.apart, strict=True)]
        assert all(abs(n) <= most for n in off), f"what a stop drops: {off}"

    def zero(self) -> None:
        """ZERO: all positions agree."""
        self.link.write(self.channel.base + r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB)
        self.begin_at_0()

    def begin_at_0(self) -> None:
        """After ZERO or a reset."""
        self.engine.run(8 * self.period)
        both = self.channel.positions(), self.read()
        assert both == ([0] * self.axes, [0] * self.axes), f"positions are 0: {both}"
        state = self.state()
        assert (state.enabled, state.moves) == (0, 0), f"{state}"
        self.know([0] * self.axes, follows=False)

    def reset(self) -> None:
        """A reset while trackers move: what was written is kept, and where they are is 0."""
        self.away()
        for axis in range(self.axes):  # all that was written has been taken
            self.go(axis, self.rng.randint(-70, 70), self.rng.randint(0, 9))
        self.engine.run(4 * self.period)
        self.engine.set("rst", 1)
        self.engine.run(self.rng.randint(1, 300))
        self.engine.set("rst", 0)
        self.origin = self.engine.clock
        self.down = [False] * self.axes
        self.engine.run(40)
        for axis in range(self.axes):
            self.link.write(self.channel.axis_base(axis) + r.AXIS_ENABLE, 1)
        self.see()
        self.events = self.events[-1:]  # a pulse in a reset is longer
        self.begin_at_0()
        self.enable((1 << self.axes) - 1)
        self.settle()
        self.alone()
        self.check_rest((1 << self.axes) - 1)
        self.enable(0)
        self.alone()

    def switches(self) -> None:
        """No step toward an active switch; a step away from it is made."""
        rng = self.rng
        self.link.write(r.ADDRESS_INPUT_FILTER, 0)
        self.engine.run(20)
        self.away()
        axis = rng.randrange(self.axes)
        up = self.targets[axis][0] > self.position(axis)
        pins = ("limit_high", "limit_low") if up else ("limit_low", "limit_high")
        self.engine.set(pins[1], 1 << axis)  # behind it: nothing happens
        self.engine.run(6 * self.period)
        assert self.channel.state().state == State.IDLE, "a switch behind it"
        self.engine.set(pins[1], 0)
        self.engine.run(20)
        self.engine.set(pins[0], 1 << axis)
        at = self.engine.clock
        self.engine.run(200_000)
        self.see()
        toward = [clock for clock, _ in self.steps(self.channel, axis) if clock > at + 4 * TIME]
        assert not toward, "a step toward a switch"
        self.until_stopped(Cause.LIMIT)
        self.channel.clear()
        self.zero()
        for way in (-1, 1):  # away, and back
            for other in range(self.axes):
                self.limit(other, STEP // 2, STEP // 50)
                self.go(other, way * (1 if up else -1) * rng.randint(5, 40))
            self.alone()
            self.enable((1 << self.axes) - 1)
            if way < 0:
                self.settle()
                self.alone()
                self.check_rest((1 << self.axes) - 1)
                self.enable(0)
                self.alone()
        self.engine.run(100_000)
        self.until_stopped(Cause.LIMIT)
        self.see()
        made = [step for step in self.steps(self.channel, axis) if (step[1] > 0) == up]
        assert not made, "a step toward a switch"
        self.engine.set(pins[0], 0)
        self.engine.run(20)
        self.channel.clear()
        self.zero()

    def unknown(self) -> None:
        """Nothing begins to move before the inputs are known."""
        length = self.rng.randint(2000, 20_000)
        for axis in range(self.axes):
            self.limit(axis, STEP // 2, STEP // 8)
            self.go(axis, self.position(axis) + self.rng.randint(3, 30))
        self.alone()
        self.link.write(r.ADDRESS_INPUT_FILTER, length)
        at = self.engine.clock
        self.enable((1 << self.axes) - 1)
        self.engine.run(2 * length + 20 * self.period)
        self.settle()
        first = min(clock for axis in range(self.axes) for clock, _ in self.steps(self.channel, axis))
        assert at - FRAME + length <= first <= at + 2 * length + 16 * self.period, "the inputs are known"
        self.landed()
        self.enable(0)
        self.alone()
        self.link.write(r.ADDRESS_INPUT_FILTER, 0)
        self.look()

    def overruns(self, axis: int, way: int) -> None:
        """More steps than the pins can make are lost, which stops the channel."""
        timing = self.channel.axis_base(axis) + r.AXIS_STEP_TIMING
        before = self.timings[axis]
        high = self.high[axis] = self.rng.randint(900, 3000)
        self.timings[axis] = replace(before, step_high=high, step_low=1)
        self.link.write(timing, high << 16 | 1)
        for other in range(self.axes):
            self.limit(other, STEP - 1, STEP // 4)
            self.go(other, self.position(other) + 200 * way)
        self.alone()
        self.enable(1 << axis)
        self.engine.run(100_000)
        self.until_stopped(Cause.STEP_OVERRUN)
        self.see()
        assert self.channel.state().overrun == 1 << axis, "the axis that overran"
        (lost,) = self.link.read(self.channel.axis_base(axis) + r.AXIS_LOST_STEPS, 1)
        assert 0 < lost < 8, "lost steps"
        made = self.steps(self.channel, axis)
        missing = (self.read()[axis] - self.position(axis)) * way - len(made)
        # rounded down, and one more may be due until it stops
        assert NOT_MADE - 1 <= missing <= NOT_MADE + 1, f"{missing} steps are not made"
        self.engine.run(2 * high)
        self.look()
        self.link.write(timing, before.step_high << 16 | before.step_low)
        self.timings[axis], self.high[axis] = before, before.step_high
        self.channel.clear()
        self.zero()

    # --- Beside a path ---------------------------------------------------------------------------

    def path(self, gap: int, endless: bool = False) -> tuple[list[Line], list[Ramp]]:
        """Lines of all kinds, a substep every `gap` clocks."""
        rng = self.rng
        velocity = ONE // gap
        ticks = rng.randint(20, 60) * gap // self.tick
        ramps = [Ramp(velocity, 0), Ramp(velocity, ticks, last=True)]
        total = len(substep_clocks(ramps, self.tick.bit_length() - 1))
        parts = [total] if endless else [total // 3, total // 3, total - 2 * (total // 3)]
        lines = [
            Line(
                m,
                self.of_lines([rng.choice((m, -m, 0, m // 2, -(m // 3), m - 1)) for _ in range(self.axes)]),
                last=n == len(parts) - 1,
            )
            for n, m in enumerate(parts)
        ]
        return lines, ramps

    def of_lines(self, steps: Sequence[int]) -> tuple[int, ...]:
        """The steps of a line, of which an axis without lines has none."""
        lined = self.parameters.lined
        return (*steps[:lined], *(0 for _ in steps[lined:]))

    def of_path(self) -> list[int]:
        """Positions without the steps of trackers; only while these rest."""
        return [a - b for a, b in zip(self.channel.positions(), self.read(), strict=True)]

    def ends(self, lines: Sequence[Line], begun: Sequence[int]) -> None:
        """Both hands come to rest: the trackers at their targets, the path by its steps behind `begun`."""
        self.wait(self.channel)
        self.settle()
        self.directions(lines)
        self.landed()
        moved = [sum(line.steps[axis] for line in lines) for axis in range(self.axes)]
        due = [a + b for a, b in zip(begun, moved, strict=True)]
        assert self.of_path() == due, "positions are the sums"

    def turn_in(self, axis: int, setup: int, hold: int) -> None:
        """Set the times of DIR of an axis."""
        self.timings[axis] = replace(self.timings[axis], dir_setup=setup, dir_hold=hold)
        self.link.write(self.channel.axis_base(axis) + r.AXIS_DIR_TIMING, setup << 16 | hold)

    def directions(self, lines: Sequence[Line]) -> None:
        """The direction in which the lines have moved the axes last."""
        for line in lines:
            for axis, steps in enumerate(line.steps):
                self.down[axis] = steps < 0 if steps else self.down[axis]

    def joins(self) -> None:
        """Both hands: each step of both is made once, in its direction, when it is due."""
        rng = self.rng
        gap = int(2 ** rng.uniform(6, 9.5))
        lines, ramps = self.path(gap)
        for axis in range(self.axes):
            speed = rng.choice((STEP - 1, STEP // 2, rng.randint(STEP // 60, STEP // 2)))
            self.limit(axis, speed, speed // rng.randint(1, 6))
            self.go(axis, self.position(axis) + rng.choice((-1, 1)) * rng.randint(1, 9))
        self.both(lines, ramps, rng.randint(0, 12 * gap))

    def meets(self) -> None:
        """Steps of both hands, against each other, come on the same clock, and around it."""
        gap = self.period + 1
        velocity, total = ONE // gap, 2 * gap
        ramps = [Ramp(velocity, 0), Ramp(velocity, total * gap // self.tick, last=True)]
        total = len(substep_clocks(ramps, self.tick.bit_length() - 1))
        ways = [self.rng.choice((-1, 1)) * total for _ in range(self.axes)]
        for axis, way in enumerate(ways):
            self.limit(axis, STEP - 1, (STEP - 1) // 8)
            self.go(axis, self.position(axis) - way)
        self.both([Line(total, self.of_lines(ways), last=True)], ramps, 2 * gap)

    def both(self, lines: Sequence[Line], ramps: Sequence[Ramp], wait: int) -> None:
        """A path, and trackers that are enabled some clocks later."""
        self.alone()
        begun = self.channel.positions()
        self.push(self.channel, lines, ramps)
        self.channel.start()
        self.engine.run(wait)
        hands = [{hand._replace(follows=True) for hand in hands} for hands in self.hands]
        self.enable((1 << self.axes) - 1)
        at = self.engine.clock - FRAME
        self.wait(self.channel)
        self.settle()
        begin, end = self.runs(self.channel)
        clocks = [begin + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        known = leads.get(self.parameters, set(range(-3, 6)))
        for axis in range(self.axes):
            path = [(clocks[n], way) for n, way in all_substeps(lines, axis, len(clocks))]
            fitting: set[int] = set()
            for changes in self.changes(lines, axis, clocks, begin, end):
                for first in range(LATE + 1):
                    for hand in hands[axis]:
                        steps = self.played(axis, hand, self.tick_of(axis, at)[0] + first)
                        fitting |= {
                            lead
                            for lead in known - fitting
                            if any(
                                self.fits(axis, joined(path, steps, changed, lead))
                                for changed in either_way(changes, steps, lead)
                            )
                        }
            assert fitting, f"steps of axis {axis} of path and tracker"
            known = fitting
        leads[self.parameters] = known
        moved = [sum(line.steps[axis] for line in lines) for axis in range(self.axes)]
        sums = [n + self.targets[axis][0] - self.position(axis) for axis, n in enumerate(moved)]
        now = self.channel.positions()
        assert [a - b for a, b in zip(now, begun, strict=True)] == sums, "positions are the sums"
        self.directions(lines)
        self.landed()
        self.enable(0)
        self.alone()

    def played(self, axis: int, hand: Hand, tick: int) -> Steps:
        """The steps of a tracker from a tick on."""
        steps = []
        for number in range(tick, tick + 5000):
            after = hand.tick()
            if way := nearest(after.position) - nearest(hand.position):
                steps.append((self.clock_of(axis, number), way))
            if after == hand and hand.position == hand.target * STEP:
                break
            hand = after
        return steps

    def changes(
        self, lines: Sequence[Line], axis: int, clocks: Sequence[int], begin: int, end: int
    ) -> Iterator[list[tuple[int, int]]]:
        """When the path moves the axis: a line begins with the end of the one before."""
        ways = [(line.steps[axis] > 0) - (line.steps[axis] < 0) for line in lines]
        firsts = [begin]
        done = 0
        for line in lines[:-1]:
            done += line.substeps
            firsts.append(clocks[done - 1] + 1)
        yield [*zip(firsts, ways, strict=True), (end, 0)]

    def fits(self, axis: int, due: Sequence[Due]) -> bool:
        """Whether these are the steps at the pins."""
        made, timing = self.steps(self.channel, axis), self.timings[axis]
        if [way for _, way in made] != [one.way for one in due]:
            return False
        step = timing.step_high + timing.step_low
        turn = timing.dir_setup + timing.dir_hold + 2
        before, late = 0, 0
        for (clock, way), one in zip(made, due, strict=True):
            if one.of_path:
                most = step + (turn if way != before else 0)
            else:
                most = 2 * (step + turn) + 2
            if not 0 <= clock - one.clock <= most:
                return False
            if one.of_path and way == before and one.clock > late and clock != one.clock:
                return False
            if not one.of_path:
                late = clock + most
            before = way
        return True

    def returns(self) -> None:
        """Trackers that turn while their steps wait: for a slow path, and for pins that are slow to turn."""
        rng, before = self.rng, list(self.timings)
        for axis in range(self.axes):
            self.turn_in(axis, rng.randint(200, 500), rng.randint(200, 500))
            self.limit(axis, STEP // 3, STEP // 6)
            self.go(axis, self.position(axis))
        self.alone()
        self.enable((1 << self.axes) - 1)
        for _ in range(3):
            begun = self.of_path()
            gap = rng.randint(1200, 2500)
            sizes = [rng.randint(1, 3) for _ in range(20)]
            ramps = [Ramp(ONE // gap, 0), Ramp(ONE // gap, sum(sizes) * gap // self.tick + 1, last=True)]
            total = len(substep_clocks(ramps, self.tick.bit_length() - 1))
            sizes.append(max(total - sum(sizes), 1))
            lines = [
                Line(
                    m,
                    self.of_lines([rng.choice((m, -m, 0, 0)) for _ in range(self.axes)]),
                    last=n == len(sizes) - 1,
                )
                for n, m in enumerate(sizes)
            ]
            self.push(self.channel, lines, ramps)
            self.channel.start()
            for _ in range(90):
                axis = rng.randrange(self.axes)
                self.go(axis, self.targets[axis][0] + rng.choice((-1, 1)) * rng.randint(1, 2))
                self.run(rng.randint(1, 1000))
            self.ends(lines, begun)
        self.enable(0)
        self.alone()
        for axis, timing in enumerate(before):
            self.turn_in(axis, timing.dir_setup, timing.dir_hold)

    def turned(self) -> None:
        """Back from a step against the path, which the pins have not made when the path moves on."""
        rng, axis = self.rng, self.rng.randrange(self.parameters.lined)
        before, way, gap = self.timings[axis], rng.choice((-1, 1)), rng.randint(950, 1050)
        self.turn_in(axis, 2 * gap, 3 * gap)
        self.limit(axis, STEP - 1, STEP // 2)
        for other in range(self.axes):
            self.go(other, self.position(other))
        here = self.position(axis)
        self.alone()
        self.enable(1 << axis)
        begun = self.channel.positions()
        ramps = [Ramp(ONE // gap, 0), Ramp(ONE // gap, 7 * gap // self.tick, last=True)]
        steps = self.of_lines([way * (other == axis) for other in range(self.axes)])
        lines = [Line(1, steps), Line(4, (0,) * self.axes), Line(1, steps, last=True)]
        self.push(self.channel, lines, ramps)
        self.channel.start()
        self.run(3 * gap // 2)
        self.down[axis] = way < 0
        for target in (here - way, here):
            self.go(axis, target)
        self.wait(self.channel)
        self.settle()
        begun[axis] += 2 * way
        assert self.channel.positions() == begun, "positions are the sums"
        self.landed()
        self.enable(0)
        self.alone()
        self.turn_in(axis, before.dir_setup, before.dir_hold)

    def held(self) -> None:
        """While the path stands, trackers move as without one; each to the target of its line's direction."""
        rng = self.rng
        for axis in range(self.axes):
            self.limit(axis, *self.limits(longest=29))
        self.alone()
        lines, ramps = self.path(rng.randint(60, 100), endless=True)
        begun = self.of_path()
        self.write(self.channel, r.CHANNEL_RATE_TARGET, RATE_ONE, RATE_ONE)
        self.push(self.channel, lines, ramps)
        self.channel.start()
        self.engine.run(rng.randint(400, 1200))
        self.channel.set_rate(0)
        self.engine.run(4 * self.tick)
        self.directions(lines)
        before = self.channel.positions(), self.read()
        self.look()
        for axis in range(self.axes):
            self.limit(axis, self.limits()[0])
            self.go(axis, self.position(axis) + rng.randint(-20, 20), rng.randint(-9, 9))
        self.enable((1 << self.axes) - 1)
        self.rest()
        after = self.channel.positions(), self.read()
        moved = [[b - a for a, b in zip(*both, strict=True)] for both in zip(before, after, strict=True)]
        for a, b in zip(*moved, strict=True):
            assert abs(a - b) <= 1, "positions while the path stands"
        self.alone()
        self.enable(0)
        self.rest()
        self.alone()
        self.channel.set_rate(RATE_ONE)
        self.wait(self.channel)
        self.settle()
        for axis in range(self.axes):
            at = begun[axis] + lines[0].steps[axis] + self.read()[axis]
            assert self.channel.positions()[axis] in (at, at + 1), "positions are the sums"
        self.enable((1 << self.axes) - 1)
        self.settle()
        self.landed()
        self.enable(0)
        self.alone()

    def rest(self) -> None:
        """Until no tracker moves, beside a path in a hold."""
        self.engine.run(8 * self.period)
        for _ in range(1000):
            if not self.state().moves:
                break
            self.engine.run(self.period)
        self.engine.run(8 * self.period)

    def disturbed(self) -> None:
        """Anything at any time beside a path, and a stop: axes are where the path ended, plus trackers."""
        rng, channel = self.rng, self.channel
        for axis in range(self.axes):
            self.limit(axis, *self.limits(longest=29))
        lines, ramps = self.path(int(2 ** rng.uniform(6, 9)), endless=True)
        m = lines[0].substeps
        lines, ramps = (
            [replace(lines[0], last=False, endless=True)],
            [ramps[0], replace(ramps[1], ticks=60_000)],
        )
        self.write(channel, r.CHANNEL_RATE_TARGET, RATE_ONE, *(rng.randint(300, RATE_ONE) for _ in range(2)))
        begun = self.of_path()
        self.push(channel, lines, ramps)
        channel.start()
        for _ in range(rng.randint(3, 25)):
            kind, axis = rng.randrange(6), rng.randrange(self.axes)
            if kind < 2:
                self.go(axis, rng.randint(-40, 40), rng.randint(-5, 5))
            elif kind == 2:
                self.limit(axis, rng.getrandbits(32))
            elif kind == 3:
                self.enable(rng.choice((0xFF, rng.getrandbits(8))))
            elif kind == 4:
                channel.set_rate(rng.choice((0, RATE_ONE, rng.randint(1, RATE_ONE))))
            self.engine.run(rng.randrange(int(2 ** rng.uniform(4, 12))))
        hard = rng.random() < 0.5
        (channel.abort if hard else channel.stop)()
        at = self.engine.clock
        self.until_stopped(Cause.ABORT if hard else Cause.STOP)
        stopped = self.engine.clock
        self.engine.run(8 * self.period)
        self.see()
        made = [self.steps(channel, axis) for axis in range(self.axes)]
        last = max((clock for axis in made for clock, _ in axis), default=0)
        assert last <= (at if hard else stopped) + 4 * TIME, "no step after a stop"
        found = [a - b for a, b in zip(self.of_path(), begun, strict=True)]
        done = [0] * self.axes
        slack = DROPPED + 1 if hard else 1
        for substep in range(self.engine.clock - self.since):
            if all(abs(a - b) <= slack for a, b in zip(found, done, strict=True)):
                break
            for axis, steps in enumerate(lines[0].steps):
                whole = (substep + 1) * abs(steps) + m // 2
                done[axis] = whole // m * (1 if steps > 0 else -1)
        else:
            raise AssertionError("positions after a stop are those of path and trackers")
        self.directions(lines)
        channel.clear()
        self.zero()
        channel.set_rate(RATE_ONE)

    def reverses(self) -> None:
        """Backlash: where the path turns an axis, its tracker goes to the other target."""
        rng = self.rng
        backs = [rng.randint(-9, 9) for _ in range(self.axes)]
        for axis in range(self.axes):
            self.limit(axis, *self.limits(longest=29))
            self.go(axis, rng.randint(-20, 20), backs[axis])
        self.enable((1 << self.axes) - 1)
        self.settle()
        self.landed()
        for _ in range(3):
            before = self.of_path()
            lines, ramps = self.path(rng.randint(50, 300))
            self.push(self.channel, lines, ramps)
            self.channel.start()
            self.ends(lines, before)
        self.enable(0)
        self.alone()


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Some of each kind.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    if not parameters.trackers:
        return
    trackers = Trackers(engine, parameters, rng)
    trackers.set_up()
    trackers.measure()
    trackers.lands()
    trackers.distances()
    trackers.jumps()
    for _ in range(4):
        trackers.joins()
    trackers.returns()
    for _ in range(3):
        trackers.turned()
    trackers.disturbed()
    trackers.stops(False)
    trackers.reverses()
    trackers.held()
    trackers.switches()
    trackers.stops(True)
    trackers.unknown()
    for axis in range(parameters.axes):
        trackers.overruns(axis, 1 - axis % 2 * 2)
    trackers.torn()
    trackers.meets()
    trackers.reset()
    trackers.disturbed()
    trackers.jumps()
    for _ in range(4):
        trackers.joins()
    trackers.lands()


KINDS: dict[str, Callable[[Trackers], None]] = {
    "lands": Trackers.lands,
    "jumps": Trackers.jumps,
    "joins": Trackers.joins,
    "returns": Trackers.returns,
    "turned": Trackers.turned,
    "distances": Trackers.distances,
    "meets": Trackers.meets,
    "reverses": Trackers.reverses,
    "held": Trackers.held,
    "disturbed": Trackers.disturbed,
    "soft stop": lambda trackers: trackers.stops(False),
    "hard stop": lambda trackers: trackers.stops(True),
    "switches": Trackers.switches,
    "unknown": Trackers.unknown,
    "overruns": lambda trackers: trackers.overruns(
        trackers.rng.randrange(trackers.axes), trackers.rng.choice((-1, 1))
    ),
    "torn": Trackers.torn,
    "reset": Trackers.reset,
}
OF_INPUTS = ("switches", "unknown")  # what needs INPUTS
CHECK = Check("trackers", "motions", check, MODULES)
# The table of the registers, of the core with trackers.
TABLES = tuple(replace(one, modules=MODULES) for one in registers_judge.CHECKS)
