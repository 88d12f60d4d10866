# SPDX-License-Identifier: MIT
"""Base classes of the generated registers."""

import dataclasses
from enum import IntEnum
from functools import cache
from typing import Any, Self

from passo.register_table import Field


class DescribedEnum(IntEnum):
    """Numbers with a name and a description."""

    description: str

    def __new__(cls, value: int, description: str) -> Self:
        member = int.__new__(cls, value)
        member._value_ = value
        member.description = description
        return member


def bits(lsb: int, width: int, access: str, default: Any = dataclasses.MISSING) -> Any:
    """A field of a word; its default is its value after a reset."""
    return dataclasses.field(default=default, metadata={"lsb": lsb, "bits": width, "access": access})


class Word:
    """A word by its fields."""

    @classmethod
    def places(cls) -> tuple[Field, ...]:
        """All fields, from the lowest."""
        return tuple(field for _, field, _ in _places(cls))

    def pack(self) -> int:
        """The word. ValueError if a field is too large."""
        word = 0
        for name, field, _ in _places(type(self)):
            value = int(getattr(self, name))
            if value >> field.bits:
                raise ValueError(f"{type(self).__name__}.{name}: {value} has more than {field.bits} bits")
            word |= value << field.lsb
        return word

    @classmethod
    def unpack(cls, word: int) -> Self:
        """The fields of a word. ValueError if an enumeration has no such value."""
        return cls(**{name: kind((word & field.mask) >> field.lsb) for name, field, kind in _places(cls)})


@cache
def _places(cls: Any) -> tuple[tuple[str, Field, Any], ...]:
    """Name, field and type of each field of a word, from the lowest."""
    places = []
    for field in dataclasses.fields(cls):
        reset = None if field.default is dataclasses.MISSING else int(field.default)
        place = Field(field.name.upper(), reset=reset, **field.metadata)
        places.append((field.name, place, field.type))
    return tuple(sorted(places, key=lambda place: place[1].lsb))
