# SPDX-License-Identifier: MIT
"""Random lines for the console, under the sanitizers (console_fuzz.c)."""

import subprocess
from pathlib import Path

import pytest
from passo import random_cases
from passo.toolchain import paths

from tests.helpers import sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())
FOLDERS = (paths.driver, paths.console, paths.planner, paths.protocol, paths.core, paths.engine)
TERMINAL = paths.engine / "passo_terminal.c"


@pytest.mark.sample(1)
def test_every_line_gets_one_answer(tmp_path: Path) -> None:
    """Any input in any state of the core: one `ok` or `error:`, no undefined behavior."""
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "console_fuzz.c", FOLDERS, TERMINAL)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    answers = {kind: int(number) for kind, number in map(str.split, done.stdout.splitlines())}
    assert min(answers.values()) > 100
