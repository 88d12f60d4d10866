# SPDX-License-Identifier: MIT
"""The words of a lathe: diameters, feeds per revolution, surface speed."""

import math
import random
from itertools import pairwise

import pytest
from passo import random_cases
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings
from passo.native import planner

from tests.test_gcode import LINE, RAPID, run

FULL = 3000  # rpm


def lathe(*lines: str) -> Gcode:
    """After some lines."""
    gcode = Gcode(GcodeSettings(spindle_maximum=FULL))
    for line in lines:
        run(gcode, line)
    return gcode


def pieces(gcode: Gcode, line: str) -> list[tuple[float, float, float, float]]:
    """X and Z in mm, feed in mm/min (0: rapid) and rpm of each line of the path."""
    return [
        (
            action.target[0] / NANOMETERS, action.target[2] / NANOMETERS,
            0 if action.feed == RAPID else action.feed / 2**32 * 60,
            (action.output & 0xFFFF) / 0xFFFF * FULL,
        )
        for action in run(gcode, line) if action.kind == LINE
    ]  # fmt: skip


def refused(gcode: Gcode, line: str) -> int:
    with pytest.raises(GcodeError) as caught:
        gcode.execute(line)
    return caught.value.number


@pytest.mark.parametrize(
    ("lines", "x"),
    [
        (["G7 G0 X20"], 10), (["G7", "G0 X20", "G91 X3"], 11.5), (["G7 G0 X20", "G8 X20"], 20),
        (["G7 G20 G0 X2"], 25.4), (["G7 G10 L2 P1 X4", "G0 X2"], 3), (["G7 G92 X-8", "G0 X0"], 4),
        (["G7 G53 G0 X5"], 2.5), (["G7 G0 X-0.000001"], 0), (["G7 G0 X0.000003"], 2e-6),
        (["G7 G18 F9 G2 X8 Z4 I4"], 4),
    ],
)  # fmt: skip
def test_diameters(lines: list[str], x: float) -> None:
    """All X words are halved, to nearest; I is not."""
    assert lathe(*lines).position[0] == round(x * NANOMETERS)


def test_a_feed_per_revolution_is_that_of_the_speed() -> None:
    """Of S, within the range of the spindle and with its override; F is kept within a mode only."""
    gcode = lathe("M3 S500 G95 G1 X1 F0.2")
    assert pieces(gcode, "X2") == [pytest.approx((2, 0, 100, 500), rel=1e-4)]
    assert pieces(gcode, "S9999 X3")[0][2] == pytest.approx(0.2 * FULL)
    gcode.c.spindle_percent = 50
    assert pieces(gcode, "S400 G81 X1 Z-1 R0")[1][2] == pytest.approx(40)
    gcode.c.spindle_percent = 100
    assert pieces(gcode, "G20 F.01 G2 X1 R5")[0][2] == pytest.approx(0.254 * 400)
    assert refused(gcode, "G94 G1 X1") == 22 and refused(gcode, "M5 G1 X0") == 42
    assert refused(gcode, "S0 G1 X0") == 42 and refused(lathe("F100"), "G95 M3 S1 G1 X1") == 22


def test_a_jog_has_its_own_feed() -> None:
    """In units per minute."""
    gcode = lathe("M3 S500 G95 F0.2")
    gcode.jog("X1 F60")
    (action,) = gcode.actions()
    assert action.feed / 2**32 == pytest.approx(1)


@pytest.mark.parametrize("seed", range(20))
def test_the_surface_speed_is_constant(seed: int) -> None:
    """On every piece of a line or arc, within what X changes on it; up to D and the speed of the spindle."""
    rng = random.Random(f"{random_cases.seed()} {seed}")
    begin, end = (round(rng.choice((0, rng.uniform(-60, 60))), 3) for _ in range(2))
    surface, most = rng.randint(5, 300), rng.choice((0, rng.randint(200, 4000)))
    shift = round(rng.uniform(-9, 9), 3)
    limit = f"D{most}" if most else ""
    gcode = lathe(f"G10 L2 P1 X{shift}", f"G18 M3 G0 X{begin} Z3", f"G96 S{surface} {limit} G95 F0.1")
    line = f"G1 X{end} Z-5"
    if seed % 4 == 0:
        radius = math.hypot(end - begin, 8)
        line = f"G2 X{end} Z-5 R{radius:.3f}"
    made = pieces(gcode, line)
    assert made[-1][:2] == pytest.approx((end + shift, -5), abs=1e-6)
    top = min(most or FULL, FULL)
    for (x0, *_), (x1, _, feed, rpm) in pairwise([(begin + shift, 0.0, 0.0, 0.0), *made]):
        radii = sorted((abs(x0 - shift), abs(x1 - shift)))
        slow, fast = (min(top, surface * 1000 / (2 * math.pi * r)) if r else top for r in radii[::-1])
        assert slow - 0.1 <= rpm <= max(fast, slow) + 0.1 and feed == pytest.approx(0.1 * rpm, abs=0.01)
        if seed % 4:
            assert fast / slow < 1.04 and len(made) < 400


@pytest.mark.parametrize(("begin", "end"), [(30, 0), (0, 30), (-30, 0), (0, -30)])
def test_a_face_to_the_middle_or_from_there(begin: int, end: int) -> None:
    """Where all other axes are at 0, too: the speed changes all the way; along the axis it does not."""
    gcode = lathe(f"G18 M3 G0 X{begin} Z0", "G96 S100 G95 F0.1")
    assert len(pieces(gcode, "G1 Z-5")) == len(pieces(gcode, "Z0")) == 1
    made = pieces(gcode, f"G1 X{end}")
    speeds = [rpm for *_, rpm in made][:: -1 if end else 1]
    assert len(made) > 30 and speeds == sorted(speeds) and speeds[-1] == pytest.approx(FULL)
    assert speeds[0] == pytest.approx(100_000 / (2 * math.pi * 30), rel=0.04)


def test_exact_stops_are_at_the_ends_of_lines() -> None:
    """Not where the speed changes."""
    gcode = lathe("G61.1 G18 M3 G0 X30 Z0", "G96 S100 G95 F0.1")
    for line in ("G1 X10", "G1 X20 Z5", "G2 X10 Z-5 R20"):
        *stops, last = (action.stops for action in run(gcode, line) if action.kind == LINE)
        assert len(stops) > 9 and not any(stops) and last


def test_surface_speed_in_feet_and_back_to_rpm() -> None:
    """G97 without S keeps the speed; a rapid has that of its end."""
    gcode = lathe("G20 M3 G0 X1 Z0", "G96 S100 D900")
    rpm = 100 * 12 / (2 * math.pi)
    assert pieces(gcode, "G0 X2")[0][3] == pytest.approx(rpm / 2, abs=0.1)
    assert pieces(gcode, "G97 G0 X1")[0][3] == pytest.approx(rpm / 2, abs=0.1)
    assert pieces(gcode, "S300 G0 X2")[0][3] == pytest.approx(300, abs=0.1)
    assert refused(gcode, "G96") == 28 and refused(gcode, "D5") == 36 and refused(gcode, "G97 D5") == 36
    assert refused(gcode, "G96 S1 D-1") == 4 and refused(gcode, "G96 G97 S1") == 21


def test_a_thread_is_in_step_with_the_spindle() -> None:
    """Its feed is that of the speed; G33.1 comes back; every word is checked."""
    gcode = Gcode(GcodeSettings(spindle_maximum=FULL, turn_counts=1000))
    run(gcode, "G20 M4 S600 G0 X1 Z0")
    (action,) = run(gcode, "G33 Z-1 X0 K.1")
    assert action.kind == planner().PASSO_GCODE_THREAD and not action.rigid
    assert action.pitch == 2_540_000 and action.feed / 2**32 == pytest.approx(25.4)
    assert list(action.target[0:3]) == [0, 0, -25_400_000] == list(gcode.position)
    (action,) = run(gcode, "G21 G33.1 Z5 K2")
    assert action.rigid and action.target[2] == 5_000_000 and gcode.position[2] == -25_400_000
    assert action.speed == 600_000_000 and run(gcode, "G91 G33 Z0 K1") == []
    for line, number in {
        "G33 Z1": 28, "G33 K1": 26, "G33 Z1 K0": 4, "G33 Z1 K-1": 4, "M5 G33 Z1 K1": 42, "S0 Z1 K1": 42,
        "G33 Z1 K1 P1": 36, "G53 G33 Z1 K1": 30, "G33 Z999999999 Z1 K1": 25, "G33.2 Z1 K1": 20,
    }.items():  # fmt: skip
        assert refused(gcode, line) == number
    assert refused(lathe("M3 S1"), "G33 Z1 K1") == 20
