# SPDX-License-Identifier: MIT
"""Output files of a run: pulses.csv and summary.json."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from passo.curve import step_errors
from passo.plan import Q48
from passo.run import Run


def write_pulses(run: Run, path: Path) -> None:
    """Write a row per step, sorted by clock and axis; clocks count from the start of the motion."""
    per_axis = [run.steps(axis) for axis in range(run.file.axes)]
    clocks = np.concatenate([clocks for clocks, _ in per_axis])
    directions = np.concatenate([directions for _, directions in per_axis])
    axes = np.repeat(np.arange(run.file.axes), [len(clocks) for clocks, _ in per_axis])
    order = np.lexsort((axes, clocks))
    rows = zip(clocks[order].tolist(), axes[order].tolist(), directions[order].tolist(), strict=True)
    with path.open("w") as file:
        file.write("clock,axis,direction\n")
        file.writelines(f"{clock},{axis},{direction}\n" for clock, axis, direction in rows)


def summarize(run: Run, engine: str) -> dict[str, Any]:
    """The contents of summary.json."""
    return {
        "name": run.file.name,
        "engine": engine,
        "ok": not run.problems(),
        "problems": run.problems(),
        "clock_hz": run.file.clock_hz,
        "total_clocks": run.total_clocks,
        "total_seconds": run.total_clocks / run.file.clock_hz,
        "matched_edges": run.matched_edges,
        "drained": run.state.drained,
        "clocks_per_second": round(run.clocks / run.seconds),
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


def write_json(data: Any, path: Path) -> None:
    """Write indented JSON."""
    path.write_text(json.dumps(data, indent=2) + "\n")
