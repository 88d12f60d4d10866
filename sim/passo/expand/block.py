# SPDX-License-Identifier: MIT
"""A line of RS274NGC: its words, its assignments, its comments."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from passo.expand.expression import Parameters, Value, integer, read_index, read_value
from passo.expand.place import NIST, LineError, UnsureError
from passo.expand.scanner import Scanner

COMMENT = re.compile(r"\(([^)\r\n]*)\)?|;([^\r\n]*)")
SHOWN = re.compile(r"#(?:<(?P<name>[^>]*)>|(?P<index>[0-9]+))|%(?:(?P<integer>d)|l?f|\.(?P<digits>[0-9])f)")
UNKNOWN = "######"
WORD = re.compile(r"([a-z])([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))")
BLANK = re.compile(r"[\x00-\x20]+")  # what an interpreter ignores
VALUES_SHOWN = ("debug", "print", "log")
DIGITS = 6  # after the point: those that Passo keeps


@dataclass(frozen=True)
class Word:
    """A letter and its value."""

    letter: str
    value: float

    def __str__(self) -> str:
        return self.letter + shown(self.value)

    @property
    def code(self) -> int:
        """The number of a command in tenths: 410 for G41, 411 for G41.1."""
        return round(self.value * 10)


def words_of(text: str) -> list[Word]:
    """The words of a plain line."""
    return [Word(letter.upper(), float(value)) for letter, value in WORD.findall(split(text)[0])]


def shown(value: float) -> str:
    """A number to a millionth, without zeros at its end."""
    text = f"{value:.{DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def split(text: str) -> tuple[str, list[str]]:
    """A line without comments and blanks in lower case, and its comments."""
    comments = [found[0] for found in COMMENT.finditer(text)]
    bare = COMMENT.sub("", text) if comments else text
    return BLANK.sub("", bare.lower()).lstrip("\ufeff").strip("%"), comments


def texts(comments: Iterable[str], parameters: Parameters) -> list[str]:
    """Comments with the values of the parameters in those that show them."""
    return [
        _filled(comment, parameters) if comment.lstrip("(; ").lower().startswith(VALUES_SHOWN) else comment
        for comment in comments
    ]


def _filled(comment: str, parameters: Parameters) -> str:
    """With values for parameters; %d, %f and %.2f set the digits of those that follow."""
    digits = DIGITS

    def fill(found: re.Match[str]) -> str:
        nonlocal digits
        if found["name"] is None and found["index"] is None:
            digits = 0 if found["integer"] else int(found["digits"] or DIGITS)
            return ""
        try:
            name = found["name"]
            value = (
                parameters.number(int(found["index"]))
                if name is None
                else parameters.name("".join(name.lower().split()))
            )
        except LineError:
            return UNKNOWN
        return f"{value:.{digits}f}"

    return SHOWN.sub(fill, comment)


class Block:
    """What a line says, compiled."""

    def __init__(self, text: str):
        """Of a line without comments, in lower case and without blanks; raises LineError."""
        self.words: list[tuple[str, Value]] = []
        self.assignments: list[tuple[Value | str, Value]] = []
        scanner = Scanner(text)
        scanner.take("/")
        try:
            while not scanner.at_end:
                self._read(scanner)
        except RecursionError:
            raise LineError("brackets are nested too deeply", NIST) from None

    def _read(self, scanner: Scanner) -> None:
        if scanner.take("#"):
            target = scanner.name() if scanner.next == "<" else read_index(scanner)
            scanner.need("=", "after the parameter that is set")
            self.assignments.append((target, read_value(scanner)))
            return
        letter = scanner.next
        if not ("a" <= letter <= "z"):
            raise LineError(f"'{letter}' is no word: write a letter and a value", NIST)
        scanner.take(letter)
        try:
            self.words.append((letter.upper(), read_value(scanner)))
        except LineError as error:
            raise _of_word(letter.upper(), error) from None

    def evaluate(self, parameters: Parameters) -> tuple[list[Word], list[tuple[int | str, float]]]:
        """The words and what the assignments set, all with the values before the line."""
        words = []
        for letter, value in self.words:
            try:
                words.append(Word(letter, value(parameters)))
            except LineError as error:
                raise _of_word(letter, error) from None
        made: list[tuple[int | str, float]] = []
        for target, value in self.assignments:
            place = target if isinstance(target, str) else integer(target(parameters), "a parameter number")
            made.append((place, value(parameters)))
        return words, made


def _of_word(letter: str, error: LineError) -> LineError:
    """An error of its value."""
    if isinstance(error, UnsureError):
        return error
    return type(error)(f"word {letter}: {error.reason}", error.norm)
