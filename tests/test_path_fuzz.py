# SPDX-License-Identifier: MIT
"""The path planner with settings and lines of all sizes, under the sanitizers (path_fuzz.c)."""

import subprocess
from pathlib import Path

from passo import random_cases
from passo.compiler import SANITIZED, STRICT, compile_to, includes, sources
from passo.toolchain import paths

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())


def test_no_path_breaks_the_planner(tmp_path: Path) -> None:
    """No undefined behaviour, nothing that the core would refuse, no path that gets stuck."""
    folders = (paths.planner, paths.protocol)
    files = [paths.tests / "path_fuzz.c", *sources(*folders)]
    program = compile_to(tmp_path / "fuzz", *STRICT, *SANITIZED, *includes(*folders), *files)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s: {done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout.split()[0]) > 50
