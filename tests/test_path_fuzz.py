# SPDX-License-Identifier: MIT
"""The path planner with settings and lines of all sizes, under the sanitizers (path_fuzz.c)."""

import subprocess
from pathlib import Path

import pytest
from passo import random_cases
from passo.toolchain import paths

from tests.helpers import sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())


@pytest.mark.sample(1)
def test_no_path_breaks_the_planner(tmp_path: Path) -> None:
    """No undefined behavior, nothing that the core would refuse, no path that gets stuck."""
    folders = (paths.planner, paths.protocol)
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "path_fuzz.c", folders)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s: {done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout.split()[0]) > 50
