# SPDX-License-Identifier: MIT
"""The page of plots of a move file with a machine."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from passo.engine import NUMBERS
from passo.plot import STYLE, save
from passo.registers import Cause
from passo.scene_panels import (
    SOUGHT,
    STOP,
    Lane,
    lanes_of,
    plot_scene_encoder,
    plot_scene_position,
    plot_scene_power,
    plot_scene_speed,
    plot_scene_trackers,
    plot_signals,
)
from passo.scene_report import said
from passo.scene_run import SceneRun

EVENT_COLOR = "#6639ba"
STOPPED = "■"
BADGE = {"boxstyle": "circle,pad=0.25", "facecolor": EVENT_COLOR, "edgecolor": "white", "linewidth": 1}
LABEL = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": STOP, "linewidth": 0.8}


def plot_scene(run: SceneRun, path: Path) -> None:
    """Write the page."""
    heights = {"speed": 1.5, "position": 1.3}
    if run.setup.encoders:
        heights["encoder"] = 1.0
    if run.setup.trackers:
        heights["tracker"] = 0.8
    if run.setup.has_outputs:
        heights["power"] = 0.8
    lanes = lanes_of(run)
    heights["lanes"] = 0.3 + 0.24 * len(lanes)
    zooms = _zooms(run)
    listed = _listing(run)
    if zooms:
        heights["zoom"] = 0.3 + 0.24 * (len(lanes) + 2 * run.file.axes)
    rows = [[name] * max(1, len(zooms)) for name in heights if name != "zoom"]
    rows += [[f"zoom {i}" for i in range(len(zooms))]] if zooms else []
    with plt.rc_context(STYLE):
        total = 1.55 * sum(heights.values()) + 0.8 + 0.19 * len(listed)
        figure = plt.figure(figsize=(11, total))
        head, body = figure.subfigures(2, 1, height_ratios=[0.5 + 0.19 * len(listed), total])
        _head(head, run, listed)
        axes = body.subplot_mosaic(rows, height_ratios=list(heights.values()))
        plot_scene_speed(axes["speed"], run)
        plot_scene_position(axes["position"], run)
        if run.setup.encoders:
            plot_scene_encoder(axes["encoder"], run)
        if run.setup.trackers:
            plot_scene_trackers(axes["tracker"], run)
        if run.setup.has_outputs:
            plot_scene_power(axes["power"], run)
        end = run.shown_clocks * 1.02
        plot_signals(axes["lanes"], run, lanes, -0.01 * run.shown_clocks, end, 1 / run.file.clock_hz)
        axes["lanes"].set_title("Inputs and drives")
        axes["lanes"].set_xlabel("s")
        shared = [axes[name] for name in heights if name != "zoom"]
        for ax in shared:
            ax.set_xlim(-0.01 * run.shown_clocks / run.file.clock_hz, end / run.file.clock_hz)
            _marks(ax, run)
            if ax is not shared[-1]:
                ax.tick_params(labelbottom=False)
        _badges(axes["speed"], run)
        if run.file.axes > 1:
            handles = axes["speed"].get_legend_handles_labels()
            head.legend(*handles, loc="upper right", ncols=8)
        for number, (title, begin, stop) in enumerate(zooms):
            _zoom(axes[f"zoom {number}"], run, lanes, title, begin, stop)
        save(figure, path, 110)


# ------------------------------------------------------------------------------------------------ words ----


def _head(figure: plt.Figure, run: SceneRun, listed: list[tuple[str, str]]) -> None:
    pulses = sum(len(run.steps(axis)[0]) for axis in range(run.file.axes))
    hz = run.file.clock_hz
    title = f"{run.file.name}: {pulses:,} steps in {run.total_clocks / hz:.6g} s at {hz / 1e6:g} MHz"
    inches = figure.bbox.height / figure.dpi
    figure.text(0.012, 1 - 0.28 / inches, title, fontsize=13, fontweight="bold")
    for line, (mark, text) in enumerate(listed):
        y = 1 - (0.55 + 0.19 * line) / inches
        color = STOP if mark == STOPPED else EVENT_COLOR
        figure.text(0.024, y, mark, color=color, fontweight="bold", ha="center")
        figure.text(0.036, y, text)


def _listing(run: SceneRun) -> list[tuple[str, str]]:
    """Events and stops in words, in the order of time."""
    hz = run.file.clock_hz
    found: list[tuple[int, str, str]] = []
    for happened in run.events:
        if happened.clock is not None:
            clock = happened.clock - run.start
            found.append((clock, happened.mark, f"{clock / hz:.6f} s  {said(happened)}"))
    for stop in run.stops:
        if not run.sought(stop):
            clock = stop.clock - run.start
            where = ", ".join(map(str, stop.positions))
            found.append((clock, STOPPED, f"{clock / hz:.6f} s  stop {stop.cause.name} at {where}"))
    return [(mark, text) for _, mark, text in sorted(found)]


# ------------------------------------------------------------------------------------------------ marks ----


def _marks(ax: Axes, run: SceneRun, scale: float = 0, origin: int = 0) -> None:
    """Vertical lines at events and stops; clocks since `origin` times `scale`, or seconds."""
    scale = scale or 1 / run.file.clock_hz
    for happened in run.events:
        if happened.clock is not None:
            at = (happened.clock - run.start - origin) * scale
            ax.axvline(at, color=EVENT_COLOR, linewidth=0.9, linestyle=(0, (3, 2)), zorder=2.2)
    for stop in run.stops:
        color, width = (SOUGHT, 0.7) if run.sought(stop) else (STOP, 1.2)
        ax.axvline((stop.clock - run.start - origin) * scale, color=color, linewidth=width, zorder=2.2)


def _badges(ax: Axes, run: SceneRun) -> None:
    """Numbers of the events at the top, causes of the stops."""
    top, hz = ("data", "axes fraction"), run.file.clock_hz
    for happened in run.events:
        if happened.clock is not None:
            ax.annotate(
                happened.mark, ((happened.clock - run.start) / hz, 0.93), xycoords=top, color="white",
                ha="center", va="center", fontsize=7.5, fontweight="bold", bbox=BADGE, zorder=6,
            )  # fmt: skip
    for stop in run.stops:
        if not run.sought(stop):
            ax.annotate(
                stop.cause.name, ((stop.clock - run.start) / hz, 0.8), xycoords=top, color=STOP,
                xytext=(-5, 0), textcoords="offset points", ha="right", va="center",
                fontsize=8, fontweight="bold", bbox=LABEL, zorder=6,
            )  # fmt: skip


def _zooms(run: SceneRun) -> list[tuple[str, int, int]]:
    """Titles, begins and ends of what is shown of the pins: edges that were sought, the stop at the end."""
    found = []
    sought = [stop for stop in run.stops if run.sought(stop) and stop.latch is not None]
    others = [stop for stop in run.stops if not run.sought(stop)]
    half = run.file.clock_hz // 1000
    if sought:
        edge = _edge_before(run, sought[0].clock)
        found.append(("First edge", edge - half // 2, edge + half))
    if others:
        clock, title = others[-1].clock - run.start, f"The stop {others[-1].cause.name}"
        if others[-1].cause == Cause.FOLLOWING_ERROR:  # what it began with
            events = [one for one in run.events if one.clock is not None and one.clock <= others[-1].clock]
            if events:
                clock, title = events[-1].clock - run.start, events[-1].name.capitalize()
        found.append((title, clock - half, clock + half // 2))
    elif len(sought) > 1:
        edge = _edge_before(run, sought[-1].clock)
        found.append(("Last edge", edge - half // 2, edge + half))
    return found


def _edge_before(run: SceneRun, clock: int) -> int:
    """Clock since the start of the last change of a switch before a stop that the filter lets pass."""
    filter_clocks = run.setup.settings.filter * run.file.clock_hz
    found = clock - run.file.clock_hz // 50
    for one in run.setup.inputs:
        own = run.inputs[(run.inputs["input"] == NUMBERS[one.role]) & (run.inputs["clock"] < clock)]
        bit = 0 if one.role == "probe" else one.axis
        levels = (own["levels"] >> np.uint64(bit) & np.uint64(1)).astype(np.int8)
        clocks = own["clock"].astype(np.int64)
        changes = np.flatnonzero(np.diff(levels)) + 1
        lasts = np.diff(np.append(clocks[changes], clock)) > filter_clocks
        found = max([found, *clocks[changes[lasts]].tolist()[-1:]])
    return found - run.start


def _zoom(ax: Axes, run: SceneRun, lanes: list[Lane], title: str, begin: int, end: int) -> None:
    pins = [
        (f"{pin.upper()} {axis}", pin, axis, False)
        for axis in range(run.file.axes)
        for pin in ("step", "dir")
    ]
    plot_signals(ax, run, pins + lanes, begin, end, 1e3 / run.file.clock_hz)
    _marks(ax, run, 1e3 / run.file.clock_hz)
    ax.set_xlim(begin * 1e3 / run.file.clock_hz, end * 1e3 / run.file.clock_hz)
    ax.set_title(title)
    ax.set_xlabel("ms")
