# SPDX-License-Identifier: MIT
"""Programs of G-code on Passo's interpreter."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings
from passo.native import planner

from benchmarks.gcode_motion import AXES, PLANES, Motion, Outputs, Played, labelled

SPEEDS = 1000  # rpm of full power
POWER = 65535
SPINDLE, REVERSE, FLOOD, MIST = (1 << bit for bit in (16, 17, 18, 19))
DIGITAL_AT, DIGITALS = 20, 15
TOUCHED = 0.254  # mm before the end of a probe, as in rs274


class Passo:
    """Passo's interpreter, line by line."""

    def __init__(self, axes: int = 3) -> None:
        self.gcode = Gcode(GcodeSettings(axes=axes, spindle_maximum=SPEEDS, turn_counts=1000))
        self.axes = axes
        self.motions: list[Motion] = []
        self.label = 0

    def execute(self, line: str) -> None:
        """A line; raises GcodeError."""
        began = np.array(self.gcode.position)
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
            elif action.kind == c.PASSO_GCODE_CHANGE:
                c.passo_gcode_load(self.gcode.c, action.tool)
            elif action.kind in (c.PASSO_GCODE_LINE, c.PASSO_GCODE_PROBE) and arc is None:
                self.motions.append(self._motion(action, None))
            elif action.kind == c.PASSO_GCODE_THREAD:
                self.motions.append(self._motion(action, None))
                if action.rigid:
                    back = [n / NANOMETERS for n in self.gcode.position]
                    end = (*back, *(0.0,) * (AXES - len(back)))
                    self.motions.append(replace(self.motions[-1], end=end))
            if action.kind == c.PASSO_GCODE_PROBE:
                self._touch(began)
        if arc is not None:
            self.motions.append(self._motion(action, arc))

    def _touch(self, began: np.ndarray) -> None:
        end = np.array(self.gcode.position)
        way = (began - end)[:3]
        end[:3] += np.rint(way * (TOUCHED * NANOMETERS / np.linalg.norm(way))).astype(int)
        planner().passo_gcode_set_position(self.gcode.c, end.tolist())

    def _motion(self, action: Any, arc: Any) -> Motion:
        feed = 0 if action.feed == (1 << 64) - 1 else action.feed / 2**32 * 60
        end = self.gcode.position if arc is not None else tuple(action.target[0 : self.axes])
        made = Motion(
            self.label,
            tuple(n / NANOMETERS for n in end) + (0.0,) * (AXES - self.axes),
            feed,
            outputs=_outputs(action.output),
            tolerance=_tolerance(action),
            probes=action.kind == planner().PASSO_GCODE_PROBE,
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
    share, digital = (word & POWER) / POWER, word >> DIGITAL_AT & DIGITALS
    return Outputs(turns, share * SPEEDS, bool(word & FLOOD), bool(word & MIST), digital, 100 * share)


def play_passo(program: Sequence[str]) -> Played:
    """The motions of Passo, and the line at which it stops."""
    passo = Passo()
    for label, line in enumerate(labelled(program), 1):
        try:
            passo.execute(line)
        except GcodeError as error:
            return Played(passo.motions, label, str(error))
    return Played(passo.motions)
