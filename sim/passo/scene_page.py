# SPDX-License-Identifier: MIT
"""Report page data of a move file with a machine: pins, power, encoders, events."""

import base64
import zlib
from dataclasses import asdict
from typing import Any

import numpy as np

from passo import __version__
from passo.moves import Channels
from passo.report_data import edges_of, packed_edges, varints
from passo.scene_figures import mean_power
from passo.scene_panels import Lane, lanes_of, trace_of
from passo.scene_plan import scene_parameters
from passo.scene_report import measured_curve, said, summarize_scene
from passo.scene_run import SceneRun


def scene_data(channels: Channels, run: SceneRun, engine: str) -> tuple[dict[str, Any], str]:
    """The facts, and the edges: zlib in base64. Clocks count from the start of the first motion.

    After the streams of the axes, those of report_data.py, comes one for each further signal: varints of the
    differences between its edges; a signal that is high at first has an edge at the beginning of the run.
    """
    axes, streams = [], []
    for axis in range(run.file.axes):
        own = edges_of(run.pins, axis, run.start)
        streams += packed_edges(*own)
        scale = 1 / float(run.setup.scales[axis]) if run.setup.scales else 1.0
        axes.append(
            {
                "run": 0,
                "axis": axis,
                "name": f"{axis}",
                "per_step": scale,
                "edges": [len(one) for one in own],
                "start": run.setup.start(axis),
            }
        )
    signals = []
    for lane in lanes_of(run):
        edges = _edges(run, lane)
        streams.append(varints(np.diff(edges, prepend=0)))
        signals.append({"name": lane[0], "axis": None if lane[3] else _axis(lane), "edges": len(edges)})
    unit = "mm" if run.setup.scales else "steps"
    facts = {
        "version": __version__,
        "summary": summarize_scene(run, engine),
        "file": channels.path.name,
        "clock_hz": run.file.clock_hz,
        "clocks": run.shown_clocks,
        "parameters": asdict(scene_parameters(channels)),
        "alpha_reset": 0,
        "runs": [
            {
                "channel": 0,
                "start": 0,
                "clocks": run.total_clocks,
                "pins": asdict(run.file.pins),
                "unit": unit,
                "plans": [],
            }
        ],
        "axes": axes,
        "events": _events(run),
        "machine": {
            "signals": signals,
            "power": _power(run),
            "encoders": [_encoder(run, number) for number in range(len(run.setup.encoders))],
            "trackers": [_tracker(run, axis) for axis in run.setup.with_trackers],
        },
    }
    packed = zlib.compress(np.concatenate([*streams, np.empty(0, np.uint8)]).tobytes(), 9)
    return facts, base64.b64encode(packed).decode()


def _axis(lane: Lane) -> int | None:
    """The axis whose color a signal has."""
    return lane[2] if lane[1] == "enable" else None


def _edges(run: SceneRun, lane: Lane) -> np.ndarray:
    clocks, levels = trace_of(run, lane, -run.start - 1, run.clocks)
    return clocks[np.flatnonzero(np.diff(levels, prepend=np.int8(0)))].astype(np.int64)


def _power(run: SceneRun) -> dict[str, list[float]] | None:
    if not run.setup.has_outputs:
        return None
    clocks, percent = mean_power(run)
    return {"clocks": clocks.tolist(), "percent": percent.round(4).tolist()}


def _encoder(run: SceneRun, number: int) -> dict[str, Any]:
    """Samples of the host: the measured position, and how far it is behind the steps."""
    encoder = run.setup.encoders[number]
    curve = measured_curve(run, encoder)
    return {
        "axis": encoder.axis,
        "clocks": curve.clocks.tolist(),
        "measured": (curve.measured + run.setup.start(encoder.axis)).tolist(),
        "error": (curve.made - curve.measured).tolist(),
        "limit": float(encoder.limit) if encoder.limit else None,
    }


def _tracker(run: SceneRun, axis: int) -> dict[str, Any]:
    """Samples of the host."""
    clocks = run.tracked["clock"].astype(np.int64) - run.start
    return {"axis": axis, "clocks": clocks.tolist(), "tracked": run.tracked["position"][:, axis].tolist()}


def _events(run: SceneRun) -> list[dict[str, Any]]:
    """What happened, in the order of the clocks."""
    found = []

    def add(clock: int, text: str, kind: str = "") -> None:
        found.append({"clock": clock, "text": text, "kind": kind})

    for section in run.sections:
        moves = ", ".join(map(str, section.numbers))
        task = "" if section.kind == "moves" else f" ({section.kind})"
        begins = "begins" if run.moved(section) else f"does not begin: {section.outcome}"
        add(section.begin - run.start, f"move {moves} {begins}{task}", "" if run.moved(section) else "stop")
    for happened in run.events:
        if happened.clock is not None:
            add(happened.clock - run.start, f"{happened.name}: {said(happened)}")
    for stop in run.stops:
        where = ", ".join(map(str, stop.positions))
        add(stop.clock - run.start, f"stop {stop.cause.name} at {where}", "" if run.sought(stop) else "stop")
    for latch in run.latches:
        clock = run.events[latch.number - 1].clock or run.start
        add(clock - run.start, f"event {latch.number} latched {', '.join(map(str, latch.positions))}")
    last = int(run.pins["clock"][-1]) - run.start if len(run.pins) else 0
    add(
        run.total_clocks if run.ended else last,
        "the motion ends" if run.ended else "the motion has not ended",
    )
    if run.unmade:
        add(run.total_clocks, f"move {', '.join(map(str, run.unmade))} does not begin", "stop")
    for problem in run.problems():
        add(run.total_clocks, problem, "fault")
    return sorted(found, key=lambda event: event["clock"])
