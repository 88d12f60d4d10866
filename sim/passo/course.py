# SPDX-License-Identifier: MIT
"""A planned part in time: where it is, how fast it is, and which limit binds it."""

from functools import cached_property

import numpy as np

from passo.native import planner
from passo.plan import Q48
from passo.preview import Planned

FULL = 0.999  # share of a speed at which the path is taken to have it
BISECTIONS = 40
LEVEL = 1e-3  # mm: Z of a line whose ends differ by less is a level
REST, FEED, CORNERS = "rest", "feed", "corners and short lines"


class Course:
    """Lines and ramps of a part. Times in seconds, ways in substeps, places in mm; a row per line."""

    def __init__(self, planned: Planned, begin: np.ndarray):
        """`begin`: where the first line begins, mm."""
        self.planned, self.machine = planned, planned.machine
        lines, ramps = planned.lines, planned.ramps
        settings = self.machine.settings
        motors = np.vstack([np.zeros(len(settings.scales)), lines["steps"][:, : len(settings.scales)]])
        places = np.cumsum(motors, axis=0) / np.array(settings.scales)
        self.points = settings.motors.axes_of(places) + begin  # line + 1 x axis
        self.delta = np.diff(self.points, axis=0)
        size = np.linalg.norm(self.delta, axis=1)  # of whole steps
        self.unit = self.delta / np.maximum(size, 1e-12)[:, None]
        self.length = lines["substeps"] / planned.substeps_per_mm
        self._scale = self.machine.clock_hz / planned.substeps_per_mm  # mm/s of a substep per clock
        self.line_way = np.cumsum(lines["substeps"], dtype=float)  # at the end of each line
        self._clocks = ramps["ticks"] * float(1 << planned.parameters.tick_log2)
        self._after = ramps["velocity"] / Q48  # substeps per clock
        before = np.concatenate([[0.0], self._after[:-1]])
        before[np.flatnonzero(ramps["last"][:-1]) + 1] = 0
        self._before = before
        self._shaped = ramps["shape"] != planner().PASSO_SHAPE_LINEAR
        self.ramp_time = np.cumsum(self._clocks) / self.machine.clock_hz  # at the end of each ramp
        self.ramp_way = np.cumsum(self._clocks * (before + self._after) / 2)

    @property
    def seconds(self) -> float:
        """Duration of all motions."""
        return float(self.ramp_time[-1]) if len(self.ramp_time) else 0.0

    @property
    def motions(self) -> int:
        """From rest to rest with nothing to follow."""
        return int(self.planned.ramps["last"].sum())

    @cached_property
    def line_time(self) -> np.ndarray:
        """When each line ends."""
        count = len(self.ramp_way)
        if not count:
            return np.zeros(0)
        way = np.minimum(self.line_way, self.ramp_way[-1])
        ramp = np.minimum(np.searchsorted(self.ramp_way, way), count - 1)
        begin = self.ramp_way[ramp] - self._clocks[ramp] * (self._before + self._after)[ramp] / 2
        low, high = np.zeros(len(way)), np.ones(len(way))
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            short = begin + self._covered(ramp, middle) < way
            low, high = np.where(short, middle, low), np.where(short, high, middle)
        at = self.ramp_time[ramp] - (1 - high) * self._clocks[ramp] / self.machine.clock_hz
        return np.maximum.accumulate(at)

    def _covered(self, ramp: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Of ramps, after a share of their time. A shape is near the cosine."""
        rise = np.where(self._shaped[ramp], u / 2 - np.sin(np.pi * u) / (2 * np.pi), u * u / 2)
        before = self._before[ramp]
        return self._clocks[ramp] * (before * u + (self._after[ramp] - before) * rise)

    def _at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The ramps at these times, and the shares of their time that are over."""
        ramp = np.minimum(np.searchsorted(self.ramp_time, times), len(self.ramp_time) - 1)
        left = (self.ramp_time[ramp] - times) * self.machine.clock_hz
        return ramp, np.clip(1 - left / np.maximum(self._clocks[ramp], 1), 0, 1)

    def places(self, times: np.ndarray) -> np.ndarray:
        """time x axis, in mm."""
        if not len(self.ramp_time):
            return np.repeat(self.points[:1], len(times), axis=0)
        ramp, u = self._at(times)
        way = self.ramp_way[ramp] - self._covered(ramp, np.ones(len(ramp))) + self._covered(ramp, u)
        ends = np.concatenate([[0.0], self.line_way])
        return np.stack([np.interp(way, ends, column) for column in self.points.T], axis=1)

    def speed(self, times: np.ndarray) -> np.ndarray:
        """Along the path, mm/s."""
        if not len(self.ramp_time):
            return np.zeros(len(times))
        return self.velocity(times) * self._scale

    def velocity(self, times: np.ndarray) -> np.ndarray:
        """In substeps per clock."""
        ramp, u = self._at(times)
        rise = np.where(self._shaped[ramp], (1 - np.cos(np.pi * u)) / 2, u)
        return self._before[ramp] + (self._after[ramp] - self._before[ramp]) * rise

    @cached_property
    def _pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """What is of one line and one ramp: duration, line, ramp, and the velocity at both ends."""
        ends = np.unique(np.concatenate([self.ramp_time, self.line_time]))
        begins = np.concatenate([[0.0], ends[:-1]])
        middle = (begins + ends) / 2
        line = np.minimum(np.searchsorted(self.line_time, middle), len(self.line_time) - 1)
        ramp = np.minimum(np.searchsorted(self.ramp_time, middle), len(self.ramp_time) - 1)
        hair = (ends - begins) * 1e-6
        return ends - begins, line, ramp, self.velocity(begins + hair), self.velocity(ends - hair)

    def bound(self) -> dict[str, float]:
        """How many seconds each limit binds, the longest first."""
        if not len(self.line_time):
            return {}
        seconds, line, ramp, begin, end = self._pieces
        lines, speed = self.planned.lines, np.maximum(begin, end) * 2.0**32
        names = self.machine.limited
        limits = self.machine.settings.limits()
        along = np.abs(self.unit @ np.array([direction for direction, _ in limits]).T)  # line x limit

        def of(name: str) -> np.ndarray:
            """Of each line the number of the limit that it meets first."""
            most = [max(float(getattr(own, name)), 1e-9) for _, own in limits]
            return np.argmax(along / np.array(most), axis=1)[line]

        low, high = (edge(self._before, self._after)[ramp] for edge in (np.minimum, np.maximum))
        steady = low >= FULL * high
        at_feed = ~lines["rapid"][line] & (speed >= FULL * lines["feed"][line])
        at_limit = speed >= FULL * lines["limit"][line]
        kinds = [
            (steady & (speed == 0), np.zeros(len(line), int), [REST]),
            (steady & at_feed, np.zeros(len(line), int), [FEED]),
            (steady & at_limit, of("speed"), [f"speed of {name}" for name in names]),
            (steady, np.zeros(len(line), int), [CORNERS]),
            (~steady, of("acceleration"), [f"acceleration of {name}" for name in names]),
        ]
        found: dict[str, float] = {}
        left = np.ones(len(line), bool)
        for here, number, texts in kinds:
            here = here & left
            left &= ~here
            for place, text in enumerate(texts):
                found[text] = float(seconds[here & (number == place)].sum())
        return {name: time for name, time in sorted(found.items(), key=lambda one: -one[1]) if time > 0}

    def speeds(self) -> dict[str, float]:
        """The highest ones in mm/s: along the path, and of each axis and motor that has limits."""
        if not len(self.line_time):
            return {}
        _, line, _, begin, end = self._pieces
        speed = np.maximum(begin, end) * self._scale
        found = {"path": float(speed.max())}
        for name, (direction, _) in zip(self.machine.limited, self.machine.settings.limits(), strict=True):
            found[name] = float((speed * np.abs(self.unit[line] @ direction)).max())
        return found

    def extent(self) -> dict[str, tuple[float, float]]:
        """Lowest and highest place of each axis."""
        lows, highs = self.points.min(axis=0).tolist(), self.points.max(axis=0).tolist()
        return dict(zip(self.machine.letters, zip(lows, highs, strict=True), strict=False))

    @cached_property
    def line_seconds(self) -> np.ndarray:
        """How long each line takes; a rest before it counts as well."""
        return np.diff(self.line_time, prepend=0.0)

    def tools(self) -> list[dict[str, float]]:
        """Of each tool, in the order of their numbers: seconds and mm at a feed, and of rapids."""
        tool, rapid = self.planned.lines["tool"], self.planned.lines["rapid"]
        return [
            {"tool": int(number), **self._sums((tool == number) & ~rapid, (tool == number) & rapid)}
            for number in np.unique(tool)
        ]

    def levels(self) -> list[dict[str, float]]:
        """The same at a feed of each level of Z, the highest first; lines that change Z are of none."""
        if "Z" not in self.machine.letters:
            return []
        z, feed = self.points[:, self.machine.letters.index("Z")], ~self.planned.lines["rapid"]
        level = np.round((z[1:] + z[:-1]) / 2 / LEVEL).astype(int)
        flat = feed & (np.abs(np.diff(z)) < LEVEL)
        numbers, where = np.unique(level, return_inverse=True)
        seconds = np.bincount(where, self.line_seconds * flat, len(numbers))
        length = np.bincount(where, self.length * flat, len(numbers))
        return [
            {"z": number * LEVEL, "feed_seconds": float(time), "feed_mm": float(way)}
            for number, time, way in zip(numbers.tolist(), seconds, length, strict=True)
            if way > 0
        ][::-1]

    def _sums(self, feed: np.ndarray, rapid: np.ndarray) -> dict[str, float]:
        return {
            "feed_seconds": float(self.line_seconds[feed].sum()),
            "feed_mm": float(self.length[feed].sum()),
            "rapid_seconds": float(self.line_seconds[rapid].sum()),
            "rapid_mm": float(self.length[rapid].sum()),
        }
