# SPDX-License-Identifier: MIT
"""The registers in Verilog."""

from textwrap import wrap

from generated import aligned

from rdl.constants import constant_groups
from rdl.schema import GENERATED, Source


def constants(source: Source) -> str:
    lines = [
        "// SPDX-License-Identifier: MIT",
        f"// {GENERATED}",
        "// Registers of Passo, to be included inside a module. Addresses are word addresses.",
        "",
        "// Each module uses its share of these.",
        "/* verilator lint_off UNUSEDPARAM */",
    ]
    for comment, constants in constant_groups(source):
        lines += ["", *(f"// {line}" for line in wrap(comment, 105))]
        rows = [(f"localparam {c.name}", "= " + c.literal(f"{c.bits}'h") + ";") for c in constants]
        lines += aligned(rows)
    for enum in source.enums:
        lines += ["", f"// {enum.text}"]
        rows = [
            (f"localparam {enum.name.upper()}_{name}", f"= {enum.bits}'d{value};", f"// {text}")
            for name, value, text in enum.members
        ]
        lines += aligned(rows)
    return "\n".join([*lines, "", "/* verilator lint_on UNUSEDPARAM */", ""])
