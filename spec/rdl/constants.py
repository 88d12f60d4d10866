# SPDX-License-Identifier: MIT
"""The constants of the register definitions, the same in all languages; see spec/generate_registers.py."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from passo import register_table

from rdl.schema import Block, Field, Register, Source


@dataclass(frozen=True)
class Constant:
    """A number with a name; without a width it is a count of something, otherwise bits in hardware."""

    name: str
    value: int
    bits: int | None = None

    def literal(self, hexadecimal_prefix: str) -> str:
        return hexadecimal_prefix + digits(self.value, self.bits) if self.bits else str(self.value)


def digits(value: int, bits: int) -> str:
    """The hexadecimal digits of a value of `bits` bits."""
    return f"{value:0{(bits + 3) // 4}X}"


def field_name(block: Block, register: Register, field: Field) -> str:
    alone = len(register.fields) == 1 and field.name == register.name
    return block.field_prefix + (register.name if alone else f"{register.name}_{field.name}")


def register_constants(block: Block, register: Register) -> Iterator[Constant]:
    address = block.address_prefix + register.name
    if register.count:
        yield Constant(f"{address}_BASE", register.word, block.address_bits)
        yield Constant(f"{address}_COUNT", register.count)
    else:
        yield Constant(address, register.word, block.address_bits)
    for field in register.fields:
        yield from field_constants(field_name(block, register, field), field)
    if register.defined:
        yield Constant(f"{block.field_prefix}{register.name}_DEFINED", register.defined, 32)


def block_constants(outer: Block, block: Block) -> Iterator[Constant]:
    name = outer.address_prefix + block.name
    yield Constant(f"{name}_BASE", block.word, outer.address_bits)
    yield Constant(f"{name}_COUNT", block.count)
    yield Constant(f"{name}_STRIDE", block.stride, outer.address_bits)


def field_constants(name: str, field: Field) -> Iterator[Constant]:
    yield Constant(f"{name}_LSB", field.lsb)
    yield Constant(f"{name}_BITS", field.bits)
    if field.reset is not None:
        yield Constant(f"{name}_RESET", field.reset, field.bits)


def constant_groups(source: Source) -> list[tuple[str, list[Constant]]]:
    """All constants in groups, each with a comment."""
    core = source.core
    groups = []
    for word in source.words:
        fields = [field_constants(f"{word.name}_{field.name}", field) for field in word.fields]
        constants = [constant for of_field in fields for constant in of_field]
        constants.append(Constant(f"{word.name}_DEFINED", register_table.bits_of(word.fields), 32))
        groups.append((f"Word: {word.title}. {word.text}", constants))
    for block in core.walk():
        level = block.name.capitalize()
        for register in block.registers:
            comment = f"{level}: {register.title}. {register.text}"
            groups.append((comment, list(register_constants(block, register))))
        for inner in block.blocks:
            comment = f"{level}: where each {inner.name.lower()} has its registers."
            groups.append((comment, list(block_constants(block, inner))))
    count = Counter(constant.name for _, constants in groups for constant in constants)
    if clashes := [name for name, times in count.items() if times > 1]:
        raise ValueError(f"more than one meaning: {', '.join(clashes)}")
    return groups
