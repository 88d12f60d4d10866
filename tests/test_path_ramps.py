# SPDX-License-Identifier: MIT
"""Each ramp of random paths, known by the velocities at its ends, against the limits of what it passes: none
is too fast or too steep, they end where the lines end, and there always is a next one."""

import math
import random
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from passo import random_cases
from passo.build import Parameters
from passo.path import Path, PathSettings
from passo.path_rounding import Line

from tests.helpers.core_steps import tables
from tests.helpers.path_limits import Limits, limits_of
from tests.test_path_relations import PROFILES, drawn

SAMPLES = 17  # of a ramp
SIMPLE = ", unrounded"
PATHS = 60
BOUNDS = {"speed": 1.001, "corner": 1.03, "steep": 1.03, "jerk": 1.0}  # what may be made of a limit
TICKS = 4  # of acceleration, by which the speed at a corner may be off
LITTLE = 10  # ticks: what a ramp has left of a line has no say


@dataclass(frozen=True)
class Made:
    """A ramp: mm, mm/s and s."""

    begin: float  # its place along the path
    length: float
    first: float  # speeds
    last: float
    seconds: float
    shape: int

    def at(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Places, speeds and accelerations at some times."""
        share, way, risen, steep = course(self.shape)
        change = self.last - self.first
        places = self.begin + self.seconds * (self.first * share + change * way)
        return places, self.first + change * risen, change / max(self.seconds, 1e-12) * steep


@cache
def course(shape: int) -> tuple[np.ndarray, ...]:
    """Shares of the time of a ramp, and there: way, speed and slope, from 0 to 1 in the time of 1."""
    share, times = np.linspace(0, 1, SAMPLES), np.linspace(0, 1, 257)
    table = np.array([*tables()[shape][:256], 65536]) / 65536 if shape else times
    area = np.concatenate(([0], np.cumsum(table[1:] + table[:-1]) / 512))
    steep = np.gradient(table, times) if shape else np.ones(257)
    return share, *(np.interp(share, times, values) for values in (area, table, steep))


class Host:
    """Takes lines and ramps, as a core that holds so much of them would."""

    def __init__(self, settings: PathSettings, look_ahead: int) -> None:
        self.path = Path(settings, Parameters(), look_ahead)
        self.scale = self.path.substeps_per_mm
        self.hz = settings.clock_hz
        self.begin = self.speed = 0.0
        self.ramps: list[Made] = []
        self.substeps = 0
        self.rests: list[float] = []  # places at which a motion ended

    def take(self, held: int = 0xFFFFFFFF) -> Any:
        """The lines that there are, and one ramp, or None."""
        while (line := self.path.next_line()) is not None:
            self.substeps += line.substeps
        ramp = self.path.next_ramp(held)
        if ramp is None:
            return None
        last = ramp.velocity_end / 2**48 * self.hz / self.scale
        seconds = (ramp.ticks << 7) / self.hz
        length = (self.speed + last) / 2 * seconds
        self.ramps.append(Made(self.begin, length, self.speed, last, seconds, ramp.shape))
        self.begin, self.speed = self.begin + length, last
        if ramp.last:
            self.rests.append(self.begin)
            assert ramp.velocity_end == 0 and self.path.next_motion()
        return ramp


def some_paths(profile: str) -> list[tuple[list[Line], PathSettings]]:
    """With a limit of jerk in the plane of two axes that are alike."""
    found = [(lines, replace(settings, tolerance=0)) for lines, settings in drawn(profile)]
    if profile == "jerk":
        found = [(lines, settings) for lines, settings in found if not any(target[2] for target, _ in lines)]
    return found[:PATHS]


def worst(host: Host, limits: Limits, settings: PathSettings, rests: bool = False) -> dict[str, float]:
    """The highest shares of the limits of what the ramps pass."""
    found = dict.fromkeys(BOUNDS, 0.0)
    ends = np.concatenate(([0.0], np.cumsum(limits.length)))
    tick = 128 / settings.clock_hz
    for ramp in host.ramps:
        if ramp.length <= 0:
            continue
        end = ramp.begin + ramp.length
        near = max(ramp.first, ramp.last) * tick * LITTLE + 1.5 / host.scale
        near = min(near, ramp.length / 2)  # it is in no other line than those between its ends

        places, speeds, steep = ramp.at()
        asked = np.concatenate(([ramp.begin + near, end - near], places - near, places + near))
        found_at = (ends.searchsorted(asked, "right") - 1).clip(0, len(ends) - 2)
        first = int(found_at[0])
        last = max(first, int(found_at[1]))
        lines = slice(first, last + 1)
        top = limits.top[found_at[2:]].reshape(2, -1).max(axis=0)
        found["speed"] = max(found["speed"], float((speeds / np.sqrt(top)).max()))
        most = float(limits.acceleration[lines].min())
        if ramp.seconds > 3 * tick:
            slack = 2 * TICKS * tick * most / ramp.seconds / 8
            found["steep"] = max(found["steep"], float((np.abs(steep).max() - slack) / most))
            change = abs(ramp.last - ramp.first)
            jerk = change / ramp.seconds**2 * math.pi**2 / 2
            if settings.profile == "jerk" and ramp.shape:
                found["jerk"] = max(found["jerk"], float(jerk / limits.jerk[lines].min()))
        for i in range(first + 1, last + 1):
            if rests and any(abs(ends[i] - place) < near for place in host.rests):
                continue
            speed = float(np.interp(ends[i], places, speeds))
            allowed = math.sqrt(limits.corner[i]) + TICKS * tick * most
            found["corner"] = max(found["corner"], speed / allowed)
    return found


@pytest.mark.parametrize("profile", PROFILES)
def test_no_ramp_exceeds_a_limit_of_what_it_passes(profile: str) -> None:
    """The feed, the acceleration and the jerk of each line, where a ramp is steepest; the speed at corners.
    The sum of the ramps is the path."""
    shares = []
    for lines, settings in some_paths(profile):
        host = Host(settings, len(lines) + 4)
        for target, feed in lines:
            host.path.add(target, feed)
        host.path.end()
        while host.take() is not None:
            pass
        limits = limits_of(lines, settings)
        assert host.speed == 0 and host.begin * host.scale == pytest.approx(host.substeps, abs=0.02)
        assert float(limits.length.sum()) == pytest.approx(host.begin, rel=1e-6, abs=2 / host.scale)
        shares.append(worst(host, limits, settings))
    assert all(share[name] < bound for share in shares for name, bound in BOUNDS.items()), shares


@pytest.mark.parametrize("profile", PROFILES)
def test_there_always_is_a_next_ramp(profile: str) -> None:
    """Lines become known one by one, or too late, and the core asks when it holds little or much: as long as
    the path moves and the core is short of ramps there is one, no faster and no steeper than allowed; where
    no line comes, the path comes to rest at the end of one, and continues from there."""
    shares = []
    for number, (lines, settings) in enumerate(some_paths(profile)[::2]):
        rng = random.Random(f"{random_cases.seed()} {profile} {number}")
        host = Host(settings, rng.choice((4, 8, 48, len(lines) + 4)))
        reserve, pause = host.path.c.reserve, rng.choice((0.01, 0.1, 0.5))
        for target, feed in lines:
            while host.path.room == 0:
                taken = host.take(rng.choice((0, reserve)) if host.speed else 0)
                assert taken is not None or host.speed == 0
            host.path.add(target, feed)
            while rng.random() < pause:
                held = rng.choice((0, reserve // 2, reserve, 2 * reserve))
                taken = host.take(held)
                assert taken is not None or held >= reserve or host.speed == 0
        host.path.end()
        while host.take(0) is not None:
            pass
        assert host.speed == 0 and host.path.is_empty
        assert host.begin * host.scale == pytest.approx(host.substeps, abs=0.02)
        limits = limits_of(lines, settings, arcs=False)
        ends = np.concatenate(([0], np.cumsum(limits.length)))
        assert all(np.abs(ends - place).min() < 3 * len(lines) / host.scale for place in host.rests)
        shares.append(worst(host, limits, settings, rests=True))
    assert all(share[name] < BOUNDS[name] for share in shares for name in ("speed", "steep")), shares
