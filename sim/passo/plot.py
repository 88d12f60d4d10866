# SPDX-License-Identifier: MIT
"""Plots of a motion."""

from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from passo.curve import speeds_and_positions, step_errors
from passo.run import Run

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7b5ea7", "#555555")
INK = "#24292f"
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": "#8c959f",
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#d8dee4",
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": "#57606a",
    "ytick.color": "#57606a",
    "legend.frameon": False,
    "figure.facecolor": "white",
    "figure.constrained_layout.use": True,
}
WIDE = {"linewidth": 5, "alpha": 0.25, "solid_capstyle": "butt"}
POINTS_MAX = 6000  # of a scatter
PULSES_SHOWN = 8  # pulses per axis in the plots of the first and the last milliseconds


def plot_motion(run: Run, path: Path) -> None:
    """Write a page of plots of one motion: speed, position, error, pulses."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplot_mosaic(
            [["speed", "speed"], ["position", "error"], ["first", "last"]],
            figsize=(11, 9.5),
            height_ratios=[1.15, 1, 0.5 + 0.22 * run.file.axes],
        )
        seconds = run.total_clocks / run.file.clock_hz
        pulses = sum(len(run.steps(axis)[0]) for axis in range(run.file.axes))
        figure.suptitle(
            f"{run.file.name}: {pulses:,} steps in {seconds:.6g} s at {run.file.clock_hz / 1e6:g} MHz",
            x=0.01, ha="left", fontsize=13, fontweight="bold",
        )  # fmt: skip
        _speed(axes["speed"], run)
        axes["speed"].set_title("Speed: ideal curve (wide) and the steps at the pins (thin)")
        _position(axes["position"], run)
        _error(axes["error"], run)
        first, last = _windows(run)
        _lines(axes["first"], run, 0, first, "The first milliseconds")
        _lines(axes["last"], run, run.total_clocks - last, run.total_clocks, "The last milliseconds")
        figure.savefig(path, dpi=110)
        plt.close(figure)


def plot_overview(runs: dict[str, Run], path: Path) -> None:
    """Write the overview picture of the demonstration."""
    with plt.rc_context(STYLE):
        names = [name for name in ("three_axes", "cosine", "sigmoid", "there_and_back") if name in runs]
        titles = {
            "three_axes": "Three axes, exactly 5 : 3 : 2",
            "cosine": "6400 steps in exactly 0.4 s",
            "sigmoid": "Sigmoid, 400 Hz to 5 kHz",
            "there_and_back": "Chained moves with reversal",
        }
        figure = plt.figure(figsize=(12, 5.6))
        head, top, bottom = figure.subfigures(3, 1, height_ratios=[0.09, 1.15, 1])
        caption = (
            "From the pins of the simulated core: wide lines are ideal curves, thin ones the measured steps."
        )
        head.text(0.01, 0.1, caption, color="#57606a")
        for ax, name in zip(np.atleast_1d(top.subplots(1, len(names))), names, strict=True):
            _speed(ax, runs[name], legend=False)
            ax.set_title(titles[name])
            if name != names[0]:
                ax.set_ylabel("")
        left, right = bottom.subplots(1, 2)
        cruise = runs["three_axes"]
        middle = cruise.total_clocks // 2
        half = round(0.0002 * cruise.file.clock_hz)
        _lines(left, cruise, middle - half, middle + half, "STEP at 50, 30 and 20 kHz", directions=False)
        back = runs["there_and_back"]
        turn = back.plans[0].clocks
        half = round(0.010 * back.file.clock_hz)
        _lines(right, back, turn - half, turn + half, "STEP and DIR at the reversal")
        figure.savefig(path, dpi=100)
        plt.close(figure)


def _speed(ax: Axes, run: Run, legend: bool = True) -> None:
    """Ideal speed, and the inverse of the time between steps."""
    hz = run.file.clock_hz
    times, speeds, _ = speeds_and_positions(run)
    for axis in range(run.file.axes):
        color = COLORS[axis]
        ax.plot(
            times / hz, speeds[axis] * hz / 1e3, color=color, linewidth=5, alpha=0.25, solid_capstyle="butt"
        )
        clocks, directions = run.steps(axis)
        same = directions[1:] == directions[:-1]
        middle = (clocks[1:] + clocks[:-1])[same] / 2
        speed = (directions[1:] / np.maximum(np.diff(clocks), 1))[same]
        ax.plot(middle / hz, speed * hz / 1e3, color=color, linewidth=0.9, label=f"axis {axis}")
    ax.set_xlabel("s")
    ax.set_ylabel("kHz")
    ax.margins(x=0.01)
    if speeds.min() >= 0:
        ax.set_ylim(bottom=0)
    if legend and run.file.axes > 1:
        ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=run.file.axes, borderaxespad=0)


def _position(ax: Axes, run: Run) -> None:
    """Ideal position, and the position counted at the pins."""
    hz = run.file.clock_hz
    times, _, positions = speeds_and_positions(run)
    for axis in range(run.file.axes):
        color = COLORS[axis]
        ax.plot(times / hz, positions[axis], color=color, **WIDE)
        clocks, directions = run.steps(axis)
        ax.step(clocks / hz, np.cumsum(directions, dtype=np.int64), where="post", color=color, linewidth=0.9)
    ax.set_title("Position")
    ax.set_xlabel("s")
    ax.set_ylabel("steps")
    ax.margins(x=0.01)


def _error(ax: Axes, run: Run) -> None:
    """Distance of each step from the ideal curve."""
    largest = 0.0
    for axis in range(run.file.axes):
        clocks, errors = step_errors(run, axis)
        largest = max(largest, float(np.abs(errors).max(initial=0)))
        every = max(1, len(clocks) // POINTS_MAX)
        ax.plot(
            clocks[::every] / run.file.clock_hz, errors[::every],
            linestyle="none", marker="o", markersize=1.6, markeredgewidth=0, color=COLORS[axis],
        )  # fmt: skip
    ax.set_title(f"Distance from the ideal curve (at most {largest:.2g} steps)")
    ax.set_xlabel("s")
    ax.set_ylabel("steps")
    ax.margins(x=0.01)


def _windows(run: Run) -> tuple[int, int]:
    """Clocks to show at the start and at the end: a millisecond, or enough for some steps."""
    clocks = np.sort(np.concatenate([run.steps(axis)[0] for axis in range(run.file.axes)]))
    some = min(len(clocks), PULSES_SHOWN * run.file.axes)
    shown = (clocks[some - 1], run.total_clocks - clocks[-some]) if some else (0, 0)
    millisecond = run.file.clock_hz // 1000
    first, last = (min(run.total_clocks, max(millisecond, int(1.05 * length))) for length in shown)
    return first, last


def _lines(ax: Axes, run: Run, begin: int, end: int, title: str, directions: bool = True) -> None:
    """The STEP and DIR signals between two clocks, counted from the start of the motion."""
    scale = 1e3 / run.file.clock_hz
    names: list[str] = []
    for axis in range(run.file.axes):
        for signal in ("step", "dir") if directions else ("step",):
            clocks, levels = trace(run, signal, axis, begin, end)
            base = -1.5 * len(names)
            style = {"color": COLORS[axis], "linewidth": 1.0, "alpha": 1.0 if signal == "step" else 0.6}
            ax.step(clocks * scale, base + levels, where="post", **style)
            ax.fill_between(
                clocks * scale, base, base + levels, step="post", color=COLORS[axis], alpha=0.15, linewidth=0
            )
            names.append(f"{signal.upper()} {axis}")
    ax.set_yticks([0.5 - 1.5 * i for i in range(len(names))], names)
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)
    ax.set_title(title)
    ax.set_xlabel("ms")
    ax.set_xlim(begin * scale, end * scale)


def trace(run: Run, signal: str, axis: int, begin: int, end: int) -> tuple[np.ndarray, np.ndarray]:
    """Clocks and levels of a pin from `begin` to `end`, counted from the start of the motion."""
    clocks = run.pins["clock"].astype(np.int64) - run.start
    levels = run.pins[signal] >> axis & 1
    first, last = np.searchsorted(clocks, [begin, end], side="right")
    before = levels[first - 1] if first else 0
    inside = levels[first:last]
    after = inside[-1] if len(inside) else before
    return np.concatenate([[begin], clocks[first:last], [end]]), np.concatenate([[before], inside, [after]])
