# SPDX-License-Identifier: MIT
"""Random lines for the console, under the sanitizers (console_fuzz.c)."""

import subprocess
from pathlib import Path

from passo import random_cases
from passo.build import engine_sources
from passo.compiler import SANITIZED, STRICT, compile_to, includes, sources
from passo.toolchain import paths

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())
# The driver before the model: both have a passo_outputs.h, the console means the first.
FOLDERS = (paths.driver, paths.console, paths.planner, paths.protocol, paths.model)
ENGINE = [*engine_sources(), paths.engine / "engine_model.c", paths.engine / "passo_terminal.c"]


def test_every_line_gets_one_answer(tmp_path: Path) -> None:
    """Any input in any state of the core: one `ok` or `error:`, no undefined behaviour."""
    files = [*sources(*FOLDERS), *ENGINE]
    flags = (*STRICT, *SANITIZED, *includes(*FOLDERS, paths.engine))
    program = compile_to(tmp_path / "fuzz", *flags, paths.tests / "console_fuzz.c", *files)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    answers = {kind: int(number) for kind, number in map(str.split, done.stdout.splitlines())}
    assert min(answers.values()) > 100
