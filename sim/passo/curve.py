# SPDX-License-Identifier: MIT
"""The ideal continuous motion of a plan, and how far each step is from it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from passo.plan import Q48, Plan
from passo.run import Run

SIGMOID_A = 5.0


def _logistic(x: np.ndarray) -> np.ndarray:
    return 1 / (1 + np.exp(-x))


def _linear(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return u, u**2 / 2


def _cosine(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (1 - np.cos(np.pi * u)) / 2, u / 2 - np.sin(np.pi * u) / (2 * np.pi)


def _sigmoid(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    a, low = SIGMOID_A, _logistic(-SIGMOID_A)
    height = _logistic(a) - low
    x = a * (2 * u - 1)
    area = (np.logaddexp(0, x) - np.logaddexp(0, -a)) / (2 * a) - low * u
    return (_logistic(x) - low) / height, area / height


def _ease(u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return u**2, u**3 / 3


# Shape and its integral from 0 to u, by enum passo_shape.
SHAPES: tuple[Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], ...] = (
    _linear,
    _cosine,
    _sigmoid,
    _ease,
)


def _shape(ramp: Any, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    shape = SHAPES[ramp.shape]
    if not ramp.mirror:
        return shape(u)
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
    ramp: Any

    def at(self, clocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and distance; beyond its ends as at its ends."""
        u = np.clip((clocks - self.begin) / self.length, 0, 1)
        value, area = _shape(self.ramp, u)
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
        begin = distance = velocity = 0.0
        for ramp in plan.ramps:
            length, velocity_end = float(ramp.ticks << plan.tick_log2), ramp.velocity_end / Q48
            if length:
                segment = Segment(begin, length, distance, velocity, velocity_end, ramp)
                self.segments.append(segment)
                begin += length
                distance = float(segment.at(np.array(begin))[1])
            velocity = velocity_end

    def at(self, clocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Velocity and distance."""
        velocity, distance = np.zeros(len(clocks)), np.zeros(len(clocks))
        for segment in self.segments:
            inside = clocks >= segment.begin
            velocity[inside], distance[inside] = segment.at(clocks[inside])
        velocity[(clocks < 0) | (clocks > self.clocks)] = 0
        return velocity, distance


def step_errors(run: Run, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Clock of each step of an axis and how far the ideal curve is beyond the step's own place, in steps.

    The place of step q (from 0) of a line is q + 1/2: the DDA starts half full.
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
    """Times (clocks), speeds (steps per clock) and positions (steps) of the ideal motion; axes are rows."""
    times, speeds, positions = [], [], []
    begin, base = 0, np.zeros((run.file.axes, 1))
    for plan in run.plans:
        clocks = np.linspace(0, plan.clocks, max(20, points // len(run.plans)))
        clocks = np.concatenate([[0], clocks, [plan.clocks]])
        velocity, distance = Curve(plan).at(clocks)
        velocity[[0, -1]] = 0  # a plan starts and ends at rest, maybe with a jump
        share = np.array(plan.move.steps)[:, None] / plan.line.substeps
        times.append(clocks + begin)
        speeds.append(velocity * share)
        positions.append(base + distance * share)
        begin += plan.clocks
        base = base + np.array(plan.move.steps)[:, None]
    return np.concatenate(times), np.concatenate(speeds, axis=1), np.concatenate(positions, axis=1)
