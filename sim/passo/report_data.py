# SPDX-License-Identifier: MIT
"""Data of the report page: facts as JSON, and every edge of STEP and DIR in a few bits."""

import base64
import zlib
from dataclasses import asdict
from typing import Any

import numpy as np

from passo import __version__
from passo.move_forms import SHAPED, USER
from passo.moves import Channels
from passo.plan import ALPHA_ONE, ALPHA_RESET, Q48, Plan
from passo.plot_panels import units_of
from passo.pulse_judge import faults
from passo.registers import Shape
from passo.report import problems, summarize_channels, total_clocks
from passo.run import Run, parameters_of
from passo.shape import ONE


def page_data(channels: Channels, runs: list[Run], engine: str) -> tuple[dict[str, Any], str]:
    """The facts, and the edges: zlib in base64. Clocks count from the start of the first channel.

    The edges of an axis are three streams of varints in zigzag: second differences of the rising edges of
    STEP, differences between the lengths of its pulses, and differences between the edges of DIR.
    """
    several = channels.several
    axes, streams = [], []
    for place, run in enumerate(runs):
        units = units_of(run)
        for axis in range(run.file.axes):
            rises, falls, turns = edges_of(run.pins, axis, run.start - run.late)
            streams += packed_edges(rises, falls, turns)
            axes.append(
                {
                    "run": place,
                    "axis": axis,
                    "name": f"{run.file.channel}.{axis}" if several else f"{axis}",
                    "per_step": float(units.per_step[axis]),
                    "edges": [len(rises), len(falls), len(turns)],
                }
            )
    facts = {
        "version": __version__,
        "summary": summarize_channels(channels, runs, engine),
        "file": channels.path.name,
        "clock_hz": channels.clock_hz,
        "clocks": total_clocks(runs),
        "parameters": asdict(parameters_of(channels)),
        "alpha_reset": ALPHA_RESET / ALPHA_ONE,
        "runs": [_motion(run) for run in runs],
        "axes": axes,
        "events": _events(runs, several),
    }
    packed = zlib.compress(np.concatenate([*streams, np.empty(0, np.uint8)]).tobytes(), 9)
    return facts, base64.b64encode(packed).decode()


def _motion(run: Run) -> dict[str, Any]:
    """The motion of a channel: its settings and the ideal curves of its plans."""
    units = units_of(run)
    return {
        "channel": run.file.channel,
        "start": run.late,
        "clocks": run.total_clocks,
        "pins": asdict(run.file.pins),
        "unit": units.name,
        "plans": [_plan(run.file.number(index), plan) for index, plan in enumerate(run.plans)],
    }


def _plan(number: int, plan: Plan) -> dict[str, Any]:
    """A move as planned. Velocities are substeps per clock."""
    own = plan.move.profile in (USER, SHAPED)
    return {
        "number": number,
        "profile": plan.move.profile,
        "form": plan.move.form.name,
        "steps": list(plan.move.steps),
        "substeps": plan.line.substeps,
        "tick": 1 << plan.tick_log2,
        "alpha": plan.c.sigmoid_alpha / ALPHA_ONE,
        "table": [point / ONE for point in (*plan.table, ONE)] if own else None,
        "ramps": [
            [ramp.ticks, ramp.velocity_end / Q48, Shape(ramp.shape).name.lower(), bool(ramp.mirror)]
            for ramp in plan.ramps
        ],
    }


def _events(runs: list[Run], several: bool) -> list[dict[str, Any]]:
    """What happened, in the order of the clocks."""
    found = []
    for run in runs:
        channel = f"channel {run.file.channel}: " if several else ""

        def add(clock: int, text: str, kind: str = "", channel: str = channel, late: int = run.late) -> None:
            found.append({"clock": clock + late, "text": channel + text, "kind": kind})

        begin, last = 0, run.moved_clocks
        for index, plan in enumerate(run.plans):
            if begin < last:
                add(begin, f"move {run.file.number(index)} begins")
            begin += plan.clocks
        wrong = [fault.text for fault in faults(run)]
        if last:
            add(last, "the motion ends" if run.total_clocks else "the motion has not ended")
        for problem in wrong:
            add(run.total_clocks, problem, "fault")
    if several:
        wrong = [text for text in problems(runs) if text not in {event["text"] for event in found}]
        found += [{"clock": total_clocks(runs), "text": text, "kind": "fault"} for text in wrong]
    return sorted(found, key=lambda event: event["clock"])


def edges_of(pins: np.ndarray, axis: int, start: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clocks since `start` of the rising and falling edges of STEP, and of all of DIR; low at first."""
    clocks = pins["clock"].astype(np.int64) - start
    step, direction = (
        np.diff((pins[signal] >> np.uint64(axis) & np.uint64(1)).astype(np.int8), prepend=np.int8(0))
        for signal in ("step", "dir")
    )
    return clocks[step > 0], clocks[step < 0], clocks[direction != 0]


def packed_edges(rises: np.ndarray, falls: np.ndarray, turns: np.ndarray) -> list[np.ndarray]:
    """The streams of an axis."""
    return [
        varints(np.diff(np.diff(rises, prepend=0), prepend=0)),
        varints(np.diff(falls - rises[: len(falls)], prepend=0)),
        varints(np.diff(turns, prepend=0)),
    ]


def varints(numbers: np.ndarray) -> np.ndarray:
    """Signed numbers in zigzag, 7 bits in a byte, the lowest first; bit 7: more follow."""
    rest = np.where(numbers < 0, -2 * numbers - 1, 2 * numbers).astype(np.uint64)
    lengths = np.ones(len(rest), np.int64)
    for bits in range(7, 64, 7):
        lengths += rest >= np.uint64(1 << bits)
    places = np.cumsum(lengths) - lengths
    coded = np.zeros(int(lengths.sum()), np.uint8)
    for group in range(int(lengths.max(initial=0))):
        here = lengths > group
        more = (lengths[here] > group + 1).astype(np.uint8) << 7
        coded[places[here] + group] = (rest[here] >> np.uint64(7 * group) & np.uint64(127)).astype(
            np.uint8
        ) | more
    return coded
