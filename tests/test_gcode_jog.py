# SPDX-License-Identifier: MIT
"""Calls of the G-code interpreter beside its lines: jog, reset, spindle limits, conversion."""

import math
from fractions import Fraction
from typing import Any

import pytest
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings
from passo.native import planner

from tests.test_gcode import OWN, SPINDLE, at, run, state

FULL = 65_535
BEFORE = ("G91 G18 G55 G1 F600 X1", "G43.1 Z3", "G92 X2", "M4 S500 M8 G61.1")


def jogged(gcode: Gcode, text: str) -> Any:
    """The action of a jog."""
    gcode.jog(text)
    (action,) = gcode.actions()
    return action


@pytest.mark.parametrize(
    ("text", "x", "feed"),
    [
        ("X10 F600", 15.0, 600.0),
        ("N7 X10 F600", 15.0, 600.0),
        ("G90 X10 F60", 10.0, 60.0),
        ("G91 G20 X-1 F1", -20.4, 25.4),
        ("G53 X10 F600", 10.0, 600.0),
        ("G53 G20 X1 F1", 25.4, 25.4),
    ],
)
def test_a_jog_is_a_line_that_leaves_no_mode(text: str, x: float, feed: float) -> None:
    """Of units, distance and machine coordinates for itself; its feed is not that of the next line."""
    gcode = Gcode()
    run(gcode, "G0 X5", "G93 G91 G38.2 X0.1 F2" if "G90" not in text else "G1 X5 F1", "G90 G0 X5", "G91")
    before = {n: gcode.c.mode[n] for n in range(11)}, gcode.c.feed
    line = jogged(gcode, text)
    assert line.target[0] == round(x * NANOMETERS) and at(gcode)[0] == pytest.approx(x)
    assert line.feed / 2**32 == pytest.approx(feed / 60, rel=1e-6)
    assert ({n: gcode.c.mode[n] for n in range(11)}, gcode.c.feed) == before


@pytest.mark.parametrize(
    ("text", "number"),
    [
        *[(f"{word} X1 F1", 16) for word in ("G1", "G0", "G38.2", "G93", "G54", "M3", "M8", "S1", "T1")],
        ("G28 X1 F1", 16),
        ("F100", 26),
        ("X1", 22),
        ("X1 F", 2),
    ],
)  # fmt: skip
def test_a_wrong_jog_changes_nothing(text: str, number: int) -> None:
    """Other words and modes, no axis, no feed."""
    gcode = Gcode()
    run(gcode, "G1 X1 F100")
    before = state(gcode)
    with pytest.raises(GcodeError, match=f"error:{number}:"):
        gcode.jog(text)
    assert state(gcode) == before and list(gcode.actions()) == []


def test_a_reset_leaves_position_and_offsets() -> None:
    """Everything else is as after power-up."""
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))
    run(gcode, "G10 L2 P2 X7", *BEFORE)
    position = gcode.position
    planner().passo_gcode_reset(gcode.c)
    fresh = Gcode(GcodeSettings(spindle_maximum=1000))
    run(fresh, "G10 L2 P2 X7")
    fresh.c.position = gcode.c.position
    assert gcode.position == position
    for name in ("mode", "shift"):
        assert list(getattr(gcode.c, name)) == list(getattr(fresh.c, name)), name
    for name in ("flood", "mist", "tool_length", "feed", "spindle", "tolerance", "line", "tool"):
        assert getattr(gcode.c, name) == getattr(fresh.c, name), name
    assert list(gcode.c.offsets.system[1]) == list(fresh.c.offsets.system[1])
    assert planner().passo_gcode_output(gcode.c) == 0


@pytest.mark.parametrize("speed", ["0", "0.00001", "1", "99", "100", "101", "500", "999", "1500"])
@pytest.mark.parametrize("percent", [10, 100, 200])
def test_the_spindle_is_between_its_limits(speed: str, percent: int) -> None:
    """S with its override, at least the minimum unless it is 0, at most the maximum."""
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))
    gcode.c.settings.spindle_minimum = 100
    gcode.c.spindle_percent = percent
    run(gcode, f"M3 S{speed}")
    wanted = Fraction(speed) * percent / 100
    turning = min(max(wanted, 100 if wanted else 0), 1000)
    assert planner().passo_gcode_output(gcode.c) == SPINDLE | math.floor(turning * FULL / 1000)


def test_what_each_action_tells() -> None:
    """No probe unless it is one, exact stops in G61.1 alone, the line and the tolerance."""
    gcode = Gcode()
    (line,) = run(gcode, "N3 G1 X1 F60")
    assert (line.probe, line.line, line.stops, line.tolerance) == (-1, 3, False, OWN)
    assert [run(gcode, f"{mode} X{n}")[0].stops for n, mode in enumerate(("G61.1", "G61", "G64"), 2)] == [
        True, False, False,
    ]  # fmt: skip


def test_coolant_is_on_until_it_is_off() -> None:
    """M7 and M8 add up; M9 ends both."""
    gcode = Gcode()
    seen = []
    for line in ("M7", "X1", "M8", "X2", "M9", "X3"):
        run(gcode, line)
        seen.append((gcode.c.mist, gcode.c.flood))
    assert seen == [(True, False)] * 2 + [(True, True)] * 2 + [(False, False)] * 2


@pytest.mark.parametrize("nanometres", [0, 1, 1_000_000, 25_400_000, 10**15 + 1])
def test_millimetres(nanometres: int) -> None:
    """To nearest, alike in both directions."""
    exact = Fraction(nanometres * 2**32, 10**6)
    made = planner().passo_gcode_millimetres(nanometres)
    assert abs(made - exact) <= Fraction(1, 2)
    assert made == -planner().passo_gcode_millimetres(-nanometres)
