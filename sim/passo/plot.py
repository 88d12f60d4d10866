# SPDX-License-Identifier: MIT
"""Plots of a motion."""

from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from passo.output import complete
from passo.plot_panels import (
    COLORS,
    INK,
    plot_acceleration,
    plot_error,
    plot_lines,
    plot_position,
    plot_pulse,
    plot_speed,
    windows,
)
from passo.run import Run

__all__ = ["COLORS", "STYLE", "plot_file", "plot_motion", "plot_overview", "save"]

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


def save(figure: Figure, path: Path, dpi: int) -> None:
    """Write a picture as PNG and close it; savefig would draw it twice, first for the layout only."""
    figure.set_dpi(dpi)
    if title := figure.get_suptitle():  # the name of a file may be in another code than UTF-8
        figure.suptitle(title.encode(errors="replace").decode())
    with complete(path) as part:
        figure.canvas.print_png(part)
    plt.close(figure)


def plot_file(runs: list[Run], folder: Path) -> None:
    """Write motion.png; of several channels: their speeds, and a page for each, motion_channel_N.png."""
    if not runs[-1].file.channel:
        plot_motion(runs[0], folder / "motion.png")
        return
    for run in runs:
        channel = run.file.channel
        plot_motion(run, folder / f"motion_channel_{channel}.png", f"{run.file.name}, channel {channel}")
    with plt.rc_context(STYLE):
        figure, panels = plt.subplots(
            len(runs), 1, sharex=True, squeeze=False, figsize=(11, 1.2 + 2.1 * len(runs))
        )
        figure.suptitle(
            f"{runs[0].file.name}: ideal speeds (wide) and the steps at the pins (thin)",
            x=0.01, ha="left", fontsize=13, fontweight="bold",
        )  # fmt: skip
        for ax, run in zip(panels.flat, runs, strict=True):
            plot_speed(ax, run, run.late / run.file.clock_hz)
            ax.set_title(f"Channel {run.file.channel}")
            if run is not runs[-1]:
                ax.set_xlabel("")
        save(figure, folder / "motion.png", 110)


def plot_motion(run: Run, path: Path, title: str = "") -> None:
    """Write a page of plots of one motion."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplot_mosaic(
            [["speed", "speed"], ["acceleration", "position"], ["error", "pulse"], ["first", "last"]],
            figsize=(11, 11.5 + 0.4 * run.file.axes),
            height_ratios=[1.15, 1, 1, 0.5 + 0.22 * run.file.axes],
        )
        seconds = run.total_clocks / run.file.clock_hz
        pulses = sum(len(run.steps(axis)[0]) for axis in range(run.file.axes))
        figure.suptitle(
            f"{title or run.file.name}: {pulses:,} steps in {seconds:.6g} s "
            f"at {run.file.clock_hz / 1e6:g} MHz",
            x=0.01, ha="left", fontsize=13, fontweight="bold",
        )  # fmt: skip
        plot_speed(axes["speed"], run)
        axes["speed"].set_title("Speed: ideal curve (wide) and the steps at the pins (thin)")
        plot_acceleration(axes["acceleration"], run)
        plot_position(axes["position"], run)
        plot_pulse(axes["pulse"], run)
        plot_error(axes["error"], run)
        first, last = windows(run)
        plot_lines(axes["first"], run, 0, first, "The first milliseconds")
        plot_lines(axes["last"], run, run.total_clocks - last, run.total_clocks, "The last milliseconds")
        if run.file.axes > 1:
            figure.legend(*axes["speed"].get_legend_handles_labels(), loc="outside lower center", ncols=8)
        save(figure, path, 110)


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
            plot_speed(ax, runs[name])
            ax.set_title(titles[name])
            if name != names[0]:
                ax.set_ylabel("")
        left, right = bottom.subplots(1, 2)
        cruise = runs["three_axes"]
        middle = cruise.total_clocks // 2
        half = round(0.0002 * cruise.file.clock_hz)
        plot_lines(left, cruise, middle - half, middle + half, "STEP at 50, 30 and 20 kHz", directions=False)
        back = runs["there_and_back"]
        turn = back.plans[0].clocks
        half = round(0.010 * back.file.clock_hz)
        plot_lines(right, back, turn - half, turn + half, "STEP and DIR at the reversal")
        save(figure, path, 100)
