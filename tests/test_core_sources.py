# SPDX-License-Identifier: MIT
"""The sources of model, planner and driver: warnings, sanitizers, no floating point and no heap."""

import re
import subprocess
from pathlib import Path

import pytest
from passo.compiler import STRICT, compile_to, includes, sources
from passo.toolchain import paths

from tests.helpers import sanitized

MODEL = (paths.core, paths.protocol)
ALL = (*MODEL, paths.planner, paths.driver)
SERVO = paths.linux / "passo_servo.c"
# Functions that a compiler may call implicitly on any target.
ALLOWED = {"memcpy", "memset", "memmove", "memcmp"}


def test_a_scenario_runs_clean_under_sanitizers(tmp_path: Path) -> None:
    """Moves, holds, every kind of stop and garbage on the link: no fault, and the specified replies."""
    program = sanitized.program(tmp_path / "scenario", paths.tests / "core_scenario.c", MODEL)
    done = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "ok\n")


@pytest.mark.parametrize("source", [*sources(*ALL), SERVO], ids=lambda path: path.stem)
def test_no_floating_point_and_no_heap(source: Path, tmp_path: Path) -> None:
    """No floating-point types or registers, and no calls except to itself and memcpy."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*|\"[^\"\n]*\"", "", source.read_text(), flags=re.S)
    assert not re.search(r"\b(float|double|(malloc|calloc|realloc|free|alloca)\s*\()|\d\.|\.\d", code)
    flags = (*STRICT, "-O2", "-mgeneral-regs-only", "-fno-stack-protector", "-c")
    made = compile_to(tmp_path / "object.o", *flags, *includes(*ALL, paths.linux), source)
    done = subprocess.run(["nm", "--undefined-only", "--format=posix", made], capture_output=True, text=True)
    names = {line.split()[0] for line in done.stdout.splitlines()} - {"_GLOBAL_OFFSET_TABLE_"}
    assert {name for name in names if not name.startswith("passo_")} <= ALLOWED
