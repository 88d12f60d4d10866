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
    MachineCompare,
    MachineEncoder,
    MachineInput,
    MachineOutput,
    MachineSettings,
    MachineSpindle,
)

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
)
EVENT_TYPES: dict[str, type[Event]] = {event.form.name: event for event in get_args(Event)}


@dataclass(frozen=True)
class Setup:
    """The machine and the events of a move file; places are in steps."""

    settings: MachineSettings
    axes: int  # of the moves
    inputs: tuple[MachineInput, ...] = ()
    encoders: tuple[MachineEncoder, ...] = ()
    events: tuple[Event, ...] = ()
    scales: tuple[Fraction, ...] = ()
    outputs: tuple[MachineOutput | None, ...] = ()  # of each move of the file
    compare: MachineCompare | None = None
    spindle: MachineSpindle | None = None

    def find(self, role: str, axis: int) -> int | None:
        """Number of an input; the channel has one probe."""
        places = [(one.role, 0 if one.role == "probe" else one.axis) for one in self.inputs]
        wanted = (role, 0 if role == "probe" else axis)
        return places.index(wanted) if wanted in places else None

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
