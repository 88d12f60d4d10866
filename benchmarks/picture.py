# SPDX-License-Identifier: MIT
"""Plot of the distance from the ideal curve over time, for a move of each method."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from passo.output import complete
from passo.plot import COLORS, STYLE

from benchmarks import passo_side, sources
from benchmarks.cases import Named, method_of, sigmoid_move
from benchmarks.sources import Cosine, MultiAxis, Trapezoid
from benchmarks.tables import number

SHOWN = (
    Named("one turn at 150 rpm", Trapezoid(360, 150, 10)),
    Named("400 Hz to 5 kHz in 1 s", sigmoid_move(2600, 400, 5000, 400, 1000, 1000, 5)),
    Named("50 kHz in 0.1 s, main axis", MultiAxis((20_000, 12_000, 8_000), 1, 50, 100)),
    Named("6400 pulses in 0.4 s, half of it cruise", Cosine(6400, 400, 100)),
)
SOURCE, PASSO = COLORS[1], COLORS[0]
FLOOR, CEILING = 1e-5, 1e3
TICKS = (0.0001, 0.001, 0.01, 0.1, 1, 10, 100)
POINTS = 240  # per envelope


def plot_accuracy(path: Path) -> None:
    """Write the plot; the logarithmic scale shows both sides."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(11, 7), sharey=True)
        title = "How far each pulse is from where it was wanted"
        figure.suptitle(title, x=0.01, ha="left", fontsize=13, fontweight="bold")
        for ax, case in zip(axes.flat, SHOWN, strict=True):
            _distances(ax, case)
        for ax in axes[:, 0]:
            ax.set_ylabel("steps")
        with complete(path) as part:
            figure.savefig(part, dpi=92, pil_kwargs={"optimize": True})
        plt.close(figure)


def _distances(ax: Axes, case: Named) -> None:
    """Plot the distances of a published method and of Passo."""
    wish = passo_side.wanted_curve(case.move)
    pulses, made = sources.simulate(case.move), passo_side.make(case.move)
    for name, times, color in (
        ("as published", pulses.times, SOURCE),
        ("Passo", made.pulses.times, PASSO),
    ):
        distances = np.abs(wish.distances(times))
        middles, largest = envelope(times, distances)
        ax.fill_between(middles, FLOOR, largest, color="white", linewidth=0)
        ax.fill_between(middles, FLOOR, largest, color=color, alpha=0.15, linewidth=0)
        ax.plot(middles, largest, color=color, linewidth=1.4)
        at = int(np.argmax(largest))
        share = middles[at] / wish.seconds
        side = "left" if share < 0.3 else "right" if share > 0.7 else "center"
        ax.annotate(
            f"{name}: at most {number(float(distances.max()))}",
            (middles[at], largest[at]), (-6 if side == "right" else 0, 5),
            textcoords="offset points", ha=side, color=color, fontweight="bold",
        )  # fmt: skip
    ax.axvline(wish.seconds, color="#8c959f", linewidth=0.9, linestyle=(0, (4, 3)), zorder=3)
    ax.annotate(
        "wanted end", (wish.seconds, CEILING), (-4, -3), textcoords="offset points",
        ha="right", va="top", fontsize=7.5, color="#57606a",
    )  # fmt: skip
    ax.set_yscale("log")
    ax.set_ylim(FLOOR, CEILING)
    ax.yaxis.set_major_locator(FixedLocator(TICKS))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.set_axisbelow(False)
    ax.margins(x=0.02)
    ax.set_xlim(left=0)
    ax.set_xlabel("s")
    method = method_of(case.move)
    ax.set_title(f"{method.key}  {method.title}", pad=16)
    ax.text(0, 1.025, case.text, transform=ax.transAxes, color="#57606a", fontsize=8.5)


def envelope(times: np.ndarray, distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The largest distance in each of POINTS equal intervals with pulses."""
    edges = np.linspace(times[0], times[-1], POINTS + 1)
    parts = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, POINTS - 1)
    largest = np.zeros(POINTS)
    np.maximum.at(largest, parts, distances)
    some = largest > 0
    return ((edges[:-1] + edges[1:]) / 2)[some], np.maximum(largest[some], FLOOR)
