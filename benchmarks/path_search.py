# SPDX-License-Identifier: MIT
"""The search for the worst path: Hypothesis draws recipes, aims at the greatest figures, shrinks faults."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings, target
from hypothesis import seed as seeded
from hypothesis import strategies as st

from benchmarks.path_measure import Measured, measure
from benchmarks.path_paths import (
    JERKS,
    JERKS_OF_MOTORS,
    LINES_MAX,
    MACHINES,
    RAPID,
    Case,
    Piece,
    seconds_at_feed,
)

SECONDS = 1.5  # of a path at its feeds; longer ones are cut
SIZES = (0.001, 0.0042, 0.02, 0.1, 0.3, 1.0, 5.0, 30.0, 200.0, 1000.0)  # mm, and all between
FEEDS = (RAPID, 0.1, 3.0, 60.0, 300.0, 1000.0, 3000.0, 6000.0, 30_000.0)  # mm/min
BENDS = (0.0, 0.01, 0.1, 0.5, 1.0, 3.4, 5.7, 10.0, 30.0, 45.0, 90.0, 150.0, 179.0)  # degrees
LOOK_AHEADS = (8, 16, 48, 100, 300, 1000)
POLLS = (500, 700, 1000, 1800, 3000, 8000)
COUNTS = (1, 2, 3, 5, 10, 30, 100, 400)
SLOT_CHORDS = 60

Check = Callable[[Case], Measured]


class BeyondError(AssertionError):
    """A case is beyond a bound."""

    def __init__(self, kind: str, case: Case, text: str):
        self.kind, self.case = kind, case
        super().__init__(f"{kind}: {text}: {case}")


@st.composite
def pieces(draw: Any) -> Piece:
    """Some lines."""
    sizes = draw(st.lists(st.sampled_from(SIZES) | st.floats(0.001, 20), min_size=1, max_size=3))
    bends = draw(st.lists(st.sampled_from(BENDS) | st.floats(0, 20), min_size=1, max_size=2))
    sign = draw(st.sampled_from((1, -1, 0)))  # 0: to either side in turn
    if sign:
        bends = [sign * bend for bend in bends]
    else:
        bends = [*bends, *(-bend for bend in bends)]
    feeds = draw(st.lists(st.sampled_from(FEEDS) | st.floats(0.1, 30_000), min_size=1, max_size=2))
    slopes = draw(st.sampled_from(((0.0,), (0.0,), (0.0,), (0.1,), (0.001, -0.001), (5.0,), (1.0, -1.0))))
    return Piece(
        draw(st.sampled_from(COUNTS)), *(tuple(round(v, 4) for v in values) for values in (sizes, bends)),
        tuple(round(v, 2) for v in feeds), slopes,
    )  # fmt: skip


@st.composite
def arcs(draw: Any) -> Piece:
    """Chords of an arc, as G-code or a CAM program has them."""
    radius = draw(st.sampled_from((0.05, 0.5, 2.0, 5.0, 20.0, 200.0)) | st.floats(0.05, 100))
    chord = min(draw(st.sampled_from((0.001, 0.0042, 0.02, 0.1, 0.35, 2.0))), radius)
    sign = draw(st.sampled_from((1, -1)))
    feed = draw(st.sampled_from((RAPID, 300.0, 3000.0, 6000.0, 30_000.0)))
    bend = sign * round(2 * math.degrees(math.asin(chord / 2 / radius)), 6)
    turn = draw(st.sampled_from((30, 90, 180, 360, 720)))
    return Piece(max(1, min(LINES_MAX, int(turn / abs(bend)))), (chord,), (bend,), (feed,))


@st.composite
def fans(draw: Any) -> Piece:
    """Nearly collinear lines whose feeds alternate."""
    size = draw(st.sampled_from((0.05, 0.2, 1.0, 3.0, 20.0)))
    bend = draw(st.sampled_from((0.0, 0.001, 0.1, 1.0, 3.4, 5.7)))
    bends = draw(st.sampled_from(((bend,), (bend, -bend))))
    feeds = tuple(draw(st.lists(st.sampled_from((RAPID, 300.0, 1000.0, 6000.0)), min_size=1, max_size=3)))
    return Piece(draw(st.sampled_from((2, 3, 10, 60))), (size,), bends, feeds)


@st.composite
def straights(draw: Any) -> Piece:
    """Corners, and between them lines of several feeds that go straight on; some of them are slivers."""
    sizes = draw(st.lists(st.sampled_from((0.001, 0.01, 0.1, 0.3, 1.0, 5.0)), min_size=1, max_size=4))
    corner = draw(st.sampled_from((0.5, 3.4, 10.0, 30.0, 90.0)))
    bends = (corner, *[0.0] * draw(st.integers(1, 4)))
    if draw(st.booleans()):
        bends = (*bends, *(-bend for bend in bends))
    feeds = draw(st.lists(st.sampled_from((RAPID, 1000.0, 6000.0, 30_000.0)), min_size=2, max_size=3))
    return Piece(draw(st.sampled_from((5, 30, 100))), tuple(sizes), bends, tuple(feeds))


@st.composite
def polylines(draw: Any) -> Piece:
    """Corners of any turns, to either side, between lines of any lengths."""
    sizes = draw(st.lists(st.floats(-2, 0.3), min_size=1, max_size=5))
    turn = draw(st.floats(0, 2))
    bends = draw(st.lists(st.tuples(st.sampled_from((1, -1)), st.floats(0.2, 1)), min_size=1, max_size=6))
    feed = draw(st.sampled_from((RAPID, 6000.0, 30_000.0)))
    return Piece(
        draw(st.sampled_from((12, 24))),
        tuple(round(10**size, 4) for size in sizes),
        tuple(round(sign * part * 10**turn, 2) for sign, part in bends),
        (feed,),
    )


@st.composite
def slots(draw: Any) -> Piece:
    """Arcs between straights that touch them."""
    radius, chord, straight = (10 ** draw(st.floats(*ends)) for ends in ((0.2, 1.7), (-1.7, 0.3), (-1, 1.3)))
    bend = min(math.degrees(chord / radius), 30.0)
    chords = max(1, min(SLOT_CHORDS, int(draw(st.sampled_from((20, 90, 180))) / bend)))
    bends = (round(bend, 4),) * (chords + 1)
    if draw(st.booleans()):
        bends += tuple(-bend for bend in bends)
    feed = draw(st.sampled_from((RAPID, 6000.0, 30_000.0)))
    sizes = (round(straight, 3), *[round(chord, 4)] * chords)
    return Piece(draw(st.sampled_from((1, 2, 4))) * (chords + 1), sizes, bends, (feed,))


@st.composite
def cases(draw: Any, machines: Sequence[str] = tuple(MACHINES)) -> Case:
    """A path that takes no more than some seconds."""
    machine = draw(st.sampled_from(sorted(machines)))
    profiles = (
        "linear",
        "linear",
        "cosine",
        "sigmoid",
        *(("jerk", "jerk") if machine in (*JERKS, *JERKS_OF_MOTORS) else ()),
    )
    kinds = pieces() | arcs() | fans() | straights() | polylines() | slots()
    case = Case(
        machine,
        tuple(draw(st.lists(kinds, min_size=1, max_size=4))),
        draw(st.sampled_from(profiles)),
        draw(st.sampled_from(LOOK_AHEADS)),
        draw(st.sampled_from(POLLS)),
        draw(st.sampled_from((0.0, 45.0, 90.0, 20.0))),
    )
    return shortened(case)


def shortened(case: Case) -> Case:
    """The same with fewer lines, if it takes too long."""
    kept: list[Piece] = []
    left = SECONDS
    for piece in case.pieces:
        one = Case(case.machine, (piece,), case.profile)
        took = seconds_at_feed(one.lines, one.settings)
        count = piece.count if took <= left else int(piece.count * left / took)
        if count == 0 and not kept:
            return Case(case.machine, (Piece(1, (1.0,)),), case.profile, case.look_ahead, case.polls)
        if count:
            kept.append(Piece(count, piece.sizes, piece.bends, piece.feeds, piece.slopes))
        left -= min(took, left)
    return Case(case.machine, tuple(kept), case.profile, case.look_ahead, case.polls, case.heading)


def search(
    examples: int,
    seed: int,
    check: Check = measure,
    known: frozenset[str] = frozenset(),
    seen: Callable[[Case, Measured], None] = lambda case, measured: None,
    machines: Sequence[str] = tuple(MACHINES),
) -> BeyondError | None:
    """Draw `cases` cases; the smallest that is beyond a bound of a kind that is not known yet, or None."""

    @seeded(seed)
    @settings(
        max_examples=examples,
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.target, Phase.shrink),
        suppress_health_check=list(HealthCheck),
        report_multiple_bugs=False,
    )
    @given(cases(machines))
    def drawn(case: Case) -> None:
        measured = check(case)
        seen(case, measured)
        target(max(measured.unlimited, measured.soft), label="slow")
        target(measured.paced, label="paced")
        target(measured.share("acceleration"), label="acceleration")
        for kind, text in measured.faults.items():
            if kind not in known:
                raise BeyondError(kind, case, text)

    try:
        drawn()
    except BeyondError as error:
        return with_fewer_pieces(error, check)
    return None


def with_fewer_pieces(error: BeyondError, check: Check) -> BeyondError:
    """Without those that its kind of fault does not need: a library that shrinks gives up before."""
    for i in reversed(range(len(error.case.pieces))):
        case = replace(error.case, pieces=error.case.pieces[:i] + error.case.pieces[i + 1 :])
        text = check(case).faults.get(error.kind) if case.pieces else None
        if text is not None:
            return with_fewer_pieces(BeyondError(error.kind, case, text), check)
    return error
