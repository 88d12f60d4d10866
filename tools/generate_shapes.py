# SPDX-License-Identifier: MIT
"""Generate the pulse shapes: rtl/passo_shapes.vh, protocol/passo_shapes.h and protocol/passo_shapes.c.

A bank has 256 points, point k being shape(k / 256) * 65536 to the nearest integer; point 256, always
65536, is not stored. The values come from 50-digit decimals, so they are the same on every machine.
With ``--check`` nothing is written; the exit status is 1 if a committed file differs from what would be.
"""

import argparse
import sys
import tomllib
from collections.abc import Callable
from decimal import ROUND_HALF_EVEN, Decimal, localcontext
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

POINTS = 256
ONE = 1 << 16
DIGITS = 50
# The sigmoid shape is the logistic function over -a .. a.
MOVES = tomllib.loads((ROOT / "schema" / "moves.toml").read_text(encoding="utf-8"))
SIGMOID_A = MOVES["constants"]["alpha_reset"]["value"]

# 60 digits of pi.
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")


def _cos(x: Decimal) -> Decimal:
    """Return the cosine of ``x`` from its power series, good for 0 .. pi."""
    total = term = Decimal(1)
    n = 0
    while abs(term) > Decimal(10) ** -DIGITS:
        term *= -x * x / ((n + 1) * (n + 2))
        total += term
        n += 2
    return total


def _logistic(x: Decimal) -> Decimal:
    return 1 / (1 + (-x).exp())


def cosine(u: Decimal) -> Decimal:
    """(1 - cos(pi u)) / 2"""
    return (1 - _cos(PI * u)) / 2


def sigmoid(u: Decimal) -> Decimal:
    """Return the logistic function over -a .. a, scaled to start at 0 and end at 1."""
    low, high = _logistic(Decimal(-SIGMOID_A)), _logistic(Decimal(SIGMOID_A))
    return (_logistic(SIGMOID_A * (2 * u - 1)) - low) / (high - low)


def ease(u: Decimal) -> Decimal:
    """u^2"""
    return u * u


def points(shape: Callable[[Decimal], Decimal]) -> list[int]:
    """Return the 256 stored points of a shape."""
    with localcontext() as context:
        context.prec = DIGITS + 10
        values = [shape(Decimal(k) / POINTS) * ONE for k in range(POINTS)]
        return [int(value.to_integral_value(ROUND_HALF_EVEN)) for value in values]


def banks() -> dict[str, list[int]]:
    """Return banks 1, 2 and 3, in this order, by name."""
    result = {"cosine": points(cosine), "sigmoid": points(sigmoid), "ease": points(ease)}

    for name, table in result.items():
        whole = [*table, ONE]
        assert whole[0] == 0 and all(low <= high for low, high in pairwise(whole)) and table[-1] < ONE, name
        # What makes a ramp of these two shapes cover exactly the mean of its ends.
        if name != "ease":
            assert all(whole[k] + whole[POINTS - k] == ONE for k in range(POINTS + 1)), name
    assert result["ease"] == [k * k for k in range(POINTS)]
    return result


def _rows(items: list[str], per_row: int, indent: str) -> list[str]:
    return [indent + " ".join(items[i : i + per_row]) for i in range(0, len(items), per_row)]


def verilog() -> str:
    """Return the text of rtl/passo_shapes.vh."""
    lines = [
        "// SPDX-License-Identifier: MIT",
        "// Pulse shapes, 256 points each, bank 1 first; bank 0, linear, needs no table.",
        "// Made by tools/generate_shapes.py; to be included where `points` is declared.",
        "",
        "initial begin",
    ]
    for bank, (name, table) in enumerate(banks().items(), start=1):
        lines.append(f"  // {bank}: {name}")
        first = (bank - 1) * POINTS
        cells = [f"points[10'h{first + k:03x}] = 16'h{value:04x};" for k, value in enumerate(table)]
        lines += _rows(cells, 4, "  ")
    lines.append("end")
    return "\n".join(lines) + "\n"


def c_header() -> str:
    """Return the text of protocol/passo_shapes.h."""
    names = banks()
    return f"""\
/* SPDX-License-Identifier: MIT
 * Pulse shapes as the core has them after reset. Made by tools/generate_shapes.py.
 */
#ifndef PASSO_SHAPES_H
#define PASSO_SHAPES_H

#include <stdint.h>

#define PASSO_BANKS {len(names)}u
#define PASSO_BANK_POINTS {POINTS}u

/* Banks 1 to {len(names)}: {", ".join(names)}.
 * Point k is shape(k / 256) * 65536; point 256 is always 65536. */
extern const uint16_t passo_shapes[PASSO_BANKS][PASSO_BANK_POINTS];
/* Where their points are written. */
extern const uint16_t passo_shape_addresses[PASSO_BANKS];

/* The bank that has a point at an address, 1 to {len(names)}, or 0. */
unsigned passo_bank_at(uint32_t address);

#endif
"""


BANK_AT = """\
unsigned passo_bank_at(uint32_t address)
{
	for (unsigned bank = 1; bank <= PASSO_BANKS; bank++)
		if (address - passo_shape_addresses[bank - 1u] < PASSO_BANK_POINTS)
			return bank;
	return 0;
}""".splitlines()


def c_source() -> str:
    """Return the text of protocol/passo_shapes.c."""
    lines = [
        "/* SPDX-License-Identifier: MIT",
        " * Pulse shapes as the core has them after reset. Made by tools/generate_shapes.py.",
        " */",
        '#include "passo_shapes.h"',
        "",
        '#include "passo_registers.h"',
        "",
        "const uint16_t passo_shapes[PASSO_BANKS][PASSO_BANK_POINTS] = {",
    ]
    for name, table in banks().items():
        lines.append(f"\t{{ /* {name} */")
        lines += _rows([f"{value:5}," for value in table], 12, "\t\t")
        lines.append("\t},")
    lines += ["};", "", "const uint16_t passo_shape_addresses[PASSO_BANKS] = {"]
    lines += [f"\tPASSO_ADDRESS_{name.upper()}_BASE," for name in banks()]
    lines += ["};", "", *BANK_AT]
    return "\n".join(lines) + "\n"


def files() -> dict[Path, str]:
    """Return every generated file with its text."""
    return {
        ROOT / "rtl" / "passo_shapes.vh": verilog(),
        ROOT / "protocol" / "passo_shapes.h": c_header(),
        ROOT / "protocol" / "passo_shapes.c": c_source(),
    }


def main() -> int:
    """Write the files, or compare them."""
    parser = argparse.ArgumentParser(description="Generate the pulse shapes of RTL and C model.")
    parser.add_argument("--check", action="store_true", help="write nothing, fail if a file is out of date")
    check = parser.parse_args().check

    stale = 0
    for path, text in files().items():
        if path.exists() and path.read_text() == text:
            continue
        if check:
            print(f"{path.relative_to(ROOT)} is out of date: run 'make generate'", file=sys.stderr)
            stale += 1
        else:
            path.write_text(text)
            print(f"wrote {path.relative_to(ROOT)}")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
