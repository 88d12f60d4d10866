# SPDX-License-Identifier: MIT
"""Output files of a move file with a machine: pulses.csv and summary.json."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from passo.curve import Curve
from passo.move_forms import EventInput, EventOverride, EventSlip, EventUntrack, MachineEncoder, MachineTrack
from passo.report import summary_head, write_rows
from passo.scene_figures import energies, thread_figures
from passo.scene_run import Happened, SceneRun, Section, Stop, Tracker
from passo.verdict import scene_verdict


@dataclass(frozen=True)
class Measured:
    """The curve of an axis as its encoder has measured it, in steps of the core, beside the commanded one."""

    clocks: np.ndarray  # since the start
    measured: np.ndarray
    made: np.ndarray  # steps at the pin on the same clock
    ideal: np.ndarray  # commanded curve; NaN where it does not apply

    @property
    def errors(self) -> np.ndarray:
        """Measured less commanded, where both are known."""
        known = ~np.isnan(self.ideal)
        return (self.measured - self.ideal)[known]


def measured_curve(run: SceneRun, encoder: MachineEncoder) -> Measured:
    """What the host has read of an encoder."""
    clocks = run.samples["clock"].astype(np.int64) - run.start
    measured = run.samples["encoder"][:, encoder.axis] / float(encoder.counts_per_step)
    made = run.samples["position"][:, encoder.axis].astype(float)
    ideal = np.full(len(clocks), np.nan)
    for section in run.sections:
        if section.plans:
            inside, _, positions = planned(run, section, clocks - (section.begin - run.start))
            ideal[inside] = positions[encoder.axis] - run.setup.start(encoder.axis)
            ideal[inside & (clocks > run.undisturbed(section, encoder.axis) - run.start)] = np.nan
    return Measured(clocks, measured, made, ideal)


def planned(run: SceneRun, section: Section, clocks: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ideal motion of a section at clocks since its start.

    Which of them are inside, speeds (steps per clock) and positions of the machine, a row for each axis.
    """
    inside = (clocks >= 0) & (clocks <= sum(plan.clocks for plan in section.plans))
    places = np.array(section.start, float)[:, None] * np.ones(inside.sum())
    speeds = np.zeros_like(places)
    begin = 0
    for plan in section.plans:
        own = clocks[inside] - begin
        velocity, distance = Curve(plan).at(own.astype(float))
        share = np.array(plan.move.steps)[:, None] / plan.line.substeps
        speeds += velocity * share
        places += np.clip(distance, 0, plan.line.substeps) * share
        begin += plan.clocks
    return inside, speeds, places


def write_scene_pulses(run: SceneRun, path: Path) -> None:
    """Write a row per step, sorted by clock and axis; clocks count from the start of the first motion."""
    rows = np.concatenate(
        [
            np.stack([clocks, np.full(len(clocks), axis), directions])
            for axis in range(run.file.axes)
            for clocks, directions in [run.steps(axis)]
        ],
        axis=1,
    )
    write_rows(("clock", "axis", "direction"), rows, path)


def summarize_scene(run: SceneRun, engine: str) -> dict[str, Any]:
    """The contents of summary.json."""
    return {
        **summary_head(run, engine, run.problems()),
        **scene_verdict(run, engine).summary(),
        "moves_not_begun": run.unmade,
        "axes": [_axis(run, axis) for axis in range(run.file.axes)],
        "moves": [_section(run, section) for section in run.sections],
        "events": [_event(run, happened) for happened in run.events if not happened.is_track],
        "tracks": [_event(run, happened) for happened in run.events if happened.is_track],
        "trackers": [_tracker(tracker) for tracker in run.trackers],
        "stops": [_stop(run, stop) for stop in run.stops],
        "triggers": [{"event": latch.number, "positions": latch.positions} for latch in run.latches],
        "energy": energies(run),
        "encoders": [_encoder(run, number) for number in range(len(run.setup.encoders))],
    }


def _axis(run: SceneRun, axis: int) -> dict[str, Any]:
    clocks, directions = run.steps(axis)
    return {
        "emitted": int(directions.sum(dtype=np.int64)),
        "pulses": len(clocks),
        "position": run.positions[axis],
        "machine_position": run.machine[axis],
    }


def _section(run: SceneRun, section: Section) -> dict[str, Any]:
    made: dict[str, Any] = {
        "numbers": section.numbers,
        "kind": section.kind,
        "start_clock": section.begin - run.start,
        "end_clock": section.end - run.start,
        "result": section.outcome,
    }
    if section.plans or section.kind == "thread":
        made |= {"steps_asked": run.asked(section), "steps_made": run.made(section)}
    return made | (thread_figures(run, section) if section.kind == "thread" else {})


def _event(run: SceneRun, happened: Happened) -> dict[str, Any]:
    event = happened.event
    made: dict[str, Any] = {"number": happened.number}
    if isinstance(event, MachineTrack):
        made |= {"axis": event.axis, "target": int(event.target.value)}
    else:
        made["do"] = event.form.name
    if happened.clock is None:
        return {**made, "clock": None}
    made |= {"clock": happened.clock - run.start, "machine_positions": happened.positions}
    if happened.answered is not None:
        made["command_clocks"] = happened.answered - happened.clock
    return made


def _tracker(tracker: Tracker) -> dict[str, Any]:
    return {"axis": tracker.axis, "position": tracker.position, "at_target": tracker.at_target}


def _stop(run: SceneRun, stop: Stop) -> dict[str, Any]:
    made: dict[str, Any] = {"cause": stop.cause.name, "clock": stop.clock - run.start}
    made["machine_positions"] = stop.positions
    if stop.axes:
        made["axes"] = stop.axes
    if stop.latch is not None:
        made["latched_positions"] = stop.latch
    return made


def _encoder(run: SceneRun, number: int) -> dict[str, Any]:
    encoder = run.setup.encoders[number]
    errors = measured_curve(run, encoder).errors
    return {
        "axis": encoder.axis,
        "samples": len(errors),
        "largest_error_steps": float(np.abs(errors).max()) if len(errors) else None,
        "rms_error_steps": float(np.sqrt((errors**2).mean())) if len(errors) else None,
        "greatest_following_error_steps": run.greatest[number],
    }


def said(happened: Happened) -> str:
    """An event in words."""
    event = happened.event
    said = event.form.name
    if isinstance(event, EventInput):
        said = f"{event.input} of axis {event.axis} {'active' if event.active else 'inactive'}"
    if isinstance(event, EventOverride):
        said += f" {event.percent} %"
    if isinstance(event, EventSlip):
        said += f" of axis {event.axis} by {event.counts} counts"
    if isinstance(event, EventUntrack):
        said += f" axis {event.axis}"
    if isinstance(event, MachineTrack):
        said = f"axis {event.axis} to {event.target.value}"
    return f"{said} at {', '.join(map(str, happened.positions))}"
