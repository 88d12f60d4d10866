# SPDX-License-Identifier: MIT
"""All planning functions with arguments of all sizes, under the sanitizers (plan_fuzz.c)."""

import os
import re
import subprocess
from pathlib import Path

from passo.toolchain import environment, paths

SEED = os.environ.get("PASSO_SEED", "1")
SECONDS = os.environ.get("PASSO_FUZZ_SECONDS", "5")
FLAGS = "-std=c11 -O1 -g -Wall -Wextra -Wconversion -Werror -fsanitize=address,undefined"


def test_no_argument_breaks_the_planner(tmp_path: Path) -> None:
    """No undefined behaviour, no plan that the core would not take, no refusal that touches the plan."""
    program = tmp_path / "fuzz"
    sources = sorted(paths.planner.glob("*.c"))
    command = ["gcc", *FLAGS.split(), "-fno-sanitize-recover=all"]
    command += [f"-I{paths.planner}", f"-I{paths.protocol}"]
    target = paths.tests / "plan_fuzz.c"
    subprocess.run([*command, target, *sources, "-o", program], env=environment(), check=True)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    rows = [line.split() for line in done.stdout.splitlines()]
    declared = set(re.findall(r"passo_plan_(\w+)\(\s*const struct passo_machine", header()))
    assert {name for name, _, _ in rows} == declared, "every planning function is called"
    assert all(int(planned) > 100 and int(refused) > 100 for _, planned, refused in rows)


def header() -> str:
    return (paths.planner / "passo_plan.h").read_text()
