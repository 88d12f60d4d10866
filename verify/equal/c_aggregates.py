# SPDX-License-Identifier: MIT
"""Structs and arrays of C as containers of bits: made leaf by leaf, chosen between, copied."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

import z3

from verify.equal.c_types import (
    Array,
    Bool,
    Condition,
    Integer,
    Pointer,
    Struct,
    Type,
    Value,
    both,
    convert,
    inverse,
    is_condition,
    to_vector,
)

INDEX_BITS = 32  # of a table


@dataclass(frozen=True)
class Table:
    """The elements of a long array: an array of z3 in the place of each leaf of an element."""

    columns: Any


def choose(condition: Condition, then: Any, other: Any, kind: Type) -> Any:
    """Bits of a type: ``then`` if the condition is true, ``other`` if not."""
    if condition is True:
        return then
    if condition is False or then is other:
        return other
    if isinstance(kind, Struct):
        return {name: choose(condition, then[name], other[name], of) for name, of in kind.fields.items()}
    if isinstance(then, Table):
        assert isinstance(kind, Array)
        return Table(mapped(kind.element, lambda a, b: z3.If(condition, a, b), then.columns, other.columns))
    if isinstance(kind, Array):
        return [choose(condition, a, b, kind.element) for a, b in zip(then, other, strict=True)]
    if isinstance(kind, Pointer):
        return [(both(condition, when), place) for when, place in then] + [
            (both(inverse(condition), when), place) for when, place in other
        ]
    if is_condition(then) and is_condition(other):
        if isinstance(then, bool) and isinstance(other, bool):
            return then if then == other else (condition if then else inverse(condition))
        return z3.If(condition, then, other)
    assert isinstance(kind, Integer)
    then, other = (convert(Value(kind, bits), kind).bits for bits in (then, other))
    if isinstance(then, int) and isinstance(other, int) and then == other:
        return then
    return z3.If(condition, to_vector(then, kind.width), to_vector(other, kind.width))


def zero(kind: Type) -> Any:
    """Bits of a type, all 0."""
    return filled(kind, "", lambda of, _: False if isinstance(of, Bool) else 0)


def filled(kind: Type, name: str, leaf: Any) -> Any:
    """Bits of a type made from its leaves: leaf(type, name as C writes it)."""
    if isinstance(kind, Struct):
        return {of: filled(inner, f"{name}.{of}", leaf) for of, inner in kind.fields.items()}
    if isinstance(kind, Array):
        return [filled(kind.element, f"{name}[{i}]", leaf) for i in range(kind.length)]
    if isinstance(kind, Pointer):
        return []  # a pointer to nothing
    return leaf(kind, name)


def symbols(kind: Type, name: str, arrays: Collection[str] = ()) -> Any:
    """Bits of a type, all unknown; each symbol has the name of its leaf.

    ``arrays`` become tables: names without indices.
    """
    if isinstance(kind, Struct):
        return {of: symbols(inner, f"{name}.{of}", arrays) for of, inner in kind.fields.items()}
    if isinstance(kind, Array) and re.sub(r"\[\d+\]", "[]", name) in arrays:
        return Table(filled(kind.element, f"{name}[]", _column))
    if isinstance(kind, Array):
        return [symbols(kind.element, f"{name}[{i}]", arrays) for i in range(kind.length)]
    if isinstance(kind, Pointer):
        return []
    return z3.Bool(name) if isinstance(kind, Bool) else z3.BitVec(name, kind.width)


def _column(kind: Type, name: str) -> z3.ArrayRef:
    element = z3.BoolSort() if isinstance(kind, Bool) else z3.BitVecSort(kind.width)
    return z3.Array(name, z3.BitVecSort(INDEX_BITS), element)


def mapped(kind: Type, leaf: Any, *bits: Any) -> Any:
    """Bits of a type made from the leaves of others: leaf(one of each)."""
    if isinstance(kind, Struct):
        return {of: mapped(inner, leaf, *(b[of] for b in bits)) for of, inner in kind.fields.items()}
    if isinstance(kind, Array):
        return [mapped(kind.element, leaf, *(b[i] for b in bits)) for i in range(kind.length)]
    return leaf(*bits)


def row_of(table: Table, kind: Array, index: int | z3.BitVecRef) -> Any:
    """The bits of an element of a table."""
    return mapped(kind.element, lambda column: column[index], table.columns)


def leaves(kind: Type, bits: Any, name: str) -> Iterator[tuple[str, Type, Any]]:
    """The leaves of a value: name, type, bits."""
    if isinstance(kind, Struct):
        for of, inner in kind.fields.items():
            yield from leaves(inner, bits[of], f"{name}.{of}")
    elif isinstance(kind, Array):
        for i in range(kind.length):
            element = row_of(bits, kind, i) if isinstance(bits, Table) else bits[i]
            yield from leaves(kind.element, element, f"{name}[{i}]")
    elif not isinstance(kind, Pointer):
        yield name, kind, bits


def copied(bits: Any) -> Any:
    """A copy of containers; their leaves never change."""
    if isinstance(bits, dict):
        return {name: copied(inner) for name, inner in bits.items()}
    return [copied(inner) for inner in bits] if isinstance(bits, list) else bits
