# SPDX-License-Identifier: MIT
"""The sources of model, planner and driver: warnings, sanitizers, and what they do without."""

import re
import subprocess
from pathlib import Path

import pytest
from passo.toolchain import environment, paths

STRICT = ["-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror"]
SANITIZED = ["-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
MODEL = [*sorted(paths.model.glob("*.c")), *sorted(paths.protocol.glob("*.c"))]
SOURCES = [*MODEL, *sorted(paths.planner.glob("*.c")), *sorted(paths.driver.glob("*.c"))]
INCLUDES = [f"-I{folder}" for folder in (paths.model, paths.planner, paths.protocol, paths.driver)]
# What a compiler may call by itself on any target.
ALLOWED = {"memcpy", "memset", "memmove", "memcmp"}


def compile_c(*arguments: object) -> None:
    """Call the compiler."""
    subprocess.run(["gcc", *map(str, arguments)], env=environment(), check=True)


def test_a_scenario_runs_clean_under_sanitizers(tmp_path: Path) -> None:
    """Moves, holds, every kind of stop and rubbish on the wire: no fault, and the answers of the contract."""
    program = tmp_path / "scenario"
    compile_c(*STRICT, *SANITIZED, *INCLUDES, paths.tests / "core_scenario.c", *MODEL, "-o", program)
    done = subprocess.run([program], capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "ok\n")


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_no_floating_point_and_no_heap(source: Path, tmp_path: Path) -> None:
    """It has no such type, needs no floating-point registers, and calls nothing but itself and memcpy."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*|\"[^\"\n]*\"", "", source.read_text(), flags=re.S)
    assert not re.search(r"\b(float|double|(malloc|calloc|realloc|free|alloca)\s*\()|\d\.|\.\d", code)
    made = tmp_path / "object.o"
    compile_c(
        *STRICT,
        "-O2",
        "-mgeneral-regs-only",
        "-fno-stack-protector",
        "-c",
        *INCLUDES,
        source,
        "-o",
        made,
    )
    done = subprocess.run(["nm", "--undefined-only", "--format=posix", made], capture_output=True, text=True)
    names = {line.split()[0] for line in done.stdout.splitlines()} - {"_GLOBAL_OFFSET_TABLE_"}
    assert {name for name in names if not name.startswith("passo_")} <= ALLOWED
