# SPDX-License-Identifier: MIT
"""Plays paths on the C model through the driver, and returns the steps that left the pins."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.driver import Driver
from passo.engine import Engine, model_engine
from passo.moves import PinTiming
from passo.path import Path, PathFeed, PathSettings

from benchmarks.path_reference import Line

PARAMETERS = Parameters(axes=4)
PINS = PinTiming()
SLEW_MICROSECONDS = 20_000
LOOP_CLOCKS = 64_000  # a millisecond between two polls


@dataclass
class Played:
    """Steps of each axis: clocks since the start of the first motion, and positions after them."""

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
        for axis in range(len(settings.axes)):
            self.driver.configure_axis(axis, PINS)
        self.driver.call("configure_motion", SLEW_MICROSECONDS, SLEW_MICROSECONDS, 1 << 20)
        self.path = Path(settings, self.engine.parameters, look_ahead)
        self.feed = PathFeed(self.driver, self.path)
        self.events: list[np.ndarray] = []

    def poll(self) -> None:
        self.feed.poll()
        self.engine.run(self.loop)
        self.events.append(self.engine.drain())

    def wait(self, until: Callable[[], bool], polls: int = 2_000_000) -> None:
        for _ in range(polls):
            if until():
                return
            self.poll()
        raise AssertionError("it takes too long")

    def rest(self, seconds: float) -> None:
        """Let time pass."""
        end = self.engine.clock + seconds * self.settings.clock_hz
        self.wait(lambda: self.engine.clock >= end)

    def add(self, target: Sequence[float], feed: float | None) -> None:
        """Add a line as soon as there is room."""
        self.wait(lambda: self.path.room > 0)
        self.path.add(target, feed)

    def finish(self) -> Played:
        self.path.end()
        self.wait(lambda: not self.feed.is_moving)
        return self.played()

    def played(self) -> Played:
        self.engine.run(1000)
        self.events.append(self.engine.drain())
        events = np.concatenate(self.events)
        running = np.concatenate([[0], events["running"] & 1]).astype(bool)
        rises = events["clock"][running[1:] & ~running[:-1]].astype(np.int64)
        falls = events["clock"][running[:-1] & ~running[1:]].astype(np.int64)
        origin = int(rises[0]) if len(rises) else 0
        clocks, steps = [], []
        for axis in range(len(self.settings.axes)):
            level = (events["step"] >> np.uint64(axis)).astype(np.int64) & 1
            rising = np.flatnonzero(np.diff(level, prepend=0) == 1)
            back = (events["dir"][rising] >> np.uint64(axis) & np.uint64(1)).astype(np.int64)
            clocks.append(events["clock"][rising].astype(np.int64) - origin)
            steps.append(np.cumsum(1 - 2 * back))
        ends = [*falls.tolist(), self.engine.clock][: len(rises)]
        return Played(
            clocks,
            steps,
            [(b - origin, e - origin) for b, e in zip(rises.tolist(), ends, strict=True)],
            self.driver.positions()[: len(self.settings.axes)],
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
