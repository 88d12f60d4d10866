# SPDX-License-Identifier: MIT
"""Drilling cycles: what each hole is made of, and what no rapid may do."""

import random

import pytest
from passo import random_cases
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings

from tests.test_gcode import DWELL, LINE, RAPID, SPINDLE, run

PLANES = {"G17": "XYZ", "G18": "ZXY", "G19": "YZX"}  # the last one drills
HOLE = "X3 Y4 Z-5 F60"
# From Z10 over the origin: the strokes of a hole, as Z and kind: rapid, feed, dwell, rapid with spindle off.
STROKES = {
    f"G81 {HOLE}": "10r 2r -5f 10r",
    f"G82 {HOLE} P0.5": "10r 2r -5f d 10r",
    f"G83 {HOLE} Q3": "10r 2r -1f 2r -0.746r -4f 2r -3.746r -5f 10r",
    f"G73 {HOLE} Q3": "10r 2r -1f -0.746r -4f -3.746r -5f 10r",
    f"G83 {HOLE} Q7": "10r 2r -5f 10r",
    f"G83 {HOLE} Q0.1 R-4.8": "10r -4.8r -4.9f -4.8r -5f 10r",  # never above R
    f"G85 {HOLE}": "10r 2r -5f 2f 10r",
    f"G86 {HOLE} P0": "10r 2r -5f 10s",
    f"G86 {HOLE} P1": "10r 2r -5f d 10s",
    f"G89 {HOLE} P1": "10r 2r -5f d 10f",
    f"G99 G81 {HOLE}": "10r 2r -5f 2r",
    f"G99 G85 {HOLE}": "10r 2r -5f 2f",
    f"G81 {HOLE} R12": "12r 12r -5f 12r",  # first up, then over
    f"G81 {HOLE} R10": "10r -5f 10r",
    f"G81 {HOLE} R-5": "10r -5r 10r",  # nothing to cut
    "G81 X0 Y0 R10 Z10 F60": "",
}  # fmt: skip


def strokes(gcode: Gcode, line: str, axis: int = 2) -> list[tuple[float, str]]:
    """Height and kind of each action of a line."""
    found = []
    for action in run(gcode, line):
        if action.kind == DWELL:
            found.append((0.0, "d"))
        elif action.kind == LINE:
            rapid = "r" if action.output & SPINDLE else "s"
            found.append((action.target[axis] / NANOMETERS, rapid if action.feed == RAPID else "f"))
    return found


def wanted(text: str) -> list[tuple[float, str]]:
    return [(float(part[:-1] or 0), part[-1]) for part in text.split()]


def ready(plane: str = "G17") -> Gcode:
    """At a height of 10, the spindle on."""
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))
    run(gcode, f"M3 S500 {plane} G0 {PLANES[plane][2]}10")
    return gcode


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("line", STROKES)
def test_the_strokes_of_a_hole(line: str, plane: str) -> None:
    """Of each cycle, in each plane; R is 2 unless given."""
    text = STROKES[line]
    line += "" if "R" in line else " R2"
    turned = "".join(PLANES[plane]["XYZ".index(c)] if c in "XYZ" else c for c in line)
    gcode = ready(plane)
    assert strokes(gcode, turned, "XYZ".index(PLANES[plane][2])) == wanted(text)
    assert not list(gcode.actions())


def test_words_are_kept_while_the_cycle_is_in_force() -> None:
    """Z, R, P and Q; only axis words drill, and L counts for its line."""
    gcode = ready()
    run(gcode, "G82 X1 Z-1 R2 P1.5 F60")
    (dwell,) = [action for action in run(gcode, "X2") if action.kind == DWELL]
    assert dwell.microseconds == 1_500_000
    assert strokes(gcode, "X3 Z-2 P0") == wanted("10r 2r -2f 10r")
    assert strokes(gcode, "X4 R1") == wanted("10r 1r -2f 10r")
    assert strokes(gcode, "F30") == strokes(gcode, "S100") == []
    assert strokes(gcode, "G80") == []
    with pytest.raises(GcodeError, match="error:31"):
        run(gcode, "X5")
    with pytest.raises(GcodeError, match="error:28"):
        run(gcode, "G82 X5")
    run(gcode, "G82 X5 Z-1 R2 P0")
    with pytest.raises(GcodeError, match="error:28"):
        run(gcode, "G83 X5 Q1")
    run(gcode, "M30")
    assert gcode.c.mode[0] == 10


def test_repeats() -> None:
    """In G91 each hole is an increment further; in G90 they are one."""
    gcode = ready()
    holes = [action.target[0:3] for action in run(gcode, "G91 G99 G81 X3 Y-1 Z-3 R-8 L3 F60")
             if action.feed != RAPID]  # fmt: skip
    assert [[at // NANOMETERS for at in hole] for hole in holes] == [[3, -1, -1], [6, -2, -1], [9, -3, -1]]
    assert [at // NANOMETERS for at in gcode.position] == [9, -3, 2]
    assert strokes(gcode, "X1") == wanted("2r -1f 2r")  # R is from where the row began
    assert strokes(gcode, "G90 X0 Y0 Z-3 R1 L2") == wanted("2r 1r -3f 1r -3f 1r")


def test_g98_returns_to_where_the_row_began() -> None:
    """Also after G99 in between: up first, then over."""
    gcode = ready()
    run(gcode, "G99 G81 X1 Z-1 R2 F60")
    assert strokes(gcode, "G98 X2") == wanted("10r 10r 2r -1f 10r")
    run(gcode, "G0 Z20")
    assert strokes(gcode, "G81 X3 Z-1 R2") == wanted("20r 2r -1f 20r")


@pytest.mark.parametrize(
    ("number", "line"),
    [(20, "G93 G81 X1 Z-1 R1 F1"), (22, "G81 X1 Z-1 R1"), (23, "G81.1 X1 Z-1 R1 F1"), (21, "G98 G99"),
     (24, "G81 G1 X1 F1"), (26, "G81 R1 F1"), (28, "G81 X1 Z-1 F1"),
     (28, "G81 X1 R1 F1"), (28, "G82 X1 Z-1 R1 F1"), (28, "G83 X1 Z-1 R1 F1"), (28, "G73 X1 Z-1 R1 Q0 F1"),
     (28, "G86 X1 Z-1 R1 F1"), (28, "G89 X1 Z-1 R1 F1"), (30, "G53 G81 X1 Z-1 R1 F1"),
     (33, "G81 X1 Z2 R1 F1"), (33, "G20 G81 X1 Z-1 R99999999 F1"), (33, "G91 G81 X999999999 Z-1 R0 L2 F1"),
     (33, "G91 G81 X9 Z-1 R0 L999999999 F1"), (4, "G81 X1 Z-1 R1 L0 F1"),
     (4, "G81 X1 Z-1 R1 L-1 F1"), (36, "G81 X1 Z-1 R1 Q1 F1"), (36, "G81 X1 Z-1 R1 P1 F1"),
     (36, "G81 X1 Z-1 R1 I1 F1"), (36, "G98 R1"), (36, "G81 X1 Z-1 R1 A5 F1")],
)  # fmt: skip
def test_a_wrong_cycle_has_its_error(number: int, line: str) -> None:
    gcode = Gcode(GcodeSettings(axes=4))
    with pytest.raises(GcodeError) as caught:
        run(gcode, line)
    assert caught.value.number == number
    assert gcode.position == (0, 0, 0, 0) and not list(gcode.actions())


def test_a_machine_without_z_drills_nothing() -> None:
    gcode = Gcode(GcodeSettings(axes=2))
    with pytest.raises(GcodeError, match="error:20"):
        run(gcode, "G81 X1 R1 F1")


def test_no_rapid_enters_what_is_not_cut() -> None:
    """Random cycles: rapids end above the depth fed to at this place, and come to the place at R or above."""
    rng = random.Random(random_cases.seed())
    holes = 0
    for _ in range(300):
        gcode = ready()
        level = rng.uniform(-3, 12)
        bottom = level - rng.uniform(0, 9)
        kind = rng.choice(("G73", "G81", "G82", "G83", "G85", "G86", "G89"))
        line = f"{rng.choice(('G98', 'G99'))} {kind} X5 Z{bottom:.3f} R{level:.3f} F60"
        line += f" Q{rng.uniform(0.01, 4):.3f}" if kind in ("G73", "G83") else ""
        line += " P0.1" if kind in ("G82", "G86", "G89") else ""
        place, depth, at = (0, 0), 10 * NANOMETERS, 10 * NANOMETERS
        for action in [*run(gcode, line), *run(gcode, "Y-3")]:
            if action.kind != LINE:
                continue
            x, y, height = action.target[0:3]
            if (x, y) != place:
                assert action.feed == RAPID and height == at
                place, depth = (x, y), round(level * 1000) * 1000
                assert height >= depth
                holes += 1
            elif action.feed == RAPID:
                assert height >= min(depth, round(level * 1000) * 1000)
            depth, at = min(depth, height), height
        assert depth == round(bottom, 3) * NANOMETERS or abs(depth / NANOMETERS - bottom) < 0.001
    assert holes == 600
