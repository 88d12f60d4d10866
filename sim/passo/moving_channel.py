# SPDX-License-Identifier: MIT
"""A channel while it executes a planned motion."""

from dataclasses import dataclass, field

import numpy as np

from passo.driver import Driver, DriverError, Source
from passo.engine import EVENT
from passo.moves import MoveFile
from passo.plan import Plan

SOON = 1 << 16  # clocks: some tens of frames
ENOUGH = 1 << 16  # events: rows of the core take six times as much memory as those of one channel
SLEWS_PER_SECOND = 20  # of hold and stop, from full speed
# The pins of one channel that change during a motion.
PINS = np.dtype([("clock", "u8"), ("step", "u1"), ("dir", "u1"), ("running", "?")])


@dataclass
class MovingChannel:
    """A channel while it moves."""

    file: MoveFile
    plans: list[Plan]
    driver: Driver
    source: Source = field(init=False)
    events: list[np.ndarray] = field(default_factory=list)  # of the core, at most ENOUGH before the last
    parts: list[np.ndarray] = field(default_factory=list)  # of its pins, before these
    moves: bool = True

    def __post_init__(self) -> None:
        ramps = [ramp for plan in self.plans for ramp in plan.ramps]
        self.source = Source([plan.line for plan in self.plans], ramps)

    @property
    def planned(self) -> int:
        """Length of its motion in clocks."""
        return sum(plan.clocks for plan in self.plans)

    def configure(self) -> None:
        """Set pins and speeds of holds, stops and the drain."""
        for axis in range(self.file.axes):
            self.driver.configure_axis(axis, self.file.pins)
        slowest = min(plan.c.velocity_peak for plan in self.plans)
        slew = self.driver.clock_hz // SLEWS_PER_SECOND
        self.driver.call("configure_motion", slew, slew, max(1, slowest >> 16 >> 4))

    def collect(self, events: np.ndarray) -> None:
        """Store its part of the pin events."""
        if len(events):
            self.events.append(events)
        if sum(map(len, self.events)) > ENOUGH:
            self._compact()

    def _compact(self) -> None:
        """Keep only what is its own of the events so far."""
        # as bytes: to join records, numpy looks at each of their fields
        events = np.concatenate([part.view(np.uint8) for part in self.events]).view(EVENT)
        pins = self.driver.engine.parameters.axes
        compact = np.empty(len(events), PINS)
        compact["clock"] = events["clock"]
        for name in ("step", "dir"):
            compact[name] = events[name] >> np.uint64(self.file.channel * pins) & np.uint64((1 << pins) - 1)
        compact["running"] = events["running"] >> np.uint32(self.file.channel) & np.uint32(1)
        self.parts.append(compact)
        self.events.clear()

    @property
    def pins(self) -> np.ndarray:
        """The pins (PINS) at all events so far."""
        if self.events:
            self._compact()
        return np.concatenate([part.view(np.uint8) for part in self.parts]).view(PINS)

    def poll(self) -> None:
        """Poll the driver while it has something to do."""
        if not self.moves:
            return
        try:
            self.driver.poll()
            while self.driver.idle_microseconds == 0 and self.driver.is_moving:
                self.driver.poll()
            self.moves = self.driver.is_moving
        except DriverError:
            if not self.driver.c.fault:
                raise
            self.moves = False  # the state shows the cause

    def hungry(self) -> int:
        """Clocks from the start of the motion until it is time for more ramps.

        Half of the queue is free by then; if what it holds is over soon, there is room for one.
        """
        parameters, ticks = self.driver.engine.parameters, self.source.ticks
        places = 1 << parameters.ramp_queue_log2
        room, half = sum(ticks[: 1 - places]), sum(ticks[: -places // 2])
        soon = sum(ticks) - (SOON >> parameters.tick_log2)
        return max(room, min(half, soon)) << parameters.tick_log2
