# SPDX-License-Identifier: MIT
"""A line of RS274NGC without its comments, in lower case and without blanks, read from left to right."""

import re

from passo.expand.place import NIST, LineError

NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)")
NAME = re.compile(r"<([^<>]+)>")


class Scanner:
    """Reads tokens at `at`; LineError says what is missing there."""

    def __init__(self, text: str):
        self.text, self.at = text, 0

    @property
    def rest(self) -> str:
        """What is not read yet."""
        return self.text[self.at :]

    @property
    def at_end(self) -> bool:
        """Whether all is read."""
        return self.at == len(self.text)

    @property
    def next(self) -> str:
        """The next character; empty at the end."""
        return self.text[self.at : self.at + 1]

    def take(self, token: str) -> bool:
        """Whether `token` comes next; it is read then."""
        if not self.text.startswith(token, self.at):
            return False
        self.at += len(token)
        return True

    def need(self, token: str, where: str) -> None:
        """Read `token`; raises LineError."""
        if not self.take(token):
            raise LineError(f"'{token}' is missing {where}, before '{self.rest}'", NIST)

    def match(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        """What `pattern` finds next; it is read then."""
        found = pattern.match(self.text, self.at)
        if found:
            self.at = found.end()
        return found

    def name(self) -> str:
        """A name in angle brackets; raises LineError."""
        found = self.match(NAME)
        if not found:
            raise LineError(f"a name in angle brackets is missing before '{self.rest}'")
        return found[1]
