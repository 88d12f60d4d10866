# SPDX-License-Identifier: MIT
"""Run a check of `make lint`; if it fails, tell which file to look at first.

    tools/check.py [--hint TEXT] NAME COMMAND [ARGUMENT ...]

The file is the first one that the output names and that exists, with its line. The exit status is that of the
command.
"""

import argparse
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from passo.console import stages

PLACE = re.compile(r"(?<![\w./-])((?:/|\w|\.{1,2}/)[\w./-]*\.\w+|Makefile)(?::(\d+))?")


def first_file(lines: Iterable[str]) -> str:
    """The first file that lines of output name, as FILE:LINE, FILE, or "" if there is none."""
    for line in lines:
        for path, number in PLACE.findall(line):
            if Path(path).is_file():
                return f"{path}:{number}" if number else path
    return ""


def main() -> int:
    """Of the command."""
    parser = argparse.ArgumentParser(description="Run a check.")
    parser.add_argument("--hint", default="", help="what to do, if it fails")
    parser.add_argument("name")
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    tell = stages()
    tell(f"lint: {options.name}")
    said = []
    with subprocess.Popen(
        options.command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    ) as process:
        for line in process.stdout or ():
            print(line, end="", flush=True)
            said.append(line)
    tell.end()
    if process.returncode:
        file = first_file(said)
        told = [f"{options.name} failed", f"look first at {file}" if file else "", options.hint]
        print("; ".join(filter(None, told)), file=sys.stderr)
    return process.returncode


if __name__ == "__main__":
    sys.exit(main())
