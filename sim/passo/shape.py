# SPDX-License-Identifier: MIT
"""User-defined shapes: tables of 256 points, from a formula or a file.

A shape rises from 0 to 1 while the progress u goes from 0 to 1, and never decreases. Point k is
shape(k / 256) in units of 2^-16; point 256 is always 1 and not stored.
"""

import csv
import io
import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

from passo.failure import BadInputError
from passo.output import complete, write_text
from passo.registers import ADDRESS_SIGMOID_COUNT

POINTS = ADDRESS_SIGMOID_COUNT
ONE = 1 << 16
HEADER = ("k", "point")
CURVE_HEADER = ("u", "s")

Points = tuple[int, ...]


class ShapeError(BadInputError):
    """Not a valid shape; the text is the reason, in one line."""


@dataclass(frozen=True)
class Facts:
    """Properties of a table."""

    mean: Fraction  # exact, with linear interpolation
    symmetric: bool


PARTS = 16  # of an interval between two points, for its area
PLACES = tuple(k / (POINTS * PARTS) for k in range(POINTS * PARTS + 1))


def sample(shape: Callable[[float], float]) -> Points:
    """Sample a function to a checked table, scaled to start at 0 and end at 1. Raises ShapeError."""
    return from_values([shape(u) for u in PLACES])


def from_values(values: Sequence[float]) -> Points:
    """The same of its values at PLACES.

    What a ramp travels is the area below the straight lines between its points. So the points are not
    rounded each by itself: each is the integer that keeps the area from the start to it closest to that
    of the function.
    """
    import numpy as np

    first, last = values[0], values[-1]
    if not last > first:
        raise ShapeError("a shape must rise: s(1) must be above s(0)")
    fine = (np.asarray(values, float) - first) / (last - first) * ONE
    exact = fine[::PARTS].tolist()
    check(tuple(_stored(round(point)) for point in exact[:-1]))
    symmetric = all(abs(exact[k] + exact[POINTS - k] - ONE) < SAME for k in range(POINTS + 1))
    # the means of the intervals (Simpson's rule)
    parts = fine[:-1].reshape(POINTS, PARTS).T.copy()
    inner = 4 * parts[1::2].sum(axis=0) + 2 * parts[2::2].sum(axis=0)
    means = ((parts[0] + inner + fine[PARTS::PARTS]) / (3 * PARTS)).tolist()
    points = _by_area(means, exact, POINTS // 2 if symmetric else POINTS)
    if symmetric:
        points = [*points, ONE // 2, *(ONE - point for point in points[:0:-1])]
    table = tuple(map(_stored, points))
    check(table)
    return table


SAME = 1e-6  # points; less is the rounding of floating point


def _stored(point: int) -> int:
    """Limit a shape that reaches 1 before its end to 16 bits."""
    return ONE - 1 if point == ONE else point


def _by_area(means: Sequence[float], exact: Sequence[float], count: int) -> list[int]:
    """The first points; the area up to point k is the sum of the points before it and half of itself."""
    points: list[int] = []
    area, total, least = 0.0, 0, 0
    for k in range(count):
        wanted = round(area + exact[k] / 2 - total)
        least = min(max(wanted, least), ONE)
        points.append(least)
        total += least
        area += means[k]
    return points


def check(points: Sequence[int]) -> Facts:
    """Check that a table is a shape; raises ShapeError."""
    if len(points) != POINTS:
        raise ShapeError(f"a table must have {POINTS} points, not {len(points)}")
    if not (min(points) >= 0 and max(points) < ONE):
        k, point = next((k, point) for k, point in enumerate(points) if not 0 <= point < ONE)
        raise ShapeError(f"point {k} is {point}; must be 0 to {ONE - 1}")
    if points[0]:
        raise ShapeError(f"a shape must start at 0, not at {points[0]}")
    whole = [*points, ONE]
    for k, (point, after) in enumerate(pairwise(whole)):
        if after < point:
            raise ShapeError(f"a shape must not decrease: point {k} is {point}, point {k + 1} is {after}")
    mean = Fraction(sum(whole[:-1]) + sum(whole[1:]), 2 * POINTS * ONE)
    return Facts(mean, all(whole[k] + whole[POINTS - k] == ONE for k in range(POINTS + 1)))


def read_table(path: Path) -> Points:
    """Read a table from a CSV file: `k,point` with all points, or `u,s` with any points of a curve.

    Raises ShapeError.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            text = file.read()
    except OSError as error:
        raise ShapeError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ShapeError(f"{path}: not a CSV file") from None
    return parse_table(text, path)


def parse_table(text: str, path: Path) -> Points:
    """The same of the text of a file."""
    try:
        rows = [[cell.strip() for cell in row] for row in csv.reader(io.StringIO(text, newline="")) if row]
    except csv.Error:
        raise ShapeError(f"{path}: not a CSV file") from None
    header, rows = tuple(rows[0]) if rows else (), rows[1:]
    if header not in (HEADER, CURVE_HEADER):
        raise ShapeError(f"{path}: the first line must be k,point or u,s")
    try:
        return _points(rows) if header == HEADER else sample(_curve(rows))
    except ShapeError as error:
        raise ShapeError(f"{path}: {error}") from None
    except ValueError:
        raise ShapeError(f"{path}: every line must have two numbers") from None


def _points(rows: list[list[str]]) -> Points:
    pairs = [(int(k), int(point)) for k, point in rows]
    if pairs and pairs[-1] == (POINTS, ONE):
        pairs.pop()
    if [k for k, _ in pairs] != list(range(POINTS)):
        raise ShapeError(f"the lines must be the points 0 to {POINTS - 1}")
    points = tuple(point for _, point in pairs)
    check(points)
    return points


def _curve(rows: list[list[str]]) -> Callable[[float], float]:
    """Linear interpolation between the points of a curve."""
    us, values = (list(column) for column in zip(*((float(u), float(s)) for u, s in rows), strict=True))
    if len(us) < 2 or us[0] != 0 or us[-1] != 1 or any(b <= a for a, b in pairwise(us)):
        raise ShapeError("u must rise strictly from 0 to 1")
    if not all(map(math.isfinite, values)):
        raise ShapeError("s must be finite")

    def value(u: float) -> float:
        i = min(bisect_right(us, u), len(us) - 1)
        part = (u - us[i - 1]) / (us[i] - us[i - 1])
        return values[i - 1] + (values[i] - values[i - 1]) * part

    return value


def write_table(points: Sequence[int], path: Path) -> None:
    """Write a table as CSV, or as TOML if the file name ends in .toml."""
    if path.suffix.lower() == ".toml":
        rows = (points[k : k + 8] for k in range(0, POINTS, 8))
        lines = "".join(f"    {', '.join(map(str, row))},\n" for row in rows)
        mean = check(points).mean
        write_text(
            path, f"mean = {mean.numerator * (1 << 24) // mean.denominator} # of 2^24\npoints = [\n{lines}]\n"
        )
    else:
        write_text(path, table_text(points))


def table_text(points: Sequence[int]) -> str:
    """A table as CSV."""
    return "k,point\n" + "".join(f"{k},{point}\n" for k, point in enumerate(points))


def check_table(path: Path) -> None:
    """Raises BadInputError if there are no tables of that name."""
    if path.suffix.lower() not in (".csv", ".toml") and (path.is_file() or not path.exists()):  # no device
        raise BadInputError(f"--out {path}: the name must end in .csv or .toml")


def check_picture(path: Path) -> None:
    """Raises BadInputError if there are no pictures of that name."""
    from matplotlib.backend_bases import FigureCanvasBase

    if path.suffix[1:].lower() not in FigureCanvasBase.filetypes:
        raise BadInputError(f"--plot {path}: the name must end in .png, .svg or .pdf")


def plot_table(points: Sequence[int], path: Path) -> None:
    """Plot a shape and its slope."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    whole = [point / ONE for point in (*points, ONE)]
    places = [k / POINTS for k in range(POINTS + 1)]
    slopes = [(b - a) * POINTS for a, b in pairwise(whole)]
    figure, axes = plt.subplots(figsize=(5, 3.2), layout="constrained")
    axes.plot(places, whole, color="#0072b2", label="shape: speed")
    axes.plot([], [], color="#d55e00", label="slope: acceleration")
    axes.set_xlabel("progress u")
    axes.set_xlim(0, 1)
    axes.set_ylim(0, 1)
    axes.grid(color="#d8dee4", linewidth=0.6)
    axes.legend(loc="upper left", frameon=False)
    twin = axes.twinx()
    twin.stairs(slopes, places, color="#d55e00", linewidth=0.9)
    twin.set_ylim(0)
    with complete(path) as part:
        figure.savefig(part, dpi=110)
    plt.close(figure)
