# SPDX-License-Identifier: MIT
"""The judge of each axis, by pulse trains whose speed, acceleration and jerk are known."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from passo.axis_judge import Marks, Share, faults, shares
from passo.path import PathAxis, PathSettings
from passo.path_rounding import Line

HZ = 64_000_000
FINE = 2e-6  # s
AXIS = PathAxis(400, 100, 1000, jerk=50_000)
ONE = PathSettings((AXIS,), HZ)
Place = Callable[[np.ndarray], np.ndarray]  # mm at these seconds


def steps(place: Place, seconds: float, steps_per_mm: float) -> tuple[np.ndarray, np.ndarray]:
    """Clocks of the steps of an axis, each half-way between two positions; positions after them."""
    times = np.arange(0, seconds, FINE)
    exact = place(times) * steps_per_mm
    near = np.floor(exact + 0.5).astype(int)
    at = np.flatnonzero(np.diff(near))
    assert np.abs(np.diff(near)).max() <= 1
    level = (near[at] + near[at + 1]) / 2
    share = (level - exact[at]) / (exact[at + 1] - exact[at])
    return np.round((times[at] + share * FINE) * HZ).astype(np.int64), near[at + 1]


def integral(times: np.ndarray, values: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Of a function that changes evenly between these points."""

    def found(at: np.ndarray) -> np.ndarray:
        fine = np.linspace(0, times[-1], 200_001)
        sums = (
            np.concatenate([[0], np.cumsum(np.interp((fine[1:] + fine[:-1]) / 2, times, values))]) * fine[1]
        )
        return np.interp(at, fine, sums)

    return found


def trapezoid(speed: float, acceleration: float) -> tuple[Place, float]:
    """Up, 0.2 s, down."""
    rise = speed / acceleration
    times = np.cumsum([0, 0.01, rise, 0.2, rise, 0.05])
    return integral(times, np.array([0, 0, speed, speed, 0, 0])), float(times[-1])


def circle(acceleration: float) -> tuple[Place, float]:
    """An axis of a circle of 50 mm, two turns; it begins and ends at rest with its whole acceleration."""
    pace = math.sqrt(acceleration / 50)
    return (
        lambda t: 50 - 50 * np.cos(pace * np.clip(t - 0.02, 0, 4 * math.pi / pace)),
        4 * math.pi / pace + 0.1,
    )


def smooth(jerk: float) -> tuple[Place, float]:
    """The jerk is constant for 0.3 s, then its opposite: up and down again."""
    times = np.cumsum([0, 0.05, 0.3, 0.3, 0.05, 0.3, 0.3, 0.05])
    speed = integral(times, 0.3 * jerk * np.array([0, 0, 1, 0, 0, -1, 0, 0]))
    fine = np.linspace(0, times[-1], 20_001)
    return integral(fine, speed(fine)), float(times[-1])


def judged(train: tuple[Place, float], name: str, settings: PathSettings = ONE) -> Share:
    """The share of one limit."""
    clocks, positions = steps(*train, float(settings.axes[0].steps_per_mm))
    (share,) = shares([clocks], [positions], settings, names=(name,))
    return share


@pytest.mark.parametrize("steps_per_mm", [80, 400, 1600])
@pytest.mark.parametrize("make", [lambda f: trapezoid(90, 1000 * f), lambda f: circle(1000 * f)])
def test_acceleration(make: Callable[[float], tuple[Place, float]], steps_per_mm: float) -> None:
    """A twentieth above the limit is a fault, the limit is none; windows are as long as steps are coarse."""
    machine = replace(ONE, axes=(replace(AXIS, steps_per_mm=steps_per_mm),))
    shares_of = {f: judged(make(f), "acceleration", machine) for f in (0.9, 1.0, 1.05, 1.1)}
    assert faults([shares_of[0.9], shares_of[1.0]]) == []
    assert len(faults([shares_of[1.05], shares_of[1.1]])) == 2
    for factor, share in shares_of.items():
        assert factor * 0.98 - 0.01 < share.share < factor * 1.002
    assert shares_of[1.0].window <= math.sqrt(4 * 0.5 / steps_per_mm / 1000 / 0.01) * 1.5


def test_speed() -> None:
    """To a few thousandths."""
    for factor in (0.9, 1.0, 1.04):
        share = judged(trapezoid(100 * factor, 1000), "speed")
        assert factor * 0.998 < share.share < factor * 1.0005
        assert bool(faults([share])) == (factor > 1)


def test_jerk() -> None:
    """Of all axes, if the profile has it."""
    machine = replace(ONE, axes=(PathAxis(1600, 200, 1000, jerk=2000),), profile="jerk")
    found = {f: judged(smooth(2000 * f), "jerk", machine) for f in (0.9, 1.0, 1.08)}
    assert faults([found[0.9], found[1.0]]) == [] and faults([found[1.08]])
    for factor, share in found.items():
        assert factor * 0.98 < share.share < factor * 1.002
    clocks, positions = steps(*smooth(2000), 1600)
    assert [s.name for s in shares([clocks], [positions], replace(machine, profile="cosine"))] == [
        *("speed", "acceleration")
    ]


def test_a_jump_is_seen_immediately() -> None:
    """A speed of 10 mm/s from rest; an axis with that start-stop speed may."""
    times = np.array([0, 0.05, 0.05, 0.3, 0.3, 0.4])
    jump = integral(times + np.array([0, -1e-9, 0, 0, 1e-9, 0]), np.array([0, 0, 10, 10, 0, 0])), 0.4
    assert judged(jump, "acceleration").share > 1.5
    assert judged(jump, "acceleration", replace(ONE, axes=(replace(AXIS, jump=10),))).share < 0.05


def corner(speed: float) -> tuple[PathSettings, list[Line], list[np.ndarray], list[np.ndarray]]:
    """Two lines at a right angle, passed at this speed."""
    settings = PathSettings((AXIS, AXIS), HZ)
    rise = speed / 1000
    first, second = [0, 0.02, 0.02 + rise, 0.3], [0.3, 0.3, 0.5, 0.5 + rise]
    x = integral(np.array([*first, 0.3 + 1e-9, 1.0]), np.array([0, 0, speed, speed, 0, 0]))
    y = integral(np.array([0, *second, 1.0]), np.array([0, 0, speed, speed, 0, 0]))
    trains = [steps(place, 0.9, 400) for place in (x, y)]
    ends = [float(place(np.array([0.95]))[0]) for place in (x, y)]
    lines: list[Line] = [((ends[0], 0), None), ((ends[0], ends[1]), None)]
    return settings, lines, [clocks for clocks, _ in trains], [positions for _, positions in trains]


def test_a_corner_is_rounded() -> None:
    """As fast as the junction deviation allows, 5.8 mm/s, it is no fault; at 15 mm/s it is."""
    for speed, most, least in ((5.8, 1.03, 0.3), (15, 3, 1.2)):
        settings, lines, clocks, positions = corner(speed)
        found = shares(clocks, positions, settings, Marks.of(lines, settings, clocks, positions))
        assert least < max(share.share for share in found if share.name == "acceleration") < most
    assert faults(shares(clocks, positions, settings))  # and without the corner anyway


def test_the_parts_of_a_curve_add_up() -> None:
    """Tangential and centripetal acceleration at 1000 mm/s^2 each are more than an axis has."""
    angle = lambda t: np.clip(t, 0, 0.25) ** 2 * 1000 / 2 / 10  # noqa: E731
    settings = PathSettings((AXIS, AXIS), HZ)
    axes = [
        steps(lambda t: 10 * np.sin(angle(t)), 0.25, 400),
        steps(lambda t: 10 - 10 * np.cos(angle(t)), 0.25, 400),
    ]
    cut = [(c[c < 0.1 * HZ], p[c < 0.1 * HZ]) for c, p in axes]
    found = shares([c for c, _ in cut], [p for _, p in cut], settings, names=("acceleration",))
    assert max(share.share for share in found) > 1.3


def turned_round(acceleration: float, phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Up and slower to 1 mm/s, back immediately at 20 mm/s, faster, to rest; then a step takes 125 us."""
    part = 20 / acceleration
    times = np.cumsum([0, 0.01, 21 / acceleration, 0.03 + phase, part, 1e-9, part, 0.03, 2 * part, 0.05])
    train = integral(times, np.array([0, 0, 21, 21, 1, -20, -40, -40, 0, 0]))
    return steps(train, float(times[-1]), 400)


def waited(clocks: np.ndarray, positions: np.ndarray, turning: int) -> np.ndarray:
    """When the steps leave pins that take so long to turn DIR; those behind follow a microsecond apart."""
    left, way = clocks.copy(), np.diff(positions, prepend=0)
    for k in range(1, len(left)):
        left[k] = max(left[k], left[k - 1] + (turning if way[k] != way[k - 1] else HZ // 1_000_000))
    return left


def test_steps_that_wait_for_dir_are_no_acceleration() -> None:
    """Late steps are known to be late; an axis that asks for too much is seen all the same."""
    machine, turning = replace(ONE, axes=(replace(AXIS, jump=21),)), HZ // 1000

    def greatest(factor: float, known: int) -> float:
        found = 0.0
        for phase in np.arange(0, 120e-6, 10e-6).tolist():  # one of them waits for nearly all of it
            clocks, positions = turned_round(1000 * factor, phase)
            left = waited(clocks, positions, turning)
            (share,) = shares([left], [positions], machine, names=("acceleration",), turning=known)
            found = max(found, share.share)
        return found

    assert greatest(1.0, 0) > 1.1
    assert 0.95 < greatest(1.0, turning) < 1.01
    assert greatest(1.06, turning) > 1.03


def test_steps_that_did_not_wait_hide_nothing() -> None:
    """A long time to turn DIR changes nothing where the steps of both directions are farther apart."""
    times = np.cumsum([0, 0.01, 0.06, 0.1, 0.12, 0.1, 0.06, 0.05])
    train = integral(times, np.array([0, 0, 60, 60, -60, -60, 0, 0])), float(times[-1])
    clocks, positions = steps(*train, 400)
    own = [
        shares([clocks], [positions], ONE, names=("acceleration",), turning=turning)
        for turning in (0, HZ // 10_000)
    ]
    assert own[0] == own[1]
