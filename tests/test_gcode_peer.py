# SPDX-License-Identifier: MIT
"""The interpreter against LinuxCNC's: random programs, and the table of differences."""

import random
import subprocess
import sys
import tomllib

import pytest
from passo import random_cases
from passo.toolchain import paths

from benchmarks.gcode_compare import compare, verdict
from benchmarks.gcode_motion import moving
from benchmarks.gcode_passo import play_passo
from benchmarks.gcode_programs import Programs, known, random_program
from benchmarks.gcode_rs274 import play_rs274

PROGRAMS = 100
ROWS = [
    (program, passo, linuxcnc)
    for program, passo, _, linuxcnc, _ in tomllib.loads(
        (paths.root / "spec" / "gcode_differences.toml").read_text()
    )["rows"]
]
# What both parsers must agree on, and a change in it that one of them sees.
CHANGES = {
    "G1 X10 Y5 F100": "G1 X10 Y-5 F100",
    "G1 X10 F100": "G1 X10.01 F100",
    "G1 X3 F100": "G1 X3 F101",
    "G0 X3": "G1 X3 F9000",
    "F100 G2 X10 Y0 I5": "F100 G3 X10 Y0 I5",
    "F100 G3 X6 Y8 R5.5": "F100 G3 X6 Y8 R-5.5",
    "F100 G2 X0 Y0 I5": "F100 G2 X0 Y0 I5.01",
    "F100 G18 G2 X10 Z0 I5 Y1": "F100 G18 G2 X10 Z0 I5 Y1.1",
    "G20 G0 X1": "G21 G0 X1",
    "G10 L2 P2 X5\nG55 G0 X1": "G10 L2 P2 X5\nG54 G0 X1",
    "G0 X5\nG92 X0\nG0 X1": "G0 X5\nG92 X1\nG0 X1",
    "G43.1 Z2\nG0 Z1": "G43.1 Z2\nG49\nG0 Z1",
    "G0 X9\nG28.1\nG0 X1\nG28": "G0 X9\nG30.1\nG0 X1\nG28",
    "G93 G1 X9 F5": "G94 G1 X9 F5",
    "G4 P1.5": "G4 P1.6",
    "M3 S500 G0 X1": "M4 S500 G0 X1",
    "M3 S500 G0 X2": "M3 S501 G0 X2",
    "M8 G0 X1": "M7 G0 X1",
    "G64 P0.1 G0 X1": "G64 P0.2 G0 X1",
    "G64 P0.1 Q0.3 G0 X1": "G61 G0 X1",
    "G0 X1\nG0 X2": "G0 X1\nG0 X2\nG0 X3",
    "G0 Z9\nG98 G81 X1 Z-1 R2 F50\nX2": "G0 Z9\nG99 G81 X1 Z-1 R2 F50\nX2",
    "G98 G83 X1 Z-5 R2 Q2 F50": "G98 G73 X1 Z-5 R2 Q2 F50",
    "G98 G82 X1 Z-1 R2 P1 F50": "G98 G82 X1 Z-1 R2 P1.5 F50",
    "G98 G91 G81 X1 Z-1 R2 L2 F50": "G98 G91 G81 X1 Z-1 R2 L3 F50",
    "M3 S100\nG98 G86 X1 Z-1 R2 P1 F50": "M3 S100\nG98 G85 X1 Z-1 R2 F50",
    "F100 G2 I5": "F100 G2 I6",
    "G0 X1 X1": "G0 X1",
}


def test_random_programs() -> None:
    """The same motions, and the same lines refused; `make gcode-peer` plays more of them."""
    arcs = refused = 0
    for number in range(PROGRAMS):
        program = random_program(random.Random(f"{random_cases.seed()} {number}"))
        ours = play_passo(program)
        found = verdict(ours, play_rs274(program))
        assert not found, "\n".join([f"seed {random_cases.seed()}: {found}", *program])
        arcs += sum(motion.center is not None for motion in ours.motions)
        refused += ours.refused > 0
    assert arcs > 3 * PROGRAMS and refused > PROGRAMS / 20


@pytest.mark.parametrize("right", CHANGES)
def test_a_change_is_seen(right: str) -> None:
    """Of target, feed, center, way round, offsets, outputs, tolerance, refusals."""
    one, other = ["G0", *right.split("\n")], ["G0", *CHANGES[right].split("\n")]
    assert compare(one) == "" and compare(other) == ""
    assert verdict(play_passo(one), play_rs274(other))
    assert verdict(play_passo(other), play_rs274(one))


def test_the_table_has_the_differences() -> None:
    """Enough of them, and none twice; the page is up to date."""
    subprocess.run([sys.executable, "spec/generate_gcode.py", "--check"], cwd=paths.root, check=True)
    assert len(ROWS) > 35
    assert len({tuple(program) for program, *_ in ROWS}) == len(ROWS)


@pytest.mark.parametrize(("program", "passo", "linuxcnc"), ROWS, ids=[" / ".join(row[0]) for row in ROWS])
def test_a_row_of_the_table(program: list[str], passo: str, linuxcnc: str) -> None:
    """Each parser does what its column says, at the last line."""
    ours, theirs = play_passo(program), play_rs274(program)
    last = 0 if passo == "ok" else len(program)
    assert ours.refused == last and (not last or f"error:{passo}:" in ours.why)
    if linuxcnc == "refused":
        assert theirs.refused == len(program)
    else:
        assert theirs.refused == 0
    if linuxcnc in ("same", "other"):
        assert not last and (verdict(ours, theirs) != "") == (linuxcnc == "other")
    if passo == "ok" and linuxcnc == "same":
        assert list(moving(ours.motions)) or program[-1].startswith("G6")


def test_random_programs_are_free_of_known_differences() -> None:
    """And what the generator leaves out is in the table."""
    left_out = 0
    for program, passo, linuxcnc in ROWS:
        programs = Programs(random.Random(1))
        for line in ["G0", *program[:-1]]:
            programs.passo.execute(line)
        if known(program[-1], programs.passo):
            left_out += 1
            differs = (linuxcnc == "refused") == (passo == "ok") or linuxcnc == "other"
            assert differs, program
    assert left_out >= 7
