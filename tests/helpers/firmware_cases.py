# SPDX-License-Identifier: MIT
"""Random moves for the firmware."""

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

from passo.build import Parameters
from passo.move_file import read_moves
from passo.moves import MoveFile
from passo.plan import Plan, PlanError, plan_move
from passo_stm32.lines import read_toml


def _steps(rng: random.Random, most: int) -> list[int]:
    axes = rng.randint(1, 4)
    steps = [rng.choice((0, 1, -1)) * rng.randint(1, most) for _ in range(axes)]
    steps[rng.randrange(axes)] = rng.choice((1, -1)) * rng.randint(1, most)
    return steps


def _milliseconds(rng: random.Random, low: float, high: float) -> str:
    return f"{rng.uniform(low, high) / 1000:.6f}"


def random_move(rng: random.Random) -> dict[str, Any]:
    """A move of some milliseconds as a table of a move file; it may be invalid."""
    profile = rng.choice(("linear", "cosine", "sigmoid", "jerk"))
    steps = _steps(rng, rng.choice((3, 40, 900)))
    speed = rng.choice((5_000, 50_000, 400_000))
    method = rng.choice(
        ("in_time", "by_speed", "below_speed", "at_speed", "axes", "turn", "sigmoid", "jerk", "straight")
    )
    if method == "in_time":
        return {
            **{"steps": steps, "profile": profile},
            **{"total_time": _milliseconds(rng, 4, 20), "ramp_time": _milliseconds(rng, 0.1, 2)},
        }
    if method == "by_speed":
        ends = {"start_speed": rng.randint(0, 500), "stop_speed": rng.randint(0, 500)}
        kind = rng.choice(("acceleration", "ramp_time"))
        value = rng.randint(10**6, 10**8) if kind == "acceleration" else _milliseconds(rng, 0.1, 3)
        return {"steps": steps, "profile": profile, "speed": speed, **ends, kind: value}
    if method == "below_speed":
        total = _milliseconds(rng, 4, 20)
        return {"method": method, "steps": steps, "profile": profile, "total_time": total, "speed": speed}
    if method == "at_speed":
        ramp = _milliseconds(rng, 0.01, 1)
        return {"method": method, "steps": steps, "profile": profile, "speed": speed, "ramp_time": ramp}
    if method == "axes":
        start, ramp = rng.randint(0, 1000), _milliseconds(rng, 0.1, 2)
        return {"method": method, "steps": steps, "start_speed": start, "speed": speed, "ramp_time": ramp}
    if method == "turn":
        return {
            **{"method": method, "axis": rng.randrange(4), "axes": 4, "steps_per_turn": 3200},
            **{"angle": f"{rng.uniform(-60, 60):.3f}", "rpm": f"{rng.uniform(200, 2000):.2f}"},
            **{"minimum_rpm": rng.randint(0, 30), "acceleration": rng.randint(10**6, 10**7)},
        }
    if method == "sigmoid":
        return {
            **{"method": method, "steps": steps, "start_speed": rng.randint(0, 400), "speed": speed},
            **{"accelerate_time": _milliseconds(rng, 0.5, 3), "decelerate_time": _milliseconds(rng, 0.5, 3)},
            "alpha": rng.choice(("5", "5", "3.5", "4.25")),
        }
    if method == "jerk":
        acceleration = rng.randint(10**6, 10**8)
        jerk = acceleration * rng.randint(100, 3000)
        return {
            **{"method": method, "steps": steps, "speed": speed, "acceleration": acceleration},
            "jerk": min(jerk, 4_000_000_000),
        }
    axes = rng.randint(1, 4)
    return {
        **{"method": method, "distance": [f"{rng.uniform(-3, 3):.3f}" for _ in range(axes)]},
        **{"feed": rng.randint(100, 400), "steps_per_mm": rng.choice((80, 400)), "speed": 500},
        **{"acceleration": rng.randint(20_000, 90_000), "jerk": rng.choice((0, 80_000_000))},
    }


def _toml(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, str):
        try:
            Fraction(value)
        except ValueError:
            return f'"{value}"'
    return str(value)


def write_moves(moves: list[dict[str, Any]], clock_hz: int, path: Path) -> Path:
    """A move file."""
    tables = ("\n".join(f"{k} = {_toml(v)}" for k, v in move.items()) for move in moves)
    path.write_text(f"clock_hz = {clock_hz}\n" + "".join(f"[[move]]\n{table}\n" for table in tables))
    return path


def random_moves(
    seed: int, count: int, clock_hz: int, parameters: Parameters, folder: Path, longest: float = 0.025
) -> list[tuple[dict[str, Any], MoveFile, Plan]]:
    """`count` random moves of at most `longest` seconds, each with its plan."""
    rng = random.Random(seed)
    found: list[tuple[dict[str, Any], MoveFile, Plan]] = []
    while len(found) < count:
        path = write_moves([random_move(rng)], clock_hz, folder / f"random_{seed}_{len(found)}.toml")
        file = read_moves(path)
        try:
            plan = plan_move(file.moves[0], clock_hz, parameters)
        except PlanError:
            continue
        fastest = plan.c.velocity_peak * max(map(abs, file.moves[0].steps)) / plan.line.substeps / 2**48
        pins = file.pins.step_high + file.pins.step_low
        if plan.clocks <= longest * clock_hz and fastest * pins <= 1:
            found.append((read_toml(path)["move"][0], file, plan))
    return found
