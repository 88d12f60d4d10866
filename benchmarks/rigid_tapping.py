# SPDX-License-Identifier: MIT
"""Rigid tapping on a simulated spindle: `python -m benchmarks.rigid_tapping`.

Ten times G33.1 into the same hole, by a spindle whose speed wanders by 20 %, overshoots at the depth,
reverses, and does so again at the top. Each step at the pins is compared with the angle of the spindle at
its time, from the edges of its encoder. Where a pass begins and ends, the axis comes up to speed and to rest,
off the thread by many counts. docs/gcode.md allows 4 v^2/a of its way for that, above the work, with the
noise in v. The exit status is 1 if a step below is further than a count of the encoder from the thread, if
the phase of a pass differs by more, or if the axis does not come to rest at the top.
"""

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from passo.console import progress
from passo.ending import ended
from passo.engine import NUMBERS
from passo.machine_file import read_machine
from passo.part import Played, core_of, play_part, read_part
from passo.run import open_engine

PASSES, PITCH, DEPTH, RPM, STEPS_PER_MM = 10, 1.25, 6, 600, 400
COUNTS, WANDER, START_UP = 1000, 20, 0.3
WITHIN = 1.0  # counts of the encoder
SPEED, ACCELERATION = 50, 500  # limits of each axis, mm/s, mm/s^2
APPROACH = 4 * (RPM / 60 * PITCH * (1 + WANDER / 100)) ** 2 / ACCELERATION  # mm, above the work
MACHINE = f"""
clock_hz = 32_000_000
spindle_maximum = 1000
[spindle]
counts = {COUNTS}
wander = {WANDER}
start_up = {START_UP}
"""
AXIS = f"""
[[axis]]
name = "{{}}"
steps_per_mm = {{}}
speed = {SPEED}
acceleration = {ACCELERATION}
"""


@dataclass(frozen=True)
class Pass:
    """A hole: what its steps are from the thread, in counts of the encoder."""

    error: float  # the greatest
    back: float  # the same on the way up
    phase: float  # mean of the way down, less whole turns
    deepest: float  # mm
    end: int  # position at the end, in steps from the top
    late: int  # steps after that
    off: float  # the greatest error above the work, in counts
    settled: float  # mm from the begin, behind which it is at most WITHIN


def program(passes: int = PASSES) -> str:
    """Of all holes, with a rapid to each."""
    holes = f"G0 Z2\nG33.1 Z{2 - DEPTH} K{PITCH}\n" * passes
    return f"M3 S{RPM}\n{holes}G0 Z5\nM5\nM2\n"


def turned(changes: np.ndarray, bit: int) -> tuple[np.ndarray, np.ndarray]:
    """Clocks of the edges of an encoder, and the angle at each, in counts."""
    pins = {NUMBERS[name]: weight for name, weight in (("encoder_a", 1), ("encoder_b", 2))}
    own = changes[np.isin(changes["input"], list(pins))]
    levels, state = np.zeros(len(own), int), 0
    weights = np.array([pins[int(number)] for number in own["input"]])
    high = (own["levels"] >> np.uint64(bit) & np.uint64(1)).astype(int)
    for at in range(len(own)):
        state = (state & ~int(weights[at])) | int(weights[at]) * int(high[at])
        levels[at] = state
    order = np.array([0, 1, 3, 2])[levels]  # 00 A AB B
    steps = np.diff(order, prepend=0) % 4
    counts = np.cumsum(np.where(steps == 3, -1, steps))
    # an edge is where both counts meet: that of a count back is a count higher
    return own["clock"].astype(np.int64), counts + (steps == 3)


def judge(played: Played, axis: int = 2) -> list[Pass]:
    """All passes, each from one position of the axis back to it; one that was canceled is left out."""
    assert played.machine.spindle
    counts = played.machine.spindle.counts
    clocks, positions = played.clocks[axis], played.positions[axis]
    edges, angles = turned(played.counts, len(played.machine.motors))
    angle = np.interp(clocks + played.origin, edges, angles)
    middle = positions - np.diff(positions, prepend=0) / 2
    top, found = 2 * STEPS_PER_MM, []
    starts = np.flatnonzero((positions[:-1] == top) & (np.diff(positions) < 0)) + 1
    for first, after in zip(starts, [*starts[1:], len(positions)], strict=True):
        if positions[first:after].max() < top:
            break
        last = first + int(np.argmax(positions[first:after] >= top))
        way = (top - middle[first : last + 1]) / STEPS_PER_MM / PITCH * counts
        in_work = way > APPROACH / PITCH * counts
        turn = int(np.argmin(positions[first : last + 1])) + 1
        seen = angle[first : last + 1] - way
        phase = float(np.mean(seen[:turn][in_work[:turn]]))
        began = counts * round(phase / counts)
        up = seen[turn:][in_work[turn:]] - began
        rest = positions[last + 1 : after]
        errors = np.abs(seen - began)
        found.append(
            Pass(
                float(np.max(errors[in_work])),
                float(np.max(np.abs(up))),
                phase - began,
                float(top - positions[first : last + 1].min()) / STEPS_PER_MM,
                int(positions[last]) - top,
                int(np.count_nonzero(np.diff(rest) < 0)),
                float(np.max(errors)),
                float(np.max(way[errors > WITHIN], initial=0)) * PITCH / counts,
            )
        )
    return found


def play(text: str, engine: str = "model", more: str = "", head: str = MACHINE) -> Played:
    """A program on the machine of this page, or one that begins with `head`; `more`: lines of its axis Z.

    Ctrl-C ends it with what is played.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        axes = "".join(AXIS.format(letter, STEPS_PER_MM if letter == "Z" else 80) for letter in "XYZ")
        (folder / "machine.toml").write_text(head + axes + more)
        (folder / "part.nc").write_text(text)
        machine = read_machine(folder / "machine.toml")
        part = read_part(folder / "part.nc", machine)
        with (
            open_engine(engine, core_of(machine), machine.clock_hz) as core,
            progress("tapping", part.chords) as report,
        ):
            return play_part(part, machine, core, report)


def main() -> int:
    """Play and print."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--passes", type=int, default=PASSES)
    asked.add_argument("--engine", default="model", choices=("model", "rtl", "both"))
    options = asked.parse_args()
    played = play(program(options.passes), options.engine)
    passes = judge(played)
    print(f"M{PITCH} at {RPM} rpm, wandering by {WANDER} %, {COUNTS} counts a turn; to {RPM} rpm in "
          f"{START_UP * RPM / 1000:g} s")  # fmt: skip
    print(f"{APPROACH:g} mm to come up to speed and to rest")
    print(
        "pass  deepest, mm  error, counts  on the way up  phase, counts  at the end  off above  settled, mm"
    )
    for number, one in enumerate(passes, 1):
        figures = f"{one.deepest:11.4f}  {one.error:13.3f}  {one.back:13.3f}  {one.phase:13.3f}"
        print(f"{number:4}  {figures}  {one.end:10}  {one.off:9.1f}  {one.settled:11.3f}")
    if played.canceled:
        return 1
    spread = max(one.phase for one in passes) - min(one.phase for one in passes)
    error = max(one.error for one in passes)
    settled = max(one.settled for one in passes)
    print(f"within {WITHIN:g} count from {settled:.2f} mm below the top on")
    print(f"greatest error {error:.3f} counts; phases within {spread:.3f} counts of {COUNTS}")
    good = error <= WITHIN and spread <= WITHIN and all(one.end == one.late == 0 for one in passes)
    return not (good and len(passes) == options.passes and not played.problems())


if __name__ == "__main__":
    sys.exit(ended(main))
