# SPDX-License-Identifier: MIT
"""The driver on a link that dies at each word of each frame of each call (driver_cuts.c)."""

import subprocess
from pathlib import Path

import pytest
from passo.build import WHOLE
from passo.compiler import STRICT, headers, includes, kept, sources
from passo.toolchain import paths

PARTS = 8
FOLDERS = (paths.core, paths.planner, paths.protocol, paths.driver)


@pytest.fixture(scope="module")
def program() -> Path:
    files = [paths.tests / "driver_cuts.c", *sources(*FOLDERS)]
    flags = (*STRICT, *WHOLE, *includes(*FOLDERS))
    return kept(paths.build / "tests" / "driver_cuts", [*files, *headers(*FOLDERS)], flags, *files)


@pytest.mark.sample(1)
@pytest.mark.parametrize("part", range(PARTS))
def test_a_wire_that_dies_anywhere(program: Path, part: int) -> None:
    """The driver's state matches the core, or the driver reports that it is unknown and can be cleared."""
    done = subprocess.run([program, str(part), str(PARTS)], capture_output=True, text=True, timeout=900)
    print(done.stdout)
    good, _, all_of_them = done.stdout.splitlines()[-1].partition(" of ")
    assert (done.returncode, done.stderr, good) == (0, "", all_of_them), done.stdout
    assert int(good) > 400
