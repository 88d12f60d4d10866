# SPDX-License-Identifier: MIT
"""The moves compared: those of the publications, and random ones of the same kinds."""

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

from benchmarks.sources import MILLISECONDS, Cosine, Move, MultiAxis, Sigmoid, Trapezoid


@dataclass(frozen=True)
class Named:
    """A move of a publication, or typical for it, and the time (s) that it reports."""

    text: str
    move: Move
    published: float | None = None


def sigmoid_move(
    run_steps: int, start: int, run: int, stop: int, up_ms: int, down_ms: int, alpha: float
) -> Sigmoid:
    """A move with a given number of steps, or one more, between its ramps."""
    ramps = ((start + run) * up_ms + (run + stop) * down_ms) / 2 / MILLISECONDS
    return Sigmoid(math.ceil(ramps) + run_steps, start, run, stop, up_ms, down_ms, alpha)


NAMED = (
    Named("1 turn at 60 rpm", Trapezoid(360, 60, 10)),
    Named("1 turn at 150 rpm", Trapezoid(360, 150, 10)),
    Named("5 turns at 300 rpm", Trapezoid(1800, 300, 10)),
    Named("90° at 300 rpm (too short)", Trapezoid(90, 300, 10)),
    Named("400 Hz - 5 kHz in 1 s, alpha 5", sigmoid_move(2600, 400, 5000, 400, 1000, 1000, 5)),
    Named("400 Hz - 5 kHz in 1 s, alpha 4", sigmoid_move(2600, 400, 5000, 400, 1000, 1000, 4)),
    Named("400 Hz - 5 kHz in 1 s, alpha 3", sigmoid_move(2600, 400, 5000, 400, 1000, 1000, 3)),
    Named("50, 30 and 20 kHz in 0.1 s", MultiAxis((20_000, 12_000, 8_000), 1, 50, 100)),
    Named("the same, too short", MultiAxis((3_000, 1_800, 1_200), 1, 50, 100)),
    Named("6400 in 0.4 s", Cosine(6400, 400, 200), 0.400),
    Named("6400 in 0.4 s, 0.2 s of cruise", Cosine(6400, 400, 100), 0.398),
    Named("12800 in 0.4 s", Cosine(12800, 400, 200), 0.400),
    Named("12800 in 0.4 s, 0.2 s of cruise", Cosine(12800, 400, 100), 0.399),
    Named("25600 in 1.2 s", Cosine(25600, 1200, 600), 1.200),
    Named("25600 in 1.2 s, 0.8 s of cruise", Cosine(25600, 1200, 200), 1.190),
)


def _log_uniform(rng: random.Random, low: float, high: float) -> int:
    return round(math.exp(rng.uniform(math.log(low), math.log(high))))


def random_trapezoid(rng: random.Random) -> Trapezoid:
    """A quarter of a turn to five turns at 60 to 300 rpm."""
    return Trapezoid(rng.randint(900, 18_000) / 10, rng.randint(60, 300), rng.randint(6, 30))


def random_sigmoid(rng: random.Random) -> Sigmoid:
    """To 2 to 40 kHz in 0.05 to 0.2 s, and back in another such time; alpha is 3 to 5."""
    run = _log_uniform(rng, 2000, 40_000)
    up_ms, down_ms = (2 * rng.randint(25, 100) for _ in range(2))
    cruise, alpha = round(run * rng.uniform(0.05, 0.3)), rng.choice((3, 3.5, 4, 4.5, 5))
    return sigmoid_move(cruise, rng.randint(200, 1500), run, rng.randint(200, 1500), up_ms, down_ms, alpha)


def random_multi_axis(rng: random.Random) -> MultiAxis:
    """Up to 100 kHz, reached in 0.02 to 0.25 s, with two followers of any ratio."""
    steps = _log_uniform(rng, 500, 20_000)
    v0 = rng.randint(1, 5)
    followers = (rng.randint(1, steps) for _ in range(2))
    return MultiAxis((steps, *followers), v0, rng.randint(v0 + 5, 100), rng.randint(20, 250))


def random_cosine(rng: random.Random) -> Cosine:
    """0.1 to 0.6 s at 10 to 50 kHz; every fourth has no cruise."""
    total = 2 * rng.randint(50, 300)
    ramp = total // 2 if rng.random() < 0.25 else rng.randint(10, total // 2 - 1)
    return Cosine(round((total - ramp) * _log_uniform(rng, 10_000, 50_000) / MILLISECONDS), total, ramp)


@dataclass(frozen=True)
class Method:
    """A published method and its random moves."""

    key: str
    title: str
    kind: type
    random_move: Callable[[random.Random], Move]


METHODS = (
    Method("A", "Trapezoid by square roots", Trapezoid, random_trapezoid),
    Method("B", "Sigmoid from a table", Sigmoid, random_sigmoid),
    Method("C", "Multi-axis trapezoid and DDA", MultiAxis, random_multi_axis),
    Method("D", "Cosine in slices of 1 ms", Cosine, random_cosine),
)


def method_of(move: Move) -> Method:
    """The method of a move."""
    return next(method for method in METHODS if isinstance(move, method.kind))


def group_of(move: Move) -> str:
    """Group of a move in the statistics; moves too short for their speed form separate groups."""
    triangle = isinstance(move, Trapezoid | MultiAxis) and not move.cruises
    return method_of(move).key + (" short" if triangle else "")


def random_moves(method: Method, count: int, seed: int) -> list[Move]:
    """Reproducible random moves."""
    rng = random.Random(f"{seed} {method.key}")
    return [method.random_move(rng) for _ in range(count)]
