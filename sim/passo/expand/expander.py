# SPDX-License-Identifier: MIT
"""From a program with parameters, expressions, O words and cutter compensation to plain lines."""

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NoReturn

from passo.expand.block import Word, split, texts, words_of
from passo.expand.expression import Value, integer
from passo.expand.flow import (
    FLOW,
    LAST,
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
    Statement,
    Subroutine,
    number_label,
    read_program,
    unreadable,
)
from passo.expand.height_map import HeightMap
from passo.expand.machine import Machine
from passo.expand.output import ENDS, Output, PlainLine
from passo.expand.parameters import ProgramParameters
from passo.expand.place import (
    FANUC,
    ContourError,
    ExpandError,
    LineError,
    Place,
    ProgramError,
    StateError,
    UnsureError,
)
from passo.expand.tools import Tool
from passo.failure import BadInputError
from passo.gcode import GcodeError, GcodeSettings, check_text, lines

LIMIT = 2_000_000  # lines executed in loops and subroutines
SUFFIX = ".ngc"
FILE_NAME = re.compile(r"[\w.+-]+")
PLAIN = re.compile(r"/?(?:[a-z][-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+))*")
NEEDS = re.compile(  # in a line of block.split()
    r"[#\[]|[-+][-+]|g0*4[12](?![0-9])|g0*(?:7[46]|84)(?![0-9.])|m0*9[89](?![0-9])"
)
CALL, BACK = 98, 99
CALLS = re.compile(r"m0*98(?![0-9.])")
SET = re.compile(r"#(?:([0-9]+)|<([^<>]+)>)=")  # what a line sets
MOVES = re.compile(r"[abcxyz]")
AFTER = 20_000  # lines that are still executed behind one that is refused
# Errors of the interpreter that may follow from a line before that was left out.
FOLLOWING = tuple(f"{GcodeError(number)}: " for number in (22, 31, 32, 33, 34, 42))
STOPS = "of the lines behind it only the words are checked"


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

    Raises BadInputError: ProgramError of all lines that are refused, as far as the others can be executed.
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


class _Stopped(Exception):  # noqa: N818
    """What follows cannot be executed."""


class _Run:
    """One run of a program; a line that is refused is left out."""

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
        self.refused: dict[Place, ExpandError] = {}
        self.limit = options.limit

    def run(self) -> list[PlainLine]:
        self.output.begin(Place(self.path, 1))
        try:
            with suppress(_Ended):
                self._body(self.program.body)
            self.output.finish(check=not self.refused)
        except _Returned:
            raise AssertionError("M99 is refused where it is not in a subroutine") from None
        except _Stopped:
            for error in unreadable(self.program.lines):
                self.refused.setdefault(error.place, error)
        except ExpandError as error:
            self._refuse(error)
        if self.refused:
            raise ProgramError([*self.refused.values()], self.output.lines)
        return self.output.lines

    def _refuse(self, error: ExpandError, targets: Sequence[int | str] = (), any_name: bool = False) -> None:
        """Leave out a line that would have set `targets`; what follows from another one is not said."""
        why = error.why
        follows = isinstance(why, StateError) or (isinstance(why, str) and why.startswith(FOLLOWING))
        if not isinstance(why, UnsureError) and not (follows and self.refused):
            for one in error.each:
                self.refused.setdefault(one.place, one)
        self.limit = min(self.limit, self.count + AFTER)
        self.parameters.leave_out(targets, any_name)

    def _stop(self, error: ExpandError) -> NoReturn:
        """Where a program continues is not known."""
        told = ExpandError(error.place, f"{error.reason}; {STOPS}")
        self.refused.setdefault(error.place, told)
        raise _Stopped

    def _body(self, body: Body) -> None:
        for statement in body:
            self.parameters.line = statement.place.line
            if self.repeating:
                self._count(statement.place)
            try:
                self._statement(statement)
            except LineError as error:
                self._leave_out(statement, ExpandError(statement.place, error))
            except ExpandError as error:
                self._leave_out(statement, error)

    def _leave_out(self, statement: Statement, error: ExpandError) -> None:
        """A statement cannot be executed: the next one is, unless it depends on this one."""
        if isinstance(statement, Line):
            targets = [int(number) if number else name for number, name in SET.findall(statement.bare)]
            self._refuse(error, targets, any_name=bool(CALLS.search(statement.bare)))
            if isinstance(error, ContourError) or MOVES.search(statement.bare):
                self.output.drop_contour()
            if LAST.search(statement.bare):
                raise _Ended
        elif isinstance(statement, Call):
            self._refuse(error, ["_value"], any_name=True)
        else:
            self._stop(error)

    def _count(self, place: Place) -> None:
        self.count += 1
        if self.count > self.limit:
            if self.limit < self.options.limit:
                raise _Stopped
            many = f"{self.options.limit:,} lines were executed in loops and subroutines"
            self._refuse(ExpandError(place, LineError(f"endless? {many}")))
            raise _Stopped

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
                self._stop(ExpandError(place, error))
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
        try:
            self.parameters.returned = None if value is None else value(self.parameters)
        finally:
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
                raise LineError("M99 of the main program repeats it without end: write M2 or M30", FANUC)
            raise _Returned(None)
        values = {word.letter: word.value for word in words}
        if "P" not in values or values.keys() - {"M", "N", "P", "L"}:
            raise LineError("M98 takes P, the number of a subroutine, and L, how often; nothing else", FANUC)
        label, times = number_label(values["P"]), integer(values.get("L", 1.0), "L")
        body = self._after(label)
        for _ in range(times):
            self._count(place)
            self.parameters.enter(None)
            self.repeating += 1
            try:
                self._body(body)
            except _Returned:
                pass
            else:
                raise LineError(f"the subroutine O{label} has no M99", FANUC)
            finally:
                self.parameters.leave(keeps_arguments=True)
                self.repeating -= 1

    def _after(self, label: str) -> Body:
        for at, statement in enumerate(self.program.body):
            if isinstance(statement, Label) and statement.label == label:
                return self.program.body[at:]
        raise LineError(f"there is no subroutine O{label} in this file", FANUC)


def _read(path: Path) -> Program:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise BadInputError(f"{path}: {error.strerror}") from None
    check_text(path, data)
    return read_program(path, _lines(data))


def _lines(text: bytes) -> list[str]:
    return [line.decode("utf-8", "replace") for line in lines(text)]
