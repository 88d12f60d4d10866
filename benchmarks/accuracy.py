# SPDX-License-Identifier: MIT
"""Accuracy of Passo compared with four published microcontroller methods: `make accuracy`.

Prints a table and writes build/accuracy.json, docs/reference/accuracy.md and docs/images/accuracy.png.
"""

import argparse
import math
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

from passo import native
from passo.build import model_library
from passo.console import console, progress
from passo.ending import ended
from passo.output import check_results, write_json, write_text
from passo.toolchain import paths
from rich.console import Console

from benchmarks import passo_side
from benchmarks.cases import METHODS, NAMED, method_of, random_moves
from benchmarks.forms import FORMS, measure_forms
from benchmarks.measure import Result, check_with_model, measure, statistics
from benchmarks.passo_side import CLOCK_HZ, PARAMETERS
from benchmarks.peer import KINDS, MOVES, compare_with_peer
from benchmarks.picture import plot_accuracy
from benchmarks.resonance import measure_resonances
from benchmarks.sources import Move
from benchmarks.tables import (
    named_table,
    page,
    peer_table,
    plan_table,
    random_table,
    resonance_table,
)

REPORT = paths.build / "accuracy.json"
PAGE = paths.reference / "accuracy.md"
PICTURE = paths.docs / "images" / "accuracy.png"

CASES = 10_000  # random moves of each method
SEED = 1
CHUNK = 100
WORKERS = 2
WIDTH = 118  # of the tables without a terminal
MODEL_MOVES = 25  # of each method, also executed on the C model
FORMS_SHARE = 5  # forms without a published counterpart get a fifth of the random moves


def measure_some(moves: list[Move]) -> list[Result]:
    """Measure a batch of moves in a worker."""
    return [measure(move) for move in moves]


def check_some(moves: list[Move]) -> int:
    """Execute moves on the C model; return the number of steps compared."""
    return sum(check_with_model(passo_side.make(move).plan) for move in moves)


@dataclass
class Measured:
    """Results of all random moves."""

    results: list[Result]
    forms: dict[str, list[dict[str, float]]]
    peers: dict[str, dict[str, Any]]
    checked_moves: int
    checked_steps: int


def measure_all(cases: int, seed: int) -> Measured:
    """Measure random moves of all methods and forms, some of them also on the C model."""
    moves = [move for method in METHODS for move in random_moves(method, cases, seed)]
    portions = [moves[i : i + CHUNK] for i in range(0, len(moves), CHUNK)]
    checked = [move for method in METHODS for move in random_moves(method, min(cases, MODEL_MOVES), seed)]
    results: list[Result] = []
    with (
        ProcessPoolExecutor(WORKERS, initializer=native.planner) as pool,
        progress("random moves", len(moves)) as report,
    ):
        for some in pool.map(measure_some, portions):
            results += some
            report(len(results))
        own = {name: pool.submit(measure_forms, name, max(1, cases // FORMS_SHARE), seed) for name in FORMS}
        share = max(1, MOVES * cases // CASES)
        peers = {name: pool.submit(compare_with_peer, name, share, seed) for name in KINDS}
        steps = sum(pool.map(check_some, ([move] for move in checked)))
        forms = {name: errors.result() for name, errors in own.items()}
        against = {name: found.result() for name, found in peers.items()}
        return Measured(results, forms, against, len(checked), steps)


def groups(results: list[Result]) -> Iterator[tuple[str, list[Result]]]:
    """Results by group, in the order of the methods."""
    for name in sorted({result.group for result in results}):
        yield name, [result for result in results if result.group == name]


def present(errors: dict[str, float]) -> dict[str, float]:
    """The quantities that are defined for a move."""
    return {name: value for name, value in errors.items() if not math.isnan(value)}


def gather(measured: Measured, named: list[Result]) -> dict[str, Any]:
    """All data of the report."""
    return {
        "clock_hz": CLOCK_HZ,
        "tick_clocks": 1 << PARAMETERS.tick_log2,
        "random": {
            name: {
                "moves": len(some),
                "source": statistics([result.source for result in some]),
                "passo": statistics([result.passo for result in some]),
            }
            for name, some in groups(measured.results)
        },
        "forms": {
            name: {"moves": len(errors), "passo": statistics(errors)}
            for name, errors in measured.forms.items()
        },
        "named": [
            {
                "method": method_of(result.move).key,
                "move": case.text,
                "wanted_seconds": result.wish_seconds,
                "published_seconds": case.published,
                "source_seconds": result.source_seconds,
                "passo_seconds": result.passo_seconds,
                "source": present(result.source),
                "passo": present(result.passo),
            }
            for case, result in zip(NAMED, named, strict=True)
        ],
        "peers": measured.peers,
        "resonances": measure_resonances(),
        "checked": {"moves": measured.checked_moves, "steps": measured.checked_steps},
    }


def accuracy(cases: int = CASES, seed: int = SEED) -> dict[str, Any]:
    """Measure, print, write the report, the page and the picture."""
    check_results(REPORT, PAGE, PICTURE)
    began = time.monotonic()
    for build in (native.planner, model_library, passo_side.library):  # before workers start
        build()
    named = [measure(case.move) for case in NAMED]
    measured = measure_all(cases, seed)
    report = {"cases": cases, "seed": seed} | gather(measured, named)
    write_json(report, REPORT)
    write_text(PAGE, page(report))
    plot_accuracy(PICTURE)
    screen = console if console.is_terminal else Console(width=WIDTH)
    for shown in (
        random_table(report),
        named_table(report),
        plan_table(report),
        peer_table(report),
        resonance_table(report),
    ):
        screen.print(shown)
        screen.print()
    made = len(measured.results) + sum(map(len, measured.forms.values()))
    screen.print(
        f"{made:,} random moves in {time.monotonic() - began:.0f} s; {measured.checked_steps:,} steps of"
        f" {measured.checked_moves} of them were also made by the C model, each on the same clock"
    )
    screen.print(" ".join(str(path.relative_to(paths.root)) for path in (REPORT, PAGE, PICTURE)))
    return report


def main() -> None:
    """Parse the command line and run."""
    parser = argparse.ArgumentParser(prog="benchmarks.accuracy", description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=CASES, help="random moves of each method")
    parser.add_argument("--seed", type=int, default=SEED, help="seed of the random moves")
    arguments = parser.parse_args()
    accuracy(arguments.cases, arguments.seed)


if __name__ == "__main__":
    sys.exit(ended(main))
