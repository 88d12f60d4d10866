# SPDX-License-Identifier: MIT
"""A simulated machine at the pins of an engine: axes that follow STEP and DIR, and their switches."""

import random
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from passo.engine import EVENT, AroundEngine, bits_of

GRAINS_PER_S = 100_000  # how often the switches are checked
RESTING_GRAINS = 10  # as many together while no pin changes
SWITCH = re.compile(
    r"(limit_low|limit_high|home|alarm|probe):(\d{1,2}):(?:\.\.(-?\d{1,10})|(-?\d{1,10})\.\.)"
)
STEPS = range(-(1 << 31), 1 << 31)  # what a counter of positions holds


@dataclass
class Switch:
    """A switch or probe in the travel of an axis; `pin` is an input of the core, such as "home"."""

    pin: str
    axis: int
    at: int  # physical position in steps from which on it is active
    above: bool = False  # active above, else below
    hysteresis: int = 0  # steps back from `at` before it is inactive again
    bounce: int = 0  # clocks of chatter after every change
    inverted: bool = False  # active low
    stuck: bool | None = None  # permanently active or inactive
    active: bool = False  # without chatter
    changed_at: int = -(1 << 60)  # clock of the last change
    edges: list[tuple[int, int]] = field(default_factory=list)  # position and clock of each change

    def look(self, position: int, clock: int) -> None:
        """The axis is there now."""
        beyond = position - self.at if self.above else self.at - position
        active = beyond >= (-self.hysteresis if self.active else 0)
        if self.stuck is not None:
            active = self.stuck
        if active != self.active:
            self.active, self.changed_at = active, clock
            self.edges.append((position, clock))

    def level(self, clock: int, rng: random.Random) -> bool:
        """Of the pin."""
        chatters = clock - self.changed_at < self.bounce
        return (rng.random() < 0.5 if chatters else self.active) != self.inverted


def read_switch(text: str) -> Switch:
    """A switch as users write it: home:0:..-500 is active up to -500, limit_high:1:9000.. from 9000 on."""
    match = SWITCH.fullmatch(text)
    if not match or int(match[3] or match[4]) not in STEPS:
        raise ValueError(
            f"{text}: a switch is PIN:AXIS:..POSITION or PIN:AXIS:POSITION.., in steps of 32 bits"
        )
    pin, axis, below, above = match.groups()
    return Switch(pin, int(axis), int(below or above), above=below is None)


class Machine(AroundEngine):
    """An engine with a machine at it: whatever has the interface of passo.engine.Engine.

    The axes begin at `start`, steps of the machine, which the core does not know. A switch sees a position up
    to 1/100000 s late, after a rest 1/10000 s, and not during a frame.
    """

    def __init__(
        self, engine: Any, switches: Sequence[Switch] = (), start: Sequence[int] = (), seed: int = 1
    ):
        super().__init__(engine)
        self.switches = list(switches)
        pins = self.parameters.channels * self.parameters.axes
        self.positions = np.zeros(pins, np.int64)
        self.positions[: len(start)] = start
        self.frames = 0
        self.noise: dict[str, float] = {}  # pin: share of the looks at which a random bit of it flips
        self.enable = 0  # levels of the EN pins
        self._rng = random.Random(seed)
        self._step = np.uint64(0)
        self._rests = False  # nothing has changed at the last look
        self._levels: dict[str, int] = {}
        self._events: list[np.ndarray] = []  # for drain()
        self._look()

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin that has no switch."""
        self.engine.set(pin, levels)

    def drain(self) -> np.ndarray:
        """The pin events since the last call, as those of the engine."""
        events, self._events = self._events, []
        return np.concatenate([np.empty(0, EVENT), *events])

    def transfer(self, mosi: Sequence[int], gap: int = 64) -> list[int]:
        """One chip select."""
        self.frames += 1
        miso = self.engine.transfer(mosi, gap)
        self._look()
        return miso

    def run(self, clocks: int) -> int:
        """Let time pass."""
        done = 0
        while done < clocks:
            grain = self.clock_hz // GRAINS_PER_S * (RESTING_GRAINS if self._rests else 1)
            done += self.engine.run(min(grain, clocks - done))
            self._look()
        return done

    def _look(self) -> None:
        events = self.engine.drain()
        if len(events):
            self._events.append(events)
            self._follow(events)
        levels = dict.fromkeys((switch.pin for switch in self.switches), 0)
        for switch in self.switches:
            switch.look(int(self.positions[switch.axis]), self.clock)
            at = switch.axis // self.parameters.axes if switch.pin == "probe" else switch.axis
            levels[switch.pin] |= switch.level(self.clock, self._rng) << at
        for pin, share in self.noise.items():
            if self._rng.random() < share:
                levels[pin] = levels.get(pin, 0) ^ 1 << self._rng.randrange(len(self.positions))
            levels.setdefault(pin, 0)
        for pin, level in levels.items():
            if self._levels.get(pin) != level:
                self.engine.set(pin, level)
        self._rests = not len(events) and self._levels == levels
        self._levels = levels

    def _follow(self, events: np.ndarray) -> None:
        """The axes go where the rising edges of STEP tell them."""
        step = np.concatenate([[self._step], events["step"]])
        count = len(self.positions)
        rising, down = bits_of(~step[:-1] & step[1:], count), bits_of(events["dir"], count)
        self.positions += rising.sum(axis=0, dtype=np.int64) - 2 * (rising & down).sum(axis=0, dtype=np.int64)
        self._step = step[-1]
        self.enable = int(events["enable"][-1])
