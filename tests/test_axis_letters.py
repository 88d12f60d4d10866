# SPDX-License-Identifier: MIT
"""Machines without some of the axes before the last one: from the machine file to the steps."""

from pathlib import Path

import pytest
from passo.cli import main
from passo.engine import model_engine
from passo.expand.expander import Options, expand_file
from passo.failure import BadInputError
from passo.gcode import NANOMETERS, Gcode, GcodeError, GcodeSettings
from passo.grbl_setup import machine_at
from passo.machine_file import read_machine
from passo.make_command import LARGE, definitions, settings_lines
from passo.part import play_part, read_part
from passo.run import open_engine, parameters_for
from passo.toolchain import paths
from passo_stm32.grbl_board import LARGE_IMAGE, GrblBoard, grbl_elf

from tests.helpers.grbl_console import GrblConsole
from tests.test_firmware_cb import HZ, PARAMETERS
from tests.test_gcode import run

LETTERS = ["XYZC", "XYZB", "XA", "XYA", "XYC", "XYZAC", "A", "XBC", "XZ", "XZC"]
STEPS = {"X": 80, "Y": 100, "Z": 400, "A": 10, "B": 20, "C": 40}


def text_of(letters: str) -> str:
    """A machine file."""
    return "clock_hz = 4_000_000\n" + "".join(
        f'[[axis]]\nname = "{letter}"\nsteps_per_mm = {STEPS[letter]}\nspeed = 100\nacceleration = 1000\n'
        for letter in letters
    )


def file_of(folder: Path, letters: str) -> Path:
    path = folder / "machine.toml"
    path.write_text(text_of(letters))
    return path


@pytest.mark.parametrize("letters", LETTERS)
def test_each_axis_has_its_letter(tmp_path: Path, letters: str) -> None:
    """All words move their own axis; the others are refused."""
    machine = read_machine(file_of(tmp_path, letters))
    assert machine.letters == letters and machine.motors == list(letters)
    gcode = Gcode(machine.gcode)
    run(gcode, "G0 " + " ".join(f"{letter}{number}" for number, letter in enumerate(letters, 1)))
    assert gcode.position == tuple(number * NANOMETERS for number in range(1, len(letters) + 1))
    for letter in set("XYZABC") - set(letters):
        with pytest.raises(GcodeError, match="error:20"):
            gcode.execute(f"G0 {letter}1")
    run(gcode, f"G10 L2 P1 {letters[-1]}5", f"G92 {letters[-1]}2", f"G20 G91 G0 {letters[-1]}1")
    unit = NANOMETERS if letters[-1] in "ABC" else 25.4 * NANOMETERS
    assert gcode.position[-1] == len(letters) * NANOMETERS + unit


@pytest.mark.parametrize(
    ("letters", "line", "taken"),
    [
        ("XYZC", "G2 X2 I1 F9 C3", True), ("XYZC", "G19 G2 Y2 J1 F9", True), ("XYC", "G2 X2 I1 F9", True),
        ("XA", "G2 X2 I1 F9", False), ("XYA", "G18 G2 X2 I1 F9", False), ("A", "G2 A2 I1 F9", False),
        ("XYZC", "G81 X1 Z-1 R1 F9", True), ("XYA", "G81 X1 R1 F9", False), ("XAB", "G81 X1 R1 F9", False),
        ("XYZC", "G43.1 Z1", True), ("XYA", "G43.1 A1", False), ("XA", "G38.2 A3 F9", True),
        ("XYZC", "G81 X1 Z-1 R1 F9 C1", False), ("XZ", "G2 X2 I1 F9", True), ("XZC", "G3 Z2 K1 F9 C3", True),
        ("XZ", "G17 G2 X2 I1 F9", False), ("XZ", "G19 G2 Z2 K1 F9", False), ("XZ", "G2 X2 J1 F9", False),
        ("XZ", "G17 G81 X1 Z-1 R1 F9", True), ("XZ", "G81 X1 R1 F9", False), ("XZ", "G43.1 Z1", True),
        ("XZ", "G10 L1 P1 Z1", True), ("XZ", "G10 L1 P1 X1", False), ("XZC", "G19 G81 X-1 Z2 R1 F9", True),
    ],
)  # fmt: skip
def test_planes_and_lengths_are_of_x_y_z(letters: str, line: str, taken: bool) -> None:
    """An axis behind one that is left out is not taken for it."""
    gcode = Gcode(GcodeSettings(axes=len(letters), letters=letters))
    if taken:
        run(gcode, line)
    else:
        with pytest.raises(GcodeError):
            gcode.execute(line)


def test_a_tool_length_is_none_of_another_axis() -> None:
    """Without Z."""
    gcode = Gcode(GcodeSettings(axes=3, letters="XYA"))
    gcode.c.offsets.tool_length[0] = 5 * NANOMETERS
    run(gcode, "G43 H1", "G0 A1")
    assert gcode.position == (0, 0, NANOMETERS)


def test_a_lathe_has_the_plane_of_x_and_z() -> None:
    """At first, and after the end of a program; its lengths are those of Z, and it drills along Z."""
    gcode = Gcode(GcodeSettings(axes=2, letters="XZ", arc_tolerance=0.1))
    run(gcode, "G10 L1 P1 Z5", "G43 H1", "G0 X10 Z0")
    assert gcode.position == (10 * NANOMETERS, 5 * NANOMETERS)
    run(gcode, "G49", "G0 X0 Z0")
    (*_, middle, end) = run(gcode, "G2 X10 Z10 K10 F9")
    assert list(end.target[0:2]) == [10 * NANOMETERS, 10 * NANOMETERS] and middle.target[1] < middle.target[0]
    holes = [list(action.target[0:2]) for action in run(gcode, "G17 G81 X3 Z-2 R1")]
    assert holes[-2:] == [[3 * NANOMETERS, -2 * NANOMETERS], [3 * NANOMETERS, 10 * NANOMETERS]]
    run(gcode, "M2", "G2 X10 Z10 R30 F9")


@pytest.mark.parametrize("letters", ["XYZC", "XA", "XZ"])
def test_a_part(tmp_path: Path, letters: str) -> None:
    """`passo run`: the steps of each motor."""
    machine = read_machine(file_of(tmp_path, letters))
    (tmp_path / "part.nc").write_text(f"G1 X5 {letters[-1]}90 F1000\nG91 {letters[-1]}-30\nG0 X1\n")
    part = read_part(tmp_path / "part.nc", machine)
    with open_engine("model", parameters_for(len(letters)), machine.clock_hz) as engine:
        played = play_part(part, machine, engine)
    assert not played.problems()
    wanted = [6 * STEPS["X"], *[0] * (len(letters) - 2), 60 * STEPS[letters[-1]]]
    assert played.end == wanted


def test_the_results_name_the_axes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And a refusal names those that there are."""
    path, part = file_of(tmp_path, "XYZC"), tmp_path / "part.nc"
    part.write_text("G1 X5 Z1 C90 F1000\n")
    command = ["preview", str(part), "--machine", str(path), "--out", str(tmp_path / "out")]
    assert main(command) == 0
    said = capsys.readouterr().out
    assert "C 0 to 90" in said and "Z 0 to 1" in said and "A " not in said
    part.write_text("G1 A5 F1000\n")
    assert main(command) != 0
    assert "A5 (NIST): the machine has the axes X Y Z C" in capsys.readouterr().err


def test_parameters_are_in_the_order_of_linuxcnc(tmp_path: Path) -> None:
    """#5424 is B, whichever axis it is of the machine."""
    (tmp_path / "part.ngc").write_text("G0 X1 B7\nG92 B3\n#1=#5424 #2=#5423 #3=#5215\nG1 X#1 B[#2+#3] F9\n")
    options = Options(GcodeSettings(axes=2, letters="XB"), at_zero=True)
    assert [line.text for line in expand_file(tmp_path / "part.ngc", options)][-1] == "G1 X3 B4 F9"


def test_the_console(tmp_path: Path) -> None:
    """Reports, settings and jogs count the axes of the machine."""
    machine = read_machine(file_of(tmp_path, "XYZC"))
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.take()
        assert session.line("G1 X1 C10 F6000") == "ok" and session.line("$J=G91 C-4 F6000") == "error:8"
        session.rest()
        assert session.fields("MPos") == [1, 0, 0, 10]
        assert session.line("$J=G91 C-4 F6000") == "ok" and session.line("$J=A1 F10") == "error:20"
        session.rest()
        assert session.fields("MPos") == [1, 0, 0, 6]
        assert "$103=40.000" in session.line("$$").splitlines()
        assert "[G54:0.000,0.000,0.000,0.000]" in session.line("$#")


@pytest.mark.parametrize(("letters", "z"), [("XZ", 1), ("XZC", 1), ("XYZC", 2)])
def test_tool_lengths_by_the_probe(tmp_path: Path, letters: str, z: int) -> None:
    """Of Z, whichever axis it is; Z touches a quarter of its travel below. A machine without Z has none."""
    path = file_of(tmp_path, letters)
    path.write_text("probe = true\n" + path.read_text())
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.limit(60)
        session.line("$X")
        assert session.line("$342=60") == session.line("$344=3000") == session.line("$345=3000") == "ok"
        assert session.line("$343=300") == session.line("G10 L1 P3 Z7") == "ok"
        assert session.line("$TPW").endswith("ok") and session.line("$TLR") == "ok"
        touched = [0.0] * len(letters)
        touched[z] = -50
        assert session.fields("MPos") == pytest.approx([at + 4 * (at != 0) for at in touched], abs=0.02)
        session.grbl.c.reference -= 3_500_000  # as if the first tool had been so much shorter
        assert session.line("$TPW").endswith("ok") and "[TLO:3.500]" in session.line("$#")
        rotary = ",0.000" if "C" in letters else ""
        assert f"[T:3,0.000,0.000,7.000{rotary},0.000]" in session.line("$#")
        assert session.fields("WCO") == [3.5 * (axis == z) for axis in range(len(letters))]


def test_a_machine_without_z_has_no_tool_length(tmp_path: Path) -> None:
    """Its third axis is not taken for Z."""
    path = file_of(tmp_path, "XYA")
    path.write_text("probe = true\n" + path.read_text())
    machine = read_machine(path)
    with machine_at("model", machine) as engine:
        session = GrblConsole(engine, machine)
        session.line("$X")
        assert session.line("$TPW") == session.line("$TLR") == "error:47"


@pytest.mark.parametrize(
    ("letters", "said"),
    [
        ("XZY", 'axis 3: name must be "A", "B" or "C", not'),
        ("XYZCA", "axis 5: name must be left out, C is the last one, not"),
        ("YZ", 'axis 1: name must be "X", "A", "B" or "C", not'),
        ("XYZBA", 'axis 5: name must be "C", not'),
        ("XX", 'axis 2: name must be "Y", "Z", "A", "B" or "C", not'),
    ],
)
def test_a_wrong_order_is_refused(tmp_path: Path, letters: str, said: str) -> None:
    with pytest.raises(BadInputError, match=said):
        read_machine(file_of(tmp_path, letters))


def test_the_firmware(tmp_path: Path) -> None:
    """Its definitions are those of the machine file; C is the fourth axis of the large chip."""
    path = tmp_path / "machine.toml"
    path.write_text(f'chip = "{LARGE}"\n' + text_of("XYZC"))
    machine = read_machine(path)
    made = definitions(machine)
    assert (made["AXES"], made["AXES_LEFT_OUT"]) == (4, 0b011000) and "$103=40" in settings_lines(machine)
    given = [f"{name}={made[name]}" for name in ("AXES", "AXES_LEFT_OUT")]
    elf = grbl_elf(paths.build / "tests" / "firmware_xyzc", *given, image=LARGE_IMAGE)
    with model_engine(PARAMETERS, HZ) as engine:
        board = GrblBoard(engine, elf)
        assert board.line("G1 X1 C2 F6000") == "ok" and board.line("G0 A1") == "error:20"
        board.rest(2)
        assert board.report()["MPos"] == "1.000,0.000,0.000,2.000"
        assert not board.faults
