# SPDX-License-Identifier: MIT
"""The limits of lines and corners by the rules of docs/path.md, in mm and seconds; the steps in integers."""

import math
import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from passo import native
from passo.build import Parameters
from passo.path import PathAxis, PathSettings
from passo.random_cases import log_uniform

from tests.helpers.core_steps import tables
from tests.helpers.path_parts import CAPACITY, SQUARE_MAX, CheckedPath, checked, ffi, parts
from tests.test_path_parts import ahead as ahead
from tests.test_path_parts import randoms

UNIT = 1 << 32
SUBSTEPS_PER_MM_MAX = 1 << 18
SHAPES = {"linear": 0, "cosine": 1, "sigmoid": 2, "jerk": 1}


def some_axis(rng: random.Random, jump: bool = True) -> PathAxis:
    return PathAxis(
        steps_per_mm=log_uniform(rng, 1, 2000),
        speed=log_uniform(rng, 1, 300),
        acceleration=log_uniform(rng, 10, 20_000),
        jump=rng.choice((0, log_uniform(rng, 0.1, 10))) if jump else 0,
        jerk=log_uniform(rng, 1e3, 1e7),
    )


def some_machine(rng: random.Random, count: int = 0, **members: Any) -> PathSettings:
    """Of any axes."""
    axes = tuple(some_axis(rng) for _ in range(count or rng.randint(1, 8)))
    profile = rng.choice(tuple(SHAPES))
    clock = rng.choice((16_000_000, 64_000_000, 100_000_000))
    members = {"profile": profile, "clock_hz": clock, "polls": 1_000_000, **members}
    return PathSettings(axes, tolerance=0, junction_deviation=log_uniform(rng, 1e-3, 0.1), **members)


@cache
def gentleness(profile: str) -> float:
    """Mean slope of a shape by its steepest."""
    table = [*tables()[SHAPES[profile]][:256], 65536]
    steepest = max(b - a for a, b in pairwise(table))
    return 256 / steepest if SHAPES[profile] else 1


class Scale:
    """From the units of a path to mm and s."""

    def __init__(self, path: CheckedPath) -> None:
        self.per_mm, self.hz = path.substeps_per_mm, path.settings.clock_hz

    def speed(self, velocity: float) -> float:
        """UQ0.32."""
        return velocity / UNIT * self.hz / self.per_mm

    def square(self, square: float) -> float:
        """UQ0.64."""
        return square / 2**64 * (self.hz / self.per_mm) ** 2

    def acceleration(self, value: float) -> float:
        """UQ0.64."""
        return value / 2**64 * self.hz**2 / self.per_mm

    def jerk(self, value: float) -> float:
        """UQ0.80."""
        return value / 2**80 * self.hz**3 / self.per_mm


# -------------------------------------------------------------------------------------------- settings


def test_a_substep_is_as_short_as_the_speed_allows() -> None:
    """Half of one per clock at the highest speed, or better a quarter; not shorter than 2^-18 mm, but two for
    each step. No machine is refused for which that is possible."""
    refused = 0
    for rng in randoms("scale", 200):
        settings = some_machine(rng, clock_hz=int(log_uniform(rng, 1e5, 1e8)))
        speed = math.hypot(*(float(axis.speed) for axis in settings.axes))
        steps = max(float(axis.steps_per_mm) for axis in settings.axes)
        half = settings.clock_hz / 2 / speed
        planner, error = opened(settings.struct(Parameters()))
        if error:
            assert error == "TOO_FAST" and half < 2 * steps + 2
            refused += 1
            continue
        found = planner.substeps_per_mm
        assert 2 * steps <= found <= half
        assert found <= max(SUBSTEPS_PER_MM_MAX, 2 * steps + 2)
        wanted = min(half / 2, SUBSTEPS_PER_MM_MAX)
        assert found == pytest.approx(wanted, rel=1e-6, abs=1.5) or wanted < found <= 2 * steps + 2
    assert 10 < refused < 150


def opened(settings: Any, capacity: int = CAPACITY) -> tuple[Any, str]:
    """A `struct passo_path_planner`, and the name of an error."""
    library, ffi = checked(), native.ffi()
    planner = ffi.new("struct passo_path_planner *")
    KEEP.append(ffi.new("struct passo_path_item[]", CAPACITY))
    error = library.passo_path_open(planner, settings, KEEP[-1], capacity)
    KEEP[:-1] = []
    return planner, ffi.string(library.passo_plan_error_name(error)).decode() if error else ""


KEEP: list[Any] = []


def test_the_limits_of_axes_in_substeps_and_clocks() -> None:
    """Speed, acceleration, jerk and jump, as far as there are bits; deviation, tolerance, reserve."""
    for rng in randoms("axes", 100):
        settings = some_machine(rng)
        tick_log2 = rng.choice((4, 7, 10))
        settings = replace(
            settings,
            tolerance=rng.choice((None, 0.001, 0)),
            reserve_clocks=rng.choice((0, rng.randint(1, 10**7))),
            acceleration=rng.choice((0, log_uniform(rng, 10, 10_000))),
        )
        c, error = opened(settings.struct(Parameters(tick_log2=tick_log2)))
        if error:
            continue
        per_mm, hz = c.substeps_per_mm, settings.clock_hz
        for i, axis in enumerate(settings.axes):
            own = c.axis[i]
            assert own.speed == pytest.approx(float(axis.speed) * per_mm / hz * 2**32, rel=1e-6, abs=2)
            assert own.jump == pytest.approx(float(axis.jump) * per_mm / hz * 2**32, rel=1e-6, abs=2)
            wide = min(float(axis.acceleration) * per_mm / hz**2 * 2**64, SQUARE_MAX / 4)
            assert own.acceleration == pytest.approx(wide, rel=1e-6, abs=2)
            wide = min(float(axis.jerk) * per_mm / hz**3 * 2**80, SQUARE_MAX)
            assert own.jerk == pytest.approx(wide, rel=1e-5, abs=2)
            assert c.steps_per_mm[i] == round(float(axis.steps_per_mm) * UNIT)
        along = float(settings.acceleration) * per_mm / hz**2 * 2**64 or SQUARE_MAX / 4
        assert c.acceleration == pytest.approx(along, rel=1e-6, abs=2)
        deviation = float(settings.junction_deviation)
        assert c.deviation == pytest.approx(deviation * per_mm * 65536, rel=1e-6, abs=8)
        wanted = {None: deviation / 20}.get(settings.tolerance, settings.tolerance)
        assert c.tolerance == c.own_tolerance == pytest.approx(wanted * per_mm * 65536, rel=1e-6, abs=8)
        assert c.reserve == ((settings.reserve_clocks or hz // 50) >> tick_log2) + 1
        assert c.gentleness / 65536 == pytest.approx(gentleness(settings.profile), abs=3e-3)
        assert c.gentleness / 65536 <= gentleness(settings.profile)
        assert (
            c.polls == 1_000_000
            and c.override == c.rapid == 1 << 16
            and c.soft == (settings.profile == "jerk")
        )


def test_tiny_limits_are_not_none() -> None:
    """An axis with the least acceleration and jerk that can be written still moves."""
    weak = PathAxis(80, 10, Fraction(1, UNIT), jerk=Fraction(1, UNIT))
    c, error = opened(PathSettings((weak,), profile="jerk").struct(Parameters()))
    assert error == "" and c.axis[0].acceleration == c.axis[0].jerk == 1


REFUSED = [
    ({"machine.clock_hz": 0}, "BAD_CLOCK"),
    ({"machine.tick_log2": 6}, "BAD_CLOCK"),
    ({"machine.tick_log2": 17}, "BAD_CLOCK"),
    ({"machine.axes": 0}, "BAD_AXES"),
    ({"machine.axes": 9}, "BAD_AXES"),
    ({"profile": 4}, "BAD_PROFILE"),
    ({"steps_per_mm": 0}, "NO_SCALE"),
    ({"speed": 0}, "NO_AXIS_SPEED"),
    ({"acceleration": 0}, "NO_AXIS_ACCELERATION"),
    ({"jerk": 0, "profile": 3}, "NO_JERK"),
    ({"steps_per_mm": (1 << 52) + 1, "speed": 1}, "TOO_FAST"),
]
TAKEN = [
    {"jerk": 0, "profile": 2},
    {"profile": 3},
    {"machine.axes": 1},
    {"machine.tick_log2": 7},
    {"machine.tick_log2": 16},
    {"machine.axes": 8},
    {"steps_per_mm": 1, "speed": 1, "acceleration": 1},
    {"steps_per_mm": 1 << 52, "speed": UNIT // 10, "machine.axes": 1},
    {"machine.clock_hz": 0xFFFFFFFF},
]


def changed(changes: dict[str, int]) -> Any:
    """Good settings of eight axes with changes; those of an axis are of the last one in use."""
    made = PathSettings((PathAxis(jerk=1000),) * 8).struct(Parameters())
    made.machine.axes = changes.get("machine.axes", 8)
    for name, value in changes.items():
        of, _, member = name.rpartition(".")
        if of:
            setattr(made.machine, member, value)
        elif hasattr(made.axis[0], name) and name != "profile":
            setattr(made.axis[min(made.machine.axes, 8) - 1], name, value)
        else:
            setattr(made, name, value)
    return made


@pytest.mark.parametrize(("changes", "name"), REFUSED)
def test_what_no_machine_is(changes: dict[str, int], name: str) -> None:
    """Each by its name, of the last axis as of any."""
    assert opened(changed(changes))[1] == name


@pytest.mark.parametrize("changes", TAKEN)
def test_what_a_machine_may_just_be(changes: dict[str, int]) -> None:
    """At the ends of each range."""
    assert opened(changed(changes))[1] == ""
    assert opened(changed(changes), 3)[1] == "PATH_FULL"
    assert opened(changed(changes), 4)[1] == ""


# ----------------------------------------------------------------------------------------------- lines


def direction(before: list[int], target: list[int]) -> tuple[np.ndarray, float]:
    """Unit vector and length in mm between two places in 2^-32 mm."""
    way = np.array([float(b - a) / UNIT for a, b in zip(before, target, strict=True)])
    length = float(np.linalg.norm(way))
    return way / (length or 1), length


def some_place(rng: random.Random, before: list[int]) -> list[int]:
    """Near or far, of some of the axes."""
    size = log_uniform(rng, 0.05, 100)
    moved = [rng.random() < 0.6 for _ in before]
    return [
        mm + round(rng.uniform(-size, size) * UNIT) if moves else mm
        for mm, moves in zip(before, moved, strict=True)
    ]


def add(path: CheckedPath, target: list[int], feed: float | None) -> Any:
    """Add a line to a place in 2^-32 mm; its item."""
    wanted = (1 << 64) - 1 if feed is None else round(feed * UNIT)
    move = native.ffi().new("struct passo_path_move *", (target, wanted, 0))
    assert checked().passo_path_add(path.c, move) == 0
    return path.item(path.c.added - 1)


def test_steps_are_those_between_rounded_places() -> None:
    """Of each axis, exactly, to the nearer step; the length of the lines adds up to less than a substep."""
    for rng in randoms("steps", 150):
        path = CheckedPath(some_machine(rng))
        axes = len(path.settings.axes)
        scales = [path.c.steps_per_mm[i] for i in range(axes)]
        at, steps, length, made = [0] * axes, [0] * axes, 0.0, 0
        for _ in range(rng.randint(1, 20)):
            target = some_place(rng, at)
            before = path.c.added
            item = add(path, target, 10)
            if target == at:
                assert path.c.added == before
                continue
            rounded = [
                int(math.copysign((abs(mm) * scale + (1 << 63)) >> 64, mm))
                for mm, scale in zip(target, scales, strict=True)
            ]
            for i in range(axes):
                moved = -item.steps[i] if item.directions >> i & 1 else item.steps[i]
                assert moved == rounded[i] - steps[i]
                assert rounded[i] != steps[i] or not item.directions >> i & 1
            assert item.substeps >= max(item.steps[i] for i in range(axes))
            length += direction(at, target)[1] * path.substeps_per_mm
            made += item.substeps
            at, steps = target, rounded
            assert made - length == pytest.approx(0, abs=0.51 + length * 1e-8)


def test_lines_that_are_none() -> None:
    """No feed, out of range, too long; what is too short becomes part of the next one."""
    settings = PathSettings((PathAxis(0.001, 10), PathAxis(0.001, 10)), tolerance=0)
    far = 1 << 62
    library, ffi = checked(), native.ffi()

    def error(path: CheckedPath, target: int, feed: int) -> str:
        move = ffi.new("struct passo_path_move *", ([0, target], feed, 0))
        found = library.passo_path_add(path.c, move)
        return ffi.string(library.passo_plan_error_name(found)).decode() if found else ""

    path = CheckedPath(settings)
    assert error(path, UNIT, 0) == "NO_FEED"
    for sign in (1, -1):
        assert error(path, sign * far, UNIT) == "TOO_FAR"
        assert error(path, sign * (far - 1), UNIT) == "TOO_LONG"
        longest = ((1 << 30) << 32) // path.substeps_per_mm
        assert error(path, sign * (longest + UNIT // 100), UNIT) == "TOO_LONG"
        assert path.c.added == 0
    assert error(path, longest - UNIT // 100, UNIT) == "" and path.item(0).substeps > (1 << 30) - 4000
    path = CheckedPath(settings)
    half = UNIT // 2 // path.substeps_per_mm
    assert error(path, half * 9 // 10, UNIT) == "" and path.c.added == 0
    assert error(path, half * 11 // 10, UNIT) == "" and path.c.added == 1 and path.item(0).substeps == 1


def test_a_line_is_limited_by_its_axes() -> None:
    """Speed and acceleration along it are those of the axis that has the least for its part of it; a shape
    takes its part of the acceleration; it begins and ends at the least start-stop speed."""
    for rng in randoms("line", 300):
        settings = replace(some_machine(rng), acceleration=rng.choice((0, log_uniform(rng, 10, 10_000))))
        path, at = CheckedPath(settings), [0] * len(settings.axes)
        scale = Scale(path)
        target = some_place(rng, at)
        if max(map(abs, target)) < UNIT // 100:
            continue
        feed = rng.choice((None, log_uniform(rng, 0.1, 1000)))
        item = add(path, target, feed)
        unit, _ = direction(at, target)
        share = np.abs(unit)
        moves = share > 0
        speed, acceleration, jerk, jump = (
            np.array([float(getattr(axis, name)) for axis in settings.axes])[moves]
            for name in ("speed", "acceleration", "jerk", "jump")
        )
        own = share[moves]
        limit = (speed / own).min()
        assert scale.speed(item.limit) == pytest.approx(limit, rel=1e-5)
        assert item.rapid == (feed is None)
        top = min(limit, feed or limit)
        assert scale.square(item.top) == pytest.approx(top**2, rel=1e-4)
        along = float(settings.acceleration) or 1e12
        most, weakest = min((acceleration / own).min(), along), min(acceleration.min(), along)
        part = gentleness(settings.profile)
        if settings.profile == "jerk":
            assert scale.jerk(item.jerk) == pytest.approx(
                (jerk / own).min() * 2 / math.pi**2 * 31 / 32, rel=3e-3
            )
        elif settings.profile != "linear":
            most = weakest * 2 ** math.floor(math.log2(most / weakest * (1 + 1e-9)))
        assert scale.acceleration(item.slope) / 2 == pytest.approx(most * part, rel=3e-3)
        begin = min(top, (np.where(jump > 0, jump, 0) / own).min())
        assert scale.speed(item.halt) == pytest.approx(begin, rel=1e-4, abs=1e-6)
        assert scale.square(item.corner) == pytest.approx(begin**2, rel=1e-3, abs=1e-9)


def test_overrides_scale_the_feed_up_to_the_limit() -> None:
    """That of feeds from 1 to 10, that of rapids from 0.01 to 1; each leaves the other."""
    library = checked()
    for rng in randoms("override", 100):
        settings = replace(some_machine(rng, 2), axes=(some_axis(rng), some_axis(rng)))
        path, scale = CheckedPath(settings), None
        scale = Scale(path)
        feed = log_uniform(rng, 0.1, 1000)
        lines = [([0, UNIT * 20], feed), ([UNIT * 20, UNIT * 20], None), ([UNIT * 30, UNIT * 20], feed)]
        for target, wanted in lines:
            add(path, target, wanted)
        override, rapid = rng.choice((0.1, 1, log_uniform(rng, 1, 10), 20)), rng.choice((0, 0.5, 1, 2))
        library.passo_path_override(path.c, round(override * 65536))
        library.passo_path_rapid(path.c, round(rapid * 65536))
        for i, axis in enumerate((1, 0, 0)):
            limit = float(settings.axes[axis].speed)
            top = limit * min(max(rapid, 0.01), 1) if i == 1 else min(limit, feed * min(max(override, 1), 10))
            assert scale.square(path.item(i).top) == pytest.approx(top**2, rel=5e-3)
        for i in (1, 2):
            item = path.item(i)
            assert item.corner <= min(item.bend, item.top, path.item(i - 1).top)


# --------------------------------------------------------------------------------------------- corners


Line = tuple[np.ndarray, float]  # direction and length, mm


def corner_of(settings: PathSettings, one: Line, other: Line) -> tuple[float, float, list[float]]:
    """The highest square at a corner between two lines, the length of its arc and what is before and behind
    the corner, in mm."""
    (u, before), (w, behind) = one, other
    change = w - u
    cosine = float(np.linalg.norm(change)) / 2
    sine = math.sqrt(max(0, 1 - cosine**2))
    arc = float(settings.junction_deviation) * 2 * sine * (1 + sine) / cosine
    sides = [min(before / 2, arc), min(behind / 2, arc)]
    sides = [min(a, max(17 / 16 * b, 3 / 8 * arc + b / 2)) for a, b in (sides, sides[::-1])]
    over = min(arc, sum(sides))
    squares = [1e30]
    for axis, part in zip(settings.axes, np.abs(change), strict=True):
        if part > 1e-9:
            squares.append(float(axis.acceleration) * over / part)
            if axis.jump:
                squares.append((float(axis.jump) / part) ** 2)
    return min(squares), over, sides


def random_corners(
    name: str, least: float, most: float
) -> Iterator[tuple[PathSettings, CheckedPath, Any, Line, Line]]:
    """Machine, path, item of the second line, and two lines whose directions differ by `least` to `most`."""
    for rng in randoms(name, 300):
        settings = some_machine(rng, profile="linear")
        path = CheckedPath(settings)
        begin = [0] * len(settings.axes)
        first = some_place(rng, begin)
        second = some_place(rng, first)
        one, other = direction(begin, first), direction(first, second)
        if min(one[1], other[1]) < 0.01 or not least < float(np.linalg.norm(other[0] - one[0])) < most:
            continue
        add(path, first, None)
        yield settings, path, add(path, second, None), one, other


def test_a_corner_is_as_fast_as_its_axes_allow() -> None:
    """Each changes its speed within its acceleration, over the arc that deviates as much as allowed, or half
    of both lines; or immediately by its start-stop speed."""
    for settings, path, item, one, other in random_corners("corner", 1e-3, 1.9999):
        scale = Scale(path)
        square, over, _ = corner_of(settings, one, other)
        if over * path.substeps_per_mm < 4:
            continue
        ceiling = scale.square(SQUARE_MAX)
        assert scale.square(item.bend) == pytest.approx(min(square, ceiling), rel=2e-3)
        if not item.rest:
            assert item.corner == min(item.bend, item.top, path.item(0).top)


def test_a_lone_corner_says_what_it_needs() -> None:
    """On either side the axis that has the most, of its acceleration, along both lines and by the corner, of
    those that the path up, or down, speeds up the way that they turn; and the one that has most along the
    lines. A valley is a corner whose axes have it where the path comes down to it and speeds up behind it."""
    valleys = [0, 0]
    for settings, path, item, one, other in random_corners("rounding", 1e-2, 1.999):
        square, over, sides = corner_of(settings, one, other)
        change = other[0] - one[0]
        alone = [side < size / 2 * (1 - 1e-4) for side, size in zip(sides, (one[1], other[1]), strict=True)]
        if over * path.substeps_per_mm < 100 or any(
            abs(side / size - 0.5) < 1e-3 and not math.isclose(side, size / 2)
            for side, size in zip(sides, (one[1], other[1]), strict=True)
        ):
            continue
        if not any(alone):
            assert item.turn == 0 and not item.valley
            continue
        turn = sides[0] if alone[0] else sides[1]
        assert item.turn == pytest.approx(turn * path.substeps_per_mm, rel=1e-3, abs=1.5)
        count = 1 if all(alone) else 2
        most, lost, valley = [0.0, 0.0], [0.0, 0.0], all(alone)
        for j, axis in enumerate(settings.axes):
            if abs(change[j]) < 1e-9:
                continue
            acceleration = float(axis.acceleration)
            bend = acceleration * over / abs(change[j])
            needed = count * min(square, bend) / bend
            own = [
                min(Scale(path).acceleration(path.item(k).slope) / 2 * abs(unit[j]) / acceleration, 1)
                * alone[k]
                for k, unit in ((0, one[0]), (1, other[0]))
            ]
            signed = [
                math.copysign(part, unit[j]) for part, unit in zip(own, (one[0], other[0]), strict=True)
            ]
            for rises, way in ((0, -1), (1, 1)):
                if any(way * part * math.copysign(1, change[j]) > 1 / 32767 for part in signed):
                    most[rises] = max(most[rises], count * sum(own) + needed)
                    lost[rises] = max(lost[rises], count * sum(own))
            excess = math.copysign(1, change[j]) * (signed[1] - signed[0]) + needed - 2
            if abs(excess) < 2e-3:
                valley = item.valley
            elif excess > 0:
                valley = False
        for rises, (first, second) in enumerate(item.lone):
            assert (first.lost + first.needed) / 128 == pytest.approx(min(most[rises], 4), abs=0.02)
            assert second.lost / 128 == pytest.approx(min(lost[rises], 2), abs=0.01)
        assert item.valley == valley
        valleys[bool(valley)] += 1
    assert min(valleys) > 10


def test_a_curve_leaves_each_axis_its_acceleration() -> None:
    """Along the path and across it together, in each half of a line by the corner at its end."""
    for rng in randoms("linear curve", 40):
        axes = tuple(PathAxis(80, 300, log_uniform(rng, 500, 2000)) for _ in range(2))
        settings = PathSettings(axes, tolerance=0, junction_deviation=1)
        path = CheckedPath(settings)
        radius, chords = log_uniform(rng, 1, 50), rng.randint(60, 200)
        units = circle(path, radius, chords, None, 12)
        length = 2 * radius * math.sin(math.pi / chords)
        scale = Scale(path)
        for i in range(2, 10):
            item = path.item(i)
            for half, up in ((0, True), (0, False), (1, True), (1, False)):
                bent = (units[i] - units[i - 1] if half == 0 else units[i + 1] - units[i]) / length
                low = rng.randint(0, item.bend)
                square = scale.square(low)
                found = (
                    scale.acceleration(parts().passo_path_slope(ffi().addressof(item), half, up, low, 0)) / 2
                )
                helps = bent * units[i] > 0
                exact = 1e30
                for j, axis in enumerate(axes):
                    if abs(units[i][j]) > 0.005:
                        taken = square * abs(bent[j]) if helps[j] == up else 0
                        exact = min(exact, (float(axis.acceleration) - taken) / abs(units[i][j]))
                assert found == pytest.approx(max(exact, 0), rel=3e-3, abs=1)


def test_straight_on_is_no_corner() -> None:
    """And a reversal is an exact stop, or in a direction that has to be rounded nearly one."""
    path = CheckedPath(PathSettings((PathAxis(), PathAxis()), tolerance=0))
    add(path, [UNIT, 2 * UNIT], None)
    item = add(path, [3 * UNIT, 6 * UNIT], None)
    assert item.bend == SQUARE_MAX and item.corner == item.top and not item.rest
    item = add(path, [UNIT, 2 * UNIT], None)
    assert Scale(path).square(item.corner) < 0.05**2
    for place in (1, 1.5):
        item = add(path, [UNIT, round(place * UNIT)], None)
    assert item.rest and item.corner == 0


# ------------------------------------------------------------------------------- curves of shaped ramps


def circle(path: CheckedPath, radius: float, chords: int, feed: float | None, count: int) -> list[np.ndarray]:
    """Lines around a circle; their unit vectors."""
    at, units = [0, 0], []
    for i in range(1, count + 1):
        angle = 2 * math.pi * i / chords
        target = [round(radius * math.sin(angle) * UNIT), round(radius * (1 - math.cos(angle)) * UNIT)]
        units.append(direction(at, target)[0])
        add(path, target, feed)
        at = target
    return units


@pytest.mark.parametrize("profile", ["cosine", "sigmoid", "jerk"])
def test_a_ramp_in_a_curve_keeps_the_acceleration_of_each_axis(profile: str) -> None:
    """Where it is steepest, along the curve and across it together, whatever the feed. By what is needed
    across at the speed of the lines, these have all, three quarters or half of the acceleration along them;
    the curve is as fast as the rest allows, with half nearly 0.87 of the square."""
    for rng in randoms(f"curve {profile}", 60):
        axes = tuple(
            PathAxis(80, 300, log_uniform(rng, 500, 2000), jerk=10 ** rng.choice((4, 5, 7))) for _ in range(2)
        )
        if rng.random() < 0.5:
            axes = (axes[0], axes[0])
        settings = PathSettings(axes, profile=profile, tolerance=0, junction_deviation=1)
        path = CheckedPath(settings)
        radius, chords = log_uniform(rng, 1, 50), rng.randint(60, 200)
        feed = rng.choice((None, log_uniform(rng, 5, 200)))
        count = min(chords // 2, CAPACITY - 2)
        units = circle(path, radius, chords, feed, count)
        scale = Scale(path)
        length = 2 * radius * math.sin(math.pi / chords)
        top = min(feed or 1e9, 300)
        for i in range(2, count - 1):
            item = path.item(i)
            square = min(scale.square(item.bend), top**2, scale.square(item.top))
            change = np.abs(units[i] - units[i - 1]).tolist()
            for j, axis in enumerate(axes):
                most = float(axis.acceleration)
                across = square * change[j] / length
                peaks = [
                    scale.acceleration(path.item(k).slope) / 2 / gentleness(profile) * abs(units[k][j])
                    for k in (i - 1, i)
                ]
                assert across + max(peaks) <= most * (1 + 1 / 64 + 1e-3)
                part = max(1, math.hypot(*change) / 8 / max(change[j], 1e-9))  # hardly turns
                if profile == "jerk":
                    assert scale.square(item.bend) ** 1.5 / radius**2 <= 0.51 * float(axis.jerk) * part
            if axes[0] == axes[1] and profile != "jerk":
                most = float(axes[0].acceleration)
                alone = most * length / math.hypot(*change)
                needs = top**2 / alone
                left, share = (0.5, 0.84) if needs > 0.95 else (0.75, 0.63) if needs > 0.19 else (1, 0.12)
                assert scale.square(item.bend) >= min(share * alone, top**2)
                slope = scale.acceleration(item.slope) / 2 / gentleness(profile)
                if min(abs(needs - 11 / 64), abs(needs - 60 / 64)) > 0.02:
                    assert slope == pytest.approx(left * most, rel=3e-3)
        if profile == "jerk" and axes[0] == axes[1]:
            jerk, most = float(axes[0].jerk), float(axes[0].acceleration)
            middle = scale.square(path.item(count // 2).bend)
            # 3 v t / r, 0.7 of the jerk
            steepest = scale.acceleration(path.item(count // 2).slope) / 2 / gentleness(profile)
            assert steepest <= 0.24 * jerk * radius / math.sqrt(min(middle, top**2))
            # with half of the jerk for the ramps at least
            assert middle >= 0.8 * min((jerk / 2 * radius**2) ** (2 / 3), 0.63 * most * radius, top**2)


@pytest.mark.parametrize("profile", ["cosine", "jerk"])
def test_the_lines_beside_a_curve_keep_their_acceleration(profile: str) -> None:
    """Those of the curve alone have less, the first and the last of them too."""
    axis = PathAxis(80, 300, 1000, jerk=1_000_000)
    settings = PathSettings((axis, axis), profile=profile, tolerance=0, junction_deviation=0.05)
    path, scale = CheckedPath(settings), None
    scale = Scale(path)
    at, heading = [0.0, 0.0], 0.0
    sizes = [50.0, *(1.0 for _ in range(8)), 50.0]
    for number, size in enumerate(sizes):
        heading += math.radians(6) if number else 0
        at = [at[0] + size * math.cos(heading), at[1] + size * math.sin(heading)]
        add(path, [round(mm * UNIT) for mm in at], None)
    slopes = [scale.acceleration(path.item(i).slope) / 2 / gentleness(profile) for i in range(len(sizes))]
    assert slopes[0] == pytest.approx(1000, rel=0.01)
    assert slopes[-1] >= 990
    assert max(slopes[1:-1]) < 760


def test_the_jerk_between_two_curves_is_limited() -> None:
    """Where a path turns to the other side, the acceleration across it jumps by k v^2; steps that are off by
    e show that as k v^3 sqrt(k / e) / 11 of jerk. Two thirds of the jerk are for the ramps, and for the jumps
    of a zigzag, which add up."""
    limited = 0
    for rng in randoms("between", 40):
        jerk, radius = log_uniform(rng, 1e4, 1e6), log_uniform(rng, 5, 50)
        axis = PathAxis(80, 300, 1e5, jerk=jerk)
        settings = PathSettings((axis, axis), profile="jerk", tolerance=0, junction_deviation=1)
        path, chords = CheckedPath(settings), rng.randint(60, 200)
        scale = Scale(path)
        at, heading, turn = [0.0, 0.0], rng.uniform(0, 6), 2 * math.pi / chords
        before = rng.choice((3, 4, 12))
        length = 2 * radius * math.sin(math.pi / chords)
        for number in range(before + 8):
            heading += turn if number < before else -turn
            at = [at[0] + length * math.cos(heading), at[1] + length * math.sin(heading)]
            item = add(path, [round(mm * UNIT) for mm in at], None)
            if number == before:
                found = scale.square(item.bend)
        # half of the height of the chords, and the lines that were merged
        k, e = 2 * turn / length, 1 / 20 + length * turn / 16
        between = (11 / 2 * jerk / k / math.sqrt(k / e)) ** (2 / 3)
        alone = (jerk / 2 * radius**2) ** (2 / 3)
        wanted = min(alone, 300**2)
        if between < 0.9 * wanted:
            assert found == pytest.approx(between * (8 / 11) ** (2 / 3), rel=0.03)
            limited += 1
        else:
            assert found >= 0.85 * wanted
    assert limited > 5


def test_ramps_over_a_lone_corner_leave_it_what_it_needs() -> None:
    """Profile jerk: half of a corner's acceleration, and what is steepest of a ramp over it, which lacks
    its 256ths of the slope, are all that an axis has."""
    lacking = 0
    for rng in randoms("over", 150):
        axis = PathAxis(80, 300, log_uniform(rng, 500, 2000), jerk=log_uniform(rng, 1e5, 1e7))
        settings = PathSettings((axis, axis), profile="jerk", tolerance=0, junction_deviation=0.05)
        path, scale = CheckedPath(settings), None
        scale = Scale(path)
        turn, heading = math.radians(rng.uniform(5, 90)), rng.uniform(0, 2 * math.pi)
        first = [round(50 * math.cos(heading) * UNIT), round(50 * math.sin(heading) * UNIT)]
        second = [
            first[0] + round(50 * math.cos(heading + turn) * UNIT),
            first[1] + round(50 * math.sin(heading + turn) * UNIT),
        ]
        feed = rng.choice((None, log_uniform(rng, 1, 100)))
        add(path, first, feed)
        item = add(path, second, feed)
        one, other = direction([0, 0], first), direction(first, second)
        _, over, _ = corner_of(settings, one, other)
        change = other[0] - one[0]
        radius, weakest = (
            over / float(np.linalg.norm(change)),
            float(axis.acceleration) * over / np.abs(change).max(),
        )
        soft = (float(axis.jerk) / 2 * radius**2) ** (2 / 3)
        assert scale.square(item.bend) == pytest.approx(min(weakest, soft), rel=0.02)
        square = min(scale.square(item.bend), 300**2, (feed or 1e9) ** 2)
        exact = 0.0
        for j in range(2):
            along = max(
                scale.acceleration(path.item(k).slope) / 2 / gentleness("jerk") * abs(unit[j])
                for k, unit in ((0, one[0]), (1, other[0]))
            )
            needed = square * abs(other[0][j] - one[0][j]) / over / 2
            if along > 0:
                exact = max(exact, (along + needed - float(axis.acceleration)) / along)
        assert item.over / 255 == pytest.approx(exact, abs=0.012)
        lacking += item.over > 0
    assert lacking > 20
