# SPDX-License-Identifier: MIT
"""Read spec/passo.rdl: registers, words and enumerations as plain data."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from passo import register_table
from systemrdl import RDLCompiler
from systemrdl.node import AddressableNode, FieldNode, RegNode

SOURCE = "spec/passo.rdl"
GENERATED = f"Generated from {SOURCE} by spec/generate_registers.py."

# Bits and meaning of the enumerations, of which the compiler keeps only the values.
ENUMS = {
    "operation": (4, "Operation of a frame."),
    "verdict": (4, "Outcome of a frame."),
    "state": (3, "State of a channel."),
    "cause": (4, "Why a channel has stopped."),
    "trigger_source": (3, "What fires the trigger of a channel."),
    "trigger_action": (2, "What the trigger does when it fires."),
    "shape": (2, "Shape of a ramp: s as a function of the progress u, both 0 .. 1."),
}


@dataclass(frozen=True)
class Field(register_table.Field):
    """Some bits of a register, with what the documentation says of them."""

    text: str
    enum: str | None
    needs: str  # what the channel must be to set it, as in the source; "" any
    survives_reset: bool


@dataclass(frozen=True)
class Register(register_table.Fields):
    """One word, or `count` words in a row."""

    name: str
    word: int
    count: int | None
    title: str
    text: str
    fields: tuple[Field, ...]
    # what the source says of it beside its fields
    part: str = ""
    pushed: bool = False
    nonzero: bool = False
    special: str = ""
    needs: str = ""
    survives_reset: bool = False
    limit: int | None = None

    @property
    def maximum(self) -> int:
        """The greatest value that may be written."""
        return self.defined if self.limit is None else self.limit


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
        needs=_named(node, "needs"),
        survives_reset=bool(node.get_property("survives_reset", default=False)),
    )


def _named(node: FieldNode | RegNode, name: str) -> str:
    """The value of a property that is an enumeration; "" if it has none."""
    value = node.get_property(name, default=None)
    return value.name if value else ""


def read_register(node: RegNode) -> Register:
    return Register(
        name=node.inst_name.upper(),
        word=node.raw_address_offset // 4,
        count=node.array_dimensions[0] if node.is_array else None,
        title=node.get_property("name"),
        text=node.get_property("desc"),
        fields=tuple(read_field(field) for field in node.fields()),
        part=_named(node, "part"),
        pushed=bool(node.get_property("pushed", default=False)),
        nonzero=bool(node.get_property("nonzero", default=False)),
        special=node.get_property("special", default=""),
        needs=_named(node, "needs"),
        survives_reset=bool(node.get_property("survives_reset", default=False)),
        limit=node.get_property("maximum", default=None),
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

    def parts(self) -> list[str]:
        """The parameters of the core that some register needs."""
        found = (register.part for block in self.core.walk() for register in block.registers)
        return sorted({part for part in found if part})

    def layouts(self) -> Iterator[tuple[str, Register]]:
        """Name and fields of all that is packed: each word, and each register of several fields."""
        for word in self.words:
            yield word.name, word
        for block in self.core.walk():
            for register in block.registers:
                if len(register.fields) > 1:
                    yield block.field_prefix + register.name, register


def read(root: Path) -> Source:
    """Compile the source."""
    compiler = RDLCompiler()
    compiler.compile_file(str(root / SOURCE))
    words = read_block(compiler.elaborate(top_def_name="words").top, "WORDS")
    compiler = RDLCompiler()
    compiler.compile_file(str(root / SOURCE))
    core = read_block(compiler.elaborate(top_def_name="passo").top, "CORE")
    enums = []
    for name, (bits, text) in ENUMS.items():
        members = compiler.namespace.lookup_type(f"{name}_e")
        enums.append(Enum(name, bits, text, tuple((m.name, m.value, m.rdl_desc) for m in members)))
    return Source(core, words.registers, tuple(enums))
