# SPDX-License-Identifier: MIT
"""The driver on a wire that dies at each word of each frame of each of its calls (driver_cuts.c)."""

import subprocess
from pathlib import Path

import pytest
from passo.toolchain import paths
from test_core_sources import compile_c

PARTS = 8
FOLDERS = (paths.model, paths.planner, paths.protocol, paths.driver)
SOURCES = [paths.tests / "driver_cuts.c", *(path for folder in FOLDERS for path in folder.glob("*.c"))]


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("cuts") / "driver_cuts"
    warnings = ["-std=c11", "-Wall", "-Wextra", "-Werror"]
    compile_c(*warnings, "-O3", *(f"-I{folder}" for folder in FOLDERS), *SOURCES, "-o", made)
    return made


@pytest.mark.parametrize("part", range(PARTS))
def test_a_wire_that_dies_anywhere(program: Path, part: int) -> None:
    """At the end the driver believes what the core has, or says what it does not know, and a clear helps."""
    done = subprocess.run([program, str(part), str(PARTS)], capture_output=True, text=True, timeout=900)
    print(done.stdout)
    good, _, all_of_them = done.stdout.splitlines()[-1].partition(" of ")
    assert (done.returncode, done.stderr, good) == (0, "", all_of_them), done.stdout
    assert int(good) > 400
