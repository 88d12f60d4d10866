# SPDX-License-Identifier: MIT
"""What a servo thread on Linux can rely on (linux/passo_servo.h): clocks that differ, gaps, deaths."""

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.engine import Engine, model_engine, moves_of
from passo.native import ffi, planner
from passo.registers import Cause

from benchmarks.hosts import Counted
from tests.helpers.driver_wire import Noise

CLOCK_HZ, SCLK_HZ = 16_000_000, 4_000_000  # two clocks per level
AXES, SCALE, PERIOD = 3, 800, 0.001
SPEED, ACCELERATION = 100.0, 2000.0  # mm/s, mm/s^2 of an axis; half of the latter for the commands
PINS = {"step_high_ns": 1000, "step_low_ns": 1000, "dir_setup_ns": 500, "dir_hold_ns": 500}
UNIT = float(1 << 32)
MICROSECOND = 1e-6

Command = Callable[[float], Sequence[float]]  # mm of each axis at a time in s


@dataclass(frozen=True)
class Setting:
    """A machine and its servo thread."""

    axes: int = AXES
    scale: float = SCALE  # steps/mm
    period: float = PERIOD
    speed: float = SPEED
    acceleration: float = ACCELERATION
    buffer: int = 0
    clock_hz: int = CLOCK_HZ
    inputs: bool = True

    @property
    def core(self) -> Parameters:
        """Of the core."""
        return Parameters(axes=self.axes, clock_hz=self.clock_hz, inputs=self.inputs)

    def options(self) -> Any:
        """`struct passo_servo_options`."""
        limit = (round(self.speed * self.scale * UNIT), round(self.acceleration * self.scale * UNIT))
        found = ffi().new("struct passo_servo_options *")
        found.period_ns, found.buffer, found.axes = round(self.period * 1e9), self.buffer, self.axes
        for axis in range(self.axes):
            found.axis[axis].speed, found.axis[axis].acceleration = limit
        return found


class Servo:
    """A servo thread whose clock is `ppm` fast beside that of the core."""

    def __init__(self, engine: Engine, setting: Setting, ppm: float = 0, noise: Noise | None = None):
        """Open the core and start."""
        self.engine, self.setting = engine, setting
        self.wire = Counted(engine, noise)
        self.driver = Driver(self.wire, tries=20)
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
    words: int
    slowed: int
    positions: list[int]
    cause: str

    @property
    def commands(self) -> np.ndarray:
        """The commands in steps, call x axis."""
        return np.floor(self.places * self.setting.scale + 0.5).astype(int)

    def at(self, axis: int, clocks: np.ndarray) -> np.ndarray:
        """Steps of an axis up to these clocks."""
        found = np.concatenate([[0], np.cumsum(moves_of(self.pins, axis))])
        return found[np.searchsorted(self.pins["clock"], clocks, "right")]

    def passes(self, tick: int = 32) -> np.ndarray:
        """Periods after its command at which all axes pass each place at once, within a step; NaN: not.

        Each is sought from the time of the one before; places at which the axes rest are left out.
        """
        times = np.arange(int(self.pins["clock"][0]), int(self.pins["clock"][-1]) + 1, tick)
        steps = np.stack([self.at(axis, times) for axis in range(self.setting.axes)], axis=1)
        commands, begin, window = self.commands, 0, round(4 * self.period / tick)
        found = np.full(len(commands), np.nan)
        for call in range(1, len(commands)):
            if np.array_equal(commands[call], commands[call - 1]):
                continue
            for first in range(begin, len(times), window):
                off = np.abs(steps[first : first + window] - commands[call]).max(axis=1)
                if off.min() <= 1:
                    begin = first + int(off.argmin())
                    found[call] = (times[begin] - self.begun) / self.period - call
                    break
            else:
                return found
        return found

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
        """The highest one over some seconds, mm/s^2, less what the rounding of steps can make."""
        clock_hz, scale = self.setting.clock_hz, self.setting.scale
        length = round(window * clock_hz)
        first, last = int(self.pins["clock"][0]), int(self.pins["clock"][-1])
        times = np.arange(first, last + 2 * length, length // 8)
        place = self.at(axis, times)
        change = np.abs(place[16:] - 2 * place[8:-8] + place[:-16])
        return float(max(0, change.max() - 2)) / scale / window**2


def waves(axes: int, seconds: float, speed: float = SPEED, acceleration: float = ACCELERATION / 2) -> Command:
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
    """Wakes that are late by up to 1 ms, and `count` gaps of so many s, after which the calls catch up."""
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
        words, count = servo.wire.words, min(die, round((seconds + settle) / setting.period))
        places, depths, trims = np.zeros((count, setting.axes)), np.zeros(count), np.zeros(count)
        for call in range(count):
            places[call] = command(min(call * setting.period, seconds))
            servo.call(places[call], late(call))
            servo.driver.positions()
            depths[call], trims[call] = servo.c.depth, servo.c.trim
        sent = servo.wire.words - words
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
            sent,
            servo.c.slowed,
            servo.driver.positions()[: setting.axes],
            Cause(servo.driver.snapshot().cause).name,
        )
