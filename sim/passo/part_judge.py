# SPDX-License-Identifier: MIT
"""Checks the pulses of a part against the limits of its machine."""

import numpy as np

from passo.axis_judge import NAMES, Marks, Share, shares
from passo.gcode import NANOMETERS, Gcode
from passo.machine_file import MachineFile
from passo.native import planner
from passo.part import Part, Played
from passo.path_rounding import Line


def path_of(part: Part, machine: MachineFile) -> list[Line]:
    """The lines of a checked part, with the chords of its arcs, from where it begins; without their feeds."""
    gcode, axes = Gcode(machine.gcode), len(machine.settings.axes)
    gcode.c[0], origin = part.begin.gcode[0], part.begin.place
    found: list[Line] = []
    for line in part.lines:
        gcode.execute(line)
        for action in gcode.actions():
            if action.kind == planner().PASSO_GCODE_LINE:
                target = np.array(list(action.target[0:axes])) / NANOMETERS - origin
                found.append((target.tolist(), None))
    return found


def shares_of(played: Played) -> list[Share]:
    """The greatest share of each limit of each axis; none of a part with threads, which the spindle moves."""
    if played.threads:
        return []
    settings = played.machine.settings
    lines = path_of(played.part, played.machine)
    marks = Marks.of(lines, settings, played.clocks, played.positions) if lines else None
    turning = sum(vars(played.machine.pins).values())
    return shares(played.clocks, played.positions, settings, marks, turning=turning)


def greatest(found: list[Share]) -> dict[str, Share]:
    """Of all axes, by the name of the limit."""
    return {
        name: max(own, key=lambda share: share.share)
        for name in NAMES
        if (own := [share for share in found if share.name == name])
    }
