# SPDX-License-Identifier: MIT
"""`passo expand`: parameters, expressions and O words as LinuxCNC has them, judged by its own interpreter."""

import random
import re
from dataclasses import replace
from pathlib import Path

import pytest
from passo import random_cases
from passo.cli import main
from passo.expand.block import shown
from passo.expand.expander import Options, expand_file, needs_expanding
from passo.expand.place import ExpandError
from passo.expand.tools import Tool
from passo.failure import BadInputError
from passo.gcode import Gcode, GcodeError, GcodeSettings, lines
from passo.machine_file import read_machine
from passo.part import read_part
from passo.toolchain import paths

from benchmarks.gcode_corpus import corpus
from benchmarks.gcode_expand import compare_expanded, play_expanded
from benchmarks.gcode_language import language_program
from tests.test_gcode_words import GROUP

PROGRAMS = 60
MACHINE = paths.examples / "gcode" / "machine.toml"
CORPUS = dict(corpus())
AT_ZERO = Options(at_zero=True, limit=2000)


def expanded(folder: Path, text: str, options: Options = AT_ZERO) -> list[str]:
    """The plain lines of a text."""
    path = folder / "part.ngc"
    path.write_text(text)
    return [line.text for line in expand_file(path, options)]


def refusal(folder: Path, text: str, options: Options = AT_ZERO) -> str:
    """Line and reason."""
    with pytest.raises(ExpandError) as caught:
        expanded(folder, text, options)
    assert str(caught.value) == f"{folder / 'part.ngc'}:{caught.value.place.line}: {caught.value.reason}"
    return f"{caught.value.place.line}: {caught.value.reason}"


@pytest.mark.parametrize("name", CORPUS)
def test_corpus(name: str) -> None:
    """Every word in each plane, unit and distance mode moves as in rs274."""
    program = CORPUS[name]
    assert compare_expanded(program) == ""
    played = play_expanded(program)
    assert not played.refused and len(played.motions) > 5


def test_the_corpus_has_all_words() -> None:
    """At least 40 programs; those of each plane, units and distance mode have every word of docs/gcode.md."""
    found: dict[str, set[str]] = {}
    for name, program in CORPUS.items():
        text = " ".join(program).upper()
        commands = {f"{letter}{float(number):g}" for letter, number in re.findall(r"([GM])([0-9.]+)", text)}
        letters = set(re.findall(r"[A-Z](?=[-+.#\[0-9])", text))
        found.setdefault(name.split(" ", 1)[1], set()).update(commands | letters)
    modes = {mode for combination in found for mode in combination.split()}
    assert len(CORPUS) >= 40 and len(found) == 12
    for combination, words in found.items():
        assert not GROUP.keys() - modes - set("IJK") - words, combination  # a plane has two of I J K


@pytest.mark.sample(1)
def test_random_programs() -> None:
    """The same motions as rs274, and the same line refused."""
    motions = refused = 0
    for number in range(PROGRAMS):
        program = language_program(random.Random(f"{random_cases.seed()} {number}"))
        found = compare_expanded(program)
        assert not found, "\n".join([f"seed {random_cases.seed()} {number}: {found}", *program])
        played = play_expanded(program)
        motions += len(played.motions)
        refused += played.refused > 0
    assert motions > 3 * PROGRAMS and refused < PROGRAMS / 2


def test_the_result_of_m66(tmp_path: Path) -> None:
    """Of inputs that never change: those given, or low ones; of a machine that is not known, none."""
    lines = {"M66 P2": 1, "M66 P2 L3 Q1": 1, "M66 P2 L4 Q1": -1, "M66 P2 L1 Q1": -1, "M66 P2 L2 Q1": -1}
    low = {"M66 P1 L0": 0, "M66 P1 L3 Q1": -1, "M66 P1 L4 Q1": 0, "M66 P1 L1 Q1": -1}
    options = Options(GcodeSettings(axes=3, levels=1 << 2))
    for line, value in {**lines, **low}.items():
        assert expanded(tmp_path, f"{line}\nG0 X#5399", options) == [line, f"G0 X{value}"]
    assert expanded(tmp_path, "M66 P2\nG0 X#5399") == ["M66 P2", "G0 X0"]
    said = refusal(tmp_path, "M66 P2\nG0 X#5399", Options())
    assert (
        said
        == "2: word X: #5399 cannot be known while expanding: it is the result of M66 (--inputs) (LinuxCNC)"
    )
    command = ["expand", str(tmp_path / "part.ngc"), "--out", str(tmp_path / "plain.nc"), "--inputs"]
    assert main([*command, "0,2"]) == 0 and (tmp_path / "plain.nc").read_text().endswith("G0 X1\n")
    for wrong in ("9", "x", "-1"):
        with pytest.raises(SystemExit):
            main([*command[:-1], f"--inputs={wrong}"])


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("[2 ** 3 ** 2]", 64), ("[-2 ** 2]", 4), ("[1 + 2 * 3]", 7), ("[[1 + 2] * 3]", 9), ("[7 - 2 - 1]", 4),
        ("[5 mod -3]", 2), ("[-5 mod 3]", 1), ("[1 or 0 and 0]", 0), ("[2 + 3 * 4 gt 13]", 1),
        ("[1 eq 1.00005]", 1), ("[1 ne 1.0009]", 1), ("round[-2.5]", -3), ("fix[-2.5]", -3),
        ("fup[-2.5]", -2), ("atan[1]/[-1]", 135),
        ("sin[30]", 0.5), ("acos[.5]", 60), ("ln[exp[2]]", 2), ("-[1]", -1), ("--1", 1), ("+-.5", -0.5),
        ("[1/3]", 0.333333), ("[2/3*1000000]", 666666.666667), ("#[1+1]", 0), ("exists[#<none>]", 0),
    ],
)  # fmt: skip
def test_value(tmp_path: Path, text: str, value: float) -> None:
    """By hand; to a millionth."""
    assert expanded(tmp_path, f"G0 X{text}") == [f"G0 X{shown(value)}"]


def test_plain_lines_stay(tmp_path: Path) -> None:
    """With their comments; what says nothing goes."""
    text = "%\nG0 x1 (to the left) ; a\n\n(a comment)\n#1=2\ng1 X [#1] F100 (b)\nM2\nX9\n"
    wanted = ["G0 x1 (to the left) ; a", "(a comment)", "G1 X2 F100 (b)", "M2"]
    assert expanded(tmp_path, text) == wanted


def test_comments_show_values(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Those of DEBUG and PRINT; PRINT also on standard error."""
    text = "#1=2\n#<a b>=.5\n(debug, #1 #<A B> #<c>)\n(msg, #1)\n(print,%d#1 %.2f#<ab>)\n"
    assert expanded(tmp_path, text) == ["(debug, 2.000000 0.500000 ######)", "(msg, #1)", "(print,2 0.50)"]
    assert main(["expand", str(tmp_path / "part.ngc")]) == 0
    assert capsys.readouterr().err == "2 0.50\n"


def test_subroutine_files(tmp_path: Path) -> None:
    """They are beside the program; an error names them."""
    (tmp_path / "slot.ngc").write_text("G0 X99\no<slot> sub\nG0 X#1\no<deep> call [#1+1]\no<slot> endsub\n")
    (tmp_path / "deep.ngc").write_text("o<deep> sub\nG0 Y#1\no<deep> endsub [5]\nM2\n")
    text = "o<slot> call [2]\nG0 Z#<_value>\nO<SLOT> call [3]\n"
    assert expanded(tmp_path, text) == ["G0 X2", "G0 Y3", "G0 Z0", "G0 X3", "G0 Y4"]
    (tmp_path / "deep.ngc").write_text("o<deep> sub\nG0 Y[1/#5]\no<deep> endsub\n")
    with pytest.raises(ExpandError, match=r"deep\.ngc:2: word Y: division by zero"):
        expanded(tmp_path, text)


def test_fanuc_subroutines(tmp_path: Path) -> None:
    """M98 P L and M99; the number of a program is nothing."""
    text = "O1000\n#1=1\nM98 P20 L2\nG0 Y#1\nM30\nO20\nG0 X#1\n#1=[#1+1]\nM99\n"
    assert expanded(tmp_path, text) == ["G0 X1", "G0 X2", "G0 Y3", "M30"]


# What is written for {}: the folder; WORD: the text of error 20.
REFUSED = {
    "G0 X1\no1 while [1]\no1 endwhile": "2: endless? 2,000 lines were executed in loops and "
    "subroutines (LinuxCNC)",
    "o1 sub\no1 call\no1 endsub\no1 call": "2: subroutines are nested deeper than 9, as is an "
    "endless recursion (LinuxCNC)",
    "o1 repeat [1e3]": "1: ']' is missing at the end of an expression, before 'e3]' (NIST)",
    "G0 X[1/0]": "1: word X: division by zero (NIST)",
    "G0 Xsqrt[-1]": "1: word X: SQRT[-1] has no value (NIST)",
    "G0 X[1": "1: word X: ']' is missing at the end of an expression, before '' (NIST)",
    "G0 X#<none>": "1: word X: #<none> was not set: write #<none>=... before (LinuxCNC)",
    "G0 X#5602": "1: word X: there is no parameter #5602: 1 to 5601 (LinuxCNC)",
    "G0 X#1.5": "1: word X: a parameter number must be an integer, not 1.5 (NIST)",
    "#<_metric>=1": "1: #<_metric> is read-only: use another name (LinuxCNC)",
    "#5420=1": "1: #5420 is read-only: write G92 or G10 L20 (LinuxCNC)",
    "#5221=1": "1: #5221 cannot be set: write G10 L2, G28.1, G30.1 or G92 (LinuxCNC)",
    "o1 endwhile": "1: O1 endwhile has no while (LinuxCNC)",
    "o1 if [1]\nG0 X1": "1: O1 if has no endif (LinuxCNC)",
    "o1 while [0]\no2 endwhile": "2: O2 endwhile has no while: O1 while is open (LinuxCNC)",
    "o1 if [0]\no1 endif\no1 if [0]\no1 endif": "3: O1 if: another construct has this label: write "
    "another one (LinuxCNC)",
    "o1 break": "1: O1 break is in no loop of this label (LinuxCNC)",
    "o1 call": "1: there is no subroutine 1, neither in this file nor as {}/1.ngc (LinuxCNC)",
    "o1 begin": "1: O: 'begin' is none of elseif, else, endif, endwhile, endrepeat, endsub, sub, call, "
    "return, if, while, do, repeat, break, continue (LinuxCNC)",
    "M99": "1: M99 of the main program repeats it without end: write M2 or M30 (Fanuc)",
    "G0 X#5063": "1: word X: #5063 cannot be known while expanding: "
    "it is the result of a probe (passo run --surface) (LinuxCNC)",
    "G0 X#<_ini[a]b>": "1: word X: #<_ini[a]b> cannot be known while expanding: only the machine "
    "has it (LinuxCNC)",
    "G0 X#1\nG5.1 X1 I1": "2: WORD: G5.1 (LinuxCNC): a spline: let the CAM program write G1, G2 and G3",
    "G0 X#1\nM104 S200": "2: WORD: M104 (RepRap): this is for 3D printers: leave it out",
    "G0 E#1": f"1: {GcodeError(36)}: E0 (RepRap: for 3D printers)",
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_refusal(tmp_path: Path, text: str) -> None:
    """Names the line, the word and the reason."""
    wanted = REFUSED[text].format(tmp_path).replace("WORD", str(GcodeError(20)))
    assert refusal(tmp_path, text) == wanted


# Each line that is refused, in one run; nothing of what only follows from it.
ALL = {
    # the lines behind are executed, but for what they have from a line that is refused
    "G0 X[1/0]\n#1=[2\nG1 X#1 F100\nX5\nG0 Y#<none>\nG5.1 X1 I1\nG0 Z#5063\nM2\nG0 X[": [
        *(
            "1: word X: division by zero (NIST)",
            "2: ']' is missing at the end of an expression, before '' (NIST)",
        ),
        "5: word Y: #<none> was not set: write #<none>=... before (LinuxCNC)",
        "6: WORD: G5.1 (LinuxCNC): a spline: let the CAM program write G1, G2 and G3",
        "7: word Z: #5063 cannot be known while expanding: it is the result of a probe (passo run --surface) "
        "(LinuxCNC)",
    ],
    "G0 X#<a> #<b>=1\n#<a>=1\nG0 X#<a> Y#<b>\nG0 Z#<c>": [
        "1: word X: #<a> was not set: write #<a>=... before (LinuxCNC)",
        "4: word Z: #<c> was not set: write #<c>=... before (LinuxCNC)",
    ],
    # in loops once, in subroutines as well
    "o1 sub\nG0 X[1/0]\no1 endsub\no2 repeat [9]\no1 call\n#3=[#3+1]\no2 endrepeat\no4 if [#3 eq 9]\nG0 Y-\n"
    "o4 endif": [
        "2: word X: division by zero (NIST)",
        "9: word Y: a value is missing: write a number, #, [ or a function (NIST)",
    ],
    # a condition that is not known ends it: then the words are read
    "G0 X[1/0]\n#1=[2/0]\no1 while [#1 lt 3]\n#1=[#1+1]\no1 endwhile\nG0 X]\nG0 Y#<none>\nM2\nG0 X[": [
        *("1: word X: division by zero (NIST)", "2: division by zero (NIST)"),
        "3: this depends on a line that is refused (LinuxCNC); of the lines behind it only the words "
        "are checked",
        "6: word X: a value is missing before ']': write a number, #, [ or a function (NIST)",
    ],
    "o1 if [1/0]\no1 endif\nG0 X": [
        "1: division by zero (NIST); of the lines behind it only the words are checked",
        "3: word X: a value is missing: write a number, #, [ or a function (NIST)",
    ],
    # O words
    "o1 whle [1]\nG0 X[\no2 if [3\nG0 X1\no2 endif\no3 endsub\no4 sub\no5 break\nM2": [
        "1: O: 'whle[1]' is none of elseif, else, endif, endwhile, endrepeat, endsub, sub, call, return, if, "
        "while, do, repeat, break, continue (LinuxCNC)",
        "3: ']' is missing at the end of an expression, before '' (NIST)",
        *("6: O3 endsub has no sub (LinuxCNC)", "8: O5 break is in no loop of this label (LinuxCNC)"),
        "7: O4 sub has no endsub (LinuxCNC)",
        "2: word X: a value is missing: write a number, #, [ or a function (NIST)",
    ],
    "o<a> call\nG0 X#<_value> Y#<b>\nG0 Z[1/0]\nM98 P7\nG0 Z[1/0]": [
        "1: there is no subroutine a, neither in this file nor as {}/a.ngc (LinuxCNC)",
        *("3: word Z: division by zero (NIST)", "4: there is no subroutine O7 in this file (Fanuc)"),
        "5: word Z: division by zero (NIST)",
    ],
    # contours
    "G0 X0 Y0\nG41.1 D4\nX9\nY1\nX0\nG40\nX50 Y50\nG42.1 D4\nX59\nY51 Z[1/0]\nY49\nX50\nG40 X0": [
        "4: the tool's radius of 2 mm would cut the contour: this line is too short for the inside corners "
        "at its ends (NIST)",
        "10: word Z: division by zero (NIST)",
    ],
}


@pytest.mark.parametrize("text", ALL)
def test_all_lines_that_are_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(ExpandError) as caught:
        expanded(tmp_path, text)
    path = f"{tmp_path / 'part.ngc'}:"
    wanted = [line.format(tmp_path).replace("WORD", str(GcodeError(20))) for line in ALL[text]]
    assert [line.removeprefix(path) for line in str(caught.value).splitlines()] == wanted


def test_many_lines_that_are_refused(tmp_path: Path) -> None:
    """The first ones, and how many more."""
    with pytest.raises(ExpandError) as caught:
        expanded(tmp_path, "G0 X[1/0]\n" * 30)
    *told, more = str(caught.value).splitlines()
    assert (
        len(told) == 20
        and told[-1].startswith(f"{tmp_path / 'part.ngc'}:20:")
        and more == "and 10 more lines"
    )


def test_a_loop_without_end_behind_a_line_that_is_refused(tmp_path: Path) -> None:
    """It is left soon, and nothing is said of it: that line may be what would end it."""
    with pytest.raises(ExpandError) as caught:
        expanded(tmp_path, "G0 X[1/0]\no1 while [1]\no1 endwhile\nG0 Y]", Options(at_zero=True))
    lines = [line.partition("part.ngc:")[2] for line in str(caught.value).splitlines()]
    assert [line.split(":")[0] for line in lines] == ["1", "4"]


def test_files_that_are_refused(tmp_path: Path) -> None:
    """Of several all, with the lines that the interpreter refuses."""
    one, two = tmp_path / "one.ngc", tmp_path / "two.nc"
    one.write_text("#1=2\nG1 X[1/0] F600\nG38.2 Z-1 F9\nG0 Y#1\nM2\n")
    two.write_text("G21 G90\nG0 X1\nM104\n")
    with pytest.raises(BadInputError) as caught:
        read_part([one, two], read_machine(MACHINE))
    told = [line.removeprefix(f"{tmp_path}/").split(": ")[0] for line in str(caught.value).splitlines()]
    assert told == ["one.ngc:2", "one.ngc:3", "two.nc:3"]


UNKNOWN = {
    "G0 Y#5420": "1: word Y: #5420 cannot be known: no absolute motion of X is before (LinuxCNC)",
    "G91 G0 X1\nG90 G0 Y#<_x>": "2: word Y: #<_x> cannot be known: no absolute motion of X is "
    "before (LinuxCNC)",
    "G0 X1\nG55\nG0 Y#5420": "3: word Y: #5420 cannot be known: no absolute motion of X is before (LinuxCNC)",
    "G0 X1\nG28 X2\nG0 Y#5420": "3: word Y: #5420 cannot be known: no absolute motion of X is "
    "before (LinuxCNC)",
    "G0 X1\nG53 G0 X0\nG0 Y#5420": "3: word Y: #5420 cannot be known: no absolute motion of X is "
    "before (LinuxCNC)",
    "G0 Y#5221": "1: word Y: #5221 cannot be known: no G10 L2 before has set this offset (LinuxCNC)",
    "G0 Y#5211": "1: word Y: #5211 cannot be known: no G92.1 is before, or no G92 at a known "
    "position (LinuxCNC)",
    "G0 Y#5161": "1: word Y: #5161 cannot be known while expanding: it is in machine coordinates (LinuxCNC)",
    "G0 Y#5400": "1: word Y: #5400 cannot be known: no M6 or M61 is before (LinuxCNC)",
    "G0 Y#5403": "1: word Y: #5403 cannot be known: no G43.1 or G49 is before (LinuxCNC)",
    "G0 Y#<_feed_override>": "1: word Y: #<_feed_override> cannot be known while expanding: only the "
    "machine has it (LinuxCNC)",
}


@pytest.mark.parametrize("text", UNKNOWN)
def test_unknown(tmp_path: Path, text: str) -> None:
    """What only a machine knows is an error."""
    assert refusal(tmp_path, text, Options()) == UNKNOWN[text]


def test_known(tmp_path: Path) -> None:
    """From the line on that tells it."""
    text = "G20 G0 X1\nG91 X1\nG10 L2 P2 X25.4\nG90 Y#5420 Z#5241\nG92 X5\nY#<_x>\nG43.1 Z2\nZ#5403"
    assert expanded(tmp_path, text.replace("25.4", "1"), Options())[3::2] == ["G90 Y2 Z25.4", "Y5", "Z2"]


def test_tool_lengths(tmp_path: Path) -> None:
    """G43 and G43.2 become G43.1 if the length is known; a tool change in the line leaves them."""
    known = Options(tools={2: Tool(2, 0, 25.4), 3: Tool(3, 0, -1.25)})
    text = "G0 G43 H2 X20 (a)\nG43.2 H3\nG20 G43 H2 Z1\nG21 M6 T3\nG43\nG43 H4\nG43.2 H2\nT2 M6 G43\nZ#5403"
    assert expanded(tmp_path, text, replace(known, at_zero=True)) == [
        *("G43.1 Z25.4", "G0 X20 (a)", "G43.1 Z24.15", "G20 G43.1 Z1", "Z1"),
        *("G21 M6 T3", "G43.1 Z-1.25", "G43 H4", "G43.2 H2", "T2 M6 G43", "Z25.4"),
    ]
    assert expanded(tmp_path, "G43.2 H2", known) == ["G43.2 H2"]
    begun = "G0 X0 Y0\nG41.1 D1 G43 H2 G0 X9\nX20\nG40 X0"
    assert expanded(tmp_path, begun, known)[1] == "G43.1 Z25.4"


def test_needs_expanding() -> None:
    """Other files are run as they are."""
    for text in (b"#1=2", b"G1 X[1]", b"n5 o100 sub", b"O1000", b"g41 d1", b"G042.1 D3", b"M98 P1", b"X--1"):
        assert needs_expanding(b"G0 X1\n" + text)
    for text in (b"(#1 [2] o100 sub) ; G41", b"G4 P1", b"G411", b"G40", b"M9", b"G1 X-1Y+2"):
        assert not needs_expanding(text)


def test_run_expands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`passo run` takes such a file, and names its lines."""
    part = tmp_path / "part.ngc"
    part.write_text("#1=0\no1 while [#1 lt 3]\n#1=[#1+1]\nG1 X#1 F600\no1 endwhile\nM2\n")
    assert main(["run", str(part), "--machine", str(MACHINE), "--out", str(tmp_path)]) == 0
    assert "4 lines, 3 chords" in capsys.readouterr().out
    part.write_text("#1=0\n\nG1 X[1/#1] F600\n")
    assert main(["run", str(part), "--machine", str(MACHINE), "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err == f"{part}:3: word X: division by zero (NIST)\n"


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """To standard output or a file, with the numbers of the original on request."""
    part, out = tmp_path / "part.ngc", tmp_path / "plain.nc"
    part.write_text("#1=2\nG0 A[#1]\n")
    assert main(["expand", str(part), "--numbers"]) == 0
    assert capsys.readouterr().out == "G0 A2 ;part.ngc:2\n"
    assert main(["expand", str(part), "-o", str(out)]) == 0
    assert capsys.readouterr().out == f"part.ngc: 1 plain lines: {out}\n" and out.read_text() == "G0 A2\n"
    assert main(["expand", str(part), "--machine", str(MACHINE)]) == 2
    assert "A2 (NIST): the machine has the axes X Y Z" in capsys.readouterr().err
    assert main(["expand", str(tmp_path / "none.ngc")]) == 2


def test_nothing_breaks_it(tmp_path: Path) -> None:
    """Damaged programs end with an error of their own, or as lines that an interpreter takes."""
    rng, taken = random.Random(f"{random_cases.seed()} fuzz"), 0
    pieces = [
        "#",
        "[",
        "]",
        "<",
        ">",
        "o1",
        "sub",
        "call",
        "if",
        "while",
        "**",
        "/",
        "(",
        ";",
        "G41",
        "\r",
        "9" * 40,
        "\0",
    ]
    options = Options(GcodeSettings(axes=3), at_zero=True, limit=500)
    for number in range(400):
        text = "\n".join(language_program(random.Random(f"{random_cases.seed()} {number}"), 4))
        for _ in range(rng.randint(0, 3)):
            at = rng.randrange(len(text))
            text = text[:at] + rng.choice(pieces) + text[at + rng.randint(0, 3) :]
        try:
            plain = expanded(tmp_path, text, options)
        except ExpandError:
            continue
        gcode = Gcode(GcodeSettings(axes=3))
        for line in plain:
            assert lines(line.encode()) == [line.encode()]
            gcode.execute(line)
            list(gcode.actions())
        taken += 1
    assert taken > 40


AXES_OF_A_MACHINE = "".join(
    f'[[axis]]\nname = "{letter}"\nsteps_per_mm = 80\nspeed = 20\nacceleration = 100\n' for letter in "XYZ"
)


def test_a_program_begins_where_the_one_before_it_ends(tmp_path: Path) -> None:
    """Position, offsets, tool, G92 and diameters are those behind it, as `passo run a.nc b.ngc` plays."""
    path = tmp_path / "machine.toml"
    path.write_text("clock_hz = 8_000_000\n" + AXES_OF_A_MACHINE)
    machine = read_machine(path)

    def played(first: str, second: str) -> list[str]:
        files = [tmp_path / "a.nc", tmp_path / "b.ngc"]
        for file, text in zip(files, (first, second), strict=True):
            file.write_text(text)
        part = read_part(files, machine, {2: Tool(2, 0, 3.5)})
        return [
            line.decode().strip()
            for line, at in zip(part.lines, part.places, strict=True)
            if at.path == files[1]
        ]

    assert played("G0 X10 Y5\nM2\n", "G0 X[#5420+1] Z#5421") == ["G0 X11 Z5"]
    assert played("G10 L2 P1 X2\nG92 Y7\nT2 M6\nG43\n", "G0 X#5221 Y[#5210+#5400]") == ["G0 X2 Y3"]
    assert played("G0 X10 Y5\n", "F9 G41.1 D2 G1 X30\nG1 X40\nG40 G1 X50")[-1] == "G1 X50 Y5"
    assert played("G7 G0 X10\n", "G0 X[2*4]\nG8\nX[1+2]") == ["G8", "G0 X4", "X3"]
    assert played("G20 G91\n", "X[1/4]") == ["X0.25"]
