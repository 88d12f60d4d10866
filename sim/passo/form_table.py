# SPDX-License-Identifier: MIT
"""What move_forms.py is made of: forms of a move, their keys and rules."""

from dataclasses import dataclass

Points = tuple[int, ...]  # the points of a user's shape; empty with any other profile


@dataclass(frozen=True)
class Key:
    """A key of a form, and what its value becomes in the struct of the planner."""

    name: str
    kind: str
    member: str | None  # of the struct
    factor: int | str | None = None  # "clock_hz": times the clock; none: as it is
    default: int | str | None = None  # a number, or the name of another key
    low: int = 0  # of a whole number
    high: int = 0
    file_only: bool = False


@dataclass(frozen=True)
class Rule:
    """What is checked when all keys are read: `key` excludes the other, needs it, or is above zero."""

    kind: str
    key: str
    other: str


@dataclass(frozen=True)
class Form:
    """A form of a move: passo_plan_NAME() plans it."""

    name: str
    keys: tuple[Key, ...]
    rules: tuple[Rule, ...] = ()
    told_by: str | None = None  # the key that tells it, so that `method` need not
