# SPDX-License-Identifier: MIT
"""Objects in memory, and the places in them that C code reads and writes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import z3

from verify.equal.c_aggregates import INDEX_BITS, Table, choose, copied, mapped, row_of
from verify.equal.c_types import (
    INT,
    UNSIGNED_LONG,
    Array,
    Condition,
    Integer,
    Pointer,
    Struct,
    Type,
    UnsupportedError,
    Value,
    both,
    convert,
    to_vector,
)

STEPS = 500  # of a simplification, at most


@dataclass
class Cell:
    """An object: a variable, a parameter, or a compound literal.

    It is seen only where ``born`` holds, so that a write under this very condition is one without.
    """

    type: Type
    bits: Any
    born: Condition = True


@dataclass(frozen=True)
class Place:
    """Where something is: an object, and the members and indexes that lead to it."""

    cell: Cell
    path: tuple[str | int | Value, ...]
    type: Type

    def member(self, name: str) -> Place:
        """A member of a struct."""
        assert isinstance(self.type, Struct)
        return Place(self.cell, (*self.path, name), self.type.fields[name])

    def element(self, index: Value) -> Place:
        """An element of an array."""
        assert isinstance(self.type, Array)
        key = index.bits if isinstance(index.bits, int) else convert(index, UNSIGNED_LONG)
        return Place(self.cell, (*self.path, key), self.type.element)


# A pointer, or an lvalue: where it points to, and when. Exactly one of the conditions is true.
Places: TypeAlias = "list[tuple[Condition, Place]]"


def within(index: Value, length: int) -> Condition:
    """Whether an index is in an array."""
    if isinstance(index.bits, int):
        return 0 <= index.bits < length
    wide = convert(index, UNSIGNED_LONG).bits
    return z3.ULT(to_vector(wide, 64), length)


def _selects(key: Value, i: int) -> Condition:
    """Whether an unknown index is i: often known to be false, for an index that was masked."""
    equal = key.bits == i
    try:
        equal = z3.simplify(equal, max_steps=STEPS)
    except z3.Z3Exception:
        return equal  # it depends on too much
    return False if z3.is_false(equal) else equal


def _index(key: int | Value) -> z3.BitVecRef:
    """An index of a table; one out of range is a demand that fails."""
    bits = key if isinstance(key, int) else convert(key, Integer(INDEX_BITS, False)).bits
    return to_vector(bits, INDEX_BITS)


def _stored(column: z3.ArrayRef, index: z3.BitVecRef, leaf: Any) -> z3.ArrayRef:
    if z3.is_select(leaf) and leaf.arg(0).eq(column) and leaf.arg(1).eq(index):
        return column  # not written
    return z3.Store(column, index, leaf)


def _read(bits: Any, kind: Type, path: tuple[str | int | Value, ...]) -> Any:
    if not path:
        return bits
    key, rest = path[0], path[1:]
    if isinstance(key, str):
        assert isinstance(kind, Struct)
        return _read(bits[key], kind.fields[key], rest)
    assert isinstance(kind, Array)
    if isinstance(bits, Table):
        return _read(row_of(bits, kind, _index(key)), kind.element, rest)
    if isinstance(key, int):  # one out of range is a demand that fails
        return _read(bits[min(max(key, 0), kind.length - 1)], kind.element, rest)
    inner = _target(kind.element, rest)
    found = _read(bits[-1], kind.element, rest)
    for i in range(kind.length - 2, -1, -1):
        found = choose(_selects(key, i), _read(bits[i], kind.element, rest), found, inner)
    return found


def _target(kind: Type, path: tuple[str | int | Value, ...]) -> Type:
    for key in path:
        if isinstance(kind, Struct):
            kind = kind.fields[key]  # type: ignore[index]
        else:
            assert isinstance(kind, Array)
            kind = kind.element
    return kind


def _write(bits: Any, kind: Type, path: tuple[str | int | Value, ...], when: Condition, new: Value) -> Any:
    """The bits after a write, which changes the containers in place."""
    if when is False:
        return bits
    if not path:
        return choose(when, copied(new.bits), bits, kind)
    key, rest = path[0], path[1:]
    if isinstance(key, str):
        assert isinstance(kind, Struct)
        bits[key] = _write(bits[key], kind.fields[key], rest, when, new)
        return bits
    assert isinstance(kind, Array)
    if isinstance(bits, Table):
        index = _index(key)
        row = _write(row_of(bits, kind, index), kind.element, rest, True, new)
        changed = Table(mapped(kind.element, lambda of, leaf: _stored(of, index, leaf), bits.columns, row))
        return choose(when, changed, bits, kind)
    for i in range(kind.length) if isinstance(key, Value) else {key} & set(range(kind.length)):
        here = both(when, _selects(key, i)) if isinstance(key, Value) else when
        bits[i] = _write(bits[i], kind.element, rest, here, new)
    return bits


def read(places: Places) -> Value:
    """What is at a place."""
    if not places:
        raise UnsupportedError("reading through a null pointer")
    kind = places[-1][1].type
    found = None
    for when, place in reversed(places):
        bits = copied(_read(place.cell.bits, place.cell.type, place.path))
        found = bits if found is None else choose(when, bits, found, kind)
    return Value(kind, found)


def write(places: Places, new: Value, guard: Condition) -> None:
    """Write a value, which has the type of the place already, if the guard is true."""
    if not places:
        raise UnsupportedError("writing through a null pointer")
    for when, place in places:
        cell = place.cell
        under = when if guard is cell.born else both(guard, when)
        cell.bits = _write(cell.bits, cell.type, place.path, under, new)


def pointer_to(places: Places) -> Value:
    """The address of a place; that of an array is that of its first element."""
    first = places[0][1].type
    return Value(Pointer(first), places)


def first_element(places: Places) -> Value:
    """An array as a pointer to its first element."""
    zero = Value(INT, 0)
    inside = [(when, place.element(zero)) for when, place in places]
    return Value(Pointer(inside[0][1].type), inside)


def moved(pointer: Value, by: Value) -> Value:
    """A pointer to an element of an array, moved by a number of elements."""
    places = []
    for when, place in pointer.bits:
        last = place.path[-1] if place.path else None
        if not isinstance(last, int) or not isinstance(by.bits, int):
            if not isinstance(last, int | Value):
                raise UnsupportedError("arithmetic on a pointer that is not into an array")
            key = Value(UNSIGNED_LONG, _sum(last, by))
        else:
            key = last + by.bits
        places.append((when, Place(place.cell, (*place.path[:-1], key), place.type)))
    return Value(pointer.type, places)


def _sum(last: int | Value, by: Value) -> Any:
    base = last if isinstance(last, int) else last.bits
    added = convert(by, Integer(64, False)).bits
    if isinstance(base, int) and isinstance(added, int):
        return base + added
    return to_vector(base, 64) + to_vector(added, 64)
