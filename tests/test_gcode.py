# SPDX-License-Identifier: MIT
"""The G-code interpreter: numbers, modes, offsets, and the error numbers of grbl's published list."""

import random
from fractions import Fraction
from math import floor
from typing import Any

import pytest
from passo import random_cases
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings, lines, stripped
from passo.native import ffi, planner
from passo.path import NOT_MOVING

LINE, PROBE, DWELL, OUTPUT, PAUSE, END, OFFSETS = range(7)
RAPID = (1 << 64) - 1
OWN, UNMERGED = 0, (1 << 64) - 1  # as passo_path_tolerance() has them
FLOOD, MIST, SPINDLE, REVERSE = 1 << 18, 1 << 19, 1 << 16, 1 << 17


def state(gcode: Gcode) -> bytes:
    """All members but the actions of the last line."""
    return bytes(ffi().buffer(gcode.c))[: ffi().offsetof("struct passo_gcode", "job")]


def run(gcode: Gcode, *lines: str) -> list[Any]:
    """The actions of the last line."""
    made: list[Any] = []
    for line in lines:
        gcode.execute(line)
        made = list(gcode.actions())
    return made


def at(gcode: Gcode) -> tuple[float, ...]:
    """Position in mm."""
    return tuple(n / NANOMETERS for n in gcode.position)


# --------------------------------------------------------------------------------------------- numbers

NUMBERS = [
    *("0", "-0", "+5", ".5", "-.25", "3.", "007", "1.0000004", "1.0000005", "-1.0000005", "-1.9999996"),
    *("0.9999995", "0.00000049999", "999999999"),
]


@pytest.mark.parametrize("text", NUMBERS)
def test_numbers_are_exact_to_a_nanometre(text: str) -> None:
    """Rounded to millionths, ties away from zero."""
    gcode = Gcode()
    run(gcode, f"G0X{text}")
    exact = Fraction(text.rstrip(".")) * NANOMETERS
    assert abs(gcode.position[0]) == floor(abs(exact) + Fraction(1, 2))
    assert gcode.position[0] * exact >= 0


def test_inches_are_exact() -> None:
    """25.4 mm each; angles of A are degrees in any units."""
    gcode = Gcode(GcodeSettings(axes=4))
    run(gcode, "G20 G0 X1 Y-0.0001 Z0.5 A90")
    assert gcode.position == (25_400_000, -2540, 12_700_000, 90_000_000)


def test_a_thousand_increments_do_not_drift() -> None:
    """Sums of decimals are exact."""
    gcode = Gcode()
    for _ in range(1000):
        run(gcode, "G91 G0 X0.1 Y-0.001")
    assert at(gcode) == (100, -1, 0)


@pytest.mark.parametrize(
    "line", ["g1 x 1 0 f6 0", "G1X10F60(a comment)", "(first) G1 X10 (second; (nested) F60", "/G1X10F60 ;end",
             "N10 G1 X1(inside)0 F60", "G01 X10.000 F060.", "\tG1\tX10 F60\r"],
)  # fmt: skip
def test_spaces_comments_and_capitals(line: str) -> None:
    gcode = Gcode()
    (action,) = run(gcode, line)
    assert at(gcode) == (10, 0, 0) and action.feed == 1 << 32


@pytest.mark.parametrize("line", ["", "%", "(only a comment)", "; the same", "N100", "  "])
def test_lines_that_do_nothing(line: str) -> None:
    assert run(Gcode(), line) == []


def test_control_characters_are_nothing() -> None:
    """As in grbl: all up to the space but line ends. A byte order mark is nothing in front of a line."""
    discarded = [chr(code) for code in range(0x21) if chr(code) not in "\n\r"]
    assert len(discarded) == 31
    gcode = Gcode()
    for i, character in enumerate(discarded):
        run(gcode, f"G{character}0{character}X{character}{i}{character}.5")
        assert at(gcode)[0] == i + 0.5
    for line in ("\ufeffG0 X70", "\ufeff\x00G0X70", "\ufeff(comment) X70"):
        run(gcode, "X0", line)
        assert at(gcode)[0] == 70
    assert run(gcode, "\ufeff") == run(gcode, "\x1a") == []


def test_lines_end_with_lf_cr_or_both() -> None:
    """In any mixture; a comment ends with its line."""
    rng = random.Random(random_cases.seed())
    for _ in range(300):
        text = bytes(rng.choices(b"G0X1(;) \n\r\x0b\x00\x85", k=rng.randrange(20)))
        assert lines(text) == text.splitlines(keepends=True)
    gcode = Gcode()
    for line in lines(b"G0 (open\rX1;comment\n\rY2\r\nZ3"):
        gcode.execute(line)
    assert at(gcode) == (1, 2, 3)
    assert lines(b"") == []
    with pytest.raises(ValueError, match="more than one line"):
        Gcode().execute("G0 X1\rG0 X2")


def test_long_comments_do_not_count() -> None:
    """127 characters are a line, 128 are too many; comments and spaces are none."""
    words = "G0X" + "0" * 124
    assert run(Gcode(), words + "(" + "x" * 500 + ")") is not None
    with pytest.raises(GcodeError, match="error:11"):
        stripped((words + "0").encode())


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("(MSG,tool 5)", "tool 5"), ("( m sg, Tool  5 ) G0", "Tool  5 "), ("G0 (MSG,a;b", "a;b"),
        ("(MSG,a)(MSG,b) (c)", "b"), ("(MSG,\ta)", "a"), ("(MSG,)", ""), ("(MSG)", ""), ("(MSG a)", ""),
        ("(MSGS,a)", ""), ("(a MSG,a)", ""), ("(a)", ""), (";MSG,a", ""), ("MSG,a", ""),
        (f"(MSG,{'x' * 63})", "x" * 63), (f"(MSG,{'x' * 64})", "x" * 63),
    ],
)  # fmt: skip
def test_a_comment_may_be_a_message(line: str, message: str) -> None:
    """One in brackets that begins with MSG and a comma; of several the last, up to 63 characters."""
    assert ffi().string(stripped(line.encode()).message).decode() == message


# ---------------------------------------------------------------------------------------------- errors

# By number: lines that are refused, after G21 G90 G94 at X0 Y0 Z0 without a feed.
ERRORS = {
    1: ["10", "G1 $", "?", "G0 X1 =", "G0 X1 *57", "%G0", "G0 X1 %", "\x7f", "\x80\xff", "G0X1\x7f", "[#1]",
        "G0 X1.2.3", "G0\N{NO-BREAK SPACE}X1", "G0\ufeffX1", "\ufffe"],
    2: ["G", "X", "G1 X", "G0 X--1", "G0 X.", "GX1", "G0 X1000000000", "G0 X+-1",
        "G0 X\N{MINUS SIGN}1"],
    4: ["G64 P-1", "G64 Q-0.1", "G1 X1 F-1", "S-5", "T-1", "N-1 G0 X1", "G4 P-1"],
    20: ["G5", "G0 U1", "G0 A1", "G33 Z1 K1", "O100", "G41", "G84 X1", "M48", "M98",
         "G28.2", "G38.1 X1", "G92.3", "G10 L1 P1 R1 Z1", "G10 L2 P1 R1 X1", "G-1",
         "G90.1", "G91.2", "G61.2", "G64.1", "G38 X1 F1", "G28.3", "G30.2",
         "G38.25 X1 F1", "G5.1",
         ],
    21: ["G17 G18", "G20 G21", "G90 G91", "G93 G94", "G54 G55", "M3 M4", "M7 M8", "M0 M2",
         "G4 P1 G53 G0 X1", "G43.1 G49 Z1", "G4 G28", "G92.1 G28", "G28.1 G92 X1", "G61 G64",
         "G7 G8", "G94 G95", "G96 G97 S1"],
    22: ["G81 X1", "G1 X1", "G1", "G2 X1 I1", "G38.2 X1", "G93 G1 X1", "G1 X1 F0"],
    23: ["G1.5 X1", "G17.1", "G54.1", "M3.5", "G0.1 X1", "G4.1 P1", "M30.2", "M6.1", "G99.5", "M99.5",
         "G59.1", "G59.3", "G49.1", "G10.1 L2 P1 X1", "G80.1", "G53.1 G0 X1"],
    24: ["G0 G1 X1", "G1 G38.2 X1 F1", "G10 G92 X1", "G28 G30", "G49 G92 X1",
         "G1 G1", "G0 X1 G92 Y1", "G28 G1 X1 F1", "G10 L2 P1 X1 G0 Y5", "G43.1 Z1 G0 X1", "G92 X0 G43.1 Z1"],
    25: ["G0 X1 X2", "F1 F2", "G1 X1 I0 I0 F1", "N1 N2", "S1 S1"],
    26: ["G10 L2 P1", "G92", "F10 G38.2", "F10 G3 R5"],
    27: ["N10000000 G0 X1"],
    28: ["G4", "G10 L2 X1", "G10 P1 X1", "G4 X1", "G96"],
    29: ["G10 L2 P7 X1", "G10 L20 P9 X1"],
    30: ["F10 G2 G53 X1 I1", "G53 G38.2 X1 F1", "G80 G53"],
    31: ["G80 X1", "G80 G92 X1", "G80 G28 X1", "G80 G30 X1", "G80 G10 L2 P1 X1", "G80 G10 L20 P0 X1",
         "G80 G43.1 Z1", "G80 G49 X1", "G80 G92.1 X1", "G80 G28.1 X1"],
    32: ["F10 G2 Z1 R1", "F10 G18 G2 Y1 R1"],
    33: ["F10 G2 X10 I4", "F10 G2 X0 Y0 R5", "F10 G38.2 X0", "G20 G0 X99999999", "F10 G3 X5 Y5 I1 J1"],
    34: ["F10 G2 X10 R4.9", "F10 G3 X1 R0", "F10 G2 X10 R-4.9999"],
    35: ["F10 G2", "F10 G2 X10", "F10 G2 X10 K5", "F10 G18 G2 X10 J5", "F10 G19 G3 Y1 I5"],
    36: ["D1", "G97 D1", "Q1", "G61 Q1", "G1 X1 Q1 F1", "G4 P1 Q1", "G61 P1", "G0 X1 I1", "G0 X1 P1", "P1",
         "L2", "R1", "G0 X1 L20", "F10 G2 X10 R5 I5", "G4 P1 L3", "M3 S1 K2", "G0 E1", "G0 X1e5"],
    37: ["G43.1 X1", "G43.1 X1 Z1", "G43.1"],
    38: ["T256", "T999999"],
    39: ["M62 P4", "M66 P7", "M66 E0", "M67 E1 Q1"],
    42: ["M5 S1 G95 G1 X1 F1", "M3 G95 G1 X1 F1", "M3 G95 G96 S0 F1 G1 X1"],
}  # fmt: skip


@pytest.mark.parametrize(("number", "line"), [(n, line) for n, lines in ERRORS.items() for line in lines])
def test_a_wrong_line_has_its_error_and_changes_nothing(number: int, line: str) -> None:
    """The numbers of grbl 1.1; all members are as before."""
    gcode = Gcode()
    before = state(gcode)
    with pytest.raises(GcodeError) as caught:
        run(gcode, line)
    assert caught.value.number == number
    assert state(gcode) == before and not list(gcode.actions())


@pytest.mark.parametrize("line", ["G1 X2 F100", "G0 G17 G40 G49 G90", "G81 X1 Z-1 R2 F50", "G2 X10 I5 F100"])
def test_g80_with_another_motion_only_ends_the_one_in_force(line: str) -> None:
    """As in LinuxCNC, wherever it is in the line."""
    expected, places = Gcode(), line.split()
    before = "G81 Z-1 R1 F10 X0"

    def made(gcode: Gcode, text: str) -> list[tuple[int, list[int], int]]:
        return [(action.kind, list(action.target), action.feed) for action in run(gcode, before, text)]

    actions = made(expected, line)
    for at in range(len(places) + 1):
        gcode = Gcode()
        assert made(gcode, " ".join([*places[:at], "G80", *places[at:]])) == actions
        assert state(gcode) == state(expected)


@pytest.mark.parametrize("line", ["G92 X1", "G28 X1", "G10 L2 P1 X1", "G43.1 Z1", "X1", "G53"])
def test_g80_in_force_allows_no_axis_words(line: str) -> None:
    """As in grbl; what needs none is allowed."""
    gcode = Gcode()
    run(gcode, "G80")
    with pytest.raises(GcodeError, match="error:30" if line == "G53" else "error:31"):
        run(gcode, line)
    assert [action.kind for action in run(gcode, "G92.1", "G49", "G28.1", "G28")] == [LINE]


@pytest.mark.parametrize(
    ("number", "line"),
    [(16, "G1 X1 F1"), (16, "X1 F1 M3"), (16, "X1 F1 S5"), (16, "G0 X1 F1"), (16, "X1 F1 G54"), (16, "G4 P1"),
     (26, "F100"), (22, "X10"), (1, "=X1"), (2, "X"), (25, "X1 X2 F1"), (4, "X1 F-1"), (21, "G20 G21 X1 F1")],
)  # fmt: skip
def test_a_wrong_jog_has_its_error(number: int, line: str) -> None:
    with pytest.raises(GcodeError) as caught:
        Gcode().jog(line)
    assert caught.value.number == number


def test_random_lines_change_nothing_or_are_executed() -> None:
    """Whatever comes, an error leaves every member as it was."""
    rng = random.Random(random_cases.seed())
    gcode = Gcode(GcodeSettings(axes=4))
    commands = ["G0", "G1", "G2", "G3", "G17", "G18", "G20", "G90", "G91", "G92", "G10", "G28", "G53", "G93"]
    words = [*commands, "M3", *"XYZIJRPLFSN"]
    refused = 0
    for _ in range(5000):
        chosen = rng.choices(words, k=rng.randint(1, 6))
        line = "".join(word if word[1:] else f"{word}{rng.uniform(-9, 30):.3f}" for word in chosen)
        before = state(gcode)
        try:
            run(gcode, line)
        except GcodeError:
            refused += 1
            assert state(gcode) == before, line
    assert 500 < refused < 4900


# ------------------------------------------------------------------------------- modes and coordinates


def test_coordinate_systems() -> None:
    """Offsets add up: coordinate system, G92, tool length; G53 is the machine."""
    gcode = Gcode()
    run(gcode, "G10 L2 P1 X10 Y20", "G10 L2 P2 X100", "G0 X1 Y1")
    assert at(gcode) == (11, 21, 0)
    run(gcode, "G55 X1")
    assert at(gcode) == (101, 21, 0)
    run(gcode, "G92 X0 Y0", "G0 X5")
    assert at(gcode) == (106, 21, 0)
    run(gcode, "G54 X0 Y0")  # G92 counts in all systems
    assert at(gcode) == (11, 41, 0)
    run(gcode, "G92.1", "X0 Y0", "G43.1 Z-2.5", "Z0")
    assert at(gcode) == (10, 20, -2.5)
    run(gcode, "G49", "Z0", "G53 G0 X3 Y4 Z5")
    assert at(gcode) == (3, 4, 5)


def test_g10_l20_gives_the_position_its_coordinates() -> None:
    """Of the system in force (P0), or of another one."""
    gcode = Gcode()
    actions = run(gcode, "G0 X10 Y10", "G92 X3", "G10 L20 P0 X0 Y1")
    assert [a.kind for a in actions] == [OFFSETS]
    run(gcode, "X0 Y1")
    assert at(gcode) == (10, 10, 0)
    run(gcode, "G10 L20 P3 X-1", "G56 X-1")
    assert at(gcode)[0] == 10


def test_stored_positions() -> None:
    """G28 and G30: through a point with the given axes, or directly with all."""
    gcode = Gcode()
    assert [a.kind for a in run(gcode, "G0 X1 Y2 Z3", "G28.1")] == [OFFSETS]
    run(gcode, "G0 X7 Y7 Z7", "G30.1", "G0 X50 Y50 Z50")
    via, home = run(gcode, "G91 G28 Z10")
    assert list(via.target)[:3] == [50 * NANOMETERS, 50 * NANOMETERS, 60 * NANOMETERS]
    assert list(home.target)[:3] == [50 * NANOMETERS, 50 * NANOMETERS, 3 * NANOMETERS]
    assert via.feed == home.feed == RAPID
    (home,) = run(gcode, "G30")
    assert list(home.target)[:3] == [7 * NANOMETERS] * 3


def test_modes_last_and_end_with_the_program() -> None:
    """M2 and M30 leave units and offsets."""
    gcode = Gcode()
    run(gcode, "G1 F600 G91 G20 G18 G55 M3 S100 M8", "X1")
    assert at(gcode)[0] == 25.4
    (end,) = run(gcode, "M30")
    assert (end.kind, end.output) == (END, 0)
    modes = {n: gcode.c.mode[n] for n in range(11)}
    assert (modes[0], modes[1], modes[2], modes[3], modes[4]) == (10, 540, 170, 200, 900)


def test_feeds() -> None:
    """mm/min, inches/min, and in G93 the whole line in a fraction of a minute."""
    gcode = Gcode()
    assert run(gcode, "G1 X10 F600")[0].feed == 10 << 32
    assert run(gcode, "X20")[0].feed == 10 << 32
    assert run(gcode, "G20 X0 F60")[0].feed == round(25.4 * 2**32)
    (line,) = run(gcode, "G21 G93 X30 Y40 F2")  # 50 mm in half a minute
    assert abs(line.feed / 2**32 - 100 / 60) < 1e-6
    chords = run(gcode, "G91 G3 I10 X0 F6")
    assert abs(chords[0].feed / 2**32 - 20 * 3.141592653589793 / 10) < 1e-6
    with pytest.raises(GcodeError, match="error:22"):
        run(gcode, "G94 G1 X1")


def test_outputs_and_their_order() -> None:
    """Spindle and coolant before a dwell, the motion after it, the end last."""
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))
    actions = run(gcode, "M4 S500 M8 G4 P1.5 M0")
    assert [a.kind for a in actions] == [OUTPUT, DWELL, PAUSE]
    assert actions[0].output == SPINDLE | REVERSE | FLOOD | 32767
    assert actions[1].microseconds == 1_500_000
    assert [a.output for a in run(gcode, "M7 G0 X1")] == [SPINDLE | REVERSE | FLOOD | MIST | 32767] * 2
    assert [a.output for a in run(gcode, "M9 S2000")] == [SPINDLE | REVERSE | 65535]
    assert [a.kind for a in run(gcode, "M5 M30")] == [OUTPUT, END]


def test_probes_and_line_numbers() -> None:
    gcode = Gcode()
    (probe,) = run(gcode, "N17 G38.3 Z-10 F60")
    assert (probe.kind, probe.probe, probe.line, probe.target[2]) == (PROBE, 383, 17, -10 * NANOMETERS)
    position = ffi().new("int64_t[6]", [0, 0, -3 * NANOMETERS])
    planner().passo_gcode_set_position(gcode.c, position)
    assert at(gcode) == (0, 0, -3)


def test_the_tolerance_of_the_path() -> None:
    """Of G64: Q, else P, in the units of the line; G61: none; G64 alone and power-up: the path's own."""
    gcode = Gcode()
    assert gcode.c.tolerance == OWN
    for line, tolerance in (
        ("G64 P0.05", 0.05), ("G0 X1", 0.05), ("G64 P0.1 Q0.02", 0.02), ("G20 G64 P0.001", 0.0254),
        ("G64 Q0.5 P2", 12.7), ("G61", UNMERGED), ("G21 G64 P1 G2 X5 I1 F100", None),
        ("G21 G64 P1 G1 X5 F100", 1),
        ("G64", OWN), ("G64 Q3", 3), ("G64 G4 P0.1", OWN), ("G64 G4 P0.1 Q2", 2), ("M2", 2),
        ("G64 P0", UNMERGED),
        ("G64 P1 Q0", UNMERGED), ("G64 G10 L2 P1 X0", OWN), ("G64 P999999", 999999),
    ):  # fmt: skip
        if tolerance is None:
            with pytest.raises(GcodeError):
                run(gcode, line)
            continue
        run(gcode, line)
        wanted = tolerance if tolerance == UNMERGED else round(tolerance * 2**32)
        assert wanted * 0.9997 <= gcode.c.tolerance <= wanted, line
    run(gcode, "G64 P1")
    gcode.jog("X1 F5")
    assert 0.9997 * (1 << 32) < gcode.c.tolerance <= 1 << 32
    planner().passo_gcode_reset(gcode.c)
    assert gcode.c.tolerance == OWN


def test_a_jog_leaves_the_modes() -> None:
    gcode = Gcode()
    run(gcode, "G20 G2 F10 X1 R4")
    gcode.jog("G91 G21 X-5.4 F600")
    (line,) = gcode.actions()
    assert line.feed == 10 << 32 and at(gcode)[0] == 20
    assert (gcode.c.mode[0], gcode.c.mode[3], gcode.c.mode[4]) == (20, 200, 900)
    assert gcode.c.feed == 254_000_000


def test_targets_for_the_planner() -> None:
    """Q31.32 mm, to the nearest."""
    for nanometers in (0, 1, -1, 500_000, 123_456_789, -987_654_321_012, NOT_MOVING):
        exact = Fraction(nanometers, NANOMETERS) * 2**32
        assert abs(planner().passo_gcode_millimetres(nanometers) - exact) <= Fraction(1, 2)
