# SPDX-License-Identifier: MIT
"""`$100`, `$110` and `$120` against the pulses: steps, speed and acceleration, by a judge of the pins."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from passo.axis_judge import shares
from passo.engine import model_engine
from passo.grbl_setup import machine_at
from passo.machine_file import read_machine
from passo.path import PathAxis, PathSettings
from passo.run import parameters_for
from passo.toolchain import paths
from passo_stm32.grbl_board import GrblBoard, grbl_elf

from tests.helpers.grbl_console import GrblConsole

MACHINE = read_machine(paths.examples / "gcode" / "machine.toml")
BOARD_HZ = 36_000_000
WAY = 16  # mm
REACHED = 0.95  # of each limit, at least; the judge's own bound is 1.03
# Steps per mm, mm/s, mm/s^2 of X, Y and Z. All of them reach their speed within the way.
TRIALS = [
    [(80, 40, 400), (160, 25, 250), (250.5, 10, 100)],
    [(120, 60, 900), (266.5, 50, 1500), (400, 20, 60)],
]
Line, Events = Callable[[str], None], Callable[[], np.ndarray]


def check(trial: list[tuple[float, float, float]], clock_hz: int, line: Line, events: Events) -> None:
    """Each axis travels alone, there and back, as fast as the settings allow."""
    for axis, values in enumerate(trial):
        for setting, value in zip((100, 110, 120), (values[0], values[1] * 60, values[2]), strict=True):
            line(f"${setting + axis}={value:g}")
    for axis, (scale, speed, acceleration) in enumerate(trial):
        for target, direction in ((WAY, 1), (0, -1)):
            line(f"G0 {'XYZ'[axis]}{target}")
            seen = events()
            assert made(seen, clock_hz, axis, scale, speed, acceleration) == direction * round(WAY * scale)


def made(
    events: np.ndarray, clock_hz: int, axis: int, scale: float, speed: float, acceleration: float
) -> int:
    """The steps of an axis, which alone has some; their speed and acceleration are those of the settings."""
    levels = np.concatenate([[0], events["step"].astype(np.int64)])
    rising = levels[1:] & ~levels[:-1]
    at = np.flatnonzero(rising >> axis & 1)
    assert not np.any(rising & ~(1 << axis))
    steps = np.where(events["dir"][at].astype(np.int64) >> axis & 1, -1, 1)
    clocks = (events["clock"][at] - events["clock"][at[0]]).astype(np.int64)
    settings = PathSettings((PathAxis(Fraction(scale), speed, acceleration),), clock_hz)
    for share in shares([clocks], [np.cumsum(steps)], settings, names=("speed", "acceleration")):
        assert REACHED < share.share < share.bound, share
    return int(steps.sum())


@pytest.mark.parametrize("trial", TRIALS, ids=["first", "second"])
def test_on_the_console(trial: list[tuple[float, float, float]]) -> None:
    with machine_at("model", MACHINE) as engine:
        session, seen, drain = GrblConsole(engine, MACHINE), [], engine.drain
        engine.drain = lambda: seen.append(drain())

        def line(text: str) -> None:
            seen.clear()
            assert session.line(text).endswith("ok")
            session.rest()

        check(trial, MACHINE.clock_hz, line, lambda: np.concatenate(seen))


def test_on_the_firmware() -> None:
    elf = grbl_elf(paths.build / "tests" / "firmware_grbl", "AXES=3")
    with model_engine(replace(parameters_for(3), clock_hz=BOARD_HZ), BOARD_HZ) as engine:
        board = GrblBoard(engine, elf)

        def line(text: str) -> None:
            board.events()
            assert board.line(text).endswith("ok")
            if text.startswith("G"):
                board.rest(10)

        check(TRIALS[0], BOARD_HZ, line, board.events)
