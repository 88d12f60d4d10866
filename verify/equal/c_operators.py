# SPDX-License-Identifier: MIT
"""Operators of C on values, with what each demands of its operands if it is to be defined."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import z3

from verify.equal.c_types import (
    INT,
    Condition,
    Integer,
    UnsupportedError,
    Value,
    common,
    convert,
    inverse,
    is_condition,
    promoted,
    to_vector,
    truth,
    wrapped,
)

Demand: TypeAlias = "Callable[[str, Condition], None]"

COMPARISONS = {"==", "!=", "<", "<=", ">", ">="}
_PLAIN = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "&": lambda a, b: a & b,
    "|": lambda a, b: a | b,
    "^": lambda a, b: a ^ b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}
_UNSIGNED = {"<": z3.ULT, "<=": z3.ULE, ">": z3.UGT, ">=": z3.UGE}


def _divided(operator: str, a: int, b: int) -> int:
    quotient = abs(a) // abs(b)
    quotient = -quotient if (a < 0) != (b < 0) else quotient
    return quotient if operator == "/" else a - quotient * b


def _no_overflow(operator: str, a: z3.BitVecRef, b: z3.BitVecRef, width: int) -> z3.BoolRef:
    more = width if operator == "*" else 1
    wide = _PLAIN[operator](z3.SignExt(more, a), z3.SignExt(more, b))
    return wide == z3.SignExt(more, z3.Extract(width - 1, 0, wide))


def _shift(operator: str, left: Value, right: Value, demand: Demand) -> Value:
    left, right = promoted(left), promoted(right)
    kind = left.type
    assert isinstance(kind, Integer)
    if isinstance(right.bits, int):
        demand("a shift by less than the width", 0 <= right.bits < kind.width)
    else:
        demand("a shift by less than the width", z3.ULT(right.bits, kind.width))
    if isinstance(left.bits, int) and isinstance(right.bits, int):
        bits = left.bits << right.bits if operator == "<<" else left.bits >> right.bits
        if operator == "<<" and kind.signed:
            demand("a shift of a positive int without overflow", bits >> (kind.width - 1) == 0)
        return Value(kind, wrapped(bits, kind))
    a = to_vector(left.bits, kind.width)
    b = to_vector(convert(right, kind).bits, kind.width)
    if operator == "<<":
        if kind.signed:
            back = (a << b) >> b
            demand("a shift of a positive int without overflow", z3.And(a >= 0, back == a, (a << b) >= 0))
        return Value(kind, a << b)
    return Value(kind, a >> b if kind.signed else z3.LShR(a, b))


def _unknown(operator: str, a: z3.BitVecRef, b: z3.BitVecRef, kind: Integer) -> Value:
    """Some function of two numbers, the same for each pair of them."""
    if kind.signed:
        raise UnsupportedError(f"{operator} of signed numbers as an unknown function")
    function = z3.Function(f"{operator}{kind.width}", a.sort(), b.sort(), a.sort())
    return Value(kind, function(a, b))


def binary(operator: str, left: Value, right: Value, demand: Demand, opaque: bool = False) -> Value:
    """The value of ``left operator right``, except && and ||.

    ``opaque``: products and quotients of unknown numbers are unknown functions.
    """
    if operator in ("<<", ">>"):
        return _shift(operator, left, right, demand)
    if operator in ("==", "!=") and is_condition(left.bits) and is_condition(right.bits):
        a, b = left.bits, right.bits
        if isinstance(a, bool) and isinstance(b, bool):
            return Value(INT, (a == b) == (operator == "=="))
        if isinstance(a, bool):
            a, b = b, a
        same = (a if b else inverse(a)) if isinstance(b, bool) else a == b
        return Value(INT, same if operator == "==" else inverse(same))
    kind = common(left, right)
    a, b = convert(left, kind).bits, convert(right, kind).bits
    if isinstance(a, int) and isinstance(b, int):
        if operator in ("/", "%"):
            demand("no division by 0", b != 0)
            return Value(kind, _divided(operator, a, b))
        bits = _PLAIN[operator](a, b)
        if operator in COMPARISONS:
            return Value(INT, bits)
        if kind.signed:
            demand("no overflow", wrapped(bits, kind) == bits)
        return Value(kind, wrapped(bits, kind))
    known = isinstance(a, int) or isinstance(b, int)
    a, b = to_vector(a, kind.width), to_vector(b, kind.width)
    if opaque and operator in ("*", "/", "%") and not known:
        if operator != "*":
            demand("no division by 0", b != 0)
        return _unknown(operator, a, b, kind)
    if operator in COMPARISONS:
        own = _PLAIN[operator] if kind.signed else _UNSIGNED.get(operator, _PLAIN[operator])
        return Value(INT, own(a, b))
    if operator in ("/", "%"):
        demand("no division by 0", b != 0)
        if kind.signed:
            lowest = 1 << (kind.width - 1)
            demand("no overflow", z3.Or(a != lowest, b != -1))
            return Value(kind, a / b if operator == "/" else z3.SRem(a, b))
        return Value(kind, z3.UDiv(a, b) if operator == "/" else z3.URem(a, b))
    if kind.signed and operator in "+-*":
        demand("no overflow", _no_overflow(operator, a, b, kind.width))
    return Value(kind, _PLAIN[operator](a, b))


def unary(operator: str, value: Value, demand: Demand) -> Value:
    """The value of -, +, ~ or ! applied to a value."""
    if operator == "!":
        return Value(INT, inverse(truth(value)))
    value = promoted(value)
    kind = value.type
    if not isinstance(kind, Integer):
        raise UnsupportedError(f"{operator} of something other than an integer")
    bits = convert(value, kind).bits
    if operator == "+":
        return Value(kind, bits)
    if operator == "-":
        return binary("-", Value(kind, 0), Value(kind, bits), demand)
    if operator == "~":
        return Value(kind, wrapped(~bits, kind) if isinstance(bits, int) else ~bits)
    raise UnsupportedError(f"operator {operator}")
