# SPDX-License-Identifier: MIT
"""The registers for people: docs/reference/registers.md."""

import re
from dataclasses import replace
from itertools import groupby

from rdl.constants import digits
from rdl.schema import GENERATED, Block, Enum, Field, Register, Source

ACCESS = {"r": "read", "w": "write", "rw": "read, write"}
BUSY = {
    "IDLE": "Refused with BUSY while a motion runs.",
    "QUIET": "Refused with BUSY unless the channel is quiet.",
}
KEPT = "Kept over a reset of the core."


def table(columns: list[str], rows: list[list[str]]) -> list[str]:
    return ["", *(f"| {' | '.join(row)} |" for row in [columns, ["---"] * len(columns), *rows])]


def first_sentence(text: str) -> str:
    return re.split(r"(?<=[^.]\.) ", text)[0]


def said(*sentences: str | bool | None) -> str:
    """Those that are not empty."""
    return " ".join(sentence for sentence in sentences if sentence)


def rules(register: Register) -> str:
    """What a register takes, as the source says beside its fields."""
    bad = ["0"] if register.nonzero else []
    if register.limit is not None:
        bad.append(f"above 0x{register.limit:X}")
    if register.special:
        bad.append(register.special)
    return said(
        register.part and f"Only with {register.part}.",
        register.pushed and "Takes only PUSH.",
        BUSY.get(register.needs),
        bad and f"Refused with BAD_VALUE if {' or '.join(bad)}.",
        register.survives_reset and KEPT,
    )


def word_range(block: Block, register: Register) -> str:
    ends = sorted({register.word, register.word + (register.count or 1) - 1})
    return "`" + " .. ".join(f"0x{digits(word, block.address_bits)}" for word in ends) + "`"


def field_row(field: Field, enums: list[Enum]) -> list[str]:
    bits = f"{field.lsb + field.bits - 1}:{field.lsb}" if field.bits > 1 else f"{field.lsb}"
    reset = "" if field.reset is None else f"0x{field.reset:X}" if field.reset > 9 else f"{field.reset}"
    meaning = said(field.text, BUSY.get(field.needs), field.survives_reset and KEPT)
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
        for _, alike in groupby(block.registers, lambda r: replace(r, name="", word=0)):
            registers = list(alike)
            register = registers[0]
            access = "push" if register.pushed else ACCESS[register.access]
            heading = ", ".join(register.name for register in registers)
            anchor = heading.lower().replace(", ", "-")
            for one in registers:
                where, link = word_range(block, one), f"[`{one.name}`](#{anchor})"
                rows.append([where, link, access, register.part, first_sentence(register.text)])
            details += [
                "",
                f"### {heading}",
                "",
                said(f"*{register.title}.*", register.text, rules(register)),
            ]
            field_rows = [field_row(field, enums) for field in reversed(register.fields)]
            details += table(["bits", "field", "access", "reset", "meaning"], field_rows)
        where = "address" if block is core else "offset"
        overview += table([where, "register", "access", "only with", "meaning"], rows)
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
        "A register is a 32-bit word; addresses count words. Unused bits read as 0; a write that sets one",
        "is refused with BAD_VALUE. A register that does not say otherwise may be written at any time.",
        "A field without a reset value reports a build parameter or a current state, or is not stored.",
        "[How Passo works](../architecture.md) explains their use and the link that carries them.",
    ]
    return "\n".join([*head, *overview, *details, ""])
