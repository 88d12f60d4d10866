# SPDX-License-Identifier: MIT
"""The table of words of docs/gcode.md is what the interpreter knows: words, groups, and what they do."""

import re
from itertools import combinations

import pytest
from passo.gcode import Gcode, GcodeError, GcodeSettings
from passo.toolchain import paths

from tests.test_gcode import run, state

PAGE = (paths.docs / "gcode.md").read_text()
TABLE = PAGE[PAGE.index("| words | group | norm |") : PAGE.index("Which [image]")]
ROW = re.compile(r"^\| ((?:`[A-Z0-9.]+` ?)+) \| ([^|]+) \| ([^|]+) \| [^|]+ \|$", re.M)
ROWS = [(re.findall("`([^`]+)`", row[1]), row[2], row[3]) for row in ROW.finditer(TABLE)]
GROUP = {word: group.split(",")[0] for words, group, _ in ROWS for word in words}
COMMANDS = [word for word in GROUP if len(word) > 1]
NORMS = {"NIST", "grbl", "LinuxCNC"}
# Lines in which a word is complete, and lines before them, after which it changes something.
LINES = {
    "G2": "G2 X10 I5 F100", "G3": "G3 X10 I5 F100", "G1": "G1 X1 F100", "G0": "G0 X1", "G80": "G80",
    **{f"G38.{n}": f"G38.{n} X9 F10" for n in (2, 3, 4, 5)},
    **{f"G{n}": f"G{n} X9 Z-1 R1 F10" for n in (81, 85)},
    **{f"G{n}": f"G{n} X9 Z-1 R1 Q1 F10" for n in (73, 83)},
    **{f"G{n}": f"G{n} X9 Z-1 R1 P1 F10" for n in (82, 86, 89)},
    "G4": "G4 P1", "G10": "G10 L2 P1 X5", "G53": "G53 G0 X7", "G92": "G92 X3", "G43.1": "G43.1 Z1",
    "G43": "G43 H5", "G43.2": "G43.2 H5", "H": "G43 H5", "M6": "T5 M6", "M61": "M61 Q5",
    "M62": "M62 P1", "M63": "M63 P1", "M64": "M64 P1", "M65": "M65 P1",
    "M66": "M66 P1", "M67": "M67 E0 Q50", "M68": "M68 E0 Q50", "E": "M67 E0 Q50",
    "X": "X1", "Y": "Y1", "Z": "Z1", "A": "A1", "B": "B1", "C": "C1", "F": "F100", "S": "S10", "T": "T5",
    "N": "N7",
    "I": "G2 X10 I5 F100", "J": "G2 X10 Y0 I5 J0 F100", "K": "G18 G2 X10 Z0 I5 K0 F100",
    "R": "G2 X10 R9 F100", "G33": "G33 Z1 K1", "G33.1": "G33.1 Z1 K1", "G96": "G96 S5", "D": "G96 S5 D9",
    "L": "G10 L20 P1 X5", "P": "G4 P2", "Q": "G64 P1 Q0.5",
}  # fmt: skip
BEFORE = {
    "G17": ["G18"], "G90": ["G91"], "G21": ["G20"], "G94": ["G93"], "G54": ["G55"], "G64": ["G61"],
    "G49": ["G43.1 Z3"], "M5": ["M3"], "M9": ["M8"], "G92.1": ["G92 X9"], "G2": ["F100"], "G28": ["G0 X4"],
    "G43": ["G10 L1 P5 Z3"], "G43.2": ["G10 L1 P5 Z3"], "H": ["G10 L1 P5 Z3"],
    "G98": ["G99"], "G30": ["G0 X4"], "G28.1": ["G0 X4"], "G30.1": ["G0 X4"],
    "G33": ["M3 S9"], "G33.1": ["M3 S9"],
    "G8": ["G7"], "G97": ["G96 S5"], "M63": ["M62 P1"], "M65": ["M64 P1"],
}  # fmt: skip
IDLE = {"G40", "G91.1", "M1"}  # of which there is nothing else, and which do nothing


def refused(line: str) -> int:
    """The number of the error; 0: none."""
    try:
        run(Gcode(GcodeSettings(axes=6, turn_counts=1000)), line)
    except GcodeError as error:
        return error.number
    return 0


def test_the_table_has_all_words() -> None:
    """Each once, with a norm; of all numbers of G and M with up to one decimal, and of all letters."""
    words = [word for listed, *_ in ROWS for word in listed]
    assert len(words) == len(set(words))
    numbers = [f"{tenths // 10}.{tenths % 10}".removesuffix(".0") for tenths in range(1000)]
    known = {f"{letter}{n}" for letter in "GM" for n in numbers if known_command(f"{letter}{n}")}
    assert known == set(COMMANDS)
    letters = {chr(c) for c in range(ord("A"), ord("Z") + 1) if refused(f"{chr(c)}1") != 20} | {"Q"}
    assert letters - {"G", "M"} == {word for word in words if len(word) == 1}
    assert all(set(norm.split(", ")) <= NORMS for *_, norm in ROWS)


def test_refused_words_have_their_errors() -> None:
    """Of each row of the page of differences, the first word."""
    page = (paths.docs / "reference" / "gcode_differences.md").read_text()
    rows = re.findall(r"^\| (\d+) \| `([A-Z][0-9.]*)`.* \| [^|]+ \| [^|]+ \|$", page, re.M)
    assert len(rows) > 20
    gcode = GcodeSettings(axes=6)
    for number, word in rows:
        line = {"G92": "G92.2"}.get(word, word if len(word) > 1 else f"{word}1")
        with pytest.raises(GcodeError) as caught:
            Gcode(gcode).execute(line)
        assert caught.value.number == int(number), word


def known_command(word: str) -> bool:
    """Whether there is such a command, though its line may lack something."""
    return refused(word) not in (20, 23)


def test_the_groups_are_those_of_the_table() -> None:
    """Two words of a group are refused, of two groups they may be together; so may G80 and another motion."""
    for a, b in combinations(COMMANDS, 2):
        number = refused(f"{a} {b}")
        if GROUP[a] == GROUP[b] and a[0] == b[0] and "G80" not in (a, b):
            assert number in (21, 24), (a, b)
        else:
            assert number != 21, (a, b)


@pytest.mark.parametrize("word", GROUP)
def test_a_word_does_something(word: str) -> None:
    """It acts, or changes a mode or a value; the same line without it is refused or does something else."""
    line = LINES.get(word, word)
    gcode = Gcode(GcodeSettings(axes=6, turn_counts=1000))
    for before in BEFORE.get(word, []):
        run(gcode, before)
    at_first = state(gcode)
    actions = run(gcode, line)
    assert (actions != [] or state(gcode) != at_first) != (word in IDLE)


def test_errors_are_those_of_the_table() -> None:
    """Each number of the table has a sentence of its own, and is the answer to some line of test_gcode.py.

    Others are those of the controller, such as homing off, a jog outside the travel, no probe.
    """
    from tests.test_gcode import ERRORS

    rows = {int(n) for n in re.findall(r"^\| (\d+) \| [^|]+ \|$", PAGE[PAGE.index("## Errors") :], re.M)}
    assert rows - {3, *range(5, 17), 47} == set(ERRORS)
