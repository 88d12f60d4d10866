# SPDX-License-Identifier: MIT
"""Fuzzes the G-code interpreter with libFuzzer, which looks for lines that reach new code.

python -m tests.helpers.gcode_guided_fuzz [SECONDS]: a finding is printed, and its program kept in the folder
of the last lines that it says. What has reached new code is in build/fuzz/gcode, and begins the next run.
"""

import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, wait
from pathlib import Path

from passo.cache import hash_of
from passo.compiler import compile_to, headers, includes, sources
from passo.console import progress
from passo.toolchain import paths

CLANG = "clang"
FOLDERS = (paths.gcode, paths.planner, paths.protocol)
FLAGS = (
    *("-std=c11", "-O1", "-g", "-Wall", "-Wextra", "-Werror"),
    *("-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all", *includes(*FOLDERS)),
)
KEPT = paths.build / "fuzz" / "gcode"
LONGEST = 2000  # bytes of a program
PATIENCE = 600  # s for a program, by the clock: of a machine that is busy with other work
MACHINE = b"\x62\xe0"  # of the examples: three axes, arcs within 4 um; seven inputs


def is_there() -> bool:
    """Whether Debian's clang is installed, with its library for fuzzing (`tools/setup.sh fuzz`)."""
    return shutil.which(CLANG) is not None


def program() -> Path:
    """The fuzzer."""
    main = paths.tests / "gcode_guided_fuzz.c"
    files = [main, *sources(*FOLDERS)]
    inputs = [*files, paths.tests / "gcode_checks.h", *headers(*FOLDERS)]
    made = paths.build / "fuzz" / f"gcode-{hash_of(inputs, FLAGS)}"
    return made if made.exists() else compile_to(made, *FLAGS, *files, compiler=(CLANG,))


def _words() -> str:
    """All commands and letters of the interpreter, as a dictionary of libFuzzer."""
    text = (paths.gcode / "passo_gcode_block.c").read_text(encoding="utf-8")
    g, m = text.split("M_CODES[] = {")
    commands = [
        f"{letter}{int(tenths) / 10:g}"
        for letter, table in (("G", g), ("M", m))
        for tenths in re.findall(r"\{(\d+), PASSO_GCODE_", table)
    ]
    return "\n".join(f'"{word}"' for word in [*commands, *"XYZABCDEFHIJKLNPQRST", "$J=", "(MSG,", "\\x0a"])


def fuzz(seconds: int, kept: Path) -> subprocess.CompletedProcess[str]:
    """Run it; programs that reach new code are added to `kept`."""
    kept.mkdir(parents=True, exist_ok=True)
    for example in sorted((paths.examples / "gcode").glob("*.n*c")):
        (kept / example.name).write_bytes(MACHINE + example.read_bytes()[:LONGEST])
    words = kept.with_suffix(".words")
    words.write_text(_words() + "\n", encoding="utf-8")
    found = kept.with_suffix(".found")
    found.mkdir(exist_ok=True)
    options = [f"-max_total_time={seconds}", f"-max_len={LONGEST}", f"-dict={words}"]
    options += [f"-artifact_prefix={found}/", "-print_final_stats=1", f"-timeout={PATIENCE}"]
    return subprocess.run([program(), kept, *options], capture_output=True, text=True)


def main() -> int:
    """The command."""
    seconds = int(sys.argv[1]) if len(sys.argv) > 1 else 3600
    began = time.monotonic()
    with ThreadPoolExecutor(1) as pool, progress("fuzzing", seconds) as report:
        running = pool.submit(fuzz, seconds, KEPT)
        while not wait([running], timeout=1).done:
            report(time.monotonic() - began)
    done = running.result()
    print("\n".join(done.stderr.splitlines()[-40:]))
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
