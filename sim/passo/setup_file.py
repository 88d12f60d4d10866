# SPDX-License-Identifier: MIT
"""Parses the machine and the events of a move file."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from passo.form_table import Place
from passo.move_forms import (
    EVENTS,
    MACHINES,
    EventArm,
    EventInput,
    EventSlip,
    EventUntrack,
    MachineEncoder,
    MachineInput,
    MoveHome,
    MoveProbe,
    MoveThread,
)
from passo.registers import ENCODER_LIMIT_BITS, INPUT_FILTER_FILTER_BITS
from passo.rig import RATIO_ONE, most
from passo.setup import EVENT_TYPES, Event, Setup
from passo.setup_outputs import (
    check_pwm,
    check_thread,
    read_compare,
    read_form,
    read_output,
    read_spindle,
    settings_of,
)
from passo.setup_tracks import read_tracks
from passo.table_values import Table, within
from passo.values import BadValueError, meant, shown

OUTPUT = "output"  # of a move
MACHINE_KEYS = ("input", "encoder", "compare", "spindle")
FILTER_MAX = (1 << INPUT_FILTER_FILTER_BITS) - 1
COUNTS_MAX = (1 << ENCODER_LIMIT_BITS) - 1


def read_setup(data: Table, moves: Sequence[Any], clock_hz: int) -> Setup | None:
    """The setup of a file that has one; raises BadValueError."""
    tasks = [move for move in moves if isinstance(move, MoveHome | MoveProbe | MoveThread)]
    has_outputs = any(OUTPUT in table for table in data["move"])
    if not any(key in data for key in ("machine", "event", "track")) and not tasks and not has_outputs:
        return None
    if any(move.channel for move in moves):
        raise BadValueError(
            "[machine], [[event]], [[track]], output, home, probe and thread are for files of channel 0 only"
        )
    axes = len(moves[0].steps)
    setup = within("machine", lambda: _machine(data.get("machine", {}), axes, clock_hz))
    events = []
    for number, table in enumerate(_tables(data, "event"), 1):
        event = within(f"event {number}", lambda table=table: _event(table, setup, axes, clock_hz))
        events.append(event)
    tracks = read_tracks(
        _tables(data, "track"),
        setup,
        clock_hz,
        lambda table, track: _check_when(table, track, setup, axes),
        lambda key, place, axis: _steps(key, place, axis, setup.scales),
    )
    for number, event in enumerate(events, 1):
        if isinstance(event, EventUntrack) and all(one.axis != event.axis for one in tracks.limits):
            raise BadValueError(f"event {number}: axis {event.axis} has no target: [[track]]")
    names = (*(f"event {number}" for number in range(1, len(events) + 1)), *tracks.names)
    several = "events and targets of trackers" if tracks.later else "events"
    _check_count(several, len(names), most("event"))
    outputs = []
    for number, (table, move) in enumerate(zip(data["move"], moves, strict=True), 1):
        made = within(f"move {number}", lambda table=table, move=move: read_output(table, move, clock_hz))
        outputs.append(made)
    setup = replace(
        setup,
        events=(*events, *tracks.later),
        outputs=tuple(outputs),
        tracks=tracks.first,
        trackers=tracks.limits,
        names=names,
    )
    if setup.has_outputs:
        check_pwm(setup.settings, clock_hz)
    for number, move in enumerate(moves, 1):
        within(f"move {number}", lambda move=move: _check_lines(move, setup))
        if move in tasks:
            within(f"move {number}", lambda move=move: _check_task(move, setup))
    return setup


def _check_count(name: str, count: int, largest: int) -> None:
    if count > largest:
        raise BadValueError(f"there are {count} {name}; must be at most {largest}")


def _tables(table: Table, key: str) -> list[Table]:
    tables = table.get(key, [])
    if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
        raise BadValueError(f"{key} must be an array of tables")
    return tables


def _machine(table: object, axes: int, clock_hz: int) -> Setup:
    if not isinstance(table, dict):
        raise BadValueError("it must be a table: [machine]")
    settings = settings_of(table, clock_hz, MACHINE_KEYS)
    for key in ("start", "steps_per_mm"):
        value = table.get(key)
        if isinstance(value, list) and len(value) != axes:
            raise BadValueError(f"{key} has {len(value)} axes, but the moves have {axes}")
    if settings.tracked >= axes:
        raise BadValueError(f"tracked must be 0 to {axes - 1}: lines move an axis at least")
    if (clocks := settings.filter * clock_hz) > FILTER_MAX:
        raise BadValueError(f"filter is {round(clocks)} clocks; must be at most {FILTER_MAX}")
    scales = settings.steps_per_mm or ()
    inputs: list[MachineInput] = []
    for number, one in enumerate(_tables(table, "input"), 1):
        made = within(f"input {number}", lambda one=one: _input(one, scales, axes, clock_hz))
        if (first := Setup(settings, axes, tuple(inputs)).find(made.role, made.axis)) is not None:
            raise BadValueError(f"input {number}: {made.role} is input {first + 1} already")
        inputs.append(made)
    _check_count("inputs", len(inputs), most("wire") - 1)
    for axis in range(axes):
        own = {one.soft for one in inputs if one.axis == axis and one.role in ("limit_low", "limit_high")}
        if len(own) > 1:
            raise BadValueError(f"the limits of axis {axis} must be both soft or both hard")
    encoders: list[MachineEncoder] = []
    for number, one in enumerate(_tables(table, "encoder"), 1):
        made = within(f"encoder {number}", lambda one=one: _encoder(one, axes, clock_hz))
        if any(made.axis == other.axis for other in encoders):
            raise BadValueError(f"encoder {number}: axis {made.axis} has an encoder already")
        if any(made.filter != other.filter for other in encoders):
            raise BadValueError(f"encoder {number}: all encoders must have the same filter")
        encoders.append(made)
    compare = within("compare", lambda: read_compare(table, axes, clock_hz))
    if compare:
        place = _steps("compare: position", compare.position, compare.axis, scales)
        compare = replace(compare, position=place)
    spindle = within("spindle", lambda: read_spindle(table, axes, clock_hz))
    return Setup(settings, axes, tuple(inputs), tuple(encoders), (), scales, (), compare, spindle)


def _check_axis(key: str, axis: int, axes: int) -> None:
    if axis >= axes:
        raise BadValueError(f"{key} must be 0 to {axes - 1}")


def _steps(key: str, place: Place, axis: int, scales: tuple[Fraction, ...]) -> Place:
    """A place in steps, to the nearest one."""
    if place.in_mm and not scales:
        raise BadValueError(f"{key} in mm needs steps_per_mm in [machine]")
    return Place(Fraction(round(place.value * scales[axis]))) if place.in_mm else place


def _input(table: Table, scales: tuple[Fraction, ...], axes: int, clock_hz: int) -> MachineInput:
    one = MachineInput(**read_form(MACHINES["input"], table, clock_hz))
    _check_axis("axis", one.axis, axes)
    if "side" in table and one.at is None:
        raise BadValueError("side needs at")
    if one.soft and one.role not in ("limit_low", "limit_high", "alarm"):
        raise BadValueError(f"soft is for limits and alarms, not for {one.role}")
    if one.disables and one.role != "alarm":
        raise BadValueError(f"disables is for alarms, not for {one.role}")
    if one.glitch and one.noise * one.glitch * 2 > 1:
        raise BadValueError("noise * glitch must be at most 0.5")
    return replace(one, at=_steps("at", one.at, one.axis, scales)) if one.at else one


def _encoder(table: Table, axes: int, clock_hz: int) -> MachineEncoder:
    encoder = MachineEncoder(**read_form(MACHINES["encoder"], table, clock_hz))
    _check_axis("axis", encoder.axis, axes)
    ratio = encoder.counts_per_step
    if not 1 <= round(ratio * RATIO_ONE) < RATIO_ONE << 16:
        raise BadValueError("counts_per_step must be 1/65536 to 65535")
    if encoder.limit and not 1 <= round(encoder.limit * ratio) <= COUNTS_MAX:
        raise BadValueError(f"limit is {float(encoder.limit * ratio):g} counts; must be 1 to {COUNTS_MAX}")
    if "stop" in table and not encoder.limit:
        raise BadValueError("stop needs limit")
    return encoder


def _event(table: Table, setup: Setup, axes: int, clock_hz: int) -> Event:
    names = tuple(EVENTS)
    if "do" not in table:
        raise BadValueError("do is missing")
    do = table["do"]
    if do not in names:
        raise BadValueError(f"do must be one of {', '.join(names)}, not {shown(do)}{meant(do, names)}")
    event = EVENT_TYPES[do](**read_form(EVENTS[do], table, clock_hz, ("do",)))
    _check_when(table, event, setup, axes)
    if isinstance(event, EventInput | EventArm | EventSlip | EventUntrack):
        _check_axis("axis", event.axis, axes)
    if isinstance(event, EventInput):
        _check_fitted(event.input, event.axis, setup)
    if isinstance(event, EventArm):
        _check_fitted(event.source, event.axis, setup)
    if isinstance(event, EventSlip) and all(one.axis != event.axis for one in setup.encoders):
        raise BadValueError(f"axis {event.axis} has no encoder: [[machine.encoder]]")
    if event.position:
        return replace(event, position=_steps("position", event.position, event.at_axis, setup.scales))
    return event


def _check_when(table: Table, event: Event, setup: Setup, axes: int) -> None:
    """One key says when the event comes."""
    given = [key for key in ("time", "position", "trigger") if key in table]
    if not given:
        raise BadValueError("time, position or trigger is missing")
    if len(given) > 1:
        raise BadValueError(f"{given[0]} and {given[1]} are mutually exclusive")
    if "falling" in table and event.trigger is None:
        raise BadValueError("falling needs trigger")
    if "at_axis" in table and event.time is not None:
        raise BadValueError("at_axis needs position or trigger")
    _check_axis("at_axis", event.at_axis, axes)
    if event.trigger:
        _check_fitted(event.trigger, event.at_axis, setup)


def _check_fitted(role: str, axis: int, setup: Setup) -> None:
    if setup.find(role, axis) is None:
        place = role if role == "probe" else f"{role} of axis {axis}"
        raise BadValueError(f"{place} is not connected: [[machine.input]]")


def _check_lines(move: Any, setup: Setup) -> None:
    for axis in range(setup.lined, setup.axes):
        if move.steps[axis]:
            raise BadValueError(f"steps of axis {axis} must be 0: it has no lines, as tracked says")


def _check_task(move: MoveHome | MoveProbe | MoveThread, setup: Setup) -> None:
    moved = [axis for axis, steps in enumerate(move.steps) if steps]
    if not moved:
        raise BadValueError(f"steps of {move.form.name} must move an axis")
    if isinstance(move, MoveProbe):
        _check_fitted("probe", 0, setup)
    if isinstance(move, MoveThread):
        check_thread(move, setup)
    if isinstance(move, MoveHome):
        for axis in moved:
            _check_fitted(move.switch, axis, setup)
