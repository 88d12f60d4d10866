# SPDX-License-Identifier: MIT
"""Random move files: a case is a function of the seed and its number alone.

A case is one move, in any form and profile; one case in four has more moves after it, one in eight a second
channel. Most are accepted by the planner and within the pin timing.
"""

import random
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from passo.campaign_forms import BANKS, Bank, Data, FormDraw
from passo.move_forms import PROFILES, SUBSTEPS_MAX
from passo.output import write_text
from passo.shape import ONE, POINTS, write_table

CLOCKS = (72_000_000, 100_000_000, 50_000_000, 12_000_000, 16_000_000, 99_999_989, 1_000_000)
AXES = 8
AXES_OF_TWO = 3  # of a core with two channels
PART = 0.98  # of the speed that the pins allow, so that rounding does not exceed it
SPOILT = 1 / 16  # of the cases


@dataclass(frozen=True)
class Case:
    """The contents of a move file, and the points of the table that it names, if any."""

    seed: int
    number: int
    data: Data
    table: tuple[int, ...] = ()

    @property
    def name(self) -> str:
        """Of its files."""
        return f"campaign-{self.seed}-{self.number}"

    def write(self, folder: Path) -> Path:
        """Write the move file and its table; return its path."""
        self.write_table(folder)
        path = folder / f"{self.name}.toml"
        write_text(path, to_toml(self.data))
        return path

    def write_table(self, folder: Path) -> Path | None:
        """Write its table, if it names one; return its path."""
        if not self.table:
            return None
        path = folder / f"{self.name}.csv"
        write_table(self.table, path)
        return path


def to_toml(data: Data) -> str:
    """The text of a move file."""
    lines = [f"{key} = {_value(value)}" for key, value in data.items() if key not in ("pins", "move")]
    if data.get("pins"):
        lines += ["[pins]", *(f"{key} = {_value(value)}" for key, value in data["pins"].items())]
    for move in data["move"]:
        lines += ["[[move]]", *(f"{key} = {_value(value)}" for key, value in move.items())]
    return "\n".join(lines) + "\n"


def _value(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return f'"{value}"'
        case list():
            return f"[{', '.join(map(_value, value))}]"
        case dict():
            return f"{{ {', '.join(f'{key} = {_value(one)}' for key, one in value.items())} }}"
    return repr(value)


def draw(seed: int, number: int) -> Case:
    """Draw a case."""
    rng = random.Random(f"campaign {seed} {number}")
    pins = _pins(rng)
    data: Data = {"clock_hz": rng.choice(CLOCKS), "pins": {key: f"{n}clocks" for key, n in pins.items()}}
    two = rng.random() < 1 / 8
    several = two or rng.random() < 1 / 4
    kind = rng.choice(BANKS) if rng.random() < 0.4 else ""
    if several and kind == "shaped":  # each move has a table of its own
        kind = "user"
    bank = Bank(kind, f"campaign-{seed}-{number}.csv", round(rng.uniform(3, 5), 3))
    waits = pins["dir_setup"] + pins["dir_hold"] if several or max(pins.values()) > 1 else 0
    between = pins["step_high"] + pins["step_low"] + waits

    def some(channel: int, axes: int, count: int) -> list[Data]:
        made = [FormDraw(rng, data["clock_hz"], axes, between / PART, bank).move() for _ in range(count)]
        return [move | {"channel": channel} for move in made] if two else made

    axes = AXES_OF_TWO if two else rng.randint(1, AXES)
    data["move"] = some(0, axes, rng.randint(2, 3) if several and not two else 1)
    if two:
        data["together"] = rng.random() < 0.5
        data["move"] += some(1, rng.randint(1, AXES_OF_TWO), rng.randint(1, 2))
    if rng.random() < SPOILT:
        _spoil(rng, data)
    return Case(seed, number, data, _points(rng) if kind == "user" else ())


def _pins(rng: random.Random) -> dict[str, int]:
    most = rng.choice((1, 4, 32, 300))
    keys = ("step_high", "step_low", "dir_setup", "dir_hold")
    return {key: rng.randint(1, most) for key in keys}


def _points(rng: random.Random) -> tuple[int, ...]:
    """A shape that never falls: powers, steps, and anything."""
    if rng.random() < 0.5:
        power = rng.uniform(0.3, 4)
        return tuple(min(round(ONE * (k / POINTS) ** power), ONE - 1) for k in range(POINTS))
    points = sorted(rng.randrange(ONE) for _ in range(rng.choice((1, 3, POINTS - 1))))
    return (0, *sorted(rng.choices(points, k=POINTS - 1)))


def _spoil(rng: random.Random, data: Data) -> None:
    """Set a value of a move that makes the planner refuse it, mostly."""
    move = rng.choice(data["move"])
    choices: list[tuple[str, Any]] = [
        ("steps", [0] * len(move.get("steps", ()))),
        ("steps", [SUBSTEPS_MAX + 1] * len(move.get("steps", ()))),
        ("total_time", "1clocks"),
        ("ramp_time", move.get("total_time", 0)),
        ("alpha", 2),
        ("alpha", 3.25),
        ("minimum_rpm", move.get("rpm", 0) * 2),
        *((key, 0) for key in ("speed", "rpm", "feed", "acceleration", "jerk", "angle", "steps_per_mm")),
        *((key, move.get("speed", 0) * 2 if "steps" in move else 0) for key in ("start_speed", "stop_speed")),
        *((key, data["clock_hz"]) for key in ("speed", "feed")),
        *(("profile", profile) for profile in PROFILES),
    ]
    key, value = rng.choice([one for one in choices if one[0] in move])
    move[key] = value
