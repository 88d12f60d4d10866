# SPDX-License-Identifier: MIT
"""Tables for the terminal, and the page docs/reference/accuracy.md."""

from pathlib import Path
from typing import Any

import numpy as np
from passo.console import table
from rich.table import Table

from benchmarks.cases import METHODS
from benchmarks.resonance import DETUNED, FREQUENCY
from benchmarks.sources import sigmoid

TEMPLATE = Path(__file__).with_name("page.md")
TITLES = {method.key: method.title for method in METHODS}
SIDES = {"source": "as published", "passo": "Passo"}

# Quantities with their headings; `time` and frequencies are relative, the others are in steps.
COLUMNS = {
    "steps": "wrong steps",
    "time": "total time",
    "distance": "steps off",
    "start": "start",
    "run": "run",
    "stop": "stop",
    "followers": "followers off",
}
RELATIVE = {"time", "start", "run", "stop"}
NONE = "–"


def number(value: float) -> str:
    """Three significant digits without exponent."""
    if value == 0:
        return "0"
    if value < 1e-5:
        return "< 0.00001"
    if value >= 99.95:
        return f"{value:,.0f}"
    if value >= 0.9995:
        return f"{value:.1f}" if value >= 9.995 else f"{value:.2f}"
    return np.format_float_positional(value, 2, fractional=False, trim="-")


def relative(value: float) -> str:
    """In percent, or in ppm if small."""
    if value < 5e-10:  # less than 0.0005 ppm: nothing but rounding of 48-bit velocities
        return "0"
    return f"{number(value * 1e6)} ppm" if value < 1e-3 else f"{number(value * 100)} %"


def show(name: str, value: float | None) -> str:
    """Text of a value of a quantity."""
    if value is None:
        return NONE
    return relative(value) if name in RELATIVE else number(value)


def title_of(group: str) -> str:
    """Title of a group of random moves; too short: the speed cannot be reached."""
    key, _, short = group.partition(" ")
    return f"{key}  the same, too short" if short else f"{key}  {TITLES[key]}"


def rows(report: dict[str, Any], wanted: tuple[str, ...]) -> list[tuple[str, str, list[str]]]:
    """Rows as group, side and cells; a cell can have several statistics."""
    made = []
    for group, data in report["random"].items():
        for side in SIDES:
            cells = []
            for name in COLUMNS:
                values = data[side].get(name)
                parts = [show(name, values[key]) for key in wanted] if values else [NONE]
                cells.append(" / ".join(parts) if set(parts) != {"0"} else "0")
            made.append((group, side, cells))
    return made


def random_table(report: dict[str, Any]) -> Table:
    """Worst values of all random moves, for the terminal."""
    made = table(f"Worst of {report['cases']:,} random moves of each method", "", *COLUMNS.values())
    for group, side, cells in rows(report, ("worst",)):
        if side == "source":
            made.add_row(f"[bold]{title_of(group)}[/bold]")
        made.add_row(f"   {SIDES[side]}", *cells, style="green" if side == "passo" else "")
    return made


def named_rows(report: dict[str, Any]) -> list[list[str]]:
    """The named moves: times, and largest distances from the curve."""
    made = []
    for case in report["named"]:
        published = case["published_seconds"]
        made.append([
            f"{case['method']}  {case['move']}",
            f"{case['wanted_seconds']:.6f}",
            f"{published:.3f}" if published else NONE,
            f"{case['source_seconds']:.6f}",
            f"{case['passo_seconds']:.6f}",
            show("distance", case["source"]["distance"]),
            show("distance", case["passo"]["distance"]),
        ])  # fmt: skip
    return made


NAMED_COLUMNS = ("", "wanted", "reported", "source", "Passo", "source off", "Passo off")


def named_table(report: dict[str, Any]) -> Table:
    """The named moves, for the terminal."""
    made = table(
        "Moves of the publications: total time (s), and largest distance from the curve (steps)",
        *NAMED_COLUMNS,
    )
    for row in named_rows(report):
        made.add_row(*row)
    return made


def markdown(head: tuple[str, ...], body: list[list[str]]) -> str:
    """A Markdown table; all columns except the first are numbers."""
    lines = [head, ("---", *["---:"] * (len(head) - 1)), *body]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


PLAN_COLUMNS = ("", "moves", "wrong steps", "missing", "time, ticks", "steps off the plan")


def plan_rows(report: dict[str, Any]) -> list[list[str]]:
    """Passo against its own plan, for all forms."""
    made = []
    for group, data in (report["random"] | report["forms"]).items():
        passo = data["passo"]
        worst = [number(passo[name]["worst"]) for name in ("steps", "missing")]
        pairs = [
            f"{number(passo[name]['median'])} / {number(passo[name]['worst'])}" if name in passo else NONE
            for name in ("ticks", "planned")
        ]
        title = title_of(group) if group in report["random"] else group
        made.append([title, f"{data['moves']:,}", *worst, *pairs])
    return made


def plan_table(report: dict[str, Any]) -> Table:
    """The same for the terminal."""
    made = table("Passo against its own plan: median / worst", *PLAN_COLUMNS)
    for row in plan_rows(report):
        made.add_row(*row)
    return made


PEER_COLUMNS = ("", "moves", "ticks longer", "median", "99.9 %", "worst")


def peer_rows(report: dict[str, Any]) -> list[list[str]]:
    """Passo's total times against those of ruckig."""
    return [
        [
            name,
            f"{data['moves']:,}",
            f"{data['fewest_ticks']:.2f} .. {data['most_ticks']:.2f}",
            *(relative(data[key]) for key in ("median", "999 of 1000", "worst")),
        ]
        for name, data in report["peers"].items()
    ]


def peer_table(report: dict[str, Any]) -> Table:
    """The same for the terminal."""
    made = table("Total time against ruckig: in ticks; relative, of moves of 50 ms and more", *PEER_COLUMNS)
    for row in peer_rows(report):
        made.add_row(*row)
    return made


RESONANCE_COLUMNS = ("ramps", *(f"{float(part - 1):+.0%}" if part != 1 else "exact" for part in DETUNED))


def resonance_rows(report: dict[str, Any]) -> list[list[str]]:
    """Steps of vibration that are left, by the error of the frequency."""
    return [
        [f"{row['ramp']}, damping {row['damping']:g}", *(f"{left:.3f}" for left in row["left"])]
        for row in report["resonances"]
    ]


def resonance_table(report: dict[str, Any]) -> Table:
    """The same for the terminal."""
    title = f"Vibration left at {FREQUENCY} Hz, in steps, when the frequency is off by"
    made = table(title, *RESONANCE_COLUMNS)
    for row in resonance_rows(report):
        made.add_row(*row)
    return made


def page(report: dict[str, Any]) -> str:
    """docs/reference/accuracy.md."""
    body = []
    for group, side, cells in rows(report, ("median", "worst")):
        if side == "source":
            moves = f"{report['random'][group]['moves']:,} moves"
            body.append([f"**{title_of(group)}** ({moves})", *[""] * len(COLUMNS)])
        body.append([SIDES[side], *cells])
    tick = report["tick_clocks"] / report["clock_hz"] * 1e6
    every = (report["random"] | report["forms"]).values()
    ticks = max(data["passo"]["ticks"]["worst"] for data in every if "ticks" in data["passo"])
    return TEMPLATE.read_text(encoding="utf-8").format(
        clock=report["clock_hz"] // 1_000_000,
        tick=f"{tick:g}",
        cases=f"{report['cases']:,}",
        seed=report["seed"],
        random=markdown(("median / worst", *COLUMNS.values()), body),
        planned=markdown(PLAN_COLUMNS, plan_rows(report)),
        peers=markdown(PEER_COLUMNS, peer_rows(report)),
        resonances=markdown(RESONANCE_COLUMNS, resonance_rows(report)),
        resonance_hz=FREQUENCY,
        named=markdown(NAMED_COLUMNS, named_rows(report)),
        gap_5=relative(sigmoid.formula(5, 0, 1)),
        gap_3=relative(sigmoid.formula(3, 0, 1)),
        worst_ticks=number(ticks),
        worst_microseconds=number(ticks * tick),
        moves=report["checked"]["moves"],
        steps=f"{report['checked']['steps']:,}",
    )
