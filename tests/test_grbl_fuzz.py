# SPDX-License-Identifier: MIT
"""Random input for the protocol of grbl, under the sanitizers (grbl_fuzz.c)."""

import subprocess
from pathlib import Path

from passo import random_cases
from passo.build import engine_sources
from passo.compiler import SANITIZED, STRICT, compile_to, includes, sources
from passo.toolchain import paths

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())
# the driver's passo_outputs.h comes before that of the model
FOLDERS = (paths.grbl, paths.driver, paths.gcode, paths.planner, paths.protocol, paths.engine, paths.model)
HOST = (paths.grbl, paths.driver, paths.gcode, paths.planner, paths.protocol, paths.model)


def test_every_line_gets_one_answer(tmp_path: Path) -> None:
    """Whatever comes at whatever time: one answer per line, a reset helps, no undefined behaviour."""
    files = [*sources(*HOST), *engine_sources(), paths.engine / "engine_model.c"]
    flags = (*STRICT, *SANITIZED, *includes(*FOLDERS))
    program = compile_to(tmp_path / "fuzz", *flags, paths.tests / "grbl_fuzz.c", *files)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    happened = {kind: int(number) for kind, number in map(str.split, done.stdout.splitlines())}
    assert min(happened[kind] for kind in ("ok", "error", "report", "motion")) > 20
    assert happened["reset"] > 3 and happened["alarm"] > 0
