# SPDX-License-Identifier: MIT
"""The registers in C: constants, and the structs of words."""

from textwrap import wrap

from generated import aligned

from rdl.constants import constant_groups
from rdl.schema import GENERATED, Field, Register, Source


def constants(source: Source) -> str:
    lines = [
        "/* SPDX-License-Identifier: MIT",
        f" * {GENERATED}",
        " *",
        " * Registers of Passo. Addresses are word addresses.",
        " */",
        "#ifndef PASSO_REGISTERS_H",
        "#define PASSO_REGISTERS_H",
    ]
    for comment, constants in constant_groups(source):
        lines += ["", "/* " + "\n * ".join(wrap(comment, 105)) + " */"]
        lines += aligned([(f"#define PASSO_{c.name}", c.literal("0x") + "u") for c in constants])
    for enum in source.enums:
        last = enum.members[-1]
        rows = [
            (f"PASSO_{enum.name.upper()}_{m[0]}", f"= {m[1]}{',' if m != last else ''}", f"/* {m[2]} */")
            for m in enum.members
        ]
        lines += ["", f"/* {enum.text} */", f"enum passo_{enum.name} {{"]
        lines += [f"\t{row}" for row in aligned(rows)] + ["};"]
        names = wrap(", ".join(f'[{value}] = "{name}"' for name, value, _ in enum.members), 90)
        lines += [f"#define PASSO_{enum.name.upper()}_NAMES \\", "\t{" + " \\\n\t ".join(names) + "}"]
    return "\n".join([*lines, "", "#endif", ""])


def c_type(field: Field) -> str:
    if field.enum:
        return f"enum passo_{field.enum}"
    if field.bits == 1:
        return "bool"
    return f"uint{next(bits for bits in (8, 16, 32) if bits >= field.bits)}_t"


# Structs whose names the model has for something else.
C_STRUCTS = {"parameters": "parameters_word"}


def c_layout(name: str, register: Register) -> list[str]:
    """A struct of the fields of a word, and the functions between it and the word."""
    name = name.lower()
    struct = f"struct passo_{C_STRUCTS.get(name, name)}"
    fields = list(reversed(register.fields))
    rows = [(c_type(f), f"{f.name.lower()};", f"/* {f.text} */") for f in fields]
    packed, unpacked = [], []
    for f in fields:
        member, mask = f.name.lower(), f"0x{(1 << f.bits) - 1:X}u"
        place = f"(uint32_t)word->{member} & {mask}"
        packed.append(f"({place}) << {f.lsb}" if f.lsb else f"({place})")
        value = f"(word >> {f.lsb} & {mask})" if f.lsb else f"(word & {mask})"
        value = f"{value} != 0u" if f.bits == 1 else f"({c_type(f)}){value}"
        unpacked.append(f"\t    .{member} = {value},")
    return [
        "",
        f"/* {register.title}. {register.text} */",
        f"{struct} {{",
        *(f"\t{row}" for row in aligned(rows)),
        "};",
        "",
        f"static inline uint32_t passo_pack_{name}(const {struct} *word)",
        "{",
        "\treturn " + "\n\t     | ".join(packed) + ";",
        "}",
        "",
        f"static inline {struct} passo_unpack_{name}(uint32_t word)",
        "{",
        f"\treturn ({struct}){{",
        *unpacked,
        "\t};",
        "}",
    ]


def words(source: Source) -> str:
    lines = [
        "/* SPDX-License-Identifier: MIT",
        f" * {GENERATED}",
        " *",
        " * The fields of words: what a frame has beside its payload, what is pushed, some registers.",
        " * What does not fit into a field is cut off.",
        " */",
        "#ifndef PASSO_WORDS_H",
        "#define PASSO_WORDS_H",
        "",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "",
        '#include "passo_registers.h"',
    ]
    for name, register in source.layouts():
        lines += c_layout(name, register)
    return "\n".join([*lines, "", "#endif", ""])
