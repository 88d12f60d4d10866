# SPDX-License-Identifier: MIT
"""Expressions and lvalues of C, evaluated on unknown values. See c_evaluate.py."""

from __future__ import annotations

from typing import Any

from pycparser import c_ast

from verify.equal import c_operators
from verify.equal.c_aggregates import choose, zero
from verify.equal.c_objects import Objects
from verify.equal.c_places import Cell, Place, Places, first_element, moved, pointer_to, read, within, write
from verify.equal.c_types import (
    BOOL,
    INT,
    UNSIGNED_LONG,
    Array,
    Condition,
    Integer,
    Pointer,
    Type,
    UnsupportedError,
    Value,
    both,
    convert,
    either,
    inverse,
    truth,
)

ASSIGNMENTS = {"+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}


class Expressions(Objects):
    """Evaluates expressions of a program; ``demands`` are what their definedness needs."""

    def _demand(self, what: str, condition: Condition) -> None:
        needed = either(inverse(both(self.guard, self._alive())), condition)
        if needed is not True:
            self.demands.append((what, needed))

    def _alive(self) -> Condition:
        alive = inverse(self.frame.returned)
        for left in (*self.frame.broken, *self.frame.continued):
            alive = both(alive, inverse(left))
        return alive

    def value(self, node: Any) -> Value:
        """The value of an expression."""
        return getattr(self, f"_value_{type(node).__name__.lower()}")(node)

    def _value_constant(self, node: c_ast.Constant) -> Value:
        text = node.value.lower()
        digits = text.rstrip("ul")
        base = 16 if digits.startswith("0x") else 8 if digits.startswith("0") and digits != "0" else 10
        number = int(digits, base)
        unsigned, wide = "u" in text[len(digits) :], "l" in text[len(digits) :]
        for width in (64,) if wide else (32, 64):
            for signed in (True, False):
                allowed = not (signed and unsigned) and (signed or unsigned or base != 10)
                if allowed and number >> (width - signed) == 0:
                    return Value(Integer(width, signed), number)
        raise UnsupportedError(f"constant {text}")

    def _value_id(self, node: c_ast.ID) -> Value:
        if node.name in self.program.constants:
            return Value(INT, self.program.constants[node.name])
        return self._loaded(self.places(node))

    def _loaded(self, places: Places) -> Value:
        if isinstance(places[0][1].type, Array):
            return first_element(places)
        return read(places)

    def _value_structref(self, node: c_ast.StructRef) -> Value:
        return self._loaded(self.places(node))

    def _value_arrayref(self, node: c_ast.ArrayRef) -> Value:
        return self._loaded(self.places(node))

    def _value_compoundliteral(self, node: c_ast.CompoundLiteral) -> Value:
        return self._initial(self.program.type_of(node.type), node.init)

    def _value_cast(self, node: c_ast.Cast) -> Value:
        return convert(self.value(node.expr), self.program.type_of(node.to_type))

    def _value_unaryop(self, node: c_ast.UnaryOp) -> Value:
        operator = node.op
        if operator == "&":
            return pointer_to(self.places(node.expr))
        if operator == "*":
            return self._loaded(self.places(node))
        if operator == "sizeof":
            return Value(UNSIGNED_LONG, 0)  # of memset, memcpy and memcmp of whole objects only
        if operator in ("++", "--", "p++", "p--"):
            places = self.places(node.expr)
            before = read(places)
            one = Value(INT, 1)
            if isinstance(before.type, Pointer):
                after = moved(before, one if "+" in operator else Value(INT, -1))
            else:
                after = c_operators.binary(operator[-1], before, one, self._demand)
            self._assign(places, after)
            return before if operator[0] == "p" else read(places)
        return c_operators.unary(operator, self.value(node.expr), self._demand)

    def _value_binaryop(self, node: c_ast.BinaryOp) -> Value:
        left = self.value(node.left)
        if node.op in ("&&", "||"):
            known = truth(left)
            right = self._under(known if node.op == "&&" else inverse(known), node.right)
            joined = both if node.op == "&&" else either
            return Value(INT, joined(known, truth(right)) if right is not None else known)
        right = self.value(node.right)
        if isinstance(left.type, Pointer) and node.op in ("+", "-"):
            by = right if node.op == "+" else c_operators.unary("-", right, self._demand)
            return moved(left, by)
        return c_operators.binary(node.op, left, right, self._demand, self.opaque)

    def _under(self, condition: Condition, node: Any) -> Value | None:
        """The value of an operand that is evaluated under a condition only; None if it never is."""
        if condition is False:
            return None
        outside = self.guard
        self.guard = both(outside, condition)
        found = self.value(node)
        self.guard = outside
        return found

    def _value_ternaryop(self, node: c_ast.TernaryOp) -> Value:
        condition = truth(self.value(node.cond))
        then, other = self._under(condition, node.iftrue), self._under(inverse(condition), node.iffalse)
        if then is None or other is None:
            known = then or other
            assert known is not None
            return known
        if isinstance(then.type, Integer | type(BOOL)):
            if then.type == BOOL and other.type == BOOL:
                return Value(BOOL, choose(condition, then.bits, other.bits, BOOL))
            kind: Type = c_operators.common(then, other)
            then, other = convert(then, kind), convert(other, kind)
        else:
            kind = then.type
        return Value(kind, choose(condition, then.bits, other.bits, kind))

    def _value_assignment(self, node: c_ast.Assignment) -> Value:
        places = self.places(node.lvalue)
        new = self.value(node.rvalue)
        if node.op in ASSIGNMENTS:
            new = c_operators.binary(node.op[:-1], read(places), new, self._demand, self.opaque)
        self._assign(places, new)
        return read(places)

    def _assign(self, places: Places, new: Value) -> None:
        kind = places[0][1].type
        write(places, convert(new, kind), both(self.guard, self._alive()))

    def _value_exprlist(self, node: c_ast.ExprList) -> Value:
        return [self.value(expr) for expr in node.exprs][-1]

    def _value_funccall(self, node: c_ast.FuncCall) -> Value:
        name = node.name.name
        arguments = [self.value(argument) for argument in (node.args.exprs if node.args else ())]
        if name in ("memset", "memcpy"):
            return self._copy(name, arguments)
        return self.call(name, arguments)

    def _copy(self, name: str, arguments: list[Value]) -> Value:
        """memset() to 0 and memcpy(), of a whole object."""
        to, given = arguments[0], arguments[1]
        places = to.bits
        kind = places[0][1].type
        self._assign(places, Value(kind, zero(kind)) if name == "memset" else read(given.bits))
        return to

    def call(self, name: str, arguments: list[Value]) -> Value:
        """Call a function of the program."""
        raise NotImplementedError

    # ---- places ----

    def places(self, node: Any) -> Places:
        """Where an lvalue is."""
        if isinstance(node, c_ast.ID):
            cell = self.cell(node.name)
            return [(True, Place(cell, (), cell.type))]
        if isinstance(node, c_ast.CompoundLiteral | c_ast.FuncCall):
            made = self.value(node)
            return [(True, Place(Cell(made.type, made.bits), (), made.type))]
        if isinstance(node, c_ast.StructRef):
            base = self.value(node.name).bits if node.type == "->" else self.places(node.name)
            if not base:
                raise UnsupportedError(f"->{node.field.name} of a null pointer")
            return [(when, place.member(node.field.name)) for when, place in base]
        if isinstance(node, c_ast.UnaryOp) and node.op == "*":
            return self.value(node.expr).bits
        if isinstance(node, c_ast.ArrayRef):
            return self._elements(self.value(node.name), self.value(node.subscript))
        raise UnsupportedError(f"an lvalue {type(node).__name__}")

    def _elements(self, pointer: Value, index: Value) -> Places:
        found = moved(pointer, index).bits
        for when, place in found:
            outer = place.cell.type
            for key in place.path[:-1]:
                outer = outer.fields[key] if isinstance(key, str) else outer.element
            last = place.path[-1]
            where = Value(INT, last) if isinstance(last, int) else last
            outside = self.guard
            self.guard = both(outside, when)
            self._demand("an index within its array", within(where, outer.length))
            self.guard = outside
        return found
