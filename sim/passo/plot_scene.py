# SPDX-License-Identifier: MIT
"""The page of plots of a move file with a machine."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from passo.engine import NUMBERS
from passo.move_forms import EventInput, EventOverride, EventSlip
from passo.plot import STYLE
from passo.plot_panels import COLORS, INK, WIDE
from passo.registers import Cause
from passo.scene_report import measured_curve, planned
from passo.scene_run import Happened, SceneRun

STOP, SOUGHT, EVENT_COLOR, INPUT = "#c1121f", "#8c959f", "#6639ba", "#57606a"
REST_SECONDS = 0.02  # between two steps that belong to no speed
BADGE = {"boxstyle": "circle,pad=0.25", "facecolor": EVENT_COLOR, "edgecolor": "white", "linewidth": 1}
LABEL = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": STOP, "linewidth": 0.8}


def plot_scene(run: SceneRun, path: Path) -> None:
    """Write the page."""
    heights = {"speed": 1.5, "position": 1.3}
    if run.setup.encoders:
        heights["encoder"] = 1.0
    lanes = _lanes(run)
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
        _speed(axes["speed"], run)
        _position(axes["position"], run)
        if run.setup.encoders:
            _encoder(axes["encoder"], run)
        end = run.total_clocks * 1.02
        _signals(axes["lanes"], run, lanes, -0.01 * run.total_clocks, end, 1 / run.file.clock_hz)
        axes["lanes"].set_title("Inputs and drives")
        axes["lanes"].set_xlabel("s")
        shared = [axes[name] for name in heights if name != "zoom"]
        for ax in shared:
            ax.set_xlim(-0.01 * run.total_clocks / run.file.clock_hz, end / run.file.clock_hz)
            _marks(ax, run)
            if ax is not shared[-1]:
                ax.tick_params(labelbottom=False)
        _badges(axes["speed"], run)
        if run.file.axes > 1:
            handles = axes["speed"].get_legend_handles_labels()
            head.legend(*handles, loc="upper right", ncols=8)
        for number, (title, begin, stop) in enumerate(zooms):
            _zoom(axes[f"zoom {number}"], run, lanes, title, begin, stop)
        figure.savefig(path, dpi=110)
        plt.close(figure)


# ------------------------------------------------------------------------------------------------ words ----


def _head(figure: plt.Figure, run: SceneRun, listed: list[tuple[str, str]]) -> None:
    pulses = sum(len(run.steps(axis)[0]) for axis in range(run.file.axes))
    hz = run.file.clock_hz
    title = f"{run.file.name}: {pulses:,} steps in {run.total_clocks / hz:.6g} s at {hz / 1e6:g} MHz"
    inches = figure.bbox.height / figure.dpi
    figure.text(0.012, 1 - 0.28 / inches, title, fontsize=13, fontweight="bold")
    for line, (mark, text) in enumerate(listed):
        y = 1 - (0.55 + 0.19 * line) / inches
        color = EVENT_COLOR if mark.isdigit() else STOP
        figure.text(0.024, y, mark, color=color, fontweight="bold", ha="center")
        figure.text(0.036, y, text)


def _listing(run: SceneRun) -> list[tuple[str, str]]:
    """Events and stops in words, in the order of time."""
    hz = run.file.clock_hz
    found: list[tuple[int, str, str]] = []
    for happened in run.events:
        if happened.clock is not None:
            clock = happened.clock - run.start
            found.append((clock, str(happened.number), f"{clock / hz:.6f} s  {_said(happened)}"))
    for stop in run.stops:
        if not run.sought(stop):
            clock = stop.clock - run.start
            where = ", ".join(map(str, stop.positions))
            found.append((clock, "■", f"{clock / hz:.6f} s  stop {stop.cause.name} at {where}"))
    return [(mark, text) for _, mark, text in sorted(found)]


def _said(happened: Happened) -> str:
    event = happened.event
    said = event.form.name
    if isinstance(event, EventInput):
        said = f"{event.input} of axis {event.axis} {'active' if event.active else 'inactive'}"
    if isinstance(event, EventOverride):
        said += f" {event.percent} %"
    if isinstance(event, EventSlip):
        said += f" of axis {event.axis} by {event.counts} counts"
    return f"{said} at {', '.join(map(str, happened.positions))}"


# ----------------------------------------------------------------------------------------------- panels ----


def _speed(ax: Axes, run: SceneRun) -> None:
    hz = run.file.clock_hz
    for section in run.sections:
        if section.plans:
            length = sum(plan.clocks for plan in section.plans)
            clocks = np.linspace(0, min(length, run.total_clocks + run.start - section.begin), 1500)
            _, speeds, _ = planned(run, section, clocks)
            for axis in range(run.file.axes):
                times = (clocks + section.begin - run.start) / hz
                ax.plot(times, speeds[axis] * hz / 1e3, color=COLORS[axis], **WIDE)
    for axis in range(run.file.axes):
        clocks, directions = run.steps(axis)
        gaps = np.diff(clocks)
        follows = (directions[1:] == directions[:-1]) & (gaps < REST_SECONDS * hz)
        speeds = np.where(follows, directions[1:] / np.maximum(gaps, 1), np.nan) * hz / 1e3
        middle = (clocks[1:] + clocks[:-1]) / 2 / hz
        ax.plot(middle, speeds, color=COLORS[axis], linewidth=0.9, label=f"axis {axis}")
    ax.axhline(0, color=INK, linewidth=0.5)
    ax.set_ylabel("kHz")
    is_planned = any(section.plans for section in run.sections)
    ax.set_title("Speed: as planned (wide) and the steps at the pins (thin)" if is_planned else "Speed")


def _position(ax: Axes, run: SceneRun) -> None:
    hz, scales = run.file.clock_hz, run.setup.scales
    in_mm = bool(scales)
    for axis in range(run.file.axes):
        scale = 1 / float(scales[axis]) if in_mm else 1
        clocks, directions = run.steps(axis)
        places = np.concatenate([[0], np.cumsum(directions, dtype=np.int64)]) + run.setup.start(axis)
        times = np.concatenate([[0], clocks, [run.total_clocks]]) / hz
        places = np.append(places, places[-1])
        ax.step(times, places * scale, where="post", color=COLORS[axis], linewidth=1.1)
    for encoder in run.setup.encoders:
        curve, color = measured_curve(run, encoder), COLORS[encoder.axis]
        scale = 1 / float(scales[encoder.axis]) if in_mm else 1
        measured = (curve.measured + run.setup.start(encoder.axis)) * scale
        ax.plot(curve.clocks / hz, measured, color=color, **WIDE)
    low, high = ax.get_ylim()
    for one in run.setup.inputs:
        if one.at is None:
            continue
        at = float(one.at.value) / (float(scales[one.axis]) if in_mm else 1)
        color, reach = COLORS[one.axis], (high - low) * 0.06
        beyond = at + reach if one.side == "above" else at - reach
        ax.axhspan(min(at, beyond), max(at, beyond), color=color, alpha=0.12, linewidth=0)
        ax.axhline(at, color=color, linewidth=0.8, linestyle=(0, (4, 2)))
        name = one.role if one.role == "probe" else f"{one.role} {one.axis}"
        ax.annotate(
            name, (1, at), xycoords=("axes fraction", "data"), xytext=(-4, 2 if one.side == "above" else -2),
            textcoords="offset points", ha="right", va="bottom" if one.side == "above" else "top",
            fontsize=7.5, color=color,
        )  # fmt: skip
    for stop in run.stops:
        for axis in range(run.file.axes):
            scale = 1 / float(scales[axis]) if in_mm else 1
            color = SOUGHT if run.sought(stop) else STOP
            at = (stop.clock - run.start) / hz
            ax.plot(at, stop.positions[axis] * scale, "o", color=color, markersize=3.5, zorder=5)
    measured = ", as measured (wide)" if run.setup.encoders else ""
    switches = ", switches (dashed)" if any(one.at is not None for one in run.setup.inputs) else ""
    ax.set_title(f"Position{measured}{switches}{', stops (dots)' if run.stops else ''}")
    ax.set_ylabel("mm" if in_mm else "steps")


def _encoder(ax: Axes, run: SceneRun) -> None:
    texts = []
    for encoder in run.setup.encoders:
        curve = measured_curve(run, encoder)
        color, times = COLORS[encoder.axis], curve.clocks / run.file.clock_hz
        ax.plot(times, curve.measured - curve.ideal, color=color, **WIDE)
        ax.step(times, curve.made - curve.measured, where="post", color=color, linewidth=1.1)
        if encoder.limit:
            for limit in (-float(encoder.limit), float(encoder.limit)):
                ax.axhline(limit, color=STOP, linewidth=0.8, linestyle=(0, (4, 2)))
        errors = curve.errors
        if len(errors):
            texts.append(f"at most {np.abs(errors).max():.2g}, rms {np.sqrt((errors**2).mean()):.2g} steps")
    ax.set_title(
        f"Measured less commanded curve (wide: {'; '.join(texts)}), steps less measured (thin), limit"
    )
    ax.set_ylabel("steps")


def _lanes(run: SceneRun) -> list[tuple[str, str, int, bool]]:
    """Name, pin, bit and whether it is an input, of the signals that are shown."""
    lanes = [("ENABLE " + str(axis), "enable", axis, False) for axis in range(run.file.axes)]
    lanes.append(("RUNNING", "running", 0, False))
    for one in run.setup.inputs:
        bit = 0 if one.role == "probe" else one.axis
        name = one.role if one.role == "probe" else f"{one.role} {one.axis}"
        lanes.append((name, one.role, bit, True))
    if any(happened.event.form.name == "estop" for happened in run.events):
        lanes.append(("estop_n", "estop_n", 0, True))
    return lanes


def _trace(
    run: SceneRun, lane: tuple[str, str, int, bool], begin: float, end: float
) -> tuple[np.ndarray, np.ndarray]:
    """Clocks since the start and levels of a pin."""
    _, pin, bit, is_input = lane
    if is_input:
        own = run.inputs[run.inputs["input"] == NUMBERS[pin]]
        clocks, levels = own["clock"], own["levels"]
    else:
        clocks, levels = run.pins["clock"], run.pins[pin]
    clocks = clocks.astype(np.int64) - run.start
    levels = (levels >> np.uint64(bit) & np.uint64(1)).astype(np.int8)
    first, last = np.searchsorted(clocks, [begin, end], side="right")
    before = levels[first - 1] if first else 0
    inside = levels[first:last]
    after = inside[-1] if len(inside) else before
    return np.concatenate([[begin], clocks[first:last], [end]]), np.concatenate([[before], inside, [after]])


def _signals(
    ax: Axes, run: SceneRun, lanes: list[tuple[str, str, int, bool]], begin: float, end: float, scale: float
) -> None:
    for row, lane in enumerate(lanes):
        base = -1.5 * row
        color = INPUT if lane[3] or lane[1] == "running" else COLORS[lane[2]]
        clocks, levels = _trace(run, lane, begin, end)
        ax.step(clocks * scale, base + levels, where="post", color=color, linewidth=1.0)
        ax.fill_between(
            clocks * scale, base, base + levels, step="post", color=color, alpha=0.15, linewidth=0
        )
    ax.set_ylim(0.7 - 1.5 * len(lanes), 1.4)
    ax.set_yticks([0.5 - 1.5 * row for row in range(len(lanes))], [lane[0] for lane in lanes])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)


# ------------------------------------------------------------------------------------------------ marks ----


def _marks(ax: Axes, run: SceneRun, scale: float = 0, origin: int = 0) -> None:
    """Vertical lines at events and stops; clocks since `origin` times `scale`, or seconds."""
    scale = scale or 1 / run.file.clock_hz
    for happened in run.events:
        if happened.clock is not None:
            at = (happened.clock - run.start - origin) * scale
            ax.axvline(at, color=EVENT_COLOR, linewidth=0.9, linestyle=(0, (3, 2)), zorder=1.5)
    for stop in run.stops:
        color, width = (SOUGHT, 0.7) if run.sought(stop) else (STOP, 1.2)
        ax.axvline((stop.clock - run.start - origin) * scale, color=color, linewidth=width, zorder=1.5)


def _badges(ax: Axes, run: SceneRun) -> None:
    """Numbers of the events at the top, causes of the stops."""
    top, hz = ("data", "axes fraction"), run.file.clock_hz
    for happened in run.events:
        if happened.clock is not None:
            ax.annotate(
                str(happened.number), ((happened.clock - run.start) / hz, 0.93), xycoords=top, color="white",
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
        found.append(("The first edge that was sought", edge - half // 2, edge + half))
    if others:
        clock, title = others[-1].clock - run.start, f"The stop {others[-1].cause.name}"
        if others[-1].cause == Cause.FOLLOWING_ERROR:  # what it began with
            events = [one for one in run.events if one.clock is not None and one.clock <= others[-1].clock]
            if events:
                clock, title = events[-1].clock - run.start, f"Event {events[-1].number}"
        found.append((title, clock - half, clock + half // 2))
    elif len(sought) > 1:
        edge = _edge_before(run, sought[-1].clock)
        found.append(("The last one", edge - half // 2, edge + half))
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


def _zoom(
    ax: Axes, run: SceneRun, lanes: list[tuple[str, str, int, bool]], title: str, begin: int, end: int
) -> None:
    pins = [
        (f"{pin.upper()} {axis}", pin, axis, False)
        for axis in range(run.file.axes)
        for pin in ("step", "dir")
    ]
    _signals(ax, run, pins + lanes, begin, end, 1e3 / run.file.clock_hz)
    _marks(ax, run, 1e3 / run.file.clock_hz)
    ax.set_xlim(begin * 1e3 / run.file.clock_hz, end * 1e3 / run.file.clock_hz)
    ax.set_title(title)
    ax.set_xlabel("ms")
