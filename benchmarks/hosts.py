# SPDX-License-Identifier: MIT
"""What a host on Linux can rely on: timed points with late polls, bit errors, hosts that die; on the C model.

    python -m benchmarks.hosts [SEED]

Six axes at 1,000 points/s over an SPI of 4 MHz, polled 1,000 times/s; then an hour of points.
"""

import random
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from passo.build import Parameters
from passo.console import stages
from passo.driver import Driver
from passo.ending import ended
from passo.engine import AroundEngine, Engine, model_engine, moves_of
from passo.native import ffi
from passo.path import PathAxis, PathSettings
from passo.registers import State
from passo.timed import POINT

from tests.helpers.driver_wire import Noise

CLOCK_HZ, SCLK_HZ = 16_000_000, 4_000_000  # two clocks per level
AXES, SCALE, PERIOD = 6, 80, 0.001
CORE = Parameters(axes=AXES, clock_hz=CLOCK_HZ, inputs=1)
SETTINGS = PathSettings((PathAxis(SCALE, 200, 2000),) * AXES, CLOCK_HZ)
POLLS, GAPS, ERRORS, DEATHS = 1000, 100, 1e-4, 20
GAP = (0.002, 0.05)  # s
PINS = {"step_high_ns": 1000, "step_low_ns": 1000, "dir_setup_ns": 500, "dir_hold_ns": 500}
STOP = CLOCK_HZ // 20  # clocks of a soft stop
SILENCE = 1.5  # s after a death, longer than the watchdog
SHARE_MAX = 0.2  # of the wire


class Counted(AroundEngine):
    """An engine whose words on the wire are counted, and disturbed."""

    def __init__(self, engine: Engine, noise: Noise | None = None):
        super().__init__(engine)
        self.words, self.noise = 0, noise

    def transfer(self, mosi: Sequence[int], gap: int = 64) -> list[int]:
        """One chip select."""
        self.words += len(mosi)
        if not self.noise:
            return self.engine.transfer(mosi, gap)
        return self.noise.back(self.engine.transfer(self.noise.there(list(mosi)), gap))

    def run(self, clocks: int) -> int:
        """Let time pass."""
        return self.engine.run(clocks)


@dataclass(frozen=True)
class Motion:
    """Points and what became of them."""

    clocks: np.ndarray  # of the points
    steps: np.ndarray  # point x axis, of the positions rounded
    events: np.ndarray  # of the pins
    words: int  # on the wire while it ran
    seconds: float

    @property
    def edges(self) -> list[np.ndarray]:
        """Of each axis: clocks of its steps from the start, negative where it goes back."""
        running = np.flatnonzero(self.events["running"] & 1)
        found = self.events["clock"].astype(np.int64) - int(self.events["clock"][running[0]]) + 1
        return [found[moves != 0] * moves[moves != 0] for moves in self._moves]

    @property
    def off(self) -> int:
        """The most steps by which an axis is off at the time of a point."""
        at = np.searchsorted(
            self.events["clock"].astype(np.int64) - self._start, self.clocks + self.clocks % 2, "right"
        )
        sums = [np.concatenate([[0], np.cumsum(moves)])[at] for moves in self._moves]
        return int(np.abs(np.stack(sums, axis=1) - self.steps).max())

    @property
    def late(self) -> int:
        """Clocks from the time of the last point to the end of the motion."""
        running = np.flatnonzero(np.diff(self.events["running"] & 1, prepend=0))
        return int(self.events["clock"][running[-1]]) - self._start - int(self.clocks[-1])

    @property
    def _start(self) -> int:
        return int(self.events["clock"][np.flatnonzero(self.events["running"] & 1)[0]])

    @property
    def _moves(self) -> list[np.ndarray]:
        return [moves_of(self.events, axis) for axis in range(AXES)]


def smooth(seed: int, seconds: float, period: float) -> tuple[np.ndarray, np.ndarray]:
    """Times in s and positions in mm (time x axis) of a smooth motion from rest to rest."""
    rng = random.Random(seed)
    times = np.arange(1, round(seconds / period) + 1) * period
    u = np.minimum(1, np.minimum(times, seconds - times))
    window = u * u * (3 - 2 * u)
    places = [window * rng.uniform(8, 14) * np.sin(rng.uniform(3, 6) * times) for _ in range(AXES)]
    return times, np.stack(places, axis=1)


class Following:
    """A call of passo_follow(), and what must live as long as its motion."""

    def __init__(self, driver: Driver, times: np.ndarray, places: np.ndarray):
        points = np.zeros(len(times), POINT)
        points["clocks"] = np.rint(times * CLOCK_HZ)
        points["target"][:, :AXES] = np.rint(places * 2.0**32)
        self.clocks, self._points = points["clocks"].astype(np.int64), points
        self._c, self._settings = ffi().new("struct passo_follow *"), SETTINGS.struct(CORE)
        buffer = ffi().cast("struct passo_timed_point *", ffi().from_buffer(points))
        driver.call("follow", self._c, self._settings, buffer, len(points))


def open_driver(wire: Any) -> Driver:
    """A driver with its axes configured."""
    driver = Driver(wire, tries=20)
    for axis in range(AXES):
        driver.call("configure_axis", axis, ffi().new("struct passo_axis_config *", PINS))
        driver.call("enable", axis, True)
    driver.call("configure_motion", STOP, STOP, 1 << 20)
    return driver


def follow(
    times: np.ndarray,
    places: np.ndarray,
    pause: Callable[[], float] = lambda: 1 / POLLS,
    noise: Noise | None = None,
) -> Motion:
    """Follow points; `pause`: seconds from one poll to the next."""
    with model_engine(CORE, CLOCK_HZ) as engine:
        wire = Counted(engine, noise)
        driver = open_driver(wire)
        following = Following(driver, times, places)
        words, began, events = wire.words, engine.clock, [engine.drain()]
        while driver.is_moving:
            due = engine.clock + round(pause() * CLOCK_HZ)
            driver.poll()
            while engine.clock < due:
                engine.run(due - engine.clock)
                events.append(engine.drain())
        seconds = (engine.clock - began) / CLOCK_HZ
        scaled = places * SCALE
        steps = np.where(scaled < 0, -np.floor(0.5 - scaled), np.floor(0.5 + scaled)).astype(int)
        assert driver.positions()[:AXES] == steps[-1].tolist()
        return Motion(following.clocks, steps, np.concatenate(events), wire.words - words, seconds)


def same(a: Motion, b: Motion) -> bool:
    """All steps are on the same clocks from the start."""
    return all(np.array_equal(one, other) for one, other in zip(a.edges, b.edges, strict=True))


def gaps(seed: int, seconds: float, count: int) -> Callable[[], float]:
    """Pauses of a host whose wakes are late by up to 1 ms, and `count` times by a gap."""
    rng = random.Random(seed)
    at = set(rng.sample(range(10, round(seconds * POLLS * 0.5)), count))
    number = iter(range(1 << 40))
    return lambda: rng.uniform(0, 2 / POLLS) + (rng.uniform(*GAP) if next(number) in at else 0)


def die(seed: int) -> tuple[str, int]:
    """A host fails while the axes move: the cause of the stop, and steps by which the next host is off."""
    rng = random.Random(seed)
    period = rng.choice([PERIOD, 0.008])  # the queue ends before the watchdog, or after
    times, places = smooth(seed, 6, period)
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = open_driver(engine)
        following = Following(driver, times, places)  # noqa: F841, the core has its lines
        events = [engine.drain()]
        for _ in range(rng.randrange(500, 4000)):
            driver.poll()
            engine.run(CLOCK_HZ // POLLS)
            events.append(engine.drain())
        for _ in range(round(SILENCE * 1000)):
            engine.run(CLOCK_HZ // 1000)
            events.append(engine.drain())
        assert driver.snapshot().state == State.STOPPED
        cause = driver.cause.name
        pins = np.concatenate(events)
        wanted = [int(moves_of(pins, axis).sum()) for axis in range(AXES)]
        found = open_driver(engine).positions()[:AXES]
        return cause, max(abs(a - b) for a, b in zip(wanted, found, strict=True))


@dataclass(frozen=True)
class Figures:
    """What was measured."""

    off: int  # steps at the time of a point
    late: int  # clocks at the end
    share: float  # of the wire
    bytes_per_point: float  # of an axis, status reads included
    gaps_same: bool
    noise_same: bool
    flips: int
    causes: dict[str, int]  # of the stops after a death
    lost: int  # steps after a death
    hour_off: int
    hour_late: int


def measure(seed: int, seconds: float = 20, deaths: int = DEATHS, hour: float = 3600) -> Figures:
    """Run everything; `hour` are the seconds of the slow motion."""
    times, places = smooth(seed, seconds, PERIOD)
    plain = follow(times, places)
    late = follow(times, places, gaps(seed, seconds, round(GAPS * seconds / 20)))
    noise = Noise(random.Random(seed), ERRORS)
    noisy = follow(times, places, noise=noise)
    ends = [die(seed * 1000 + number) for number in range(deaths)]
    slow = np.arange(1, round(hour / 0.05) + 1) * 0.05
    waves = np.sin(np.pi * slow / hour)[:, None] * 2 * np.sin(slow[:, None] * np.linspace(0.2, 0.5, AXES))
    long = follow(slow, waves, lambda: 0.1)
    return Figures(
        plain.off,
        plain.late,
        plain.words * 32 / SCLK_HZ / plain.seconds,
        plain.words * 4 / len(times) / AXES,
        same(plain, late),
        same(plain, noisy),
        noise.flips,
        {cause: [end[0] for end in ends].count(cause) for cause in sorted({end[0] for end in ends})},
        max(lost for _, lost in ends),
        long.off,
        long.late,
    )


def main() -> int:
    """Print the figures; 1 if one of them is not as promised."""
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    tell = stages()
    tell("hosts: all figures")
    found = measure(seed)
    tell.end()
    same_edges = {True: "the same edges", False: "OTHER EDGES"}
    for line in (
        f"axes off at the time of a point: {found.off} steps; the end late: {found.late} clocks",
        f"the wire is busy for {found.share:.1%}; bytes per axis and point: {found.bytes_per_point:.1f}",
        f"wakes late by up to 1 ms, {GAPS} gaps of {GAP[0]:g} to {GAP[1]:g} s: {same_edges[found.gaps_same]}",
        f"bit errors of {ERRORS:g}, {found.flips} bits: {same_edges[found.noise_same]}",
        f"{sum(found.causes.values())} deaths of the host: {found.causes}; steps lost: {found.lost}",
        f"after an hour: axes off {found.hour_off} steps; the end late: {found.hour_late} clocks",
    ):
        print(line)
    return int(not good(found))


def good(found: Figures) -> bool:
    """All promises are kept; a motion ends with a tick of 128 clocks."""
    exact = found.off == found.lost == found.hour_off == 0 and found.gaps_same and found.noise_same
    return exact and found.share <= SHARE_MAX and 0 <= found.late <= 128 and 0 <= found.hour_late <= 128


if __name__ == "__main__":
    sys.exit(ended(main))
