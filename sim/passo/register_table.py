# SPDX-License-Identifier: MIT
"""Types of the table of all registers (passo.registers.TABLE)."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Field:
    """Some bits of a register."""

    name: str
    lsb: int
    bits: int
    access: str  # r, w or rw
    reset: int | None  # None: it depends on the core or on what happens now, or is not stored

    @property
    def mask(self) -> int:
        """Its bits of the word."""
        return ((1 << self.bits) - 1) << self.lsb


def bits_of(fields: Iterable[Field]) -> int:
    """All bits of fields."""
    return sum(field.mask for field in fields)


class Fields:
    """What follows from the fields of a register."""

    fields: tuple[Field, ...]

    @property
    def access(self) -> str:
        """What can be done with one of the fields: r, w or rw."""
        return "".join(letter for letter in "rw" if any(letter in field.access for field in self.fields))

    @property
    def defined(self) -> int:
        """The bits that may be written."""
        return bits_of(field for field in self.fields if "w" in field.access)


@dataclass(frozen=True)
class Register(Fields):
    """One word of the core, of each channel or of each axis, or `count` words in a row."""

    name: str
    block: str  # CORE, CHANNEL or AXIS
    word: int  # of its block
    count: int
    fields: tuple[Field, ...]
    part: str = ""  # the parameter that it needs: inputs, encoders or outputs

    @property
    def known(self) -> int:
        """The bits that are known after a reset: all but the fields without a reset value."""
        return 0xFFFFFFFF & ~bits_of(field for field in self.fields if field.reset is None)

    @property
    def reset(self) -> int:
        """What the known bits are then."""
        return sum((field.reset or 0) << field.lsb for field in self.fields)
