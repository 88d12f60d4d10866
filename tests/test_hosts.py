# SPDX-License-Identifier: MIT
"""`make hosts` in short: timed points with late polls, bit errors and hosts that die; and its page."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.toolchain import paths

from benchmarks import hosts_all, servo
from benchmarks.hosts import good, measure
from benchmarks.hosts_all import Options, Row

PAGE = paths.reference / "hosts.md"


def test_promises() -> None:
    """Nothing is lost, late polls and bit errors change no edge, the wire has room."""
    found = measure(seed=7, seconds=3, deaths=3, hour=60)
    print(found)
    assert good(found), found
    assert found.flips > 10
    assert sum(found.causes.values()) == 3 and set(found.causes) <= {"RAMP_UNDERRUN", "WATCHDOG"}


def test_minutes_of_a_servo_thread() -> None:
    """Steps are counted as they come; the loop finds the difference of the clocks."""
    found = servo.long(0.25)
    assert found.lost == 0 and found.off <= servo.OFF_MAX
    assert abs(found.trim + servo.PPM) < 60
    assert abs(servo.long(0.25, -servo.PPM).trim - servo.PPM) < 60


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(hosts_all, "RESULTS", tmp_path / "results")
    monkeypatch.setattr(hosts_all, "PAGE", tmp_path / "hosts.md")
    return tmp_path


@pytest.mark.parametrize("kept", [True, False])
def test_the_command(
    folder: Path, kept: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It prints rows and keeps them; a promise that is not kept is an error, on the page as well."""

    def part(options: Options) -> Iterator[Row]:
        """Of a test."""
        yield Row("steps lost", f"{options.seed} steps", "0", kept)

    monkeypatch.setattr(hosts_all, "PARTS", {"one": ("One", part)})
    monkeypatch.setattr("sys.argv", ["hosts_all", "--seed", "7"])
    assert hosts_all.main() == int(not kept)
    assert ("NOT KEPT: steps lost: 7 steps" in capsys.readouterr().out) != kept
    mark = "" if kept else " **not kept**"
    assert f"| steps lost | 7 steps{mark} | 0 |" in (folder / "hosts.md").read_text()
    monkeypatch.setattr("sys.argv", ["hosts_all", "--page"])
    assert hosts_all.main() == int(not kept)


def test_the_first_program_and_the_list_of_what_is_wrong(folder: Path) -> None:
    """The program has at most 15 lines; each test of the list exists."""
    (row,) = hosts_all.first_program(Options(1, 1, 1))
    assert row.kept and row.figure.startswith("11 lines: off the plan by at most ")
    for file, test in hosts_all.WRONG.values():
        assert re.search(rf"^def {test}\(", (paths.tests / f"test_{file}.py").read_text(), re.M), test


def test_the_page() -> None:
    """It has all parts, and each promise was kept."""
    text = PAGE.read_text()
    assert re.findall(r"^## (.*)", text, re.M) == [title for title, _ in hosts_all.PARTS.values()]
    assert "not kept" not in text
