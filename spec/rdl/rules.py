# SPDX-License-Identifier: MIT
"""The rules of the registers, by which RTL and model judge each access: one row for each register.

They are those of a block: the core, a channel, an axis, an encoder. The modules that include them know where
the blocks are, and how many.
"""

from collections.abc import Iterator
from dataclasses import replace

from generated import aligned

from rdl.constants import digits
from rdl.schema import GENERATED, Block, Register, Source

AXES = 8  # words of an array of the axes; other arrays are shape tables


def _rows(block: Block) -> Iterator[tuple[str, Register]]:
    """Name of the address, and register."""
    for register in block.registers:
        if register.count in (None, AXES):
            _check(register)
            yield block.address_prefix + register.name, register


def _shape(core: Block) -> Register:
    """A point of any shape table."""
    first, *others = (register for register in core.registers if register.count not in (None, AXES))
    for other in others:
        if replace(other, name=first.name, word=first.word) != first:
            raise SystemExit(f"{other.name}: not as {first.name}, which is a shape table, too")
    return replace(first, count=None)


def _check(register: Register) -> None:
    """Refuse what the rules cannot say."""
    if register.limit is not None and register.limit & (register.limit - 1):
        raise SystemExit(f"{register.name}: a maximum is a power of 2")
    holes = ~register.defined & ((1 << register.defined.bit_length()) - 1)
    if holes and holes != 1 and not register.special:
        raise SystemExit(f"{register.name}: only bit 0 may be undefined below others")
    if register.needs == "IDLE":
        raise SystemExit(f"{register.name}: IDLE is what shape tables need, and single bits")


def _flags(register: Register) -> list[str]:
    """What the rule of a register says of it."""
    said = {
        "READ": "r" in register.access,
        "WRITE": "w" in register.access and not register.pushed,
        "PUSH": register.pushed,
        "QUIET": register.needs == "QUIET",
        "NONZERO": register.nonzero,
        "POWER": register.limit is not None,
        "EVEN": not register.special and register.defined and not register.defined & 1,
        "AXIS": register.count,
    }
    return [flag for flag, is_said in said.items() if is_said]


def _rule(register: Register) -> str:
    flags = [f"RULE_{flag}" for flag in _flags(register)]
    if "RULE_WRITE" in flags:
        flags.append(f"13'd{register.maximum.bit_length() - 1}")
    rule = " | ".join(flags)
    if register.part:
        rule = f"WITH_{register.part} & {f'({rule})' if len(flags) > 1 else rule}"
    return rule


def _is(address: str, register: Register, bits: int) -> str:
    if register.count:
        return f"address[{bits - 1}:3] == {address}_BASE[{bits - 1}:3]"
    return f"address == {address}" + ("[7:0]" if bits > 8 else "")


def verilog(source: Source) -> str:
    """rtl/passo_register_rules.vh"""
    lines = [
        "// SPDX-License-Identifier: MIT",
        f"// {GENERATED}",
        "// What each register takes, to be included in passo_rules. It is flags, and in its lower 5 bits",
        "// the highest bit that a word may have; without a flag there is no register.",
        "// Not a `case`: yosys would make a ROM of it, with registers of its own for the address.",
        "",
        f"localparam [12:0] RULE_SHAPE = {_rule(_shape(source.core))};",
    ]
    for block in source.core.walk():
        name, bits = f"{block.name.lower()}_rule", block.address_bits
        rows = aligned(
            [(f"{{13{{{_is(address, of, bits)}}}}}", f"& ({_rule(of)})") for address, of in _rows(block)]
        )
        lines += ["", f"function [12:0] {name}(input [{min(bits, 8) - 1}:0] address);"]
        lines += [f"  {name} =", f"    {rows[0]}", *(f"    | {row}" for row in rows[1:])]
        lines[-1] += ";"
        lines.append("endfunction")
    return "\n".join([*lines, ""])


def _members(register: Register) -> Iterator[str]:
    names = {"READ": "read", "WRITE": "write", "PUSH": "push", "QUIET": "needs_quiet", "NONZERO": "nonzero"}
    yield from (f".{names[flag]} = true" for flag in _flags(register) if flag in names)
    if register.count:
        yield ".per_axis = true"
    if register.part:
        yield f".part = PASSO_PART_{register.part}"
    if register.defined:
        yield f".defined = 0x{digits(register.defined, 32)}u"
        yield f".maximum = 0x{digits(register.maximum, 32)}u"


def _literal(register: Register) -> str:
    return f"(struct passo_rule){{{', '.join(_members(register))}}}"


def c(source: Source) -> str:
    """c_model/core/passo_register_rules.h"""
    lines = [
        "/* SPDX-License-Identifier: MIT",
        f" * {GENERATED}",
        " *",
        " * What each register takes.",
        " */",
        "#ifndef PASSO_REGISTER_RULES_H",
        "#define PASSO_REGISTER_RULES_H",
        "",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "",
        '#include "passo_registers.h"',
        "",
        "enum passo_part {",
        "\tPASSO_PART_NONE,",
        ",\n".join(f"\tPASSO_PART_{part}" for part in source.parts()),
        "};",
        "",
        "struct passo_rule {",
        "\tbool read, write, push; /* none: there is no such register */",
        "\tbool per_axis;          /* a word for each axis */",
        "\tbool needs_quiet;       /* the channel, for a write */",
        "\tenum passo_part part;   /* it exists only with this */",
        "\tbool nonzero;           /* what may be written */",
        "\tuint32_t defined, maximum;",
        "};",
        "",
        "static inline struct passo_rule passo_shape_rule(void)",
        "{",
        f"\treturn {_literal(_shape(source.core))};",
        "}",
    ]
    for block in source.core.walk():
        name = f"passo_{block.name.lower()}_rule"
        lines += [
            "",
            f"static inline struct passo_rule {name}(unsigned address)",
            "{",
            "\tswitch (address) {",
        ]
        for address, register in _rows(block):
            if register.count:
                lines += [f"\tcase PASSO_{address}_BASE + {n}u:" for n in range(AXES)]
            else:
                lines.append(f"\tcase PASSO_{address}:")
            lines.append(f"\t\treturn {_literal(register)};")
        lines += ["\tdefault:", "\t\treturn (struct passo_rule){0};", "\t}", "}"]
    return "\n".join([*lines, "", "#endif", ""])
