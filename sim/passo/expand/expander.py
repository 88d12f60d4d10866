# SPDX-License-Identifier: MIT
"""From a program with parameters, expressions, O words and cutter compensation to plain lines."""

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from passo.expand.block import Word, split, texts, words_of
from passo.expand.expression import Value, integer
from passo.expand.flow import (
    FLOW,
    Body,
    Call,
    Choice,
    Label,
    Leave,
    Line,
    Loop,
    Program,
    Repeat,
    Return,
    Subroutine,
    number_label,
    read_program,
)
from passo.expand.height_map import HeightMap
from passo.expand.machine import Machine
from passo.expand.output import ENDS, Output, PlainLine
from passo.expand.parameters import ProgramParameters
from passo.expand.place import ExpandError, LineError, Place
from passo.expand.tools import Tool
from passo.failure import BadInputError
from passo.gcode import GcodeSettings, lines

LIMIT = 2_000_000  # lines executed in loops and subroutines
SUFFIX = ".ngc"
FILE_NAME = re.compile(r"[\w.+-]+")
PLAIN = re.compile(r"/?(?:[a-z][-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))*")
NEEDS = re.compile(  # in a line of block.split()
    r"[#\[]|[-+][-+]|g0*4[12](?![0-9])|g0*(?:7[46]|84)(?![0-9.])|m0*9[89](?![0-9])"
)
CALL, BACK = 98, 99


@dataclass(frozen=True)
class Options:
    """How to expand."""

    gcode: GcodeSettings = field(default_factory=lambda: GcodeSettings(axes=6, turn_counts=1))
    tools: dict[int, Tool] = field(default_factory=dict)
    at_zero: bool = False  # the machine is known: at 0, without offsets
    surface: HeightMap | None = None  # in machine coordinates, that probes touch; needs at_zero
    begin: Any = None  # with at_zero: a `struct passo_gcode` behind another program
    limit: int = LIMIT


def needs_expanding(text: bytes) -> bool:
    """Whether a file has something that only expanded files may have."""
    return any(FLOW.match(bare) or NEEDS.search(bare) for bare in (split(line)[0] for line in _lines(text)))


def expand_file(
    path: Path,
    options: Options,
    say: Callable[[str], None] = lambda text: None,
    data: bytes | None = None,
) -> list[PlainLine]:
    """The plain lines of a program; `say` gets the texts of PRINT; `data`: what the file has, if it is read.

    Raises BadInputError.
    """
    return _Run(path, options, say, data).run()


class _Left(Exception):  # noqa: N818 - not an error
    """`break` or `continue`."""

    def __init__(self, label: str, again: bool):
        self.label, self.again = label, again


class _Returned(Exception):  # noqa: N818
    """From a subroutine."""

    def __init__(self, value: Value | None):
        self.value = value


class _Ended(Exception):  # noqa: N818
    """M2 or M30."""


class _Run:
    """One run of a program."""

    def __init__(self, path: Path, options: Options, say: Callable[[str], None], data: bytes | None):
        self.options, self.say, self.path, self.folder = options, say, path, path.parent
        letters = options.gcode.axis_letters
        if options.surface and (missing := next((axis for axis in "XYZ" if axis not in letters), "")):
            raise BadInputError(f"{path}: the machine has no axis {missing} to probe a surface")
        self.machine = Machine(options.gcode, options.tools, options.at_zero, options.begin)
        self.parameters = ProgramParameters(self.machine)
        self.output = Output(self.machine, options.surface)
        self.program = _read(path) if data is None else read_program(path, _lines(data))
        self.files: dict[str, Program] = {}
        self.count, self.repeating = 0, 0

    def run(self) -> list[PlainLine]:
        self.output.begin(Place(self.path, 1))
        try:
            self._body(self.program.body)
            self.output.finish()
        except _Ended:
            self.output.finish()
        except _Returned:
            raise AssertionError("M99 is refused where it is not in a subroutine") from None
        return self.output.lines

    def _body(self, body: Body) -> None:
        for statement in body:
            self.parameters.line = statement.place.line
            if self.repeating:
                self._count(statement.place)
            try:
                self._statement(statement)
            except LineError as error:
                raise ExpandError(statement.place, error) from None

    def _count(self, place: Place) -> None:
        self.count += 1
        if self.count > self.options.limit:
            raise ExpandError(
                place,
                f"endless? {self.options.limit:,} lines were executed in loops and subroutines",
            )

    def _statement(self, statement: object) -> None:
        match statement:
            case Line():
                self._line(statement)
            case Choice():
                self._choice(statement)
            case Loop() | Repeat():
                self._loop(statement)
            case Call():
                self._call(statement)
            case Return():
                raise _Returned(statement.value)
            case Leave():
                raise _Left(statement.label, statement.again)

    def _line(self, line: Line) -> None:
        comments = line.comments
        if PLAIN.fullmatch(line.bare):
            words = words_of(line.bare)
            text = line.text.strip()
            assignments: list[tuple[int | str, float]] = []
        else:
            words, assignments = line.block().evaluate(self.parameters)
            text = ""
        if comments:
            comments = self._comments(comments)
            text = "" if comments != line.comments else text
        commands = {round(word.value) for word in words if word.letter == "M"}
        if commands & {CALL, BACK}:
            self._fanuc(line.place, words, commands)
        elif words or comments:
            self.output.take(text or " ".join([*map(str, words), *comments]), words, comments, line.place)
        for target, value in assignments:
            self.parameters.set(target, value)
        if commands & {*ENDS}:
            raise _Ended

    def _comments(self, comments: list[str]) -> list[str]:
        made = texts(comments, self.parameters)
        for comment in made:
            if comment.lower().startswith("(print,"):
                self.say(comment.split(",", 1)[1].strip(" )"))
        return made

    def _choice(self, choice: Choice) -> None:
        for place, condition, body in choice.branches:
            try:
                chosen = condition is None or condition(self.parameters) != 0
            except LineError as error:
                raise ExpandError(place, error) from None
            if chosen:
                self._body(body)
                return

    def _loop(self, loop: Loop | Repeat) -> None:
        self.repeating += 1
        left = self._repetitions(loop)
        while left > 0 if isinstance(loop, Repeat) else loop.late or loop.condition(self.parameters) != 0:
            left -= 1
            self._count(loop.place)
            try:
                self._body(loop.body)
            except _Left as leave:
                if leave.label != loop.label:
                    self.repeating -= 1
                    raise
                if not leave.again:
                    break
                continue  # a `do` as well begins again, without its condition
            self.parameters.line = loop.place.line
            if isinstance(loop, Loop) and loop.late and loop.condition(self.parameters) == 0:
                break
        self.repeating -= 1

    def _repetitions(self, loop: Loop | Repeat) -> int:
        return integer(loop.count(self.parameters), "the count of repeat") if isinstance(loop, Repeat) else 1

    def _call(self, call: Call) -> None:
        label = call.label if isinstance(call.label, str) else number_label(call.label(self.parameters))
        arguments = [argument(self.parameters) for argument in call.arguments]
        subroutine = self._subroutine(label)
        self.parameters.enter(arguments)
        self.repeating += 1
        value = subroutine.value
        try:
            self._body(subroutine.body)
        except _Returned as returned:
            value = returned.value
        self.parameters.returned = None if value is None else value(self.parameters)
        self.parameters.leave(keeps_arguments=False)
        self.repeating -= 1

    def _subroutine(self, label: str) -> Subroutine:
        """In a file that is read, or in one of its name beside the program; raises LineError."""
        for program in (self.program, *self.files.values()):
            if label in program.subroutines:
                return program.subroutines[label]
        if not FILE_NAME.fullmatch(label):
            raise LineError(f"there is no subroutine {label}, and no file can have this name")
        path = self.folder / f"{label}{SUFFIX}"
        if not path.is_file():
            raise LineError(f"there is no subroutine {label}, neither in this file nor as {path}")
        self.files[label] = _read(path)
        if label not in self.files[label].subroutines:
            raise LineError(f"{path} has no subroutine {label}")
        return self.files[label].subroutines[label]

    def _fanuc(self, place: Place, words: list[Word], commands: set[int]) -> None:
        """M98 P L calls what follows `O` and the number, M99 returns."""
        if BACK in commands:
            if not self.parameters.level:
                raise LineError("M99 of the main program repeats it without end: write M2 or M30")
            raise _Returned(None)
        values = {word.letter: word.value for word in words}
        if "P" not in values or values.keys() - {"M", "N", "P", "L"}:
            raise LineError("M98 takes P, the number of a subroutine, and L, how often; nothing else")
        label, times = number_label(values["P"]), integer(values.get("L", 1.0), "L")
        for _ in range(times):
            self._count(place)
            self.parameters.enter(None)
            self.repeating += 1
            try:
                self._body(self._after(label))
            except _Returned:
                pass
            else:
                raise LineError(f"the subroutine O{label} has no M99")
            self.parameters.leave(keeps_arguments=True)
            self.repeating -= 1

    def _after(self, label: str) -> Body:
        for at, statement in enumerate(self.program.body):
            if isinstance(statement, Label) and statement.label == label:
                return self.program.body[at:]
        raise LineError(f"there is no subroutine O{label} in this file")


def _read(path: Path) -> Program:
    try:
        return read_program(path, _lines(path.read_bytes()))
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None


def _lines(text: bytes) -> list[str]:
    return [line.decode("utf-8", "replace") for line in lines(text)]
