# SPDX-License-Identifier: MIT
"""The parts of the path planner against the physics: closed forms, and the recurrence of the core.

Of a velocity v at a place x: `slope` is d(v^2)/dx, twice the acceleration.
"""

import math
import random
from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import pytest
from passo import random_cases
from passo.native import planner
from passo.random_cases import log_uniform

from tests.helpers.core_steps import sum_of_velocities, tables
from tests.helpers.path_parts import CAPACITY, NEVER, ONE, SQUARE_MAX, Planner, ffi, lone_item, parts
from tests.helpers.plans import COSINE, LINEAR, SIGMOID, Ramp

UNIT = 1 << 32
VELOCITY_MAX = 1 << 47
PARTS = 8  # of a line, at most
DOWN = Fraction(255, 256)  # of the slope is used to come down
UP, FLAT, FALL = range(3)


def ahead() -> None:
    """The libraries."""
    parts()
    planner()


def randoms(name: str, count: int) -> Iterator[random.Random]:
    for number in range(count):
        yield random.Random(f"{random_cases.seed()} {name} {number}")


def whole(rng: random.Random, low: float, high: float) -> int:
    """An integer of any size."""
    return int(log_uniform(rng, low, high))


# ------------------------------------------------------------------------------------- under a ramp


def ramp_of(ticks: int, shape: int, end: int) -> Any:
    ramp = ffi().new("struct passo_ramp *", {"shape": shape, "velocity_end": end})
    parts().passo_path_set_ticks(ramp, ticks)
    return ramp


def test_the_progress_of_all_ticks_is_the_whole_ramp() -> None:
    """To half of a tick's; a single tick has as much as there is, and none has none."""
    for ticks in (2, 3, 5, 7, 100, 4095, 4096, 12345, (1 << 20) - 1):
        ramp = ramp_of(ticks, LINEAR, 0)
        assert ramp.ticks == ticks and abs(ramp.progress_step * ticks - (1 << 48)) <= ticks / 2
    assert ramp_of(0, LINEAR, 0).progress_step == 0
    assert ramp_of(1, LINEAR, 0).progress_step >= (1 << 48) - 1


def some_ramp(rng: random.Random, tick_log2: int) -> tuple[Ramp, int]:
    """Up, down and level, slow and fast, short and long; and what the core makes of it, UQ.49 substeps."""
    ticks = rng.choice(
        (rng.randint(1, 64), rng.randint(1, 4095), rng.randint(4096, 8191), whole(rng, 8192, 32768))
    )
    start, end = (rng.choice((0, VELOCITY_MAX, whole(rng, 1, VELOCITY_MAX))) for _ in range(2))
    end = rng.choice((start, end, end))
    shape = rng.choice((LINEAR, LINEAR, COSINE, SIGMOID)) if start != end else LINEAR
    made = ramp_of(ticks, shape, end)
    ramp = Ramp(ticks, shape, shape != LINEAR and end < start, start, end, made.progress_step)
    return ramp, sum_of_velocities(ramp) << (tick_log2 + 1)


def test_the_distance_under_a_ramp_is_what_the_core_makes_of_it() -> None:
    """But for what rounding down takes in each tick, half a unit of the velocity."""
    for rng in randoms("distance", 300):
        tick_log2 = rng.choice((4, 7, 7, 10, 12))
        path = Planner(tick_log2)
        ramp, twice = some_ramp(rng, tick_log2)
        made = ramp_of(ramp.ticks, ramp.shape, ramp.velocity_end)
        found = parts().passo_path_distance(path.c, ramp.velocity_start, made)
        within = (ramp.ticks + 2 << tick_log2) if ramp.shape == LINEAR else (ramp.ticks << tick_log2 + 24)
        assert abs((found << 17) - twice) <= within + (1 << 17), (ramp, found)
        if ramp.velocity_start == ramp.velocity_end:
            assert found == twice >> 17


def test_a_ramp_lands_where_it_should() -> None:
    """To the last unit of the velocity, or it saturates: too slow at 0, too fast at the most there is."""
    for rng in randoms("land", 300):
        tick_log2 = rng.choice((7, 10))
        path, ticks = Planner(tick_log2), rng.choice((1, 2, rng.randint(3, 100), rng.randint(100, 30_000)))
        shape, start = rng.choice((LINEAR, COSINE)), whole(rng, 1, VELOCITY_MAX)
        twice = rng.choice((rng.randint(0, start), rng.randint(start, 1 << 48), 2 * start))
        distance = twice * ticks << tick_log2 >> 17
        ramp = ramp_of(ticks, shape, 0)
        parts().passo_path_land(path.c, start, distance, ramp)
        covered = parts().passo_path_distance(path.c, start, ramp)
        unit = (ticks << tick_log2 >> 17) + 2
        if ramp.velocity_end == 0:
            assert covered >= distance - unit
        elif ramp.velocity_end == VELOCITY_MAX:
            assert covered <= distance + unit
        else:
            assert abs(covered - distance) <= unit


def test_speed_and_length_by_acceleration_and_time() -> None:
    """dv = a t; dv^2 = 2 a s, as far as there is room for it; s = t (u + v) / 2, rounded down."""
    for rng in randoms("change", 200):
        tick_log2 = rng.choice((4, 7, 12))
        path, slope, ticks = Planner(tick_log2), whole(rng, 1, 1 << 50), whole(rng, 1, 1 << 20)
        assert parts().passo_path_change(path.c, slope, ticks) == min(slope * ticks << tick_log2 >> 17, NEVER)
        length = whole(rng, 1, 1 << 63)
        assert parts().passo_path_gain(slope, length) == min(slope * length >> 32, SQUARE_MAX)
        speeds = whole(rng, 1, 1 << 48)
        way = parts().passo_path_length_in(path.c, speeds, ticks)
        assert way == min(speeds * ticks << tick_log2 >> 17, NEVER)
        over = parts().passo_path_ticks_over(path.c, length, speeds)
        assert over == min((length << 17 - tick_log2) // speeds, NEVER)


# ------------------------------------------------------------------------------- corners in a shaped ramp


@pytest.mark.parametrize("shape", [COSINE, SIGMOID])
def test_a_shaped_ramp_ends_at_the_first_corner_that_it_passes_too_fast(shape: int) -> None:
    """The time over the shape says where it is how fast; corners at which the path rests have no say."""
    table = np.array(tables()[shape][:257]) / 65536
    area = np.concatenate(([0], np.cumsum(table[1:] + table[:-1]) / 512))
    seen = [0, 0]
    for rng in randoms(f"too fast {shape}", 300):
        begin, end = (rng.choice((0, whole(rng, 1 << 30, VELOCITY_MAX))) for _ in range(2))
        if begin == end:
            continue
        count, first = rng.randint(2, 12), rng.choice((0, 5, CAPACITY - 3))
        substeps = [rng.randint(1, 2000) for _ in range(count)]
        offset = rng.choice((0, rng.randrange(substeps[0] << 32)))
        ends = [place / UNIT for place in np.cumsum([s << 32 for s in substeps], dtype=float) - offset]
        length = rng.choice((ends[-1], ends[-1] - substeps[-1] / 2, ends[0] / 2, rng.uniform(0, ends[-1])))
        # where the shape is at each 256th of the time, and the speed there
        speed = (begin + (end - begin) * table) / (1 << 48)
        places = (begin * np.linspace(0, 1, 257) + (end - begin) * area) / ((begin + end) / 2) * length
        at = np.searchsorted(places, ends, "right")
        slow, fast = (
            change(speed[np.maximum(at - 1 - more, 0)], speed[np.minimum(at + more, 256)])
            for change, more in ((np.minimum, 0), (np.maximum, 0))
        )
        now = np.interp(ends, places, speed)
        corners = [
            rng.choice((rng.uniform(0.3, 1.2) * v, rng.uniform(1.1, 2) * v, 1.1 * v, 0.4999, 0.4999, 0))
            for v in now
        ]
        path = Planner(shape=shape, velocity=begin, planned=first, added=first + count, offset=offset)
        alone = [rng.random() < 0.5 for _ in corners]
        for i, size in enumerate(substeps):
            corner = min(int(corners[i - 1] ** 2 * 2**64), SQUARE_MAX) if i else 0
            path.item(first + i, substeps=size, corner=corner, arc=0 if i and alone[i - 1] else 3)
        # a lone one may be passed with a sixteenth of the square to spare
        most = math.sqrt(SQUARE_MAX / 2**64)
        corners = [
            min(v, most) * math.sqrt(15 / 16) if one else v for v, one in zip(corners, alone, strict=True)
        ]
        square = int((end / (1 << 48)) ** 2 * 2**64)
        aim = ffi().new("struct passo_path_aim *", {"length": int(length * UNIT), "square": square})
        found = parts().passo_path_too_fast(path.c, aim) - first
        passed = [i for i in range(count - 1) if ends[i] < length - 1e-6 and corners[i] > 0]
        surely = [i + 1 for i in passed if corners[i] < now[i] * (1 - 1e-4)]
        perhaps = [i + 1 for i in passed if corners[i] < fast[i] * (1 + 1e-4)]
        assert found <= min(surely, default=count), (begin, end, found)
        assert found == count or found in perhaps, (begin, end, found)
        assert (slow <= now * (1 + 1e-9)).all()
        seen[found < count] += 1
    assert min(seen) > 50


# ------------------------------------------------------------------------------------------- in a curve


def some_curve(
    rng: random.Random, halves: int
) -> tuple[Any, list[dict[int, tuple[Fraction, Fraction, bool]]]]:
    """An item, and of each half and axis in it: the slope that the axis has at rest, by how much that falls
    with the square (per substep), and whether it is the way up that is hindered."""
    item = lone_item(substeps=rng.choice((1, rng.randint(2, 50), rng.randint(50, 1 << 20))))
    item.slope = whole(rng, 1 << 20, 1 << 40)
    curves: list[dict[int, tuple[Fraction, Fraction, bool]]] = [{} for _ in range(halves)]
    item.curve.halved = halves > 1
    path = Planner(shape=LINEAR, unrounded=halves == 1)
    path.c.machine.axes = path.c.rows = 8
    for axis in range(8):
        share = rng.randint(ONE >> 7, ONE)
        most = rng.randint(item.slope, 2 * item.slope)
        parts().passo_path_add_slope(item, axis, share, most)
        for half in range(halves):
            if rng.random() < 0.3:
                bend, turns = log_uniform(rng, 1e-9, 1e-3), rng.random() < 0.5
                unit = rng.choice((1, -1)) * share
                curvature = round(bend * share / ONE / 2 * 2**48) * (1 if (unit > 0) == turns else -1)
                curvatures, units = ffi().new("int64_t[8]"), ffi().new("int32_t[8]")
                curvatures[axis], units[axis] = curvature, unit
                parts().passo_path_bend(path.c, curvatures, units, half, item)
                exact = Fraction(2 * abs(curvature) * ONE, share << 48)
                if curvature:
                    curves[half][axis] = (Fraction(most), exact, turns)
    return item, curves


def left_in(item: Any, curve: dict, up: bool, low: int, length: Fraction) -> Fraction:
    """The slope with which the square rises from `low` over a length such that, at its upper end, it is what
    the curve leaves: s = A - B (w + s l)."""
    slopes = [(a - b * low) / (1 + b * length) for a, b, turns in curve.values() if turns == up]
    return max(min([Fraction(item.slope), *slopes]), Fraction(0))


@pytest.mark.parametrize("halves", [1, 2])
def test_a_curve_leaves_what_it_does_not_need(halves: int) -> None:
    """On the way up where it speeds an axis up, on the way down where it slows it down; never more than that,
    and hardly less."""
    for rng in randoms(f"slope {halves}", 300):
        item, curves = some_curve(rng, halves)
        for half, curve in enumerate(curves):
            for up in (True, False):
                strongest = min(
                    (a / b for a, b, turns in curve.values() if turns == up), default=Fraction(1 << 50)
                )
                low = rng.choice((0, whole(rng, 1, SQUARE_MAX), int(strongest * rng.randint(0, 1000) / 1000)))
                low = min(low, SQUARE_MAX)
                length = rng.choice((0, item.substeps << 32, rng.randrange(item.substeps << 32)))
                found = parts().passo_path_slope(item, half, up, low, length)
                exact = left_in(item, curve, up, low, Fraction(length, UNIT))
                # squares are large: those of the last unit of a curvature, and of its 26 bits
                bends = sum(b for _, b, turns in curve.values() if turns == up)
                slack = 2 + bends * low / (1 << 25) + (low >> 47)
                assert found <= max(1, exact * (1 + Fraction(1, 1 << 24)) + slack)
                assert found >= exact * (1 - Fraction(1, 1 << 14)) - slack


def test_no_curve_of_shaped_ramps() -> None:
    """These have their own rule; nor has an axis that hardly moves, or does not turn, a curve."""
    path, item = Planner(shape=COSINE), lone_item()
    path.c.machine.axes = path.c.rows = 2
    curvature, unit = (
        ffi().new("int64_t[2]", [1 << 40, 1 << 40]),
        ffi().new("int32_t[2]", [ONE, (ONE >> 8) - 1]),
    )
    parts().passo_path_bend(path.c, curvature, unit, 0, item)
    assert not any(item.curve.helps) and not any(item.curve.bend[0])
    path.c.shape = LINEAR
    parts().passo_path_bend(path.c, curvature, unit, 0, item)
    assert item.curve.helps[0] == 1 and item.curve.halved
    parts().passo_path_bend(path.c, ffi().new("int64_t[2]"), unit, 1, item)
    assert not any(item.curve.hinders) and item.curve.helps[1] == 0
    for share, kept in ((ONE >> 8, True), ((ONE >> 8) - 1, False)):
        item = lone_item()
        parts().passo_path_add_slope(item, 3, share, 5 << 26)
        assert (item.curve.slope[3] > 0) == kept


def test_the_greater_of_two_bends_counts() -> None:
    """Of the corners at both ends of a line that is in no halves."""
    for rng in randoms("bends", 100):
        path = Planner(unrounded=True)
        path.c.machine.axes = path.c.rows = 1
        unit, bends = ffi().new("int32_t[1]", [ONE]), [whole(rng, 1, 1 << 40) for _ in range(2)]
        both, one = lone_item(), lone_item()
        for bend in bends:
            parts().passo_path_bend(path.c, ffi().new("int64_t[1]", [bend]), unit, rng.randint(0, 1), both)
        parts().passo_path_bend(path.c, ffi().new("int64_t[1]", [max(bends)]), unit, 1, one)
        assert both.curve.bend[0][0] == one.curve.bend[0][0] > 0 and not both.curve.halved


def test_the_fall_over_a_line_is_that_of_its_slope() -> None:
    """v^2 = u^2 + 2 a s over the whole of it, of the least slope that the curve leaves: never more, as its
    bounds are lines, and hardly less where one axis limits it."""
    for rng in randoms("fall", 300):
        item, (curve,) = some_curve(rng, 1)
        parts().passo_path_set_fall(item)
        down = [(a, b) for a, b, up in curve.values() if not up]
        if not down:
            item.slope = whole(rng, 1 << 20, 1 << 60)
        fastest = min((a / b for a, b in down), default=Fraction(SQUARE_MAX))
        end = min(int(fastest * rng.randint(0, 1100) / 1000), SQUARE_MAX)
        found = parts().passo_path_fall(item, end)
        exact = min(
            left_in(item, curve, False, end, Fraction(item.substeps)) * item.substeps * DOWN, SQUARE_MAX
        )
        slack = Fraction(item.substeps) + sum((b * end / (1 << 20) + 2**33) * item.substeps for _, b in down)
        assert (
            found
            <= exact + (exact + sum(b * end * item.substeps for _, b in down)) / (1 << 24) + item.substeps
        )
        if len(down) < 2:
            assert found >= exact * (1 - Fraction(1, 1 << 14)) - slack


@pytest.mark.parametrize("halves", [1, 2])
def test_the_square_from_which_a_line_comes_down(halves: int) -> None:
    """From its end backward, by the slope of each half that is passed; no more than the top of the line where
    it passes from one into the other."""
    for rng in randoms(f"before {halves}", 300):
        item, curves = some_curve(rng, halves)
        substeps = Fraction(item.substeps)
        item.top = whole(rng, 1, SQUARE_MAX)
        end = rng.choice((0, whole(rng, 1, 1 << 60)))
        behind = rng.choice((0, rng.randrange(item.substeps << 32)))
        length = rng.randrange((item.substeps << 32) - behind + 1)
        found = parts().passo_path_before(item, end, length, behind)
        second = Fraction(length, UNIT)
        if halves > 1:
            second = min(max(substeps / 2 - Fraction(behind, UNIT), Fraction(0)), second)
        square = Fraction(end)
        slack = Fraction(0)
        for half, way in ((halves - 1, second), (0, Fraction(length, UNIT) - second)):
            if half == 0 and halves > 1 and way > 0:
                square = min(square, Fraction(max(item.top, end)))
            if half == halves - 1 or way > 0:
                bends = sum(b for _, b, up in curves[half].values() if not up)
                slack += (bends * square / (1 << 24) + 4) * way + 2 + slack * bends * way
                square += min(left_in(item, curves[half], False, square, way) * way * DOWN, SQUARE_MAX)
        assert (
            square * (1 - Fraction(1, 1 << 13)) - slack
            <= found
            <= square * (1 + Fraction(1, 1 << 13)) + slack
        )


# -------------------------------------------------------------------------------------------- the profile


class Part(NamedTuple):
    """Of the profile of a line."""

    kind: int
    length: int
    square: int  # at its end
    slope: int
    early: bool


def profile_of(path: Planner, index: int, left: int, square: int, level: bool = False) -> list[Part]:
    """All of them."""
    found = ffi().new("struct passo_path_part[]", PARTS)
    count = parts().passo_path_parts(path.c, index, left, square, level, found)
    return [Part(one.kind, one.length, one.square, one.slope, one.early) for one in found[0:count]]


def straight(rng: random.Random) -> tuple[Planner, Any, Any]:
    """Two lines, of which the second can be entered at its `reach`."""
    path = Planner(planned=0, added=2, final=rng.choice((0, 2)))
    slope, top = whole(rng, 1 << 30, 1 << 50), whole(rng, 1 << 40, SQUARE_MAX)
    item = path.item(0, substeps=rng.randint(1, min(1 << 20, SQUARE_MAX // slope)), slope=slope, top=top)
    reach = rng.choice((0, min(top, whole(rng, 1, SQUARE_MAX))))
    following = path.item(1, substeps=1, slope=slope, top=top, reach=reach, corner=reach)
    return path, item, following


def test_a_line_is_passed_as_fast_as_its_slope_and_its_top_allow() -> None:
    """The parts are the line; each changes the square by its slope; up, level, down to the end that it may
    have: the highest speed in between is that of the closed form."""
    kinds = set()
    for rng in randoms("profile", 400):
        path, item, following = straight(rng)
        left = rng.choice((item.substeps << 32, rng.randrange(1, item.substeps << 32)))
        slope, down, length = (
            Fraction(item.slope),
            Fraction(item.slope - item.slope // 256),
            Fraction(left, UNIT),
        )
        end = following.reach
        highest = end + down * length
        square = rng.choice((0, end, min(item.top, int(highest)), rng.randint(0, item.top)))
        made = profile_of(path, 0, left, square)
        assert sum(part.length for part in made) == left and all(part.length for part in made)
        kinds.add(tuple(part.kind for part in made))
        at = Fraction(square)
        near = slope / UNIT * 4 + 4
        for part in made:
            change = (
                {UP: 1, FLAT: 0, FALL: -1}[part.kind] * Fraction(part.slope) * Fraction(part.length, UNIT)
            )
            assert 0 <= item.slope - part.slope < (1 if square <= highest else 4)
            if square < highest:
                # what comes down is planned with a little less than its slope
                within = near + (abs(change) / 250 if part.kind == FALL else 0)
                assert abs(part.square - (at + change)) <= within
            at = Fraction(part.square)
        if square >= highest:
            assert [part.kind for part in made] == [FALL] and at == end
            continue
        top = max(item.top, square)
        peak = min(top, square + (highest - square) * slope / (slope + down), square + slope * length)
        assert abs(max([square, *(part.square for part in made)]) - peak) <= near
        assert abs(at - min(end, square + slope * length, top)) <= near
        rises = made[0].kind == UP
        assert made[0].early == (rises and len(made) > 1 and made[0].square < top)
    assert {(UP,), (FALL,), (UP, FALL), (UP, FALL, FALL)[:2], (UP, FLAT, FALL)} & kinds == {
        (UP,),
        (FALL,),
        (UP, FLAT, FALL),
    } | ({(UP, FALL)} & kinds)
    assert (UP, FALL) in kinds


def test_what_is_not_settled_may_be_kept_level() -> None:
    """Where asked, the path speeds up only for the end of a line that may still change."""
    for rng in randoms("level", 200):
        path, item, following = straight(rng)
        square = rng.randint(0, item.top)
        level, free = (profile_of(path, 0, item.substeps << 32, square, asked) for asked in (True, False))
        most = max(part.square for part in level)
        if path.c.final == 0:
            assert most <= max(square, following.reach)
        else:
            assert most == max(part.square for part in free)


def test_the_curve_of_each_half_is_its_own() -> None:
    """No part is steeper than the half in which it is, where it begins and where it ends, and none is faster
    than the line."""
    for rng in randoms("halves", 200):
        source, curves = some_curve(rng, 2)
        path = Planner(planned=0, added=2, final=2)
        path.items[0] = source[0]
        item = path.items[0]
        item.top = whole(rng, 1 << 30, 1 << 58)
        path.item(1, substeps=1, slope=item.slope, top=item.top, reach=rng.randint(0, item.top))
        following = path.items[1]
        square = rng.randint(0, item.top)
        made = profile_of(path, 0, item.substeps << 32, square)
        assert sum(part.length for part in made) == item.substeps << 32
        at, place, half = square, 0, item.substeps << 31
        for part in made:
            assert place >= half or place + part.length <= half  # none is in both
            curve = curves[place >= half]
            size = Fraction(part.length, UNIT)
            if part.kind == UP:
                limit = left_in(item, curve, True, at, Fraction(0)) * size
                bends = sum(b for _, b, up in curve.values() if up)
                assert (
                    part.square - at
                    <= limit * (1 + Fraction(1, 1 << 20)) + size * (2 + bends * at / 2**24) + 2
                )
            assert part.square <= max(item.top, square)
            at, place = part.square, place + part.length
        assert at <= max(following.reach, square)


def flat(path: Planner, square: int, valley: bool = False, rises: bool = False) -> int:
    """Before the corner at the start of item 1."""
    return parts().passo_path_flat(path.c, 1, 0, rises, square, valley)


def both(share: tuple[int, int]) -> list[list[tuple[int, int]]]:
    """What an axis has of its acceleration in the lines beside a lone corner, and needs there (UQ1.7), for a
    path that falls and one that rises."""
    return [[share], [share]]


def test_a_lone_corner_is_left_what_it_needs() -> None:
    """Of twice the acceleration of an axis, before it and behind it, the lines have `lost` at their slopes,
    and the corner needs its part of the square: over what is level they have less, by what is too much. Of
    two axes, the one that needs more counts; a path that falls does not need what one that rises does."""
    for rng in randoms("flat", 300):
        path = Planner(added=2)
        path.item(0, substeps=rng.randint(1, 1000))
        bend = whole(rng, 1 << 20, SQUARE_MAX)
        shares = [(rng.randint(1, 255), rng.randint(0, 255)) for _ in range(2)]
        rises = rng.random() < 0.5
        lone = [[], shares] if rises else [shares, []]
        item = path.item(1, substeps=5, turn=rng.randint(1, 400), lone=lone, bend=bend)
        square = rng.choice((bend, rng.randint(0, bend), min(2 * bend, SQUARE_MAX)))
        found = flat(path, square, rises=rises)
        assert flat(path, square, rises=not rises) == 0
        most = max(1 - (256 - Fraction(min(square, bend) * needed, bend)) / lost for lost, needed in shares)
        if path.items[0].substeps // 2 < item.turn or most <= 0:
            assert found == 0
        else:
            assert abs(Fraction(found, UNIT * item.turn) - most) <= Fraction(1, min(shares)[0])
        path.items[1].rest = True
        assert flat(path, square, rises=rises) == 0
        path.items[1].rest, path.c.added = False, 1
        assert flat(path, square, rises=rises) == 0
        path.c.added, path.c.shape = 2, COSINE
        assert flat(path, square, rises=rises) == 0


def test_a_valley_needs_no_level_way() -> None:
    """Where the path comes down to the highest speed of a corner and up again; to a 128th of the square."""
    path = Planner(added=2)
    path.item(0, substeps=1000)
    reach = 1 << 50
    members = {"substeps": 5, "turn": 100, "lone": both((234, 234)), "bend": reach, "corner": reach}
    path.item(1, valley=True, reach=reach, **members)
    assert flat(path, reach) > 0 == flat(path, reach, True)
    assert flat(path, reach - reach // 130, True) == 0 < flat(path, reach - reach // 120, True)
    path.item(1, valley=True, reach=reach - 1, **members)
    assert flat(path, reach, True) > 0
    path.item(1, valley=False, reach=reach, **members)
    assert flat(path, reach, True) > 0


def change_over(made: list[Any], square: int, length: int) -> Fraction:
    """From a square to that over a length from the start of parts; squares change evenly within each."""
    at = Fraction(square)
    for part in made:
        now = min(part.length, length)
        at += Fraction(now, part.length) * (part.square - at)
        length -= now
    return at - square


def change_at_the_end(made: list[Any], square: int, length: int) -> Fraction:
    """Over a length at the end of parts."""
    whole = sum(part.length for part in made)
    return change_over(made, square, whole) - change_over(made, square, whole - length)


def test_a_valley_is_come_down_to_over_all_of_its_rounding() -> None:
    """Else the way down leaves what the corner needs: it is that of all the slope over the rest of it."""
    reach, seen, slope, turn = 1 << 50, [0, 0], 1 << 38, 400 << 32
    members = {"turn": 400, "lone": both((234, 234)), "bend": reach, "corner": reach, "reach": reach}
    for left in range(420, 1000, 20):
        path = Planner(planned=0, added=2, final=2)
        path.item(0, substeps=1000, slope=slope, top=1 << 58)
        path.item(1, substeps=1000, slope=slope, top=1 << 58, valley=True, **members)
        made = profile_of(path, 0, left << 32, reach)
        assert sum(part.length for part in made) == left << 32
        comes_down = made[-1].square == reach
        if comes_down:
            assert sum(part.length for part in made if part.kind == FALL) >= turn
        else:
            assert reach * 62 // 64 <= made[-1].square < reach
            steep = turn - flat(path, made[-1].square)
            fall = -change_at_the_end(made, reach, turn)
            assert slope * steep / UNIT * 0.98 < fall <= slope * steep / UNIT
        seen[comes_down] += 1
    assert min(seen) > 5


def test_a_lone_corner_has_what_it_needs_on_both_sides() -> None:
    """Where the path comes up to it, the speed is the same over that; where it comes down to it, or rises
    behind it, the square changes over its rounding by no more than at the full slope over the rest."""
    seen = [0, 0]
    for rng in randoms("sides", 200):
        path, item, _ = straight(rng)
        item.substeps, item.slope = 1000, min(item.slope, 1 << 50)
        first = rng.randint(0, item.top)
        reach = whole(rng, 1 << 30, min(1 << 60, item.top))
        if rng.random() < 0.5:  # one that is hardly come up to
            reach = min(first + item.slope * rng.randint(500, 1200), item.top)
        share, turn = (rng.randint(195, 255), rng.randint(195, 255)), rng.randint(1, 400)
        members = {"turn": turn, "lone": both(share), "bend": reach, "substeps": 1000}
        path.item(1, slope=item.slope, top=item.top, reach=reach, corner=reach + 1, **members)
        made = profile_of(path, 0, 1000 << 32, first)
        last = made[-1]
        assert sum(part.length for part in made) == 1000 << 32
        level = flat(path, last.square)
        if last.square == reach and last.kind != FALL:
            assert last.kind == FLAT and last.length >= level > 0
            seen[0] += 1
        elif last.square == reach and made[0].kind != FALL:
            fall = -change_at_the_end(made, first, turn << 32)
            most = Fraction(item.slope * ((turn << 32) - level), UNIT)
            assert fall <= most * (1 + Fraction(1, 1 << 20)) + 4
            seen[1] += 1
        begin = min(reach, item.top)
        path.c.planned, path.c.added = 1, 3
        path.item(2, substeps=1, slope=item.slope, top=item.top, reach=item.top, corner=item.top)
        after = profile_of(path, 1, 1000 << 32, begin)
        steep = (turn << 32) - parts().passo_path_flat(path.c, 1, 1, True, begin, True)
        rise = change_over(after, begin, turn << 32)
        assert rise <= Fraction(item.slope * steep, UNIT) * (1 + Fraction(1, 1 << 20)) + 4
        assert after[0].square > begin or begin == item.top
        # what has been passed of it is left out
        path.c.passing, passed = begin, after[0].length // 2
        square = begin + int(change_over(after, begin, passed))
        rest = profile_of(path, 1, (1000 << 32) - passed, square)
        again = change_over(rest, square, (turn << 32) - passed)
        assert abs(square + again - begin - rise) <= rise / 2**20 + 2**20
    assert min(seen) > 10


# ------------------------------------------------------------------------------------ ramps by their jerk


def law_of(rng: random.Random) -> tuple[Any, int, int]:
    slope, jerk = whole(rng, 1 << 20, 1 << 44), whole(rng, 1 << 16, 1 << 44)
    return ffi().new("struct passo_path_law *", (slope, jerk)), slope, jerk


def clocks_of(slope: int, jerk: int, change: int) -> float:
    """Of a cosine ramp: its mean acceleration, slope / 2, and dv / T^2 are limited."""
    return max(2 * change / 2**48 / (slope / 2**64), math.sqrt(change / 2**48 / (jerk / 2**80)))


def test_a_ramp_is_as_long_as_acceleration_and_jerk_demand() -> None:
    """And a 128th for ticks; up as long as down; none without a change, and none that has too many ticks."""
    seen = [0, 0]
    for rng in randoms("ramp length", 400):
        path, (law, slope, jerk) = Planner(rng.choice((4, 7, 10))), law_of(rng)
        a, b = (rng.choice((0, whole(rng, 1 << 16, 1 << 47))) for _ in range(2))
        found = parts().passo_path_ramp_length(path.c, law, a, b)
        assert found == parts().passo_path_ramp_length(path.c, law, b, a)
        if a == b:
            assert found == 0
            continue
        clocks = clocks_of(slope, jerk, abs(a - b))
        exact = (a + b) / 2**49 * clocks * (1 + 1 / 128)
        if clocks * (1 + 1 / 128) >= (1 << 20 + path.c.machine.tick_log2) * 1.001 or exact >= 2**32:
            assert found == NEVER
        elif clocks * (1 + 1 / 128) < (1 << 20 + path.c.machine.tick_log2) * 0.999 and exact < 2**31:
            within = (a + b) / 2**49 * (3 + clocks / 2**31) + 1e-9
            assert abs(found / UNIT - exact) <= exact * 1e-4 + within
        seen[found == NEVER] += 1
    assert min(seen) > 20


def test_a_detour_is_up_level_and_down() -> None:
    """The sum of the three; of what is longer than all lines there is none."""
    for rng in randoms("detour", 300):
        path, (law, *_) = Planner(), law_of(rng)
        speeds = sorted(whole(rng, 1 << 16, 1 << 47) for _ in range(3))
        low, middle, top = speeds
        start, to = rng.choice(((low, middle), (middle, low), (low, low), (low, top), (low, NEVER)))
        pause = rng.choice((0, rng.randint(1, 1000), 1 << 40))
        up = parts().passo_path_ramp_length(path.c, law, start, top)
        down = parts().passo_path_ramp_length(path.c, law, top, to) if to < top else 0
        level = min(2 * top * pause * 128 >> 17, NEVER)
        found = parts().passo_path_detour(path.c, law, start, top, pause, to)
        assert found == (min(up + level + down, NEVER) if NEVER not in (up, down) else NEVER)


def test_the_highest_velocity_of_a_detour() -> None:
    """It fits in the length, and one that is a little higher does not; none is above the most."""
    reached = [0, 0]
    for rng in randoms("highest", 300):
        path, (law, *_) = Planner(), law_of(rng)
        start, most, to = (whole(rng, 1 << 30, 1 << 47) for _ in range(3))
        pause = rng.choice((0, rng.randint(1, 100)))
        to = rng.choice((0, to, NEVER))
        scale = parts().passo_path_detour(path.c, law, start, max(start, most), pause, to)
        length = int(rng.uniform(0, 1.2) * min(scale, 1 << 62))
        found = parts().passo_path_highest(path.c, law, start, pause, to, length, most)
        assert start <= found <= max(start, most)
        if found > start and most > start:
            assert parts().passo_path_detour(path.c, law, start, found, pause, to) <= length
        if found < most:
            higher = min(most, found + (found >> 11) + 4)
            assert parts().passo_path_detour(path.c, law, start, higher, pause, to) > length
        reached[found >= most] += 1
    assert min(reached) > 30


def test_a_ramp_over_a_corner_lacks_what_that_needs() -> None:
    """In 256ths of the lower slope of both lines; something is always left."""
    for rng in randoms("pass", 200):
        own, other, over = (
            whole(rng, 1, 1 << 50),
            whole(rng, 1, 1 << 50),
            rng.choice((0, 255, rng.randint(0, 255))),
        )
        item = lone_item(slope=own, over=over)
        least = min(own, other)
        found = parts().passo_path_pass_slope(item, other)
        assert found == max(1, least - least * over // 256)


def test_the_jerk_of_a_cosine_ramp_is_below_the_limit() -> None:
    """dv / T^2 = 2 j / pi^2, less a 32nd."""
    for rng in randoms("soften", 100):
        jerk, item = whole(rng, 1 << 10, 1 << 60), lone_item()
        parts().passo_path_soften(item, jerk)
        assert item.jerk / jerk == pytest.approx(2 / math.pi**2 * 31 / 32, rel=2e-3, abs=1 / jerk)
    item = lone_item()
    parts().passo_path_soften(item, 0)
    assert item.jerk == 1
