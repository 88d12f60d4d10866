# SPDX-License-Identifier: MIT
"""Generate the definitions of registers and words of RTL, C and Python and their documentation.

Their source is registers/passo.rdl.

Names are the same in all languages; C puts PASSO_ in front:

    ADDRESS_RUN             word address of a register of the core
    CHANNEL_ROOM            word offset of a register in its channel
    AXIS_PINS               word offset of a register in its axis
    ..._BASE, _COUNT        first word and length of an array; arrays of blocks also have a _STRIDE
    RUN_WAIT_SYNC_LSB       lowest bit of the field WAIT_SYNC of RUN; _BITS: width, _RESET: reset value
    CHANNEL_ROOM_..._LSB    the same for the field of a channel's register
    RUN_DEFINED             the bits of a register that may be written
    VERDICT_OK              an enumeration's value; Verdict.OK in Python
    HEADER_SEQUENCE_LSB     the field of a word that is no register

Each register of several fields, and each word, also has a struct passo_<name> with passo_pack_<name>() and
passo_unpack_<name>() in C, and a class with pack() and unpack() in Python. Python also has the TABLE of all
registers.

A field that is alone in its register and has its name does not repeat it: CHANNEL_RATE_TARGET_LSB.
"""

import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from textwrap import wrap

from generated import is_check, keep
from passo import register_table
from systemrdl import RDLCompiler
from systemrdl.node import AddressableNode, FieldNode, RegNode

ROOT = Path(__file__).resolve().parent.parent
SOURCE = "registers/passo.rdl"
GENERATED = f"Generated from {SOURCE} by tools/generate_registers.py."

# Bits and meaning of the enumerations, of which the compiler keeps only the values.
ENUMS = {
    "operation": (4, "Operation of a frame."),
    "verdict": (4, "Outcome of a frame."),
    "state": (3, "State of a channel."),
    "cause": (4, "Why a channel has stopped."),
    "shape": (2, "Shape of a ramp: s as a function of the progress u, both 0 .. 1."),
}


@dataclass(frozen=True)
class Field(register_table.Field):
    """Some bits of a register, with what the documentation says of them."""

    text: str
    enum: str | None


@dataclass(frozen=True)
class Register(register_table.Fields):
    """One word, or `count` words in a row."""

    name: str
    word: int
    count: int | None
    title: str
    text: str
    fields: tuple[Field, ...]


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


@dataclass(frozen=True)
class Source:
    """What is in the source: the registers, the words that are none, the enumerations."""

    core: Block
    words: tuple[Register, ...]
    enums: tuple[Enum, ...]

    def layouts(self) -> Iterator[tuple[str, Register]]:
        """Name and fields of all that is packed: each word, and each register of several fields."""
        for word in self.words:
            yield word.name, word
        for block in self.core.walk():
            for register in block.registers:
                if len(register.fields) > 1:
                    yield block.field_prefix + register.name, register


def read_source() -> Source:
    """Compile the source."""
    compiler = RDLCompiler()
    compiler.compile_file(str(ROOT / SOURCE))
    words = read_block(compiler.elaborate(top_def_name="words").top, "WORDS")
    compiler = RDLCompiler()
    compiler.compile_file(str(ROOT / SOURCE))
    core = read_block(compiler.elaborate(top_def_name="passo").top, "CORE")
    enums = []
    for name, (bits, text) in ENUMS.items():
        members = compiler.namespace.lookup_type(f"{name}_e")
        enums.append(Enum(name, bits, text, tuple((m.name, m.value, m.rdl_desc) for m in members)))
    return Source(core, words.registers, tuple(enums))


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


# --- From constants to files ----------------------------------------------------------------------


def aligned(rows: list[tuple[str, ...]]) -> list[str]:
    """Join the cells of each row so that they stand below each other."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [" ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def write_verilog(source: Source) -> str:
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


def write_c(source: Source) -> str:
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


def write_c_words(source: Source) -> str:
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


PYTHON_HEAD = f"""\
# SPDX-License-Identifier: MIT
# {GENERATED}
\"\"\"Registers of Passo: word addresses, fields, reset values, enumerations.\"\"\"

from dataclasses import dataclass
from typing import ClassVar

from passo.register_table import Field, Register
from passo.register_word import DescribedEnum, Word
"""


def python_table(core: Block) -> list[str]:
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
            lines.append("    )),")
    return [*lines, ")", "# fmt: on"]


def python_type(field: Field) -> str:
    return field.enum.capitalize() if field.enum else "bool" if field.bits == 1 else "int"


def python_default(field: Field, enums: Sequence[Enum]) -> str:
    """The reset value as a default, if there is one."""
    if field.reset is None:
        return ""
    for enum in enums:
        if enum.name == field.enum:
            (name,) = (name for name, value, _ in enum.members if value == field.reset)
            return f" = {python_type(field)}.{name}"
    return f" = {bool(field.reset) if field.bits == 1 else field.reset}"


def python_layout(name: str, register: Register, enums: Sequence[Enum]) -> list[str]:
    """A class of the fields of a word; those with a reset value need not be given."""
    fields = sorted(reversed(register.fields), key=lambda field: field.reset is not None)
    lines = ["", "@dataclass(frozen=True)", f"class {name.title().replace('_', '')}Word(Word):"]
    lines += [f'    """{register.title}."""', ""]
    for field in fields:
        lines += [f"    # {line}" for line in wrap(field.text, 104)]
        lines.append(f"    {field.name.lower()}: {python_type(field)}{python_default(field, enums)}")
    lines += ["", "    PLACES: ClassVar = {"]
    lines += [f'        "{f.name.lower()}": ({f.lsb}, {f.bits}, {python_type(f)}),' for f in register.fields]
    return [*lines, "    }", ""]


def write_python(source: Source) -> str:
    lines = [PYTHON_HEAD]
    for enum in source.enums:
        lines += ["", f"class {enum.name.capitalize()}(DescribedEnum):", f'    """{enum.text}"""', ""]
        lines += [f'    {name} = {value}, "{text}"' for name, value, text in enum.members] + [""]
    for name, register in source.layouts():
        lines += python_layout(name, register, source.enums)
    for comment, constants in constant_groups(source):
        lines += ["", *(f"# {line}" for line in wrap(comment, 105))]
        lines += [f"{c.name} = {c.literal('0x')}" for c in constants]
    lines += python_table(source.core)
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


def write_markdown(source: Source) -> str:
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
        "A field without a reset value reports a build parameter or a current state, or is not stored.",
        "[How Passo works](architecture.md) explains their use and the link that carries them.",
    ]
    return "\n".join([*head, *overview, *details, ""])


OUTPUTS = {
    "rtl/passo_registers.vh": write_verilog,
    "protocol/passo_registers.h": write_c,
    "protocol/passo_words.h": write_c_words,
    "sim/passo/registers.py": write_python,
    "docs/registers.md": write_markdown,
}


def main() -> int:
    check = is_check(f"Generate the register definitions from {SOURCE}.")
    source = read_source()
    return keep(ROOT, {name: write(source) for name, write in OUTPUTS.items()}, check)


if __name__ == "__main__":
    sys.exit(main())
