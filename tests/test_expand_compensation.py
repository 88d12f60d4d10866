# SPDX-License-Identifier: MIT
"""Cutter compensation: against LinuxCNC's interpreter, and by the distance of the tool from the contour."""

import cmath
import math
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from passo import random_cases
from passo.cli import main
from passo.expand.expander import Options, expand_file
from passo.expand.output import FIRST_AFTER
from passo.expand.place import ExpandError
from passo.expand.tools import Tool, read_tools
from passo.failure import BadInputError
from passo.toolchain import paths

from benchmarks.gcode_contours import contour_program
from benchmarks.gcode_corpus import contours
from benchmarks.gcode_expand import OPTIONS, compare_contour, play_expanded
from benchmarks.gcode_motion import Motion

PROGRAMS = 100
CONTOURS = dict(contours())
SLACK = 0.004  # of the radius: a corner of up to 0.05 rad has no arc, and a chord of these tests is short
TOOLS = {3: Tool(3, 4.0)}
SQUARE = "G0 X-5 Y0\nG41 D3\nG1 F100 X0\nY10\nX10\nY0\nX0\nG40\nX-5\n"


def plain(folder: Path, text: str, options: Options | None = None) -> list[str]:
    """The plain lines of a text."""
    path = folder / "part.ngc"
    path.write_text(text)
    options = options or replace(OPTIONS, tools=TOOLS)
    return [line.text for line in expand_file(path, options)]


@pytest.mark.parametrize("name", CONTOURS)
def test_corpus(name: str) -> None:
    """Each side, plane and unit, with tools of a table, and with inverse time."""
    assert compare_contour(CONTOURS[name]) == ""
    assert not play_expanded(CONTOURS[name]).refused


def test_random_contours() -> None:
    """The same motions, feeds, centers as rs274; refused is what it refuses, and more gouges."""
    arcs = refused = 0
    for number in range(PROGRAMS):
        program = contour_program(random.Random(f"{random_cases.seed()} {number}"))
        found = compare_contour(program)
        assert not found, "\n".join([f"seed {random_cases.seed()} {number}: {found}", *program])
        played = play_expanded(program)
        arcs += sum(motion.center is not None for motion in played.motions)
        refused += played.refused > 0
    assert arcs > PROGRAMS and PROGRAMS / 50 < refused < PROGRAMS / 2


def test_distance_from_the_contour() -> None:
    """The tool touches what it cuts, and stays out of the elements beside it."""
    judged = 0
    for number in range(3 * PROGRAMS):
        program = contour_program(random.Random(f"{random_cases.seed()} {number}"))
        if program[0] != "G21 G90 G94 G17" or "G93" in program[3]:
            continue
        programmed, played = play_expanded(without(program)), play_expanded(program)
        if not played.refused:
            tool, diameter = program[2].split()
            radius = float(diameter[1:]) / 2 * (1 if "." in tool else 0.254)
            judged += judge(elements(programmed.motions, program), elements(played.motions, program), radius)
    assert judged > PROGRAMS


def without(program: list[str]) -> list[str]:
    """A program without its compensation."""
    return ["" if line.startswith(("G41", "G42")) else line for line in program]


def elements(motions: list[Motion], program: list[str]) -> dict[int, list[list[complex]]]:
    """By line of the contour, but those that lead to it and away: points along each motion in the plane."""
    first, last = 5, program.index("G40")
    at, found = 0j, {}
    for motion in motions:
        if motion.dwell is not None:
            continue
        end = complex(*motion.end[:2])
        if first < motion.label <= last and motion.feed:  # a rapid crosses an outside corner
            found.setdefault(motion.label, []).append(list(points(at, end, motion)))
        at = end
    return found


def points(begin: complex, end: complex, motion: Motion) -> Iterator[complex]:
    """Along a motion, both ends included."""
    count = 200
    for k in range(count + 1):
        if motion.center is None:
            yield begin + (end - begin) * k / count
            continue
        center = complex(*motion.center)
        sweep = cmath.phase((end - center) / (begin - center)) % math.tau
        if motion.clockwise:
            sweep -= math.tau
        yield center + (begin - center) * cmath.exp(1j * sweep * k / count)


def judge(
    contour: dict[int, list[list[complex]]], tool: dict[int, list[list[complex]]], radius: float
) -> int:
    """Number of motions judged. An element that comes back to the one beside it does not count for it."""
    judged = 0
    lines = sorted(contour)
    for at, label in enumerate(lines):
        (own,) = contour[label]
        if abs(own[0] - own[-1]) < 1e-6 or label not in tool:
            continue  # along the third axis, or a rapid
        near = [own]
        if at and distance(contour[lines[at - 1]][0][:140], own) > 2 * radius:
            near += contour[lines[at - 1]]
        if at + 1 < len(lines) and distance(contour[lines[at + 1]][0][60:], own) > 2 * radius:
            near += contour[lines[at + 1]]
        for motion in tool[label]:
            assert min(distance(motion[::10], element) for element in near) > radius * (1 - SLACK) - 1e-4, (
                label
            )
            judged += 1
        assert distance(tool[label][-1][::10], own) < radius * (1 + SLACK) + 0.02, label
    return judged


def distance(some: list[complex], others: list[complex]) -> float:
    """The smallest one."""
    return min(abs(p - q) for p in some for q in others)


def test_square(tmp_path: Path) -> None:
    """By hand: clockwise with the tool on the left is outside."""
    assert plain(tmp_path, SQUARE) == [
        "G0 X-5 Y0", "F100", "G1 X-2 Y2", "G1 X-2 Y10", "G2 X0 Y12 I2 J0", "G1 X10 Y12", "G2 X12 Y10 I0 J-2",
        "G1 X12 Y0", "G2 X10 Y-2 I-2 J0", "G1 X0 Y-2", "G1 X-5 Y0",
    ]  # fmt: skip


def test_order_and_modes(tmp_path: Path) -> None:
    """Other words keep their place; increments add up to the same places; N stays with its motion."""
    text = "G20 G0 X-1 Y0 F9\nG42.1 D.2 (on)\nN7 G1 X0\nM8\nG91 Y1 Z-.5 (down)\nS5 X1\nG4 P1\nZ.5\n"
    text += "G40 G0 X1\nX1\n"
    assert plain(tmp_path, text) == [
        "G20 G0 X-1 Y0 F9", "(on)", "N7 G1 X0 Y-0.1", "M8", "G91 (down)", "G3 X0.1 Y0.1 I0 J0.1",
        "G1 X0 Y0.9 Z-0.5",
        "S5", "G1 X0.9 Y0", "G4 P1", "G1 X0 Y0 Z0.5", "G0 X1 Y0.1", "X1",
    ]  # fmt: skip


def test_example(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is cut as on LinuxCNC, and runs."""
    folder = paths.examples / "gcode"
    program = [line.strip() for line in (folder / "plate.ngc").read_text().splitlines()]
    assert compare_contour([line for line in program if line not in ("", "M2")]) == ""
    asked = ["run", str(folder / "plate.ngc"), "--machine", str(folder / "machine.toml")]
    assert main([*asked, "--out", str(tmp_path)]) == 0
    assert "greatest share of a limit" in capsys.readouterr().out


def test_flat_corner_before_a_narrow_arc(tmp_path: Path) -> None:
    """A corner of 0.04 rad has no arc, but the one behind it must be round: a line leads to it."""
    text = "G0 X0 Y0 F9\nG42.1 D10\nG1 X20\nG2 X25.474292 Y-3.870239 I0.219941 J-5.495601\nG40\nG1 X0\n"
    lines = plain(tmp_path, text)
    assert lines[1] == "G1 X20 Y-5" and lines[2].startswith("G1 X20.") and lines[3].startswith("G2 X")


REFUSED = {
    "G0 X0 Y0\nG41 D9\n": "2: G41: no tool table has T9: --tools, or G41.1 D (NIST, LinuxCNC)",
    "G41\n": "1: G41: which tool? Write M6, D or G41.1 D (NIST, LinuxCNC)",
    "G41.1\n": "1: G41.1 needs the diameter of the tool: D (NIST, LinuxCNC)",
    "G19 G42 D3\n": "1: G42 is for the planes XY and ZX: write G17 or G18 (NIST, LinuxCNC)",
    "G41.1 D1 L2\n": "1: G41.1: L: edges of lathe tools are not supported (NIST, LinuxCNC)",
    "G41 D3\nG0 X1 Y9\n": "2: X is not known at its beginning: move X before G41 (NIST, LinuxCNC)",
    "G0 X0 Y0\nG41 D3\nX1\n": "3: the first motion after G41 or G42 is 1 mm and must be longer than the "
    "tool's radius, 2 mm (NIST)",
    "G0 X0 Y0\nG41 D3\nX9\nG42 D3\n": "4: G42 cannot be used while G41 is in force: write G40 "
    "before (NIST, LinuxCNC)",
    "G0 X0 Y0\nG41 D3\nX9\nG28\n": "4: G28 cannot be used while G41 is in force: write G40 before "
    "(NIST, LinuxCNC)",
    "G0 X0 Y0\nG41 D3\nX9\nG18\n": "4: G18 cannot be used while G41 is in force: write G40 before "
    "(NIST, LinuxCNC)",
    "G0 X0 Y0\nG42 D3\nX9\nG92 X0\n": "4: G92 cannot be used while G42 is in force: write G40 "
    "before (NIST, LinuxCNC)",
    "G0 X0 Y0\nG42 D3\nX9\nY#5420\n": "4: word Y: #5420 cannot be read while G41 or G42 is in "
    "force: write G40 before (LinuxCNC)",
    "G0 X0 Y0\nG41 D3\nX9\nY1\nX0\n": "4: the tool's radius of 2 mm would cut the contour: this line is too "
    "short for the inside corners at its ends (NIST)",
    "G0 X0 Y0 F9\nG41 D3\nX9\nG3 X9 Y2 J1\n": "4: the tool's radius of 2 mm does not fit inside the "
    "arc's 1 (NIST)",
    "G0 X0 Y0 F9\nG41 D3\nX9\nG3 X3 I-3\n": "4: the tool's radius of 2 mm does not fit into this inside "
    "corner (NIST)",
    "G0 X0 Y0 F9\nG41 D3\nX9\nG40\nG2 X10 I.5\n": f"5: {FIRST_AFTER} (NIST, LinuxCNC)",
    "G0 X0 Y0 F9\nG41 D3\nX9\nG40\nG92 X0\n": f"5: {FIRST_AFTER} (NIST, LinuxCNC)",
    "G0 X0 Y0 Z3 F9\nG41 D3\nX9\nG40\nG81 X0 Z0 R1\n": f"5: {FIRST_AFTER} (NIST, LinuxCNC)",
    "G0 X0 Y0 Z3 F9\nG41 D3\nX9\nG81 X0 Z0 R1\n": "4: G81 cannot be used while G41 is in force: "
    "write G40 before (NIST, LinuxCNC)",
}


@pytest.mark.parametrize("text", REFUSED)
def test_refusal(tmp_path: Path, text: str) -> None:
    """Names the line, the word and the reason."""
    with pytest.raises(ExpandError) as caught:
        plain(tmp_path, text, Options(tools=TOOLS))
    assert f"{caught.value.place.line}: {caught.value.reason}" == REFUSED[text]


def test_a_tool_without_a_radius(tmp_path: Path) -> None:
    """It is where the program says, also in the line that turns compensation on."""
    text = "G0 X0 Y0 Z1 F9\nG42 D0 G1 X5 Y1 Z0\nX6\nG40 X7\n"
    assert plain(tmp_path, text) == ["G0 X0 Y0 Z1 F9", "G1 X5 Y1 Z0", "X6", "G40 X7"]


def test_home_after_compensation(tmp_path: Path) -> None:
    """Z may go home first; the next line in the plane begins where the tool is."""
    text = "G0 X0 Y0 Z0\nG41 D3\nX9\nG40\nG53 G0 Z0\nG91 G28 Z0\nX1\n"
    assert plain(tmp_path, text)[-3:] == ["G53 G0 Z0", "G91 G28 Z0", "G0 X1 Y-2"]


def test_tool_table(tmp_path: Path) -> None:
    """LinuxCNC's format; a wrong line is named."""
    path = tmp_path / "tool.tbl"
    path.write_text(";comment\nT1 P2 Z1.5 D6.35 ;end mill\nT20 P3\n")
    assert read_tools(path) == {1: Tool(1, 6.35, 1.5), 20: Tool(20)}
    path.write_text("T1 P1\nD5\n")
    with pytest.raises(BadInputError, match=r"tool\.tbl:2: a tool needs its number: T"):
        read_tools(path)
    with pytest.raises(BadInputError, match="No such file"):
        read_tools(tmp_path / "none")
