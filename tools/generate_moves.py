# SPDX-License-Identifier: MIT
"""Generate the forms of a move, in C, in Python and in the documentation, from schema/moves.toml."""

import argparse
import sys
from pathlib import Path

from moves import c, docs, python
from moves.schema import SOURCE, SchemaError, read

ROOT = Path(__file__).resolve().parent.parent

OUTPUTS = {
    "protocol/passo_limits.h": c.limits,
    "planner/passo_moves.h": c.moves,
    "stm32_bridge/console/passo_form_tables.c": c.tables,
    "sim/passo/move_forms.py": python.module,
}
PAGES = ("docs/planning.md", "docs/console.md")


def main() -> int:
    """Write the files, or compare them."""
    parser = argparse.ArgumentParser(description=f"Generate the forms of a move from {SOURCE}.")
    parser.add_argument("--check", action="store_true", help="only tell which files are not up to date")
    check = parser.parse_args().check

    try:
        schema = read(ROOT)
        made = {name: write(schema) for name, write in OUTPUTS.items()}
        for name in PAGES:
            made[name] = docs.fill(schema, name, (ROOT / name).read_text(encoding="utf-8"))
    except SchemaError as error:
        print(f"{SOURCE}: {error}", file=sys.stderr)
        return 2
    stale = []
    for name, text in made.items():
        path = ROOT / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.write_text(text, encoding="utf-8")
    for name in stale:
        print(f"{name} is stale: run 'make generate'" if check else f"wrote {name}")
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main())
