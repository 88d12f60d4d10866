# SPDX-License-Identifier: MIT
"""Quantities compared, for a move and for many."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from passo.engine import model_engine
from passo.host import load_table
from passo.link import Link
from passo.moves import MoveFile, PinTiming
from passo.plan import Plan
from passo.run import execute

from benchmarks import passo_side, sources
from benchmarks.cases import group_of
from benchmarks.ideal import Ideal
from benchmarks.passo_side import CLOCK_HZ, PARAMETERS, TICK_SECONDS
from benchmarks.sources import Move, Pulses

# All are magnitudes; NaN if not defined for a move.
QUANTITIES = (
    *("steps", "time", "distance", "start", "run", "stop", "followers"),  # against the ideal curve
    *("ticks", "planned", "missing"),  # Passo only: time in ticks, and deviation from the plan
)
NAN = float("nan")
SIGMOID = passo_side.SHAPES.index("sigmoid")


def compare(pulses: Pulses, wish: Ideal, steps: tuple[int, ...]) -> dict[str, float]:
    """Compare pulses with a curve: relative errors of time and frequencies, distances in steps."""
    followers = [
        np.abs(wish.distances(times, count / steps[0])).max(initial=0)
        for times, count in zip(pulses.followers, steps[1:], strict=True)
    ]
    counts = [len(times) for times in (pulses.times, *pulses.followers)]
    errors = {
        "steps": sum(abs(made - count) for made, count in zip(counts, steps, strict=True)),
        "time": abs(pulses.seconds - wish.seconds) / wish.seconds,
        "distance": float(np.abs(wish.distances(pulses.times)).max(initial=0)),
        "followers": float(max(followers)) if followers else NAN,
    }
    for name in ("start", "run", "stop"):
        wanted = getattr(wish, name)
        errors[name] = abs(getattr(pulses, name) - wanted) / wanted if wanted else NAN
    return errors


@dataclass(frozen=True)
class Result:
    """Measurements of a move."""

    move: Move
    source: dict[str, float]
    passo: dict[str, float]
    source_seconds: float
    passo_seconds: float
    wish_seconds: float

    @property
    def group(self) -> str:
        """Group in the statistics."""
        return group_of(self.move)


def measure(move: Move) -> Result:
    """Measure a published method and Passo against the ideal curve."""
    wish, steps = passo_side.wanted_curve(move), passo_side.wanted_steps(move)
    pulses, made = sources.simulate(move), passo_side.make(move)
    passo = compare(made.pulses, wish, steps)
    passo["ticks"] = abs(made.pulses.seconds - wish.seconds) / TICK_SECONDS
    passo["planned"] = float(np.abs(made.planned.distances(made.pulses.times)).max(initial=0))
    passo["missing"] = made.missing
    return Result(
        move, compare(pulses, wish, steps), passo, pulses.seconds, made.pulses.seconds, wish.seconds
    )


def statistics(errors: list[dict[str, float]]) -> dict[str, dict[str, float]]:
    """Median, 99th percentile and worst of each quantity that the moves have."""
    made = {}
    for name in QUANTITIES:
        values = np.array([error.get(name, NAN) for error in errors], dtype=float)
        values = values[~np.isnan(values)]
        if len(values):
            median, most, worst = np.quantile(values, (0.5, 0.99, 1), method="higher")
            made[name] = {"median": float(median), "most": float(most), "worst": float(worst)}
    return made


def check_with_model(plan: Plan) -> int:
    """Execute a move on the C model, from SPI to pins; return the number of steps compared.

    Each step must leave its pin on the clock computed by steps.c.
    """
    file = MoveFile(Path("accuracy"), CLOCK_HZ, PinTiming(), (plan.move,))
    with model_engine(PARAMETERS, CLOCK_HZ) as engine:
        if plan.table:
            load_table(Link(engine), SIGMOID, plan.table)
        run = execute(file, [plan], engine)
    if run.problems():
        raise AssertionError(f"{plan.move}: {run.problems()}")
    expected, _ = passo_side.step_clocks(plan)
    for axis, clocks in enumerate(expected):
        if not np.array_equal(run.steps(axis)[0], clocks):
            raise AssertionError(f"{plan.move}: steps of axis {axis} are not where the recurrences put them")
    return sum(map(len, expected))
