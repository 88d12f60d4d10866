# SPDX-License-Identifier: MIT
"""Base classes of the generated registers."""

from enum import IntEnum
from typing import ClassVar, Self


class DescribedEnum(IntEnum):
    """Numbers with a name and a description."""

    description: str

    def __new__(cls, value: int, description: str) -> Self:
        member = int.__new__(cls, value)
        member._value_ = value
        member.description = description
        return member


class Word:
    """A word by its fields; PLACES has the lowest bit, the width and the type of each."""

    PLACES: ClassVar[dict[str, tuple[int, int, type]]]

    def pack(self) -> int:
        """The word. ValueError if a field is too large."""
        word = 0
        for name, (lsb, bits, _) in self.PLACES.items():
            value = int(getattr(self, name))
            if value >> bits:
                raise ValueError(f"{type(self).__name__}.{name}: {value} has more than {bits} bits")
            word |= value << lsb
        return word

    @classmethod
    def unpack(cls, word: int) -> Self:
        """The fields of a word. ValueError if an enumeration has no such value."""
        return cls(
            **{name: kind(word >> lsb & (1 << bits) - 1) for name, (lsb, bits, kind) in cls.PLACES.items()}
        )
