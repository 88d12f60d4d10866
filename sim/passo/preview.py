# SPDX-License-Identifier: MIT
"""The plan of a part without its pulses: lines and ramps as they are in a run, from C (passo_preview.h)."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from passo.build import Parameters
from passo.driver import DriverError
from passo.expand.refusals import NO_PROBE, explain_text, no_probe
from passo.gcode import GcodeError, GcodeSettings, set_tool_lengths
from passo.link import error_text
from passo.machine_file import MachineFile
from passo.native import ffi, planner, previewer, unopened

CHUNK = 2000  # lines between two reports of progress
# struct passo_preview_line and struct passo_preview_ramp
LINE = np.dtype(
    [
        ("steps", "i4", 8),
        ("substeps", "u4"),
        ("feed", "u4"),
        ("limit", "u4"),
        ("source", "u4"),
        ("tool", "u1"),
        ("rapid", "?"),
    ],
    align=True,
)
RAMP = np.dtype([("velocity", "u8"), ("ticks", "u4"), ("shape", "u1"), ("last", "?")], align=True)
REFUSAL = np.dtype([("line", "u4"), ("error", "i4")], align=True)


@dataclass(frozen=True)
class Refused:
    """A line of a part, counted from 0, that was refused; see struct passo_preview_refusal."""

    line: int
    error: int

    def why(self, text: bytes, settings: GcodeSettings) -> str:
        """What is wrong with the line, and what to write instead."""
        if self.error == NO_PROBE:
            return no_probe(text.decode("utf-8", "replace"))
        if self.error < NO_PROBE:
            return error_text(NO_PROBE - self.error)
        return explain_text(GcodeError(self.error), text.decode("utf-8", "replace"), settings)


@dataclass(frozen=True)
class Checked:
    """What a text says; see struct passo_preview_check."""

    lines: int
    unread: int
    chords: int
    ended: bool
    refused: list[Refused]


def new_gcode(settings: GcodeSettings, tools: Mapping[int, float]) -> Any:
    """A `struct passo_gcode` with tool lengths in mm."""
    gcode = unopened("passo_gcode")
    planner().passo_gcode_open(gcode, settings.struct())
    set_tool_lengths(gcode, tools)
    return gcode


def position_of(gcode: Any) -> tuple[int, ...]:
    """Where a `struct passo_gcode` is, in nm."""
    return tuple(gcode.position[0 : gcode.settings.axes])


def check_lines(text: Sequence[bytes], gcode: Any) -> Checked:
    """Execute all lines without any motion; a refused line changes nothing."""
    whole = b"".join(text)
    found = ffi().new("struct passo_preview_refusal[]", len(text))
    made = previewer().passo_preview_check(gcode, ffi().from_buffer(whole), len(whole), found, len(text))
    refused = [Refused(found[i].line, found[i].error) for i in range(made.refused)]
    return Checked(made.lines, made.unread, made.chords, made.ended, refused)


@dataclass(frozen=True)
class Planned:
    """A program as it was planned, up to where it was canceled."""

    machine: MachineFile
    parameters: Parameters
    lines: np.ndarray  # LINE
    ramps: np.ndarray  # RAMP
    refused: list[Refused]
    substeps_per_mm: int
    taken: int  # lines of the program
    ended: bool  # whether all of it is planned
    dry: bool  # whether the core was short of ramps
    canceled: bool = False  # by Ctrl-C


def plan_lines(
    text: Sequence[bytes],
    machine: MachineFile,
    gcode: Any,
    steps: Sequence[int],
    parameters: Parameters,
    look_ahead: int,
    polls: int,
    progress: Callable[[int], None] = lambda lines: None,
) -> Planned:
    """Plan a program for a core, from the modes of a `struct passo_gcode` and positions of the motors on.

    `polls`: of the driver in a second. Ctrl-C ends it with what is planned.

    Raises DriverError if the machine cannot be.
    """
    c, whole = previewer(), b"".join(text)
    buffer = ffi().from_buffer(whole)
    config = ffi().new("struct passo_preview_config *", {**vars(machine.pins), "text": buffer})
    inputs = machine.gcode.simulated_inputs()
    config.program.path = machine.settings.struct(parameters)[0]
    config.program.gcode, config.program.inputs = machine.gcode.struct()[0], inputs
    config.program.spin_up = int(machine.spindle_wait > 0)  # us: it rests where a run waits
    config.length, config.look_ahead, config.period = len(whole), look_ahead, machine.clock_hz // polls
    config.core_axes = parameters.axes
    config.line_queue_log2, config.ramp_queue_log2 = parameters.line_queue_log2, parameters.ramp_queue_log2
    error = ffi().new("enum passo_error *")
    made = c.passo_preview_create(config, error)
    if made == ffi().NULL:
        if error[0]:
            raise DriverError("preview", error[0])
        raise MemoryError
    try:
        canceled = False
        c.passo_preview_begin(made, gcode, ffi().new("int32_t[8]", list(steps)))
        try:
            while c.passo_preview_play(made, CHUNK):
                progress(c.passo_preview_taken(made))
        except KeyboardInterrupt:
            canceled = True
        refused = _copied(c.passo_preview_refusals, made, REFUSAL)
        return Planned(
            machine,
            parameters,
            _copied(c.passo_preview_lines, made, LINE),
            _copied(c.passo_preview_ramps, made, RAMP),
            [Refused(int(line), int(number)) for line, number in refused],
            c.passo_preview_substeps_per_mm(made),
            c.passo_preview_taken(made),
            c.passo_preview_is_done(made),
            c.passo_preview_ran_dry(made),
            canceled,
        )
    finally:
        c.passo_preview_destroy(made)


def _copied(call: Any, made: Any, kind: np.dtype) -> np.ndarray:
    found = np.empty(call(made, ffi().NULL), kind)
    item = ffi().typeof(call).args[1]
    assert ffi().sizeof(item.item) == kind.itemsize
    call(made, ffi().cast(item, found.ctypes.data))
    return found
