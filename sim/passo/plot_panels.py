# SPDX-License-Identifier: MIT
"""The plots of a page: speed, acceleration, position, error, pulses."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from passo.curve import speeds_and_positions, step_errors
from passo.moves import MoveStraight
from passo.run import Run

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7b5ea7", "#555555")
INK = "#24292f"
WIDE = {"linewidth": 5, "alpha": 0.25, "solid_capstyle": "butt"}
POINTS_MAX = 6000  # of a scatter
WINDOWS, MANY = 600, 4  # of a plot of speeds, and steps in one of them that are shown as their mean
PULSES_SHOWN = 8  # pulses per axis in the plots of the first and the last milliseconds


@dataclass(frozen=True)
class Units:
    """What the plots are in: steps, or mm where all moves have the same scale."""

    name: str
    speed: str
    speed_scale: float
    per_step: np.ndarray  # of each axis


def units_of(run: Run) -> Units:
    """The units of a motion."""
    moves = run.file.moves
    scales = {move.steps_per_mm for move in moves if isinstance(move, MoveStraight)}
    if len(scales) == 1 and all(isinstance(move, MoveStraight) for move in moves):
        (scale,) = scales
        if all(scale):
            return Units("mm", "mm/s", 1, np.array([float(1 / value) for value in scale]))
    return Units("steps", "kHz", 1e-3, np.ones(run.file.axes))


def moves_of_steps(run: Run, axis: int) -> np.ndarray:
    """The move to which each step of an axis belongs."""
    made = len(run.steps(axis)[0])
    counts = [abs(move.steps[axis]) for move in run.file.moves]
    return np.repeat(np.arange(len(counts)), counts)[:made]


def measured_speeds(run: Run, axis: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clocks and speeds (steps per clock) between steps, NaN where the axis rested or turned.

    And the clocks of the steps without a neighbor to measure from.
    """
    clocks, directions = run.steps(axis)
    moves = moves_of_steps(run, axis)
    if len(moves) < len(clocks):  # more steps than planned: a fault
        moves = np.zeros(len(clocks), int)
    follows = (directions[1:] == directions[:-1]) & (np.diff(moves) <= 1)
    middle = (clocks[1:] + clocks[:-1]) / 2
    speeds = np.where(follows, directions[1:] / np.maximum(np.diff(clocks), 1), np.nan)
    padded = np.concatenate([[False], follows, [False]])
    return middle, speeds, clocks[~(padded[1:] | padded[:-1])[: len(clocks)]]


def evened(clocks: np.ndarray, speeds: np.ndarray, window: float) -> tuple[np.ndarray, np.ndarray]:
    """Clocks and speeds, with the mean speed of each window of clocks in place of its steps if it has many.

    A window ends at a rest, too, and one with few of them keeps them all.
    """
    if len(clocks) == 0:
        return clocks, speeds
    windows = np.floor(clocks / window) + np.cumsum(np.isnan(speeds) | np.isnan(np.roll(speeds, 1)))
    starts = np.flatnonzero(np.diff(windows, prepend=-1))
    counts = np.diff(starts, append=len(clocks))
    means = counts / np.add.reduceat(1 / speeds, starts)
    many = (counts >= MANY) & np.isfinite(means)
    kept = np.repeat(~many, counts)
    made = np.concatenate([clocks[kept], (np.add.reduceat(clocks, starts) / counts)[many]])
    order = np.argsort(made)
    return made[order], np.concatenate([speeds[kept], means[many]])[order]


def plot_speed(ax: Axes, run: Run, late: float = 0) -> None:
    """Ideal speed, and the inverse of the time between steps; the motion starts at `late` seconds."""
    hz, units = run.file.clock_hz, units_of(run)
    times, speeds, _ = speeds_and_positions(run)
    for axis in range(run.file.axes):
        color, scale = COLORS[axis], hz * units.speed_scale * units.per_step[axis]
        ax.plot(times / hz + late, speeds[axis] * scale, color=color, **WIDE)
        clocks, measured, single = measured_speeds(run, axis)
        clocks, measured = evened(clocks, measured, times[-1] / WINDOWS)
        ax.plot(clocks / hz + late, measured * scale, color=color, linewidth=0.9, label=f"axis {axis}")
        heights = np.interp(single, times, speeds[axis]) * scale
        ax.vlines(single / hz + late, 0, heights, color=color, linewidth=0.9)
    ax.set_xlabel("s")
    ax.set_ylabel(units.speed)
    ax.margins(x=0.01)
    if speeds.min() >= 0:
        ax.set_ylim(bottom=0)


def plot_acceleration(ax: Axes, run: Run) -> None:
    """Slope of the ideal speed."""
    hz, units = run.file.clock_hz, units_of(run)
    times, speeds, _ = speeds_and_positions(run)
    apart = np.diff(times) > 0
    middle = ((times[1:] + times[:-1]) / 2)[apart]
    for axis in range(run.file.axes):
        slopes = (np.diff(speeds[axis])[apart] / np.diff(times)[apart]) * hz**2 * units.per_step[axis]
        ax.plot(middle / hz, slopes, color=COLORS[axis], linewidth=0.9)
    ax.set_title("Acceleration of the ideal curve")
    ax.set_xlabel("s")
    ax.set_ylabel(f"{units.name}/s²")
    ax.margins(x=0.01)


def plot_position(ax: Axes, run: Run) -> None:
    """Ideal position, and the position counted at the pins."""
    hz, units = run.file.clock_hz, units_of(run)
    times, _, positions = speeds_and_positions(run)
    for axis in range(run.file.axes):
        color, scale = COLORS[axis], units.per_step[axis]
        ax.plot(times / hz, positions[axis] * scale, color=color, **WIDE)
        clocks, directions = run.steps(axis)
        clocks = np.concatenate([[0], clocks, [max(run.total_clocks, *clocks[-1:], 0)]])
        counted = np.concatenate([[0], np.cumsum(directions, dtype=np.int64)])
        counted = np.concatenate([counted, counted[-1:]])
        ax.step(clocks / hz, counted * scale, where="post", color=color, linewidth=0.9)
    ax.set_title("Position")
    ax.set_xlabel("s")
    ax.set_ylabel(units.name)
    ax.margins(x=0.01)


def plot_error(ax: Axes, run: Run) -> None:
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


def windows(run: Run) -> tuple[int, int]:
    """Clocks to show at the start and at the end: a millisecond, or enough for some steps."""
    clocks = np.sort(np.concatenate([run.steps(axis)[0] for axis in range(run.file.axes)]))
    some = min(len(clocks), PULSES_SHOWN * run.file.axes)
    shown = (clocks[some - 1], run.total_clocks - clocks[-some]) if some else (0, 0)
    millisecond = run.file.clock_hz // 1000
    first, last = (min(run.total_clocks, max(millisecond, int(1.05 * length))) for length in shown)
    return first, last


def shown_pulse(run: Run) -> tuple[int, int] | None:
    """Axis and clock of the step that follows a change of its DIR most closely, else of the first step."""
    best = None
    for axis in range(run.file.axes):
        clocks, _ = run.steps(axis)
        if not len(clocks):
            continue
        levels = np.concatenate([[0], run.pins["dir"] >> axis & 1]).astype(np.int8)
        changes = run.pins["clock"][np.flatnonzero(np.diff(levels))].astype(np.int64) - run.start
        next_step = np.searchsorted(clocks, changes)
        for change, step in zip(changes, next_step, strict=True):
            if step < len(clocks) and (best is None or clocks[step] - change < best[0]):
                best = (clocks[step] - change, axis, int(clocks[step]))
        if best is None:
            best = (np.inf, axis, int(clocks[0]))
    return best[1:] if best else None


def plot_pulse(ax: Axes, run: Run) -> None:
    """One pulse with its four timings."""
    pulse = shown_pulse(run)
    pins, micro = run.file.pins, 1e6 / run.file.clock_hz
    ax.set_title("One pulse and its four timings")
    ax.set_xlabel("µs from its rising edge")
    if pulse is None:
        return
    axis, rise = pulse
    fall, low_end = rise + pins.step_high, rise + pins.step_high + pins.step_low
    spans = {
        "dir_setup": (rise - pins.dir_setup, rise),
        "step_high": (rise, fall),
        "step_low": (fall, low_end),
        "dir_hold": (low_end, low_end + pins.dir_hold),
    }
    margin = (low_end + pins.dir_hold - rise + pins.dir_setup) // 6 + 1
    begin, end = rise - pins.dir_setup - margin, low_end + pins.dir_hold + margin
    for base, signal in ((0, "step"), (-2.4, "dir")):
        clocks, levels = trace(run, signal, axis, begin, end)
        places = (clocks - rise) * micro
        ax.step(places, base + levels, where="post", color=COLORS[axis], linewidth=1.2)
        ax.fill_between(places, base, base + levels, step="post", color=COLORS[axis], alpha=0.15, linewidth=0)
    height, arrow = -0.35, {"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0}
    for number, (name, (left, right)) in enumerate(spans.items()):
        places = [(clock - rise) * micro for clock in (left, right)]
        ax.annotate("", (places[1], height), (places[0], height), arrowprops=arrow)
        ax.text(
            sum(places) / 2, height - 0.12 - 0.5 * (number % 2), f"{name}\n{(right - left) * micro:.4g} µs",
            ha="center", va="top", fontsize=7,
        )  # fmt: skip
    ax.set_ylim(-2.7, 1.3)
    ax.set_yticks([0.5, -1.9], [f"STEP {axis}", f"DIR {axis}"])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)
    ax.set_xlim((begin - rise) * micro, (end - rise) * micro)


def plot_lines(ax: Axes, run: Run, begin: int, end: int, title: str, directions: bool = True) -> None:
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
    ax.set_ylim(0.7 - 1.5 * len(names), 1.4)
    ax.set_yticks([0.5 - 1.5 * i for i in range(len(names))], names)
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)
    ax.set_title(title)
    ax.set_xlabel("ms")
    ax.set_xlim(begin * scale, max(end, begin + 1) * scale)


def trace(run: Run, signal: str, axis: int, begin: int, end: int) -> tuple[np.ndarray, np.ndarray]:
    """Clocks and levels of a pin from `begin` to `end`, counted from the start of the motion."""
    clocks = run.pins["clock"].astype(np.int64) - run.start
    levels = run.pins[signal] >> axis & 1
    first, last = np.searchsorted(clocks, [begin, end], side="right")
    before = levels[first - 1] if first else 0
    inside = levels[first:last]
    after = inside[-1] if len(inside) else before
    return np.concatenate([[begin], clocks[first:last], [end]]), np.concatenate([[before], inside, [after]])
