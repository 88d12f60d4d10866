# SPDX-License-Identifier: MIT
"""Parameters of moves, one class for each form; units as in spec/moves.toml."""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import get_args

from passo import move_forms
from passo.failure import BadInputError
from passo.move_forms import (
    UNIT_Q32,
    MoveAtSpeed,
    MoveAxes,
    MoveBelowSpeed,
    MoveBySpeed,
    MoveHome,
    MoveInTime,
    MoveJerk,
    MoveProbe,
    MoveSigmoid,
    MoveThread,
)
from passo.registers import ADDRESS_CHANNEL_COUNT, AXIS_STEP_TIMING_STEP_HIGH_BITS, CHANNEL_AXIS_COUNT
from passo.setup import Setup

AXES_MAX = CHANNEL_AXIS_COUNT
CHANNELS_MAX = ADDRESS_CHANNEL_COUNT
PIN_CLOCKS_MAX = (1 << AXIS_STEP_TIMING_STEP_HIGH_BITS) - 1


class MoveFileError(BadInputError):
    """A move file cannot be executed; the text is the reason, in one line."""


@dataclass(frozen=True)
class PinTiming:
    """Pin timing of an axis in clocks, 1 .. PIN_CLOCKS_MAX each."""

    step_high: int = 1
    step_low: int = 1
    dir_setup: int = 1
    dir_hold: int = 1


class MoveTurn(move_forms.MoveTurn):
    """Rotation of one axis by degrees and rpm."""

    @cached_property
    def steps(self) -> tuple[int, ...]:
        """Steps of each axis, rounded like the planner."""
        count = (q32(abs(self.angle)) * self.steps_per_turn + 180 * UNIT_Q32) // (360 * UNIT_Q32)
        return tuple((count if self.angle > 0 else -count) * (i == self.axis) for i in range(self.axes))


class MoveStraight(move_forms.MoveStraight):
    """Straight line in millimeters, with limits for each axis."""

    @property
    def profile(self) -> str:
        """Profile of the ramps."""
        return "jerk" if any(self.jerk) else "linear"

    @cached_property
    def steps(self) -> tuple[int, ...]:
        """Steps of each axis, rounded like the planner."""
        counts = (
            (q32(abs(d)) * q32(scale) + (1 << 63)) >> 64
            for d, scale in zip(self.distance, self.steps_per_mm, strict=True)
        )
        return tuple(n if d > 0 else -n for n, d in zip(counts, self.distance, strict=True))


Move = (
    MoveInTime
    | MoveBySpeed
    | MoveBelowSpeed
    | MoveAtSpeed
    | MoveAxes
    | MoveTurn
    | MoveSigmoid
    | MoveJerk
    | MoveStraight
)
Task = MoveHome | MoveProbe | MoveThread

# By name of the form.
MOVES: dict[str, type[Move]] = {move.form.name: move for move in get_args(Move)}
TASK_TYPES: dict[str, type[Task]] = {task.form.name: task for task in get_args(Task)}


def q32(value: Fraction) -> int:
    """Convert to UQ32.32 or Q31.32, rounded to nearest."""
    return round(value * UNIT_Q32)


@dataclass(frozen=True)
class MoveFile:
    """The checked moves of a file, all of one channel and with the same number of axes."""

    path: Path
    clock_hz: int
    pins: PinTiming
    moves: tuple[Move | Task, ...]  # tasks only in a file with a setup
    channel: int = 0
    numbers: tuple[int, ...] = ()  # of the moves in the file; empty: from 1 on

    @property
    def name(self) -> str:
        """Name of the results."""
        return self.path.stem

    @property
    def axes(self) -> int:
        """Number of axes of each move."""
        return len(self.moves[0].steps)

    def number(self, index: int) -> int:
        """Number of a move in the file, from 1 on."""
        return self.numbers[index] if self.numbers else index + 1


@dataclass(frozen=True)
class Channels:
    """A checked move file: the moves of each of its channels, in ascending order."""

    path: Path
    together: bool  # they start on one clock
    files: tuple[MoveFile, ...]
    setup: Setup | None = None  # the machine and the events, if it has any

    @property
    def name(self) -> str:
        """Name of the results."""
        return self.path.stem

    @property
    def clock_hz(self) -> int:
        """Clock of the core."""
        return self.files[0].clock_hz

    @property
    def several(self) -> bool:
        """A channel other than 0 is in use."""
        return self.files[-1].channel > 0
