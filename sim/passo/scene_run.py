# SPDX-License-Identifier: MIT
"""Results of a move file with a machine."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from passo.move_forms import MachineTrack, MoveHome, MoveProbe
from passo.moves import MoveFile, Task
from passo.plan import Plan
from passo.registers import Cause
from passo.setup import Event, Setup

# What the host has read in one frame, all of one clock.
SAMPLE = np.dtype([("clock", "u8"), ("position", "i4", 8), ("encoder", "i4", 8)])
# What the trackers have made, read a frame later.
TRACKED = np.dtype([("clock", "u8"), ("position", "i4", 8)])
ROUND_CLOCKS = 64  # the core reads its positions in rounds from the reset on; docs/link.md
CS_CLOCKS = 4  # until chip select is seen


def sampled_at(clock: int) -> int:
    """Clock of the positions in a frame whose chip select falls at `clock`: the end of the next round."""
    return ((clock + CS_CLOCKS) // ROUND_CLOCKS + 1) * ROUND_CLOCKS - 1


@dataclass
class Section:
    """Moves that make one motion, or a home or a probe."""

    numbers: list[int]  # of its moves in the file
    moves: list[Any]
    plans: list[Plan]  # none of a home or probe
    begin: int = 0  # clock at which it has started to move
    end: int = 0
    start: list[int] = field(default_factory=list)  # positions of the machine
    outcome: str = "OK"  # name of an error of the driver
    raster: list[bytes] = field(default_factory=list)  # powers of its raster lines
    pitch: int = 0  # of them in substeps; 0: there are none

    @property
    def kind(self) -> str:
        """home, probe, thread or moves."""
        return self.moves[0].form.name if isinstance(self.moves[0], Task) else "moves"


@dataclass
class Stop:
    """The core has stopped."""

    clock: int
    cause: Cause
    positions: list[int]  # of the machine
    axes: list[int]  # of the limit or alarm
    latch: list[int] | None  # positions that the trigger latched, as the driver counts them


@dataclass
class Happened:
    """An event."""

    name: str  # "event 1", or "track 1"
    event: Event
    clock: int | None  # None: it never occurred
    positions: list[int]  # of the machine
    answered: int | None = None  # clock at which the frame of a command ended

    @property
    def number(self) -> int:
        """Of those of its kind in the file."""
        return int(self.name.split()[1])

    @property
    def mark(self) -> str:
        """In a picture: 1, or T1."""
        return f"T{self.number}" if self.is_track else str(self.number)

    @property
    def is_track(self) -> bool:
        """A target of a tracker."""
        return isinstance(self.event, MachineTrack)


@dataclass
class Latch:
    """What an armed trigger has latched."""

    number: int  # of the event that armed it
    positions: list[int]  # as the driver counts them


@dataclass
class Tracker:
    """A tracker at the end."""

    axis: int
    position: int
    target: int  # the last one that it was sent to
    at_target: bool
    enabled: bool


@dataclass
class SceneRun:
    """Result of a move file with a machine. Clocks are those of the engine."""

    file: MoveFile
    setup: Setup
    sections: list[Section]
    pins: np.ndarray  # EVENT
    inputs: np.ndarray  # CHANGE of passo.rig
    samples: np.ndarray  # SAMPLE
    events: list[Happened]
    stops: list[Stop]
    latches: list[Latch]
    positions: list[int]  # as the driver counts them
    core_positions: list[int]
    machine: list[int]  # positions of the machine
    greatest: list[float]  # following error of each encoder in steps
    troubles: list[str]  # what a command or a read has met
    trackers: list[Tracker]  # at the end, those that are used
    tracked: np.ndarray  # TRACKED
    matched_edges: int | None
    clocks: int
    seconds: float
    unmade: list[int] = field(default_factory=list)  # numbers of the moves after a stop
    start: int = 0  # clock at which the first motion started
    total_clocks: int = 0  # from there to the end of the last one

    def __post_init__(self) -> None:
        running = np.concatenate([[0], self.pins["running"] & 1])
        rises = self.pins["clock"][running[1:] > running[:-1]]
        falls = self.pins["clock"][running[1:] < running[:-1]]
        self.rises, self.falls = rises.astype(np.int64), falls.astype(np.int64)
        self.start = int(rises[0]) if len(rises) else 0
        self.total_clocks = int(falls[-1]) - self.start if len(falls) else 0
        for stop in self.stops:
            ends = self.falls[self.falls <= stop.clock]
            stop.clock = int(ends[-1]) if len(ends) else stop.clock
        for section in self.sections:
            ends = self.falls[(self.falls > section.begin) & (self.falls <= section.end)]
            begins = self.rises[self.rises >= section.begin]
            section.begin = int(begins[0]) if len(begins) else section.begin
            section.end = int(ends[-1]) if len(ends) else section.end

    def steps(self, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """Clocks since the start and directions of all steps of an axis."""
        level = self.pins["step"] >> np.uint64(axis) & np.uint64(1)
        rising = np.flatnonzero(level > np.concatenate([[0], level[:-1]]))
        negative = (self.pins["dir"][rising] >> np.uint64(axis) & np.uint64(1)).astype(np.int8)
        return self.pins["clock"][rising].astype(np.int64) - self.start, 1 - 2 * negative

    @property
    def ended(self) -> bool:
        """The last motion did."""
        return bool(len(self.rises)) and len(self.rises) == len(self.falls)

    def moved(self, section: Section) -> bool:
        """It was not refused."""
        return bool(((self.rises >= section.begin) & (self.rises <= section.end)).any())

    @property
    def plain_axes(self) -> list[int]:
        """Axes whose steps are those of the path alone."""
        return [axis for axis in range(self.file.axes) if axis not in self.setup.with_trackers]

    @property
    def shown_clocks(self) -> int:
        """Clocks from the start to the end of the last motion, or of the last step of a tracker."""
        ends = [int(self.steps(axis)[0].max(initial=0)) for axis in self.setup.with_trackers]
        return max([self.total_clocks, *ends])

    def asked(self, section: Section) -> int:
        """Steps of the moves of a section, of all axes without a tracker."""
        return sum(abs(move.steps[axis]) for move in section.moves for axis in self.plain_axes)

    def made(self, section: Section) -> int:
        """Steps at the pins during a section, of all axes without a tracker."""
        first, last = section.begin - self.start, section.end - self.start
        clocks = [self.steps(axis)[0] for axis in self.plain_axes]
        return sum(int(((own >= first) & (own <= last)).sum()) for own in clocks)

    def sought(self, stop: Stop) -> bool:
        """Home or probe has made it."""
        kinds = {s.kind for s in self.sections if s.begin <= stop.clock <= s.end}
        return stop.cause in (Cause.TRIGGER, Cause.LIMIT) and bool(kinds & {"home", "probe"})

    def undisturbed(self, section: Section, axis: int) -> int:
        """Clock up to which the moves of a section are certainly as planned."""
        if any(track.axis == axis for track in self.setup.tracks):
            return section.begin
        if axis not in self.setup.with_trackers and section.end - section.begin == sum(
            plan.clocks for plan in section.plans
        ):
            return section.end
        clocks = [happened.clock for happened in self.events if happened.clock is not None]
        return min((clock for clock in clocks if section.begin < clock <= section.end), default=section.begin)

    def problems(self) -> list[str]:
        """What is not as it must be, one sentence each."""
        found = list(self.troubles)
        mistakes = (Cause.LINE_UNDERRUN, Cause.RAMP_UNDERRUN, Cause.STEP_OVERRUN)
        found += [f"the core stopped: {s.cause.name}" for s in self.stops if s.cause in mistakes]
        for axis in range(self.file.axes):
            _, directions = self.steps(axis)
            net = int(directions.sum(dtype=np.int64))
            if self.core_positions[axis] != net:
                found.append(f"axis {axis} is at {self.core_positions[axis]}, but its pin made {net} steps")
            if self.machine[axis] != net + self.setup.start(axis):
                found.append(f"axis {axis} of the simulated machine is at {self.machine[axis]}")
        found += self._tracked()
        for section in self.sections:
            number = section.numbers[0]
            if section.outcome == "OK":
                found += self._short(section)
            elif all(map(self.sought, self.stops)) or section.outcome in ("SWITCH_MISSED", "SWITCH_LEVEL"):
                found.append(f"move {number}: {section.outcome}")
        for happened in self.events:
            if happened.clock is None:
                found.append(f"{happened.name}: it never occurred")
        return found

    def _tracked(self) -> list[str]:
        """What the trackers have not made, unless a stop ended them."""
        found = []
        for tracker in [] if self.stops or self.unmade else self.trackers:
            axis = tracker.axis
            if tracker.enabled and not tracker.at_target:
                found.append(f"axis {axis}: its tracker is at {tracker.position}, not at {tracker.target}")
            moves = [move for section in self.sections for move in section.moves]
            path = sum(move.steps[axis] for move in moves)
            if not any(isinstance(move, MoveHome | MoveProbe) for move in moves) and (
                self.core_positions[axis] != path + tracker.position
            ):
                found.append(
                    f"axis {axis} is at {self.core_positions[axis]}, not at the {path} of its path "
                    f"and the {tracker.position} of its tracker"
                )
        return found

    def _short(self, section: Section) -> list[str]:
        """Axes that did not make the steps of a section that was not stopped."""
        found = []
        for axis in self.plain_axes if section.kind in ("moves", "thread") else []:
            clocks, directions = self.steps(axis)
            own = (clocks >= section.begin - self.start) & (clocks <= section.end - self.start)
            made, wanted = int(directions[own].sum()), sum(move.steps[axis] for move in section.moves)
            if made != wanted:
                found.append(f"move {section.numbers[0]}: axis {axis} made {made} steps of {wanted}")
        return found
