# SPDX-License-Identifier: MIT
"""Errors that the command reports in one line."""


class Failure(Exception):  # noqa: N818 - the errors have it as their base
    """A mismatch or a fault: exit status 1."""


class BadInputError(ValueError):
    """The input is invalid: exit status 2."""


class BuildError(Failure):
    """What the command needs cannot be built; the text is the message of the compiler, or says why."""
