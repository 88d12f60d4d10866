# SPDX-License-Identifier: MIT
"""Formulas of user-defined shapes."""

import ast
import math
import operator
from collections.abc import Callable

from passo.shape import ShapeError

OPERATORS = {
    **{ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv},
    **{ast.Pow: math.pow, ast.USub: operator.neg, ast.UAdd: operator.pos},
}
FUNCTIONS: dict[str, Callable[..., float]] = {
    **{"sin": math.sin, "cos": math.cos, "tan": math.tan, "atan": math.atan, "tanh": math.tanh},
    **{"exp": math.exp, "log": math.log, "sqrt": math.sqrt, "abs": abs, "min": min, "max": max},
}
CONSTANTS = {"pi": math.pi, "e": math.e}
FORMULA_MAX = 500  # characters


def formula(text: str) -> Callable[[float], float]:
    """Parse a function of u: numbers, u, pi, e, + - * / ^, parentheses and the functions in FUNCTIONS.

    Raises ShapeError, and so does the returned function where it has no finite value.
    """
    if len(text) > FORMULA_MAX:
        raise ShapeError(f"a formula must have at most {FORMULA_MAX} characters")
    if not text.strip():
        raise ShapeError("the formula is empty")
    try:
        tree = ast.parse(text.replace("^", "**").strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ShapeError(f"not a formula: {text[:60]}") from None
    _check(tree)

    def evaluate(u: float) -> float:
        try:
            value = _value(tree, u)
        except (ArithmeticError, ValueError, TypeError):
            raise ShapeError(f"the formula has no value at u = {u:g}") from None
        if not isinstance(value, float | int) or not math.isfinite(value):
            raise ShapeError(f"the formula has no value at u = {u:g}")
        return value

    return evaluate


def _check(node: ast.expr) -> None:
    """Accept only arithmetic, so that nothing else can be evaluated."""
    match node:
        case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
            pass
        case ast.Name(id=name) if name == "u" or name in CONSTANTS:
            pass
        case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
            _check(left)
            _check(right)
        case ast.UnaryOp(op=op, operand=operand) if type(op) in OPERATORS:
            _check(operand)
        case ast.Call(func=ast.Name(id=name), args=[_, *_], keywords=[]) if name in FUNCTIONS:
            for argument in node.args:
                _check(argument)
        case _:
            raise ShapeError(f"a formula cannot contain {ast.unparse(node)[:60]!r}")


def _value(node: ast.expr, u: float) -> float:
    match node:
        case ast.Constant(value=value):
            return float(value)
        case ast.Name(id=name):
            return u if name == "u" else CONSTANTS[name]
        case ast.BinOp(left=left, op=op, right=right):
            return OPERATORS[type(op)](_value(left, u), _value(right, u))
        case ast.UnaryOp(op=op, operand=operand):
            return OPERATORS[type(op)](_value(operand, u))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return FUNCTIONS[name](*(_value(argument, u) for argument in arguments))
    raise AssertionError(node)
