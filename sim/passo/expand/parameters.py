# SPDX-License-Identifier: MIT
"""Numbered and named parameters: the program's own, and those that tell the state of the machine."""

from collections.abc import Callable, Iterable
from typing import TypeVar

from passo.expand.machine import POSITIONS, Machine
from passo.expand.place import LineError, StateError, UnsureError

ARGUMENTS = range(1, 31)  # of a subroutine: its own
LAST = 5601
OWN = range(1, 5061)  # the rest tells the state of the machine
LEVELS = 10  # of calls, as LinuxCNC
T = TypeVar("T")
V = TypeVar("V")


class ProgramParameters:
    """All parameters while a program runs."""

    def __init__(self, machine: Machine):
        self.machine = machine
        self.line = 0
        self.returned: float | None = None
        self._numbers: dict[int, float] = {}
        self._globals: dict[str, float] = {}
        self._locals: list[dict[str, float]] = [{}]
        self._arguments: list[dict[int, float]] = []
        self._unsure: set[int | str] = set()
        self._left_out = self._names_left_out = False

    @property
    def level(self) -> int:
        """Calls that have not returned."""
        return len(self._locals) - 1

    def leave_out(self, targets: Iterable[int | str] = (), any_name: bool = False) -> None:
        """A line that sets these, or `any_name`, is left out; what depends on it raises UnsureError."""
        self._left_out = True
        self._names_left_out |= any_name
        self._unsure.update(targets)

    def number(self, index: int) -> float:
        """A numbered parameter; 0 if it was not set. Raises LineError for a state that is not known."""
        if index in self._unsure:
            raise UnsureError
        if not 1 <= index <= LAST:
            raise LineError(f"there is no parameter #{index}: 1 to {LAST}")
        if index in OWN:
            return self._numbers.get(index, 0.0)
        return self._of_machine(self.machine.number, index)

    def name(self, name: str) -> float:
        """A named parameter; raises LineError."""
        own = self._scope(name)
        if name in self._unsure:
            raise UnsureError
        if name in own:
            return own[name]
        if name == "_value":
            return self.returned or 0.0
        if name == "_value_returned":
            return float(self.returned is not None)
        if name == "_call_level":
            return float(self.level)
        if name == "_line":
            return float(self.line)
        value = self._of_machine(self.machine.name, name)
        if value is None:
            if self._names_left_out:
                raise UnsureError
            raise LineError(f"#<{name}> was not set: write #<{name}>=... before")
        return value

    def exists(self, name: str) -> bool:
        """Whether a named parameter can be read, now or on a machine."""
        if name in self._scope(name):
            return True
        try:
            self.name(name)
        except UnsureError:
            raise
        except LineError:
            return Machine.has_name(name)
        return True

    def set(self, target: int | str, value: float) -> None:
        """Set a parameter; raises LineError."""
        if isinstance(target, int):
            if target not in OWN:
                raise LineError(_refusal(target))
            self._numbers[target] = value
            self._unsure.discard(target)
        elif target not in self._scope(target) and self.exists(target):
            raise LineError(f"#<{target}> is read-only: use another name")
        else:
            self._scope(target)[target] = value
            self._unsure.discard(target)

    def enter(self, arguments: list[float] | None) -> None:
        """Begin a subroutine; without arguments it has those of its caller. Raises LineError."""
        if self.level + 1 >= LEVELS:
            raise LineError(f"subroutines are nested deeper than {LEVELS - 1}, as is an endless recursion")
        self._locals.append({})
        self._arguments.append({index: self._numbers.get(index, 0.0) for index in ARGUMENTS})
        if arguments is not None:
            for index in ARGUMENTS:
                self._numbers[index] = arguments[index - 1] if index <= len(arguments) else 0.0

    def leave(self, keeps_arguments: bool) -> None:
        """End it."""
        self._locals.pop()
        before = self._arguments.pop()
        if not keeps_arguments:
            self._numbers.update(before)

    def _of_machine(self, read: Callable[[T], V], which: T) -> V:
        """What the machine says of itself."""
        try:
            return read(which)
        except StateError:
            if self._left_out:
                raise UnsureError from None
            raise

    def _scope(self, name: str) -> dict[str, float]:
        return self._globals if name.startswith("_") else self._locals[-1]


def _refusal(index: int) -> str:
    if not 1 <= index <= LAST:
        return f"there is no parameter #{index}: 1 to {LAST}"
    if index in POSITIONS:
        return f"#{index} is read-only: write G92 or G10 L20"
    return f"#{index} cannot be set: write G10 L2, G28.1, G30.1 or G92"
