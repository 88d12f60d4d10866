# SPDX-License-Identifier: MIT
"""Arcs of the G-code interpreter against exact geometry."""

import math
import random

import numpy as np
import pytest
from passo import random_cases
from passo.gcode import NANOMETERS, Gcode, GcodeSettings
from passo.native import ffi, planner

TURN = 1 << 64
PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
PI = 2 * np.arcsin(np.longdouble(1))


def corners(gcode: Gcode, *lines: str) -> np.ndarray:
    """The targets of the last line in nanometers, with the start."""
    for line in lines[:-1]:
        gcode.execute(line)
        list(gcode.actions())
    start = gcode.position
    gcode.execute(lines[-1])
    axes = gcode.settings.axes
    return np.array(
        [start, *(tuple(action.target[0:axes]) for action in gcode.actions())], dtype=np.longdouble
    )


def judge(
    points: np.ndarray, plane: str, center: np.ndarray, clockwise: bool, tolerance: float, turn: float | None
) -> None:
    """Corners on the circle, chords within the tolerance, one way round, a straight helix."""
    first, second, other = PLANES[plane]
    flat = points[:, [first, second]] - center
    radius = np.hypot(*flat[0])
    assert np.abs(np.hypot(flat[:-1, 0], flat[:-1, 1]) - radius).max() < 1.0
    chords = np.hypot(*np.diff(flat[:-1], axis=0).T) if len(flat) > 2 else np.zeros(1)
    height = radius - np.sqrt(np.maximum(radius**2 - (chords / 2) ** 2, 0))
    assert height.max() <= tolerance + 1.5
    cross = flat[:-1, 0] * flat[1:, 1] - flat[:-1, 1] * flat[1:, 0]
    inner = (flat[:-1] * flat[1:]).sum(axis=1)
    angles = np.arctan2(cross, inner) * (-1 if clockwise else 1)
    assert (angles > 0).all()
    assert angles.max() / angles.min() < 1.01 + 10 / radius
    if turn is not None:
        assert abs(float(angles.sum()) - turn) < 1e-3
    along = points[:, other]
    wanted = along[0] + (along[-1] - along[0]) * np.arange(len(points)) / (len(points) - 1)
    assert np.abs(along - wanted).max() <= 0.5 + 1e-6


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("turn", [1e-3, 0.5, math.pi / 2, math.pi, 5, 2 * math.pi])
@pytest.mark.parametrize("radius", [0.01, 3, 250, 10_000])
def test_arcs_are_on_the_circle(plane: str, clockwise: bool, turn: float, radius: float) -> None:
    """In all planes, both ways, to full circles and helices; the end exactly."""
    first, second, other = PLANES[plane]
    center = np.array([round(12.345678e6), round(-7.654321e6)])
    sign = -1 if clockwise else 1
    places = []
    for angle in (0.7, 0.7 + sign * turn):
        radial = radius * NANOMETERS * np.array([math.cos(angle), math.sin(angle)])
        places.append(np.rint(center + radial).astype(np.int64))
    if turn == 2 * math.pi:
        places[1] = places[0]
    begin, end = places
    gcode = Gcode(GcodeSettings(arc_tolerance=0.002))
    offset = center - begin
    letters, offsets = "XYZ", "IJK"
    start = f"G0 {letters[first]}{begin[0] / 1e6:.6f} {letters[second]}{begin[1] / 1e6:.6f} {letters[other]}1"
    arc = (
        f"G{2 if clockwise else 3} {letters[first]}{end[0] / 1e6:.6f} {letters[second]}{end[1] / 1e6:.6f} "
        f"{letters[other]}4.5 {offsets[first]}{offset[0] / 1e6:.6f} {offsets[second]}{offset[1] / 1e6:.6f}"
    )
    points = corners(gcode, f"{plane} F100", start, arc)
    assert gcode.position[first] == end[0] and gcode.position[second] == end[1]
    assert points[-1].tolist() == list(gcode.position)
    judge(points, plane, center, clockwise, 2000, None if radius * turn < 0.01 else turn)


@pytest.mark.parametrize("tolerance", [0.000001, 0.0001, 0.01, 5])
def test_no_more_chords_than_needed(tolerance: float) -> None:
    """One more at most than the tolerance asks for."""
    points = corners(Gcode(GcodeSettings(arc_tolerance=tolerance)), "F100", "G2 X0 I10")
    least = math.pi / math.acos(1 - min(tolerance / 10, 1))
    assert least - 1e-6 <= len(points) - 1 <= least * (1.001 if tolerance < 0.1 else 1.5) + 2


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("major", [False, True])
def test_the_radius_form(clockwise: bool, major: bool) -> None:
    """The center is as far from both ends, on the side of the shorter or the longer way."""
    rng = random.Random(random_cases.seed())
    for _ in range(60):
        x, y = (round(rng.uniform(-50, 50), 4) for _ in range(2))
        radius = math.hypot(x, y) / 2 * rng.choice([1.0001, 1.01, 1.5, 10, 100])
        sign = "-" if major else ""
        gcode = Gcode()
        points = corners(gcode, "F100", f"G{2 if clockwise else 3} X{x:.4f} Y{y:.4f} R{sign}{radius:.6f}")
        chord = np.array([x, y]) * 1e6
        r = round(radius, 6) * 1e6
        aside = math.sqrt(r**2 - chord @ chord / 4) * (-1 if clockwise != major else 1)
        center = chord / 2 + aside * np.array([-chord[1], chord[0]]) / math.hypot(*chord)
        half = math.asin(min(1.0, math.hypot(*chord) / 2 / r))
        # the center is whole nanometers, within 1.5 nm
        assert abs(np.hypot(*(points[:-1, :2] - center).T) - r).max() < 4
        judge_turn = 2 * (math.pi - half if major else half)
        flat = points[:, :2] - center
        cross = flat[:-1, 0] * flat[1:, 1] - flat[:-1, 1] * flat[1:, 0]
        angles = np.arctan2(cross, (flat[:-1] * flat[1:]).sum(axis=1)) * (-1 if clockwise else 1)
        assert abs(float(angles.sum()) - judge_turn) < 1e-4
        assert points[-1, :2].tolist() == [round(x * 1e6), round(y * 1e6)]


def test_a_small_difference_of_the_radii_is_allowed() -> None:
    """As in grbl: 0.005 mm always, more up to 0.1 % and 0.5 mm; the end is the target."""
    for line, allowed in (
        ("G2 X20.005 I10", True), ("G2 X20.0051 I10", True), ("G2 X20.0102 I10", False),
        ("G2 X0.013 I0.005", True), ("G2 X0.017 I0.005", False), ("G2 X2000.9 I1000", False),
        ("G2 X2000.5 I1000", True), ("G2 X2000.500001 I1000", False),
    ):  # fmt: skip
        gcode = Gcode()
        gcode.execute("F100")
        try:
            points = corners(gcode, line)
            assert allowed, line
            assert points[-1].tolist() == list(gcode.position)
        except Exception as error:
            assert not allowed and "error:33" in str(error), line


def test_unit_vectors_and_angles() -> None:
    """The bounds in passo_gcode_angle.h, against extended precision."""
    c, rng = planner(), random.Random(random_cases.seed())
    for number in range(4000):
        angle = (number // 5) * (TURN >> 9) + number % 5 - 2 if number < 2000 else rng.getrandbits(64)
        angle %= TURN
        unit = c.passo_gcode_unit_vector(angle)
        radians = np.longdouble(angle) * 2 * PI / np.longdouble(2) ** 64
        for value, wanted in ((unit.x, np.cos(radians)), (unit.y, np.sin(radians))):
            assert abs(np.longdouble(value) / 2**62 - wanted) < np.longdouble(2) ** -53
        size = 2.0 ** rng.uniform(0, 61)
        x, y = int(size * math.cos(float(radians))), int(size * math.sin(float(radians)))
        if x or y:
            found = np.longdouble(c.passo_gcode_angle(ffi().new("struct passo_gcode_vector *", (x, y))[0]))
            wanted = np.arctan2(np.longdouble(y), np.longdouble(x)) / (2 * PI) * np.longdouble(2) ** 64
            difference = (found - wanted + 2**63) % np.longdouble(2) ** 64 - 2**63
            assert abs(difference) < 2**14
