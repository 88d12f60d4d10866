# SPDX-License-Identifier: MIT
"""What is said of a line that is refused: the word, the norm that this is from, and what to do."""

import re
from pathlib import Path

import pytest
from passo.expand.block import words_of
from passo.expand.place import BOTH, FANUC, ITSELF, LINUXCNC, NIST, LineError
from passo.expand.refusals import ADVICE, LETTERS, NORMS, OTHERWISE, SAID, explain_text
from passo.failure import BadInputError
from passo.gcode import Gcode, GcodeError, GcodeSettings
from passo.machine_file import read_machine
from passo.part import read_part
from passo.toolchain import paths
from passo.web import EXAMPLE

from tests.test_expand import REFUSED, UNKNOWN
from tests.test_expand_compensation import REFUSED as CONTOURS
from tests.test_gcode import ERRORS
from tests.test_gcode_words import ROWS

NAMES = ("NIST", "LinuxCNC", "grbl", "FIDIA", "Fanuc", "RepRap")
NORM = f"(?:{'|'.join(NAMES)})(?:, (?:{'|'.join(NAMES)}))*"
# Behind the error and its text: the word, its norm, what to do.
SENTENCE = re.compile(rf"(\S+|the line) (?:\((?:{NORM}|{OTHERWISE[0]})\): .+|\({NORM}: .+\))", re.S)
LINES = [(number, line) for number, lines in ERRORS.items() for line in lines]
SETTINGS = GcodeSettings(spindle_maximum=10_000)


def said(number: int, line: str) -> str:
    return explain_text(GcodeError(number), line, SETTINGS)


@pytest.mark.parametrize(("number", "line"), LINES)
def test_each_error_names_word_norm_and_what_to_do(number: int, line: str) -> None:
    text = said(number, line)
    found = SENTENCE.fullmatch(text.removeprefix(f"{GcodeError(number)}: "))
    assert found, text
    if found[1] != "the line" and number > 2:
        assert found[1] in map(str, words_of(line)), found[1]


def test_all_errors_of_the_interpreter_have_advice() -> None:
    """The line is named only where no word can be."""
    assert set(ERRORS) <= set(SAID)
    unnamed = [line for number, line in LINES if ": the line (" in said(number, line)]
    assert unnamed == ["%G0", "G0 X1 %", "G0\N{NO-BREAK SPACE}X1"]


def test_all_words_that_are_not_taken() -> None:
    """Of each row of the table the first and the last one."""
    for letter, codes, _, norm, advice in ADVICE:
        for code in (codes.start, codes.stop - (1 if letter == "G" else 10)):
            word, found = f"{letter}{code / 10:g}", ""
            try:
                Gcode(SETTINGS).execute(word)
            except GcodeError as error:
                found = explain_text(error, word, SETTINGS)
            if "(" in found and f"{norm}: " in found:
                assert found.endswith(f": {word} ({norm}): {advice}")
        assert norm in NAMES or set(norm.split(", ")) <= set(NAMES)
    assert all(re.fullmatch(f"{NORM}: .+", told) for told in LETTERS.values())


@pytest.mark.parametrize(
    ("number", "line", "wanted"),
    [
        (20, "M66 P1 L5 Q1", "L5 (grbl): write another value"),
        (20, "G10 L2 P1 R1 X1", "R1 (grbl): write another value"),
        (22, "N7 X1", "X1 (NIST): write F with the first motion, such as G1 X1 F600"),
        (28, "N7 M67 E0", "M67 (LinuxCNC): add E and Q"),
        (36, "G4 P1 Q1", "Q1 (grbl): leave it out"),
        (
            39,
            "M62 P9",
            "M62 (LinuxCNC): there are the outputs P0 to P3, the inputs P0 to P6, the analog output E0",
        ),
        (42, "G1 G95 X1 F1", "G95 (grbl, LinuxCNC): write M3 or M4"),
    ],
)
def test_the_word_is_that_of_the_error(number: int, line: str, wanted: str) -> None:
    assert wanted in said(number, line)


def test_norms_are_those_of_the_table() -> None:
    """docs/gcode.md has all words with their norms."""
    table = {word: norm for words, _, norm in ROWS for word in words}
    assert {word: norm for word, norm in table.items() if norm != "NIST"} == NORMS


EXPANDED = {**REFUSED, **UNKNOWN, **CONTOURS}


@pytest.mark.parametrize("text", EXPANDED)
def test_what_cannot_be_expanded_names_its_norm(text: str) -> None:
    """Of a word with the word, of a line or an O word at its end."""
    assert re.search(rf"\({NORM}(?:\)|: )", EXPANDED[text]), EXPANDED[text]


def test_every_error_of_the_expander_has_a_norm() -> None:
    """No sentence is raised without one, in all of its sources."""
    for path in sorted((paths.sim / "passo" / "expand").glob("*.py")):
        for bare in re.findall(r'ExpandError\(\s*[^,()]+,\s*f?"[^)]*', path.read_text(encoding="utf-8")):
            assert re.search(r"\{(?:told|error\.reason)\}", bare), f"{path.name}: {bare}"
    assert [str(LineError("a", norm)) for norm in (LINUXCNC, ITSELF)] == ["a (LinuxCNC)", "a (Passo)"]
    assert {NIST, LINUXCNC, FANUC, *BOTH.split(", ")} <= set(NAMES)


def test_a_probe_that_there_is_not(tmp_path: Path) -> None:
    path = tmp_path / "a.nc"
    path.write_text("G38.3 Z-1 F100\n")
    with pytest.raises(
        BadInputError, match=r":1: no probe is fitted: G38\.3 \(grbl, LinuxCNC\): --surface MAP"
    ):
        read_part(path, read_machine(EXAMPLE / "machine.toml"))
