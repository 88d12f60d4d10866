# SPDX-License-Identifier: MIT
"""The simulated machine and the events of a move file."""

from dataclasses import dataclass
from fractions import Fraction
from typing import get_args

from passo.move_forms import (
    EventAbort,
    EventArm,
    EventEstop,
    EventHold,
    EventInput,
    EventOverride,
    EventResume,
    EventSlip,
    EventStop,
    EventUntrack,
    MachineCompare,
    MachineEncoder,
    MachineInput,
    MachineOutput,
    MachineSettings,
    MachineSpindle,
    MachineTrack,
)

AXES_OF_CORES = (3, 4, 8)  # few, as each has to be built

Event = (
    EventInput
    | EventEstop
    | EventHold
    | EventResume
    | EventOverride
    | EventStop
    | EventAbort
    | EventArm
    | EventSlip
    | EventUntrack
    | MachineTrack
)
EVENT_TYPES: dict[str, type[Event]] = {event.form.name: event for event in get_args(Event)}


@dataclass(frozen=True)
class Setup:
    """The machine and the events of a move file; places are in steps."""

    settings: MachineSettings
    axes: int  # of the moves
    inputs: tuple[MachineInput, ...] = ()
    encoders: tuple[MachineEncoder, ...] = ()
    events: tuple[Event, ...] = ()  # also targets of trackers that come at a moment
    scales: tuple[Fraction, ...] = ()
    outputs: tuple[MachineOutput | None, ...] = ()  # of each move of the file
    compare: MachineCompare | None = None
    spindle: MachineSpindle | None = None
    tracks: tuple[MachineTrack, ...] = ()  # those that hold from the beginning, one per axis at most
    names: tuple[str, ...] = ()  # of the events: "event 1", "track 1"
    trackers: tuple[MachineTrack, ...] = ()  # limits of the trackers that are used, one per axis

    def find(self, role: str, axis: int) -> int | None:
        """Number of an input; the channel has one probe."""
        places = [(one.role, 0 if one.role == "probe" else one.axis) for one in self.inputs]
        wanted = (role, 0 if role == "probe" else axis)
        return places.index(wanted) if wanted in places else None

    @property
    def core_axes(self) -> int:
        """Axes of the core that runs the file: those of the moves, and one for the spindle."""
        return next(n for n in AXES_OF_CORES if n >= self.axes + bool(self.spindle))

    @property
    def lined(self) -> int:
        """Axes that moves can have steps of: the first ones."""
        return self.axes - self.settings.tracked

    @property
    def with_trackers(self) -> list[int]:
        """Axes whose trackers are used."""
        return [one.axis for one in self.trackers]

    @property
    def spindle_axis(self) -> int:
        """The axis whose encoder inputs the spindle has: the first one without a move."""
        return self.axes

    @property
    def has_outputs(self) -> bool:
        """A move says what they do."""
        return any(self.outputs)

    def start(self, axis: int) -> int:
        """Where an axis is at the beginning."""
        return self.settings.start[axis] if self.settings.start else 0
