# SPDX-License-Identifier: MIT
"""The limits along each line and at each corner by the rules of docs/path.md."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from passo.path import PathSettings
from passo.path_rounding import Line

UNLIMITED = 1e30
NEARLY = 1 - 1e-9
ON = 2.0**-30  # mm: by this a line is off the one before it, as their ends are in 2^-32 mm
SMALL = 8  # part of a turn


@dataclass(frozen=True)
class Limits:
    """Limits of each line and of the corner at its start, in mm and s; squares are of the path speed."""

    length: np.ndarray
    unit: np.ndarray  # line x axis
    top: np.ndarray  # square within the line
    acceleration: np.ndarray  # along the path
    jerk: np.ndarray  # along the path; only profile jerk has a limit
    corner: np.ndarray  # square at the start
    start: float  # square at the beginning and the end of the path
    stop: float


def straights(unit: np.ndarray, length: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of the straight that a line is in, how long it is up to the end of the line, and from its start on."""
    ended, begun = length.copy(), length.copy()
    shorter = np.minimum(length[1:], length[:-1])
    on = np.linalg.norm(np.diff(unit, axis=0), axis=1) * shorter < ON
    for i in np.flatnonzero(on):
        ended[i + 1] += ended[i]
    for i in np.flatnonzero(on)[::-1]:
        begun[i] += begun[i + 1]
    return ended, begun


def limits_of(lines: Sequence[Line], settings: PathSettings, arcs: bool = True) -> Limits:
    """The limits of a path that begins at the origin; without `arcs` their lines are as fast as others."""
    axes = len(settings.axes)
    points = np.array([[0.0] * axes, *(list(target) for target, _ in lines)])
    delta = np.diff(points, axis=0)
    length = np.linalg.norm(delta, axis=1)
    feed = np.array([UNLIMITED if feed is None else feed for _, feed in lines])[length > 0]
    delta, length = delta[length > 0], length[length > 0]
    unit = delta / length[:, None]
    speed, acceleration, jump, jerk = (
        np.array([float(getattr(axis, name)) for axis in settings.axes])
        for name in ("speed", "acceleration", "jump", "jerk")
    )
    if settings.profile != "jerk":
        jerk[:] = UNLIMITED
    with np.errstate(divide="ignore"):
        top = np.minimum(feed, (speed / np.abs(unit)).min(axis=1)) ** 2
        along = (acceleration / np.abs(unit)).min(axis=1)
        soft = (jerk / np.abs(unit)).min(axis=1)
        along = np.minimum(along, float(settings.acceleration) or UNLIMITED)
        ends = (np.where(unit == 0, UNLIMITED, jump) / np.maximum(np.abs(unit), 1e-12)).min(axis=1) ** 2
    corner = np.full(len(length), UNLIMITED)
    bends_before, bends_behind = np.ones(len(length), bool), np.ones(len(length), bool)
    ends_there, begins_there = straights(unit, length) if settings.profile == "linear" else (length, length)
    for i in range(1, len(length)):
        change = np.abs(unit[i] - unit[i - 1])
        cosine = np.linalg.norm(change) / 2
        if cosine < 1e-9:
            continue
        sine = max(0.0, 1 - cosine**2) ** 0.5
        rounded = float(settings.junction_deviation) * 2 * sine * (1 + sine) / cosine
        before, behind = (min(size / 2, rounded) for size in (ends_there[i - 1], begins_there[i]))
        before, behind = min(before, (rounded + behind) / 2), min(behind, (rounded + before) / 2)
        over = min(before + behind, rounded)
        bends_before[i] = before + behind < rounded and before > NEARLY * length[i - 1] / 2
        bends_behind[i] = before + behind < rounded and behind > NEARLY * length[i] / 2
        moved = change > 1e-9
        corner[i] = (acceleration[moved] / change[moved]).min() * over
        part = np.maximum(2 * cosine / SMALL / change[moved], 1)  # an axis that hardly turns is stronger
        corner[i] = min(corner[i], ((jerk[moved] * part).min() * (over / (2 * cosine)) ** 2) ** (2 / 3))
        jumps = moved & (jump > 0)
        if jumps.any():
            corner[i] = min(corner[i], (jump[jumps] / change[jumps]).min() ** 2)
    arc = bends_behind[1:-1] & bends_before[2:] if arcs else False
    curve = np.maximum(corner[1:-1], corner[2:])  # whatever the feeds beside it
    corner[1:] = np.minimum(corner[1:], np.minimum(top[1:], top[:-1]))
    top[1:-1] = np.where(arc, np.minimum(top[1:-1], curve), top[1:-1])
    corner[1:] = np.minimum(corner[1:], np.minimum(top[1:], top[:-1]))
    return Limits(length, unit, top, along, soft, corner, min(ends[0], top[0]), min(ends[-1], top[-1]))
