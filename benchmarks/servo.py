# SPDX-License-Identifier: MIT
"""What a servo thread on Linux can rely on (linux/passo_servo.h): clocks that differ, gaps, deaths.

    python -m benchmarks.servo [SEED]

Three axes at 1 kHz on the C model, judged at the pins.
"""

import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.console import stages
from passo.driver import Driver, DriverError
from passo.ending import ended
from passo.engine import Engine, model_engine, moves_of
from passo.native import ffi, planner
from passo.registers import Cause
from passo.toolchain import paths

from benchmarks.hosts import Counted
from tests.helpers.driver_wire import Noise
from tests.helpers.serving import serving

CLOCK_HZ, SCLK_HZ = 16_000_000, 4_000_000  # two clocks per level
AXES, SCALE, PERIOD = 3, 800, 0.001
SPEED, ACCELERATION, STOP = 100.0, 1000.0, 1000.0  # mm/s, mm/s^2 of an axis: commands, and beyond them
HARDEST = ACCELERATION + STOP
PINS = {"step_high_ns": 1000, "step_low_ns": 1000, "dir_setup_ns": 500, "dir_hold_ns": 500}
UNIT = float(1 << 32)
MICROSECOND = 1e-6
PPM, ERRORS, GAP = 200, 1e-4, (0.002, 0.05)
LAGS = 6  # periods about the lag in which a place is sought
CONSTANT = 1.0  # periods that it differs from what is stated
LATE = 3  # periods beyond the lag: the queue is read once in a period, and the core begins within another
ROUNDING = 1.01  # of what is computed from steps
ROUNDING_PPM = 125.0  # a substep of a line
SHARE_MAX = 0.2  # of the wire
COST_CALLS = 1000, 3000

Command = Callable[[float], Sequence[float]]  # mm of each axis at a time in s


@dataclass(frozen=True)
class Setting:
    """A machine and its servo thread."""

    axes: int = AXES
    scale: float = SCALE  # steps/mm
    period: float = PERIOD
    speed: float = SPEED
    acceleration: float = ACCELERATION
    stop: float = STOP
    buffer: int = 0
    clock_hz: int = CLOCK_HZ
    inputs: bool = True
    outputs: bool = False

    @property
    def core(self) -> Parameters:
        """Of the core."""
        return Parameters(axes=self.axes, clock_hz=self.clock_hz, inputs=self.inputs, outputs=self.outputs)

    def options(self) -> Any:
        """`struct passo_servo_options`."""
        limits = [round(value * self.scale * UNIT) for value in (self.speed, self.acceleration, self.stop)]
        found = ffi().new("struct passo_servo_options *")
        found.period_ns, found.buffer, found.axes = round(self.period * 1e9), self.buffer, self.axes
        for axis in range(self.axes):
            found.axis[axis] = limits
        return found


class Servo:
    """A servo thread whose clock is `ppm` fast beside that of the core."""

    def __init__(self, engine: Engine, setting: Setting, ppm: float = 0, noise: Noise | None = None):
        """Open the core and start."""
        self.engine, self.setting = engine, setting
        self.driver = Driver(Counted(engine, noise) if noise else engine, tries=20)
        for axis in range(setting.axes):
            self.driver.call("configure_axis", axis, ffi().new("struct passo_axis_config *", PINS))
            self.driver.call("enable", axis, True)
        self.c = ffi().new("struct passo_servo *")
        self._lib, self.options = planner(), setting.options()
        self.check()
        self._commands = ffi().new("int64_t[8]")
        self.period = setting.period * setting.clock_hz / (1 + ppm * MICROSECOND)  # clocks of the core
        self.begun = float(engine.clock)
        self.calls = 0
        self.events = [engine.drain()]

    def check(self) -> None:
        """Raise DriverError for what is wrong."""
        error = self._lib.passo_servo_check(self.c, self.driver.c, self.options)
        if error:
            raise DriverError("servo_check", error, f"problem {self.c.problem}, axis {self.c.axis}")

    def start(self) -> None:
        """Take over from rest."""
        self._call("start", self._lib.passo_servo_start(self.c))
        self.begun, self.calls = float(self.engine.clock), 0

    def wait_until(self, clock: float) -> None:
        """Let time pass."""
        while self.engine.clock < round(clock):
            self.engine.run(round(clock) - self.engine.clock)
            self.events.append(self.engine.drain())

    def call(self, places: Sequence[float], late: float = 0) -> None:
        """The next call of the thread, in mm, late by some seconds."""
        self.wait_until(self.begun + self.calls * self.period + late * self.setting.clock_hz)
        for axis, place in enumerate(places):
            self._commands[axis] = round(place * self.setting.scale * UNIT)
        self.calls += 1
        self._call("write", self._lib.passo_servo_write(self.c, self._commands))

    def stop(self) -> None:
        """A soft stop."""
        self._call("stop", self._lib.passo_servo_stop(self.c))

    @property
    def pins(self) -> np.ndarray:
        """All events so far."""
        self.events.append(self.engine.drain())
        self.events = [np.concatenate(self.events)]
        return self.events[0]

    def _call(self, name: str, error: int) -> None:
        if error:
            raise DriverError(f"servo_{name}", error)


def steps_at(pins: np.ndarray, axis: int, clocks: np.ndarray) -> np.ndarray:
    """Steps of an axis up to these clocks."""
    found = np.concatenate([[0], np.cumsum(moves_of(pins, axis))])
    return found[np.searchsorted(pins["clock"], clocks, "right")]


def passes(pins: np.ndarray, commands: np.ndarray, begun: float, period: float, tick: int = 32) -> np.ndarray:
    """Periods after its command at which all axes are within a step of its place together; NaN: never.

    `commands` are steps, call x axis; `begun` and `period` are clocks. Each is sought, to `tick` clocks, from
    the time of the one before; places at which the axes rest are left out.
    """
    times = np.arange(int(pins["clock"][0]), int(pins["clock"][-1]) + 1, tick)
    steps = np.stack([steps_at(pins, axis, times) for axis in range(commands.shape[1])], axis=1)
    begin, window = 0, round(4 * period / tick)
    found = np.full(len(commands), np.nan)
    for call in range(1, len(commands)):
        if np.array_equal(commands[call], commands[call - 1]):
            continue
        for first in range(begin, len(times), window):
            off = np.abs(steps[first : first + window] - commands[call]).max(axis=1)
            if off.min() <= 1:
                begin = first + int(off.argmin())
                found[call] = (times[begin] - begun) / period - call
                break
        else:
            return found
    return found


@dataclass
class Run:
    """A motion and what became of it."""

    setting: Setting
    lag: int
    pins: np.ndarray
    begun: float  # clocks
    period: float  # of the thread, clocks of the core
    places: np.ndarray  # commands, call x axis
    depths: np.ndarray
    trims: np.ndarray
    slowed: int
    positions: list[int]
    cause: str

    @property
    def commands(self) -> np.ndarray:
        """The commands in steps, call x axis."""
        return np.floor(self.places * self.setting.scale + 0.5).astype(int)

    def at(self, axis: int, clocks: np.ndarray) -> np.ndarray:
        """Steps of an axis up to these clocks."""
        return steps_at(self.pins, axis, clocks)

    def passes(self) -> np.ndarray:
        """Periods after its command at which all axes are within a step of its place together; NaN: never."""
        return passes(self.pins, self.commands, self.begun, self.period)

    @property
    def lags(self) -> np.ndarray:
        """Periods after its command at which an axis with half its speed or more passes the place."""
        found, wanted = [], self.places * self.setting.scale
        for axis in range(self.setting.axes):
            moves = moves_of(self.pins, axis)
            clocks = self.pins["clock"][moves != 0].astype(float)
            steps = np.cumsum(moves[moves != 0])
            change = np.gradient(wanted[:, axis]) / self.setting.period
            for call in np.flatnonzero(np.abs(change) > self.setting.speed * self.setting.scale / 2):
                about = self.begun + (call + self.lag) * self.period
                ends = about - LAGS * self.period, about + LAGS * self.period
                near = slice(*np.searchsorted(clocks, ends))
                way = np.sign(change[call])
                clock = np.interp(way * wanted[call, axis], way * steps[near], clocks[near])
                found.append((clock - self.begun) / self.period - call)
        return np.array(found)

    @property
    def moved(self) -> np.ndarray:
        """Calls whose command differs from the one before."""
        return np.flatnonzero(np.any(np.diff(self.commands, axis=0, prepend=self.commands[:1]) != 0, axis=1))

    @property
    def hardest(self) -> float:
        """The highest acceleration of an axis over 2 to 20 ms, mm/s^2."""
        windows = (0.002, 0.005, 0.01, 0.02)
        return max(self.acceleration(axis, window) for axis in range(self.setting.axes) for window in windows)

    @property
    def made(self) -> list[int]:
        """Steps at the pins."""
        return [int(moves_of(self.pins, axis).sum()) for axis in range(self.setting.axes)]

    def acceleration(self, axis: int, window: float) -> float:
        """The highest one over some seconds, mm/s^2, less what the rounding of steps can make.

        Commands are rounded to steps, and steps to their places in a line: each position by up to one step.
        """
        clock_hz, scale = self.setting.clock_hz, self.setting.scale
        length = round(window * clock_hz)
        first, last = int(self.pins["clock"][0]), int(self.pins["clock"][-1])
        times = np.arange(first, last + 2 * length, length // 8)
        place = self.at(axis, times)
        change = np.abs(place[16:] - 2 * place[8:-8] + place[:-16])
        return float(max(0, change.max() - 4)) / scale / window**2


def waves(axes: int, seconds: float, speed: float = SPEED, acceleration: float = ACCELERATION) -> Command:
    """Sines from rest to rest, of a different pace per axis; each comes near one of the two limits."""
    grid = np.linspace(0, seconds, round(seconds * 2000) + 1)
    window = np.clip(np.minimum(grid, seconds - grid) / (0.2 * seconds), 0, 1)
    window = window**3 * (10 - 15 * window + 6 * window**2)
    shapes = [window * np.sin(2 * np.pi * (0.8 + 1.1 * axis) * grid) for axis in range(axes)]
    ratios = [
        min(speed / np.abs(np.gradient(v, grid)).max(), acceleration / np.abs(second(v, grid)).max())
        for v in shapes
    ]
    places = np.stack([0.98 * ratio * shape for ratio, shape in zip(ratios, shapes, strict=True)], axis=1)

    def at(time: float) -> list[float]:
        return [float(np.interp(time, grid, places[:, axis])) for axis in range(axes)]

    return at


def second(values: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Its second derivative."""
    return np.gradient(np.gradient(values, grid), grid)


def gaps(
    seed: int, setting: Setting, seconds: float, count: int, size: tuple[float, float]
) -> Callable[[int], float]:
    """Wakes that are late by up to 1 ms, and `count` gaps of `size` s, after which the calls catch up."""
    rng = random.Random(seed)
    at = set(rng.sample(range(100, round(seconds / setting.period)), count))
    until = 0.0

    def late(call: int) -> float:
        nonlocal until
        if call in at:
            until = max(until, call * setting.period + rng.uniform(*size))
        return max(rng.uniform(0, 0.001), until - call * setting.period)

    return late


def run(
    setting: Setting,
    seconds: float,
    command: Command,
    ppm: float = 0,
    late: Callable[[int], float] = lambda call: 0,
    noise: Noise | None = None,
    settle: float = 1,
    die: int = 1 << 30,
) -> Run:
    """Follow a command; `late`: seconds by which a call comes late, after which the thread catches up.

    `die`: the number of the call after which there are no more, nor any frame for a second.
    """
    with model_engine(setting.core, setting.clock_hz) as engine:
        servo = Servo(engine, setting, ppm, noise)
        servo.start()
        count = min(die, round((seconds + settle) / setting.period))
        places, depths, trims = np.zeros((count, setting.axes)), np.zeros(count), np.zeros(count)
        for call in range(count):
            places[call] = command(min(call * setting.period, seconds))
            servo.call(places[call], late(call))
            servo.driver.positions()
            depths[call], trims[call] = servo.c.depth, servo.c.trim
        if count < die:
            servo.stop()
        servo.wait_until(engine.clock + setting.clock_hz * (1 if count == die else 0.5))
        return Run(
            setting,
            servo.c.lag,
            servo.pins,
            servo.begun,
            servo.period,
            places,
            depths,
            trims,
            servo.c.slowed,
            servo.driver.positions()[: setting.axes],
            Cause(servo.driver.snapshot().cause).name,
        )


SLOW = Setting(
    axes=2, scale=50, period=0.05, clock_hz=1_000_000, inputs=False, speed=50, acceleration=200, stop=200
)
CHUNK = 5000  # calls
OFF_MAX = 1  # lines that the queue may differ from the lag
SETTLED = 1500  # s: by then the loop has the difference of the clocks


@dataclass(frozen=True)
class Long:
    """Hours of a thread whose clock is PPM fast, on a slow core."""

    hours: float
    lost: int  # steps by which pins, core and the last command differ
    off: int  # lines that the queue differs from the lag, at most, once the loop has settled
    trim: float  # ppm by which the lines are longer, at the end


def long(hours: float, ppm: float = PPM) -> Long:
    """Follow two sines; the steps at the pins are counted as they come."""
    count, made, off = round(hours * 3600 / SLOW.period), np.zeros(SLOW.axes, int), 0
    with model_engine(SLOW.core, SLOW.clock_hz) as engine:
        servo = Servo(engine, SLOW, ppm)
        servo.start()

        def collect(before: np.ndarray) -> np.ndarray:
            events = np.concatenate([before, servo.pins])
            made[:] += [int(moves_of(events, axis)[len(before) :].sum()) for axis in range(SLOW.axes)]
            servo.events = [events[:0]]
            return events[-1:]

        last, place = servo.events[0][:0], [0.0, 0.0]
        for call in range(count + round(1 / SLOW.period)):
            time = min(call, count) * SLOW.period
            place = [5 * np.sin(time), 2 * np.sin(2.3 * time)]
            servo.call(place)
            if call * SLOW.period > SETTLED:
                off = max(off, abs(servo.c.depth - servo.c.lag))
            if call % CHUNK == 0:
                last = collect(last)
        trim = servo.c.trim / 1000
        servo.stop()
        servo.wait_until(engine.clock + SLOW.clock_hz)
        collect(last)
        wanted = np.floor(np.array(place) * SLOW.scale + 0.5).astype(int)
        positions = np.array(servo.driver.positions()[: SLOW.axes])
    return Long(hours, int(max(np.abs(positions - made).max(), np.abs(wanted - made).max())), off, trim)


# Beside hostmot2's design: axes that bear more, and a shorter period on a faster wire
BESIDE = (
    *(Setting(stop=stop, buffer=1) for stop in (1000.0, 10_000.0, 40_000.0)),
    Setting(stop=40_000.0, buffer=1, period=PERIOD / 4, clock_hz=3 * CLOCK_HZ),
)


@dataclass(frozen=True)
class Beside:
    """A design and the same trajectories and wakes."""

    name: str
    lag: float  # ms
    following: float  # mm, the greatest following error
    hardest: float  # mm/s^2
    off: float  # mm from the commanded path


def off_path(found: np.ndarray, places: np.ndarray) -> float:
    """The greatest distance of places, time x axis, from a path of commands, mm."""
    parts = np.linspace(0, 1, 4, endpoint=False)[:, None, None]
    path = (places[:-1] * (1 - parts) + places[1:] * parts).transpose(1, 0, 2).reshape(-1, places.shape[1])
    away = np.empty(len(found))
    for first in range(0, len(found), 64):
        part = found[first : first + 64]
        away[first : first + 64] = np.linalg.norm(part[:, None] - path[None], axis=2).min(axis=1)
    return float(away.max())


def one_period(seconds: float, command: Command, late: Callable[[int], float]) -> Beside:
    """hostmot2's design: each call reads the axes, and sets rates that lead to its command in a period.

    The rates change by at most 1.25 times the acceleration of the commands, and last until the next call. A
    call that is late is followed immediately by those that became due.
    """
    change, count = 1.25 * ACCELERATION * PERIOD, round((seconds + 0.2) / PERIOD)
    place = np.array(command(0.0))
    rate, now, errors, times, track, commands = np.zeros_like(place), 0.0, [], [0.0], [place], []
    for call in range(count):
        then = max(now, call * PERIOD + late(call))
        place, now = place + rate * (then - now), then
        wanted = np.array(command(min(call * PERIOD, seconds)))
        rate = np.clip((wanted - place) / PERIOD, rate - change, rate + change)
        errors.append(float(np.abs(wanted - place).max()))
        times.append(now)
        track.append(place)
        commands.append(wanted)
    grid = np.arange(0, now, PERIOD / 4)
    places = np.stack([np.interp(grid, times, np.array(track)[:, axis]) for axis in range(AXES)], axis=1)
    second = np.abs(places[16:] - 2 * places[8:-8] + places[:-16]).max() / (8 * PERIOD / 4) ** 2
    return Beside(
        "hostmot2's design", 1, max(errors), float(second), off_path(places[::8], np.array(commands))
    )


def beside(seed: int, seconds: float = 2, count: int = 8) -> list[Beside]:
    """Both designs, with wakes that are late by up to a tenth of a period, then with gaps as well."""
    command, found = waves(AXES, seconds), []
    wakes: dict[str, Callable[[Setting], Callable[[int], float]]] = {
        "": lambda setting: late_by(seed, 0.1 * setting.period),
        ", gaps": lambda setting: gaps(seed, setting, seconds, count, GAP),
    }
    for name, late in wakes.items():
        for setting in BESIDE:
            one = run(setting, seconds, command, 0, late(setting), settle=2)
            clocks = np.arange(int(one.pins["clock"][0]), int(one.pins["clock"][-1]), setting.clock_hz // 500)
            places = np.stack([one.at(axis, clocks) / SCALE for axis in range(AXES)], axis=1)
            off = off_path(places, one.places[:: round(PERIOD / setting.period)])
            faster = "" if setting.period == PERIOD else f" at {1 / setting.period / 1000:g} kHz"
            label = f"stop of {setting.stop:,g} mm/s²{faster}{name}"
            found.append(Beside(label, one.lag * setting.period * 1000, following(one), one.hardest, off))
        made = one_period(seconds, command, late(Setting()))
        found.append(replace(made, name=made.name + name))
    return found


def late_by(seed: int, most: float) -> Callable[[int], float]:
    """Wakes that are late by up to `most` s."""
    rng = random.Random(seed)
    return lambda call: rng.uniform(0, most)


def cost(axes: int = 6) -> tuple[float, float]:
    """Instructions of a call without those of the kernel, NaN without valgrind, and words on the wire."""
    folders = (paths.linux, paths.driver, paths.planner, paths.protocol)
    program = paths.build / "servo_cost"
    sources = [file for folder in folders for file in sorted(folder.glob("*.c"))]
    includes = [f"-I{folder}" for folder in folders]
    main = Path(__file__).with_suffix(".c").with_stem("servo_cost")
    subprocess.run(["cc", "-O2", *includes, main, *sources, "-o", program, "-lm"], check=True)
    counts, words = [], []
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    tool = valgrind if shutil.which("valgrind") else []
    for calls in COST_CALLS:
        with (
            tempfile.TemporaryDirectory() as folder,
            model_engine(Parameters(axes=axes, clock_hz=CLOCK_HZ), CLOCK_HZ) as engine,
        ):
            place = Path(folder) / "core"
            with serving(engine, place):
                done = subprocess.run(
                    [*tool, program, f"unix:{place}", str(axes), str(calls)], capture_output=True, text=True
                )
        counted = re.search(r"Collected : (\d+)", done.stderr)
        counts.append(int(counted[1]) if counted else np.nan)
        words.append(int(done.stdout.split()[1]))
        assert done.stdout.startswith("OK "), done.stdout
    more = COST_CALLS[1] - COST_CALLS[0]
    return (counts[1] - counts[0]) / more, (words[1] - words[0]) / more


@dataclass(frozen=True)
class Figures:
    """What was measured."""

    lag: int  # periods
    late: float  # periods by which a place is passed after its command, at most
    lags: tuple[float, float]  # at half the speed or more: least and most
    lost: int  # steps
    hardest: float  # mm/s^2, in step
    trim_step: float  # ppm by which a line differs from the one before, at most, by the loop
    gaps: int
    gaps_hardest: float
    gaps_slowed: int
    gaps_off: bool  # a place was not passed
    flips: int
    causes: dict[str, int]  # of the stops after a death
    deaths_hardest: float
    designs: list[Beside]
    instructions: float  # of a call of six axes, without those of the kernel
    bytes_per_call: float  # of an axis, if all is read in each call


def measure(seed: int, seconds: float = 20, count: int = 100, deaths: int = 20) -> Figures:
    """Run everything but the hours; `count` gaps."""
    setting, command = Setting(), waves(AXES, seconds)
    rng = random.Random(seed)
    wakes = gaps(seed, setting, seconds, 0, GAP)
    noise = Noise(rng, ERRORS)
    steady = [run(setting, seconds, command, ppm, wakes) for ppm in (-PPM, PPM)]
    steady.append(run(setting, seconds, command, PPM, wakes, noise))
    late = run(setting, seconds, command, PPM, gaps(seed, setting, seconds, count, GAP), settle=4)
    ends = []
    for _ in range(deaths):
        end = run(setting, seconds, command, rng.choice((-PPM, PPM)), wakes, die=rng.randrange(200, 3000))
        ends.append((end.cause, end.hardest, lost(end)))
    passed = [found.passes()[found.moved] for found in steady]
    lags = np.concatenate([found.lags for found in steady])
    instructions, words = cost()
    causes = [cause for cause, _, _ in ends]
    return Figures(
        steady[0].lag,
        max(np.inf if np.isnan(one).any() else float(one.max()) for one in passed),
        (float(lags.min()), float(lags.max())),
        max(*(lost(found) for found in (*steady, late)), *(steps for _, _, steps in ends)),
        max(found.hardest for found in steady),
        max(float(np.abs(np.diff(found.trims)).max()) for found in steady) / 1000,
        count,
        late.hardest,
        late.slowed,
        bool(np.isnan(late.passes()[late.moved]).any()),
        noise.flips,
        {cause: causes.count(cause) for cause in sorted(set(causes))},
        max(hardest for _, hardest, _ in ends),
        beside(seed),
        instructions,
        words * 4 / 6,
    )


def lost(found: Run) -> int:
    """Steps by which pins, core and, at the end of a command, its last place differ."""
    off = [abs(a - b) for a, b in zip(found.positions, found.made, strict=True)]
    if found.cause == Cause.STOP.name:
        off += [abs(a - b) for a, b in zip(found.made, found.commands[-1].tolist(), strict=True)]
    return max(off)


def following(found: Run) -> float:
    """The greatest distance of an axis from its command at the time of a call, mm."""
    calls = np.arange(len(found.places))
    clocks = (found.begun + calls * found.period).astype(np.int64)
    return max(
        float(np.abs(found.at(axis, clocks) - found.commands[:, axis]).max()) / found.setting.scale
        for axis in range(found.setting.axes)
    )


def is_constant(found: Figures) -> bool:
    """The lag is the stated one."""
    return max(abs(lag - found.lag) for lag in found.lags) <= CONSTANT


def good(found: Figures) -> bool:
    """All promises are kept."""
    exact = found.lost == 0 and not found.gaps_off
    soft = found.hardest <= ACCELERATION * ROUNDING
    soft = soft and max(found.gaps_hardest, found.deaths_hardest) <= HARDEST * ROUNDING
    in_step = found.late <= found.lag + LATE and found.trim_step < ROUNDING_PPM and is_constant(found)
    return exact and soft and in_step and set(found.causes) == {Cause.WATCHDOG.name}


def main() -> int:
    """Print the figures; 1 if one of them is not as promised."""
    tell = stages()
    tell("servo: all figures")
    found = measure(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
    tell.end()
    for line in (
        f"clocks {PPM} ppm apart, wakes late by up to 1 ms, bit errors of {ERRORS:g} ({found.flips} bits):",
        f"    every place within a step at most {found.late:.1f} periods after its command; lag {found.lag}",
        f"    lag at half the speed or more {found.lags[0]:.1f} to {found.lags[1]:.1f} periods",
        f"    steps lost: {found.lost}; acceleration {found.hardest:.0f} of {ACCELERATION:g} mm/s^2",
        f"    the loop changes a line by at most {found.trim_step:.1f} ppm; rounding: {ROUNDING_PPM:g} ppm",
        f"gaps of {GAP[0]:g} to {GAP[1]:g} s slow {found.gaps_slowed} times: {found.gaps_hardest:.0f} mm/s^2",
        f"deaths of the host: {found.causes}; {found.deaths_hardest:.0f} mm/s^2",
        f"a call of six axes: {found.instructions:.0f} instructions, "
        f"{found.bytes_per_call:.1f} bytes per axis",
        *(
            f"{one.name}: lag {one.lag:g} ms, following error {one.following:.2f} mm, "
            f"{one.hardest:.0f} mm/s^2, off the path {one.off:.3f} mm"
            for one in found.designs
        ),
    ):
        print(line, flush=True)
    return int(not good(found))


if __name__ == "__main__":
    sys.exit(ended(main))
