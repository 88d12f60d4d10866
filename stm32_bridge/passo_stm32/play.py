# SPDX-License-Identifier: MIT
"""Moves typed at the console of the firmware, and the same moves planned on the PC for the C model."""

import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from passo.build import Parameters
from passo.engine import EVENT, Engine, model_engine, rtl_engine
from passo.move_file import read_channels
from passo.moves import AXES_MAX, Channels, MoveFile, MoveFileError
from passo.plan import Plan, plan_move
from passo.run import execute, parameters_of

from passo_stm32.board import Board, Motion, motions
from passo_stm32.lines import move_lines, pin_lines, read_toml


@dataclass
class Played:
    """Result of one move."""

    line: str
    plan: Plan
    made: Motion
    expected: Motion
    seconds: float  # planned length in simulated time

    @property
    def difference(self) -> str:
        """First difference between the pulses made and expected; empty if there is none."""
        return self.made.same_as(self.expected)


def with_clock(path: Path, clock_hz: int, folder: Path) -> Path:
    """Copy a move file with another clock, and the tables in its folder; return its path."""
    copy = folder / path.name
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise MoveFileError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise MoveFileError(f"{path}: not a UTF-8 text file") from None
    lines = [f"clock_hz = {clock_hz}" if line.startswith("clock_hz") else line for line in lines]
    copy.write_text("\n".join(lines) + "\n", encoding="utf-8")
    for table in path.parent.glob("*.csv"):
        (folder / table.name).write_bytes(table.read_bytes())
    return copy


def channels_of(path: Path, clock_hz: int) -> Channels:
    """Read a move file, for a core with this clock."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            channels = read_channels(with_clock(path, clock_hz, Path(folder)))
        except MoveFileError as error:
            told = str(error).replace(str(Path(folder) / path.name), str(path))
            raise MoveFileError(told.replace(folder, str(path.parent))) from None
    if channels.setup:
        raise MoveFileError(f"{path}: a [machine] is not simulated here: use passo run")
    return channels


def on_the_model(file: MoveFile, number: int, plan: Plan, parameters: Parameters) -> Motion:
    """The pulses of one move, planned on the PC and executed on the C model."""
    one = replace(file, moves=(file.moves[number],))
    with model_engine(parameters, file.clock_hz) as engine:
        run = execute(one, [plan], engine)  # its events are those of its channel alone
    if problems := run.problems():
        raise AssertionError(problems[0])
    events = np.zeros(len(run.pins), EVENT)
    for name in ("clock", "step", "dir", "running"):
        events[name] = run.pins[name]
    (motion,) = motions(events)
    return motion


def type_move(
    board: Board, lines: list[str], seconds: float, channel: int = 0, axes: int = AXES_MAX
) -> Motion:
    """Type the lines of one move; return the pulses of its channel, which has `axes` axes."""
    board.events()
    for line in lines:
        board.must(line)
    board.wait_motion(seconds)
    (motion,) = motions(board.events(), channel, axes)
    return motion


def play(
    path: Path,
    clock_hz: int,
    engine: str = "rtl",
    progress: Callable[[int], None] = lambda clocks: None,
) -> tuple[list[Played], Board, float]:
    """Type all moves of a file, each after the previous one has ended.

    Returns the moves, the board and the real time in seconds.
    """
    began = time.monotonic()
    data = read_toml(path)
    channels = channels_of(path, clock_hz)
    parameters = parameters_of(channels)
    core: Engine = rtl_engine(parameters, clock_hz) if engine == "rtl" else model_engine(parameters, clock_hz)
    board = Board(core)
    for file in channels.files:
        for line in pin_lines(data, file.axes, file.channel):
            board.must(line)
    typed = move_lines(data, path.parent)
    moves = [(file.number(index), file, index) for file in channels.files for index in range(len(file.moves))]
    played, clocks = [], 0
    for place, file, number in sorted(moves, key=lambda move: move[0]):
        lines = typed[place - 1]
        plan = plan_move(file.moves[number], clock_hz, parameters)
        made = type_move(board, lines, plan.clocks / clock_hz, file.channel, parameters.axes)
        expected = on_the_model(file, number, plan, parameters)
        played.append(Played(lines[-1], plan, made, expected, plan.clocks / clock_hz))
        clocks += plan.clocks
        progress(clocks)
    return played, board, time.monotonic() - began


def planned_clocks(path: Path, clock_hz: int) -> int:
    """Total length of the moves of a file in clocks."""
    channels = channels_of(path, clock_hz)
    parameters = parameters_of(channels)
    return sum(plan_move(move, clock_hz, parameters).clocks for file in channels.files for move in file.moves)
