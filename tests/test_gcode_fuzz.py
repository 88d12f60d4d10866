# SPDX-License-Identifier: MIT
"""The G-code interpreter with lines of all kinds, under the sanitizers (gcode_fuzz.c)."""

import re
import subprocess
from pathlib import Path

import pytest
from passo import random_cases
from passo.toolchain import paths

from tests.helpers import gcode_guided_fuzz, sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())


@pytest.mark.sample(1)
def test_no_line_breaks_the_interpreter(tmp_path: Path) -> None:
    """No undefined behavior, no partial effect, nothing that the planner cannot take."""
    folders = (paths.gcode, paths.planner, paths.protocol)
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "gcode_fuzz.c", folders)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s: {done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout.split()[0]) > 20


@pytest.mark.skipif(not gcode_guided_fuzz.is_there(), reason="no clang: tools/setup.sh fuzz")
def test_no_line_that_reaches_new_code(tmp_path: Path) -> None:
    """The short form of `make gcode-fuzz`: libFuzzer, from the examples on."""
    done = gcode_guided_fuzz.fuzz(round(random_cases.fuzz_seconds()), tmp_path / "kept")
    assert done.returncode == 0, done.stderr[-3000:]
    (runs,) = re.findall(r"stat::number_of_executed_units: (\d+)", done.stderr)
    assert int(runs) > 100
    assert len(list((tmp_path / "kept").iterdir())) > 20
