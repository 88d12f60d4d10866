# SPDX-License-Identifier: MIT
"""Types and values of C as the model uses them: integers, bool, enums, structs, arrays, pointers.

A value of an integer type is a Python integer or a z3 bit vector of the width of its type; a bool is a Python
bool or a z3 condition. Structs are dicts, arrays are lists.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import z3

Bits: TypeAlias = "int | z3.BitVecRef"
Condition: TypeAlias = "bool | z3.BoolRef"


@dataclass(frozen=True)
class Integer:
    """An integer type other than bool."""

    width: int
    signed: bool


@dataclass(frozen=True)
class Bool:
    """_Bool."""


@dataclass
class Struct:
    """A struct; its fields are known once its definition has been read."""

    name: str
    fields: dict[str, Type] = field(default_factory=dict)


@dataclass(frozen=True)
class Array:
    """An array of known length."""

    element: Type
    length: int


@dataclass(frozen=True)
class Pointer:
    """A pointer to a type."""

    target: Type


@dataclass(frozen=True)
class Void:
    """No value."""


Type: TypeAlias = "Integer | Bool | Struct | Array | Pointer | Void"

INT = Integer(32, True)
UNSIGNED = Integer(32, False)
LONG = Integer(64, True)
UNSIGNED_LONG = Integer(64, False)
BOOL = Bool()


@dataclass(frozen=True)
class Value:
    """A value with its type. A comparison is an int whose ``bits`` are a condition until they are needed."""

    type: Type
    bits: Any  # Bits, Condition, dict, list, or Place of a pointer


class UnsupportedError(Exception):
    """Something of C that the model does not use, and that is therefore not evaluated."""


def both(a: Condition, b: Condition) -> Condition:
    """a and b."""
    if a is False or b is False:
        return False
    if a is True:
        return b
    return a if b is True else z3.And(a, b)


def either(a: Condition, b: Condition) -> Condition:
    """a or b."""
    return inverse(both(inverse(a), inverse(b)))


def inverse(a: Condition) -> Condition:
    """Not a."""
    if isinstance(a, bool):
        return not a
    return a.arg(0) if z3.is_not(a) else z3.Not(a)


def to_vector(bits: Bits, width: int) -> z3.BitVecRef:
    """Bits as a z3 bit vector."""
    return z3.BitVecVal(bits, width) if isinstance(bits, int) else bits


def is_condition(bits: object) -> bool:
    """Whether bits are those of a bool or of a comparison."""
    return isinstance(bits, bool | z3.BoolRef)


def truth(value: Value) -> Condition:
    """Whether a value is not 0."""
    bits = value.bits
    if is_condition(bits):
        return bits
    if isinstance(bits, int):
        return bits != 0
    if isinstance(bits, z3.BitVecRef):
        return bits != 0
    raise UnsupportedError("the truth of this value")


def wrapped(bits: int, kind: Integer) -> int:
    """A Python integer in the range of a type."""
    bits &= (1 << kind.width) - 1
    return bits - (1 << kind.width) if kind.signed and bits >> (kind.width - 1) else bits


def convert(value: Value, to: Type) -> Value:
    """A value converted to a type, as by an assignment."""
    if isinstance(to, Bool):
        return Value(BOOL, truth(value))
    if not isinstance(to, Integer):
        return Value(to, value.bits)
    bits = value.bits
    if isinstance(bits, bool):
        return Value(to, int(bits))
    if isinstance(bits, z3.BoolRef):
        return Value(to, z3.If(bits, z3.BitVecVal(1, to.width), z3.BitVecVal(0, to.width)))
    if isinstance(bits, int):
        return Value(to, wrapped(bits, to))
    assert isinstance(value.type, Integer)
    more = to.width - bits.size()
    if more < 0:
        bits = z3.Extract(to.width - 1, 0, bits)
    elif more > 0:
        bits = z3.SignExt(more, bits) if value.type.signed else z3.ZeroExt(more, bits)
    return Value(to, bits)


def promoted(value: Value) -> Value:
    """A value after the integer promotions."""
    kind = value.type
    small = isinstance(kind, Bool) or (isinstance(kind, Integer) and kind.width < INT.width)
    return convert(value, INT) if small else value


def common(a: Value, b: Value) -> Integer:
    """The type of an operation on two values: the usual arithmetic conversions."""
    kinds = [promoted(value).type for value in (a, b)]
    if not all(isinstance(kind, Integer) for kind in kinds):
        raise UnsupportedError("arithmetic of something other than integers")
    width = max(kind.width for kind in kinds)
    signed = all(kind.signed for kind in kinds if kind.width == width)
    return Integer(width, signed)
