# SPDX-License-Identifier: MIT
"""The registers in Python: enumerations, classes of words, constants, the table of all registers."""

from collections.abc import Sequence
from textwrap import wrap

from rdl.constants import constant_groups, digits
from rdl.schema import GENERATED, Block, Enum, Field, Register, Source

HEAD = f"""\
# SPDX-License-Identifier: MIT
# {GENERATED}
# fmt: off
# ruff: noqa: E501, RUF009
\"\"\"Registers of Passo: word addresses, fields, reset values, enumerations.\"\"\"

from dataclasses import dataclass

from passo.register_table import Field, Register
from passo.register_word import DescribedEnum, Word, bits
"""


def _table(core: Block) -> list[str]:
    """All registers of all blocks."""
    lines = ["", "# All registers, once each.", "TABLE = ("]
    for block in core.walk():
        for register in block.registers:
            name, word = block.field_prefix + register.name, digits(register.word, block.address_bits)
            fields = f"{_class_name(name)}Word.places()"
            if len(register.fields) == 1:
                (field,) = register.fields
                reset = None if field.reset is None else f"0x{digits(field.reset, field.bits)}"
                fields = f'(Field("{field.name}", {field.lsb}, {field.bits}, "{field.access}", {reset}),)'
            part = f', "{register.part.lower()}"' if register.part else ""
            count = register.count or 1
            lines.append(f'    Register("{name}", "{block.name}", 0x{word}, {count}, {fields}{part}),')
    return [*lines, ")"]


def _type(field: Field) -> str:
    return _class_name(field.enum) if field.enum else "bool" if field.bits == 1 else "int"


def _default(field: Field, enums: Sequence[Enum]) -> str:
    """The reset value as a default, if there is one."""
    if field.reset is None:
        return ""
    for enum in enums:
        if enum.name == field.enum:
            (name,) = (name for name, value, _ in enum.members if value == field.reset)
            return f"{_type(field)}.{name}"
    return f"{bool(field.reset) if field.bits == 1 else field.reset}"


def _layout(name: str, register: Register, enums: Sequence[Enum]) -> list[str]:
    """A class of the fields of a word; those with a reset value need not be given."""
    fields = sorted(reversed(register.fields), key=lambda field: field.reset is not None)
    lines = ["", "@dataclass(frozen=True)", f"class {_class_name(name)}Word(Word):"]
    lines += [f'    """{register.title}."""', ""]
    for f in fields:
        default = _default(f, enums)
        place = f'{f.lsb}, {f.bits}, "{f.access}"{default and f", {default}"}'
        lines.append(f"    {f.name.lower()}: {_type(f)} = bits({place})  # {f.text}")
    return [*lines, ""]


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
