# SPDX-License-Identifier: MIT
"""The one runner: what a name selects, and what it says of a name that nobody knows."""

import re
import subprocess
import sys

import pytest

from verify import run

KNOWN = run.parts()


@pytest.mark.parametrize(
    ("names", "chosen"),
    [
        ([], {"formal": [], "equal": [], "wiring": [], "soak": [], "mutants": []}),
        (["formal", "equal"], {"formal": [], "equal": []}),
        (["formal", "axis"], {"formal": ["axis"]}),
        (["axis"], {"formal": ["axis"], "equal": ["axis"], "mutants": ["axis"]}),
        (["soak", "endings", "sessions"], {"soak": ["endings", "sessions"]}),
        (["passo_goto.c"], {"mutants": ["passo_goto.c"]}),
        (["wiring", "passo_core"], {"wiring": ["passo_core"]}),
    ],
)
def test_names_select(names: list[str], chosen: dict[str, list[str]]) -> None:
    assert run.chosen_of(KNOWN, names) == chosen


def test_a_name_that_nobody_knows() -> None:
    command = [sys.executable, "-m", "verify.run", "axs"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert re.search(r"no 'axs' in formal, equal, wiring, soak, mutants; near: axis", done.stderr)


def test_it_fails_when_a_part_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """And runs the others; the status of each part is that of its program."""
    codes = {"verify.formal.run": 1, "verify.equal.run": 0}
    called = []

    def call(command: list[str]) -> subprocess.CompletedProcess[bytes]:
        called.append(command[2:])
        return subprocess.CompletedProcess(command, codes[command[2]])

    monkeypatch.setattr(run.subprocess, "run", call)
    for names, status in ((["axis", "formal", "equal"], 1), (["equal", "axis"], 0)):
        monkeypatch.setattr(sys, "argv", ["run", *names])
        with pytest.raises(SystemExit) as ended:
            run.main()
        assert ended.value.code == status
    assert called == [
        ["verify.formal.run", "axis"],
        ["verify.equal.run", "axis"],
        ["verify.equal.run", "axis"],
    ]
