# SPDX-License-Identifier: MIT
"""Motions in step with a spindle, at the pins; ten taps: `python -m benchmarks.rigid_tapping`."""

from dataclasses import replace

import numpy as np
import pytest
from passo import part
from passo.axis_judge import Share, faults
from passo.failure import BadInputError
from passo.part import Played
from passo.part_judge import shares_of
from passo.spindle_at import SpindleAt

from benchmarks.rigid_tapping import (
    APPROACH,
    COUNTS,
    DEPTH,
    MACHINE,
    STEPS_PER_MM,
    WITHIN,
    judge,
    play,
    program,
    turned,
)

SMALL = MACHINE.replace("32_000_000", "4_000_000").replace(f"counts = {COUNTS}", "counts = 200")


def test_two_holes_are_in_phase() -> None:
    """Down, on while the spindle reverses, up, and at rest at the top; the judge sees steps that are late."""
    played = play(program(2))
    passes = judge(played)
    assert len(passes) == 2 and played.problems() == []
    for one in passes:
        assert one.error <= WITHIN and one.end == one.late == 0 and one.deepest > DEPTH
        assert 0.5 < one.settled <= APPROACH and one.off > 10  # it comes up to speed and to rest
    counts = 32_000_000 * 60 * 3 // (600 * COUNTS)
    late = replace(played, clocks=[clocks + counts for clocks in played.clocks])
    assert all(one.error > 2 for one in judge(late))


def errors(played: Played, places: list[float], pitches: list[float]) -> np.ndarray:
    """How far each step down is from a thread between places, in counts; first, from any begin of a turn."""
    clocks, positions = played.clocks[2], played.positions[2] / STEPS_PER_MM
    first = np.flatnonzero((np.diff(positions) < 0) & (positions[:-1] <= places[0]))[0] + 1
    down = slice(first, first + int(np.argmin(positions[first:])) + 1)
    edges, angles = turned(played.counts, len(played.machine.motors))
    middle = positions[down] + 0.5 / STEPS_PER_MM
    way = np.interp(-middle, [-place for place in places], np.cumsum([0, *pitches]))
    seen = np.interp(clocks[down] + played.origin, edges, angles) - way
    return seen - COUNTS * round(float(np.median(seen)) / COUNTS)


def test_a_thread_of_several_pitches() -> None:
    """One pass; from the run-in to the run-out, and where the pitch changes, all steps are on it."""
    played = play("M3 S400\nG0 Z12\nG33 Z5 K1.25\nG33 Z0 K2\nG0 Z20\nM5\nM2\n")
    assert played.threads == 1 and played.problems() == [] == faults(shares_of(played))
    found = errors(played, [12, 5, 0], [7 / 1.25 * COUNTS, 5 / 2 * COUNTS])
    inside = found[round(4.5 * STEPS_PER_MM) : -round(1 * STEPS_PER_MM)]
    assert len(inside) > 6 * STEPS_PER_MM and np.abs(inside).max() <= WITHIN
    assert np.abs(found).max() > 10


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ("G33 Z0 K8", "part.nc:3: program_poll: FOLLOW_SPEED"),
        ("G33 Z9 K1.25", "part.nc:3: program_poll: .*ramp"),
        ("G33.1 Z9.9 K1.25", "part.nc:3: program_poll: .*ramp"),
        ("G33 Z5 K1.25\nG33 Z0 K2", "part.nc:3: program_poll: FOLLOW_SPEED"),
        ("G33 Z2 K1.25\nG33 Z0 X2 K2", "part.nc:3: program_poll: FOLLOW_SPEED"),
    ],
)
def test_what_axes_cannot_follow_is_refused(lines: str, told: str) -> None:
    """Before the pass."""
    with pytest.raises(BadInputError, match=told):
        play(f"M3 S600\nG0 Z10\n{lines}\nM2\n", head=SMALL)


@pytest.mark.parametrize("last", ["M5\nG0 Z5\nM2", "M2", "S1"])
def test_what_is_behind_a_thread_leaves_its_spindle_alone(last: str) -> None:
    """It is read while the thread waits for its index."""
    played = play(f"M3 S600\nG0 Z2\nG33 Z1 K.5\nG33 Z0 K.5\n{last}\n", head=SMALL)
    assert [one.lines for one in played.passes] == [2] and played.problems() == []


def shares_at(played: Played, **limits: float) -> list[Share]:
    """By other limits of Z."""
    settings = played.machine.settings
    axes = (*settings.axes[:2], replace(settings.axes[2], **limits))
    machine = replace(played.machine, settings=replace(settings, axes=axes))
    return [one for one in shares_of(replace(played, machine=machine)) if one.axis == 2]


def test_pulses_of_threads_are_judged() -> None:
    """A tap is within the limits of its axis; a pass shows when they are lower, or its steps irregular."""
    played = play(TAP, head=SMALL)
    assert {one.name for one in shares_of(played)} == {"speed", "acceleration"}
    assert faults(shares_of(played)) == [] and shares_of(played)[-1].share > 0.5
    (one,) = played.passes
    assert one.lines == 1
    begin, end = ((clock - played.origin) / played.machine.clock_hz for clock in (one.begin, one.end))
    fast, steep = shares_at(played, speed=5, acceleration=500)[0], shares_at(played, acceleration=60)[1]
    assert fast.share > 1 and steep.share > 1
    own = slice(*np.searchsorted(played.clocks[2], [begin * 4e6, end * 4e6]))
    clocks = [*played.clocks[:2], played.clocks[2].copy()]
    clocks[2][own.start + 100 : own.stop] += 40_000
    late = shares_of(replace(played, clocks=clocks))[-1]
    assert late.share > late.bound and begin < late.time < end


def test_lines_of_a_pass_meet_within_the_junction_deviation() -> None:
    """Without that its corner is a fault."""
    head = SMALL.replace("counts = 200", f"counts = {COUNTS}").replace("wander = 20", "")
    played = play("M3 S400\nG0 Z9\nG33 Z4 K1.25\nG33 Z0 K2\nM2\n", head=head)
    assert [one.lines for one in played.passes] == [2] and faults(shares_of(played)) == []
    settings = replace(played.machine.settings, junction_deviation=0)
    sharp = replace(played, machine=replace(played.machine, settings=settings))
    (told,) = faults(shares_of(sharp))
    assert told.startswith("axis 2: ") and "acceleration" in told


def test_tapered_ends() -> None:
    """Each pass is three lines; X and Z are on the thread at all steps of X, within a step and a count."""
    played = play("M3 S600\nG0 X10 Z5\nG76 P1 Z0 I-1 J.4 K.5 E1.5 L3\nM2\n", head=SMALL)
    assert [one.lines for one in played.passes] == [3, 3] and played.problems() == []
    assert faults(shares_of(played)) == []
    x, z = (np.concatenate([[0], positions]) for positions in (played.positions[0], played.positions[2]))
    for one, cut in zip(played.passes, (9 - 0.4, 9 - 0.5), strict=True):
        own = slice(*np.searchsorted(played.clocks[0], [one.begin - played.origin, one.end - played.origin]))
        clocks, places = played.clocks[0][own], (x[own] + x[1:][own]) / 2 / 80
        along = z[np.searchsorted(played.clocks[2], clocks)] / STEPS_PER_MM
        wanted = cut + 0.5 * np.maximum(0, np.maximum(along - 3.5, 1.5 - along) / 1.5)
        assert len(places) == 2 * 40 and np.abs(places - wanted).max() <= 1 / STEPS_PER_MM + 1 / 200


ENCODER = "encoders = [800]\nfollowing = 0.05\n"
TAP = "M3 S600\nG0 Z1\nG33.1 Z0 K.5\nG0 Z2\nM5\nM2\n"


@pytest.mark.parametrize("engine", ["model", "both"])
def test_encoders_of_axes_beside_that_of_the_spindle(engine: str) -> None:
    """Nothing at the pins is as much as a clock from where it is without them."""
    without, played = play(TAP, head=SMALL), play(TAP, engine, ENCODER, SMALL)
    assert played.problems() == [] and played.threads == 1
    assert 0 < played.following["Z"] <= 1.5 / STEPS_PER_MM
    for own, other in zip(played.clocks, without.clocks, strict=True):
        assert np.array_equal(own, other)


def test_a_motor_that_leaves_its_encoder_in_a_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    """It stops, on the line of the thread."""

    class Slipping(SpindleAt):
        def drive(self, power: int) -> None:
            super().drive(power)
            ((library, rig),) = self._rigs
            if library.passo_rig_position(rig, 2) == STEPS_PER_MM // 2:
                library.passo_rig_slip(rig, 0, -200)

    monkeypatch.setattr(part, "SpindleAt", Slipping)
    with pytest.raises(BadInputError, match=r"part.nc:3: program_poll: FOLLOWING"):
        play(TAP, more=ENCODER, head=SMALL)
