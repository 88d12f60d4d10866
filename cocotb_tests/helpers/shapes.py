# SPDX-License-Identifier: MIT
"""Shapes in integers, from the formulas of docs/architecture.md."""

from collections.abc import Sequence
from math import cos, exp, log1p, pi, sin

from passo.registers import Shape

ONE = 1 << 24  # of s
PROGRESS_ONE = 1 << 49
POINTS = 256


def _logistic(x: float) -> float:
    return 1 / (1 + exp(-x))


def _cosine(u: float) -> tuple[float, float]:
    """The shape, and the area below it from 0 to u."""
    return (1 - cos(pi * u)) / 2, (u - sin(pi * u) / pi) / 2


def _sigmoid(u: float) -> tuple[float, float]:
    low, high = _logistic(-5), _logistic(5)
    area = log1p(exp(5 * (2 * u - 1))) - log1p(exp(-5))
    return (_logistic(5 * (2 * u - 1)) - low) / (high - low), (area / 10 - low * u) / (high - low)


def loaded_table(shape: Shape) -> list[int]:
    """Table of a shape after configuration, including point 256."""
    if shape == Shape.EASE:
        return [k * k for k in range(POINTS + 1)]
    curve = {Shape.COSINE: _cosine, Shape.SIGMOID: _sigmoid}[shape]
    table: list[int] = []
    for k in range(POINTS // 2 + 1):
        value, area = curve(k / POINTS)
        # the area below the lines: all points so far, less half of the last
        table.append(round(65536 * (POINTS * area + value / 2)) - sum(table))
    table[POINTS // 2] = 32768
    return table + [65536 - point for point in reversed(table[: POINTS // 2])]


def evaluate(progress: int, table: Sequence[int] | None) -> int:
    """s (UQ1.24) for a progress u (UQ0.49); `table` is None for linear."""
    if table is None:
        return _rounded(progress, 25)
    k, rest = divmod(progress, PROGRESS_ONE // POINTS)
    return _rounded((table[k] << 24) + (table[k + 1] - table[k]) * _rounded(rest, 17), 16)


def _rounded(number: int, bits: int) -> int:
    """To the nearest without the lower bits, ties up."""
    return (number + (1 << bits - 1)) >> bits
