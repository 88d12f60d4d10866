# SPDX-License-Identifier: MIT
"""Several files on the page to try Passo, as `passo run` takes them; threads, in step with its spindle."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo import web_python
from passo.cli import main
from passo.engine import model_engine
from passo.expand.height_map import read_height_map
from passo.failure import BadInputError
from passo.machine_file import MachineFile, read_machine
from passo.part import Played, core_of, play_part, read_part
from passo.toolchain import paths
from passo.web import EXAMPLE

from benchmarks.rigid_tapping import AXIS
from tests.helpers.browser import Browser
from tests.helpers.firefox import Firefox
from tests.test_refusals import LINES
from tests.test_web import ANSWER, READY, VERDICT, saved, verdict_of

PYODIDE = pytest.mark.skipif(
    not web_python.is_installed() and shutil.which("npm") is None, reason="Pyodide needs npm"
)
PATIENCE = 300  # seconds


@pytest.fixture(scope="module", params=[Browser, Firefox])
def either(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A browser for all tests that both pass."""
    with request.param(tmp_path_factory.mktemp("either")) as made:
        yield made


@pytest.fixture
def browser(kept: Browser, page: str) -> Browser:
    """The page, as it opens."""
    kept.open("about:blank")
    kept.open(page, READY)
    return kept


def dropped(browser: Browser | Firefox, files: dict[str, str] | list[tuple[str, str]]) -> str:
    """Drop files on the page; the verdict."""
    done = browser.value("web.done")
    given = json.dumps(list(files.items()) if isinstance(files, dict) else files)
    browser.value(
        "(() => { const data = new DataTransfer();"
        f"for (const [name, text] of {given}) data.items.add(new File([text], name));"
        "dispatchEvent(new DragEvent('drop', {dataTransfer: data})); })()"
    )
    browser.wait(f"web.done > {done}", PATIENCE)
    return str(browser.value(VERDICT))


def written(folder: Path, files: dict[str, str]) -> list[Path]:
    """The same files for the command."""
    for name, text in files.items():
        (folder / name).write_text(text)
    return [folder / name for name in sorted(files)]


def refused(folder: Path, machine: MachineFile, files: dict[str, str]) -> str:
    """What the command says of them, run in their folder."""
    with pytest.raises(BadInputError) as error:
        read_part(written(folder, files), machine)
    return str(error.value).replace(f"{folder}/", "")


PLAIN = {
    "b.nc": "G1 X3 Y1\nG2 X1 Y1 I-1\nM30\nG1 X100",
    "a.nc": "G21 G91 F900\nG1 X2\nM2\nnonsense\n(a comment)\n",
    "c.nc": "G91 G1 F300 X-5 (behind M30 modes are those of the beginning)\n",
}


@pytest.mark.sample(1)
def test_files_play_in_turn(either: Browser | Firefox, page: str, tmp_path: Path) -> None:
    """In the order of their names; each up to its M2 or M30, from where the one before ends."""
    either.open("about:blank")
    either.open(page, READY)
    assert dropped(either, PLAIN) == "done"
    assert either.value(ANSWER) == "2 lines behind the end of the program are not read"
    command = ["run", *map(str, written(tmp_path, PLAIN)), "--machine", str(EXAMPLE / "machine.toml")]
    assert main([*command, "--out", str(tmp_path / "out")]) == 0
    assert saved(either, "csv") == (tmp_path / "out" / "pulses.csv").read_bytes()


def test_they_are_shown_edited_and_kept_in_a_link(browser: Browser, page: str) -> None:
    assert dropped(browser, PLAIN) == "done"
    shown = "Array.from(document.getElementById('files').options, own => own.textContent)"
    assert browser.value(shown) == ["a.nc", "b.nc", "c.nc"]
    assert browser.value("[document.getElementById('files').hidden, web.text]") == [False, PLAIN["a.nc"]]
    browser.value("(document.getElementById('lines').value = 'G21 G90 F900\\nG1 X4', web.choose(1))")
    assert browser.value("[web.text, web.edited[0].text]") == [PLAIN["b.nc"], "G21 G90 F900\nG1 X4"]
    link = browser.value("toFragment(web.state)")
    browser.open("about:blank")
    browser.open(page + link, READY)
    assert browser.value(VERDICT) == "done" and browser.value(shown) == ["a.nc", "b.nc", "c.nc"]
    ends = browser.value("passo.motion.axes.map(axis => axis.counted.at(-1) * axis.per_step)")
    assert ends == pytest.approx([1 - 5, 1], abs=0.01)
    verdict_of(browser, "G1 F600 X1")
    assert browser.value("[document.getElementById('files').hidden, web.edited.length]") == [True, 1]


def test_wrong_files_are_said_as_the_command_says_them(browser: Browser, tmp_path: Path) -> None:
    machine = read_machine(EXAMPLE / "machine.toml")
    for number, files in enumerate(
        (
            {"a.nc": "G0 X1\nM2\nM117", "b.nc": "G1 X1\nM117\nG38.2 Z-1 F1", "c.nc": "G0 X1\nM98.5"},
            {"a.nc": "G0 X1", "b.nc": "(nothing)\n%\n"},
            {"a.nc": "G0 X1\n" + "G1 X2\n" * 25, "b.nc": "G1 X1\n"},
        )
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        wanted = refused(folder, machine, files).replace(
            "--surface MAP.csv simulates", "a height map simulates"
        )
        dropped(browser, files)
        assert browser.value(ANSWER) == wanted
    assert wanted.splitlines()[-1] == "and 6 more lines"


def test_each_error_is_said_as_the_command_says_it(browser: Browser, tmp_path: Path) -> None:
    """Word, norm and advice, of all lines of which tests/test_refusals.py asks for them."""
    machine, count = read_machine(EXAMPLE / "machine.toml"), 0
    lines = [line for _, line in LINES if "%" not in line]
    for at in range(0, len(lines), 15):
        text = "\n".join(f"G17 G21 G54 G90 G94\n{line}" for line in lines[at : at + 15])
        folder = tmp_path / str(at)
        folder.mkdir()
        wanted = refused(folder, machine, {"a.nc": text, "b.nc": "G0 X1"})
        dropped(browser, {"a.nc": text, "b.nc": "G0 X1"})
        assert browser.value(ANSWER) == wanted
        count += wanted.count("error:")
    assert count > 100


def test_two_programs_of_one_name(browser: Browser, page: str, tmp_path: Path) -> None:
    """They play in the order in which they are given, also when shown again, and from a link."""
    files = [
        ("part.nc", "G21 G91 F900\nG1 X2\n"),
        ("a.nc", "G1 F900 Y1"),
        ("part.nc", "G91 G1 F900 X-1 Y1\nM2\n"),
    ]
    assert dropped(browser, files) == "done"
    names = ["a.nc", "part.nc", "part (2).nc"]
    shown = "web.edited.map(file => [file.name, file.text])"
    texts = [files[1][1], files[0][1], files[2][1]]
    assert browser.value(shown) == [list(pair) for pair in zip(names, texts, strict=True)]
    paths_ = []
    for folder, (name, text) in zip("abc", (files[1], files[0], files[2]), strict=True):
        (tmp_path / folder).mkdir()
        paths_.append(tmp_path / folder / name)
        paths_[-1].write_text(text)
    machine = str(EXAMPLE / "machine.toml")
    assert main(["run", *map(str, paths_), "--machine", machine, "--out", str(tmp_path / "out")]) == 0
    csv = (tmp_path / "out" / "pulses.csv").read_bytes()
    assert saved(browser, "csv") == csv
    browser.value("web.choose(2)")
    assert browser.value("web.text") == files[2][1]
    link = browser.value("toFragment(web.state)")
    browser.open("about:blank")
    browser.open(page + link, READY)
    assert browser.value(VERDICT) == "done" and saved(browser, "csv") == csv
    dropped(browser, [*files, ("part.nc", "G1 X1\nM117\n")])
    assert str(browser.value(ANSWER)).startswith("part (3).nc:2: error:20: ")


@PYODIDE
def test_subroutines_of_one_name(browser: Browser, tmp_path: Path) -> None:
    """The same one twice is one; of two a program cannot know which it calls."""
    twice = [*CALLS.items(), ("slot.ngc", CALLS["slot.ngc"])]
    assert dropped(browser, twice) == "done"
    assert browser.value("web.edited.map(file => file.name)") == sorted(CALLS)
    other = ("slot.ngc", CALLS["slot.ngc"].replace("Y#2", "Y3"))
    said = "error: two files slot.ngc have subroutines: open one of them"
    assert dropped(browser, [*CALLS.items(), other]) == said
    browser.value("web.choose(1)")
    assert browser.value("web.edited.filter(file => file.clashes).length") == 1
    main_of_this_name = [*CALLS.items(), ("slot.ngc", "G0 X1\n")]
    assert dropped(browser, main_of_this_name) == "done"
    assert browser.value("web.edited.map(file => [file.name, file.plays])")[-2:] == [
        ["slot.ngc", False],
        ["slot (2).ngc", True],
    ]


CALLS = {
    "part.ngc": "G21 G90 F900\no<slot> call [4] [1]\no100 call [2]\nM2\n",
    "slot.ngc": "(a slot)\no<slot> sub\nG1 X#1\nG91 G1 Y#2\nG90\no<slot> endsub\nM2\n",
    "100.ngc": "o100 sub\no<slot> call [0] [#1]\no100 endsub\n",
    "second.ngc": "G1 X[#5420+1] F600\no<slot> call [#5420*2] [-1]\nM30\n",
}


@PYODIDE
def test_subroutines_of_other_files(either: Browser | Firefox, page: str, tmp_path: Path) -> None:
    """Files of subroutines alone do not play; the second program begins where the first one ends."""
    either.open("about:blank")
    either.open(page, READY)
    assert dropped(either, CALLS) == "done"
    marked = either.value("web.edited.map(file => [file.name, file.plays])")
    playing = ["part.ngc", "second.ngc"]
    assert marked == [[name, name in playing] for name in sorted(CALLS)]
    written(tmp_path, CALLS)
    command = ["run", *(str(tmp_path / name) for name in playing), "--machine", str(EXAMPLE / "machine.toml")]
    assert main([*command, "--out", str(tmp_path / "out")]) == 0
    assert saved(either, "csv") == (tmp_path / "out" / "pulses.csv").read_bytes()
    assert either.value("passo.motion.axes.map(axis => axis.counted.at(-1) * axis.per_step)") == [2, 2]
    for number, line, wanted in ((1, 1, "G1 X4"), (2, 0, "G1 X1 F600")):
        either.value(f"web.choose({number})")
        assert saved(either, "plain").decode().split("\n")[line] == wanted
    either.value("web.choose(3)")
    either.value("document.getElementById('plain').click()")
    said = "slot.ngc has subroutines: show the program that calls them"
    either.wait(f"document.getElementById('told').textContent === {json.dumps(said)}")


@PYODIDE
def test_errors_of_subroutines_name_their_files(browser: Browser, tmp_path: Path) -> None:
    machine = read_machine(EXAMPLE / "machine.toml")
    for number, (name, old, new) in enumerate(
        (
            ("slot.ngc", "Y#2", "Y[1/0]"),  # while it is expanded
            ("slot.ngc", "Y#2", "Y#2 M117"),  # afterward
            ("part.ngc", "o100 call", "o101 call"),
            ("second.ngc", "[-1]", "[-1"),
        )
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        files = {**CALLS, name: CALLS[name].replace(old, new)}
        written(folder, files)
        with pytest.raises(BadInputError) as error:
            read_part([folder / "part.ngc", folder / "second.ngc"], machine)
        dropped(browser, files)
        assert browser.value(ANSWER) == str(error.value).replace(f"{folder}/", "")


MAP = "".join(f"{x},{y},{-1 - 0.01 * x - 0.02 * y}\n" for x in (-5, 20) for y in (-5, 30))
PROBES = {
    "a.nc": "G21 G90 G0 X4 Y2\nM2\n",
    "b.ngc": "G38.2 Z-5 F300\nG92 Z0\nG0 Z[2-#5063]\n",
    "map.csv": MAP,
}


@PYODIDE
def test_a_height_map(either: Browser | Firefox, page: str, tmp_path: Path) -> None:
    """Probes touch it, or Z follows it; a wrong one is said as the command says it."""
    either.open("about:blank")
    either.open(page, READY)
    assert dropped(either, PROBES) == "done"
    first, second, surface = written(tmp_path, PROBES)
    machine = EXAMPLE / "machine.toml"
    command = ["run", str(first), str(second), "--machine", str(machine), "--surface", str(surface)]
    assert main([*command, "--out", str(tmp_path / "out")]) == 0
    assert saved(either, "csv") == (tmp_path / "out" / "pulses.csv").read_bytes()
    either.value("document.getElementById('map-use').value = 'follows'")
    text = "G21 G90 G0 X0 Y0 Z1\nG1 Z0 F300\nG2 X10 Y20 R15\nG1 X1\n"
    assert verdict_of(either, text, seconds=PATIENCE) == "done"
    first.write_text(text)
    made = tmp_path / "followed.nc"
    assert main(["heightmap", str(first), "--map", str(surface), "--at-zero", "-o", str(made)]) == 0
    assert saved(either, "plain") == made.read_bytes() and made.read_text().count("\n") > 5
    link = either.value("toFragment(web.state)")
    either.open("about:blank")
    either.open(page + link, READY)
    either.wait("web.done", PATIENCE)
    assert either.value("[web.map.follows, web.map.text]") == [True, MAP]
    assert verdict_of(either, "G0 X0 Y0 Z0\nG1 X99 F9").startswith("error: line 2: this motion leaves the ")
    either.value("document.getElementById('map').value = '1,2,3'")
    surface.write_text("1,2,3")
    with pytest.raises(BadInputError) as error:
        read_height_map(surface)
    said = str(error.value).replace(str(surface), "height map")
    assert verdict_of(either, "G0 X0") == f"error: {said}"


def test_a_machine_and_tools_among_the_files(browser: Browser) -> None:
    """They are no programs."""
    lathe = (paths.examples / "gcode" / "lathe.toml").read_text()
    files = {"own.toml": lathe, "b.nc": "G0 X1", "a.nc": "G0 Z1", "mine.tbl": ""}
    assert dropped(browser, files) == "done"
    assert browser.value("[web.machine.letters, web.edited.map(file => file.name)]") == [
        "XZ",
        ["a.nc", "b.nc"],
    ]


HEAD = """
clock_hz = 4_000_000
spindle_maximum = 1000
[spindle]
counts = 200
wander = 20
start_up = 0.1
"""
TAPPED = "M3 S600\n" + "G0 Z2\nG33.1 Z1 K1.25\n" * 2 + "G0 Z3\nM5\nM2\n"
CUT = "G90\nM3 S500\nG0 X1 Z2\nG33 X1.6 Z-1 K1.5\nG33 X1.8 Z-2 K1.5\nG0 X0\nM5\n"
WHOLE = "G18 G90\nG0 X4 Z2\nM3 S500\nG76 P1 Z0 I-1 J0.4 K0.5 H0\nM5\nM2\n"
TAPS = "G0 Z2\nM3 S600 F750\nG84 Z1 R2\nG80 M5\nM2\n"


def of_the_command(folder: Path, machine: MachineFile, text: str) -> Played:
    """What it plays."""
    path = folder / "thread.ngc"
    path.write_text(text)
    with model_engine(core_of(machine), machine.clock_hz) as engine:
        return play_part(read_part(path, machine), machine, engine)


def is_played(browser: Browser | Firefox, played: Played, text: str) -> None:
    """Each step of the page is in the clock of that of the command: the spindle turns in the same way."""
    assert verdict_of(browser, text, seconds=PATIENCE) == "done"
    for axis, (clocks, positions) in enumerate(zip(played.clocks, played.positions, strict=True)):
        own = f"passo.motion.axes.find(own => own.axis === {axis})"
        assert browser.value(f"Array.from({own}?.rises ?? [])") == clocks.tolist()
        assert browser.value(f"Array.from({own}?.counted ?? [])") == positions.tolist()


def mill(folder: Path) -> Path:
    """A machine that is simulated fast."""
    path = folder / "mill.toml"
    path.write_text(HEAD + "".join(AXIS.format(letter, 80) for letter in "XYZ"))
    return path


def test_taps(either: Browser | Firefox, page: str, tmp_path: Path) -> None:
    path = mill(tmp_path)
    either.open("about:blank")
    either.open(page, READY)
    either.value(f"(web.putMachine({json.dumps(path.read_text())}), 1)")
    played = of_the_command(tmp_path, read_machine(path), TAPPED)
    assert played.threads == 2 and min(np.diff(played.positions[2])) == -1
    is_played(either, played, TAPPED)


@PYODIDE
def test_threads(browser: Browser, tmp_path: Path) -> None:
    """G33 that a second one continues; the passes of G76, which Python expands; G84."""
    path = mill(tmp_path)
    machine = read_machine(path)
    browser.value(f"(web.putMachine({json.dumps(path.read_text())}), 1)")
    for text, threads in ((CUT, 1), (WHOLE, 2), (TAPS, 1)):
        played = of_the_command(tmp_path, machine, text)
        assert played.threads == threads
        is_played(browser, played, text)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("M3 S900\nG0 Z2\nG33 Z-20 K30\nG0 X1", 3),  # too fast for Z
        ("M3 S600\nG0 Z2\nG33 Z1.9 K1.25\n", 3),  # too short
        ("G0 Z4\nG33 Z3.9 K1.25\n", 2),  # the spindle does not turn
    ],
)
def test_a_thread_that_cannot_be(browser: Browser, tmp_path: Path, text: str, line: int) -> None:
    """The sentence is that of the command, with its line."""
    path = mill(tmp_path)
    machine = read_machine(path)
    browser.value(f"(web.putMachine({json.dumps(path.read_text())}), 1)")
    with pytest.raises(BadInputError) as error:
        of_the_command(tmp_path, machine, text)
    place, *_, reason = str(error.value).split(": ", 1 if "error:" in str(error.value) else 3)
    assert place == f"{tmp_path / 'thread.ngc'}:{line}"
    assert verdict_of(browser, text) == f"error: line {line}: {reason}"


WAITS = "clock_hz = 4_000_000\nspindle_maximum = 1000\nspindle_wait = "
STARTS = "G1 X1 F600\nM3 S1000\nX2\nX3 M4\nX4\nM5\nX5\n"


@pytest.mark.parametrize(
    "head",
    [
        "0.2\n",
        "1\nspindle_at_speed = 3\n",
        HEAD[HEAD.index("[spindle]") :].replace("[", "1\nspindle_at_speed = 2\n[", 1),
    ],
)
def test_motions_wait_for_the_spindle(browser: Browser, tmp_path: Path, head: str) -> None:
    path = tmp_path / "mill.toml"
    path.write_text(WAITS + head + "".join(AXIS.format(letter, 80) for letter in "XYZ"))
    played = of_the_command(tmp_path, read_machine(path), STARTS)
    assert len(played.motions) == 3
    browser.value(f"(web.putMachine({json.dumps(path.read_text())}), 1)")
    is_played(browser, played, STARTS)


def test_a_spindle_that_is_too_slow(browser: Browser, tmp_path: Path) -> None:
    path = tmp_path / "mill.toml"
    path.write_text(f"{WAITS}0.25\nspindle_at_speed = 1\n" + AXIS.format("X", 80))
    with pytest.raises(BadInputError) as error:
        of_the_command(tmp_path, read_machine(path), STARTS)
    browser.value(f"(web.putMachine({json.dumps(path.read_text())}), 1)")
    reason = str(error.value).split("thread.ngc:2: ")[1]
    assert verdict_of(browser, STARTS) == f"error: line 2: {reason}"


def test_the_spindle_of_the_page_can_be_wrong(browser: Browser, tmp_path: Path) -> None:
    """A spindle that wanders otherwise makes other steps: the comparison above sees it."""
    path = mill(tmp_path)
    played = of_the_command(tmp_path, read_machine(path), TAPPED)
    text = path.read_text().replace("wander = 20", "wander = 19")
    browser.value(f"(web.putMachine({json.dumps(text)}), 1)")
    assert verdict_of(browser, TAPPED, seconds=PATIENCE) == "done"
    rises = browser.value("Array.from(passo.motion.axes.find(own => own.axis === 2).rises)")
    assert rises != played.clocks[2].tolist() and np.diff(rises).min() > 0
