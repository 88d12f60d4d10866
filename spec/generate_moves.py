# SPDX-License-Identifier: MIT
"""Generate the move forms in C, in Python and in the documentation from spec/moves.toml."""

import sys
from pathlib import Path

from generated import is_check, keep
from moves import c, docs, python
from moves.schema import SOURCE, SchemaError, read

ROOT = Path(__file__).resolve().parent.parent

OUTPUTS = {
    "c_model/protocol/passo_limits.h": c.limits,
    "c_model/planner/passo_moves.h": c.moves,
    "stm32_bridge/console/passo_form_tables.c": c.tables,
    "sim/passo/move_forms.py": python.module,
}
PAGES = ("docs/planning.md", "docs/console.md", "docs/scenes.md")


def main() -> int:
    """Write the files, or compare them."""
    check = is_check(f"Generate the move forms from {SOURCE}.")
    try:
        schema = read(ROOT)
        made = {name: write(schema) for name, write in OUTPUTS.items()}
        for name in PAGES:
            made[name] = docs.fill(schema, name, (ROOT / name).read_text(encoding="utf-8"))
    except SchemaError as error:
        print(f"{SOURCE}: {error}", file=sys.stderr)
        return 2
    return keep(ROOT, made, check)


if __name__ == "__main__":
    sys.exit(main())
