# SPDX-License-Identifier: MIT
"""Diameters, threads and taps as plain lines."""

import json
import math
import random
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from passo import random_cases
from passo.cli import main
from passo.toolchain import paths

from benchmarks.gcode_expand import compare_expanded, play_expanded
from benchmarks.gcode_motion import verdict
from benchmarks.gcode_rs274 import play_rs274
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


TAPERED = {  # and lines that are in step
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 E2 L1": 6,
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 E2 L2": 6,
    "G76 P1.5 Z-20 I1 J0.3 K0.9 R1.5 Q29.5 H2 E1.25 L3": 24,
    "G91 G76 P1.5 Z-20 I-1 J0.3 K0.9 X3 E12.5 L2\nG0 X1": 6,
    "G20 G0 X1 Z1\nG76 P.05 Z-.5 I-.1 J.01 K.04 R2 Q30 E.1 L3\nG0 Z1": 48,
    "G76 P1 Z9 I-1 J0.3 K0.4 Q20 E1 L3": 6,
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 E2": 3,
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 E2 L0": 3,
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 L3": 3,
    "G76 P1.5 Z-20 I-1 J0.3 K0.9 E-2 L3": 3,
}


@pytest.mark.parametrize("text", TAPERED)
def test_tapered_ends(text: str) -> None:
    """All passes are those of rs274, but that the way in, at right angles to the thread, is a rapid."""
    program = [*HEAD, *text.split("\n")]
    ours, theirs = play_expanded(program), play_rs274(program)
    for k, (before, motion) in enumerate(pairwise(theirs.motions), 1):
        if motion.feed and motion.end[2] == before.end[2]:
            theirs.motions[k] = replace(motion, feed=0)
    assert verdict(ours, theirs) == ""
    assert sum(motion.feed > 0 for motion in ours.motions) == TAPERED[text]


@pytest.mark.parametrize("seed", range(12))
def test_each_turn_of_a_thread_is_a_pitch_along_it(seed: int, tmp_path: Path) -> None:
    """In its tapers too; these have its height, and all passes begin at the same angle of the thread."""
    rng = random.Random(f"{random_cases.seed()} {seed}")
    pitch, height, taper = (round(rng.uniform(0.5, 3), 3) for _ in range(3))
    end, ends, inner = rng.choice((-30, 30)), rng.randrange(4), rng.choice((-1, 1))
    asked = f"P{pitch} Z{end} I{inner} J{height / 4} K{height} E{taper} L{ends}"
    lines = expanded(tmp_path, f"M3 S9\nG0 X20 Z0\nG76 {asked}\n")
    at, passes, g33 = {"X": 20.0, "Z": 0.0}, [[]], False
    for line in lines[2:]:
        words = {letter: float(value) for letter, value in re.findall(r"([GXZK])(-?[0-9.]+)", line)}
        g33 = words.get("G", 33 if g33 else 0) == 33
        to = {letter: words.get(letter, at[letter]) for letter in at}
        if g33:
            along, across = to["Z"] - at["Z"], to["X"] - at["X"]
            assert abs(along) / (math.hypot(along, across) / words["K"]) == pytest.approx(pitch, rel=1e-5)
            passes[-1].append((along, across))
        elif passes[-1]:
            passes.append([])
        at = to
    sense, out = math.copysign(1, end), math.copysign(1, inner)
    begins, stops = [(sense * taper, out * height)], [(sense * taper, -out * height)]
    rest = end - sense * taper * ends.bit_count()
    wanted = begins * (ends & 1) + [(rest, 0.0)] + stops * (ends >> 1)
    assert len(passes) == 5 and passes.pop() == []
    for made in passes:
        assert made == [pytest.approx(one, abs=3e-6) for one in wanted]


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
        ("G76 P1 Z-9 I-1 J.1 K.2 E8 L3", "1: G76: E: the tapered ends are longer"),
        ("G76 P1 Z-9 I-1 J.1 K.2 E1 L4", "1: G76: L must be 0 to 3"),
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
