# SPDX-License-Identifier: MIT
"""Reads a board.toml key by key; errors name board, key and reason."""

import re
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

P = TypeVar("P")

_NEEDED: Any = object()  # marks a required key


class BoardError(ValueError):
    """Unknown board, or invalid table."""


class TableError(BoardError):
    """A key of a table is invalid or missing."""

    def __init__(self, board: str, key: str, reason: str) -> None:
        super().__init__(f"board '{board}': {key}: {reason}")


class Table:
    """A table from which each key is taken once; `end` rejects the remaining keys."""

    def __init__(self, board: str, where: str, facts: dict[str, Any]) -> None:
        self.board = board
        self._where = where
        self._facts = dict(facts)
        self._known: set[str] = set()

    @classmethod
    def read(cls, board: str, path: Path) -> "Table":
        """Read a file."""
        try:
            return cls(board, "", tomllib.loads(path.read_text(encoding="utf-8")))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise TableError(board, path.name, str(error)) from None

    def error(self, key: str, reason: str) -> TableError:
        """An error about a key."""
        return TableError(self.board, self._path(key), reason)

    def has(self, key: str) -> bool:
        """Whether the table has a key."""
        self._known.add(key)
        return key in self._facts

    def is_table(self, key: str) -> bool:
        """Whether the value of a key is a table."""
        return isinstance(self._facts.get(key), dict)

    def is_list(self, key: str) -> bool:
        """Whether the value of a key is a list."""
        return isinstance(self._facts.get(key), list)

    def text(self, key: str, default: str = _NEEDED) -> str:
        """A string."""
        return self._take(key, default, "a text", lambda value: isinstance(value, str) and value != "")

    def texts(self, key: str, default: Sequence[str] = _NEEDED) -> tuple[str, ...]:
        """A list of strings."""

        def fits(value: Any) -> bool:
            return isinstance(value, list) and all(isinstance(text, str) for text in value)

        return tuple(self._take(key, default, "a list of texts", fits))

    def number(self, key: str) -> float:
        """A number above 0."""
        return self._take(
            key, _NEEDED, "a number above 0", lambda value: type(value) in (int, float) and value > 0
        )

    def flag(self, key: str) -> bool:
        """A boolean, default False."""
        return self._take(key, False, "true or false", lambda value: isinstance(value, bool))

    def choice(self, key: str, possible: Sequence[str], default: str = _NEEDED) -> str:
        """One of several strings."""
        return self._take(key, default, f"one of {', '.join(possible)}", lambda value: value in possible)

    def pin(self, key: str) -> str:
        """The name or number of a pin."""

        def fits(value: Any) -> bool:
            return type(value) is int or (isinstance(value, str) and re.fullmatch(r"\w+", value) is not None)

        return str(self._take(key, _NEEDED, "the name or number of a pin", fits))

    def pins(self, key: str, pin: Callable[["Table", str], P]) -> tuple[P, ...]:
        """A list of one or more pins, each read by `pin` as a key of a table."""
        found = self._take(
            key, _NEEDED, "a list of pins", lambda value: isinstance(value, list) and value != []
        )
        each = Table(self.board, "", {f"{self._path(key)}[{n}]": value for n, value in enumerate(found)})
        return tuple(pin(each, name) for name in each._facts)

    def levels(self, key: str, axes: int) -> tuple[int, ...]:
        """A level for each axis, or one for all."""

        def fits(value: Any) -> bool:
            levels = value if isinstance(value, list) else [value]
            return all(type(level) is int and level in (0, 1) for level in levels) and (
                levels is not value or len(levels) == axes
            )

        value = self._take(key, _NEEDED, f"0 or 1, or a list of {axes} of these", fits)
        return tuple(value) if isinstance(value, list) else (value,) * axes

    def table(self, key: str, default: dict[str, Any] = _NEEDED) -> "Table":
        """A nested table."""
        facts = self._take(key, default, "a table", lambda value: isinstance(value, dict))
        return Table(self.board, self._path(key), facts)

    def tables(self, key: str) -> list["Table"]:
        """A list of one or more tables."""

        def fits(value: Any) -> bool:
            return isinstance(value, list) and value != [] and all(isinstance(each, dict) for each in value)

        found = self._take(key, _NEEDED, "a list of tables", fits)
        return [Table(self.board, f"{self._path(key)}[{n}]", facts) for n, facts in enumerate(found)]

    def end(self) -> None:
        """Reject keys that have not been taken."""
        for key in self._facts:
            if key not in self._known:
                known = ", ".join(sorted(self._known))
                raise self.error(key, f"unknown key; must be one of {known}")

    def _take(self, key: str, default: Any, what: str, fits: Any) -> Any:
        self._known.add(key)
        if key not in self._facts:
            if default is _NEEDED:
                raise self.error(key, f"missing; must be {what}")
            return default
        value = self._facts[key]
        if not fits(value):
            raise self.error(key, f"must be {what}, not {value!r}")
        return value

    def _path(self, key: str) -> str:
        return f"{self._where}.{key}" if self._where else key
