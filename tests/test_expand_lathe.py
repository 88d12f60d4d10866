# SPDX-License-Identifier: MIT
"""Diameters, threads and taps as plain lines."""

import json
from pathlib import Path

import pytest
from passo.cli import main
from passo.toolchain import paths

from benchmarks.gcode_expand import compare_expanded, play_expanded
from tests.test_expand import expanded, refusal

HEAD = ["G21 G18 G8 G0 X10 Z5", "M3 S100"]
THREADS = {
    "G76 P1.5 Z-20 I-1 J0.3 K0.9": 14,
    "G76 P1.5 Z-20 I1 J0.3 K0.9 R1.5 Q29.5 H2": 34,
    "G91 G76 P1.5 Z-20 I-1 J0.3 K0.9 X3\nG0 X1": 15,
    "G20 G0 X1 Z1\nG76 P.05 Z-.5 I-.1 J.01 K.04 R2 Q30\nG0 Z1": 68,
    "G76 P1 Z9 I-1 J0.3 K0.4 Q20": 10,
}


@pytest.mark.parametrize("text", THREADS)
def test_a_thread(text: str) -> None:
    """All passes are those of rs274."""
    program = [*HEAD, *text.split("\n")]
    assert compare_expanded(program) == ""
    assert len(play_expanded(program).motions) == THREADS[text]


def test_words_of_a_thread_are_diameters_after_g7(tmp_path: Path) -> None:
    """As LinuxCNC's documentation says; its interpreter 2.9 halves I, J and K twice."""
    text = "{} G0 X{} Z5\nM3 S1\nG76 P1 Z-9 I{} J{} K{}\nG0 X{}\n"
    assert expanded(tmp_path, text.format("G7", 20, -2, 0.6, 1.2, 30)) == [
        line for line in expanded(tmp_path, text.format("", 10, -1, 0.3, 0.6, 15))
    ]


def test_holes(tmp_path: Path) -> None:
    """The pitch is F / S; the row goes on at each line with an axis word; L repeats."""
    assert expanded(tmp_path, "M3 S500\nG0 Z5\nG84 X1 Y1 Z-5 R2 F625\nX2\nG80\nG0 X0") == [
        *("M3 S500", "G0 Z5", "F625", "G0 X1 Y1", "G0 Z2", "G33.1 Z-5 K1.25", "G0 Z5"),
        *("G0 X2", "G0 Z2", "G33.1 Z-5 K1.25", "G0 Z5", "G80", "G0 X0"),
    ]
    assert expanded(tmp_path, "M4 S500\nG0 Z5\nG91 G95 G99 G74 X1 Z-5 R-2 F2 L2\nG90 G0 X0") == [
        *("M4 S500", "G0 Z5", "G91 G95 G99 F2", "G91 G0 X1", "G90 G0 Z3", "G33.1 Z-2 K2", "G0 Z3"),
        *("G91 G0 X1", "G90 G0 Z3", "G33.1 Z-2 K2", "G0 Z3", "G91", "G90 G0 X0"),
    ]
    assert expanded(tmp_path, "M3 S1 F1\nG84 Y1 Z-5 R2 F9")[3] == "G0 Y1"  # first up


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("M4\nG84 Z-5 R2 F1", "2: G84 needs M3"), ("G84 Z-5 F1", "1: G84 lacks Z or R"),
        ("S0\nG84 Z-5 R2 F9", "2: G84 needs F and S"), ("G84 Z-5 R2 F9 P1", "1: G84 takes neither P"),
        ("G84 Z5 R2 F9", "1: G84: Z must not be above R"), ("G84 G0 Z-1 R1 F9", "1: G84 and G0 are both"),
        ("G76 Z-9", "1: G76 lacks P"), ("G76 P1 Z-9 I-1 J.5 K.2", "1: G76: K must be greater"),
        ("G76 P1 Z-9 I-1 J.1 K.2 E1", "1: G76: E and L"),
        ("G76 P1 Z-9 I-1 J.0001 K9 R3", "1: G76 makes more"),
        ("M5\nG76 P1 Z-9 I-1 J.1 K.2", "2: error:42:"), ("G33 Z-5", "1: error:28:"),
    ],
)  # fmt: skip
def test_refusals(tmp_path: Path, line: str, reason: str) -> None:
    """With what to do."""
    number, text = reason.split(":", 1)
    assert refusal(tmp_path, f"M3 S9\n{line}").startswith(f"{int(number) + 1}:{text}")


def test_the_example_is_planned(tmp_path: Path) -> None:
    """In a preview, threads are lines at the feed of the spindle's speed."""
    folder = paths.examples / "gcode"
    asked = ["preview", str(folder / "lathe.ngc"), "--machine", str(folder / "lathe.toml")]
    assert main([*asked, "--out", str(tmp_path)]) == 0
    summary = json.loads((tmp_path / "preview.json").read_text())
    assert summary["ok"] and summary["extent"]["Z"] == [-14, 20]
