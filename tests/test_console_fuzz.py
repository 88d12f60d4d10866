# SPDX-License-Identifier: MIT
"""Random lines for the console, under the sanitizers (console_fuzz.c)."""

import os
import subprocess
from pathlib import Path

from passo.build import ENGINE
from passo.toolchain import environment, paths

SEED = os.environ.get("PASSO_SEED", "1")
SECONDS = os.environ.get("PASSO_FUZZ_SECONDS", "5")
FLAGS = "-std=c11 -O1 -g -Wall -Wextra -Wconversion -Werror -fsanitize=address,undefined"


def test_every_line_gets_one_answer(tmp_path: Path) -> None:
    """Whatever is typed, whatever the core does: one `ok` or `error:`, no undefined behaviour."""
    program = tmp_path / "fuzz"
    folders = [paths.model, paths.planner, paths.protocol, ENGINE]
    folders += [paths.stm32_bridge / "console", paths.driver]
    sources = [
        path for folder in folders for path in sorted(folder.glob("*.c")) if path.name != "passo_cpu.c"
    ]
    command = ["gcc", *FLAGS.split(), "-fno-sanitize-recover=all", *(f"-I{folder}" for folder in folders)]
    target = paths.tests / "console_fuzz.c"
    subprocess.run([*command, target, *sources, "-o", program], env=environment(), check=True)
    done = subprocess.run([program, SEED, SECONDS], capture_output=True, text=True, timeout=600)
    print(f"seed {SEED}, {SECONDS} s\n{done.stdout}")
    assert (done.returncode, done.stderr) == (0, "")
    answers = {kind: int(number) for kind, number in map(str.split, done.stdout.splitlines())}
    assert min(answers.values()) > 100
