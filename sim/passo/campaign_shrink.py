# SPDX-License-Identifier: MIT
"""The smallest case that fails as a given one does."""

from collections.abc import Callable, Iterator
from copy import deepcopy

from passo.campaign_case import Table

TRIES_MAX = 400
ENDS = ("start_speed", "stop_speed")
DIGITS = 2


def shrink(case: Table, fails: Callable[[Table], bool]) -> Table:
    """Simplify a failing case step by step, as long as it fails."""
    tries = 0
    again = True
    while again:
        again = False
        for simpler in _simpler(case):
            tries += 1
            if tries > TRIES_MAX:
                return case
            if fails(simpler):
                case, again = simpler, True
                break
    return case


def _simpler(case: Table) -> Iterator[Table]:
    """Cases that are a little simpler, the boldest steps first."""
    moves = case["move"]
    for number in range(len(moves)):
        if len(moves) > 1:
            yield {**case, "move": moves[:number] + moves[number + 1 :]}
    for axis in range(len(moves[0]["steps"])):
        fewer = [{**move, "steps": move["steps"][:axis] + move["steps"][axis + 1 :]} for move in moves]
        if all(any(move["steps"]) for move in fewer):
            yield {**case, "move": fewer}
    for number, move in enumerate(moves):
        for simpler in _simpler_moves(move):
            yield {**case, "move": [*moves[:number], simpler, *moves[number + 1 :]]}
    for key in case["pins"]:
        if case["pins"][key] != 1 / case["clock_hz"]:
            yield {**case, "pins": {**case["pins"], key: 1 / case["clock_hz"]}}


def _simpler_moves(move: Table) -> Iterator[Table]:
    steps = move["steps"]
    for axis, count in enumerate(steps):
        for less in {0, int(count / 2), abs(count)} - {count}:
            fewer = [*steps[:axis], less, *steps[axis + 1 :]]
            if any(fewer):
                yield {**move, "steps": fewer}
    if move.get("profile", "linear") != "linear":
        yield {**move, "profile": "linear"}
    for key in ENDS:
        if move.get(key):
            yield {**move, key: 0}
    for key, value in move.items():
        if isinstance(value, float) and (rounder := float(f"{value:.{DIGITS}g}")) != value:
            yield {**deepcopy(move), key: rounder}
