# SPDX-License-Identifier: MIT
"""Shrinks a failing case while it fails with the same kind of fault."""

import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import replace
from typing import Any

from passo.campaign_forms import Data
from passo.campaign_moves import Case
from passo.pulse_judge import Fault

TRIES = 400
PER_AXIS = ("steps", "distance", "steps_per_mm", "speed", "acceleration", "jerk")
IN_CLOCKS = re.compile(r"(\d+)clocks")


def shrink(case: Case, fault: Fault, judge: Callable[[Case], Fault | None]) -> tuple[Case, Fault]:
    """The smallest case found, and its fault; `judge` plays a case and returns its fault."""
    tries = 0
    while True:
        for smaller in _smaller(case):
            tries += 1
            if tries > TRIES:
                return case, fault
            if (found := judge(smaller)) and found.kind == fault.kind:
                case, fault = smaller, found
                break
        else:
            return case, fault


def _smaller(case: Case) -> Iterator[Case]:
    """Cases that are a little simpler, those that drop most first."""
    for data in _simpler(case.data):
        if all(move.get("profile") != "user" for move in data["move"]):
            yield replace(case, data=data, table=())
        else:
            yield replace(case, data=data)


def _simpler(data: Data) -> Iterator[Data]:
    yield from _fewer_moves(data)
    yield from _fewer_axes(data)
    if data.get("together"):
        yield {key: value for key, value in data.items() if key != "together"}
    for index, move in enumerate(data["move"]):
        for other in (*_plainer(move), *_halved(move)):
            yield data | {"move": [*data["move"][:index], other, *data["move"][index + 1 :]]}
    for key, value in data.get("pins", {}).items():
        if (half := _half(value)) is not None:
            yield data | {"pins": data["pins"] | {key: half}}


def _fewer_moves(data: Data) -> Iterator[Data]:
    for index in range(len(data["move"]) if len(data["move"]) > 1 else 0):
        left = deepcopy(data["move"][:index] + data["move"][index + 1 :])
        made = {key: value for key, value in data.items() if key != "together"} | {"move": left}
        if len({move.get("channel", 0) for move in left}) == 1:
            for move in left:
                move.pop("channel", None)
        elif "together" in data:
            made["together"] = data["together"]
        yield made


def _axes(move: Data) -> int:
    return len(move.get("steps", move.get("distance", ()))) or move.get("axes", 1)


def _fewer_axes(data: Data) -> Iterator[Data]:
    """Of all moves of a channel."""
    for channel in {move.get("channel", 0) for move in data["move"]}:
        own = [move for move in data["move"] if move.get("channel", 0) == channel]
        for axis in range(_axes(own[0]) if _axes(own[0]) > 1 else 0):
            left = [_without(move, axis) if move in own else move for move in data["move"]]
            if None not in left:
                yield data | {"move": left}


def _without(move: Data, axis: int) -> Data | None:
    """The move without an axis; None: it is the one that turns."""
    if "axes" in move:
        if axis == move["axis"]:
            return None
        return move | {"axes": move["axes"] - 1, "axis": move["axis"] - (axis < move["axis"])}
    lists = {key: move[key] for key in PER_AXIS if isinstance(move.get(key), list)}
    return move | {key: value[:axis] + value[axis + 1 :] for key, value in lists.items()}


def _plainer(move: Data) -> Iterator[Data]:
    """The same with a simpler profile, or without a key that has a default."""
    if move.get("profile", "linear") != "linear":
        others = {key: value for key, value in move.items() if key not in ("table", "shaper")}
        yield others | {"profile": "linear"}
    for key in ("start_speed", "stop_speed", "minimum_rpm", "deceleration", "decelerate_time", "alpha"):
        if key in move:
            yield {name: value for name, value in move.items() if name != key}


def _halved(move: Data) -> Iterator[Data]:
    """The same with smaller numbers; all steps, and one by one."""
    for key in ("steps", "distance"):
        if any(steps := move.get(key, ())):
            yield move | {key: [_half(n) or 0 for n in steps]}
            for axis, n in enumerate(steps):
                if n:
                    yield move | {key: [*steps[:axis], 0, *steps[axis + 1 :]]}
                if (half := _half(n)) is not None:
                    yield move | {key: [*steps[:axis], half, *steps[axis + 1 :]]}
    for key, value in move.items():
        if key not in ("steps", "distance", "channel", "axis", "axes") and (half := _half(value)) is not None:
            yield move | {key: half}


def _half(value: Any) -> Any:
    """About half of a number, with few digits; None where there is nothing to halve."""
    match value:
        case bool():
            return None
        case int():
            return int(value / 2) if abs(value) > 1 else None
        case float():
            half = float(f"{value / 2:.2g}")
            return half if abs(half) > 1e-9 and half != value else None
        case str() if found := IN_CLOCKS.fullmatch(value):
            clocks = int(found[1])
            return f"{clocks // 2}clocks" if clocks > 1 else None
    return None
