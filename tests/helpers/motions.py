# SPDX-License-Identifier: MIT
"""Lines and ramps for tests, and their conversion to C structs."""

import random
from collections.abc import Sequence
from typing import Any

from passo.native import ffi

from tests.helpers.closed_form import COSINE, ONE, SHAPES, TABLES, Line, Ramp, Tables, substep_clocks

SLOW = ONE // 40  # with the shortest pin timings no step has to wait then, not even for DIR


def to_line(line: Line) -> Any:
    """The `struct passo_line`."""
    directions = sum((n < 0) << axis for axis, n in enumerate(line.steps))
    steps = [abs(n) for n in line.steps]
    fields = {"last": line.last, "endless": line.endless, "directions": directions}
    return ffi().new("struct passo_line *", {**fields, "substeps": line.substeps, "steps": steps})[0]


def to_ramp(ramp: Ramp) -> Any:
    """The `struct passo_ramp`."""
    fields = {"last": ramp.last, "now": ramp.now, "mirror": ramp.mirror, "shape": ramp.shape}
    return ffi().new(
        "struct passo_ramp *",
        {
            **fields,
            "velocity_end": ramp.velocity_end,
            "ticks": ramp.ticks,
            "progress_step": ramp.progress_step,
        },
    )[0]


def distance(ramps: Sequence[Ramp], tick_log2: int = 7, tables: Tables = TABLES) -> int:
    """Whole substeps under the ramps."""
    return len(substep_clocks(ramps, tick_log2, tables))


def fill(
    ramps: Sequence[Ramp], shares: Sequence[tuple[int, ...]], tick_log2: int = 7, tables: Tables = TABLES
) -> list[Line]:
    """As many lines as shares, that together use up the distance; a share is the steps per 100 substeps."""
    total = distance(ramps, tick_log2, tables)
    lengths = [total // len(shares)] * len(shares)
    lengths[-1] += total - sum(lengths)
    return [
        Line(m, tuple((m * abs(n) // 100) * (-1 if n < 0 else 1) for n in share), last=i == len(shares) - 1)
        for i, (m, share) in enumerate(zip(lengths, shares, strict=True))
    ]


def random_motion(
    rng: random.Random, axes: int, most_lines: int = 9, most_ramps: int = 14, tables: Tables = TABLES
) -> tuple[list[Line], list[Ramp]]:
    """A limited number of lines and ramps of all kinds; at least 3 ramps."""
    ramps = []
    for _ in range(rng.randint(1, most_ramps - 2)):
        velocity = rng.choice([0, rng.randrange(SLOW), SLOW, rng.randrange(1 << rng.randint(1, 42))])
        # more than two that take no time do take some
        least = int(len(ramps) > 1 and ramps[-1].ticks == ramps[-2].ticks == 0)
        ticks = rng.choice([least, 1, 2, 3, rng.randint(1, 60)])
        ramps.append(Ramp(velocity, ticks, rng.choice(SHAPES), rng.random() < 0.5))
    ramps.append(Ramp(SLOW, 30, COSINE))
    ramps.append(Ramp(0, rng.randint(0, 40), rng.choice(SHAPES), rng.random() < 0.5, last=True))
    shares = [tuple(rng.randint(-100, 100) for _ in range(axes)) for _ in range(rng.randint(1, most_lines))]
    return fill(ramps, shares, tables=tables), ramps
