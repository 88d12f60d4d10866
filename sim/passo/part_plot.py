# SPDX-License-Identifier: MIT
"""Plots of a part: the tool path, the speed along it, and the margin to the limits of the axes."""

from pathlib import Path
from typing import Self

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

from passo.course import Course
from passo.machine_file import MachineFile
from passo.part import Part, Played
from passo.plot import COLORS, STYLE, save

SAMPLES = 20_000
WINDOW = 0.004  # seconds over which speeds are measured
RASTER = 0.0005  # seconds between two samples, at least


class Motion:
    """Places of all axes over time in mm, and their speeds; the tool path, and the speed along it."""

    def __init__(self, machine: MachineFile, times: np.ndarray, places: np.ndarray):
        """`places`: axis x time."""
        step = times[1]
        width = max(1, round(WINDOW / step / 2))
        self.machine, self.times, self.places = machine, times, places
        self.speeds = [_change(place, width) / step for place in places]
        self.speed = np.sqrt(np.sum(np.square(self.speeds), axis=0))
        self.path, self.path_speed = places, self.speed
        self.shares = [  # of the limits of axes and motors
            np.abs(direction @ self.speeds) / float(limits.speed)
            for direction, limits in machine.settings.limits()
        ]

    @classmethod
    def of_played(cls, played: Played) -> Self:
        """From the steps."""
        clock_hz, settings, motors = played.machine.clock_hz, played.machine.settings, []
        times = _raster(played.motions[-1][1] / clock_hz if played.motions else 0)
        for clocks, counts, scale in zip(played.clocks, played.positions, settings.scales, strict=True):
            at = np.concatenate([[-1e-9], clocks / clock_hz])
            motors.append(np.interp(times, at, np.concatenate([[0], counts])) / scale)
        places = settings.motors.axes_of(np.stack(motors, axis=1)) + played.part.begin.place
        return cls(played.machine, times, places.T)

    @classmethod
    def of_course(cls, course: Course) -> Self:
        """As planned; the tool path has the ends of all lines."""
        times = _raster(course.seconds)
        made = cls(course.machine, times, course.places(times).T)
        every = np.sort(np.concatenate([times, course.line_time]))
        every = every[:: len(every) // (2 * SAMPLES) + 1]
        made.path, made.path_speed = course.places(every).T, course.speed(every)
        return made


def _raster(seconds: float) -> np.ndarray:
    seconds = max(seconds, 16 * RASTER)
    return np.linspace(0, seconds, max(16, min(SAMPLES, round(seconds / RASTER))))


def _change(values: np.ndarray, width: int) -> np.ndarray:
    """Change per sample, over 2 `width` samples."""
    padded = np.pad(values, width, mode="edge")
    return (padded[2 * width :] - padded[: -2 * width]) / (2 * width)


def plot_part(played: Played, path: Path) -> None:
    """Write a page of plots of what left the pins."""
    _plot(Motion.of_played(played), _title(played.part, played.seconds), path)


def plot_course(part: Part, course: Course, path: Path) -> None:
    """The same of a plan."""
    _plot(Motion.of_course(course), _title(part, course.seconds), path)


def _title(part: Part, seconds: float) -> str:
    return f"{part.path.name}: {len(part.lines):,} lines, {part.chords:,} chords in {seconds:.6g} s"


def _plot(motion: Motion, title: str, path: Path) -> None:
    with plt.rc_context(STYLE):
        figure, panels = plt.subplot_mosaic(
            [["path"], ["speed"], ["axes"]], figsize=(11, 13), height_ratios=[2.2, 1, 1]
        )
        figure.suptitle(title, x=0.01, ha="left", fontsize=13, fontweight="bold")
        _draw_path(figure, panels["path"], motion)
        panels["speed"].plot(motion.times, motion.speed, color=COLORS[0], linewidth=0.8)
        panels["speed"].set(title="Speed along the path", xlabel="s", ylabel="mm/s", ylim=(0, None))
        names = motion.machine.limited
        for number, share in enumerate(motion.shares):
            panels["axes"].plot(
                motion.times,
                share,
                label=names[number],
                color=COLORS[number % len(COLORS)],
                linewidth=0.8,
            )
        panels["axes"].set(
            title=f"Speeds of {', '.join(names)}, relative to their limits", xlabel="s", ylim=(0, 1.25)
        )
        panels["axes"].axhline(1, color="#8c959f", linestyle="--", linewidth=0.8)
        panels["axes"].legend(loc="upper right", ncols=6)  # above the limit
        save(figure, path, 110)


def _draw_path(figure: plt.Figure, ax: plt.Axes, motion: Motion) -> None:
    """The first two axes, or those of a lathe, colored by the speed."""
    plane = len(motion.path) > 1
    across, up = (1, 0) if motion.machine.letters == "XZ" else (0, 1)
    x, y = (motion.path[across], motion.path[up]) if plane else (motion.times, motion.places[0])
    points = np.stack([x, y], axis=1)
    lines = LineCollection(
        np.stack([points[:-1], points[1:]], axis=1),
        array=(motion.path_speed if plane else motion.speed)[:-1],
        cmap="viridis",
        linewidth=1.4,
        capstyle="round",
        snap=False,  # whole pixels for some parts of a line, not for others, make a jog
    )
    ax.add_collection(lines)
    ax.autoscale()
    if plane:
        ax.set_aspect("equal", adjustable="datalim")
    letters = [f"{motion.machine.letters[axis]}, mm" for axis in (across, up)] if plane else ["s", "X, mm"]
    ax.set(title="Tool path", xlabel=letters[0], ylabel=letters[1])
    figure.colorbar(lines, ax=ax, label="mm/s", shrink=0.8)
