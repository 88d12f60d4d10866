# SPDX-License-Identifier: MIT
"""The structure of a program: its O words, as a tree of statements."""

import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from passo.expand.block import Block, split
from passo.expand.expression import Value, integer, read_bracket, read_value
from passo.expand.place import ExpandError, LineError, Place, ProgramError
from passo.expand.scanner import Scanner

FLOW = re.compile(r"/?(n[0-9]+)?o(?=[0-9<\[#])")
LABEL = re.compile(r"[0-9]+")
KEYWORDS = (
    *("elseif", "else", "endif", "endwhile", "endrepeat", "endsub"),
    *("sub", "call", "return", "if", "while", "do", "repeat", "break", "continue"),
)
ENDS = {"while": "endwhile", "do": "while", "repeat": "endrepeat", "if": "endif", "sub": "endsub"}
ARGUMENTS_MAX = 30
WITH_VALUE = {"if", "elseif", "while", "repeat"}
SIMPLE = re.compile(rf"(?:[0-9]+|<[^<>]+>)(?P<keyword>{'|'.join(KEYWORDS)})")
LAST = re.compile(r"m(?:0*2|0*30)(?![0-9.])")  # M2, M30


@dataclass
class Line:
    """A line without an O word; compiled when it is first executed, since LinuxCNC reads no line it skips."""

    place: Place
    text: str  # as in the file, without its end
    bare: str
    comments: list[str]
    compiled: Block | None = None

    def block(self) -> Block:
        """What it says; raises LineError."""
        if self.compiled is None:
            self.compiled = Block(self.bare)
        return self.compiled


@dataclass
class Call:
    """Of a subroutine, by name or by a number that is evaluated; Fanuc's is without arguments of its own."""

    place: Place
    label: str | Value
    arguments: list[Value]


@dataclass
class Return:
    """To the caller."""

    place: Place
    value: Value | None


@dataclass
class Choice:
    """Conditions and what each is for; the condition of `else` is None."""

    place: Place
    branches: list[tuple[Place, Value | None, "Body"]]


@dataclass
class Loop:
    """`while` or `do`: `late` is tested after the body."""

    place: Place
    label: str
    condition: Value
    body: "Body"
    late: bool


@dataclass
class Repeat:
    """A number of times."""

    place: Place
    label: str
    count: Value
    body: "Body"


@dataclass
class Leave:
    """`break`, or `continue` with `again`."""

    place: Place
    label: str
    again: bool


@dataclass
class Label:
    """`O1000` alone: the number of a program, or the begin of a subroutine of M98."""

    place: Place
    label: str


@dataclass
class Subroutine:
    """From `sub` to `endsub`."""

    place: Place
    label: str
    body: "Body"
    value: Value | None  # of endsub


Statement = Line | Call | Return | Choice | Loop | Repeat | Leave | Label
Body = list[Statement]


@dataclass
class Program:
    """A file."""

    path: Path
    body: Body
    subroutines: dict[str, Subroutine]
    lines: list[Line]  # all without an O word


@dataclass
class _Word:
    """An O word."""

    place: Place
    label: str | Value
    keyword: str  # empty: alone
    values: list[Value]

    @property
    def name(self) -> str:
        """As in an error."""
        label = self.label if isinstance(self.label, str) else "[...]"
        return f"O{label if label.isdigit() else f'<{label}>'} {self.keyword}"


@dataclass
class _Open:
    """A construct whose end is awaited; `told`: an error has named it."""

    word: _Word
    body: Body
    told: bool = False
    branches: list[tuple[Place, Value | None, Body]] = field(default_factory=list)


def read_program(path: Path, lines: list[str]) -> Program:
    """The tree of a file; raises ProgramError: all wrong O words, and other lines that cannot be read."""
    return _Builder(path).read(lines)


class _Builder:
    def __init__(self, path: Path):
        self.program = Program(path, [], {}, [])
        self.stack: list[_Open] = []
        self.labels: set[tuple[str, str]] = set()
        self.body = self.program.body

    def read(self, lines: list[str]) -> Program:
        wrong: dict[Place, ExpandError] = {}
        for number, text in enumerate(lines, 1):
            place = Place(self.program.path, number)
            bare, comments = split(text)
            try:
                if found := FLOW.match(bare):
                    self._read(place, bare[found.end() :])
                else:
                    line = Line(place, text, bare, comments)
                    self.body.append(line)
                    self.program.lines.append(line)
            except LineError as error:
                wrong[place] = ExpandError(place, error)
        for opened in self.stack:
            if not opened.told:
                word, end = opened.word, ENDS[opened.word.keyword]
                missing = ExpandError(word.place, LineError(f"{word.name} has no {end}"))
                wrong.setdefault(word.place, missing)
        if wrong:
            raise ProgramError([*wrong.values(), *unreadable(self.program.lines)])
        return self.program

    def _read(self, place: Place, text: str) -> None:
        """What follows an O; with wrong expressions it is taken without them, as what follows needs it."""
        try:
            word = _word(place, text)
        except LineError:
            if found := SIMPLE.match(text):
                with suppress(LineError):
                    self._take(_word(place, found[0] + "[0]" * (found["keyword"] in WITH_VALUE)))
            raise
        self._take(word)

    def _take(self, word: _Word) -> None:
        match word.keyword:
            case "":
                self.body.append(Label(word.place, _label(word)))
            case "call":
                self.body.append(Call(word.place, word.label, word.values))
            case "return":
                if not any(opened.word.keyword == "sub" for opened in self.stack):
                    raise LineError(f"{word.name} is not in a subroutine: write it between sub and endsub")
                self.body.append(Return(word.place, word.values[0] if word.values else None))
            case "break" | "continue":
                self._leave(word)
            case "while" if self._closes(word, "do"):
                self._close(word)
            case "sub" | "while" | "do" | "repeat" | "if":
                self._open(word)
            case "elseif" | "else":
                self._branch(word)
            case _:
                self._close(word)

    def _leave(self, word: _Word) -> None:
        loops = [o.word.label for o in self.stack if o.word.keyword in ("while", "do", "repeat")]
        if word.label not in loops:
            raise LineError(f"{word.name} is in no loop of this label")
        self.body.append(Leave(word.place, _label(word), word.keyword == "continue"))

    def _open(self, word: _Word) -> None:
        label = _label(word)
        wrong = self._misplaced(word, label)
        opened = _Open(word, [])
        if word.keyword == "if":
            opened.branches.append((word.place, word.values[0], opened.body))
        self.stack.append(opened)
        self.body = opened.body
        if wrong:  # its end belongs to it all the same
            raise LineError(f"{word.name}{wrong}")

    def _misplaced(self, word: _Word, label: str) -> str:
        """What is wrong with a construct that begins here."""
        if word.keyword == "sub":
            if self.stack:
                return f" is within {self.stack[-1].word.name}"
            if label in self.program.subroutines:
                return f" is in line {self.program.subroutines[label].place.line} already: write another name"
            return ""
        scope = str(next((o.word.label for o in self.stack if o.word.keyword == "sub"), ""))
        known = (scope, label) in self.labels
        self.labels.add((scope, label))
        return ": another construct has this label: write another one" if known else ""

    def _branch(self, word: _Word) -> None:
        opened = self._opened(word, "if")
        if opened.branches[-1][1] is None:
            raise LineError(f"{word.name} is behind else")
        self.body = []
        condition = word.values[0] if word.keyword == "elseif" else None
        opened.branches.append((word.place, condition, self.body))

    def _closes(self, word: _Word, keyword: str) -> bool:
        return (
            bool(self.stack)
            and self.stack[-1].word.keyword == keyword
            and self.stack[-1].word.label == word.label
        )

    def _opened(self, word: _Word, keyword: str) -> _Open:
        if not self._closes(word, keyword):
            inner = f": {self.stack[-1].word.name} is open" if self.stack else ""
            if self.stack:
                self.stack[-1].told = True
            raise LineError(f"{word.name} has no {keyword}{inner}")
        return self.stack[-1]

    def _close(self, word: _Word) -> None:
        keyword = next(begin for begin, end in ENDS.items() if end == word.keyword)
        opened = self._opened(word, keyword)
        begin, label = opened.word, _label(word)
        self.stack.pop()
        self.body = (
            self.stack[-1].branches[-1][2]
            if self.stack and self.stack[-1].branches
            else (self.stack[-1].body if self.stack else self.program.body)
        )
        match keyword:
            case "sub":
                value = word.values[0] if word.values else None
                self.program.subroutines[label] = Subroutine(begin.place, label, opened.body, value)
            case "if":
                self.body.append(Choice(begin.place, opened.branches))
            case "repeat":
                self.body.append(Repeat(begin.place, label, begin.values[0], opened.body))
            case "while":
                self.body.append(Loop(begin.place, label, begin.values[0], opened.body, False))
            case "do":
                self.body.append(Loop(word.place, label, word.values[0], opened.body, True))


def unreadable(lines: Iterable[Line]) -> Iterator[ExpandError]:
    """The errors of lines that are not executed: of their words alone. Behind M2 and M30 nothing is read."""
    for line in lines:
        try:
            line.block()
        except LineError as error:
            yield ExpandError(line.place, error)
        if LAST.search(line.bare):
            return


def _label(word: _Word) -> str:
    if not isinstance(word.label, str):
        raise LineError("only call may have an expression as its label")
    return word.label


def _word(place: Place, text: str) -> _Word:
    """What follows the O."""
    scanner = Scanner(text)
    label: str | Value
    if found := scanner.match(LABEL):
        label = str(int(found[0]))
    elif scanner.next == "<":
        label = scanner.name()
    else:
        index = read_value(scanner)
        label = index
    if scanner.at_end:
        return _Word(place, label, "", [])
    keyword = next((word for word in KEYWORDS if scanner.take(word)), None)
    if keyword is None:
        raise LineError(f"O: '{scanner.rest}' is none of {', '.join(KEYWORDS)}")
    values = []
    while not scanner.at_end:
        values.append(read_bracket(scanner))
    least, most = {
        "if": (1, 1), "elseif": (1, 1), "while": (1, 1), "repeat": (1, 1),
        "return": (0, 1), "endsub": (0, 1), "call": (0, ARGUMENTS_MAX),
    }.get(keyword, (0, 0))  # fmt: skip
    if not least <= len(values) <= most:
        wanted = str(least) if least == most else f"{least} to {most}"
        raise LineError(f"O {keyword} takes {wanted} expressions in brackets, not {len(values)}")
    return _Word(place, label, keyword, values)


def number_label(value: float) -> str:
    """The label that an expression names; raises LineError."""
    return str(integer(value, "the label of a call"))
