# SPDX-License-Identifier: MIT
"""Plots of a part: the tool path, the speed along it, and the margin to the limits of the axes."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from passo.part import Played
from passo.plot import COLORS, STYLE, save

SAMPLES = 20_000
WINDOW = 0.004  # seconds over which speeds are measured
RASTER = 0.0005  # seconds between two samples, at least


class Motion:
    """Positions of all axes over time in mm, from the steps, and their speeds."""

    def __init__(self, played: Played):
        clock_hz = played.machine.clock_hz
        seconds = played.motions[-1][1] / clock_hz if played.motions else RASTER
        self.times = np.linspace(0, seconds, max(16, min(SAMPLES, round(seconds / RASTER))))
        step = self.times[1]
        width = max(1, round(WINDOW / step / 2))
        settings, motors = played.machine.settings, []
        for clocks, counts, scale in zip(played.clocks, played.positions, settings.scales, strict=True):
            at = np.concatenate([[-1e-9], clocks / clock_hz])
            motors.append(np.interp(self.times, at, np.concatenate([[0], counts])) / scale)
        self.positions = settings.motors.axes_of(np.stack(motors, axis=1)).T
        self.speeds = [_change(position, width) / step for position in self.positions]
        self.speed = np.sqrt(np.sum(np.square(self.speeds), axis=0))
        self.shares = [  # of the limits of axes and motors
            np.abs(direction @ self.speeds) / float(limits.speed) for direction, limits in settings.limits()
        ]


def _change(values: np.ndarray, width: int) -> np.ndarray:
    """Change per sample, over 2 `width` samples."""
    padded = np.pad(values, width, mode="edge")
    return (padded[2 * width :] - padded[: -2 * width]) / (2 * width)


def plot_part(played: Played, path: Path) -> None:
    """Write a page of plots."""
    motion = Motion(played)
    with plt.rc_context(STYLE):
        figure, panels = plt.subplot_mosaic(
            [["path"], ["speed"], ["axes"]], figsize=(11, 13), height_ratios=[2.2, 1, 1]
        )
        figure.suptitle(
            f"{played.part.path.name}: {len(played.part.lines):,} lines, {played.part.chords:,} chords "
            f"in {played.seconds:.6g} s",
            x=0.01, ha="left", fontsize=13, fontweight="bold",
        )  # fmt: skip
        _draw_path(figure, panels["path"], motion)
        panels["speed"].plot(motion.times, motion.speed, color=COLORS[0], linewidth=0.8)
        panels["speed"].set(title="Speed along the path", xlabel="s", ylabel="mm/s", ylim=(0, None))
        names = played.machine.limited
        for number, share in enumerate(motion.shares):
            panels["axes"].plot(
                motion.times,
                share,
                label=names[number],
                color=COLORS[number % len(COLORS)],
                linewidth=0.8,
            )
        panels["axes"].set(title=f"Speeds of {', '.join(names)}, relative to their limits", xlabel="s")
        panels["axes"].axhline(1, color="#8c959f", linestyle="--", linewidth=0.8)
        panels["axes"].legend(loc="upper right", ncols=6)
        save(figure, path, 110)


def _draw_path(figure: plt.Figure, ax: plt.Axes, motion: Motion) -> None:
    """The first two axes, colored by the speed."""
    x, y = motion.positions[0], motion.positions[1] if len(motion.positions) > 1 else motion.times
    points = np.stack([x, y], axis=1)
    lines = LineCollection(
        np.stack([points[:-1], points[1:]], axis=1), array=motion.speed[:-1], cmap="viridis", linewidth=1.4
    )
    ax.add_collection(lines)
    ax.autoscale()
    if len(motion.positions) > 1:
        ax.set_aspect("equal", adjustable="datalim")
    ax.set(title="Tool path", xlabel="X, mm", ylabel="Y, mm" if len(motion.positions) > 1 else "s")
    figure.colorbar(lines, ax=ax, label="mm/s", shrink=0.8)
