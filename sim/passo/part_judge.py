# SPDX-License-Identifier: MIT
"""Checks the pulses of a part against the limits of its machine."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from passo.axis_judge import NAMES, Marks, Share, shares
from passo.gcode import NANOMETERS, Gcode
from passo.machine_file import MachineFile
from passo.native import planner
from passo.part import Part, Played
from passo.path_rounding import Line

WAITS = 2  # steps that wait


@dataclass(frozen=True)
class Thread:
    """A line in step with the spindle."""

    begin: np.ndarray  # of the axes, mm; so is the end
    end: np.ndarray
    turns: float  # of the spindle

    @property
    def lead(self) -> np.ndarray:
        """Way of each axis in a turn, mm."""
        return (self.end - self.begin) / self.turns


def path_of(part: Part, machine: MachineFile) -> list[Line]:
    """The lines of a checked part, with the chords of its arcs, from where it begins; without their feeds.

    A thread is a line, and another one back where it is made so.
    """
    return _path_of(part, machine)[0]


def _path_of(part: Part, machine: MachineFile) -> tuple[list[Line], list[Thread]]:
    gcode, axes, c = Gcode(machine.gcode), len(machine.settings.axes), planner()
    gcode.c[0], origin = part.begin.gcode[0], part.begin.place
    found: list[Line] = []
    threads: list[Thread] = []
    at = np.zeros(axes)
    for line in part.lines:
        gcode.execute(line)
        for action in gcode.actions():
            if action.kind not in (c.PASSO_GCODE_LINE, c.PASSO_GCODE_THREAD):
                continue
            target = np.array(list(action.target[0:axes])) / NANOMETERS - origin
            found.append((target.tolist(), None))
            if action.kind == c.PASSO_GCODE_THREAD:
                pitch = action.pitch / NANOMETERS
                threads.append(Thread(at, target, float(np.linalg.norm(target - at)) / pitch))
                if action.rigid:
                    found.append((at.tolist(), None))
                    continue
            at = target
    return found, threads


def shares_of(played: Played) -> list[Share]:
    """The greatest share of each limit of each axis.

    In step with the spindle each step is within half a count of its encoder, and where two lines of a pass
    meet an axis may be off by the junction deviation.
    """
    settings = played.machine.settings
    lines, threads = _path_of(played.part, played.machine)
    marks = Marks.of(lines, settings, played.clocks, played.positions) if lines else None
    if played.passes and marks:
        marks = marks.with_more(_in_step(played, threads))
    turning = sum(vars(played.machine.pins).values())
    return shares(played.clocks, played.positions, settings, marks, turning=turning)


def beside(played: Played, alone: Played) -> list[str]:
    """What trackers that take up backlash have done to the path besides, one sentence each.

    `alone` is the path without them: each motor is where that is, or lower by up to its backlash; a step may
    wait for one of the other hand, and where DIR turns.
    """
    found = []
    if played.seconds != alone.seconds:
        found.append(f"the path took {played.seconds:.9f} s, without backlash {alone.seconds:.9f} s")
    for motor, (clocks, places) in enumerate(zip(played.clocks, played.positions, strict=True)):
        backlash = played.machine.backlash(motor)
        at = np.union1d(clocks, alone.clocks[motor])
        off = _places(clocks, places, at) - _places(alone.clocks[motor], alone.positions[motor], at)
        if off.min(initial=0) < -backlash - WAITS or off.max(initial=0) > WAITS:
            name, far = played.machine.motors[motor], f"{off.min():g} to {off.max():g} steps"
            found.append(f"motor {name} is {far} from its path; its backlash is {backlash}")
    return found


def _places(clocks: np.ndarray, places: np.ndarray, at: np.ndarray) -> np.ndarray:
    return np.concatenate([[0], places])[np.searchsorted(clocks, at, side="right")]


def _in_step(played: Played, threads: Sequence[Thread]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Times in each pass, and how far each limit may be off at these."""
    settings, counts = played.machine.settings, played.machine.gcode.turn_counts
    directions = np.array([direction for direction, _ in settings.limits()])
    left, found = list(threads), []
    for one in played.passes:
        own, left = left[: one.lines], left[one.lines :]
        begin, end = one.begin - played.origin, one.end - played.origin
        steps = np.sort(np.concatenate([clocks[_within(clocks, begin, end)] for clocks in played.clocks]))
        leads = np.array([thread.lead for thread in own])
        half = np.abs(leads @ directions.T).max(axis=0) / counts / 2
        found.append((steps / played.machine.clock_hz, np.tile(half, (len(steps), 1))))
        for number in range(1, len(own)):
            change = leads[number] - leads[number - 1]
            size = float(np.linalg.norm(change))
            if size:
                off = np.abs(directions @ change) * (float(settings.junction_deviation) / size)
                met = _met(played, own[:number], begin) / played.machine.clock_hz
                found.append((met, np.tile(half + off, (len(met), 1))))
    return found


def _within(clocks: np.ndarray, begin: int, end: int) -> slice:
    return slice(*np.searchsorted(clocks, [begin, end]))


def _met(played: Played, done: Sequence[Thread], begin: int) -> np.ndarray:
    """Clocks of the last step of lines of the pass that begins then, and of the next one."""
    settings = played.machine.settings
    rows = settings.motors.map(len(settings.axes))
    places = [np.round(rows @ place * settings.scales) for place in (done[0].begin, *(t.end for t in done))]
    made = np.abs(np.diff(places, axis=0)).sum(axis=0).astype(int)
    ends = [
        clocks[first + count - 1 : first + count + 1]
        for clocks, count in zip(played.clocks, made, strict=True)
        if count and (first := int(np.searchsorted(clocks, begin))) + count < len(clocks)
    ]
    return np.sort(np.concatenate([np.empty(0), *ends]))


def greatest(found: list[Share]) -> dict[str, Share]:
    """Of all axes, by the name of the limit."""
    return {
        name: max(own, key=lambda share: share.share)
        for name in NAMES
        if (own := [share for share in found if share.name == name])
    }
