# SPDX-License-Identifier: MIT
"""Roundness of a circle on screws with play, without trackers and with the backlash that they take up.

    .venv/bin/python -m benchmarks.backlash [--picture FILE]

Radius 20 mm at 100 mm/s, 400 steps/mm, 0.05 mm of play in both axes. The model makes the pulses; the table
follows a motor as far as the play lets it. The distance to the center counts after the first quarter.
"""

import argparse
import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from passo import registers as r
from passo.build import Parameters
from passo.console import cancelable, console, progress, table
from passo.ending import ended
from passo.engine import model_engine
from passo.host import Channel, PinTiming
from passo.link import Link
from passo.native import ffi
from passo.output import complete

CLOCK_HZ, TICK = 10_000_000, 128
STEPS_PER_MM, RADIUS_MM, FEED_MM_S, PLAY_MM = 400, 20, 100, 0.05
PLAY = round(PLAY_MM * STEPS_PER_MM)  # steps
CHORDS, TURNS, SUBSTEPS = 360, 1.25, 400  # of a turn; substeps of a chord
SPEED, ACCELERATION = 60_000, 20_000_000  # of the trackers, steps/s, steps/s^2
ONE, STEP = 1 << 48, 1 << 32  # substep, UQ0.48; step, UQ0.32
AHEAD = 40  # lines


@dataclass
class Result:
    """Distance of the table to the center, less the radius, in mm at each step; and the time of the path."""

    errors: np.ndarray
    angles: np.ndarray
    seconds: float

    @property
    def roundness(self) -> float:
        """Greatest distance less the smallest one, mm."""
        return float(self.errors.max() - self.errors.min())


def chords() -> list[list[int]]:
    """Lines of the circle, as words."""
    count = round(CHORDS * TURNS)
    angles = 2 * math.pi * np.arange(count + 1) / CHORDS
    places = np.rint(RADIUS_MM * STEPS_PER_MM * np.stack([np.cos(angles), np.sin(angles)], 1)).astype(int)
    lines = []
    for i, (x, y) in enumerate(np.diff(places, axis=0).tolist()):
        directions = (x < 0) | (y < 0) << 1
        control = (i == count - 1) | directions << r.LINE_CONTROL_DIRECTIONS_LSB
        lines.append([control, SUBSTEPS, abs(x), abs(y)])
    return lines


def follow(motor: np.ndarray, start: int) -> np.ndarray:
    """Where a table with play is: `motor` pushes it up, or pulls it down once the play is used up."""
    at, places = start, np.empty(len(motor))
    for i, place in enumerate(motor.tolist()):
        at = min(max(at, place), place + PLAY)
        places[i] = at
    return places


def machine(trackers: bool, report: Callable[[float], None] = lambda lines: None) -> Result:
    """Make the circle; `report` is called with the lines sent."""
    parameters = Parameters(axes=2, trackers=int(trackers), line_queue_log2=8)
    with model_engine(parameters, CLOCK_HZ) as engine:
        link = Link(engine)
        channel = Channel(link, parameters)
        for axis in range(2):
            channel.configure_axis(axis, PinTiming(20, 20, 20, 20))
            if trackers:
                seconds = TICK / CLOCK_HZ
                limits = int(SPEED * seconds * STEP), int(ACCELERATION * seconds * seconds * STEP)
                link.write(channel.axis_base(axis) + r.AXIS_TRACKER_SPEED, *limits)
        if trackers:
            down = [-PLAY % STEP] * 2
            link.write(channel.base + r.CHANNEL_TRACKER_TARGET_DOWN_BASE, *down)
            link.write(channel.base + r.CHANNEL_TRACKER_ENABLE, 3)
        lines = chords()
        seconds = 2 * math.pi * RADIUS_MM * TURNS / FEED_MM_S
        ticks = round(seconds * CLOCK_HZ / TICK)
        velocity = len(lines) * SUBSTEPS * ONE // (ticks * TICK)
        ramps = [{"velocity_end": velocity}, {"velocity_end": velocity, "ticks": ticks, "last": True}]
        ramps[1]["progress_step"] = ONE // ticks
        channel.push_ramps([ffi().new("struct passo_ramp *", ramp)[0] for ramp in ramps])
        channel.push_line_words(lines[: 2 * AHEAD])
        sent = 2 * AHEAD
        channel.start()
        events = []
        while sent < len(lines) or not channel.state().quiet:
            engine.run(CLOCK_HZ // 200)
            events.append(engine.drain())
            room = min(channel.room()[0], AHEAD, len(lines) - sent)
            if room:
                channel.push_line_words(lines[sent : sent + room])
                sent += room
                report(sent)
        end = channel.positions()
        events.append(engine.drain())
    return judge(np.concatenate(events), end)


def judge(events: np.ndarray, end: list[int]) -> Result:
    """The table, from the pins."""
    at = []
    for axis in range(2):
        step = (events["step"] >> np.uint64(axis) & np.uint64(1)).astype(np.int64)
        sign = 1 - 2 * (events["dir"] >> np.uint64(axis) & np.uint64(1)).astype(np.int64)
        motor = np.cumsum((np.diff(step, prepend=0) == 1) * sign)
        assert motor[-1] == end[axis]
        first = RADIUS_MM * STEPS_PER_MM if axis == 0 else 0
        at.append(follow(motor + first, first) / STEPS_PER_MM)
    running = events["running"] & np.uint64(1)
    clocks = events["clock"][running == 1]
    angles = np.unwrap(np.arctan2(at[1], at[0]))
    judged = (angles > math.pi / 2) & (running == 1)
    errors = np.hypot(*at) - RADIUS_MM
    return Result(errors[judged], angles[judged], int(clocks[-1] - clocks[0]) / CLOCK_HZ)


def draw(results: dict[str, Result], path: Path) -> None:
    """The errors, a thousand times as large, around the circle."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6, 6), subplot_kw={"projection": "polar"})
    for name, result in results.items():
        axes.plot(result.angles, 1000 * result.errors, label=name, linewidth=1)
    axes.set_rlabel_position(22)
    axes.set_rmin(-1500 * PLAY_MM)
    axes.set_title("distance to the center, off by (µm)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncol=2)
    with complete(path) as part:
        figure.savefig(part, dpi=110, bbox_inches="tight")


def main() -> None:
    """Make both circles and print what they are off."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--picture", type=Path, help="draw it into this file")
    arguments = parser.parse_args()
    results = {}
    with cancelable() as work:
        for name, trackers in {"without trackers": False, "backlash by trackers": True}.items():
            with progress(name, len(chords())) as report:
                results[name] = machine(trackers, report)
    made = table("Circle on screws with play", "", "roundness, µm", "path, s")
    for name, result in results.items():
        made.add_row(name, f"{1000 * result.roundness:.1f}", f"{result.seconds:.4f}")
    console.print(made)
    if work.canceled:
        raise SystemExit("canceled")
    plain, taken = results.values()
    rounder, longer = plain.roundness / taken.roundness, taken.seconds / plain.seconds
    console.print(f"{rounder:.1f} times as round, {longer:.4f} of the time")
    if arguments.picture:
        draw(results, arguments.picture)


if __name__ == "__main__":
    sys.exit(ended(main))
