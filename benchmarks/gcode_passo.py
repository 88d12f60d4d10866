# SPDX-License-Identifier: MIT
"""Programs of G-code on Passo's interpreter."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings
from passo.native import planner

from benchmarks.gcode_motion import PLANES, Motion, Outputs, Played, labelled

SPEEDS = 1000  # rpm of full power
POWER = 65535
SPINDLE, REVERSE, FLOOD, MIST = (1 << bit for bit in (16, 17, 18, 19))
DIGITAL_AT, DIGITALS = 20, 15


class Passo:
    """Passo's interpreter, line by line."""

    def __init__(self) -> None:
        self.gcode = Gcode(GcodeSettings(axes=3, spindle_maximum=SPEEDS))
        self.motions: list[Motion] = []
        self.label = 0

    def execute(self, line: str) -> None:
        """A line; raises GcodeError."""
        self.gcode.execute(line)
        self.label += 1
        c = planner()
        arc = self.gcode.c.job.arc if self.gcode.c.job.turns else None
        for action in self.gcode.actions():
            if action.kind == c.PASSO_GCODE_DWELL:
                seconds = action.microseconds / 1e6
                self.motions.append(
                    Motion(
                        self.label,
                        dwell=seconds,
                        outputs=_outputs(action.output),
                        tolerance=_tolerance(action),
                    )
                )
            elif action.kind == c.PASSO_GCODE_LINE and arc is None:
                self.motions.append(self._motion(action, None))
        if arc is not None:
            self.motions.append(self._motion(action, arc))

    def _motion(self, action: Any, arc: Any) -> Motion:
        feed = 0 if action.feed == (1 << 64) - 1 else action.feed / 2**32 * 60
        end = tuple(n / NANOMETERS for n in self.gcode.position) if arc is not None else None
        made = Motion(
            self.label,
            end or tuple(n / NANOMETERS for n in action.target[0:3]),
            feed,
            outputs=_outputs(action.output),
            tolerance=_tolerance(action),
        )
        if arc is None:
            return made
        plane = next(axes for axes in PLANES.values() if axes[0] == arc.plane.first)
        center = (arc.center.x / NANOMETERS, arc.center.y / NANOMETERS)
        return replace(made, center=center, plane=plane, clockwise=bool(arc.clockwise))


def _tolerance(action: Any) -> float:
    """Of merged lines, in mm; 0: none, or the path's own."""
    unmerged = (1 << 64) - 1
    return action.tolerance % unmerged / 2**32


def _outputs(word: int) -> Outputs:
    turns = (-1 if word & REVERSE else 1) if word & SPINDLE else 0
    rpm, digital = (word & POWER) / POWER * SPEEDS, word >> DIGITAL_AT & DIGITALS
    return Outputs(turns, rpm, bool(word & FLOOD), bool(word & MIST), digital)


def play_passo(program: Sequence[str]) -> Played:
    """The motions of Passo, and the line at which it stops."""
    passo = Passo()
    for label, line in enumerate(labelled(program), 1):
        try:
            passo.execute(line)
        except GcodeError as error:
            return Played(passo.motions, label, str(error))
    return Played(passo.motions)
