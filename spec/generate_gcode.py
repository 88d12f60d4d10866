# SPDX-License-Identifier: MIT
"""Generate the page of differences in the meaning of G-code from spec/gcode_differences.toml."""

import sys
import tomllib
from pathlib import Path

from generated import is_check, keep

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "spec" / "gcode_differences.toml"
PAGE = "docs/reference/gcode_differences.md"
HEAD = """# G-code: differences

Generated from `spec/gcode_differences.toml` by `spec/generate_gcode.py`.

What the last line of each program does on Passo, grbl 1.1 and LinuxCNC 2.9. `same`: as on Passo; `other`:
moves, but elsewhere or at another feed; a number is the [error](../gcode.md#errors). `make gcode-peer`
compares Passo and LinuxCNC.

| program | Passo | grbl 1.1 | LinuxCNC | |
|---|---|---|---|---|
"""


def write_page() -> str:
    """A row for each program."""
    rows = tomllib.loads(SOURCE.read_text(encoding="utf-8"))["rows"]
    lines = [(" ".join(f"`{line}`" for line in program), *told) for program, *told in rows]
    return HEAD + "".join(f"| {' | '.join(row)} |\n" for row in lines)


if __name__ == "__main__":
    sys.exit(keep(ROOT, {PAGE: write_page()}, is_check(__doc__)))
