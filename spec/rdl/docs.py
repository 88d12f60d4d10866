# SPDX-License-Identifier: MIT
"""The registers for people: docs/reference/registers.md."""

import re
from itertools import groupby

from rdl.constants import digits
from rdl.schema import GENERATED, Block, Enum, Field, Register, Source

ACCESS = {"r": "read", "w": "write", "rw": "read, write"}


def table(columns: list[str], rows: list[list[str]]) -> list[str]:
    return ["", *(f"| {' | '.join(row)} |" for row in [columns, ["---"] * len(columns), *rows])]


def first_sentence(text: str) -> str:
    return re.split(r"(?<=[^.]\.) ", text)[0]


def word_range(block: Block, register: Register) -> str:
    ends = sorted({register.word, register.word + (register.count or 1) - 1})
    return "`" + " .. ".join(f"0x{digits(word, block.address_bits)}" for word in ends) + "`"


def field_row(field: Field, enums: list[Enum]) -> list[str]:
    bits = f"{field.lsb + field.bits - 1}:{field.lsb}" if field.bits > 1 else f"{field.lsb}"
    reset = "" if field.reset is None else f"0x{field.reset:X}" if field.reset > 9 else f"{field.reset}"
    meaning = field.text
    for enum in enums:
        if enum.name == field.enum:
            values = ", ".join(f"{value} `{name}`" for name, value, _ in enum.members)
            title = f"{enum.name.capitalize()}s".replace("_", " ")
            meaning += f" [{title}](#{title.lower().replace(' ', '-')}): {values}."
    return [bits, f"`{field.name}`", ACCESS[field.access], reset, meaning]


def page(source: Source) -> str:
    """The same for people: an overview, then every field, then the enumerations."""
    core, enums = source.core, list(source.enums)
    overview, details = [], []
    for block in core.walk():
        level = block.name.lower()
        overview += ["", f"## {level.capitalize()} registers"]
        details += ["", f"## Fields of the {level} registers"]
        if block is not core:
            where = f"`0x{block.word:X} + 0x{block.stride:X} * n`"
            whose = "" if block in core.blocks else ", counted from the first word of its channel"
            overview += ["", f"{level.capitalize()} n = 0 .. {block.count - 1} begins at {where}{whose}."]
        rows = []
        for (title, text, fields), alike in groupby(block.registers, lambda r: (r.title, r.text, r.fields)):
            registers = list(alike)
            heading = ", ".join(register.name for register in registers)
            anchor = heading.lower().replace(", ", "-")
            for register in registers:
                where, link = word_range(block, register), f"[`{register.name}`](#{anchor})"
                rows.append([where, link, ACCESS[register.access], first_sentence(text)])
            details += ["", f"### {heading}", "", f"*{title}.* {text}"]
            field_rows = [field_row(field, enums) for field in reversed(fields)]
            details += table(["bits", "field", "access", "reset", "meaning"], field_rows)
        where = "address" if block is core else "offset"
        overview += table([where, "register", "access", "meaning"], rows)
    details += [
        "",
        "## Words",
        "",
        "The words of a frame other than the payload, and the first words of pushed lines and ramps.",
    ]
    for word in source.words:
        details += ["", f"### {word.title}", "", word.text]
        rows = [field_row(field, enums) for field in reversed(word.fields)]
        rows = [[bits, name, meaning] for bits, name, _, _, meaning in rows]
        details += table(["bits", "field", "meaning"], rows)
    for enum in enums:
        details += ["", f"## {enum.name.capitalize().replace('_', ' ')}s", "", enum.text]
        rows = [[f"{value}", f"`{name}`", text] for name, value, text in enum.members]
        details += table(["value", "name", "meaning"], rows)
    head = [
        "<!-- SPDX-License-Identifier: MIT -->",
        f"<!-- {GENERATED} -->",
        "",
        "# Registers",
        "",
        "A register is a 32-bit word; addresses count words. Unused bits read as 0 and must be written as 0.",
        "A field without a reset value reports a build parameter or a current state, or is not stored.",
        "[How Passo works](../architecture.md) explains their use and the link that carries them.",
    ]
    return "\n".join([*head, *overview, *details, ""])
