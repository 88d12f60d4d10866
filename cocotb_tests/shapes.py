# SPDX-License-Identifier: MIT
"""Shapes in integers, from the formulas of docs/architecture.md."""

from collections.abc import Sequence
from enum import IntEnum
from math import cos, exp, pi

ONE = 1 << 24  # of s and x
POINTS = 256


class Shape(IntEnum):
    """Numbers of the shapes."""

    LINEAR = 0
    COSINE = 1
    SIGMOID = 2
    EASE = 3


def _logistic(x: float) -> float:
    return 1 / (1 + exp(-x))


def loaded_table(shape: Shape) -> list[int]:
    """Table of a shape that nobody has rewritten, point 256 included."""
    low, high = _logistic(-5), _logistic(5)
    formulas = {
        Shape.COSINE: lambda u: (1 - cos(pi * u)) / 2,
        Shape.SIGMOID: lambda u: (_logistic(5 * (2 * u - 1)) - low) / (high - low),
        Shape.EASE: lambda u: u * u,
    }
    return [round(formulas[shape](k / POINTS) * 65536) for k in range(POINTS + 1)]


def evaluate(progress: int, table: Sequence[int] | None, mirror: bool) -> int:
    """s (UQ1.24) for a progress u (UQ0.48); `table` is None for linear."""
    x = (progress + (1 << 23)) >> 24
    if mirror:
        return ONE - _interpolate(ONE - x, table)
    return _interpolate(x, table)


def _interpolate(x: int, table: Sequence[int] | None) -> int:
    if table is None or x == ONE:
        return x
    k, f = divmod(x, 1 << 16)
    return (table[k] << 8) + (((table[k + 1] - table[k]) * f + (1 << 7) - (k >> 7)) >> 8)
