# SPDX-License-Identifier: MIT
"""The registers in Python: enumerations, classes of words, constants, the table of all registers."""

import re
from collections.abc import Sequence
from textwrap import wrap

from rdl.constants import constant_groups, digits
from rdl.schema import GENERATED, Block, Enum, Field, Register, Source

HEAD = f"""\
# SPDX-License-Identifier: MIT
# {GENERATED}
\"\"\"Registers of Passo: word addresses, fields, reset values, enumerations.\"\"\"

from dataclasses import dataclass
from typing import ClassVar

from passo.register_table import Field, Register
from passo.register_word import DescribedEnum, Word
"""


def _table(core: Block) -> list[str]:
    """All registers of all blocks."""
    lines = ["", "# All registers, once each.", "# fmt: off", "TABLE = ("]
    for block in core.walk():
        for register in block.registers:
            name, word = block.field_prefix + register.name, digits(register.word, block.address_bits)
            lines.append(f'    Register("{name}", "{block.name}", 0x{word}, {register.count or 1}, (')
            for field in register.fields:
                reset = None if field.reset is None else f"0x{digits(field.reset, field.bits)}"
                arguments = f'"{field.name}", {field.lsb}, {field.bits}, "{field.access}", {reset}'
                lines.append(f"        Field({arguments}),")
            part = re.match(r"Only with (INPUTS|ENCODERS|OUTPUTS)\.", register.text)
            lines.append(f'    ), "{part[1].lower()}"),' if part else "    )),")
    return [*lines, ")", "# fmt: on"]


def _type(field: Field) -> str:
    return _class_name(field.enum) if field.enum else "bool" if field.bits == 1 else "int"


def _default(field: Field, enums: Sequence[Enum]) -> str:
    """The reset value as a default, if there is one."""
    if field.reset is None:
        return ""
    for enum in enums:
        if enum.name == field.enum:
            (name,) = (name for name, value, _ in enum.members if value == field.reset)
            return f" = {_type(field)}.{name}"
    return f" = {bool(field.reset) if field.bits == 1 else field.reset}"


def _layout(name: str, register: Register, enums: Sequence[Enum]) -> list[str]:
    """A class of the fields of a word; those with a reset value need not be given."""
    fields = sorted(reversed(register.fields), key=lambda field: field.reset is not None)
    lines = ["", "@dataclass(frozen=True)", f"class {_class_name(name)}Word(Word):"]
    lines += [f'    """{register.title}."""', ""]
    for field in fields:
        lines += [f"    # {line}" for line in wrap(field.text, 104)]
        lines.append(f"    {field.name.lower()}: {_type(field)}{_default(field, enums)}")
    lines += ["", "    PLACES: ClassVar = {"]
    lines += [f'        "{f.name.lower()}": ({f.lsb}, {f.bits}, {_type(f)}),' for f in register.fields]
    return [*lines, "    }", ""]


def _class_name(name: str) -> str:
    """Of a word or an enumeration."""
    return name.title().replace("_", "")


def module(source: Source) -> str:
    lines = [HEAD]
    for enum in source.enums:
        lines += ["", f"class {_class_name(enum.name)}(DescribedEnum):", f'    """{enum.text}"""', ""]
        lines += [f'    {name} = {value}, "{text}"' for name, value, text in enum.members] + [""]
    for name, register in source.layouts():
        lines += _layout(name, register, source.enums)
    for comment, constants in constant_groups(source):
        lines += ["", *(f"# {line}" for line in wrap(comment, 105))]
        lines += [f"{c.name} = {c.literal('0x')}" for c in constants]
    lines += _table(source.core)
    return "\n".join([*lines, ""])
