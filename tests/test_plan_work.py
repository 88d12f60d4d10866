# SPDX-License-Identifier: MIT
"""How much work it is to find the highest speed of a move that is too short for its speed.

A small controller plans between two moves. The roots of 128 bits are the longest steps: one in each round of
the search, and one before it.
"""

import ctypes
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from passo.compiler import library, sources
from passo.native import load
from passo.toolchain import paths

from tests.helpers.plans import Machine, make_move, q32

ROUNDS = 4  # for two ramps alike
MOST = 6


@cache
def built() -> Path:
    """The planner, which counts."""
    folders = (paths.planner, paths.protocol)
    files = [*sources(*folders), paths.tests / "plan_work.c"]
    return library("plan_work", folders, files, "-O1", "-Wl,--wrap=passo_isqrt128")


def ahead() -> None:
    """What takes long."""
    built()


def roots(fields: dict[str, Any]) -> int:
    """Of planning a move."""
    count = ctypes.c_uint.in_dll(ctypes.CDLL(str(built())), "passo_roots")
    before = count.value
    make_move(load(built()), Machine(16_000_000), "jerk", fields)
    return count.value - before


def move(steps: int, **changes: int) -> dict[str, Any]:
    """Its speed is far above what it reaches."""
    fields = {"start_speed": 0, "stop_speed": 0, "speed": q32(400_000)}
    return {"steps": (steps,), **fields, "acceleration": q32(4_000_000), "jerk": q32(20_000_000), **changes}


@pytest.mark.parametrize("steps", [1, 3, 10, 30, 100, 300, 1000, 3000, 10_000])
def test_a_short_move_from_rest_to_rest(steps: int) -> None:
    """The search begins near its end, whatever the speed that is asked for."""
    assert roots(move(steps)) <= 1 + ROUNDS


@pytest.mark.parametrize("ends", [(400_000, 1000), (100_000, 1000)])
def test_a_short_move_that_is_too_fast_at_its_start(ends: tuple[int, int]) -> None:
    """It has no way up: the way down alone says how fast it may begin."""
    start, stop = map(q32, ends)
    assert roots(move(30, start_speed=start, stop_speed=stop)) <= 1 + ROUNDS


@pytest.mark.parametrize("ends", [(1000, 1000), (1000, 0), (0, 3000), (500, 5000)])
@pytest.mark.parametrize("steps", [300, 3000])
def test_a_short_move_between_two_speeds(steps: int, ends: tuple[int, int]) -> None:
    """A few rounds more where its ramps differ."""
    start, stop = map(q32, ends)
    assert roots(move(steps, start_speed=start, stop_speed=stop)) <= 1 + MOST
