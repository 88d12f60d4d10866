# SPDX-License-Identifier: MIT
"""A case of a campaign: random moves, played and judged from outside.

A case is a function of the seed and of its number, so any worker can repeat it.
"""

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from passo.curve import step_errors
from passo.driver import DriverError
from passo.engine import DifferenceError
from passo.failure import BadInputError, Failure
from passo.move_file import parse_moves
from passo.plan import PlanError, plan_file
from passo.run import Run, execute, open_engine, parameters_for

Table = dict[str, Any]

CLOCKS = (12_000_000, 16_000_000, 50_000_000, 64_000_000, 72_000_000, 99_999_989, 100_000_000)
ENGINES = {"model": "model", "rtl": "both"}  # of the command line: the engine that plays
AXES = 4
MOVES_MAX = 4  # in a file
STEPS_MAX = 400  # of a move; a tenth of them are longer
LONG_STEPS_MAX = 20_000
SECONDS_MAX = 0.1  # that a move should take
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
PIN_KEYS = ("step_high", "step_low", "dir_setup", "dir_hold")
# Of a step, from the ideal curve: rounding to whole clocks and substeps, see docs/accuracy.md.
ERROR_MAX = 1.0


@dataclass(frozen=True)
class Verdict:
    """What came of a case. ``kind``: "exact", "refused" (by a documented error), or a kind of failure."""

    kind: str
    says: str = ""
    moves: int = 0
    steps: int = 0

    @property
    def good(self) -> bool:
        """Whether nothing is wrong."""
        return self.kind in ("exact", "refused")


def draw(seed: int, number: int) -> Table:
    """The move file of a case, as tables of TOML."""
    rng = random.Random(f"{seed} {number}")
    clock_hz = rng.choice(CLOCKS)
    axes = rng.randint(1, AXES)
    clocks = {key: rng.choice((1, 2, 20, 100, rng.randint(1, 300))) for key in PIN_KEYS}
    pins = {key: value / clock_hz for key, value in clocks.items()}
    return {"clock_hz": clock_hz, "pins": pins, "move": [_move(rng, axes) for _ in range(moves_of(number))]}


def moves_of(number: int) -> int:
    """Moves of a case."""
    return 1 + number % MOVES_MAX


def cases_for(moves: int) -> int:
    """Cases, from 0 on, that have so many moves or a few more."""
    per_round = sum(map(moves_of, range(MOVES_MAX)))
    cases = moves // per_round * MOVES_MAX
    left = moves % per_round
    while left > 0:
        left -= moves_of(cases)
        cases += 1
    return cases


def _log_uniform(rng: random.Random, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _steps(rng: random.Random, axes: int) -> list[int]:
    most = LONG_STEPS_MAX if rng.random() < 0.1 else STEPS_MAX
    longest = max(1, round(_log_uniform(rng, 1, most)))
    steps = [rng.choice((0, 1, longest, rng.randint(0, longest))) for _ in range(axes)]
    steps[rng.randrange(axes)] = longest
    return [rng.choice((1, -1)) * n for n in steps]


def _rounded(value: float) -> float:
    """As somebody would write it."""
    return float(f"{value:.6g}")


def _move(rng: random.Random, axes: int) -> Table:
    """A move of any form, of which most are possible."""
    steps = _steps(rng, axes)
    longest = max(map(abs, steps))
    seconds = _log_uniform(rng, SECONDS_MAX / 100, SECONDS_MAX)
    mean = longest / seconds
    speed, acceleration = _rounded(mean * rng.uniform(1.05, 3)), _rounded(mean / seconds * rng.uniform(2, 20))
    low = rng.choice((0, 0, 1))
    ends = {key: _rounded(low * speed * rng.random()) for key in ("start_speed", "stop_speed")}
    ramp = _rounded(seconds * rng.uniform(0, 0.5))
    profile = rng.choice(PROFILES)
    forms: dict[str, Callable[[], Table]] = {
        "in_time": lambda: {"profile": profile, "total_time": _rounded(seconds), "ramp_time": ramp},
        "by_speed": lambda: {"profile": profile, **ends, "speed": speed, "acceleration": acceleration},
        "below_speed": lambda: {"profile": profile, "total_time": _rounded(seconds), "speed": speed},
        "at_speed": lambda: {"profile": profile, "speed": speed, "ramp_time": ramp},
        "axes": lambda: {"start_speed": ends["start_speed"], "speed": speed, "ramp_time": ramp},
        "sigmoid": lambda: {
            **ends,
            "speed": speed,
            "accelerate_time": ramp,
            "decelerate_time": _rounded(ramp * rng.uniform(0.5, 2)),
            "alpha": rng.choice((3, 4, 5)),
        },
        "jerk": lambda: {
            **ends,
            "speed": speed,
            "acceleration": acceleration,
            "jerk": _rounded(acceleration / seconds * rng.uniform(2, 50)),
        },
    }
    method = rng.choice(tuple(forms))
    return {"method": method, "steps": steps, **forms[method]()}


def written(case: Table) -> str:
    """A case as a move file."""
    lines = [f"clock_hz = {case['clock_hz']}", "", "[pins]"]
    lines += [f"{key} = {value!r}" for key, value in case["pins"].items()]
    for move in case["move"]:
        lines += ["", "[[move]]"]
        lines += [
            f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}"
            for key, value in move.items()
        ]
    return "\n".join(lines) + "\n"


def play(case: Table, engine: str) -> Verdict:
    """Plan a case, play it and judge what left the pins."""
    try:
        file = parse_moves(written(case), Path("case"))
        parameters = parameters_for(file.axes)
        plans = plan_file(file, parameters)
    except (BadInputError, PlanError) as error:
        return Verdict("refused", str(error).removeprefix("case: "), len(case["move"]))
    try:
        with open_engine(ENGINES[engine], parameters, file.clock_hz) as core:
            run = execute(file, plans, core)
    except DifferenceError as error:
        return Verdict("model and RTL differ", str(error))
    except DriverError as error:
        return Verdict("an error of the driver", str(error))
    except Failure as error:
        return Verdict("it did not end", str(error))
    steps = sum(run.commanded(axis)[1] for axis in range(file.axes))
    found = {
        "not the planned motion": run.problems(),
        "a pin timing": pins_wrong(run),
        "off its curve": off_curve(run),
    }
    for kind, sentences in found.items():
        if sentences:
            return Verdict(kind, sentences[0], len(plans), steps)
    return Verdict("exact", "", len(plans), steps)


def off_curve(run: Run) -> list[str]:
    """Steps that are too far from the ideal curve."""
    found = []
    for axis in range(run.file.axes):
        _, errors = step_errors(run, axis)
        worst = float(np.abs(errors).max(initial=0))
        if worst > ERROR_MAX:
            found.append(f"axis {axis}: a step is {worst:.3f} steps from its curve")
    return found


def _edges(run: Run, signal: str, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Clocks of the rising and of the falling edges."""
    level = (run.pins[signal] >> axis & 1).astype(np.int8)
    change = np.diff(level, prepend=0)
    clocks = run.pins["clock"].astype(np.int64)
    return clocks[change == 1], clocks[change == -1]


def pins_wrong(run: Run) -> list[str]:
    """Pin timings that were not kept, by the edges alone."""
    found, pins = [], run.file.pins

    def check(name: str, axis: int, times: np.ndarray, least: int) -> None:
        if len(times) and times.min() < least:
            found.append(f"axis {axis}: {name} was {times.min()} clocks, at least {least} are set")

    for axis in range(run.file.axes):
        rises, falls = _edges(run, "step", axis)
        turns = np.sort(np.concatenate(_edges(run, "dir", axis)))
        check("step_high", axis, falls - rises[: len(falls)], pins.step_high)
        check("step_low", axis, rises[1:] - falls[: len(rises) - 1], pins.step_low)
        if not len(turns) or not len(rises):
            continue
        after = np.searchsorted(rises, turns)
        known = after < len(rises)
        check("dir_setup", axis, rises[after[known]] - turns[known], pins.dir_setup)
        before = np.searchsorted(falls, turns) - 1
        known = before >= 0
        check("dir_hold", axis, turns[known] - falls[before[known]] - pins.step_low, pins.dir_hold)
    return found
