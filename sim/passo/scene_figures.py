# SPDX-License-Identifier: MIT
"""Evenness of laser power and accuracy of a thread, measured at the pins."""

from typing import Any

import numpy as np

from passo.engine import NUMBERS
from passo.move_forms import MachineOutput
from passo.scene_run import SceneRun, Section

PERIODS = 256  # of the PWM in a window at full speed: its ends are a period uncertain
POWER_POINTS = 2000  # at most, of the curve of the mean power
SLOWEST = 0.05  # of the speed at which the power is full


def energies(run: SceneRun) -> list[dict[str, Any]]:
    """Of each move with a power in proportion to the speed: the energy per step, beside the wanted one."""
    found = []
    for section in run.sections:
        begin = np.zeros(run.file.axes, int)
        for number, move in zip(section.numbers, section.moves, strict=True):
            output = run.setup.outputs[number - 1]
            if output and output.speed and output.power:
                axis = int(np.argmax(np.abs(move.steps)))
                steps = _steps_of(run, section, axis)[begin[axis] :][: abs(move.steps[axis])]
                found.append({"number": number, **_energy(run, output, steps)})
            begin += np.abs(move.steps)
    return found


def _steps_of(run: SceneRun, section: Section, axis: int) -> np.ndarray:
    """Clocks since the start of the steps of a section."""
    clocks, _ = run.steps(axis)
    return clocks[(clocks >= section.begin - run.start) & (clocks <= section.end - run.start)]


def _energy(run: SceneRun, output: MachineOutput, steps: np.ndarray) -> dict[str, Any]:
    assert output.speed
    hz = run.file.clock_hz
    ideal = float(output.power / 100 * hz / output.speed)  # clocks of power per step
    size = max(1, -(-PERIODS * output.speed // run.setup.settings.pwm))
    begins = np.arange(0, len(steps) - size, size)
    slowest = float(hz / (output.speed * SLOWEST)) * (1 + 1e-3)  # steps lie on whole clocks
    gaps = np.diff(steps)
    fast = [bool(gaps[begin : begin + size].max() <= slowest) for begin in begins]
    on = time_on(run, steps)
    deviations = ((on[begins + size] - on[begins]) / (size * ideal) - 1)[fast] if len(begins) else np.empty(0)
    whole = float(100 * ((on[-1] - on[0]) / ((len(steps) - 1) * ideal) - 1)) if len(steps) > 1 else None
    return {
        "steps_per_window": int(size),
        "windows": len(deviations),
        "least_percent": float(100 * deviations.min(initial=np.inf)) if len(deviations) else None,
        "most_percent": float(100 * deviations.max(initial=-np.inf)) if len(deviations) else None,
        "whole_percent": whole,
    }


def time_on(run: SceneRun, clocks: np.ndarray) -> np.ndarray:
    """Clocks on which the power pin was high before each of `clocks`."""
    level = (run.pins["power"] & np.uint64(1)).astype(np.int64)
    at = run.pins["clock"].astype(np.int64) - run.start
    total = np.concatenate([[0], np.cumsum(np.diff(at) * level[:-1])])
    place = np.searchsorted(at, clocks, side="right") - 1
    return total[place] + (clocks - at[place]) * level[place]


def mean_power(run: SceneRun) -> tuple[np.ndarray, np.ndarray]:
    """Clocks, a period of the PWM or more apart, and the power (%) from each to the next."""
    period = float(run.file.clock_hz / run.setup.settings.pwm)
    count = max(1, int(min(POWER_POINTS, run.total_clocks / period)))
    clocks = np.linspace(0, run.total_clocks, count + 1).astype(np.int64)
    shares = np.diff(time_on(run, clocks)) / np.maximum(1, np.diff(clocks))
    return clocks, np.append(100 * shares, 0)


def thread_figures(run: SceneRun, section: Section) -> dict[str, Any]:
    """How far the steps of a pass are from the exact pitch, and where on the turn it began, in counts."""
    (move,), spindle = section.moves, run.setup.spindle
    assert spindle
    axis = int(np.argmax(np.abs(move.steps)))
    steps = _steps_of(run, section, axis)
    numbers = [NUMBERS["encoder_a"], NUMBERS["encoder_b"]]
    turned = run.inputs["clock"][np.isin(run.inputs["input"], numbers)].astype(np.int64) - run.start
    if not len(steps):
        return {"steps": 0}
    counts = np.searchsorted(turned, steps, side="right")
    pitch = float(move.turns * spindle.counts_per_turn / abs(move.steps[axis]))
    late = counts - np.arange(len(steps)) * pitch
    gaps = np.diff(turned[counts[0] : counts[-1]])
    return {
        "steps": len(steps),
        "counts_per_step": pitch,
        "largest_distance_counts": float(late.max() - late.min()),
        "spindle_rpm": [_rpm(run, gap) for gap in (gaps.max(initial=1), gaps.min(initial=run.file.clock_hz))],
        "phase_counts": int(counts[0]) % spindle.counts_per_turn,
    }


def _rpm(run: SceneRun, clocks: int) -> float:
    assert run.setup.spindle
    return float(60 * run.file.clock_hz / (int(clocks) * run.setup.spindle.counts_per_turn))
