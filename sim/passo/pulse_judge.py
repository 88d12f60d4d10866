# SPDX-License-Identifier: MIT
"""Checks the recorded pins of a motion: pulse timing, directions and the curve of the plan.

The guarantees are those of docs/architecture.md, checked at the pins without knowledge of the core.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from passo.curve import shapes, told_of
from passo.move_forms import Points
from passo.native import ffi, planner
from passo.plan import Q48, Plan
from passo.run import Run, Steps
from passo.shape import POINTS

ROUNDING = 2.0**-17  # of a shape: half a unit of its table
DISTANCE = 0.25  # substeps by which a plan may miss its line
FAR = 1e9  # clocks
ENDLESS = (1 << 63) - 1  # clocks of a pulse that does not end

GRID = np.arange(POINTS + 1) / POINTS  # the points of a table


@dataclass(frozen=True)
class Fault:
    """A broken promise; `kind` is a word."""

    kind: str
    text: str


# A word in a sentence of `Run.problems`, and the kind of such a fault.
KINDS = {"stopped": "stop", "missing": "drain", "made": "count", "is at": "position", "took": "clocks"}


def faults(run: Run, steps: list[Steps] | None = None) -> list[Fault]:
    """All broken promises of a motion; those of the pulses only if their number is right.

    `steps` are those of run.all_steps(), if they are known.
    """
    steps = run.all_steps() if steps is None else steps
    found = [
        Fault(next((kind for word, kind in KINDS.items() if word in text), "problem"), text)
        for text in run.problems(steps)
    ]
    return found or _pulse_faults(run)


def _pulse_faults(run: Run) -> list[Fault]:
    """Those of sim/engine/passo_pulses.h, axis by axis."""
    c, pins = planner(), run.file.pins
    rows = np.ascontiguousarray(run.pins)
    curves = [expected(plan) for plan in run.plans]
    plans = ffi().new("struct passo_pulse_plan[]", len(curves))
    for plan, curve, wanted in zip(run.plans, curves, plans, strict=True):
        wanted.clocks, wanted.substeps = plan.clocks, plan.line.substeps
        wanted.steps[0 : len(plan.move.steps)] = plan.move.steps
        wanted.oversampled, wanted.tolerance = plan.c.oversampling > 1, _tolerance(plan)
        wanted.points = len(curve[0])
        wanted.times, wanted.places = (ffi().from_buffer("double[]", values) for values in curve)
    kinds = c.PASSO_PULSE_EARLY + 2 * len(curves)
    found = ffi().new("struct passo_pulse_fault[]", kinds * run.file.axes)
    timing = (pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold)
    wanted_pins = ffi().new("struct passo_pulse_pins *", timing)
    data = ffi().from_buffer("uint8_t[]", rows)
    if not c.passo_pulses_judge(
        data, len(rows), run.start, wanted_pins, plans, len(curves), run.file.axes, found
    ):
        return []
    return [_told(i // kinds, i % kinds, fault) for i, fault in enumerate(found) if fault.found]


def _told(axis: int, kind: int, fault: Any) -> Fault:
    c, step, value = planner(), fault.step, fault.value
    at = f"axis {axis}, step {step}"
    match kind:
        case c.PASSO_PULSE_HIGH if value == ENDLESS:
            return Fault("high", f"axis {axis}: the last pulse does not end")
        case c.PASSO_PULSE_HIGH:
            return Fault("high", f"{at}: STEP is high for {value} clocks")
        case c.PASSO_PULSE_LOW:
            return Fault("low", f"{at}: STEP was low for {value} clocks")
        case c.PASSO_PULSE_SETUP:
            return Fault("setup", f"{at}: DIR changed {value} clocks before")
        case c.PASSO_PULSE_HOLD:
            text = f"DIR changed {value} clocks after the low time"
            return Fault("hold", f"axis {axis}, clock {step}: {text}")
        case c.PASSO_PULSE_DIRECTION:
            return Fault("direction", f"{at}: its direction is {value}")
        case c.PASSO_PULSE_TURNS:
            text = f"DIR turns {value} times before step {step}, {fault.off:.0f} needed"
            return Fault("turns", f"axis {axis}: {text}")
    word = "early" if (kind - c.PASSO_PULSE_EARLY) % 2 == 0 else "late"
    text = f"{at}, clock {value}: {word}, {fault.off:.3f} substeps from its position"
    return Fault("curve", text)


Curve = tuple[np.ndarray, np.ndarray]


@lru_cache(16)
def _points(shape: int, alpha: int, table: Points) -> np.ndarray:
    return shapes(alpha, table)[shape](GRID)[0]


def expected(plan: Plan) -> Curve:
    """Clocks since the start, and the substeps due by then: the curve, sampled in the middle of each tick.

    Before and after the plan it goes on at its highest velocity, so that a step there is early or late.
    """
    velocities, velocity, told = [np.empty(0)], 0.0, told_of(plan)
    for ramp in plan.ramps:
        end = ramp.velocity_end / Q48
        if end == velocity:
            velocities.append(np.full(ramp.ticks, end))
        elif ramp.ticks:
            u = (np.arange(ramp.ticks) + 0.5) / ramp.ticks
            s = np.interp(1 - u if ramp.mirror else u, GRID, _points(ramp.shape, *told))
            velocities.append(velocity + (end - velocity) * (1 - s if ramp.mirror else s))
        velocity = end
    tick, peak = 1 << plan.tick_log2, plan.c.velocity_peak / Q48
    distance = np.concatenate([[0], np.cumsum(np.concatenate(velocities))]) * tick
    clocks = np.arange(len(distance), dtype=float) * tick
    return (
        np.concatenate([[-FAR], clocks, [clocks[-1] + FAR]]),
        np.concatenate([[-FAR * peak], distance, [distance[-1] + FAR * peak]]),
    )


def _tolerance(plan: Plan) -> float:
    """Substeps by which rounding may move a step."""
    change, velocity = 0.0, 0
    for ramp in plan.ramps:
        change += abs(ramp.velocity_end - velocity) / Q48 * (ramp.ticks << plan.tick_log2)
        velocity = ramp.velocity_end
    return DISTANCE + change * ROUNDING
