# SPDX-License-Identifier: MIT
"""The types of move_forms.py: move forms, their keys and rules."""

from dataclasses import dataclass
from fractions import Fraction

Points = tuple[int, ...]  # points of a user-defined shape; empty for other profiles


@dataclass(frozen=True)
class Shaper:
    """An input shaper, and the resonance that it is for; see passo/shaper.py."""

    name: str
    frequency: Fraction  # Hz
    damping: Fraction  # of 1, critical


@dataclass(frozen=True)
class Place:
    """A position as written, in steps or millimeters."""

    value: Fraction
    in_mm: bool = False


@dataclass(frozen=True)
class Key:
    """A key of a form, and the conversion of its value for the planner's struct."""

    name: str
    kind: str
    member: str | None  # struct member; None: not in the struct
    factor: int | str | None = None  # scale in the struct; "clock_hz": the clock; None: 1
    default: int | str | None = None  # a number, a word, or the name of another key
    low: int = 0  # range of an integer
    high: int = 0
    choices: tuple[str, ...] = ()  # of a word
    file_only: bool = False
    optional: bool = False  # None without it


@dataclass(frozen=True)
class Rule:
    """A rule checked after all keys are read: `key` excludes `other`, needs it, or must be above 0."""

    kind: str
    key: str
    other: str


@dataclass(frozen=True)
class Form:
    """A move form, planned by passo_plan_NAME()."""

    name: str
    keys: tuple[Key, ...]
    rules: tuple[Rule, ...] = ()
    told_by: str | None = None  # the key that identifies the form when `method` is missing
