# SPDX-License-Identifier: MIT
"""Output files of a run: pulses.csv and summary.json."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from passo.curve import step_errors
from passo.moves import Channels
from passo.native import ffi, planner
from passo.output import complete
from passo.plan import Q48
from passo.pulse_judge import faults
from passo.run import Run
from passo.scene_run import SceneRun
from passo.verdict import verdict_of

ROWS = 1 << 16  # that are written in one go


def write_pulses(runs: list[Run], path: Path) -> None:
    """Write a row per step, sorted by clock, channel and axis; clocks count from the first start.

    A file of channel 0 alone has no column for the channel.
    """
    parts = []
    for run in runs:
        for axis in range(run.file.axes):
            clocks, directions = run.steps(axis)
            place = (np.full(len(clocks), n) for n in (run.file.channel, axis))
            parts.append(np.stack([clocks + run.late, *place, directions.astype(np.int64)]))
    columns = ["clock", "channel", "axis", "direction"]
    if not runs[-1].file.channel:
        parts, columns = [np.delete(rows, 1, axis=0) for rows in parts], ["clock", "axis", "direction"]
    write_rows(columns, np.concatenate(parts, axis=1), path)


def write_rows(columns: Sequence[str], numbers: np.ndarray, path: Path) -> None:
    """Write whole numbers, column x row, as CSV, sorted by the first column; equal ones keep their order."""
    rows = np.ascontiguousarray(numbers.T[np.argsort(numbers[0], kind="stable")], np.int64)
    c = planner()
    with complete(path) as part, part.open("wb") as file:
        file.write(",".join(columns).encode() + b"\n")
        for begin in range(0, len(rows), ROWS):
            some = rows[begin : begin + ROWS]
            text = ffi().new("char[]", some.size * c.PASSO_CSV_CHARACTERS)
            count = c.passo_csv_write(text, ffi().cast("int64_t *", some.ctypes.data), *some.shape)
            file.write(ffi().buffer(text, count))


def problems(runs: list[Run]) -> list[str]:
    """Deviations from the plans, their curves and the pin timings, one sentence each."""
    several = runs[-1].file.channel > 0
    return [
        f"channel {run.file.channel}: {fault.text}" if several else fault.text
        for run in runs
        for fault in faults(run)
    ]


def total_clocks(runs: list[Run]) -> int:
    """From the first start to the last end."""
    return max(run.late + run.total_clocks for run in runs)


def summarize_channels(channels: Channels, runs: list[Run], engine: str) -> dict[str, Any]:
    """The contents of summary.json; of a file of channel 0 alone: `summarize`."""
    summaries = [summarize(run, engine) for run in runs]
    if not channels.several:
        return summaries[0]
    found = problems(runs)
    clocks = total_clocks(runs)
    places = [{"channel": file.channel} for file in channels.files]
    own = ("total_clocks", "drained")
    parts = list(zip(places, runs, summaries, strict=True))
    return {
        **summaries[0],
        **verdict_of(runs, engine, found).summary(),
        "ok": not found,
        "problems": found,
        "total_clocks": clocks,
        "total_seconds": clocks / channels.clock_hz,
        "drained": sum(run.state.drained for run in runs),
        "together": channels.together,
        "channels": [
            {**place, "start_clock": run.late, **{name: summary[name] for name in own}}
            for place, run, summary in parts
        ],
        "axes": [{**place, **axis} for place, _, summary in parts for axis in summary["axes"]],
        "moves": [{**place, **move} for place, _, summary in parts for move in summary["moves"]],
    }


def summarize(run: Run, engine: str) -> dict[str, Any]:
    """The contents of summary.json for one channel."""
    found = [fault.text for fault in faults(run)]
    return {
        **summary_head(run, engine, found),
        **verdict_of([run], engine, found).summary(),
        "drained": run.state.drained,
        "axes": [_axis(run, axis) for axis in range(run.file.axes)],
        "moves": [
            {
                "steps": list(plan.move.steps),
                "profile": plan.move.profile,
                "oversampling": plan.c.oversampling,
                "tick_clocks": 1 << plan.tick_log2,
                "accelerate_ticks": plan.c.accelerate_ticks,
                "cruise_ticks": plan.c.cruise_ticks,
                "decelerate_ticks": plan.c.decelerate_ticks,
                "peak_speed": plan.c.velocity_peak / Q48 / plan.c.oversampling * run.file.clock_hz,
            }
            for plan in run.plans
        ],
    }


def summary_head(run: Run | SceneRun, engine: str, found: list[str]) -> dict[str, Any]:
    """What each summary begins with; `found` are the problems."""
    return {
        "name": run.file.name,
        "engine": engine,
        "ok": not found,
        "problems": found,
        "clock_hz": run.file.clock_hz,
        "total_clocks": run.total_clocks,
        "total_seconds": run.total_clocks / run.file.clock_hz,
        "matched_edges": run.matched_edges,
        "clocks_per_second": round(run.clocks / run.seconds),
    }


def _axis(run: Run, axis: int) -> dict[str, Any]:
    """Sums are signed, pulses are not. The error is the largest distance of a step from the ideal curve."""
    clocks, directions = run.steps(axis)
    _, errors = step_errors(run, axis)
    return {
        "commanded": run.commanded(axis)[0],
        "emitted": int(directions.sum(dtype=np.int64)),
        "position": run.positions[axis],
        "pulses": len(clocks),
        "largest_error_steps": float(np.abs(errors).max(initial=0)),
    }
