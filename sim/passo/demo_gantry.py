# SPDX-License-Identifier: MIT
"""A gantry that starts skewed: `$H` of the grbl console squares it, on both engines."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from passo.build import Parameters
from passo.engine import AroundEngine, moves_of
from passo.grbl import Grbl
from passo.grbl_setup import attach
from passo.machine_file import MachineFile, read_machine
from passo.output import empty_folder, write_json
from passo.plot import COLORS, STYLE, save
from passo.run import open_engine, parameters_for

SKEW = 2.5  # mm that the second motor begins further up
AXIS, PATIENCE = 1, 60  # Y; simulated seconds


class Recorder(AroundEngine):
    """Keeps what leaves the pins."""

    def __init__(self, engine: Any):
        super().__init__(engine)
        self.events: list[np.ndarray] = []

    def transfer(self, mosi: Sequence[int], gap: int = 64) -> list[int]:
        """One chip select."""
        return self.engine.transfer(mosi, gap)

    def run(self, clocks: int) -> int:
        """Let time pass."""
        return self.engine.run(clocks)

    def drain(self) -> np.ndarray:
        """The pin events since the last call."""
        self.events.append(self.engine.drain())
        return self.events[-1]


def gantry_core(machine: MachineFile) -> Parameters:
    """The core of an example with inputs, which other examples have as well."""
    return replace(parameters_for(len(machine.motors)), inputs=1)


def run_gantry(machine_path: Path, folder: Path, on: str = "both") -> dict[str, Any]:
    """Home it on an engine, write picture and summary to a folder; return the summary."""
    machine, began = read_machine(machine_path), time.monotonic()
    empty_folder(folder, ("summary.json", "motion.png"))
    scale = float(machine.settings.axes[AXIS].steps_per_mm)
    motors, said = machine.motors_of(AXIS), []
    with open_engine(on, gantry_core(machine), machine.clock_hz) as made:
        start = round(machine.ends[AXIS].travel * scale) // 2
        attach(made, machine, {motors[1]: round(SKEW * scale)})
        engine = Recorder(made)
        grbl = Grbl(engine, machine, said.append)
        grbl.type(b"$H\n")
        ended = grbl.wait(lambda: grbl.answers > 0 and grbl.is_idle, PATIENCE)
        matched = getattr(made, "matched_edges", None)
    events = np.concatenate(engine.events)
    seconds, places = events["clock"] / machine.clock_hz, []
    for motor in motors:
        places.append((start + np.cumsum(moves_of(events, motor))) / scale)
    places[1] = places[1] + SKEW
    wanted = [machine.switches.pull_off - offset for offset in machine.ends[AXIS].offsets]
    off = max(abs(place[-1] - end) for place, end in zip(places, wanted, strict=True)) * scale
    problems = [] if ended and "ok\r\n" in said else ["the cycle did not end"]
    problems += [f"a motor is {off:.2f} steps off"] if off > 1 else []
    with plt.rc_context(STYLE):
        figure, panel = plt.subplots(figsize=(9, 4.5))
        for name, place, color in zip(("Y", "Y2"), places, COLORS, strict=False):
            panel.plot(seconds, place, label=f"motor {name}", color=color)
        panel.plot(seconds, places[1] - places[0], label="Y2 less Y", color="#8c959f", linestyle="--")
        panel.set(title="A gantry that starts skewed is squared", xlabel="s", ylabel="mm from its own switch")
        panel.legend(loc="upper right")
        save(figure, folder / "motion.png", 110)
    summary = {
        "ok": not problems,
        "problems": problems,
        "axes": [{"pulses": int(np.abs(np.diff(place * scale)).round().sum())} for place in places],
        "total_seconds": float(seconds[-1]),
        "matched_edges": matched,
        "clocks_per_second": float(events["clock"][-1]) / (time.monotonic() - began),
        "stops": [],
    }
    write_json(summary, folder / "summary.json")
    return summary
