# SPDX-License-Identifier: MIT
"""Checks the recorded pins of a motion: pulse timing, directions and the curve of the plan.

The guarantees are those of docs/architecture.md, checked at the pins without knowledge of the core.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from passo.curve import shapes_of
from passo.plan import Q48, Plan
from passo.run import Run, Steps
from passo.shape import POINTS

EARLY = 0.25  # substeps: the rounding to clocks is centered at full speed
LATE = 1.25  # of any axis; the steps of the leading one are at whole substeps:
LATE_LEADING = 0.25
LATENCY = 8  # clocks from the substep to the pin
ROUNDING = 2.0**-17  # of a shape: half a unit of its table
DISTANCE = 0.25  # substeps by which a plan may miss its line
FAR = 1e9  # clocks

GRID = np.arange(POINTS + 1) / POINTS  # the points of a table

Curve = tuple[np.ndarray, np.ndarray]


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
    return found or list(_pulse_faults(run, steps))


def _pulse_faults(run: Run, steps: list[Steps]) -> Iterator[Fault]:
    places, pins = [_Place.of(plan) for plan in run.plans], _Pins.of(run)
    for axis, own in enumerate(steps):
        yield from timing_faults(run, axis, own, pins)
        yield from curve_faults(run, axis, own, places)


@dataclass(frozen=True)
class _Pins:
    """Clocks since the start, and which axes change STEP and DIR there, a bit each."""

    clock: np.ndarray
    step: np.ndarray
    dir: np.ndarray

    @classmethod
    def of(cls, run: Run) -> "_Pins":
        """All pins are low at first."""
        found = []
        for name in ("step", "dir"):
            changes = run.pins[name].copy()
            changes[1:] ^= run.pins[name][:-1]
            found.append(changes)
        return cls(run.pins["clock"].astype(np.int64) - run.start, *found)

    def changes(self, pin: str, axis: int) -> np.ndarray:
        """Clocks at which a pin of an axis changes."""
        return self.clock[np.flatnonzero(getattr(self, pin) & (1 << axis))]


def _first(bad: np.ndarray) -> int | None:
    return int(np.argmax(bad)) if bad.any() else None


def timing_faults(run: Run, axis: int, steps: Steps, seen: _Pins) -> Iterator[Fault]:
    """STEP high and low, DIR setup, hold and reversals, the direction of each pulse; first faults."""
    pins, changes = run.file.pins, seen.changes("step", axis)
    rises, falls = changes[::2], changes[1::2]
    turns = seen.changes("dir", axis)
    if len(falls) != len(rises):
        yield Fault("high", f"axis {axis}: the last pulse does not end")
        return
    if (k := _first(falls - rises != pins.step_high)) is not None:
        yield Fault("high", f"axis {axis}, step {k}: STEP is high for {falls[k] - rises[k]} clocks")
    low = rises[1:] - falls[:-1]
    if (k := _first(low < pins.step_low)) is not None:
        yield Fault("low", f"axis {axis}, step {k + 1}: STEP was low for {low[k]} clocks")
    before = np.searchsorted(turns, rises, "right")
    setup = rises - np.concatenate([[-FAR], turns])[before]
    if (k := _first(setup < pins.dir_setup)) is not None:
        yield Fault("setup", f"axis {axis}, step {k}: DIR changed {int(setup[k])} clocks before")
    hold = turns - np.concatenate([[-FAR], falls])[np.searchsorted(rises, turns, "left")] - pins.step_low
    if (k := _first(hold < pins.dir_hold)) is not None:
        yield Fault(
            "hold", f"axis {axis}, clock {turns[k]}: DIR changed {int(hold[k])} clocks after the low time"
        )
    wanted = _directions(run, axis)
    if (k := _first(wanted != steps[1])) is not None:
        yield Fault("direction", f"axis {axis}, step {k}: its direction is {-wanted[k]}")
    # turns of DIR before each step, and after the last one
    made = np.concatenate([before, [len(turns)]])
    made[1:] -= before
    needed = np.zeros(len(wanted) + 1, bool)
    if len(wanted):
        needed[0] = wanted[0] < 0
        needed[1:-1] = wanted[1:] != wanted[:-1]
    if (k := _first(made != needed)) is not None:
        yield Fault("turns", f"axis {axis}: DIR turns {made[k]} times before step {k}, {needed[k]:d} needed")


def _directions(run: Run, axis: int) -> np.ndarray:
    steps = [plan.move.steps[axis] for plan in run.plans]
    return np.repeat(np.sign(steps), np.abs(steps))


def expected(plan: Plan) -> Curve:
    """Clocks since the start, and the substeps due by then: the curve, sampled in the middle of each tick.

    Before and after the plan it goes on at its highest velocity, so that a step there is early or late.
    """
    velocities, velocity = [np.empty(0)], 0.0
    shapes: dict[int, np.ndarray] = {}
    for ramp in plan.ramps:
        end, u = ramp.velocity_end / Q48, (np.arange(ramp.ticks) + 0.5) / max(ramp.ticks, 1)
        if (points := shapes.get(ramp.shape)) is None:
            points = shapes[ramp.shape] = shapes_of(plan)[ramp.shape](GRID)[0]
        s = np.interp(1 - u if ramp.mirror else u, GRID, points)
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


@dataclass(frozen=True)
class _Place:
    """Where the steps of a plan belong, for all axes."""

    curve: Curve
    tolerance: float

    @classmethod
    def of(cls, plan: Plan) -> "_Place":
        return cls(expected(plan), _tolerance(plan))


def curve_faults(run: Run, axis: int, steps: Steps, places: list[_Place]) -> Iterator[Fault]:
    """The first step that is early, and the first that is late although the pins did not keep it waiting.

    `places` are those of the plans.
    """
    clocks, directions = steps
    pins = run.file.pins
    turned = np.concatenate([[True], directions[1:] != directions[:-1]])
    turn = pins.step_low + pins.dir_hold + pins.dir_setup
    gaps = clocks.copy()
    gaps[1:] -= clocks[:-1]
    gaps[:1] += int(FAR)
    waited = gaps <= pins.step_high + pins.step_low + turned * (pins.dir_hold + pins.dir_setup + LATENCY)
    first = begin = 0
    for plan, place in zip(run.plans, places, strict=True):
        count = abs(plan.move.steps[axis])
        own = slice(first, first + count)
        times, due = clocks[own] - begin, (np.arange(count) + 0.5) * plan.line.substeps / max(count, 1)
        tolerance = place.tolerance
        lead = np.interp(times, *place.curve) - due
        leading = count == max(map(abs, plan.move.steps)) and plan.c.oversampling > 1
        latest = LATE_LEADING if leading else LATE
        in_time = np.interp(times - LATENCY - turned[own] * turn, *place.curve) - due <= latest + tolerance
        for word, bad in (("early", lead < -EARLY - tolerance), ("late", ~in_time & ~waited[own])):
            if (k := _first(bad)) is not None:
                where = f"axis {axis}, step {first + k}, clock {clocks[first + k]}"
                yield Fault("curve", f"{where}: {word}, {abs(lead[k]):.3f} substeps from its position")
        first += count
        begin += plan.clocks
