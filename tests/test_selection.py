# SPDX-License-Identifier: MIT
"""The short form of the tests, which `make test` runs: by tests/times.txt and by marks, and of every file."""

import ast
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
from passo.toolchain import paths

SELECTION = paths.root / "conftest.py"
TIMES = paths.tests / "times.txt"
TESTS = """
import time
import pytest

@pytest.mark.parametrize("case", "abcdef")
def test_several(case): pass

@pytest.mark.sample(1)
@pytest.mark.parametrize("case", "gh")
def test_sampled(case): pass

@pytest.mark.parametrize("case", range(2))
def test_long(case): time.sleep(0.1 + 0.2 * case)

@pytest.mark.first
def test_first(): pass
"""
FILES = sorted(path for folder in (paths.tests, paths.cocotb_tests) for path in folder.glob("test_*.py"))

# Tests of the same on the PC; of these files the firmware is built and emulated for a minute.
ON_THE_PC = {"test_firmware_at_speed": "test_spindle_wait", "test_firmware_threads": "test_grbl_threads"}


@pytest.fixture
def selection(request: pytest.FixtureRequest) -> ModuleType:
    module = request.config.pluginmanager.get_plugin(str(SELECTION))
    assert isinstance(module, ModuleType)
    return module


@pytest.mark.parametrize(("count", "kept"), [(1, 1), (3, 5), (6, 2), (129, 30), (10, 9), (4, 0)])
def test_cases_are_spread_and_every_one_has_its_turn(selection: ModuleType, count: int, kept: int) -> None:
    turns = [sorted(selection.chosen(count, kept, seed)) for seed in range(count)]
    assert {len(turn) for turn in turns} == {min(count, kept)}
    if kept:
        assert {case for turn in turns for case in turn} == {*range(count)}
        steps = [b - a for turn in turns for a, b in zip(turn, [*turn[1:], turn[0] + count], strict=True)]
        assert max(steps) - min(steps) <= 1


def ran(folder: Path, *arguments: str, seed: str = "1") -> list[str]:
    """The cases that pass."""
    command = (sys.executable, "-m", "pytest", "-q", "-rp", "-p", "no:cacheprovider", *arguments)
    done = subprocess.run(command, cwd=folder, env={"PASSO_SEED": seed}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    return [line.partition("::test_")[2] for line in done.stdout.splitlines() if line.startswith("PASSED")]


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    """Some tests with times of their own."""
    (tmp_path / "conftest.py").write_text(SELECTION.read_text().replace("SECONDS = 4", "SECONDS = 0.16"))
    (tmp_path / "test_some.py").write_text(TESTS)
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = first\n sample\n")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/times.txt").write_text(
        "# Seconds\n  0.050 test_some.py::test_several\n 9.000 test_some.py::test_sampled\n"
        "9.000 test_some.py::test_long\n  9.000 test_other.py::test_other\n"
    )
    return tmp_path


@pytest.mark.parametrize(("seed", "cases"), [("1", "bdf"), ("2", "ace")])
def test_the_short_form(suite: Path, seed: str, cases: str) -> None:
    """As many cases as fit, those of a mark, all that are not listed, and the first ones first."""
    sampled = {"1": "h", "2": "g"}[seed]
    expected = ["first", *(f"several[{case}]" for case in cases), f"sampled[{sampled}]"]
    assert ran(suite, "--short", seed=seed) == expected


@pytest.mark.parametrize("workers", ["0", "2"])
def test_times_are_recorded(suite: Path, workers: str) -> None:
    """Of all cases, of the tests that take longer; those that did not run keep theirs."""
    assert len(ran(suite, "--times", "-n", workers)) == 11
    lines = [line.split() for line in (suite / "tests/times.txt").read_text().splitlines()[1:]]
    assert [name for _, name in lines] == ["test_other.py::test_other", "test_some.py::test_long"]
    assert float(lines[0][0]) == 9 and 0.2 <= float(lines[1][0]) < 1


def functions_of(path: Path) -> dict[str, ast.FunctionDef]:
    """By their names in tests/times.txt."""
    functions = (node for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef))
    file = path.relative_to(paths.root).as_posix()
    return {f"{file}::{node.name}": node for node in functions if node.name.startswith("test_")}


def test_each_time_is_that_of_a_test(selection: ModuleType) -> None:
    """Else a test that was renamed would be run whatever it takes."""
    assert not {*selection.listed()} - {name for path in FILES for name in functions_of(path)}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_no_file_is_left_out(selection: ModuleType, path: Path) -> None:
    """Whatever a file is about, some of it is in `make test`, or of the file named above."""
    times = selection.listed()
    path = path.with_stem(ON_THE_PC.get(path.stem, path.stem))
    assert any(
        times.get(name, 0) <= selection.SECONDS or "mark.sample" in ast.unparse(test)
        for name, test in functions_of(path).items()
    )
