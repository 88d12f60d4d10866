# SPDX-License-Identifier: MIT
"""Motors that are not axes: maps, closed forms, pins, and what is left after a stop."""

import itertools
import math
import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from passo.driver import DriverError
from passo.gcode import GcodeSettings
from passo.native import ffi, planner
from passo.path import LOOK_AHEAD, Motors, Path, PathAxis, PathSettings
from passo.plan import PlanError
from passo.program import Program

from benchmarks import path_measure
from benchmarks.path_measure import measure
from benchmarks.path_paths import MOTORS, XY, XZ, Case, Piece
from benchmarks.path_plan import plan
from benchmarks.path_search import search
from tests.helpers.path_player import Player, play

GANGED = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 1, 0))
AXES = (PathAxis(80, 200, 1000),) * 3
LENGTH = 120.0  # mm
PIECES = {
    "circle": (Piece(120, (1.0,), (3.0,)),),
    "sharp": (Piece(6, (8.0, 3.0), (70.0, -140.0)),),
    "long": (Piece(3, (40.0,), (20.0, -35.0), (6000.0, 0.0)),),
}


def map_of(rows: Any) -> Any:
    """A `struct passo_motors`."""
    made = ffi().new("struct passo_motors *", {"count": len(rows)})
    for motor, row in enumerate(rows):
        made.plus[motor] = sum((part > 0) << axis for axis, part in enumerate(row))
        made.minus[motor] = sum((part < 0) << axis for axis, part in enumerate(row))
    return made


def has_inverse(rows: np.ndarray) -> bool:
    """What a header promises, from the matrix alone."""
    products = rows.T @ rows
    parts = np.abs(rows).sum(axis=1)
    own = np.array([rows[axis, axis] != 0 for axis in range(rows.shape[1])])
    return bool(
        own.all()
        and (parts >= 1).all()
        and (parts <= 2).all()
        and (products == np.diag(products.diagonal())).all()
    )


def test_a_map_fits_where_axes_are_means_of_motors() -> None:
    """All maps of two axes to two or three motors; of three axes some."""
    maps = [
        np.array(rows)
        for n in (2, 3)
        for rows in itertools.product(itertools.product((-1, 0, 1), repeat=2), repeat=n)
    ]
    rng = random.Random(1)
    maps += [
        np.array([[rng.choice((-1, 0, 0, 1)) for _ in range(3)] for _ in range(rng.choice((3, 4, 5)))])
        for _ in range(3000)
    ]
    fitting = [rows for rows in maps if planner().passo_motors_fit(map_of(rows), rows.shape[1])]
    assert [rows.tolist() for rows in fitting] == [rows.tolist() for rows in maps if has_inverse(rows)]
    parts = ffi().new("uint32_t *")
    for rows in fitting:
        axes = [rng.randrange(-(1 << 28), 1 << 28) for _ in range(rows.shape[1])]
        places = [
            planner().passo_motor_place(map_of(rows), motor, ffi().new("int64_t[8]", axes))
            for motor in range(len(rows))
        ]
        assert places == (rows @ axes).tolist()
        for axis, place in enumerate(axes):
            total = planner().passo_axis_place(map_of(rows), axis, ffi().new("int32_t[8]", places), parts)
            assert (total, parts[0]) == (place * parts[0], int(np.abs(rows[:, axis]).sum()))


@pytest.mark.parametrize(
    ("axes", "rows"),
    [
        (AXES, ((1, 1, 0), (1, 1, 0), (0, 0, 1))),  # no inverse
        (AXES, ((1, 1, 0), (0, 1, 0), (0, 0, 1))),  # an axis is no mean
        (AXES, ((1, 1, 1), (1, -1, 0), (0, 0, 1))),  # three axes
        (AXES, ((1, 0, 0), (0, 1, 0))),  # too few motors
        (AXES, ((0, 1, 0), (1, 0, 0), (0, 0, 1))),  # not in order
        ((PathAxis(80), PathAxis(160), PathAxis(80)), XY),  # two scales
        ((PathAxis(80),) * 7, (*np.eye(7, dtype=int)[:6].tolist(), [0] * 7)),  # a motor of none
        (
            (PathAxis(80),) * 8,
            ((1, 1, *[0] * 6), (1, -1, *[0] * 6), *np.eye(8, dtype=int)[2:].tolist()),
        ),  # ten limits
    ],
)
def test_what_no_machine_has_is_refused(axes: tuple[PathAxis, ...], rows: Any) -> None:
    with pytest.raises(PlanError, match="axes"):
        Path(
            PathSettings(axes, motors=Motors(tuple(map(tuple, rows)))),
            Player.__init__.__globals__["PARAMETERS"],
            LOOK_AHEAD,
        )


def trapezoid(length: float, speed: float, acceleration: float) -> float:
    """Seconds from rest to rest."""
    return length / speed + speed / acceleration


@pytest.mark.parametrize("rows", [XY, XZ])
def test_a_line_at_any_angle_is_limited_by_axes_and_motors(rows: Any) -> None:
    """In closed form: of both sets the stricter one, and exact steps of each motor."""
    settings = PathSettings(AXES, motors=Motors(rows))
    one, other = (0, 1) if rows == XY else (0, 2)
    for degrees in range(0, 360, 15):
        cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        target = [0.0, 0.0, 0.0]
        target[one], target[other] = LENGTH * cosine, LENGTH * sine
        most = max(abs(cosine), abs(sine), abs(cosine + sine), abs(cosine - sine))
        made = plan([(target, None)], settings, LOOK_AHEAD)
        assert made.seconds == pytest.approx(trapezoid(LENGTH, 200 / most, 1000 / most), rel=2e-3)
        (line,) = made.lines
        signed = [-n if line.directions >> i & 1 else n for i, n in enumerate(line.steps[0:3])]
        assert signed == [round(80 * float(np.dot(row, target))) for row in rows]


def test_motors_have_limits_of_their_own() -> None:
    """Weaker or stronger than the axes."""
    for speed, acceleration in ((120, 600), (500, 9000)):
        settings = PathSettings(AXES, motors=Motors(XY, PathAxis(0, speed, acceleration)))
        for target, share in (((LENGTH, 0, 0), 1.0), ((LENGTH, LENGTH, 0), math.sqrt(2))):
            size = math.hypot(*target)
            limits = (
                min(200 * size / LENGTH, speed / share),
                min(1000 * size / LENGTH, acceleration / share),
            )
            assert plan([(target, None)], settings, LOOK_AHEAD).seconds == pytest.approx(
                trapezoid(size, *limits), rel=2e-3
            )


def test_ganged_motors_step_on_the_same_clocks() -> None:
    case = Case("ganged", PIECES["sharp"])
    played = play(case.lines, case.settings)
    assert len(played.clocks[1]) > 100
    assert np.array_equal(played.clocks[1], played.clocks[3]) and np.array_equal(
        played.steps[1], played.steps[3]
    )


@pytest.mark.parametrize("piece", PIECES)
@pytest.mark.parametrize("machine", MOTORS)
def test_paths_are_within_all_bounds(machine: str, piece: str) -> None:
    """Time, limits of axes and motors at the pins, and where the machine is at each step."""
    for heading in (0.0, 20.0, 45.0):
        measured = measure(Case(machine, PIECES[piece], heading=heading))
        assert measured.faults == {} and measured.unlimited > 0.99
        assert len(measured.shares) == 2 * (3 if machine == "ganged" else 5)


def test_profile_jerk_keeps_the_jerk_of_the_motors() -> None:
    case = Case("corexy_soft", PIECES["long"], "jerk", 100, heading=20.0)
    assert {*measure(case).faults} <= {"slow"}  # benchmarks/path_open.json has the worst of these


def test_random_paths_are_within_all_bounds() -> None:
    """The short form of `python -m benchmarks.path_adversary 1000 1 --motors`."""
    assert search(15, 7, machines=tuple(MOTORS)) is None


@pytest.mark.parametrize(
    ("kind", "wrong"),
    [
        ("acceleration", Motors(XY, PathAxis(0, 200, 1100))),  # of the motors alone
        ("off", Motors((XY[1], (1, 1, 0), XY[2]))),  # exchanged
    ],
)
def test_a_wrong_planner_is_found(kind: str, wrong: Motors, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        path_measure,
        "Player",
        lambda settings, *rest: Player(replace(settings, motors=wrong), *rest),
    )
    assert kind in measure(Case("corexy", PIECES["sharp"], heading=45.0)).faults


@pytest.mark.parametrize("machine", ["corexy", "corexz", "ganged"])
def test_the_rest_of_a_path_after_a_stop(machine: str) -> None:
    """From where the motors are to the exact end, wherever they stopped."""
    case = Case(machine, PIECES["sharp"], heading=30.0)
    end = case.settings.motors.map(3) @ np.array(case.lines[-1][0]) * case.settings.scales
    for seconds in (0.05, 0.2, 0.5):
        player = Player(case.settings, 300)
        for target, feed in case.lines:
            player.add(target, feed)
        player.path.end()
        player.rest(seconds)
        player.driver.call("stop")
        player.wait(lambda player=player: not player.driver.is_moving)
        positions = player.driver.positions()
        assert positions[:4] != [round(place) for place in end]
        player.driver.call("clear")
        assert player.feed.recover(positions)
        player.wait(lambda player=player: not player.feed.is_moving)
        assert np.abs(np.array(player.driver.positions()[: len(end)]) - end).max() <= 0.5 + 1e-9
        player.engine.close()


def test_a_core_with_too_few_motors_is_refused() -> None:
    """Before anything moves."""
    player = Player(PathSettings(AXES), LOOK_AHEAD, axes=3)
    with pytest.raises(DriverError, match="PINS_TOO_SLOW"):
        Program(player.driver, PathSettings(AXES, motors=Motors(GANGED)), GcodeSettings())
    player.engine.close()
