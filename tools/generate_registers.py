# SPDX-License-Identifier: MIT
"""Generate the register definitions of RTL, C and Python and their documentation from registers/passo.rdl.

Names are the same in all languages; C puts PASSO_ in front:

    ADDRESS_RUN             word address of a register of the core
    CHANNEL_ROOM            word offset of a register in its channel
    AXIS_PINS               word offset of a register in its axis
    ..._BASE, _COUNT        first word and length of an array; arrays of blocks also have a _STRIDE
    RUN_WAIT_SYNC_LSB       lowest bit of the field WAIT_SYNC of RUN; _BITS: width, _RESET: reset value
    CHANNEL_ROOM_..._LSB    the same for the field of a channel's register
    RUN_DEFINED             the bits of a register that may be written
    VERDICT_OK              an enumeration's value; Verdict.OK in Python

A field that is alone in its register and has its name does not repeat it: CHANNEL_RATE_TARGET_LSB.
"""

import argparse
import re
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from textwrap import wrap

from systemrdl import RDLCompiler
from systemrdl.node import AddressableNode, FieldNode, RegNode

ROOT = Path(__file__).resolve().parent.parent
SOURCE = "registers/passo.rdl"
GENERATED = f"Generated from {SOURCE} by tools/generate_registers.py."

# Bits and meaning of the enumerations, of which the compiler keeps only the values.
ENUMS = {
    "operation": (4, "What a frame asks for."),
    "verdict": (4, "What became of a frame."),
    "state": (3, "What a channel does."),
    "cause": (3, "Why a channel stopped."),
}


@dataclass(frozen=True)
class Field:
    """Some bits of a register."""

    name: str
    lsb: int
    bits: int
    access: str
    reset: int | None
    text: str
    enum: str | None


@dataclass(frozen=True)
class Register:
    """One word, or `count` words in a row."""

    name: str
    word: int
    count: int | None
    title: str
    text: str
    fields: tuple[Field, ...]

    @property
    def access(self) -> str:
        return "".join(letter for letter in "rw" if any(letter in field.access for field in self.fields))

    @property
    def defined(self) -> int:
        return sum(((1 << f.bits) - 1) << f.lsb for f in self.fields if "w" in f.access)


@dataclass(frozen=True)
class Block:
    """The core, its channels or their axes: `count` times the same registers, every `stride` words."""

    name: str
    word: int
    count: int
    stride: int
    registers: tuple[Register, ...]
    blocks: tuple["Block", ...]

    @property
    def address_bits(self) -> int:
        return (self.stride - 1).bit_length()

    @property
    def address_prefix(self) -> str:
        return "ADDRESS_" if self.name == "CORE" else f"{self.name}_"

    @property
    def field_prefix(self) -> str:
        return "" if self.name == "CORE" else f"{self.name}_"

    def walk(self) -> Iterator["Block"]:
        yield self
        for block in self.blocks:
            yield from block.walk()


@dataclass(frozen=True)
class Enum:
    """A set of named values: (name, value, description)."""

    name: str
    bits: int
    text: str
    members: tuple[tuple[str, int, str], ...]


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


# --- From the compiler to plain data --------------------------------------------------------------


def read_field(node: FieldNode) -> Field:
    encode = node.get_property("encode")
    return Field(
        name=node.inst_name.upper(),
        lsb=node.lsb,
        bits=node.width,
        access=node.get_property("sw").name,
        reset=node.get_property("reset"),
        text=node.get_property("desc"),
        enum=encode and encode.type_name.removesuffix("_e"),
    )


def read_register(node: RegNode) -> Register:
    return Register(
        name=node.inst_name.upper(),
        word=node.raw_address_offset // 4,
        count=node.array_dimensions[0] if node.is_array else None,
        title=node.get_property("name"),
        text=node.get_property("desc"),
        fields=tuple(read_field(field) for field in node.fields()),
    )


def read_block(node: AddressableNode, name: str) -> Block:
    children = list(node.children())
    registers = [child for child in children if isinstance(child, RegNode)]
    blocks = [child for child in children if not isinstance(child, RegNode)]
    return Block(
        name=name,
        word=node.raw_address_offset // 4,
        count=node.array_dimensions[0] if node.is_array else 1,
        stride=(node.array_stride if node.is_array else node.size) // 4,
        registers=tuple(map(read_register, registers)),
        blocks=tuple(read_block(child, child.inst_name.upper()) for child in blocks),
    )


def read_source() -> tuple[Block, list[Enum]]:
    """Compile the source; return the core and the enumerations."""
    compiler = RDLCompiler()
    compiler.compile_file(str(ROOT / SOURCE))
    core = read_block(compiler.elaborate().top, "CORE")
    enums = []
    for name, (bits, text) in ENUMS.items():
        members = compiler.namespace.lookup_type(f"{name}_e")
        enums.append(Enum(name, bits, text, tuple((m.name, m.value, m.rdl_desc) for m in members)))
    return core, enums


# --- From plain data to constants -----------------------------------------------------------------


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
        name = field_name(block, register, field)
        yield Constant(f"{name}_LSB", field.lsb)
        yield Constant(f"{name}_BITS", field.bits)
        if field.reset is not None:
            yield Constant(f"{name}_RESET", field.reset, field.bits)
    if register.defined:
        yield Constant(f"{block.field_prefix}{register.name}_DEFINED", register.defined, 32)


def block_constants(outer: Block, block: Block) -> Iterator[Constant]:
    name = outer.address_prefix + block.name
    yield Constant(f"{name}_BASE", block.word, outer.address_bits)
    yield Constant(f"{name}_COUNT", block.count)
    yield Constant(f"{name}_STRIDE", block.stride, outer.address_bits)


def constant_groups(core: Block) -> list[tuple[str, list[Constant]]]:
    """All constants in groups, each with a comment."""
    groups = []
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


# --- From constants to files ----------------------------------------------------------------------


def aligned(rows: list[tuple[str, ...]]) -> list[str]:
    """Join the cells of each row so that they stand below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [" ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def write_verilog(core: Block, enums: list[Enum]) -> str:
    lines = [
        "// SPDX-License-Identifier: MIT",
        f"// {GENERATED}",
        "// Registers of Passo, to be included inside a module. Addresses are word addresses.",
        "",
        "// Each module uses its share of these.",
        "/* verilator lint_off UNUSEDPARAM */",
    ]
    for comment, constants in constant_groups(core):
        lines += ["", *(f"// {line}" for line in wrap(comment, 105))]
        rows = [(f"localparam {c.name}", "= " + c.literal(f"{c.bits}'h") + ";") for c in constants]
        lines += aligned(rows)
    for enum in enums:
        lines += ["", f"// {enum.text}"]
        rows = [
            (f"localparam {enum.name.upper()}_{name}", f"= {enum.bits}'d{value};", f"// {text}")
            for name, value, text in enum.members
        ]
        lines += aligned(rows)
    return "\n".join([*lines, "", "/* verilator lint_on UNUSEDPARAM */", ""])


def write_c(core: Block, enums: list[Enum]) -> str:
    lines = [
        "/* SPDX-License-Identifier: MIT",
        f" * {GENERATED}",
        " *",
        " * Registers of Passo. Addresses are word addresses.",
        " */",
        "#ifndef PASSO_REGISTERS_H",
        "#define PASSO_REGISTERS_H",
    ]
    for comment, constants in constant_groups(core):
        lines += ["", "/* " + "\n * ".join(wrap(comment, 105)) + " */"]
        lines += aligned([(f"#define PASSO_{c.name}", c.literal("0x") + "u") for c in constants])
    for enum in enums:
        last = enum.members[-1]
        rows = [
            (f"PASSO_{enum.name.upper()}_{m[0]}", f"= {m[1]}{',' if m != last else ''}", f"/* {m[2]} */")
            for m in enum.members
        ]
        lines += ["", f"/* {enum.text} */", f"enum passo_{enum.name} {{"]
        lines += [f"\t{row}" for row in aligned(rows)] + ["};"]
    return "\n".join([*lines, "", "#endif", ""])


PYTHON_HEAD = f"""\
# SPDX-License-Identifier: MIT
# {GENERATED}
\"\"\"Registers of Passo: word addresses, fields, reset values, enumerations.\"\"\"

from enum import IntEnum
from typing import Self


class _DescribedEnum(IntEnum):
    \"\"\"Numbers with a name and a description.\"\"\"

    description: str

    def __new__(cls, value: int, description: str) -> Self:
        member = int.__new__(cls, value)
        member._value_ = value
        member.description = description
        return member
"""


def write_python(core: Block, enums: list[Enum]) -> str:
    lines = [PYTHON_HEAD]
    for enum in enums:
        lines += ["", f"class {enum.name.capitalize()}(_DescribedEnum):", f'    """{enum.text}"""', ""]
        lines += [f'    {name} = {value}, "{text}"' for name, value, text in enum.members] + [""]
    for comment, constants in constant_groups(core):
        lines += ["", *(f"# {line}" for line in wrap(comment, 105))]
        lines += [f"{c.name} = {c.literal('0x')}" for c in constants]
    return "\n".join([*lines, ""])


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
            meaning += f" [{enum.name.capitalize()}s](#{enum.name}s): {values}."
    return [bits, f"`{field.name}`", ACCESS[field.access], reset, meaning]


def write_markdown(core: Block, enums: list[Enum]) -> str:
    """The same for people: an overview, then every field, then the enumerations."""
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
        overview += table([where, "register", "access", "what it is"], rows)
    for enum in enums:
        details += ["", f"## {enum.name.capitalize()}s", "", enum.text]
        rows = [[f"{value}", f"`{name}`", text] for name, value, text in enum.members]
        details += table(["value", "name", "meaning"], rows)
    head = [
        "<!-- SPDX-License-Identifier: MIT -->",
        f"<!-- {GENERATED} -->",
        "",
        "# Registers",
        "",
        "A register is a 32-bit word; addresses count words. Unused bits read as 0 and must be written as 0.",
        "A field without a reset value shows how the core was built or what happens now, or is not stored.",
        "[How Passo works](architecture.md) tells what the registers are for and how the link carries them.",
    ]
    return "\n".join([*head, *overview, *details, ""])


OUTPUTS = {
    "rtl/passo_registers.vh": write_verilog,
    "c_model/passo_registers.h": write_c,
    "sim/passo/registers.py": write_python,
    "docs/registers.md": write_markdown,
}


def main() -> int:
    parser = argparse.ArgumentParser(description=f"Generate the register definitions from {SOURCE}.")
    parser.add_argument("--check", action="store_true", help="only tell which files are not up to date")
    check = parser.parse_args().check

    core, enums = read_source()
    stale = []
    for name, write in OUTPUTS.items():
        path, text = ROOT / name, write(core, enums)
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.write_text(text, encoding="utf-8")
    for name in stale:
        print(f"{name} is stale: run 'make generate'" if check else f"wrote {name}")
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main())
