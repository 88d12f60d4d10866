# SPDX-License-Identifier: MIT
"""Results whose places are fixed: one that cannot be written is refused before the work for it begins."""

import re
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest
from passo import cli
from passo.ending import BAD_INPUT, INTERRUPTED, ended
from passo.failure import BadInputError
from passo.toolchain import paths
from passo_fpga import boards_report, pages, parts_report
from passo_fpga import report as fpga_report
from passo_stm32 import bench, grbl_bench

from benchmarks import (
    accuracy,
    first_hour,
    hosts_all,
    hour,
    path,
    path_page,
    path_times,
    plan_record,
    squaring,
)
from verify import page as modules_page
from verify.equal import page as equal_page
from verify.equal import run as equal
from verify.mutants import page as mutants_page
from verify.mutants import run as mutants
from verify.soak import page as soak_page
from verify.soak import run as soak

SECONDS = 20  # until the work is taken to have begun
Call = Callable[[], object]
CASES: dict[str, tuple[ModuleType, str, Call]] = {
    "accuracy, report": (accuracy, "REPORT", accuracy.main),
    "accuracy, page": (accuracy, "PAGE", accuracy.main),
    "accuracy, picture": (accuracy, "PICTURE", accuracy.main),
    "first hour, kept": (first_hour, "KEPT", first_hour.main),
    "first hour, page": (first_hour, "PAGE", first_hour.main),
    "hosts": (hosts_all, "PAGE", hosts_all.main),
    "hour": (hour, "OUT", hour.main),
    "paths, report": (path_page, "REPORT", path.main),
    "paths, page": (path_page, "PAGE", path.main),
    "times of paths": (path_times, "KEPT", path_times.main),
    "record of plans": (plan_record, "RECORD", plan_record.main),
    "squaring": (squaring, "PAGE", lambda: squaring.main([])),
    "firmware": (bench, "REPORT", bench.bench),
    "FPGA": (fpga_report, "REPORT", fpga_report.main),
    "FPGA, page": (pages, "PAGE", fpga_report.main),
    "parts": (parts_report, "PAGE", lambda: fpga_report.main(["--parts"])),
    "boards": (boards_report, "PAGE", lambda: fpga_report.main(["--boards"])),
    "equality": (equal_page, "PAGE", equal.main),
    "mutants": (mutants_page, "PAGE", mutants.main),
    "modules": (modules_page, "PAGE", mutants.main),
    "scenarios": (soak, "REPORT", soak.main),
    "scenarios, page": (soak_page, "PAGE", soak.main),
}


@pytest.fixture(autouse=True)
def limit(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The work has not begun; the words of pytest are not those of the command."""

    def begun(*_: object) -> None:
        raise TimeoutError("the work has begun")

    monkeypatch.setattr(sys, "argv", ["command"])
    before = signal.signal(signal.SIGALRM, begun)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("case", CASES)
def test_it_is_refused_first(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder is in its place."""
    module, name, call = CASES[case]
    (tmp_path / "hour.json").mkdir()
    own = getattr(module, name)
    for used in [one for key, one in sys.modules.items() if re.match(r"benchmarks|verify|passo_", key)]:
        if getattr(used, name, None) == own:
            monkeypatch.setattr(used, name, tmp_path)
    with pytest.raises(BadInputError, match=rf"^result {tmp_path}.*: Is a directory$"):
        call()


def test_the_table_of_the_firmware(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The command says so."""
    monkeypatch.setattr(bench, "REPORT", tmp_path)
    assert cli.main(["firmware", "--table"]) == BAD_INPUT
    assert capsys.readouterr().err == f"result {tmp_path}: Is a directory\n"
    with pytest.raises(BadInputError):
        grbl_bench.bench(1, tmp_path)


def test_all_benchmarks_end_as_the_command_does(capsys: pytest.CaptureFixture[str]) -> None:
    """In one sentence, with its exit status."""

    def refuse() -> None:
        raise BadInputError("no")

    def interrupt() -> None:
        raise KeyboardInterrupt

    assert [ended(refuse), ended(interrupt), ended(lambda: None)] == [BAD_INPUT, INTERRUPTED, 0]
    assert capsys.readouterr().err == "no\n"
    for file in (paths.root / "benchmarks").glob("*.py"):
        _, main, how = file.read_text(encoding="utf-8").partition('if __name__ == "__main__":\n')
        assert not main or how.startswith("    sys.exit(ended("), file
