# SPDX-License-Identifier: MIT
"""The search for the worst path: what it kept, a short search, and that it finds a planner that is wrong."""

import itertools
import math
from dataclasses import replace

import pytest
from passo.path import PathSettings
from passo.random_cases import log_uniform

from benchmarks import path_adversary, path_measure
from benchmarks.path_measure import KINDS, Measured, measure, play
from benchmarks.path_page import PROFILES, page
from benchmarks.path_paths import JERKS, Case, Piece, case_of, read_cases
from tests.test_path_parts import randoms

KEPT = read_cases(path_adversary.WORST)


@pytest.mark.sample(30)
@pytest.mark.parametrize("name", KEPT)
def test_a_kept_case_is_within_all_bounds(name: str) -> None:
    """Time, steps and underruns of paths that were wrong once."""
    assert measure(KEPT[name]).faults == {}


@pytest.mark.parametrize("bend", [2.0, 3.4, 6.0])
def test_slight_corners_keep_the_jerk(bend: float) -> None:
    """Of axes that turn and speed up: to one side and to both, in directions of one axis and of all."""
    for bends, heading, slope in itertools.product([(bend,), (bend, -bend)], [0.0, 45.0], [0.0, 0.5]):
        piece = Piece(12, (20.0,), bends, slopes=(slope,))
        case = Case("fast", (piece,), "jerk", 48, 8000, heading)
        assert beyond(case) == {}, (bends, heading, slope)


# machine, lengths and turns in degrees: what had more jerk than an axis may have
CORNERS = {
    "pairs to both sides": ("soft", (0.2, 0.6), (10.0, 10.0, -10.0, -10.0)),
    "a zigzag of two lengths": ("soft", (0.12, 0.41), (30.0, -30.0)),
    "pairs to one side": ("fast", (0.023, 1.766), (5.15,)),
    "a step between long lines": ("soft", (1.1441, 1.7232, 0.0511), (51.92, -51.92, -51.92, 51.92, 26.5)),
    "slower once another line is known": (
        "soft",
        (1.2587, 1.3511, 0.2251),
        (-14.19, -4.97, 22.42, 22.42, -21.29),
    ),
}


@pytest.mark.parametrize("name", CORNERS)
def test_corners_near_each_other_keep_the_jerk(name: str) -> None:
    """The turn of one, and that of the next one to the other side or to the same, add up."""
    machine, sizes, bends = CORNERS[name]
    for heading in (0.0, 45.0):
        piece = Piece(24, sizes, bends, (6000.0,))
        assert beyond(Case(machine, (piece,), "jerk", 48, 1000, heading)) == {}


def test_random_corners_keep_the_jerk() -> None:
    """Of any turns, to either side, between lines of any lengths."""
    for rng in randoms("corners", 150):
        sizes = tuple(log_uniform(rng, 0.01, 2) for _ in range(rng.randint(1, 5)))
        turn = log_uniform(rng, 1, 100)
        parts = [rng.choice((1, 1, rng.random())) for _ in range(rng.randint(2, 6))]
        piece = Piece(24, sizes, tuple(turn * rng.choice((-1, 1)) * part for part in parts))
        look_ahead, heading = rng.choice((16, 48, 300)), rng.choice((0.0, 20.0, 45.0))
        case = Case(rng.choice(JERKS), (piece,), "jerk", look_ahead, 1000, heading)
        assert beyond(case) == {}, case


def test_random_arcs_between_straights_keep_the_jerk() -> None:
    """Where the curvature changes: of any radius, chords and turn, to one side and the other."""
    for rng in randoms("arcs", 40):
        pieces = [Piece(1, (20.0,))]
        for _ in range(rng.randint(1, 3)):
            chord, radius = log_uniform(rng, 0.03, 2), log_uniform(rng, 1.6, 50)
            bend = min(math.degrees(chord / radius), 25)
            count = max(2, min(80, int(rng.uniform(6, 180) / bend)))
            pieces.append(Piece(count, (chord,), (bend * rng.choice((-1, 1)),)))
            if rng.random() < 0.7:
                pieces.append(Piece(1, (log_uniform(rng, 0.1, 30),)))
        case = Case(rng.choice(JERKS), tuple(pieces), "jerk", 300, 8000, rng.choice((0.0, 30.0, 45.0)))
        assert beyond(case) == {}, case


def test_random_corners_behind_a_curve_keep_the_acceleration() -> None:
    """Corners with a sliver between them, to which the path comes down: of axes of which one is weaker."""
    for rng in randoms("slivers", 40):
        bends = tuple(rng.uniform(-7, 7) for _ in range(rng.randint(1, 3)))
        sizes = tuple(log_uniform(rng, 0.09, 0.6) for _ in range(rng.randint(1, 3)))
        corners = tuple(rng.choice((-1, 1)) * rng.uniform(20, 70) for _ in range(2))
        pieces = (
            Piece(rng.randint(8, 20), sizes, bends),
            Piece(2, (log_uniform(rng, 0.001, 0.05), 30.0), corners),
        )
        case = Case("laser", pieces, "linear", 300, 8000, rng.choice((0.0, 20.0, 90.0)))
        assert beyond(case) == {}, case


def beyond(case: Case) -> dict[str, str]:
    """What is beyond a limit at the pins."""
    measured = Measured()
    play(case, measured)
    return measured.faults


def weaker(share: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The planner has more acceleration than the judge and the reference think."""

    def stronger(settings: PathSettings) -> PathSettings:
        axes = tuple(replace(axis, acceleration=float(axis.acceleration) * share) for axis in settings.axes)
        return replace(settings, axes=axes)

    plan, player = path_measure.plan, path_measure.Player
    monkeypatch.setattr(path_measure, "plan", lambda lines, settings, n: plan(lines, stronger(settings), n))
    monkeypatch.setattr(path_measure, "Player", lambda settings, n, loop: player(stronger(settings), n, loop))


@pytest.mark.parametrize(("share", "kind"), [(1.1, "acceleration"), (0.9, "slow")])
def test_the_search_finds_a_wrong_planner(share: float, kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth too strong is seen at the pins, a tenth too weak in the time; each piece is needed for it."""
    weaker(share, monkeypatch)
    batches = (path_adversary.smallest(kind, seed, 100) for seed in range(1, 9))
    error = next(filter(None, batches), None)  # what a batch draws depends on the library
    assert error is not None and error.kind == kind
    assert measure(error.case).faults.keys() >= {kind}
    pieces = error.case.pieces
    for fewer in itertools.combinations(pieces, len(pieces) - 1) if len(pieces) > 1 else ():
        assert kind not in measure(replace(error.case, pieces=fewer)).faults


def test_a_stop_of_the_core_is_a_fault_of_its_own() -> None:
    """An underrun has a kind; any other cause is a fault."""
    assert list(Measured(fault="RAMP_UNDERRUN at 0.1 s").faults) == ["underrun"]
    assert list(Measured(fault="LINE_UNDERRUN at 0.1 s").faults) == ["underrun"]
    assert list(Measured(fault="3 substeps were drained").faults) == ["fault"]


def test_cases_are_kept_as_they_are() -> None:
    """A file holds what was found."""
    for case in KEPT.values():
        assert case_of(case.to_json()) == case
    assert set(KINDS) >= {"underrun", "slow", "acceleration"}


def test_the_page_of_figures() -> None:
    """Each figure beside its bound, each path and profile in a row."""
    one = {
        "lines": 4,
        "seconds": 2.5,
        "unlimited": 1.01,
        "look_ahead": 1.02,
        "speed": 0.5,
        "acceleration": 0.75,
    }
    profiles = [
        {"name": "square", "profile": profile, "time": 1.1, "look_ahead": 1.1 + n, "peak_jerk": 1000.0 * n}
        for n, profile in enumerate(PROFILES)
    ]
    report = {
        "adversarial": {"paths": 12_345, "worst": {"unlimited": 1.0123, "jerk": 0.9}, "beyond": {"slow": 7}},
        "paths": [{"name": "square", "instructions": 1234, **one}],
        "profiles": profiles,
        "circle_seconds": 1.3568,
    }
    text = page(report)
    assert "12,345 adversarial paths" in text and "takes 1.357 s" in text
    assert "all lines known; 1: the fastest motion | 1.0123 | 1.02 |" in text
    assert "profile `jerk`; 1: its limit | 0.9000 | 1.05 |" in text
    assert "| slower than its bound, all lines known | 7 |" in text and "| a jerk too high | 0 |" in text
    assert "| square of 50 mm | 4 | 2.500 | 1.0100 | 1.0200 | 0.500 | 0.750 | 1,234 |" in text
    assert "| square of 50 mm | time | 1.100 | 1.100 (2.100) | 1.100 (3.100) | 1.100 (4.100) |" in text
    assert "|  | jerk | 0 | 1,000 | 2,000 | 3,000 |" in text
