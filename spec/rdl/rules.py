# SPDX-License-Identifier: MIT
"""The rules of the registers, by which RTL and model judge each access: one row for each register.

Of a block, as the source has them: the core, a channel, an axis, an encoder. The modules around them know where
the blocks are, and how many.
"""

from collections.abc import Iterator
from dataclasses import replace

from generated import aligned

from rdl.constants import digits
from rdl.schema import GENERATED, Block, Register, Source

AXES = 8  # of an array with a word for each axis


def _rows(block: Block) -> Iterator[tuple[str, Register]]:
    """Name of the address, and register. Shape tables are no row."""
    for register in block.registers:
        if register.count in (None, AXES):
            yield block.address_prefix + register.name, register


def _shape(core: Block) -> Register:
    """A point of any shape table."""
    first, *others = (register for register in core.registers if register.count not in (None, AXES))
    for other in others:
        if replace(other, name=first.name, word=first.word) != first:
            raise ValueError(f"{other.name}: an array of the core with other rules than {first.name}")
    return first


def _check(block: Block, register: Register) -> None:
    """ValueError for what the rules cannot say."""
    holes = register.maximum & ~register.defined or register.defined & (register.defined + 1)
    if register.limit is not None and register.limit & (register.limit - 1):
        raise ValueError(f"{register.name}: a maximum is a power of 2")
    if holes and not register.special and register.defined + 2 != 1 << register.highest_bit + 1:
        raise ValueError(f"{register.name}: of its undefined bits only bit 0 may be below others")
    if register.needs == "IDLE" and register.count in (None, AXES):
        raise ValueError(f"{register.name}: only shape tables need no more than idle channels")


def _flags(register: Register) -> list[str]:
    """What the rule of a register says of it."""
    flags = ["READ"] if "r" in register.access else []
    if "w" in register.access:
        flags.append("PUSH" if register.pushed else "WRITE")
    if register.count:
        flags.append("AXIS")
    if register.needs == "QUIET":
        flags.append("QUIET")
    if register.nonzero:
        flags.append("NONZERO")
    if register.defined and not register.special and register.lowest_bit == 1:
        flags.append("EVEN")
    if register.limit is not None:
        flags.append("POWER")
    return flags


def verilog(source: Source) -> str:
    """rtl/passo_register_rules.vh"""
    lines = [
        "// SPDX-License-Identifier: MIT",
        f"// {GENERATED}",
        "// What each register takes, to be included in passo_rules: a rule is the flags RULE_..., and in its lower 5 bits",
        "// the highest bit that a word may have. A rule of 0: there is no such register.",
        "",
        f"localparam [12:0] RULE_SHAPE = {_rule(replace(_shape(source.core), count=None))};",
    ]
    for block in source.core.walk():
        name, bits = f"{block.name.lower()}_rule", block.address_bits
        rows = []
        for address, register in _rows(block):
            _check(block, register)
            rows.append((_case(address, register, bits), f"{name} = {_rule(register)};"))
        read = "{4'd0, address}" if block is source.core else "address"
        lines += ["", f"function [12:0] {name}(input [{min(bits, 8) - 1}:0] address);", f"  casez ({read})"]
        lines += [f"    {row}" for row in aligned([*rows, ("default:", f"{name} = 13'd0;")])]
        lines += ["  endcase", "endfunction"]
    return "\n".join([*lines, ""])


def _rule(register: Register) -> str:
    flags = [f"RULE_{flag}" for flag in _flags(register)]
    if "WRITE" in _flags(register):
        flags.append(f"13'd{register.highest_bit}")
    rule = " | ".join(flags)
    if not register.part:
        return rule
    return f"WITH_{register.part} & " + (f"({rule})" if len(flags) > 1 else rule)


def _case(address: str, register: Register, bits: int) -> str:
    if not register.count:
        return f"{address}:"
    low = (AXES - 1).bit_length()
    return f"{{{address}_BASE[{bits - 1}:{low}], {low}'b???}}:"


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
        "enum passo_part { PASSO_PART_NONE, PASSO_PART_INPUTS, PASSO_PART_ENCODERS, PASSO_PART_OUTPUTS };",
        "",
        "struct passo_rule {",
        "\tbool read, write, push; /* none: there is no such register */",
        "\tbool per_axis; /* a word for each axis */",
        "\tbool needs_quiet; /* a quiet channel, for a write */",
        "\tenum passo_part part; /* it is there only with it */",
        "\tbool nonzero; /* what may be written */",
        "\tuint32_t defined, maximum;",
        "};",
        "",
        "static inline struct passo_rule passo_shape_rule(void)",
        "{",
        f"\treturn (struct passo_rule){{{', '.join(_members(replace(_shape(source.core), count=None)))}}};",
        "}",
    ]
    for block in source.core.walk():
        lines += [
            "",
            f"static inline struct passo_rule passo_{block.name.lower()}_rule(unsigned address)",
            "{",
        ]
        lines.append("\tswitch (address) {")
        for address, register in _rows(block):
            if register.count:
                lines += [f"\tcase PASSO_{address}_BASE + {n}u:" for n in range(register.count)]
            else:
                lines.append(f"\tcase PASSO_{address}:")
            lines.append(f"\t\treturn (struct passo_rule){{{', '.join(_members(register))}}};")
        lines += ["\tdefault:", "\t\treturn (struct passo_rule){0};", "\t}", "}"]
    return "\n".join([*lines, "", "#endif", ""])


def _members(register: Register) -> Iterator[str]:
    flags = _flags(register)
    yield from (f".{flag.lower()} = true" for flag in flags if flag in ("READ", "WRITE", "PUSH", "NONZERO"))
    if register.count:
        yield ".per_axis = true"
    if "QUIET" in flags:
        yield ".needs_quiet = true"
    if register.part:
        yield f".part = PASSO_PART_{register.part}"
    if register.defined:
        yield f".defined = 0x{digits(register.defined, 32)}u"
        yield f".maximum = 0x{digits(register.maximum, 32)}u"
