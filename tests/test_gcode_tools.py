# SPDX-License-Identifier: MIT
"""Tool change and tool lengths in the interpreter."""

import pytest
from passo.gcode import Gcode, GcodeError, GcodeSettings
from passo.native import planner

from tests.test_gcode import run

TABLE = "G10 L1 P1 Z10", "G10 L1 P2 Z-2.5", "G20 G10 L1 P100 Z1", "G21"


@pytest.fixture
def gcode() -> Gcode:
    """With a tool table."""
    made = Gcode(GcodeSettings(axes=3))
    for line in TABLE:
        run(made, line)
    return made


def kinds(gcode: Gcode, line: str) -> list[tuple[int, int]]:
    """Kind and output of the actions of a line; a tool to be changed is loaded."""
    gcode.execute(line)
    found = []
    for action in gcode.actions():
        found.append((action.kind, action.output >> 16))
        if action.kind == planner().PASSO_GCODE_CHANGE:
            planner().passo_gcode_load(gcode.c, action.tool)
    return found


def refused(gcode: Gcode, line: str) -> int:
    with pytest.raises(GcodeError) as error:
        gcode.execute(line)
    return error.value.number


def test_a_change(gcode: Gcode) -> None:
    """Before spindle and coolant of its line, with both off; only if another tool is loaded."""
    c = planner()
    assert kinds(gcode, "M3 S100 M8") == [(c.PASSO_GCODE_OUTPUT, 5)]
    assert kinds(gcode, "T3") == [] and gcode.c.loaded == 0
    assert kinds(gcode, "M6 M4 M9 G0 X1") == [
        (c.PASSO_GCODE_CHANGE, 0), (c.PASSO_GCODE_OUTPUT, 3), (c.PASSO_GCODE_LINE, 3),
    ]  # fmt: skip
    assert gcode.c.loaded == 3 and kinds(gcode, "T3 M6") == []
    assert kinds(gcode, "T0 M6") == [(c.PASSO_GCODE_CHANGE, 0)] and gcode.c.loaded == 0


def test_a_change_with_a_laser(gcode: Gcode) -> None:
    """Power in proportion to the speed is off as well; the outputs of the user stay."""
    gcode.c.settings.laser = True
    gcode.c.settings.spindle_maximum = 1000
    assert kinds(gcode, "M4 S500 M62 P1 T3 M6")[0] == (planner().PASSO_GCODE_CHANGE, 1 << 5)


def test_m61_says_which_one_is_loaded(gcode: Gcode) -> None:
    assert kinds(gcode, "M61 Q7") == [] and (gcode.c.loaded, gcode.c.tool) == (7, 7)
    assert kinds(gcode, "T7 M6") == []
    assert refused(gcode, "M61") == 28 and refused(gcode, "M61 Q256") == 38
    assert refused(gcode, "M6 M61 Q1") == 21 and refused(gcode, "M61 Q-1") == 4
    planner().passo_gcode_reset(gcode.c)
    assert (gcode.c.loaded, gcode.c.tool) == (7, 7)


@pytest.mark.parametrize(
    ("lines", "length"),
    [
        (["G43 H1"], 10), (["T2 M6", "G43"], -2.5), (["T1 M6 G43"], 10), (["G43"], 0), (["G43 H0"], 0),
        (["G43 H100"], 25.4), (["G43.2 H1"], 10), (["G43 H1", "G43.2 H2"], 7.5), (["G43 H1", "G49"], 0),
        (["M61 Q2 G43"], -2.5), (["G43 H1", "G43 H2"], -2.5), (["G43.1 Z3", "G43.2 H1"], 13), (["G43 H3"], 0),
        (["G43 H1", "G10 L1 P1 Z5"], 10), (["G91", "G43 H1"], 10),
    ],
)  # fmt: skip
def test_lengths(gcode: Gcode, lines: list[str], length: float) -> None:
    """They hold in the line that gives them, whatever its motion, and move nothing."""
    for line in lines:
        kinds(gcode, line)
    assert gcode.c.tool_length == round(length * 1e6) and gcode.position == (0, 0, 0)
    kinds(gcode, "G90 G0 Z1")
    assert gcode.position[2] == round(1e6 * (1 + length))


def test_a_length_and_a_motion_in_one_line(gcode: Gcode) -> None:
    kinds(gcode, "G0 G43 H1 X2 Z5")
    assert gcode.position == (2_000_000, 0, 15_000_000)
    kinds(gcode, "G49 G0")
    kinds(gcode, "Z5")
    assert gcode.position[2] == 5_000_000


@pytest.mark.parametrize(
    ("line", "number"),
    [
        ("H1", 36), ("G43 H101", 38), ("G43 H-1", 4), ("G43.2", 28), ("G43 G49", 21), ("G10 L1 P0 Z1", 38),
        ("G10 L1 P101 Z1", 38), ("G10 L1 P1 X1", 37), ("G10 L1 P1 X1 Z1", 37), ("G10 L1 P1", 26),
        ("G10 L1 Z1", 28), ("G10 L1 P1 Z1 R2", 20), ("G10 L1 P1 Z3000", 33), ("G49 H1", 36),
        ("G43.1 H1 Z1", 36), ("G43.3", 20), ("M6.1", 23), ("T256 M6", 38),
    ],
)  # fmt: skip
def test_errors_change_nothing(gcode: Gcode, line: str, number: int) -> None:
    before = list(gcode.c.offsets.tool_length)
    assert refused(gcode, line) == number
    assert list(gcode.c.offsets.tool_length) == before and gcode.c.tool_length == 0 and gcode.c.tool == 0


def test_outputs_of_the_user(gcode: Gcode) -> None:
    """M62 and M63 with the lines that follow, M64 and M65 at rest; a reset ends them, M2 and M6 do not."""
    c = planner()

    def acted(line: str) -> list[tuple[int, int, bool]]:
        gcode.execute(line)
        return [(action.kind, action.output >> 20, action.stops) for action in gcode.actions()]

    assert acted("M62 P0 G0 X1") == [(c.PASSO_GCODE_OUTPUT, 1, False), (c.PASSO_GCODE_LINE, 1, False)]
    assert acted("M64 P3") == [(c.PASSO_GCODE_OUTPUT, 9, True)]
    assert acted("M64 P3 X2") == [(c.PASSO_GCODE_LINE, 9, False)]
    assert acted("T5 M6 M62 P2") == [(c.PASSO_GCODE_CHANGE, 13, False), (c.PASSO_GCODE_OUTPUT, 13, False)]
    assert acted("M63 P0") == [(c.PASSO_GCODE_OUTPUT, 12, False)]
    assert acted("M65 P2 M2") == [(c.PASSO_GCODE_OUTPUT, 8, True), (c.PASSO_GCODE_END, 8, False)]
    assert refused(gcode, "M62") == 28 and refused(gcode, "M62 P4") == 39 and refused(gcode, "M62 P-1") == 4
    assert refused(gcode, "M62 P1 M63 P1") in (21, 25) and refused(gcode, "M62 M64 P1") == 21
    planner().passo_gcode_reset(gcode.c)
    assert gcode.c.digital == 0


def test_an_input(gcode: Gcode) -> None:
    """M66 is at rest, before the motion of its line; L0, or none, only reads."""
    c = planner()

    def acted(line: str) -> list[tuple[int, ...]]:
        gcode.execute(line)
        return [(action.kind, action.input, action.wanted, action.microseconds) for action in gcode.actions()]

    assert acted("M66 P1") == acted("M66 P1 L0") == [(c.PASSO_GCODE_INPUT, 1, 0, 0)]
    moved = (c.PASSO_GCODE_LINE, 0, 0, 0)
    assert acted("M66 P3 L4 Q.5 G0 X1") == [(c.PASSO_GCODE_INPUT, 3, 4, 500_000), moved]
    assert acted("G4 P2 M66 L1 Q3")[0] == (c.PASSO_GCODE_INPUT, 2, 1, 3_000_000)
    for line, number in {
        "M66": 28, "M66 L0": 28, "M66 P1 L3": 28, "M66 P1 L3 Q0": 28, "M66 P7": 39, "M66 E0": 39,
        "M66 P1 E0": 39, "M66 P1 L5 Q1": 20, "M66 P1 L-1": 4, "M66 P1 M62": 21, "M66 P1 Q1 R1": 36,
    }.items():  # fmt: skip
        assert refused(gcode, line) == number, line
    with pytest.raises(GcodeError, match="no such input"):
        Gcode(GcodeSettings(inputs=0)).execute("M66 P0")


def test_the_power(gcode: Gcode) -> None:
    """M67 with the lines that follow, M68 at rest; S, M3, M4, M5, the end and a reset take it back."""
    full = 65535
    gcode = Gcode(GcodeSettings(spindle_maximum=1000))

    def power(line: str) -> list[tuple[int, bool]]:
        gcode.execute(line)
        return [(action.output & full, action.stops) for action in gcode.actions()]

    assert power("M67 E0 Q50 G0 X1") == [(full // 2, False)] * 2
    assert power("M68 E0 Q100") == [(full, True)] and power("M68 E0 Q100") == []
    assert power("M67 E0 Q12.5") == [(full // 8, False)]
    assert power("M62 P0 X2")[-1] == (full // 8, False)
    for back, left in {"S500": 0, "M3": full // 2, "M4": full // 2, "M5": 0}.items():
        power("M67 E0 Q80")
        assert power(back)[-1][0] == left, back
    power("M3 S500")
    assert power("M67 E0 Q25")[-1] == (full // 4, False) and power("M2")[-1] == (0, False)
    power("M67 E0 Q25")
    planner().passo_gcode_reset(gcode.c)
    assert power("X0 G0") == [(0, False)]
    for line, number in {
        "M67": 28, "M67 E0": 28, "M67 Q1": 28, "M67 E1 Q1": 39, "M68 E-1 Q1": 4, "M67 E0 Q-1": 4,
        "E1": 36, "M67 E0 Q1 M68": 21, "M67 E0 Q1 P1": 36,
    }.items():  # fmt: skip
        assert refused(gcode, line) == number, line
    with pytest.raises(GcodeError, match="no such input or output"):
        Gcode(GcodeSettings(power=False)).execute("M68 E0 Q1")


def test_p_and_q_of_an_output_are_not_those_of_the_path() -> None:
    gcode = Gcode(GcodeSettings())
    gcode.execute("G64 M67 E0 Q2")
    assert gcode.c.tolerance == 0
    gcode.execute("G64 P2")
    assert gcode.c.tolerance > 0
