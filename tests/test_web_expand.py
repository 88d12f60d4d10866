# SPDX-License-Identifier: MIT
"""The page to try Passo expands programs as the command does."""

import ast
import json
import random
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest
from passo import random_cases, web_python
from passo.cli import main
from passo.expand.expander import Options, expand_file
from passo.expand.output import PlainLine
from passo.expand.place import ExpandError
from passo.expand.tools import read_tools
from passo.gcode import GcodeSettings
from passo.machine_file import read_machine
from passo.part import read_part
from passo.toolchain import paths
from passo.web import EXAMPLE, build

from benchmarks.gcode_contours import contour_program
from benchmarks.gcode_corpus import contours, corpus
from benchmarks.gcode_language import language_program
from tests.helpers.browser import Browser
from tests.helpers.firefox import Firefox
from tests.test_expand import ALL, REFUSED, UNKNOWN
from tests.test_web import ANSWER, READY, VERDICT, saved, verdict_of

pytestmark = pytest.mark.skipif(
    not web_python.is_installed() and shutil.which("npm") is None, reason="Pyodide needs npm"
)
PROGRAMS = 60
PATIENCE = 300  # seconds
PLATE = (paths.examples / "gcode" / "plate.ngc").read_text()
TOOLS = "".join(f"T{tool} D{tool / 100} Z{tool}\n" for tool in range(1, 20))
LIMIT = 20_000  # loops that are executed more often take minutes


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page, with what is beside it."""
    return build(tmp_path_factory.mktemp("web"))


@pytest.fixture(scope="module", params=[Browser, Firefox])
def either(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, page: Path
) -> Iterator[Any]:
    """Both browsers, with the page."""
    with request.param(tmp_path_factory.mktemp("either")) as made:
        opened(made, page)
        yield made


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory, page: Path) -> Iterator[Browser]:
    """The page in Chromium."""
    with Browser(tmp_path_factory.mktemp("browser")) as made:
        opened(made, page)
        yield made


def opened(browser: Browser | Firefox, page: Path) -> None:
    """Open the page, with Python: that takes long on a busy computer."""
    browser.open(page.as_uri(), READY)
    browser.value("(web.runner.python().then(() => { window.loaded = 1; }), 1)")
    browser.wait("window.loaded", PATIENCE)


def of_the_page(
    browser: Browser | Firefox, programs: list[str], settings: GcodeSettings, tools: str
) -> list[Any]:
    """What the page makes of programs."""
    numbers = [0, 0, 0, settings.arc_tolerance, *[0] * 6, settings.spindle_maximum]
    machine = {**asdict(settings), "letters": settings.axis_letters, "numbers": numbers}
    browser.value(
        f"(window.found = null, (async () => {{ await web.runner.python(); const all = [];"
        f"for (const text of {json.dumps(programs)}) all.push(await web.runner.ask("
        f"{{kind: 'expand', name: 'program', files: [{{name: 'program', text, plays: true}}],"
        f" machine: {json.dumps(machine)}, tools: {json.dumps(tools)}}}));"
        "found = all; })().catch(error => { found = `${error}`; }), 1)"
    )
    browser.wait("found", PATIENCE)
    found = browser.value("found")
    assert isinstance(found, list), found
    return found


def of_the_command(folder: Path, program: str, options: Options) -> dict[str, Any]:
    """The same from the command."""
    said: list[str] = []
    path = folder / "program"
    path.write_bytes(program.encode())
    try:
        lines = expand_file(path, options, said.append)
    except ExpandError as error:
        wrong = str(error).replace(f"{path}:", "line ").replace(f"{folder}/", "")
        return {"kind": "expanded", "said": said, "wrong": wrong, **plain(error.lines)}
    return {"kind": "expanded", "said": said, **plain(lines)}


def plain(lines: Sequence[PlainLine]) -> dict[str, list[str]]:
    """As the page has them."""
    places = [f"line {line.place.line}" for line in lines]
    return {"lines": [line.text for line in lines], "places": places}


def is_same(browser: Browser | Firefox, folder: Path, programs: list[str], tools: str = TOOLS) -> int:
    """Compare programs; return how many were refused."""
    settings = GcodeSettings(axes=6, spindle_maximum=10_000, turn_counts=1000)
    table = folder / "tools.tbl"
    table.write_text(tools)
    options = Options(settings, read_tools(table), at_zero=True, limit=LIMIT)
    wanted = {program: of_the_command(folder, program, options) for program in programs}
    wanted = {program: made for program, made in wanted.items() if "endless?" not in made.get("wrong", "")}
    assert len(wanted) > len(programs) / 2
    for (program, made), own in zip(
        wanted.items(), of_the_page(browser, list(wanted), settings, tools), strict=True
    ):
        assert own == made, program
    return sum("wrong" in made for made in wanted.values())


def test_the_corpora(browser: Browser, tmp_path: Path) -> None:
    programs = ["\n".join(lines) for _, lines in (*corpus(), *contours())]
    assert is_same(browser, tmp_path, [*programs, PLATE]) < len(programs) / 4


def test_random_programs(browser: Browser, tmp_path: Path) -> None:
    makers = (language_program, contour_program)
    programs = [
        "\n".join(make(random.Random(f"{random_cases.seed()} {number}")))
        for number in range(PROGRAMS)
        for make in makers
    ]
    assert 0 < is_same(browser, tmp_path, programs) < len(programs)


def test_refusals(browser: Browser, tmp_path: Path) -> None:
    """The sentences are those of the command."""
    assert is_same(browser, tmp_path, [*REFUSED, *UNKNOWN, *ALL]) > len(REFUSED) / 2


@pytest.mark.sample(1)
def test_both_browsers_play_what_they_expand(either: Browser | Firefox, tmp_path: Path) -> None:
    path = tmp_path / "plate.ngc"
    path.write_text(PLATE)
    assert verdict_of(either, PLATE, seconds=PATIENCE) == "done"
    part = read_part(path, read_machine(EXAMPLE / "machine.toml"))
    ends = either.value("passo.motion.axes.map(axis => axis.counted.at(-1) * axis.per_step)")
    assert ends == pytest.approx(part.ends[: len(ends)], abs=0.01)
    plain = tmp_path / "plain.nc"
    assert main(["expand", str(path), "--at-zero", "-o", str(plain)]) == 0
    assert saved(either, "plain") == plain.read_bytes()


def test_what_it_says(browser: Browser) -> None:
    """Texts of PRINT, then all wrong lines with their places in the program, as `passo run` names them."""
    assert verdict_of(browser, "(print,length #<_x>)\nG1 X[1] F100") == "done"
    assert browser.value(ANSWER) == "length 0.000000"
    text = "(print,one)\no1 repeat [2]\nG91 G1 Z-1 F9\no1 endrepeat\n\nG0 A[2]"
    assert verdict_of(browser, text).startswith("error: line 6: error:20: ")
    said, wrong = browser.value(ANSWER).splitlines()
    assert said == "one" and wrong.endswith(": A2 (NIST): the machine has the axes X Y Z")
    assert browser.value("passo") is None


def test_it_says_all_that_is_wrong(browser: Browser) -> None:
    """A sentence for each line, of those that cannot be expanded and of those that are refused then."""
    said = verdict_of(browser, "G1 X[1/0] F9\nG38.2 Z-1 F[9]\nG0 Y-")
    wrong = browser.value(ANSWER).splitlines()
    assert said == f"error: {wrong[0]} (3 errors, listed below)"
    assert [line[:8] for line in wrong] == ["line 1: ", "line 3: ", "line 2: "]


def test_places_of_plain_lines(browser: Browser) -> None:
    text = "o1 repeat [2]\nG91 G38.2 Z-1 F9\no1 endrepeat\nG0 X0"
    assert verdict_of(browser, text).startswith("error: line 2: no probe is fitted")
    said = "line 2: no probe is fitted: G38.2 (grbl, LinuxCNC): a height map simulates one"
    assert browser.value(ANSWER).splitlines() == [said] * 2


def test_tools(browser: Browser, page: Path) -> None:
    text = "G0 X0 Y0\nG41 D1\nG1 X10 F600\nY10\nG40 X0 Y0"
    assert "no tool table has T1" in verdict_of(browser, text)
    browser.value("(document.getElementById('tools').value = 'T1 D2', 1)")
    assert verdict_of(browser, text) == "done"
    link = browser.value("toFragment(web.state)")
    browser.value("(document.getElementById('tools').value = 'D2', 1)")
    assert verdict_of(browser, "G0 X1").startswith("error: tool table:1: a tool needs its number: T")
    browser.open("about:blank")
    browser.open(page.as_uri() + link, READY)
    assert browser.value(VERDICT) == "done"


def test_an_endless_program_is_canceled(either: Browser | Firefox) -> None:
    text = "o1 while [1]\n#1=[#1+1]\no1 endwhile"
    done = either.value("web.done")
    either.value(f"(web.put({json.dumps(text)}, 'G-code'), document.getElementById('go').click())")
    either.wait("document.getElementById('told').textContent === 'expanding the program'", PATIENCE)
    either.value("document.getElementById('cancel').click()")
    either.wait(f"web.done > {done}")
    assert either.value(VERDICT) == "error: canceled while the program was expanded"
    assert verdict_of(either, "G1 F600 X1") == "done"
    assert verdict_of(either, "G1 F600 X[1+1]", seconds=PATIENCE) == "done"


def test_without_python(tmp_path: Path, page: Path) -> None:
    """One sentence; plain programs are played."""
    copy = shutil.copy(page, tmp_path / "index.html")
    with Browser(tmp_path / "browser") as browser:
        browser.open(Path(copy).as_uri(), READY)
        said = verdict_of(browser, "#1=2\nG0 X#1")
        assert said.startswith("error: python.js is missing beside this page: it expands parameters, ")
        assert verdict_of(browser, "G0 X2") == "done"
        shutil.copy(page.with_name(web_python.NAME), tmp_path)
        assert verdict_of(browser, "#1=2\nG0 X#1", seconds=PATIENCE) == "done"


def test_without_pyodide(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What an earlier build has left is deleted."""
    (tmp_path / web_python.NAME).write_text("")
    monkeypatch.setattr(web_python, "PYODIDE", tmp_path / "none")
    assert web_python.write_python(tmp_path) is None
    assert not (tmp_path / web_python.NAME).exists()


def test_the_page_has_all_that_its_modules_import_of_native() -> None:
    """It has a passo.native of its own."""
    folder = paths.sim / "passo"
    own = ast.parse((folder / "page" / "native.py").read_text())
    has = {node.name for node in own.body if isinstance(node, ast.FunctionDef)}
    wanted: set[str] = set()
    for source in [*(folder / name for name in web_python.MODULES), *(folder / "expand").glob("*.py")]:
        for node in ast.walk(ast.parse(source.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module == "passo.native":
                wanted |= {name.name for name in node.names}
    assert {"ffi", "planner"} <= wanted <= has
