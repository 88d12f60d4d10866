# SPDX-License-Identifier: MIT
"""Values of RS274NGC: numbers, parameters, and expressions in brackets, in binary floating point as LinuxCNC.

A value is compiled once and evaluated whenever its line is executed.
"""

import math
import operator
from collections.abc import Callable
from typing import Protocol

from passo.expand.place import NIST, LineError
from passo.expand.scanner import NUMBER, Scanner

EQUAL = 1e-4  # numbers nearer than this are EQ
INTEGER = 1e-4  # and an integer may be off by this


class Parameters(Protocol):
    """What values refer to. `number` and `name` raise LineError for what cannot be known."""

    def number(self, index: int) -> float:
        """A numbered parameter."""

    def name(self, name: str) -> float:
        """A named parameter."""

    def exists(self, name: str) -> bool:
        """Whether there is a named parameter."""


Value = Callable[[Parameters], float]


def integer(value: float, what: str) -> int:
    """A value that must be an integer; raises LineError."""
    near = round(value)
    if abs(value - near) > INTEGER:
        raise LineError(f"{what} must be an integer, not {value:g}", NIST)
    return near


def read_value(scanner: Scanner) -> Value:
    """A number, parameter, function or bracket, with a sign or several; raises LineError."""
    if found := scanner.match(NUMBER):
        constant = float(found[0])
        return lambda parameters: constant
    if scanner.take("+"):
        return read_value(scanner)
    if scanner.take("-"):
        negated = read_value(scanner)
        return lambda parameters: -negated(parameters)
    if scanner.next == "[":
        return read_bracket(scanner)
    if scanner.next == "#":
        return _parameter(scanner)
    for name in FUNCTIONS:
        if scanner.take(name):
            return _function(scanner, name)
    before = f" before '{scanner.rest}'" if scanner.rest else ""
    raise LineError(f"a value is missing{before}: write a number, #, [ or a function", NIST)


def read_bracket(scanner: Scanner) -> Value:
    """An expression in brackets; raises LineError."""
    scanner.need("[", "around an expression")
    value = _operation(scanner, 0)
    scanner.need("]", "at the end of an expression")
    return value


def read_index(scanner: Scanner) -> Value:
    """The index of a numbered parameter, after the #."""
    return read_value(scanner)


def _parameter(scanner: Scanner) -> Value:
    scanner.need("#", "before a parameter")
    if scanner.next == "<":
        name = scanner.name()
        return lambda parameters: parameters.name(name)
    index = read_index(scanner)
    return lambda parameters: parameters.number(integer(index(parameters), "a parameter number"))


def _operation(scanner: Scanner, level: int) -> Value:
    """Operators of a level and those that bind more tightly; all are left-associative."""
    if level == len(OPERATORS):
        return read_value(scanner)
    left = _operation(scanner, level + 1)
    while function := _operator(scanner, level):
        left = _binary(function, left, _operation(scanner, level + 1))
    return left


def _operator(scanner: Scanner, level: int) -> Callable[[float, float], float] | None:
    if level == TIMES and scanner.rest.startswith("**"):
        return None
    for token, function in OPERATORS[level].items():
        if scanner.take(token):
            return function
    return None


def _binary(function: Callable[[float, float], float], left: Value, right: Value) -> Value:
    return lambda parameters: _finite(function(left(parameters), right(parameters)))


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise LineError("the result is too large", NIST)
    return value


def _function(scanner: Scanner, name: str) -> Value:
    if name == "exists":
        scanner.need("[", "after EXISTS")
        scanner.need("#", "in EXISTS, which takes a named parameter")
        asked = scanner.name()
        scanner.need("]", "after EXISTS")
        return lambda parameters: float(parameters.exists(asked))
    argument = read_bracket(scanner)
    if name == "atan":
        scanner.need("/", "after ATAN[y], which is written ATAN[y]/[x]")
        other = read_bracket(scanner)
        return lambda parameters: math.degrees(math.atan2(argument(parameters), other(parameters)))
    function = FUNCTIONS[name]
    return lambda parameters: _called(name, function, argument(parameters))


def _called(name: str, function: Callable[[float], float], argument: float) -> float:
    try:
        return _finite(function(argument))
    except (ValueError, OverflowError):
        raise LineError(f"{name.upper()}[{argument:g}] has no value", NIST) from None


def _power(base: float, exponent: float) -> float:
    try:
        return math.pow(base, exponent)
    except (ValueError, OverflowError):
        raise LineError(f"{base:g} ** {exponent:g} has no value", NIST) from None


def _divide(left: float, right: float) -> float:
    if right == 0:
        raise LineError("division by zero", NIST)
    return left / right


def _modulo(left: float, right: float) -> float:
    if right == 0:
        raise LineError("MOD by zero", NIST)
    rest = math.fmod(left, right)
    return rest + abs(right) if rest < 0 else rest


def _round(value: float) -> float:
    return float(math.trunc(value + math.copysign(0.5, value)))


FUNCTIONS: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "acos": lambda value: math.degrees(math.acos(value)),
    "asin": lambda value: math.degrees(math.asin(value)),
    "atan": math.atan,  # of two arguments: _function()
    "cos": lambda value: math.cos(math.radians(value)),
    "exists": bool,  # of a name: _function()
    "exp": math.exp,
    "fix": lambda value: float(math.floor(value)),
    "fup": lambda value: float(math.ceil(value)),
    "ln": math.log,
    "round": _round,
    "sin": lambda value: math.sin(math.radians(value)),
    "sqrt": math.sqrt,
    "tan": lambda value: math.tan(math.radians(value)),
}
# From the loosest to the tightest.
OPERATORS: tuple[dict[str, Callable[[float, float], float]], ...] = (
    {
        "and": lambda a, b: float(a != 0 and b != 0),
        "or": lambda a, b: float(a != 0 or b != 0),
        "xor": lambda a, b: float((a != 0) != (b != 0)),
    },
    {
        "eq": lambda a, b: float(abs(a - b) < EQUAL),
        "ne": lambda a, b: float(abs(a - b) >= EQUAL),
        "gt": lambda a, b: float(a > b),
        "ge": lambda a, b: float(a >= b),
        "lt": lambda a, b: float(a < b),
        "le": lambda a, b: float(a <= b),
    },
    {"+": operator.add, "-": operator.sub},
    {"*": operator.mul, "/": _divide, "mod": _modulo},
    {"**": _power},
)
TIMES = 3
