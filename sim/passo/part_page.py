# SPDX-License-Identifier: MIT
"""Report page of a part: every edge of its motors; of the charts those of a motion without ideal curves."""

import base64
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from passo import __version__
from passo.part import Played
from passo.report_data import edges_of, packed_edges
from passo.report_page import write_data

COMPLETE, FAULT = "complete", "fault"


def write_part_page(played: Played, summary: dict[str, Any], path: Path) -> None:
    """Write the report; `summary` is that of the run."""
    write_data(summary["name"], part_data(played, summary), path)


def part_data(played: Played, summary: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """The facts and the edges, as page_data() of report_data.py."""
    machine, axes, streams = played.machine, [], []
    begins = np.array(played.part.begin.steps)
    for motor, scale in enumerate(machine.settings.scales):
        edges = edges_of(played.events, motor, played.origin)
        streams += packed_edges(*edges)
        axes.append(
            {
                "run": 0,
                "axis": motor,
                "name": machine.motors[motor],
                "per_step": 1 / scale,
                "edges": [len(one) for one in edges],
                "start": int(begins[motor]),
            }
        )
    clocks = played.motions[-1][1] if played.motions else 0
    ok = summary["ok"]
    facts = {
        "version": __version__,
        "summary": {
            "name": summary["name"],
            "outcome": COMPLETE if ok else FAULT,
            "verdict": f"{summary['chords']} chords in {played.seconds:.6g} s"
            if ok
            else "; ".join(summary["problems"]),
            "engine": summary["engine"],
            "matched_edges": played.matched_edges,
            "moves": [],
            "axes": [{"pulses": count} for count in summary["pulses"]],
        },
        "file": "",  # no tables of moves
        "clock_hz": machine.clock_hz,
        "clocks": clocks,
        "parameters": {},
        "alpha_reset": 0,
        "runs": [{"channel": 0, "start": 0, "clocks": clocks, "pins": None, "unit": "mm", "plans": []}],
        "axes": axes,
        "events": [
            {"clock": clock, "text": text, "kind": ""}
            for begin, end in played.motions
            for clock, text in ((begin, "a motion begins"), (end, "the motion ends"))
        ],
    }
    packed = zlib.compress(np.concatenate([*streams, np.empty(0, np.uint8)]).tobytes(), 9)
    return facts, base64.b64encode(packed).decode()
