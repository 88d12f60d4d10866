# SPDX-License-Identifier: MIT
"""Random input for the protocol of grbl, under the sanitizers (grbl_fuzz.c)."""

import subprocess
from pathlib import Path

import pytest
from passo import random_cases
from passo.toolchain import paths

from tests.helpers import sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())
FOLDERS = (paths.grbl, paths.driver, paths.gcode, paths.planner, paths.protocol, paths.engine, paths.core)


@pytest.mark.sample(1)
def test_every_line_gets_one_answer(tmp_path: Path) -> None:
    """Whatever comes at whatever time: one answer per line, a reset helps, no undefined behavior."""
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "grbl_fuzz.c", FOLDERS)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    happened = {kind: int(number) for kind, number in map(str.split, done.stdout.splitlines())}
    assert min(happened[kind] for kind in ("ok", "error", "report", "motion")) > 20
    assert happened["reset"] > 3 and happened["alarm"] > 0
