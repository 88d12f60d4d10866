# SPDX-License-Identifier: MIT
"""All planning functions with arguments of all sizes, under the sanitizers (plan_fuzz.c)."""

import re
import subprocess
from pathlib import Path

import pytest
from passo import random_cases
from passo.toolchain import paths

from tests.helpers import sanitized

SEED = str(random_cases.seed())
SECONDS = str(random_cases.fuzz_seconds())


@pytest.mark.sample(1)
def test_no_argument_breaks_the_planner(tmp_path: Path) -> None:
    """No undefined behavior, no plan that the core would refuse, no error that modifies the plan."""
    folders = (paths.planner, paths.protocol)
    program = sanitized.program(tmp_path / "fuzz", paths.tests / "plan_fuzz.c", folders)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    rows = [line.split() for line in done.stdout.splitlines()]
    declared = set(re.findall(r"passo_plan_(\w+)\(\s*const struct passo_machine", header()))
    assert {name for name, _, _ in rows} == declared, "every planning function is called"
    assert all(int(planned) > 100 and int(refused) > 100 for _, planned, refused in rows)


def header() -> str:
    return (paths.planner / "passo_plan.h").read_text()
