# SPDX-License-Identifier: MIT
"""Shapes in integers, from the formulas of docs/architecture.md."""

from collections.abc import Sequence
from math import cos, exp, pi

from passo.registers import Shape

ONE = 1 << 24  # of s
PROGRESS_ONE = 1 << 49
POINTS = 256


def _logistic(x: float) -> float:
    return 1 / (1 + exp(-x))


def loaded_table(shape: Shape) -> list[int]:
    """Table of a shape after configuration, including point 256."""
    low, high = _logistic(-5), _logistic(5)
    formulas = {
        Shape.COSINE: lambda u: (1 - cos(pi * u)) / 2,
        Shape.SIGMOID: lambda u: (_logistic(5 * (2 * u - 1)) - low) / (high - low),
        Shape.EASE: lambda u: u * u,
    }
    return [round(formulas[shape](k / POINTS) * 65536) for k in range(POINTS + 1)]


def evaluate(progress: int, table: Sequence[int] | None) -> int:
    """s (UQ1.24) for a progress u (UQ0.49); `table` is None for linear."""
    if table is None:
        return _rounded(progress, 25)
    k, rest = divmod(progress, PROGRESS_ONE // POINTS)
    return _rounded((table[k] << 24) + (table[k + 1] - table[k]) * _rounded(rest, 17), 16)


def _rounded(number: int, bits: int) -> int:
    """To the nearest without the lower bits, ties up."""
    return (number + (1 << bits - 1)) >> bits
