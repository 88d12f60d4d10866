# SPDX-License-Identifier: MIT
"""What the generators have in common: files that are written, or compared."""

import argparse
from collections.abc import Mapping
from pathlib import Path


def is_check(description: str) -> bool:
    """Read the command line: whether the files are only to be compared."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--check", action="store_true", help="only tell which files are not up to date")
    return parser.parse_args().check


def keep(root: Path, made: Mapping[str, str], check: bool) -> int:
    """Write the files below root that are not as they were made, or only tell of them; the exit status."""
    stale = []
    for name, text in made.items():
        path = root / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.write_text(text, encoding="utf-8")
    for name in stale:
        print(f"{name} is stale: run 'make generate'" if check else f"wrote {name}")
    return int(check and bool(stale))
