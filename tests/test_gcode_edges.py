# SPDX-License-Identifier: MIT
"""G-code that is nearly something else: a percent sign, a byte order mark, the current system, a laser."""

import pytest
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings

from tests.test_gcode import SPINDLE, run

PROPORTIONAL = 1 << 24  # of the output word


@pytest.mark.parametrize(
    "line", [b"%1", b"%X1", b"\xefG\xbfG0X1", b"\xef\xbb0G0X1", b"A\xbb\xbfG0X1", b"G0X1\xef\xbb\xbf"]
)
def test_what_only_begins_like_a_mark(line: bytes) -> None:
    """Nothing is left out of a line but a whole mark."""
    gcode = Gcode()
    run(gcode, "%")
    gcode.execute(b"\xef\xbb\xbfG0X2")
    list(gcode.actions())
    assert gcode.position[0] == 2 * NANOMETERS
    with pytest.raises(GcodeError, match=r"error:(1|2):"):
        gcode.execute(line)


@pytest.mark.parametrize("system", range(6))
def test_p0_is_the_current_system(system: int) -> None:
    """Of G10, with either L."""
    for words, offset in (("L2 P0 X7", 7), ("L20 P0 X7", 3)):
        gcode = Gcode()
        run(gcode, "G0 X10", f"G{54 + system}", f"G10 {words}")
        offsets = [gcode.c.offsets.system[n][0] for n in range(6)]
        assert offsets == [offset * NANOMETERS if n == system else 0 for n in range(6)]


@pytest.mark.parametrize(
    ("lines", "number"),
    [
        (("G53 G2 X2 I1 F1",), 30),
        (("G2 X2 I1 F1", "G53 X4 I1"), 30),
        (("G53 G38.2 X1 F1",), 30),
        (("G80 X1",), 31),
        (("G80", "X1"), 31),
    ],
)
def test_motions_that_take_no_such_words(lines: tuple[str, ...], number: int) -> None:
    """Machine coordinates are for lines; without a motion there are no targets."""
    gcode = Gcode()
    *before, last = lines
    run(gcode, *before)
    with pytest.raises(GcodeError, match=f"error:{number}:"):
        gcode.execute(last)
    run(gcode, "G80", "G53 G1 X1 F1")


@pytest.mark.parametrize("plane", ["G17 G2 X2 I1 J0", "G18 G2 X2 I1 K0", "G19 G2 Y2 J1 K0"])
def test_an_arc_after_a_cycle(plane: str) -> None:
    """All planes take their words, and nothing is left of a hole."""
    fresh, drilled = Gcode(), Gcode()
    run(drilled, "G81 X0 Y0 Z-3 R0 F60", "G80", "G0 X0 Y0 Z0")
    arcs = [[tuple(action.target) for action in run(gcode, f"{plane} F60")] for gcode in (fresh, drilled)]
    assert arcs[0] == arcs[1] and len(arcs[0]) > 8


def test_a_laser_has_a_power_in_proportion() -> None:
    """With M4, which does not reverse it."""
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))
    gcode.c.settings.laser = True
    assert run(gcode, "M4 S1000 G1 X1 F60")[-1].output == SPINDLE | PROPORTIONAL | 0xFFFF
    assert run(gcode, "M3 X2")[-1].output == SPINDLE | 0xFFFF
