# SPDX-License-Identifier: MIT
"""The main loop of a host in simulated time, and the steps that it causes."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from passo.engine import moves_of

DRAIN = 1 << 15  # events that are worth to be drained


@dataclass(frozen=True)
class Steps:
    """What left the pins: times in clocks since the start of the first motion."""

    clocks: list[np.ndarray]  # of the steps of each axis
    positions: list[np.ndarray]  # in steps, after each of them
    begins: list[int]  # of the motions
    ends: list[int]
    origin: int  # clock of that start
    events: np.ndarray  # of the pins, EVENT


class HostLoop:
    """Turns of a main loop at `engine`, `period` clocks apart, and the events of the pins in them."""

    def __init__(self, engine: Any, period: int):
        self.engine, self.period = engine, period
        self._events = [engine.drain()]

    def turn(self, poll: Callable[[], None], rests: Callable[[], bool] = lambda: False) -> None:
        """Poll, and let time pass; if the host then `rests` (passo_rests.h), up to the poll that has news."""
        began = self.engine.clock
        poll()
        look, idle = self.engine.clock - began, rests()
        self.run(self.period)
        if idle and look:
            self.engine.pass_looks(look + self.period, look)

    def run(self, clocks: int) -> None:
        """Let time pass."""
        if self.engine.waiting > DRAIN:
            self._events.append(self.engine.drain())
        self.engine.run(clocks)

    def last_step(self) -> int:
        """Clock of the last step so far; 0: there was none."""
        self._events.append(self.engine.drain())
        steps = (events["clock"][events["step"] > 0] for events in reversed(self._events))
        return next((int(clocks[-1]) for clocks in steps if len(clocks)), 0)

    def steps(self, axes: int) -> Steps:
        """All steps so far."""
        self._events.append(self.engine.drain())
        events = np.concatenate(self._events)
        running = np.concatenate([[0], events["running"] & 1]).astype(bool)
        rises = events["clock"][running[1:] & ~running[:-1]].astype(np.int64)
        falls = events["clock"][running[:-1] & ~running[1:]].astype(np.int64)
        origin = int(rises[0]) if len(rises) else 0
        clocks, positions = [], []
        for axis in range(axes):
            moves = moves_of(events, axis)
            made = np.flatnonzero(moves)
            clocks.append(events["clock"][made].astype(np.int64) - origin)
            positions.append(np.cumsum(moves[made]))
        return Steps(clocks, positions, (rises - origin).tolist(), (falls - origin).tolist(), origin, events)
