# SPDX-License-Identifier: MIT
"""Errors that the command reports in one line. Each can be raised in another process."""

from typing import Any


class Portable(Exception):  # noqa: N818 - part of others
    """What its constructor takes may differ from what it says: another process makes it of both."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args), self.__dict__


def _again(kind: type[Portable], says: tuple[Any, ...]) -> Portable:
    made = kind.__new__(kind)
    made.args = says
    return made


class Failure(Portable):
    """A mismatch or a fault: exit status 1."""


class BadInputError(Portable, ValueError):
    """The input is invalid: exit status 2."""


class BuildError(Failure):
    """What the command needs cannot be built; the text is the message of the compiler, or says why."""
