# SPDX-License-Identifier: MIT
"""Motions as judge: the clock of each step, from the recurrences of docs/architecture.md in Python integers.

Motions of all kinds, at rates that change, and each of their endings. Every step leaves on its clock, STEP is
active for its time, positions, states, room and `irq` are what the pins and the document say.
"""

import random
from collections.abc import Iterator, Sequence
from itertools import product

import numpy as np
from passo import registers as r
from passo.build import Parameters
from passo.engine import Engine
from passo.host import RATE_ONE, Channel
from passo.link import Link
from passo.moves import PinTiming
from passo.registers import Cause, State

from tests.helpers.closed_form import ONE, TABLES, Line, Ramp, Tables, substep_clocks
from tests.helpers.motions import SLOW, random_motion, to_line, to_ramp
from verify.mutants.engine_judge import Check

LONGEST = 300_000  # clocks of a motion
FRAME = 64 + 2 * 128 + 8  # clocks from the words of a write to the end of its acknowledgment
GRANULE = 200  # clocks from one look at `running` to the next
SLEWS, MOST_SLEW = (1 << 15) - 1, 31_000  # bits of a slew of the rate that are set
TIME = 8  # clocks of each pin timing, at most: no step waits at SLOW

Steps = list[tuple[int, int]]  # clock and direction

# The clocks on which slew ticks act at the pins, modulo their period: those that fit the core itself.
phases: dict[Parameters, set[int]] = {}


def all_substeps(lines: Sequence[Line], axis: int, count: int) -> Iterator[tuple[int, int]]:
    """The steps of an axis within `count` substeps: the number of the substep, from 0, and the direction."""
    place = done = 0
    while done < count and place < len(lines):
        line = lines[place]
        n, m = abs(line.steps[axis]), line.substeps
        error = m // 2
        for substep in range(done, min(done + m, count)):
            error += n
            if error >= m:
                error -= m
                yield substep, -1 if line.steps[axis] < 0 else 1
        done += m
        place += not line.endless


class Motions:
    """A core whose motions are judged."""

    def __init__(self, engine: Engine, parameters: Parameters, rng: random.Random):
        self.engine, self.parameters, self.rng = engine, parameters, rng
        self.link = Link(engine)
        self.channels = [Channel(self.link, parameters, n) for n in range(parameters.channels)]
        self.tick = 1 << parameters.tick_log2
        self.high = [0] * (parameters.channels * parameters.axes)
        self.lacked = [0] * parameters.channels  # substeps drained so far
        self.inverted = {"step": 0, "dir": 0}
        self.tables: Tables = TABLES
        self.events = engine.drain()

    def set_up(self) -> None:
        """Any polarity and timing of each axis, and all drives enabled."""
        enabled = 0
        for channel in self.channels:
            for axis in range(self.parameters.axes):
                bit = channel.number * self.parameters.axes + axis
                step, down, off = (self.rng.getrandbits(1) for _ in range(3))
                high, low, setup, hold = (self.rng.randint(1, TIME) for _ in range(4))
                flags = r.AxisPinsWord(
                    step_inverted=bool(step), direction_inverted=bool(down), enable_inverted=bool(off)
                )
                channel.configure_axis(axis, PinTiming(high, low, setup, hold), flags.pack())
                self.high[bit] = high
                self.inverted["step"] |= step << bit
                self.inverted["dir"] |= down << bit
                enabled |= (1 - off) << bit
        self.engine.run(100)
        self.events = self.engine.drain()
        assert int(self.events["enable"][-1]) == enabled, "EN"
        for pin, levels in self.inverted.items():
            assert int(self.events[pin][-1]) == levels, f"{pin} at rest"

    def write(self, channel: Channel, place: int, *words: int) -> None:
        """Write registers of a channel."""
        self.link.write(channel.base + place, *words)

    def push(
        self,
        channel: Channel,
        lines: Sequence[Line],
        ramps: Sequence[Ramp],
        outputs: Sequence[r.LineOutputWord] = (),
    ) -> None:
        """Queue a motion, which does not begin yet."""
        self.link.write(r.ADDRESS_RUN, 0)
        self.queue(channel, lines, ramps, outputs)
        room = 1 << self.parameters.line_queue_log2, 1 << self.parameters.ramp_queue_log2
        assert channel.room() == (room[0] - len(lines), room[1] - len(ramps)), "room of what is queued"
        self.events = self.engine.drain()[-1:]

    def queue(
        self,
        channel: Channel,
        lines: Sequence[Line],
        ramps: Sequence[Ramp],
        outputs: Sequence[r.LineOutputWord] = (),
    ) -> None:
        """Queue lines and ramps."""
        channel.push_lines([to_line(line) for line in lines], outputs)
        channel.push_ramps([to_ramp(ramp) for ramp in ramps])

    def run(self, clocks: int) -> None:
        """Let time pass."""
        while clocks > 0:
            clocks -= self.engine.run(clocks)

    def see(self) -> None:
        """Take the events of the pins."""
        self.events = np.concatenate([self.events, self.engine.drain()])

    def wait(self, channel: Channel) -> None:
        """Until the motion has ended, and some clocks more."""
        for _ in range(LONGEST // GRANULE):
            self.engine.run(GRANULE)
            if not self.engine.running >> channel.number & 1:
                break
        self.engine.run(6 * TIME)
        self.see()

    def runs(self, channel: Channel) -> tuple[int, int]:
        """From when to when `running` was high, once."""
        level = (self.events["running"] >> channel.number & 1).astype(np.int8)
        at = np.flatnonzero(np.diff(level, prepend=np.int8(0)))
        assert len(at) == 2, f"running changes {len(at)} times"
        return int(self.events["clock"][at[0]]), int(self.events["clock"][at[1]])

    def steps(self, channel: Channel, axis: int) -> Steps:
        """Each pulse, which has its length."""
        bit = channel.number * self.parameters.axes + axis
        level = ((self.events["step"] ^ self.inverted["step"]) >> bit & 1).astype(np.int8)
        change = np.diff(level, prepend=np.int8(0))
        up, down = np.flatnonzero(change == 1), np.flatnonzero(change == -1)
        clocks = self.events["clock"].astype(np.int64)
        assert len(up) == len(down) and (clocks[down] - clocks[up] == self.high[bit]).all(), "STEP is active"
        back = (self.events["dir"] ^ self.inverted["dir"])[up] >> bit & 1
        return [(int(clock), -1 if way else 1) for clock, way in zip(clocks[up], back, strict=True)]

    def check_positions(self, channel: Channel, before: Sequence[int]) -> None:
        """They are the steps that have left the pins."""
        axes = range(self.parameters.axes)
        made = [sum(way for _, way in self.steps(channel, axis)) for axis in axes]
        found = channel.positions()
        assert [a - b for a, b in zip(found, before, strict=True)] == made, "positions"

    def check_end(self, channel: Channel, cause: Cause, drained: int = 0) -> None:
        """The state after a motion; then the channel is as if there had been none."""
        state, stopped = channel.state(), cause != Cause.NONE
        expected = State.STOPPED if stopped else State.IDLE
        assert (state.state, state.cause, state.stopping) == (expected, cause, False), f"{state}"
        self.lacked[channel.number] += drained
        assert state.quiet and state.drained == self.lacked[channel.number], f"{state}"
        assert self.engine.irq == stopped, "irq"
        parts = {"outputs": self.parameters.outputs, "power": self.parameters.outputs}
        for pin, there in (parts | {"compare": self.parameters.compare}).items():
            assert there or not self.events[pin].any(), f"{pin} without its part"
        status = r.StatusWord.unpack(self.link.status)
        assert (status.any_stopped, status.any_occupied) == (stopped, False), f"{status}"
        if stopped:
            channel.clear()
            assert channel.state().state == State.IDLE
        room = 1 << self.parameters.line_queue_log2, 1 << self.parameters.ramp_queue_log2
        assert channel.room() == room, "room at rest"
        self.write(channel, r.CHANNEL_COMMAND, 1 << r.CHANNEL_COMMAND_ZERO_LSB)
        assert channel.positions() == [0] * self.parameters.axes
        self.write(channel, r.CHANNEL_RATE_TARGET, RATE_ONE)
        self.engine.run(10)

    def check_steps(
        self, channel: Channel, lines: Sequence[Line], clocks: Sequence[int], exact: bool = True
    ) -> None:
        """The steps of all axes, if the substeps leave the pins on these clocks; or the first of them."""
        for axis in range(self.parameters.axes):
            due = [(clocks[n], way) for n, way in all_substeps(lines, axis, len(clocks))]
            made = self.steps(channel, axis)
            assert made == (due if exact else due[: len(made)]), f"steps of axis {axis}"

    # --- Motions -----------------------------------------------------------------------------------

    def draw(self, most_ramps: int = 7) -> tuple[list[Line], list[Ramp]]:
        """Any motion that fits into the queues."""
        places = 1 << self.parameters.line_queue_log2
        while True:
            lines, ramps = random_motion(
                self.rng, self.parameters.axes, min(6, places), most_ramps, self.tables
            )
            if sum(ramp.ticks for ramp in ramps) < 200 and all(line.substeps for line in lines):
                return lines, ramps

    def exact(self, channel: Channel) -> None:
        """At full rate: each step on its clock, the profile as long as it is."""
        lines, ramps = self.draw()
        self.push(channel, lines, ramps)
        channel.start()
        self.wait(channel)
        begin, end = self.runs(channel)
        assert end - begin == sum(ramp.ticks for ramp in ramps) * self.tick, "the profile lasts"
        self.check_steps(
            channel, lines, [begin + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        )
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.NONE)

    def cruise(self, velocity: int, ticks: int, axes: int) -> tuple[list[Line], list[Ramp]]:
        """An endless line at a constant velocity."""
        n = self.rng.randint(1, 60)
        steps = tuple(self.rng.randint(-n, n) for _ in range(axes - 1))
        return [Line(n, (n, *steps), endless=True)], [Ramp(velocity, 0), Ramp(velocity, ticks, last=True)]

    def paced(self, channel: Channel, stops: bool, slews: tuple[int, int]) -> None:
        """The rate goes to its goal by its slew with each tick: override, hold, resume, soft stop."""
        rng = self.rng
        slew, stop_slew = slews
        rate = rng.randint(RATE_ONE // 4, RATE_ONE)
        lines, ramps = self.cruise(SLOW - rng.getrandbits(40), 60, self.parameters.axes)
        self.write(channel, r.CHANNEL_RATE_TARGET, rate, slew, stop_slew)
        self.push(channel, lines, ramps)
        channel.start()
        changes: list[tuple[int, int, int]] = []  # the clock of a write, the goal, the slew
        targets = [rng.randint(1, RATE_ONE), 0, rng.randint(RATE_ONE // 2, RATE_ONE)]
        for target in targets[: 1 if stops else 3]:
            self.engine.run(rng.randint(900, 1600))
            self.write(channel, r.CHANNEL_RATE_TARGET, target)
            changes.append((self.engine.clock - FRAME, target, slew))
        if stops:
            self.engine.run(rng.randint(300, 1600))
            channel.stop()
            changes.append((self.engine.clock - FRAME, 0, stop_slew))
        self.wait(channel)
        begin, end = self.runs(channel)
        clocks = substep_clocks(ramps, self.tick.bit_length() - 1)
        observed = [self.steps(channel, axis) for axis in range(self.parameters.axes)]

        def fits(phase: int, late: tuple[int, ...]) -> bool:
            made = self.enabled(begin, end, rate, changes, phase, late)
            due = [begin + int(made[n - 1]) for n in clocks if n <= len(made)]
            return all(
                steps == [(due[n], way) for n, way in all_substeps(lines, axis, len(due))]
                for axis, steps in enumerate(observed)
            )

        known = phases.get(self.parameters, range(self.tick))
        options = list(product((0, 1), repeat=len(changes)))  # the slew tick that sees a write, or the next
        phases[self.parameters] = {phase for phase in known if any(fits(phase, late) for late in options)}
        assert phases[self.parameters], "steps at a rate that changes"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.STOP if stops else Cause.NONE)

    def enabled(
        self,
        begin: int,
        end: int,
        rate: int,
        changes: Sequence[tuple[int, int, int]],
        phase: int,
        late: Sequence[int],
    ) -> np.ndarray:
        """The clocks that are enabled, from 1 on, when slew ticks act on clocks that are `phase`."""
        rates = np.empty(end - begin + 1, np.int64)
        at = begin
        tick = begin + (phase - begin) % self.tick
        seen = []
        for (clock, _, _), later in zip(changes, late, strict=True):
            first = clock + (phase - clock) % self.tick
            seen.append(first + self.tick * later)
        while at <= end:
            rates[at - begin : max(tick, at) - begin] = rate
            at = max(tick, at)
            now = [i for i, first in enumerate(seen) if first <= tick]
            if now:
                _, goal, slew = changes[now[-1]]
                rate = min(rate + slew, goal) if rate < goal else max(rate - slew, goal)
            tick += self.tick
            rates[at - begin : min(tick, end + 1) - begin] = rate
            at = min(tick, end + 1)
        total = np.cumsum(rates) >> 16
        return np.searchsorted(total, np.arange(1, int(total[-1]) + 1)) + 1

    def aborted(self, channel: Channel) -> None:
        """A long line with steps of all sizes, until an abort."""
        rng = self.rng
        velocity = ONE // rng.randint(50, 90)
        m = rng.getrandbits(30) | 1 << 29
        steps = tuple(rng.choice((-1, 1)) * rng.randrange(m // 4, m + 1) for _ in range(self.parameters.axes))
        lines = [Line(m, steps, last=True)]
        ramps = [Ramp(velocity, 0), Ramp(velocity, 80), Ramp(0, 1, last=True)]
        self.push(channel, lines, ramps)
        channel.start()
        self.engine.run(rng.randint(5000, 8000))
        channel.abort()
        at = self.engine.clock
        self.engine.run(1000)
        self.see()
        begin, end = self.runs(channel)
        assert end <= at, "running after an abort"
        clocks = [begin + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        self.check_steps(channel, lines, clocks, exact=False)
        made = [self.steps(channel, axis) for axis in range(self.parameters.axes)]
        longest = max(clock for axis in made for clock, _ in axis)
        assert end - 100 * 4 < longest <= end + TIME, "the last step before an abort"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.ABORT)

    def underrun(self, channel: Channel) -> None:
        """Lines that end without a successor: all of their steps, and a hard stop."""
        lines, ramps = self.draw()
        lines = [Line(line.substeps, line.steps) for line in lines[:-1] or [Line(9, lines[0].steps)]]
        lines = [Line(line.substeps, tuple(n % (line.substeps + 1) for n in line.steps)) for line in lines]
        velocity = SLOW - self.rng.getrandbits(38)
        ramps = [Ramp(velocity, 0), Ramp(velocity, 1 << 20, last=True)]
        self.push(channel, lines, ramps)
        channel.start()
        self.wait(channel)
        begin, _ = self.runs(channel)
        count = sum(line.substeps for line in lines)
        # phase 1/4 when it starts
        clocks = [begin - ((ONE // 4 - k * ONE) // velocity) for k in range(1, count + 1)]
        self.check_steps(channel, lines, clocks)
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.LINE_UNDERRUN)

    def starved(self, channel: Channel) -> None:
        """Ramps that run out at speed: a soft stop, by the slew of a stop."""
        rng = self.rng
        velocity = SLOW - rng.getrandbits(38)
        slew = rng.randint(3000, 30000)
        self.write(channel, r.CHANNEL_STOP_SLEW, slew)
        lines, _ = self.cruise(velocity, 1, self.parameters.axes)
        lines = [Line(1 << 20, tuple(n * ((1 << 20) // 64) for n in lines[0].steps))]
        self.push(channel, lines, [Ramp(velocity, 0), Ramp(velocity, rng.randint(3, 9))])
        channel.start()
        self.wait(channel)
        begin, end = self.runs(channel)
        count = sum(1 for _ in all_substeps([Line(1, (1,), endless=True)], 0, 400))
        clocks = [begin - ((ONE // 4 - k * ONE) // velocity) for k in range(1, count + 1)]
        ticks = -(-RATE_ONE // slew)  # until the rate is 0
        assert (ticks - 2) * self.tick < end - begin < (ticks + 12) * self.tick, "a soft stop lasts"
        for axis in range(self.parameters.axes):
            due = [(clocks[n], way) for n, way in all_substeps(lines, axis, len(clocks))]
            made = self.steps(channel, axis)
            full = [step for step in made if step[0] < begin + 2 * self.tick]
            assert full == due[: len(full)], f"steps of axis {axis} before the stop"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.RAMP_UNDERRUN)

    def drained(self, channel: Channel) -> None:
        """The last line lacks substeps, which come at the drain velocity and are counted."""
        rng = self.rng
        _, ramps = self.draw(4)
        period = rng.randint(40, 120)
        self.write(channel, r.CHANNEL_DRAIN_VELOCITY, (1 << 32) // period)
        clocks = substep_clocks(ramps, self.tick.bit_length() - 1)
        lacking = rng.randint(3, 40)
        m = len(clocks) + lacking
        lines = [Line(m, tuple(rng.choice((-m, m)) for _ in range(self.parameters.axes)), last=True)]
        self.push(channel, lines, ramps)
        channel.start()
        self.wait(channel)
        begin, _ = self.runs(channel)
        for axis in range(self.parameters.axes):
            made = [clock - begin for clock, _ in self.steps(channel, axis)]
            assert made[: len(clocks)] == clocks, f"steps of axis {axis}"
            gaps = np.diff(made[len(clocks) :])
            assert len(gaps) == lacking - 1 and (abs(gaps - period) <= 1).all(), "drained"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.NONE, lacking)

    def overrun(self, channel: Channel) -> None:
        """Steps that come faster than the pins let them out stop the channel, and are counted."""
        axis = self.rng.randrange(self.parameters.axes)
        bit = channel.number * self.parameters.axes + axis
        high, self.high[bit] = self.high[bit], self.rng.randint(300, 3000)
        timing = channel.axis_base(axis) + r.AXIS_STEP_TIMING
        self.link.write(timing, self.high[bit] << 16 | 1)
        steps = tuple(int(other == axis) for other in range(self.parameters.axes))
        self.push(channel, [Line(1, steps, endless=True)], [Ramp(SLOW, 0), Ramp(SLOW, 900, last=True)])
        channel.start()
        self.wait(channel)
        self.engine.run(8 * self.high[bit])
        self.see()
        begin, end = self.runs(channel)
        assert end - begin < 3 * self.high[bit] + 400, "an overrun stops it"
        assert channel.state().overrun == 1 << axis, "the axis that overran"
        lost = [
            self.link.read(channel.axis_base(other) + r.AXIS_LOST_STEPS, 1)[0]
            for other in range(self.parameters.axes)
        ]
        assert [bool(n) for n in lost] == [other == axis for other in range(self.parameters.axes)], "lost"
        self.check_positions(channel, [0] * self.parameters.axes)
        self.check_end(channel, Cause.STEP_OVERRUN)
        self.high[bit] = high
        self.link.write(timing, high << 16 | TIME)

    def synchronized(self) -> None:
        """All channels begin 4 clocks after the edge of `sync`, and not before."""
        lines = [Line(40, (40,) * self.parameters.axes, last=True)]
        ramps = [Ramp(SLOW, 0), Ramp(SLOW, 13, last=True)]
        everyone = (1 << len(self.channels)) - 1
        for channel in self.channels:
            self.push(channel, lines, ramps)
        self.link.write(r.ADDRESS_RUN, everyone << r.RUN_RUN_LSB | everyone << r.RUN_WAIT_SYNC_LSB)
        self.engine.run(500)
        assert all(channel.state().state == State.ARMED for channel in self.channels), "ARMED"
        assert not self.engine.running
        self.engine.drain()
        self.engine.sync(True)
        self.engine.run(30)
        self.engine.sync(False)
        for channel in self.channels:
            self.wait(channel)
        begun = {self.runs(channel) for channel in self.channels}
        assert len(begun) == 1, "they begin and end together"
        clocks = [begun.copy().pop()[0] + n for n in substep_clocks(ramps, self.tick.bit_length() - 1)]
        for channel in self.channels:
            self.check_steps(channel, lines, clocks[:40])
            self.check_end(channel, Cause.NONE)


def check(engine: Engine, parameters: Parameters, rng: random.Random) -> None:
    """Play each kind of motion, some on each channel.

    Raises:
        AssertionError: Something is not as it is known to be.
    """
    motions = Motions(engine, parameters, rng)
    motions.set_up()
    for channel in motions.channels:
        motions.exact(channel)
    slews = rng.randint(SLEWS - MOST_SLEW, MOST_SLEW), rng.randint(SLEWS - MOST_SLEW, MOST_SLEW)
    for stops in (False, True):  # each bit of a slew is 0 once, and 1
        motions.paced(rng.choice(motions.channels), stops, slews)
        motions.paced(rng.choice(motions.channels), stops, (SLEWS - slews[0], SLEWS - slews[1]))
    kinds = (motions.aborted, motions.underrun, motions.drained, motions.starved, motions.overrun)
    for play in kinds:
        play(rng.choice(motions.channels))
    for channel in motions.channels:
        motions.exact(channel)
    motions.synchronized()


CHECK = Check("motions", "motions", check)
