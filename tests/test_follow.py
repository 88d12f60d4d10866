# SPDX-License-Identifier: MIT
"""Timed points: each is reached on its clock, by the pins; what cannot be made is refused; a late host."""

import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.engine import Engine, model_engine, moves_of, rtl_engine
from passo.moves import AXES_MAX, PinTiming
from passo.native import ffi, planner
from passo.path import Motors, PathAxis, PathSettings

CLOCK_HZ = 16_000_000
CORE = Parameters(axes=4, clock_hz=CLOCK_HZ, line_queue_log2=6)
AXIS = PathAxis(80, 200, 1000)
SETTINGS = PathSettings((AXIS, AXIS, replace(AXIS, steps_per_mm=Fraction(1000, 3))), CLOCK_HZ)
COREXY = replace(SETTINGS, motors=Motors(((1, 1, 0), (1, -1, 0), (0, 0, 1)), PathAxis(0, 150, 0)))
POINT = np.dtype([("clocks", "u8"), ("target", "i8", AXES_MAX)])
PINS = PinTiming(20, 20, 10, 10)


def points_of(times: Any, places: Any) -> Any:
    """The `struct passo_timed_point[]`; times in s, places in mm."""
    array = np.zeros(len(times), POINT)
    array["clocks"] = np.rint(np.asarray(times) * CLOCK_HZ)
    array["target"][:, : np.shape(places)[1]] = np.rint(np.asarray(places) * 2.0**32)
    made = ffi().new("struct passo_timed_point[]", len(times))
    ffi().memmove(made, array.tobytes(), array.nbytes)
    return made


def driver_at(engine: Engine, pins: PinTiming = PINS) -> Driver:
    driver = Driver(engine)
    for axis in range(3):
        driver.configure_axis(axis, pins)
    driver.call("configure_motion", CLOCK_HZ // 20, CLOCK_HZ // 20, 1 << 20)
    return driver


class Follow:
    """A call of passo_follow(), and all that must live as long as it."""

    def __init__(self, driver: Driver, times: Any, places: Any, settings: PathSettings = SETTINGS):
        self.driver, self.count = driver, len(times)
        self.points, self.c = points_of(times, places), ffi().new("struct passo_follow *")
        self.settings = settings.struct(CORE)
        self.error = driver.attempt("follow", self.c, self.settings, self.points, self.count)

    @property
    def refusal(self) -> tuple[str, int, int]:
        """Reason, point, axis."""
        assert self.error == planner().PASSO_ERROR_SUPPLY
        reason = ffi().typeof("enum passo_timed_error").elements[self.c.reason]
        return reason.removeprefix("PASSO_TIMED_"), self.c.refused, self.c.axis


def finish(driver: Driver, engine: Engine) -> np.ndarray:
    """Poll to the end; return the events of the pins."""
    events = []
    while driver.is_moving:
        driver.poll()
        engine.run(CLOCK_HZ // 5000)
        events.append(engine.drain())
    engine.run(10_000)
    return np.concatenate([*events, engine.drain()])


def at(events: np.ndarray, clocks: np.ndarray, motors: int) -> np.ndarray:
    """Steps made by each motor up to these clocks of the motion: time x motor."""
    start = int(events["clock"][np.flatnonzero(events["running"] & 1)[0]])
    found = np.searchsorted(events["clock"].astype(np.int64) - start, clocks, "right")
    sums = [np.concatenate([[0], np.cumsum(moves_of(events, motor))])[found] for motor in range(motors)]
    return np.stack(sums, axis=1)


def smooth(seed: int, seconds: float, period: float) -> tuple[np.ndarray, np.ndarray]:
    """A smooth motion of three axes from rest to rest, sampled at uneven times."""
    rng = random.Random(seed)
    count = round(seconds / period)
    times = np.array([(k + rng.uniform(-0.3, 0.3)) * period for k in range(1, count)] + [seconds])
    u = times / seconds
    window = np.sin(np.pi * u) ** 2
    places = [
        window * sum(rng.uniform(-4, 4) * np.sin(2 * np.pi * f * u) for f in (0.5, 1, 1.5)) for _ in range(3)
    ]
    return times, np.stack(places, axis=1)


def rounded(places: np.ndarray, settings: PathSettings) -> np.ndarray:
    """Steps of the motors at places, by the definition."""
    motors = settings.motors.map(3) @ np.asarray(places).T
    scaled = motors.T * np.array(settings.scales)
    return np.where(scaled < 0, -np.floor(0.5 - scaled), np.floor(0.5 + scaled)).astype(int)


@pytest.mark.parametrize("settings", [SETTINGS, COREXY], ids=["cartesian", "corexy"])
@pytest.mark.parametrize("period", [0.0004, 0.002, 0.008])
@pytest.mark.parametrize("seed", [1, 2])
def test_each_point_is_reached_on_its_clock(seed: int, period: float, settings: PathSettings) -> None:
    """At the time of each point every motor has exactly its steps; nothing adds up; it ends with the last."""
    times, places = smooth(seed, 2.0, period)
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        follow = Follow(driver, times, places, settings)
        assert follow.error == 0
        events = finish(driver, engine)
        clocks = np.rint(times * CLOCK_HZ).astype(int)
        assert np.array_equal(at(events, clocks + clocks % 2, 3), rounded(places, settings))
        assert driver.positions()[:3] == rounded(places[-1:], settings)[0].tolist()
        assert driver.fault == "OK" and driver.snapshot().drained == 0
    running = events["clock"][np.flatnonzero(np.diff(events["running"] & 1, prepend=0))].astype(int)
    assert len(running) == 2
    assert 0 <= running[1] - running[0] - clocks[-1] <= 128


def test_the_core_does_the_same() -> None:
    """Model and Verilated core, edge for edge."""
    times, places = smooth(3, 0.2, 0.002)
    found = []
    for make in (model_engine, rtl_engine):
        with make(CORE, CLOCK_HZ) as engine:
            driver = driver_at(engine)
            follow = Follow(driver, times, places / 60)
            assert follow.error == 0
            found.append(finish(driver, engine))
    assert len(found[0]) > 20
    assert np.array_equal(*found)


def test_a_chain_of_motions_and_a_single_point() -> None:
    """Each begins where the last one ended; a point alone is a line at constant speed, if it is slow."""
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        for target in (0.5, 1.0, 0.25):
            follow = Follow(driver, [0.1], [[target, -target, 0]])
            assert follow.error == 0
            finish(driver, engine)
            assert driver.positions()[:3] == [target * 80, -target * 80, 0]


@pytest.mark.parametrize(
    ("times", "x", "refusal"),
    [
        ([0.1, 0.1, 0.2], [0, 0, 0], ("ORDER", 1, 0)),
        ([0.0, 0.1], [0, 0], ("ORDER", 0, 0)),
        ([1.0, 140.0], [0, 0], ("LONG", 1, 0)),
        ([0.1, 0.2], [0, 3e8], ("FAR", 1, 0)),
        ([0.01, 0.02], [0, 2.01], ("SPEED", 1, 0)),
        ([0.1, 0.2], [0.8, 1.7], ("ACCELERATION", 2, 0)),  # to rest from 9 mm/s, above sqrt(8 * 1000 * 0.01)
        ([0.001, 0.002], [0.0005, 0.003], ("ACCELERATION", 1, 0)),  # by 2 mm/s in 1 ms
        ([0.1, 0.2], [0.9, 1.7], ("ACCELERATION", 0, 0)),
        ([], [], ("NO_POINTS", 0, 0)),
    ],
)
def test_what_cannot_be_made(times: list[float], x: list[float], refusal: tuple[str, int, int]) -> None:
    """It is named, and nothing moves."""
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        engine.drain()
        follow = Follow(driver, times, [[place, 0.0, 0.0] for place in x] or np.zeros((0, 3)))
        assert follow.refusal == refusal
        engine.run(CLOCK_HZ // 10)
        assert not driver.is_moving and not len(engine.drain())


def test_pins_limits_of_motors_and_machines() -> None:
    """Pin timing of a motor; the limit of a motor that moves two axes; settings that cannot be."""
    jump = replace(AXIS, speed=2000, jump=2000)
    fast = replace(SETTINGS, axes=(jump, jump, jump))
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine, PinTiming(100, 100, 1, 1))
        assert Follow(driver, [0.1], [[0, 100.01, 0]], fast).refusal == ("PINS", 0, 4)
        follow = Follow(driver, [0.1], [[0, 99.9, 0]], fast)
        assert follow.error == 0
        finish(driver, engine)
        both = replace(fast, motors=Motors(((1, 1, 0), (1, -1, 0), (0, 0, 1)), PathAxis(0, 150, 0, 150)))
        assert Follow(driver, [1.0], [[160 - 99.9 / 2, 99.9 / 2, 0]], both).refusal == ("SPEED", 0, 3)
        assert Follow(driver, [0.1], [[0] * 3], replace(fast, clock_hz=0)).refusal[0] == "SETTINGS"
        many = replace(SETTINGS, axes=(AXIS,) * 5)
        assert Follow(driver, [0.1], [[0] * 5], many).error == planner().PASSO_ERROR_ARGUMENT_AXIS


def test_rounding_of_times_is_no_change_of_speed() -> None:
    """Samples of a motion at the limit pass, at any period; 2 % more acceleration does not."""
    for period in (1 / 3000, 1 / 1000, 1 / 700, 1 / 130):
        half = round(0.15 / period)
        k = np.arange(1, 2 * half + 1)
        speed = np.minimum(k - 0.5, 2 * half - k + 0.5) * 1000 * period
        for factor, passes in ((1.0, True), (1.02, False)):
            x = np.cumsum(speed * period) * factor
            with model_engine(CORE, CLOCK_HZ) as engine:
                follow = Follow(driver_at(engine), k * period, np.stack([x, 0 * x, 0 * x], axis=1))
                if passes:
                    assert follow.error == 0
                else:
                    assert follow.refusal[0] == "ACCELERATION"


def test_a_late_host_slows_along_the_points() -> None:
    """RAMP_UNDERRUN within the stop time; the axes stay on the line, in step, and positions are exact."""
    count = 400
    times = np.arange(1, count + 1) * 0.005
    x = (
        np.cumsum(np.minimum(np.minimum(np.arange(count), 40) * 2.0, (count - np.arange(count)) * 2.0))
        * 0.005
    )
    places = np.stack([x, x / 2, 0 * x], axis=1)
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        follow = Follow(driver, times, places)
        assert follow.error == 0
        events = []
        for _ in range(700):
            driver.poll()
            engine.run(CLOCK_HZ // 1000)
            events.append(engine.drain())
        for _ in range(500):  # the host is away
            engine.run(CLOCK_HZ // 1000)
            events.append(engine.drain())
        with pytest.raises(DriverError, match="RAMP_UNDERRUN"):
            driver.poll()
        made = np.concatenate(events)
        positions = [int(moves_of(made, motor).sum()) for motor in range(3)]
        assert driver.positions()[:3] == positions
        assert 0 < positions[0] < x[-1] * 80 and abs(positions[0] - 2 * positions[1]) <= 2
        steps = made["clock"][moves_of(made, 0) != 0].astype(float)
        gaps = np.diff(steps)[-200:]
        assert gaps[-1] > 5 * gaps[0]  # it did not stop dead ...
        slow = steps[-1] - steps[:-1][np.diff(steps) < gaps[0] * 1.2][-1]
        assert 0.01 * CLOCK_HZ < slow < 0.06 * CLOCK_HZ  # ... but within the stop time
        driver.call("clear")
        assert (
            Follow(driver, [0.1], [[p / s for p, s in zip(positions, SETTINGS.scales, strict=True)]]).error
            == 0
        )
        finish(driver, engine)
        assert driver.positions()[:3] == positions


def test_points_exactly_at_the_limit_of_speed_pass() -> None:
    """However their times are rounded."""
    jump = replace(SETTINGS, axes=(replace(AXIS, jump=500),) * 3)
    for period in (1 / 3000, 1 / 700, 1 / 130):
        k = np.arange(1, 40)
        with model_engine(CORE, CLOCK_HZ) as engine:
            x = 200 * period * k
            assert Follow(driver_at(engine), k * period, np.stack([x, 0 * x, 0 * x], axis=1), jump).error == 0


@pytest.mark.parametrize(("clocks", "passes"), [(2**31 - 2, True), (2**31, False)])
def test_the_longest_interval(clocks: int, passes: bool) -> None:
    """Less than 2^31 clocks, as the message says; clocks are rounded to even ones."""
    with model_engine(CORE, CLOCK_HZ) as engine:
        follow = Follow(driver_at(engine), [clocks / CLOCK_HZ], [[0.5, 0, 0]])
        assert (follow.error == 0) == passes
        assert passes or follow.refusal == ("LONG", 0, 0)


@pytest.mark.parametrize("axis", range(3))
def test_the_axis_or_motor_that_is_out_of_range_is_named(axis: int) -> None:
    """A target beyond all numbers is that of an axis, one with too many steps that of a motor."""
    place = [0.0, 0.0, 0.0]
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        place[axis] = 4e8
        assert Follow(driver, [100.0], [place]).refusal == ("FAR", 0, axis)
        fast = replace(SETTINGS, axes=(PathAxis(2**20, 2**31, 1, jump=2**31),) * 3)
        place[axis] = 2100.0
        assert Follow(driver, [100.0], [place], fast).refusal == ("FAR", 0, 3 + axis)


def test_the_limits_of_mixed_motors_are_no_others() -> None:
    """A motor that moves one axis has those of the axis."""
    slow = replace(COREXY, motors=Motors(COREXY.motors.rows, PathAxis(0, 5, 0)))
    with model_engine(CORE, CLOCK_HZ) as engine:
        driver = driver_at(engine)
        assert Follow(driver, [0.1], [[0, 0, 0.8]], slow).error == 0  # 8 mm/s
        finish(driver, engine)
        assert Follow(driver, [0.1], [[0.8, 0, 0.8]], slow).refusal == ("SPEED", 0, 3)
