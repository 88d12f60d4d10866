# SPDX-License-Identifier: MIT
"""What trackers do, from the recurrence and the joining of docs/architecture.md, in Python integers."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, NamedTuple

from verify.mutants.motions_judge import Steps

STEP = 1 << 32
HALF = 1 << 31
LATE = 4  # ticks until a write acts, at most


def signed(value: int, bits: int = 64) -> int:
    """As a signed number."""
    value %= 1 << bits
    return value - (value >> bits - 1 << bits)


def nearest(position: int) -> int:
    """A step is due where this changes."""
    return (position + HALF) // STEP


class Hand(NamedTuple):
    """The tracker of an axis between two ticks, and what the host has written."""

    position: int = 0  # of 2^-32 steps
    v: int = 0
    t: int = 0
    sign: int = 1  # of the distance, when it looked last
    target: int = 0
    speed: int = 0
    acceleration: int = 0
    follows: bool = False  # enabled, and in no soft stop
    applied: int = 0  # writes

    def tick(self) -> "Hand":
        """The recurrence."""
        position, before, t, sign, target, speed, a, follows, applied = self
        v = before
        if not follows and v == 0:
            return self
        d = signed(target * STEP - position) * sign
        if follows and v + a <= speed and t + v + a <= d:
            v += a
            t += v
        elif v and not (follows and v <= speed and t <= d):
            t -= v
            v -= a
        if v == 0 and follows and 0 <= d < a:
            return Hand(position + d * sign, 0, 0, sign, target, speed, a, follows, applied)
        after = -sign if follows and before == 0 and d < 0 else sign
        return Hand(position + v * sign, v, t, after, target, speed, a, follows, applied)


@dataclass(frozen=True)
class Due:
    """A step that is due at the pins, of the path or of the tracker."""

    clock: int
    way: int
    of_path: bool


@dataclass(frozen=True)
class Write:
    """What is written for an axis, and the clock from which on it may act."""

    clock: int
    told: dict[str, Any] = field(hash=False)


def applied(hand: Hand, writes: Sequence[tuple[int, dict[str, Any]]], tick: int) -> Iterator[Hand]:
    """It before a tick, with the writes that act by now, and with some that may."""
    while hand.applied < len(writes) and writes[hand.applied][0] + LATE <= tick:
        hand = hand._replace(**writes[hand.applied][1], applied=hand.applied + 1)
    yield hand
    while hand.applied < len(writes) and writes[hand.applied][0] <= tick:
        hand = hand._replace(**writes[hand.applied][1], applied=hand.applied + 1)
        yield hand


def either_way(
    changes: Sequence[tuple[int, int]], tracker: Steps, lead: int
) -> Iterator[list[tuple[int, int]]]:
    """The changes of joined(); those while it is decided that a step is made may come before or after it."""
    decides = range(min(0, -lead) - 1, max(0, -lead) + 2)
    counts = {clock + n for clock, _ in tracker for n in decides}
    for shifts in product(*((0, -1, 1) if clock in counts else (0,) for clock, _ in changes)):
        yield [(clock + shift, way) for (clock, way), shift in zip(changes, shifts, strict=True)]


def joined(path: Steps, tracker: Steps, changes: Sequence[tuple[int, int]], lead: int) -> list[Due]:
    """The steps of an axis: as docs/architecture.md joins those of both hands.

    `changes` are the clocks from which on the path moves the axis up, down, or not (0); a tracker's step
    counts `lead` clocks before it leaves the pins.
    """
    events = [(clock, 0, way) for clock, way in changes]
    events += [(clock - lead, 1, way) for clock, way in tracker]
    events += [(clock, 2, way) for clock, way in path]
    events += [(clock, 3, 0) for clock, _ in (*tracker, *changes)]
    going = owed = 0
    due = []
    for clock, kind, way in sorted(events):
        if kind == 0:
            going = way
        elif kind == 1:
            owed += way
        elif kind == 2:
            if owed * way < 0:
                owed += way
            else:
                due.append(Due(clock, way, True))
        while kind == 3 and owed and owed * going != -1:
            one = 1 if owed > 0 else -1
            due.append(Due(clock, one, False))
            owed -= one
    return due
