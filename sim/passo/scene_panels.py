# SPDX-License-Identifier: MIT
"""The plots of a page of a move file with a machine: speed, position, encoders, pins."""

import numpy as np
from matplotlib.axes import Axes

from passo.engine import NUMBERS
from passo.move_forms import MachineTrack
from passo.plot_panels import COLORS, INK, WIDE, WINDOWS, evened
from passo.scene_figures import energies, mean_power
from passo.scene_report import measured_curve, planned
from passo.scene_run import SceneRun

STOP, SOUGHT, INPUT = "#c1121f", "#8c959f", "#57606a"
REST_SECONDS = 0.02  # between two steps that belong to no speed
OF_AXES = ("step", "dir", "enable")  # pins that have the color of an axis
Lane = tuple[str, str, int, bool]  # name, pin, bit, whether it is an input


def plot_scene_speed(ax: Axes, run: SceneRun) -> None:
    """Speed as planned, and the inverse of the time between steps."""
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
        speeds = np.where(follows, directions[1:] / np.maximum(gaps, 1), np.nan)
        middle, speeds = evened((clocks[1:] + clocks[:-1]) / 2, speeds, run.total_clocks / WINDOWS)
        ax.plot(middle / hz, speeds * hz / 1e3, color=COLORS[axis], linewidth=0.9, label=f"axis {axis}")
    ax.axhline(0, color=INK, linewidth=0.5)
    ax.set_ylabel("kHz")
    is_planned = any(section.plans for section in run.sections)
    ax.set_title("Speed: as planned (wide) and the steps at the pins (thin)" if is_planned else "Speed")


def plot_scene_position(ax: Axes, run: SceneRun) -> None:
    """Position counted at the pins and as measured, with the switches in the travel."""
    hz, scales = run.file.clock_hz, run.setup.scales
    in_mm = bool(scales)
    for axis in range(run.file.axes):
        scale = 1 / float(scales[axis]) if in_mm else 1
        clocks, directions = run.steps(axis)
        places = np.concatenate([[0], np.cumsum(directions, dtype=np.int64)]) + run.setup.start(axis)
        times = np.concatenate([[0], clocks, [run.shown_clocks]]) / hz
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


def plot_scene_encoder(ax: Axes, run: SceneRun) -> None:
    """Distance of what the encoder measured from the commanded curve and from the steps."""
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


def plot_scene_trackers(ax: Axes, run: SceneRun) -> None:
    """Steps of the trackers, and where they were sent."""
    hz = run.file.clock_hz
    times = (run.tracked["clock"].astype(np.int64) - run.start) / hz
    for track in run.setup.trackers:
        axis = track.axis
        scale = 1 / float(run.setup.scales[axis]) if run.setup.scales else 1
        ax.plot(times, run.tracked["position"][:, axis] * scale, color=COLORS[axis], linewidth=1.1)
        sent = sorted(
            (happened.clock - run.start, int(happened.event.target.value))
            for happened in run.events
            if isinstance(happened.event, MachineTrack) and happened.event.axis == axis and happened.clock
        )
        at = np.array([(0, 0), *sent, (run.shown_clocks, sent[-1][1] if sent else 0)])
        ax.step(at[:, 0] / hz, at[:, 1] * scale, where="post", color=COLORS[axis], **WIDE)
    ax.set_title("Trackers: targets (wide) and steps (thin)")
    ax.set_ylabel("mm" if run.setup.scales else "steps")


def plot_scene_power(ax: Axes, run: SceneRun) -> None:
    """Share of the time that the power is on."""
    clocks, percent = mean_power(run)
    ax.step(clocks / run.file.clock_hz, percent, where="post", color=STOP, linewidth=1.0)
    ax.set_ylim(bottom=0)
    found = [
        f"move {one['number']}: {one['least_percent']:+.2f} to {one['most_percent']:+.2f} %"
        for one in energies(run)
        if one["windows"]
    ]
    ax.set_title("Power" + (f"; energy per step less the wanted one, {'; '.join(found)}" if found else ""))
    ax.set_ylabel("%")


def lanes_of(run: SceneRun) -> list[Lane]:
    """The signals that are shown."""
    lanes = [("ENABLE " + str(axis), "enable", axis, False) for axis in range(run.file.axes)]
    lanes.append(("RUNNING", "running", 0, False))
    if run.setup.has_outputs:
        used = 0
        for output in run.setup.outputs:
            used |= output.levels if output else 0
        lanes += [(f"output {bit}", "outputs", bit, False) for bit in range(8) if used >> bit & 1]
        lanes.append(("POWER", "power", 0, False))
    if run.setup.compare:
        lanes.append(("COMPARE", "compare", 0, False))
    for one in run.setup.inputs:
        bit = 0 if one.role == "probe" else one.axis
        name = one.role if one.role == "probe" else f"{one.role} {one.axis}"
        lanes.append((name, one.role, bit, True))
    if any(happened.event.form.name == "estop" for happened in run.events):
        lanes.append(("estop_n", "estop_n", 0, True))
    return lanes


def trace_of(run: SceneRun, lane: Lane, begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
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


def plot_signals(ax: Axes, run: SceneRun, lanes: list[Lane], begin: float, end: float, scale: float) -> None:
    """Levels of pins, one above the other."""
    for row, lane in enumerate(lanes):
        base = -1.5 * row
        color = INPUT if lane[3] or lane[1] not in OF_AXES else COLORS[lane[2]]
        clocks, levels = trace_of(run, lane, begin, end)
        ax.step(clocks * scale, base + levels, where="post", color=color, linewidth=1.0)
        ax.fill_between(
            clocks * scale, base, base + levels, step="post", color=color, alpha=0.15, linewidth=0
        )
    ax.set_ylim(0.7 - 1.5 * len(lanes), 1.4)
    ax.set_yticks([0.5 - 1.5 * row for row in range(len(lanes))], [lane[0] for lane in lanes])
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)
