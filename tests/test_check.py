# SPDX-License-Identifier: MIT
"""What a failed check of `make lint` says: the file to look at first."""

import subprocess
import sys

import pytest
from passo.toolchain import paths

CHECK = paths.tools / "check.py"

SAID = {
    "verilator": ("%Warning-WIDTH: rtl/passo_crc.v:12:8: too wide", "rtl/passo_crc.v:12"),
    "slang": ("  rtl/passo_crc.v:7:3: error: use of undeclared identifier", "rtl/passo_crc.v:7"),
    "surelog": ("[ERROR  :CP0310] /gone/passo_crc.v:9:1: rtl/passo_dda.v:9:1: lost", "rtl/passo_dda.v:9"),
    "ruff": ("Would reformat: tools/check.py", "tools/check.py"),
    "verible": ("rtl/passo_crc.v: Needs formatting.", "rtl/passo_crc.v"),
    "clang": (
        "c_model/core/passo_core.c:3:1: error: code should be clang-formatted",
        "c_model/core/passo_core.c:3",
    ),
    "prose": ("a version 1.5 of nothing\ndocs/path.md:12: 'wrong'\ndocs/gcode.md:1: x", "docs/path.md:12"),
}


def check(code: str) -> subprocess.CompletedProcess[str]:
    command = (sys.executable, CHECK, "--hint", "do this", "name", sys.executable, "-c", code)
    return subprocess.run(command, cwd=paths.root, capture_output=True, text=True)


@pytest.mark.parametrize("tool", SAID)
def test_a_failed_check_names_the_first_file(tool: str) -> None:
    text, file = SAID[tool]
    done = check(f"print({text!r}); raise SystemExit(3)")
    assert done.returncode == 3 and done.stdout == f"[  0:00] lint: name\n{text}\n"
    assert done.stderr == f"name failed; look first at {file}; do this\n"


def test_a_good_check_is_silent() -> None:
    done = check("print('rtl/passo_crc.v:1: all is well')")
    assert done.returncode == 0 and not done.stderr


def test_a_check_without_a_file() -> None:
    assert check("raise SystemExit('no compiler')").stderr == "name failed; do this\n"
