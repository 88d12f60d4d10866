# SPDX-License-Identifier: MIT
"""Judges of the mutants in C that take long: pieces of what `make verify ONLY=soak` and the search for the
worst path play, each as a test of pytest. They judge what is promised at the pins, whatever the sources do.

    .venv/bin/python -m verify.mutants.run --only c --tests c_long
"""

from functools import cache

import pytest

from benchmarks.path_adversary import batch
from benchmarks.path_paths import MACHINES, MOTORS
from verify.soak.program import build, build_endings, play_program

SEED = 2  # the tests play those of 1
OPERATIONS = 13  # enum operation of verify/soak/endings/endings.h
ENDED, DIED, DISTURBED, PATHS = 12, 20, 60, 12  # histories, or paths, of a test


@cache
def _program(kind: str) -> str:
    return str(build() if kind == "driver" else build_endings())


def ahead() -> None:
    """The programs, with all mutants."""
    for kind in ("driver", "endings", "sessions"):
        _program(kind)


def _fails_nowhere(command: list[str], part: str) -> None:
    counts, failures = play_program(command, part, SEED)
    assert not failures, [f"{failure.again}: {failure.text}" for failure in failures]
    assert counts["histories"]


@pytest.mark.parametrize("first", range(0, 3 * ENDED, ENDED))
@pytest.mark.parametrize("operation", range(OPERATIONS))
def test_no_promise_is_broken_by_an_early_end(operation: int, first: int) -> None:
    """Whatever ends an operation."""
    command = [_program("endings"), "endings", str(SEED), str(first), str(ENDED), str(operation)]
    _fails_nowhere(command, "endings")


@pytest.mark.parametrize("first", range(0, 4 * DIED, DIED))
def test_no_promise_is_broken_by_the_death_of_a_host(first: int) -> None:
    """Nothing of it acts in the session of the next one."""
    _fails_nowhere([_program("sessions"), "sessions", str(SEED), str(first), str(DIED)], "sessions")


@pytest.mark.parametrize("first", range(0, 4 * DISTURBED, DISTURBED))
def test_a_bad_link_loses_no_move(first: int) -> None:
    """Each move is made once, or the driver reports an error."""
    _fails_nowhere([_program("driver"), str(SEED), str(first), str(DISTURBED), "--driver"], "driver")


@pytest.mark.parametrize("seed", range(5))
def test_paths_are_within_all_bounds(seed: int) -> None:
    """Time, steps and underruns of random paths."""
    assert batch(seed, PATHS, tuple(MACHINES)).beyond == {}


@pytest.mark.parametrize("seed", range(2))
def test_paths_of_motors_that_move_two_axes_are_within_all_bounds(seed: int) -> None:
    """The same, where the motors are not the axes."""
    assert batch(seed, PATHS, tuple(MOTORS)).beyond == {}
