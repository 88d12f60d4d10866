# SPDX-License-Identifier: MIT
"""Variables of C and their initializers, with unknown values. See c_evaluate.py."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any

import z3
from pycparser import c_ast

from verify.equal.c_aggregates import copied, filled, symbols, zero
from verify.equal.c_places import Cell
from verify.equal.c_program import Program
from verify.equal.c_types import (
    BOOL,
    INT,
    UNSIGNED_LONG,
    Array,
    Condition,
    Struct,
    Type,
    UnsupportedError,
    Value,
    convert,
)


@dataclass
class Frame:
    """A call: its variables, and how it has been left so far."""

    scopes: list[dict[str, Cell]] = field(default_factory=lambda: [{}])
    returned: Condition = False
    result: Value | None = None
    broken: list[Condition] = field(default_factory=list)  # of the loops and switches around
    continued: list[Condition] = field(default_factory=list)


class Objects:
    """Variables of a program; ``demands`` are what the definedness of its expressions needs."""

    def __init__(self, program: Program, opaque: bool = False) -> None:
        self.program = program
        self.opaque = opaque  # products and quotients of unknown numbers are unknown functions
        self.cells: dict[str, Cell] = {}
        self.demands: list[tuple[str, Condition]] = []
        self.fresh = 0
        self.frame = Frame()
        self.guard: Condition = True

    def cell(self, name: str) -> Cell:
        """A variable: of the function, or with file scope."""
        for scope in reversed(self.frame.scopes):
            if name in scope:
                return scope[name]
        if name not in self.cells:
            decl = self.program.objects.get(name)
            if decl is None:
                raise UnsupportedError(f"no variable {name}")
            self.cells[name] = self._declared(decl, name)
        return self.cells[name]

    def make_unknown(self, name: str, arrays: Collection[str] = ()) -> None:
        """Give an object with file scope unknown contents; ``arrays`` are symbols as a whole."""
        kind = self.program.type_of(self.program.objects[name].type)
        self.cells[name] = Cell(kind, symbols(kind, name, arrays))

    def _declared(self, decl: c_ast.Decl, name: str, born: Condition = True) -> Cell:
        node = decl.type
        if isinstance(node, c_ast.ArrayDecl) and node.dim is None:
            element = self.program.type_of(node.type)
            kind: Type = Array(element, self._length(decl.init))
        else:
            kind = self.program.type_of(node)
        if decl.init is None:
            return Cell(kind, self._undefined(kind, name), born)
        return Cell(kind, self._initial(kind, decl.init).bits, born)

    def _length(self, init: c_ast.InitList) -> int:
        place, length = 0, 0
        for item in init.exprs:
            if isinstance(item, c_ast.NamedInitializer):
                place = self._designated(item.name[0])
            place += 1
            length = max(length, place)
        return length

    def _undefined(self, kind: Type, name: str) -> Any:
        """A variable without initializer: what it holds is unknown."""
        self.fresh += 1
        mark = f"{name}!{self.fresh}"
        return filled(kind, mark, lambda of, leaf: z3.Bool(leaf) if of == BOOL else z3.BitVec(leaf, of.width))

    def _initial(self, kind: Type, node: Any) -> Value:
        if not isinstance(node, c_ast.InitList):
            return Value(kind, copied(convert(self.value(node), kind).bits))
        bits = zero(kind)
        members = list(kind.fields) if isinstance(kind, Struct) else None
        place = 0
        for item in node.exprs or ():
            inner = item
            if isinstance(item, c_ast.NamedInitializer):
                inner = item.expr
                place = members.index(item.name[0].name) if members else self._designated(item.name[0])
                if len(item.name) != 1:
                    raise UnsupportedError("nested designators")
            if members is not None:
                assert isinstance(kind, Struct)
                bits[members[place]] = self._initial(kind.fields[members[place]], inner).bits
            elif isinstance(kind, Array):
                bits[place] = self._initial(kind.element, inner).bits
            else:
                return Value(kind, convert(self.value(inner), kind).bits)
            place += 1
        return Value(kind, bits)

    def _designated(self, node: Any) -> int:
        return self.constant(node.expr if isinstance(node, c_ast.ArrayDesignator) else node)

    def constant(self, node: Any) -> int:
        """The value of an expression that must be known."""
        bits = convert(self.value(node), INT if not isinstance(node, c_ast.Constant) else UNSIGNED_LONG).bits
        if not isinstance(bits, int):
            raise UnsupportedError("a constant that is not known")
        return bits

    def value(self, node: Any) -> Value:
        """The value of an expression."""
        raise NotImplementedError
