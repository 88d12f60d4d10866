# SPDX-License-Identifier: MIT
"""The figures of a first hour, with small cases; `make first-hour` has the fresh clone and the whole ones."""

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from passo.toolchain import paths
from passo.web import build

from benchmarks import first_hour, hour, page, play
from benchmarks.first_hour import Figure, most


@pytest.mark.first
def test_the_short_form(monkeypatch: pytest.MonkeyPatch) -> None:
    """Preview and page with a twentieth of the lines, well within their goals; it says so."""
    monkeypatch.setattr(page, "LINES", 4000)
    told: list[str] = []
    figures = first_hour.measure_short(told.append)
    assert [figure.command.split(".")[-1] for figure in figures] == ["preview", "preview", "page", "page"]
    assert all(figure.met for figure in figures[:3]), figures
    assert len(told) == 2 and "5,000 lines" in figures[0].what


def test_a_run_goes_on_where_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Part by part; another commit measures all of it, chosen parts only these."""
    monkeypatch.setattr(first_hour, "KEPT", tmp_path / "kept" / "figures.json")
    head, broken, ran = "a", "rtl", list[str]()
    monkeypatch.setattr(first_hour, "commit", lambda: head)

    def part(name: str) -> Callable[[first_hour.Tell], Iterator[Figure]]:
        def run(_: first_hour.Tell) -> Iterator[Figure]:
            ran.append(name)
            if name == broken:
                raise KeyboardInterrupt
            yield Figure(name, "1", str(len(ran)), True, "make")

        return run

    monkeypatch.setattr(first_hour, "PARTS", {name: part(name) for name in ("page", "rtl", "hour")})
    with pytest.raises(KeyboardInterrupt):
        first_hour.measure(print)
    broken = ""
    found = first_hour.measure(print)
    assert ran == ["page", "rtl", "rtl", "hour"] and [figure.what for figure in found] == [
        "page",
        "rtl",
        "hour",
    ]
    assert first_hour.measure(print) == found and len(ran) == 4
    head = "b"
    first_hour.measure(print, ["rtl"])
    assert ran[4:] == ["rtl"]
    first_hour.measure(print)
    assert ran[5:] == ["page", "hour"]
    first_hour.measure(print, again=True)
    assert ran[7:] == ["page", "rtl", "hour"]


def test_figures_and_their_goals() -> None:
    assert most("a", 5, 4.999, "s", "c").met and most("a", 5, 5, "s", "c").met
    missed = most("a", 5, 5.001, "s", "make c")
    assert most("a", 5, 1459, "s", "c").measured == "1,459 s"
    assert missed.row == ("a", "at most 5 s", "5 s", "**no**", "`make c`")


def test_the_page_is_written() -> None:
    """Between its marks; the text around them stays."""
    before = first_hour.PAGE.read_text()
    made = first_hour.written([Figure("a part", "2 s", "1 s", True, "make part")])
    assert "| a part | 2 s | 1 s | yes | `make part` |\n<!-- to here -->" in made
    assert made.partition("<!--")[0] == before.partition("<!--")[0]
    assert made.partition("<!-- to here")[2] == before.partition("<!-- to here")[2]


def test_rows_of_other_parts_stay() -> None:
    """Where a part is measured alone and nothing is known of the others."""
    (first, *_) = rows = [line for line in first_hour.PAGE.read_text().splitlines() if line.startswith("| ")][
        2:
    ]
    what = first.strip("| ").split(" | ")[0]
    own = Figure(what, "5 s", "9 s", False, "`python -m benchmarks.preview`".strip("`"))
    made = first_hour.written([own, Figure("a part", "2 s", "1 s", True, "make part")], keep=True)
    after = [line for line in made.splitlines() if line.startswith("| ")][2:]
    assert after[:2] == [
        f"| {what} | 5 s | 9 s | **no** | `python -m benchmarks.preview` |",
        "| a part | 2 s | 1 s | yes | `make part` |",
    ]
    assert after[2:] == rows[1:]
    what = [row.strip("| ").split(" | ")[0] for row in rows]
    ends = [Figure(name, "5 s", "9 s", False, "make all") for name in (what[0], what[-1])]
    made = first_hour.written(ends, keep=True)
    after = [line for line in made.splitlines() if line.startswith("| ")][2:]
    assert [row.strip("| ").split(" | ")[0] for row in after] == what


def test_ratios_are_measured_with_the_same_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """The seconds of both; other steps are an error, other edges are not."""
    kinds = (("ab", "ab"), ("ab", "cb"), ("ab", "ac"))
    seconds = iter([one for old, new in kinds for one in ((0.1, ""), (0.1, ""), (8.0, old), (1.0, new))])
    monkeypatch.setattr(play, "extract", lambda commit, folder: None)
    monkeypatch.setattr(play, "play", lambda root, name, lines: next(seconds))
    for edges in (True, False):
        (found,) = play.compare(play.CASES[:1])
        assert found.ratio == 8 and found.edges == edges
    with pytest.raises(SystemExit, match="the steps differ"):
        play.compare(play.CASES[:1])


def test_the_part_on_the_page(tmp_path: Path) -> None:
    """As the command makes it; a person sees it."""
    seen = hour.look(build(tmp_path / "web"), tmp_path / "page.png")
    assert seen == hour.steps_of_command(tmp_path / "out") and min(seen) > 1000
    assert (tmp_path / "page.png").stat().st_size > 20_000


DEMO = """demo:
	sleep 1.1
	head -c 3000000 /dev/zero > made
	python3 -c 'import time; [None for _ in iter(lambda: time.process_time() > 2.2, True)]'
"""


def test_the_script(tmp_path: Path) -> None:
    """In plain shell: it clones, runs the demonstration, and hands on seconds, processor and megabytes."""
    repository = tmp_path / "repository"
    (repository / ".venv" / "bin").mkdir(parents=True)
    (repository / "Makefile").write_text(DEMO)
    python = repository / ".venv" / "bin" / "python"
    python.write_text('#!/bin/sh\necho "$@" > said\n')
    python.chmod(0o755)
    git = ("git", "-C", repository, "-c", "user.name=a", "-c", "user.email=a")
    for words in (("init", "-q"), ("add", "-f", "."), ("commit", "-q", "-m", "one")):
        subprocess.run([*git, *words], check=True)
    subprocess.run(["sh", first_hour.SCRIPT, repository, tmp_path / "clone"], check=True)
    module, name, *said = (tmp_path / "clone" / "said").read_text().split()
    seconds, processor, megabytes = map(int, said)
    assert (module, name) == ("-m", "benchmarks.hour") and seconds >= 3
    assert 2 <= processor < 10 and 3 <= megabytes < 10


def test_an_hour_of_a_bare_machine(tmp_path: Path) -> None:
    """Is read from its file."""
    file = tmp_path / "hour.json"
    file.write_text('{"seconds": 130, "processor": 200, "megabytes": 350, "commands": 3, "steps": 51200}')
    figures = list(first_hour.hour_of(file, lambda _: None))
    assert [figure.met for figure in figures] == [False, True, True, True, True]
    assert [figure.measured for figure in figures[1:4]] == ["200 s", "350 MB", "3 of 3"]


def test_a_command_that_fails_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Named; the demonstration is not run again."""
    ended = subprocess.CompletedProcess([], 1, "", "nothing moves")
    monkeypatch.setattr(hour.subprocess, "run", lambda *_, **__: ended)
    monkeypatch.setattr(hour, "run", lambda *_: ended)
    with pytest.raises(hour.Failure, match=r"README: make web.*: nothing moves"):
        hour.commands()


def test_steps_of_the_command_are_counted(tmp_path: Path) -> None:
    made = hour.steps_of_command(tmp_path)
    assert sum(made) == len(np.loadtxt(tmp_path / "pulses.csv", delimiter=",", skiprows=1))
    assert paths.build / "first_hour" == hour.OUT
