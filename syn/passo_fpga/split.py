# SPDX-License-Identifier: MIT
"""Size of each module, from a synthesis that keeps the hierarchy."""

import json
import re
from collections import Counter
from typing import Any

from passo_fpga.design import Design
from passo_fpga.flow import CELLS, count, synthesize

# Yosys names a module with parameters $paramod$HASH\name or $paramod\name\PARAMETER=...
_PLAIN = re.compile(r"^\$paramod(?:\$[0-9a-f]+)?\\([^\\]+)(?:\\.*)?$")


def split(design: Design) -> list[dict[str, Any]]:
    """Cells of all instances of each module, without their submodules; largest first."""
    modules = json.loads((synthesize(design) / CELLS).read_text(encoding="utf-8"))["modules"]
    inside = {name.lstrip("\\"): facts["num_cells_by_type"] for name, facts in modules.items()}
    instances: Counter[str] = Counter()

    def visit(name: str, times: int) -> None:
        instances[name] += times
        for cell, number in inside[name].items():
            if cell.lstrip("\\") in inside:
                visit(cell.lstrip("\\"), times * number)

    visit(design.top, 1)
    rows: dict[str, Counter[str]] = {}
    for name, times in instances.items():
        row = rows.setdefault(_plain(name), Counter())
        row["instances"] += times
        for column, number in count(design.device, inside[name]).items():
            row[column] += times * number
    found = [{"module": name, **row} for name, row in rows.items()]
    return sorted(found, key=lambda row: -row["LUT"])


def difference(small: list[dict[str, Any]], large: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What a larger design has more of each module; the largest first, without modules it has no more of."""
    before = {row["module"]: _counts(row) for row in small}
    more = []
    for row in large:
        counts = _counts(row)
        counts.subtract(before.get(row["module"], Counter()))
        more.append({"module": row["module"], **counts})
    return sorted((row for row in more if row["instances"]), key=lambda row: -row["LUT"])


def _counts(row: dict[str, Any]) -> Counter[str]:
    return Counter({column: number for column, number in row.items() if column != "module"})


def _plain(name: str) -> str:
    found = _PLAIN.match(name)
    return found.group(1) if found else name
