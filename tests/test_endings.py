# SPDX-License-Identifier: MIT
"""Every operation of the driver, ended early in every way at a random moment; hosts that die in one."""

import pytest
from passo import random_cases

from verify.soak.program import build_endings, play_program

SEED = random_cases.seed()
OPERATIONS = (
    *("move", "queue", "path", "stream", "jog", "endless", "goto"),
    *("home", "probe", "thread", "raster", "compare", "together"),
)  # as enum operation of verify/soak/endings/endings.h
LIMIT = 4  # enum ending
ENDED = 5


def play(kind: str, first: int, count: int, *only: int) -> dict[str, int]:
    """Histories, none of which breaks a promise; how many there were of each."""
    command = [build_endings(), kind, str(SEED), str(first), str(count), *map(str, only)]
    counts, failures = play_program(command, kind, SEED)
    assert not failures, [f"{failure.again}: {failure.text}" for failure in failures]
    assert counts["histories"] == count
    return counts


@pytest.mark.parametrize("operation", OPERATIONS)
def test_no_promise_is_broken_by_an_early_end(operation: str) -> None:
    """Whatever ends it."""
    counts = play("endings", 0, ENDED, OPERATIONS.index(operation))
    assert sum(count for name, count in counts.items() if name.startswith(f"{operation}:")) == ENDED


def test_a_limit_within_the_stop_of_a_probe() -> None:
    """A hard limit may override the soft stop of what was found: then it is not homed."""
    play("endings", 0, 8, OPERATIONS.index("probe"), LIMIT)


def test_no_promise_is_broken_by_the_death_of_a_host() -> None:
    """Nothing of it acts in the session of the next one."""
    play("sessions", 0, 20)
