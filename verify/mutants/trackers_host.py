# SPDX-License-Identifier: MIT
"""The host of a core with trackers, which knows what is due at the pins.

What a write changes acts within some ticks: all of them are tried, and one must explain every step.
"""

import random
from collections.abc import Sequence
from typing import Any

import numpy as np
from passo import registers as r
from passo.build import Parameters
from passo.host import Channel
from passo.moves import PinTiming

from verify.mutants.motions_judge import FRAME, TIME, Motions
from verify.mutants.trackers_due import LATE, STEP, Hand, Write, applied, nearest, signed

TURN = 32  # clocks
OPTIONS = 100_000  # ways in which writes may have acted; more are never needed

# When the steps leave the pins: clocks after the turn of their axis begins, as it is in the core itself.
phases: dict[Parameters, int] = {}


class Host(Motions):
    """A core whose trackers are judged."""

    def __init__(self, engine: Any, parameters: Parameters, rng: random.Random):
        super().__init__(engine, parameters, rng)
        self.axes = parameters.axes
        self.turns = 8 if self.axes > 4 else 4
        self.channel: Channel = self.channels[0]
        self.timings: list[PinTiming] = []
        self.hands = [{Hand()} for _ in range(self.axes)]  # all that it may be
        self.writes: list[list[Write]] = [[] for _ in range(self.axes)]
        self.shown: list[tuple[int, int, list[int]]] = []
        self.targets = [(0, 0)] * self.axes  # of an axis that went up last, or down
        self.down = [False] * self.axes
        self.origin = 0  # clock at which the first turn begins
        self.since = 0  # clock of the last look
        self.made = 0  # steps so far
        self.apart: list[int] = []  # positions without the trackers

    @property
    def period(self) -> int:
        """Clocks of a tick."""
        return TURN * self.turns

    # --- The host --------------------------------------------------------------------------------

    def set_up(self) -> None:
        """Any polarity and timing of each axis, and all drives enabled."""
        super().set_up()
        for axis in range(self.axes):
            timing = PinTiming(*(self.rng.randint(1, TIME) for _ in range(4)))
            word = timing.step_high << 16 | timing.step_low, timing.dir_setup << 16 | timing.dir_hold
            self.link.write(self.channel.axis_base(axis) + r.AXIS_STEP_TIMING, *word)
            self.timings.append(timing)
            self.high[axis] = timing.step_high
        self.see()
        self.events = self.events[-1:]
        self.look()

    def look(self) -> None:
        """Forget the events so far."""
        self.engine.run(10)
        self.see()
        self.check_times()
        self.made += sum(len(self.steps(self.channel, axis)) for axis in range(self.axes))
        self.events = self.events[-1:]
        self.since = self.engine.clock

    def tell(self, axis: int, **told: int) -> None:
        """Note what a write has told an axis."""
        self.writes[axis].append(Write(self.engine.clock - FRAME, told))

    def limit(self, axis: int, speed: int, acceleration: int | None = None) -> None:
        """Write its speed; and its acceleration, only at rest."""
        words = [speed] if acceleration is None else [speed, acceleration]
        self.link.write(self.channel.axis_base(axis) + r.AXIS_TRACKER_SPEED, *words)
        more = {} if acceleration is None else {"acceleration": acceleration}
        self.tell(axis, speed=speed, **more)

    def go(self, axis: int, target: int, back: int = 0) -> None:
        """Write its target; the one of an axis that went down is another."""
        base = self.channel.base + axis
        arrays = r.CHANNEL_TRACKER_TARGET_BASE, r.CHANNEL_TRACKER_TARGET_DOWN_BASE
        words = [target % STEP, (target - back) % STEP]
        self.targets[axis] = (signed(words[0], 32), signed(words[1], 32))
        for place in (1, 0) if self.down[axis] is False else (0, 1):  # what acts, last
            self.link.write(base + arrays[place], words[place])
        self.tell(axis, target=self.targets[axis][self.down[axis]])

    def enable(self, axes: int) -> None:
        """Let some trackers follow their targets, as bits."""
        self.link.write(self.channel.base + r.CHANNEL_TRACKER_ENABLE, axes)
        for axis in range(self.axes):
            self.tell(axis, follows=axes >> axis & 1)

    def state(self) -> r.ChannelTrackerStateWord:
        """Read TRACKER_STATE."""
        (word,) = self.link.read(self.channel.base + r.CHANNEL_TRACKER_STATE, 1)
        return r.ChannelTrackerStateWord.unpack(word)

    def read(self) -> list[int]:
        """Read TRACKER_POSITION of all axes."""
        words = self.link.read(self.channel.base + r.CHANNEL_TRACKER_POSITION_BASE, self.axes)
        return [signed(word, 32) for word in words]

    def settle(self, most: int = 2_000_000) -> None:
        """Until all trackers rest."""
        for _ in range(most // 1000):
            self.engine.run(1000)
            if self.channel.state().quiet:
                break
        else:
            raise AssertionError(f"trackers come to rest: {self.channel.state()} {self.state()}")
        self.engine.run(6 * TIME)
        self.see()

    def check_times(self) -> None:
        """STEP is inactive, and DIR keeps its level, for as long as it must."""
        clocks = self.events["clock"].astype(np.int64)
        for axis, timing in enumerate(self.timings):
            step, way = (
                ((self.events[pin] ^ self.inverted[pin]) >> axis & 1).astype(np.int8)
                for pin in ("step", "dir")
            )
            change = np.diff(step)
            rises, falls = clocks[1:][change == 1], clocks[1:][change == -1]
            assert (rises[1:] - falls[: len(rises) - 1] >= timing.step_low).all(), "STEP is inactive"
            for turn in clocks[1:][np.diff(way) != 0]:
                after, before = rises[rises >= turn], falls[falls <= turn]
                assert not len(after) or after[0] - turn >= timing.dir_setup, "DIR setup"
                hold = timing.step_low + timing.dir_hold
                assert not len(before) or turn - before[-1] >= hold, "DIR hold"

    # --- What is due -----------------------------------------------------------------------------

    def tick_of(self, axis: int, clock: int) -> tuple[int, int]:
        """The tick in which a step of a tracker leaves the pins, and by how many clocks it is late."""
        since = clock - self.origin - TURN * axis - phases[self.parameters]
        return since // self.period, since % self.period

    def clock_of(self, axis: int, tick: int) -> int:
        """When a step of a tick leaves the pins."""
        return self.origin + TURN * axis + phases[self.parameters] + tick * self.period

    def alone(self) -> None:
        """Every step since the last look is in its tick, of an axis that no path moves."""
        self.see()
        shown: list[list[set[int]]] = []
        for axis in range(self.axes):
            made: dict[int, int] = {}
            before = 0
            for clock, way in self.steps(self.channel, axis):
                tick, late = self.tick_of(axis, clock)
                timing = self.timings[axis]
                turns = timing.dir_setup + timing.dir_hold + timing.step_low if way != before else 0
                assert late <= turns + 2 * bool(turns), f"a step of axis {axis} is {late} clocks late"
                assert tick not in made, f"two steps of axis {axis} in a tick"
                made[tick], before = way, way
            first = self.tick_of(axis, self.since)[0] - LATE
            until = self.tick_of(axis, self.engine.clock)[0]
            if made and max(made) > until:
                until = max(made)
            shown.append(self.follow(axis, made, first, until))
        self.check_shown(shown)
        self.look()

    def follow(self, axis: int, made: dict[int, int], first: int, until: int) -> list[set[int]]:
        """Play the ticks; the positions that a host may see in each of the last ones."""
        writes = [(self.tick_of(axis, write.clock)[0], write.told) for write in self.writes[axis]]
        hands = self.hands[axis]
        looks: dict[int, set[int]] = {}
        for tick in range(first, until + 1):
            options = set()
            for hand in hands:
                options |= set(applied(hand, writes, tick))
            hands = {
                after
                for hand in options
                if nearest((after := hand.tick()).position) - nearest(hand.position) == made.get(tick, 0)
            }
            assert hands, f"axis {axis}: step {made.get(tick, 0)} in tick {tick}"
            assert len(hands) < OPTIONS
            looks[tick] = {nearest(hand.position) for hand in hands}
        done = {hand for hand in hands if hand.applied == len(writes)}
        assert done, f"axis {axis}: a write acts"
        self.hands[axis] = {hand._replace(applied=0) for hand in done}
        self.writes[axis] = []
        seen = []
        for begun, ended, _ in self.shown:
            ticks = range(self.tick_of(axis, begun)[0] - 1, self.tick_of(axis, ended)[0] + 1)
            seen.append(set().union(*(looks.get(tick, set()) for tick in ticks)))
        return seen

    def check_shown(self, due: list[list[set[int]]]) -> None:
        """What was read on the way is what was due then."""
        for n, (_, _, positions) in enumerate(self.shown):
            for axis, position in enumerate(positions):
                assert position in due[axis][n], f"TRACKER_POSITION of axis {axis}: {position}"
        self.shown = []

    def position(self, axis: int) -> int:
        """In whole steps, at rest."""
        (position,) = {nearest(hand.position) for hand in self.hands[axis]}
        return position

    def check_rest(self, enabled: int) -> None:
        """At rest: registers and pins agree, and nothing waits. What would still move is ruled out."""
        state, read = self.state(), self.read()
        assert (state.enabled, state.moves) == (enabled, 0), f"{state}"
        self.hands = [{hand for hand in hands if hand.v == 0} for hands in self.hands]
        for axis, hands in enumerate(self.hands):
            assert hands, "at rest"
            at = {hand.position == hand.target * STEP for hand in hands}
            assert bool(state.at_target >> axis & 1) in at, f"at the target: {state}"
            assert read[axis] in {nearest(hand.position) for hand in hands}, "TRACKER_POSITION"

    def landed(self) -> None:
        """All are known to rest at their targets."""
        targets = [both[down] for both, down in zip(self.targets, self.down, strict=True)]
        assert self.read() == targets, "at the targets"
        self.know(targets)

    def know(self, positions: Sequence[int], **told: bool) -> None:
        """All trackers are known to rest at these positions, and have taken what was written."""
        for axis, hands in enumerate(self.hands):
            written: dict[str, Any] = {
                name: value for write in self.writes[axis] for name, value in write.told.items()
            }
            written |= {
                **told,
                "target": self.targets[axis][self.down[axis]],
                "position": positions[axis] * STEP,
            }
            known = next(iter(hands))._replace(**written, v=0, t=0, applied=0)
            self.hands[axis] = {known._replace(sign=sign) for sign in (-1, 1)}
            self.writes[axis] = []
        self.shown = []
        self.look()
