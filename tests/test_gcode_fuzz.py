# SPDX-License-Identifier: MIT
"""The G-code interpreter with lines of all kinds, under the sanitizers (gcode_fuzz.c)."""

import subprocess
from pathlib import Path

from passo import random_cases
from passo.toolchain import paths

from tests.helpers import sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())


def test_no_line_breaks_the_interpreter(tmp_path: Path) -> None:
    """No undefined behavior, no partial effect, nothing that the planner cannot take."""
    folders = (paths.gcode, paths.planner, paths.protocol)
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "gcode_fuzz.c", folders)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s: {done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout.split()[0]) > 20
