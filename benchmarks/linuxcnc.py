# SPDX-License-Identifier: MIT
"""Programs in a headless LinuxCNC, on the C model and on the Verilated core.

    python -m benchmarks.linuxcnc

Each command of each period is judged: the axes are within a step of it after the stated lag.
"""

import sys
from dataclasses import dataclass, field

import numpy as np
from passo.console import stages
from passo.ending import ended
from passo.engine import moves_of

from benchmarks.servo import CLOCK_HZ, LATE, PERIOD, passes
from tests.helpers.linuxcnc import Result, number_of, run_linuxcnc

ARCS = """
G21 G90 G17 G64 P0.01
G0 X60 Y60 Z74
G1 F6000 X80
G2 I15 J0
G3 X110 Y90 I15 J15
G1 X60 Y70
G0 X50 Y50 Z73
M2
"""


def short_lines(count: int, place: int = 60, size: float = 1) -> str:
    """A program of lines of 0.25 mm, times `size`, on a curve around a place of X and Y, to its right end."""
    angles = np.linspace(0, 40 * np.pi * count / 20_000, count)
    radii = size * (40 + 8 * np.sin(7.3 * angles))
    points = [
        f"X{place + radius * np.cos(angle):.4f} Y{place + radius * np.sin(angle):.4f}"
        for radius, angle in zip(radii, angles, strict=True)
    ]
    end, level = f"G1 X{place + 40 * size:g} Y{place}", 74 if size == 1 else 1
    return "\n".join(["G21 G90 G64 P0.01", f"G1 F6000 Z{level}", *(f"G1 {p}" for p in points), end, "M2", ""])


LATHE = """
host = "linuxcnc"
clock_hz = 16_000_000
spindle_maximum = 300
[spindle]
counts = 4000
[pins]
step_high = "2 us"
step_low = "2 us"
[[axis]]
name = "X"
steps_per_mm = 200
speed = 50
acceleration = 500
[[axis]]
name = "Z"
steps_per_mm = 200
speed = 80
acceleration = 500
"""
THREADS = """
G21 G90 G18
G0 X5 Z15
M3 S300
G33 Z8 K1
G0 X6
G0 Z16
G0 X5
G33 Z8 K1
M9
G61
G0 X6
G0 Z16
G0 X5
G33 Z8 K1
M5
G0 X8 Z2
M2
"""
OFF_THREAD = 0.005  # mm
PITCH = 0.0005  # of the pitch: the loop makes up a line or two
TURNS = 5  # per s
# LinuxCNC begins in the period after the index, and takes the phase, in whole periods, when its axis has the
# speed of the thread; a line of the core is one more
OFF_BEGIN = 2 * TURNS * PERIOD  # turns
# by then the axis is behind the spindle by v^2 / (2 a); in G64 LinuxCNC halves a if it knows no move behind
# the pass, as before M9
BEHIND = TURNS**2 / (2 * 500) * np.array([1, 2, 1])
LONG = 4 * 3600  # s that a program may take, on a busy computer
TICK = 160  # clocks: less than a step
ALIGN = range(0, 1000)  # periods from the start of the core to the first sample


def begun(found: Result, scales: list[float]) -> float:
    """The clock of the core at the first sample, by the counts of the core in all of them."""
    clocks = round(PERIOD * CLOCK_HZ)
    places = found.samples[:, len(scales) :] * scales
    moving = np.flatnonzero(np.any(np.diff(places, axis=0), axis=1))
    chosen = moving[np.linspace(0, len(moving) - 1, 400).astype(int)]

    made = [np.concatenate([[0], np.cumsum(moves_of(found.events, axis))]) for axis in range(len(scales))]
    steps = np.stack(made, axis=1)

    def off(begin: float) -> float:
        then = np.searchsorted(found.events["clock"], begin + chosen * clocks, "right")
        return float(np.abs(steps[then] - places[chosen]).sum())

    best = min((number * clocks for number in ALIGN), key=off)
    return min((best + part * clocks // 64 for part in range(-64, 65)), key=off)


def delays(found: Result, scales: list[float]) -> np.ndarray:
    """Periods from each command that moves to when all axes are within a step of it; NaN: never."""
    commands = np.floor(found.samples[:, : len(scales)] * scales + 0.5).astype(int)
    moved = np.flatnonzero(np.any(np.diff(commands, axis=0, prepend=commands[:1]) != 0, axis=1))
    return passes(found.events, commands, begun(found, scales), PERIOD * CLOCK_HZ, TICK)[moved]


def is_in_step(found: Result, scales: list[float]) -> bool:
    """Each command is reached, at most LATE periods after the lag that the component states."""
    lag = number_of(found.pins["passo.0.queue.lag"])
    late = delays(found, scales)
    return bool(np.all(late <= lag + LATE))


@dataclass(frozen=True)
class Threads:
    """Passes of G33 by the pins: place against the angle of the spindle."""

    pitches: list[float]
    off: float  # mm from the even thread of a pass
    phases: list[float]  # turns by which a pass is off the first one, less what LinuxCNC makes of it


def threads(found: Result) -> Threads:
    """Those of THREADS, of axis 1, from place 14 to 9."""
    steps = moves_of(found.events, 1)
    turns = np.interp(found.events["clock"][steps != 0], found.turns, np.arange(len(found.turns)))
    places = np.cumsum(steps[steps != 0]) / 200
    inside = (places > 9) & (places < 14) & (np.diff(places, append=0) < 0)
    passes = [one for one in np.split(np.arange(len(places)), np.flatnonzero(~inside)) if len(one) > 900]
    fits = [np.polyfit(turns[one[1:]], places[one[1:]], 1) for one in passes]
    off = [
        np.abs(turns[one[1:]] * pitch + at - places[one[1:]]).max()
        for one, (pitch, at) in zip(passes, fits, strict=True)
    ]
    begins = np.array([(12 - at) / pitch for pitch, at in fits])
    phases = (begins - BEHIND[: len(begins)] - begins[0] + BEHIND[0] + 0.5) % 1 - 0.5
    return Threads([float(pitch) for pitch, _ in fits], float(max(off)), phases.tolist())


@dataclass(frozen=True)
class Program:
    """A program, and where it ends."""

    name: str
    text: str
    end: list[float]
    scales: list[float] = field(default_factory=lambda: [80, 80, 400])
    changes: dict[str, str] = field(default_factory=dict)  # of the configuration
    machine: str = ""  # the text of its file, unless it is the example
    engine: str = "both"  # model and Verilated core, compared on each edge


# Without homing, near the place where it is, for less time on the Verilated core
HOME_WHERE_IT_IS = {
    **{f"HOME_{key} = {value}\n": "" for key, value in {"SEARCH_VEL": -50, "LATCH_VEL": -2}.items()},
    **{"HOME_SEARCH_VEL = 20\n": "", "HOME_LATCH_VEL = 2\n": ""},
    **{f"HOME = {value}\n": "HOME = 0\n" for value in (5, 75)},
    "HOME_OFFSET = 80\n": "HOME_OFFSET = 0\n",
}


def programs(lines: int = 20_000) -> dict[str, Program]:
    """By the name of a part of `make hosts`."""
    shorter = short_lines(lines, place=10, size=0.2)
    return {
        "arcs": Program("homing on switches, circle and arcs at 6,000 mm/min", ARCS, [50, 50, 73]),
        "g33": Program("three passes of G33", THREADS, [8, 2], [200, 200], machine=LATHE),
        "lines": Program(f"{lines:,} lines of 0.25 mm", short_lines(lines), [100, 60, 74], engine="model"),
        "both": Program(f"{lines:,} lines of 0.05 mm", shorter, [18, 10, 1], changes=HOME_WHERE_IT_IS),
    }


@dataclass(frozen=True)
class Figures:
    """Of a program."""

    program: Program
    said: list[str]  # by LinuxCNC
    exact: bool  # it ended, where it should
    late: float  # periods from a command to the axes within a step of it, at most
    lag: int  # periods
    following: float  # mm, the greatest following error
    edges: int  # at the STEP pins
    threads: Threads | None

    @property
    def is_good(self) -> bool:
        """All promises are kept."""
        return (
            self.exact
            and not self.said
            and self.late <= self.lag + LATE
            and (not self.threads or fits(self.threads))
        )


def fits(found: Threads) -> bool:
    """Three passes in step with the spindle."""
    steady = all(abs(pitch + 1) <= PITCH for pitch in found.pitches)
    return (
        len(found.phases) == 3
        and steady
        and found.off < OFF_THREAD
        and max(map(abs, found.phases)) < OFF_BEGIN
    )


def measure(program: Program) -> Figures:
    """Run it."""
    found = run_linuxcnc(program.text, program.engine, program.changes, program.machine, seconds=LONG)
    done = found.homed and found.ended
    exact = done and bool(np.abs(np.array(found.positions) - program.end).max() < 1e-9)
    axes = range(len(program.scales))
    return Figures(
        program,
        found.said,
        exact,
        float(delays(found, program.scales).max()) if done else np.nan,
        round(number_of(found.pins.get("passo.0.queue.lag", "0"))),
        max(found.ferror or [np.nan]),
        sum(int(np.count_nonzero(moves_of(found.events, axis))) for axis in axes),
        threads(found) if done and program.text == THREADS else None,
    )


def figure(found: Figures) -> str:
    """What is printed."""
    said = "; ".join(found.said) or "no fault"
    text = f"{'end exact' if found.exact else 'WRONG'}, {said}, {found.edges:,} edges, "
    text += f"each command within a step after at most {found.late:.1f} periods, "
    text += f"following error {found.following:.2f} mm"
    if found.threads:
        phases = ", ".join(f"{phase:+.4f}" for phase in found.threads.phases)
        text += f"; off the thread {1000 * found.threads.off:.1f} um, phases {phases} turns"
    return text


def main() -> int:
    """Print the figures; 1 if one of them is not as promised."""
    kept = True
    tell = stages()
    for program in programs().values():
        tell(f"LinuxCNC: {program.name}")
        found = measure(program)
        print(f"{program.name}: {figure(found)}; lag {found.lag}", flush=True)
        kept = kept and found.is_good
    tell.end()
    return int(not kept)


if __name__ == "__main__":
    sys.exit(ended(main))
