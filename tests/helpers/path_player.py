# SPDX-License-Identifier: MIT
"""Plays paths on the C model through the driver, and returns the steps that left the pins."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.driver import Driver
from passo.engine import Engine, model_engine
from passo.host_loop import HostLoop
from passo.moves import PinTiming
from passo.path import Path, PathFeed, PathSettings

from benchmarks.path_reference import Line

PARAMETERS = Parameters(axes=4)
PINS = PinTiming()
SLEW_MICROSECONDS = 20_000
LOOP_CLOCKS = 64_000  # a millisecond between two polls


@dataclass
class Played:
    """Steps of each motor: clocks since the start of the first motion, and positions after them."""

    clocks: list[np.ndarray]
    steps: list[np.ndarray]
    motions: list[tuple[int, int]]  # begin and end of each motion, in clocks
    positions: list[int]
    drained: int

    @property
    def moving(self) -> int:
        """Clocks of all motions."""
        return sum(end - begin for begin, end in self.motions)


class Player:
    """A core with a path. `poll` passes time; `finish` returns what was played."""

    def __init__(self, settings: PathSettings, look_ahead: int, loop: int = LOOP_CLOCKS, **parameters: Any):
        self.settings, self.loop = settings, loop
        self.engine: Engine = model_engine(Parameters(**{"axes": 4, **parameters}), settings.clock_hz)
        self.driver = Driver(self.engine, settings.clock_hz, self.engine.parameters)
        for axis in range(len(settings.scales)):
            self.driver.configure_axis(axis, PINS)
        self.driver.call("configure_motion", SLEW_MICROSECONDS, SLEW_MICROSECONDS, 1 << 20)
        self.path = Path(settings, self.engine.parameters, look_ahead)
        self.feed = PathFeed(self.driver, self.path)
        self.turns = HostLoop(self.engine, loop)

    def poll(self, until: Callable[[], bool] = lambda: True) -> None:
        """One poll, or several without an effect, `until` a condition that only a poll can fulfil."""
        self.turns.turn(self.feed.poll, lambda: not until() and self.feed.rests)

    def wait(self, until: Callable[[], bool], polls: int = 2_000_000) -> None:
        for _ in range(polls):
            if until():
                return
            self.poll(until)
        raise AssertionError("it takes too long")

    def rest(self, seconds: float) -> None:
        """Let time pass."""
        end = self.engine.clock + seconds * self.settings.clock_hz
        while self.engine.clock < end:
            self.poll()

    def add(self, target: Sequence[float], feed: float | None) -> None:
        """Add a line as soon as there is room."""
        self.wait(lambda: self.path.room > 0)
        self.path.add(target, feed)

    def finish(self) -> Played:
        self.path.end()
        self.wait(lambda: not self.feed.is_moving)
        return self.played()

    def played(self) -> Played:
        self.turns.run(1000)
        axes = len(self.settings.scales)
        steps = self.turns.steps(axes)
        ends = [*steps.ends, self.engine.clock - steps.origin][: len(steps.begins)]
        return Played(
            steps.clocks,
            steps.positions,
            list(zip(steps.begins, ends, strict=True)),
            self.driver.positions()[:axes],
            int(self.driver.snapshot().drained),
        )


def play(
    lines: Iterable[Line],
    settings: PathSettings,
    look_ahead: int = 48,
    loop: int = LOOP_CLOCKS,
) -> Played:
    """Play a path whose lines are all at hand."""
    player = Player(settings, look_ahead, loop)
    try:
        for target, feed in lines:
            player.add(target, feed)
        return player.finish()
    finally:
        player.engine.close()
