# SPDX-License-Identifier: MIT
"""The ideal continuous motion of a plan, and the distance of each step from it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from passo.move_forms import SHAPED, USER, Points
from passo.plan import ALPHA_ONE, ALPHA_RESET, Q48, Plan
from passo.run import Run
from passo.shape import ONE, POINTS

# A function of u that returns a shape and its integral from 0 to u.
Shape = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def _logistic(x: np.ndarray) -> np.ndarray:
    return 1 / (1 + np.exp(-x))


def _linear(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return u, u**2 / 2


def _cosine(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (1 - np.cos(np.pi * u)) / 2, u / 2 - np.sin(np.pi * u) / (2 * np.pi)


def _sigmoid(u: np.ndarray, a: float) -> tuple[np.ndarray, np.ndarray]:
    low = _logistic(-a)
    height = _logistic(a) - low
    x = a * (2 * u - 1)
    area = (np.logaddexp(0, x) - np.logaddexp(0, -a)) / (2 * a) - low * u
    return (_logistic(x) - low) / height, area / height


def _ease(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return u**2, u**3 / 3


def _table(u: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear interpolation between the points; the last one is 1."""
    place = u * POINTS
    k = np.minimum(place.astype(int), POINTS - 1)
    areas = np.concatenate([[0], np.cumsum((points[1:] + points[:-1]) / 2)])
    value = points[k] + (points[k + 1] - points[k]) * (place - k)
    return value, (areas[k] + (points[k] + value) / 2 * (place - k)) / POINTS


def shapes_of(plan: Plan) -> tuple[Shape, ...]:
    """The shapes that the ramps of a plan use, indexed by enum passo_shape."""
    return shapes(*told_of(plan))


def told_of(plan: Plan) -> tuple[int, Points]:
    """What tells them: alpha of the sigmoid in units of 1/4096, and the points of a table in its place, or
    none."""
    own = plan.move.profile in (USER, SHAPED)
    return plan.c.sigmoid_alpha or ALPHA_RESET, plan.table if own else ()


def shapes(alpha: int, table: Points) -> tuple[Shape, ...]:
    """The shapes for what `told_of` returns."""
    sigmoid = partial(_sigmoid, a=alpha / ALPHA_ONE)
    if table:
        sigmoid = partial(_table, points=np.array([*table, ONE]) / ONE)
    return _linear, _cosine, sigmoid, _ease


def _mirrored(shape: Shape, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    value, area = shape(1 - u)
    return 1 - value, u - (shape(np.ones_like(u))[1] - area)


@dataclass(frozen=True)
class Segment:
    """One ramp: times in clocks since the start of the plan, distances in substeps."""

    begin: float
    length: float
    distance: float
    velocity: float
    velocity_end: float
    shape: Shape

    def at(self, clocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocity (substeps per clock) and distance (substeps) at `clocks`, clamped to the segment."""
        u = np.clip((clocks - self.begin) / self.length, 0, 1)
        value, area = self.shape(u)
        change = self.velocity_end - self.velocity
        return (
            self.velocity + change * value,
            self.distance + self.length * (self.velocity * u + change * area),
        )


class Curve:
    """Velocity (substeps per clock) and distance (substeps) of a plan over the clocks since its start."""

    def __init__(self, plan: Plan):
        self.clocks = plan.clocks
        self.segments: list[Segment] = []
        shapes = shapes_of(plan)
        begin = distance = velocity = 0.0
        for ramp in plan.ramps:
            length, velocity_end = float(ramp.ticks << plan.tick_log2), ramp.velocity_end / Q48
            if length:
                shape = partial(_mirrored, shapes[ramp.shape]) if ramp.mirror else shapes[ramp.shape]
                segment = Segment(begin, length, distance, velocity, velocity_end, shape)
                self.segments.append(segment)
                begin += length
                distance = float(segment.at(np.array(begin))[1])
            velocity = velocity_end

    def at(self, clocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and distance at each of `clocks`; the velocity outside the plan is 0."""
        velocity, distance = np.zeros(len(clocks)), np.zeros(len(clocks))
        for segment in self.segments:
            inside = clocks >= segment.begin
            velocity[inside], distance[inside] = segment.at(clocks[inside])
        velocity[(clocks < 0) | (clocks > self.clocks)] = 0
        return velocity, distance


def step_errors(run: Run, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Clock of each step of an axis, and the lead of the ideal curve over the step at that clock, in steps.

    Step q (from 0) of a line belongs at distance q + 1/2, because the DDA starts half full.
    """
    clocks, _ = run.steps(axis)
    errors, first, begin = [], 0, 0
    for plan in run.plans:
        count = abs(plan.move.steps[axis])
        own = clocks[first : first + count]
        _, distance = Curve(plan).at((own - begin).astype(float))
        errors.append(distance * count / plan.line.substeps - (np.arange(len(own)) + 0.5))
        first += count
        begin += plan.clocks
    return clocks[:first], np.concatenate(errors)


def speeds_and_positions(run: Run, points: int = 2000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ideal motion, sampled: times (clocks), speeds (steps per clock) and positions (steps).

    Speeds and positions have one row per axis; there are about `points` columns.
    """
    times, speeds, positions = [], [], []
    begin, base = 0, np.zeros((run.file.axes, 1))
    for plan in run.plans:
        clocks = np.linspace(0, plan.clocks, max(20, points // len(run.plans)))
        clocks = np.concatenate([[0], clocks, [plan.clocks]])
        velocity, distance = Curve(plan).at(clocks)
        velocity[[0, -1]] = 0  # a plan starts and ends at rest, possibly with a jump
        share = np.array(plan.move.steps)[:, None] / plan.line.substeps
        times.append(clocks + begin)
        speeds.append(velocity * share)
        positions.append(base + distance * share)
        begin += plan.clocks
        base = base + np.array(plan.move.steps)[:, None]
    return np.concatenate(times), np.concatenate(speeds, axis=1), np.concatenate(positions, axis=1)
