# SPDX-License-Identifier: MIT
"""Executes C on unknown values: every statement with the condition under which it is reached.

Both branches of an if are executed, each write under its condition, so a function has one path however
many its branches are. Loops must end after a number of turns that does not depend on unknown values. Whatever
C leaves undefined (overflow, shifts too far, indexes out of range) is a demand that has to be proved too.
"""

from __future__ import annotations

from typing import Any

from pycparser import c_ast

from verify.equal import c_operators
from verify.equal.c_aggregates import choose, copied
from verify.equal.c_expressions import Expressions
from verify.equal.c_objects import Frame
from verify.equal.c_places import Cell
from verify.equal.c_types import (
    Condition,
    Pointer,
    UnsupportedError,
    Value,
    Void,
    both,
    convert,
    either,
    inverse,
    truth,
)

TURNS_MAX = 1024  # of a loop


class Evaluator(Expressions):
    """Executes functions of a program."""

    def call(self, name: str, arguments: list[Value]) -> Value:
        """Call a function of the program."""
        function = self.program.functions.get(name)
        if function is None:
            raise UnsupportedError(f"no function {name}")
        decl = function.decl.type
        outside, guard = self.frame, both(self.guard, self._alive())
        frame = Frame()
        parameters = [p for p in (decl.args.params if decl.args else ()) if getattr(p, "name", None)]
        for parameter, argument in zip(parameters, arguments, strict=True):
            node = parameter.type
            kind = Pointer(self.program.type_of(node.type)) if isinstance(node, c_ast.ArrayDecl) else None
            kind = kind or self.program.type_of(node)
            frame.scopes[0][parameter.name] = Cell(kind, copied(convert(argument, kind).bits), guard)
        result = self.program.type_of(decl.type)
        if not isinstance(result, Void):
            frame.result = Value(result, None)
        outer_guard, self.guard, self.frame = self.guard, guard, frame
        self.execute(function.body)
        self.guard, self.frame = outer_guard, outside
        return frame.result if frame.result is not None else Value(Void(), None)

    # ---- statements ----

    def execute(self, node: Any) -> None:
        """Execute a statement."""
        if both(self.guard, self._alive()) is not False:
            handler = getattr(self, f"_do_{type(node).__name__.lower()}", None)
            if handler is not None:
                handler(node)
            else:
                self.value(node)

    def _do_compound(self, node: c_ast.Compound) -> None:
        self.frame.scopes.append({})
        for item in node.block_items or ():
            self.execute(item)
        self.frame.scopes.pop()

    def _do_decl(self, node: c_ast.Decl) -> None:
        if node.name is not None:
            guard = both(self.guard, self._alive())
            self.frame.scopes[-1][node.name] = self._declared(node, node.name, guard)

    def _do_decllist(self, node: c_ast.DeclList) -> None:
        for decl in node.decls:
            self._do_decl(decl)

    def _do_emptystatement(self, _node: c_ast.EmptyStatement) -> None:
        pass

    def _do_return(self, node: c_ast.Return) -> None:
        live = both(self.guard, self._alive())
        frame = self.frame
        if node.expr is not None:
            assert frame.result is not None
            new = convert(self.value(node.expr), frame.result.type)
            bits = new.bits
            if frame.result.bits is not None:
                bits = choose(live, bits, frame.result.bits, new.type)
            frame.result = Value(new.type, copied(bits))
        # what follows the statement in a branch is reached only if the branch is not
        frame.returned = either(frame.returned, live)

    def _do_if(self, node: c_ast.If) -> None:
        condition = truth(self.value(node.cond))
        outside = self.guard
        for taken, branch in ((condition, node.iftrue), (inverse(condition), node.iffalse)):
            if branch is not None and taken is not False:
                self.guard = both(outside, taken)
                self.execute(branch)
        self.guard = outside

    def _do_break(self, _node: c_ast.Break) -> None:
        self.frame.broken[-1] = either(self.frame.broken[-1], both(self.guard, self._alive()))

    def _do_continue(self, _node: c_ast.Continue) -> None:
        self.frame.continued[-1] = either(self.frame.continued[-1], both(self.guard, self._alive()))

    def _do_for(self, node: c_ast.For) -> None:
        self.frame.scopes.append({})
        if node.init is not None:
            self.execute(node.init)
        self._loop(node.cond, node.stmt, node.next)
        self.frame.scopes.pop()

    def _do_while(self, node: c_ast.While) -> None:
        self._loop(node.cond, node.stmt, None)

    def _loop(self, condition: Any, body: Any, following: Any) -> None:
        outside = self.guard
        self.frame.broken.append(False)
        for _ in range(TURNS_MAX):
            goes_on = truth(self.value(condition)) if condition is not None else True
            if goes_on is False or both(self.guard, self._alive()) is False:
                break
            self.guard = both(self.guard, goes_on)
            self.frame.continued.append(False)
            self.execute(body)
            self.frame.continued.pop()
            if following is not None:
                self.value(following)
        else:
            raise UnsupportedError("a loop whose end depends on unknown values")
        self.frame.broken.pop()
        self.guard = outside

    def _do_switch(self, node: c_ast.Switch) -> None:
        chosen = self.value(node.cond)
        outside = self.guard
        cases = node.stmt.block_items or ()
        labels = [c_operators.binary("==", chosen, self.value(case.expr), self._demand).bits
                  for case in cases if isinstance(case, c_ast.Case)]  # fmt: skip
        none: Condition = True
        for label in labels:
            none = both(none, inverse(label))
        self.frame.broken.append(False)
        entered: Condition = False
        remaining = iter(labels)
        for case in cases:
            if not isinstance(case, c_ast.Case | c_ast.Default):
                raise UnsupportedError("a statement between the cases of a switch")
            entered = either(entered, next(remaining) if isinstance(case, c_ast.Case) else none)
            self.guard = both(outside, entered)
            for statement in case.stmts or ():
                self.execute(statement)
        self.guard = outside
        self.frame.broken.pop()
