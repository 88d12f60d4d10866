# SPDX-License-Identifier: MIT
"""Shared by the generators: rows in columns; write the generated files, or compare them."""

import argparse
from collections.abc import Mapping
from pathlib import Path

from passo.output import write_text


def is_check(description: str) -> bool:
    """Parse the command line; True if the files are only to be compared (--check)."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--check", action="store_true", help="only list the files that are out of date")
    return parser.parse_args().check


def keep(root: Path, made: Mapping[str, str], check: bool) -> int:
    """Write the files below root that differ, or only list them; return the exit status."""
    stale = []
    for name, text in made.items():
        path = root / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            write_text(path, text)
    for name in stale:
        print(f"{name} is stale: run 'make generate'" if check else f"wrote {name}")
    return int(check and bool(stale))


def aligned(rows: list[tuple[str, ...]]) -> list[str]:
    """Join the cells of each row so that they stand below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [" ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
