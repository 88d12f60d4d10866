# SPDX-License-Identifier: MIT
"""Parses the targets of trackers in a move file."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from passo.form_table import Place
from passo.move_forms import MACHINES, SIGNED_MAX, UNIT_Q32, MachineTrack
from passo.moves import q32
from passo.setup import Setup
from passo.setup_outputs import read_form
from passo.table_values import Table, within
from passo.values import BadValueError

TURN = 32  # PASSO_TRACKER_TURN
BACKLASH_MAX = (1 << 16) - 1  # of struct passo_track
KEPT = ("speed", "acceleration", "backlash")  # changed only at rest: all tables of an axis agree
WHEN = ("time", "position", "trigger")
CheckWhen = Callable[[Table, MachineTrack], None]
Steps = Callable[[str, Place, int], Place]


@dataclass(frozen=True)
class Tracks:
    """The tables of a file."""

    first: tuple[MachineTrack, ...]  # hold from the beginning
    later: tuple[MachineTrack, ...]
    names: tuple[str, ...]  # of the later ones
    limits: tuple[MachineTrack, ...]  # the first one of each axis


def tick_of(axes: int) -> int:
    """Clocks from one step of a tracker to the next, at least, as PASSO_TRACKER_TICK()."""
    return TURN * (8 if axes > 4 else 4)


def read_tracks(
    tables: Sequence[Table], setup: Setup, clock_hz: int, check_when: CheckWhen, steps: Steps
) -> Tracks:
    """All of them; raises BadValueError, which names the table and the key."""
    limits: dict[int, tuple[int, MachineTrack]] = {}
    first, later, names = [], [], []
    for number, table in enumerate(tables, 1):
        track = within(
            f"track {number}",
            lambda number=number, table=table: _track(
                number, table, setup, clock_hz, limits, check_when, steps
            ),
        )
        if any(key in table for key in WHEN):
            later.append(track)
            names.append(f"track {number}")
        else:
            first.append(track)
    return Tracks(tuple(first), tuple(later), tuple(names), tuple(track for _, track in limits.values()))


def _track(
    number: int,
    table: Table,
    setup: Setup,
    clock_hz: int,
    limits: dict[int, tuple[int, MachineTrack]],
    check_when: CheckWhen,
    steps: Steps,
) -> MachineTrack:
    track = MachineTrack(**read_form(MACHINES["track"], table, clock_hz))
    if track.axis >= setup.axes:
        raise BadValueError(f"axis must be 0 to {setup.axes - 1}: the moves have no other drives")
    track = replace(track, target=_within("target", steps("target", track.target, track.axis), SIGNED_MAX))
    if any(key in table for key in (*WHEN, "falling", "at_axis")):
        check_when(table, track)
    elif track.target.value:
        raise BadValueError("target needs time, position or trigger: without them it is 0")
    elif track.axis in limits:
        raise BadValueError("time, position or trigger is missing: only the first track of an axis has none")
    if track.position:
        track = replace(track, position=steps("position", track.position, track.at_axis))
    if track.backlash:
        place = steps("backlash", track.backlash, track.axis)
        if not 0 <= place.value <= BACKLASH_MAX:
            raise BadValueError(f"backlash is {place.value} steps; must be 0 to {BACKLASH_MAX}")
        track = replace(track, backlash=place)
    if track.axis not in limits:
        for key in ("speed", "acceleration"):
            if key not in table:
                raise BadValueError(f"{key} is missing")
        track = replace(track, backlash=track.backlash or Place(Fraction(0)))
        assert track.speed is not None and track.acceleration is not None
        check_limits(track.speed, track.acceleration, setup.core_axes, clock_hz)
        limits[track.axis] = number, track
        return track
    before, own = limits[track.axis]
    for key in KEPT:
        if getattr(track, key) not in (None, getattr(own, key)):
            raise BadValueError(f"{key} is another one than in track {before}, and changes only at rest")
    return replace(track, **{key: getattr(own, key) for key in KEPT})


def _within(key: str, place: Place, most: int) -> Place:
    if abs(place.value) > most:
        raise BadValueError(f"{key} is {place.value} steps; must be {-most} to {most}")
    return place


def check_limits(top: Fraction, most_change: Fraction, axes: int, clock_hz: int) -> None:
    """Raises BadValueError for what passo_configure_tracker() would refuse; steps/s, steps/s^2."""
    tick = tick_of(axes)
    rate = Fraction(clock_hz, tick)
    if top >= rate:
        raise BadValueError(f"speed must be less than {float(rate):g} steps/s, a step per {tick} clocks")
    speed = q32(top) * tick // clock_hz
    acceleration = q32(most_change) * tick // clock_hz * tick // clock_hz
    if not acceleration:
        least = float(rate * rate / UNIT_Q32)
        raise BadValueError(f"acceleration must be at least {least:.3g} steps/s^2, or the core does not move")
    if acceleration > speed:
        most = float(top * rate)
        raise BadValueError(
            f"acceleration must be at most {most:g} steps/s^2: the speed within {tick} clocks"
        )
