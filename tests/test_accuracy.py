# SPDX-License-Identifier: MIT
"""The simulated microcontroller methods against hand-computed figures, and the error bounds of Passo."""

import math
import random
import re
from fractions import Fraction

import numpy as np
import pytest
from passo import random_cases
from passo.curve import shapes_of
from passo.moves import MoveBelowSpeed, MoveInTime
from passo.plan import ALPHA_ONE, plan_move, sigmoid_table
from passo.registers import Shape
from passo.shaper import shaped

from benchmarks import passo_side, sources
from benchmarks.accuracy import Measured, gather
from benchmarks.cases import METHODS, NAMED, Method, method_of, random_moves
from benchmarks.forms import FORMS, measure_form, measure_forms
from benchmarks.ideal import Phase, by_speed, in_time, shape_area, shape_value
from benchmarks.measure import Result, check_with_model, measure
from benchmarks.passo_side import CLOCK_HZ, PARAMETERS
from benchmarks.peer import KINDS, compare_with_peer
from benchmarks.resonance import measure_resonances, moves, residual
from benchmarks.sources import Cosine, MultiAxis, Sigmoid, Trapezoid, cosine, multi_axis, sigmoid, trapezoid
from benchmarks.tables import number, page, relative
from tests.helpers.closed_form import Ramp, substep_clocks

SEED = random_cases.seed()
MOVES = 200  # of each method

# Error bounds of Passo: total time in ticks (a move by speeds rounds up each of three phases), and distance
# of a pulse from the planned curve in steps.
TICKS = {"A": 3, "B": 3, "C": 3, "D": 0.5 + 1e-6}
PLANNED = 0.1


# -------------------------------------------------------------------------------------------- the curves ----


def test_ideal_trapezoid() -> None:
    """1000 to 5000 Hz in 0.1 s is 300 steps; of 1000 steps 400 are left for the cruise, which take 0.08 s."""
    curve = by_speed(1000, 1000, 5000, 1000, 0.1, 0.1)
    assert curve.seconds == pytest.approx(0.28)
    assert curve.position(np.array([0, 0.05, 0.1, 0.14, 0.18, 0.28, 1.0])) == pytest.approx(
        [0, 100, 300, 500, 700, 1000, 1000]
    )


def test_ideal_triangle() -> None:
    """Too short for 5000 Hz: the peak is sqrt(1000^2 + 40000 Hz/s * 100)."""
    curve = by_speed(100, 1000, 5000, 1000, 0.1, 0.1)
    assert curve.run == pytest.approx(math.sqrt(5e6))
    assert curve.seconds == pytest.approx(2 * (math.sqrt(5e6) - 1000) / 40_000)
    assert curve.steps == pytest.approx(100)


def test_ideal_in_time() -> None:
    """6400 steps in 0.4 s with ramps of 0.1 s: 21333.3 Hz."""
    curve = in_time(6400, 0.4, 0.1, "cosine")
    assert curve.run == pytest.approx(6400 / 0.3)
    assert curve.position(np.array([0.1, 0.2, 0.3, 0.4])) == pytest.approx(
        [6400 / 6, 3200, 6400 * 5 / 6, 6400]
    )


@pytest.mark.parametrize("shape", Shape, ids=lambda shape: shape.name.lower())
def test_plots_follow_the_same_shapes(shape: Shape) -> None:
    """With an integral that is that of the shape."""
    move = MoveInTime((100,), "linear", Fraction(1, 10), Fraction(1, 20))
    u = np.linspace(0, 1, 257)
    value, area = shapes_of(plan_move(move, CLOCK_HZ, PARAMETERS))[shape](u)
    name = shape.name.lower()
    assert value == pytest.approx(shape_value(name, 5, u)) and area == pytest.approx(shape_area(name, 5, u))


@pytest.mark.parametrize("shape", ("linear", "cosine", "sigmoid", "ease", "quintic"))
def test_areas_are_the_integrals_of_shapes(shape: str) -> None:
    """The position of a phase is the integral of its speed, also for the mirror image."""
    area = 1 / 3 if shape == "ease" else 1 / 2
    seconds = np.linspace(0, 1, 2001)
    for mirror in (False, True):
        phase = Phase(1, 10, 30, shape, 4, mirror)
        speed = np.gradient(phase.position(seconds), seconds)
        assert speed[[0, -1]] == pytest.approx([10, 30], abs=0.1)
        assert np.all(np.diff(speed) > -1e-6)
        assert phase.steps == pytest.approx(10 + 20 * (1 - area if mirror else area))


# ---------------------------------------------------------------------------------------------- method A ----


def test_turn_is_3200_updates_and_1600_pulses() -> None:
    """60 rpm are 3200 updates/s, 10 rpm are 533; (3200^2 - 533^2) / 2 / 40000 = 124 updates are a ramp."""
    move = Trapezoid(360, 60, 10)
    assert (move.n_target, move.v_target, move.v_min, move.n_acc) == (3200, 3200, 533, 124)
    pulses = sources.simulate(move)
    assert len(pulses.times) == 1600
    assert (pulses.start, pulses.run, pulses.stop) == (1e6 / 1876 / 2, 1e6 / 312 / 2, 1e6 / 1876 / 2)


def test_square_roots_are_truncated() -> None:
    """533, then sqrt(533^2 + 80000) = 603.4, then sqrt(603^2 + 80000) = 666.03; at 40000 it is stationary."""
    assert trapezoid.update_speeds(Trapezoid(360, 60, 10))[:3] == [533, 603, 666]
    fast = Trapezoid(3600, 900, 740)  # 39466 to 48000 updates/s in 9330 updates
    assert fast.n_acc == 9330
    assert trapezoid.update_speeds(fast)[534:9330] == [40_000] * (9330 - 534)


def test_short_move_ends_at_speed() -> None:
    """90 degrees at 300 rpm: acceleration takes 3196 updates, more than half of 800: nothing else is left."""
    move = Trapezoid(90, 300, 10)
    assert (move.n_target, move.n_acc, move.cruises) == (800, 3196, False)
    pulses = sources.simulate(move)
    assert pulses.stop > 14 * pulses.start
    assert len(pulses.times) == 400


def test_trapezoid_is_the_loop_of_updates() -> None:
    """The speeds computed by phase equal those of the published loop, update by update."""
    for move in random_moves(METHODS[0], 40, SEED):
        v = move.v_min
        speeds = [v]
        for n in range(1, move.n_target):
            if n < move.n_acc:
                v = math.isqrt(v * v + 80_000)
            elif move.n_target - n > move.n_acc and move.cruises:
                v = move.v_target
            else:
                v = math.isqrt(max(v * v - 80_000, 0))
            v = min(max(v, move.v_min), move.v_target)
            speeds.append(v)
        assert trapezoid.update_speeds(move) == speeds, move


# ---------------------------------------------------------------------------------------------- method B ----


def test_sigmoid_indices() -> None:
    """alpha = 5: x = 16384 - 20480 is below 0 at first; at last d = 32767, x = 28671, 28671 / 32 = 895."""
    ends = {alpha: [sigmoid.index(alpha, n, 500) for n in (0, 500, 1000)] for alpha in (3, 4, 5)}
    assert ends == {3: [128, 512, 896], 4: [0, 512, 1023], 5: [0, 512, 895]}


def test_sigmoid_table() -> None:
    """65535 / (1 + e^5) = 438.6 and 65535 / (1 + e^-3.7488) = 64027: 2.3 % short."""
    table = sigmoid.logistic_table()
    assert len(table) == 1024
    assert (table[0], table[895], table[1023]) == (438, 64027, 65096)


def test_sigmoid_formula_misses_its_ends() -> None:
    """1 / (1 + e^5) = 0.67 % at alpha = 5, 1 / (1 + e^3) = 4.74 % at alpha = 3, at both ends."""
    for alpha, gap in ((5, 0.006693), (3, 0.047426)):
        ends = [sigmoid.formula(alpha, i, 50) for i in (0, 50, 100)]
        assert ends == pytest.approx([gap, 0.5, 1 - gap], abs=1e-6)


def test_sigmoid_frequencies() -> None:
    """400 + 4600 * 438 / 65535 = 430 Hz, 400 + 4600 * 64027 / 65535 = 4894 Hz, and 400 Hz at the end."""
    pulses = sources.simulate(Sigmoid(8000, 400, 5000, 400, 1000, 1000, 5))
    timer = Sigmoid.TIMER_HZ
    assert (pulses.start, pulses.run, pulses.stop) == (timer / 27906, timer / 2451, timer / 30000)
    assert len(pulses.times) == 8000
    assert np.all(np.diff(pulses.times) > 0)


# ---------------------------------------------------------------------------------------------- method C ----


def test_multi_axis_table() -> None:
    """1 to 50 pulses/ms in 100 ms: 1 + 0.49 i, truncated; 36000 / 50 fits, 36000 / 70 is 514.3."""
    move = MultiAxis((20_000, 12_000, 8_000), 1, 50, 100)
    assert multi_axis.pulses_each_ms(move, 100)[[0, 1, 2, 3, 50, 99]].tolist() == [1, 1, 1, 2, 25, 49]
    assert multi_axis.period(move, np.array([1, 50, 70])).tolist() == [72_000, 1440, 1028]
    assert move.cruises  # (2 + 0.49 * 99) * 100 = 5051


def test_multi_axis_triangle() -> None:
    """3000 pulses: (sqrt(4 + 4 * 0.49 * 3000) - 2) / 0.98 = 76.2 ms, to 1 + 0.49 * 76 = 38 pulses/ms."""
    move = MultiAxis((3_000, 1_800, 1_200), 1, 50, 100)
    pulses = sources.simulate(move)
    assert not move.cruises
    assert pulses.run == 72e6 / (2 * (36_000 // 38))
    assert [len(times) for times in (pulses.times, *pulses.followers)] == [3000, 1800, 1200]


def test_followers_keep_5_to_3_to_2() -> None:
    """50, 30 and 20 kHz: of each 50 pulses of the main axis the others make 30 and 20."""
    for sub in (30, 20):
        every = multi_axis.follower(5000, 100 * sub)
        assert np.bincount(every // 50, minlength=100).tolist() == [sub] * 100


def test_follower_is_the_loop_of_pulses() -> None:
    """The closed form is the published loop."""
    rng = random.Random(SEED)
    for _ in range(50):
        main = rng.randint(1, 300)
        sub = rng.randint(0, main)
        sy, st, made = -(-main // 2), main - sub, []
        for pulse in range(main):
            if sy >= st:
                made.append(pulse)
                sy -= st
            else:
                sy += sub
        assert multi_axis.follower(main, sub).tolist() == made[: sub if sub else 0]


# ---------------------------------------------------------------------------------------------- method D ----


def test_slices_fall_short_until_repaired() -> None:
    """6400 in 0.4 s: 0.5 of a pulse is lost in each of 400 slices, which is about 200."""
    move = Cosine(6400, 400, 200)
    assert move.f_max == 32_000
    assert cosine.slices_at(move, move.f_max).sum() == 6200
    assert cosine.repaired(move).sum() == 6400
    with_cruise = Cosine(6400, 400, 100)
    slices = cosine.slices_at(with_cruise, with_cruise.f_max)
    assert slices[100:300].tolist() == [21] * 200  # 21333.3 Hz
    assert slices.sum() < 6400


def test_cosine_times_are_near_the_published_ones() -> None:
    """Without cruise exactly; with cruise within the errors of the publication, which are up to 0.8 %."""
    for case in NAMED:
        if case.published is not None:
            pulses = sources.simulate(case.move)
            tolerance = 0.008 if case.move.total_ms > 2 * case.move.ramp_ms else 1e-9
            assert pulses.seconds == pytest.approx(case.published, rel=tolerance), case
            assert len(pulses.times) == case.move.steps


# ------------------------------------------------------------------------------------------------- Passo ----


@pytest.fixture(scope="module")
def results() -> dict[str, list[Result]]:
    """A small sample of each method."""
    return {method.key: [measure(move) for move in random_moves(method, MOVES, SEED)] for method in METHODS}


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_bounds(results: dict[str, list[Result]], method: Method) -> None:
    """Every step, no substep missing, the time to some ticks, frequencies to 1e-9, the plan to 0.1 steps."""
    for result in results[method.key]:
        passo, move = result.passo, result.move
        assert passo["steps"] == passo["missing"] == 0, move
        assert passo["ticks"] <= TICKS[method.key], move
        assert passo["planned"] <= PLANNED, move
        for name in ("start", "stop"):
            assert math.isnan(passo[name]) or passo[name] < 1e-9, (name, move)
        # A step can be off by the rounding of time at full speed.
        off = (
            (passo["ticks"] + TICKS[method.key]) * passo_side.TICK_SECONDS * passo_side.wanted_curve(move).run
        )
        assert passo["distance"] <= off + PLANNED, move


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.key)
def test_passo_is_better_in_every_move(results: dict[str, list[Result]], method: Method) -> None:
    """More than ten times closer to the curve than the published methods, which lose no steps either."""
    for result in results[method.key]:
        assert result.passo["distance"] < result.source["distance"] / 10, result.move
        assert result.source["steps"] <= 1, result.move


@pytest.mark.parametrize("name", FORMS)
def test_forms_keep_to_their_plans(name: str) -> None:
    """All steps and substeps; moves in a given time to half a tick, by speed and ramp time to three."""
    for errors in measure_forms(name, 25, SEED):
        assert errors["steps"] == errors["missing"] == 0
        assert errors["planned"] <= PLANNED
        assert math.isnan(errors["ticks"]) or errors["ticks"] <= (4 if "ramp time" in name else 0.5 + 1e-6)


@pytest.mark.parametrize("name", KINDS)
def test_plans_are_as_short_as_those_of_a_peer(name: str) -> None:
    """Never shorter than the shortest possible; longer by some ticks, and by less than 0.02 %."""
    found = compare_with_peer(name, 400, SEED)
    assert found["fewest_ticks"] >= 0 and found["most_ticks"] < 10
    assert found["long_moves"] > 350 and found["worst"] < 2e-4


def test_shaped_ramps_leave_a_resonance_at_rest() -> None:
    """At its frequency some hundredths of a step; with ei a tenth of linear ramps, 10 % off too."""
    rows = {(row["ramp"], row["damping"]): row["left"] for row in measure_resonances()}
    for damping in (0, 0.1):
        linear = rows["linear", damping]
        assert linear[1] > 8
        assert rows["zv", damping][1] < 0.06 and rows["mzv", damping][1] < 0.06
        assert rows["ei", damping][1] < linear[1] / 10
        assert all(rows["ei", damping][i] < linear[i] / 10 for i in (0, 2))


@pytest.mark.parametrize("name", ["zv", "mzv", "ei"])
def test_the_order_of_time_matters(name: str) -> None:
    """The mirror image of a shaper for a damped resonance leaves many times more."""
    move = moves(Fraction(1, 10))[name]
    points = shaped(move.shaper, move.ramp_time)
    mirrored = MoveInTime(move.steps, "user", move.total_time, move.ramp_time, points)
    assert residual(mirrored, 40, 0.1) > 2 * residual(move, 40, 0.1) + 0.3


def test_steps_are_those_of_the_model() -> None:
    """steps.c puts each step on the clock on which the C model's pin rises; also with tables for an alpha."""
    moves = [move for method in METHODS for move in random_moves(method, 2, SEED)]
    alphas = [case.move for case in NAMED if isinstance(case.move, Sigmoid)]
    for move in [*moves, *alphas]:
        assert check_with_model(passo_side.make(move).plan) == sum(passo_side.wanted_steps(move))


def test_steps_are_those_of_the_closed_form() -> None:
    """steps.c agrees with closed_form.py on a jerk-limited plan, which has mirrored ramps."""
    move = MoveInTime((300,), "jerk", Fraction(200_000, CLOCK_HZ), Fraction(80_000, CLOCK_HZ))
    plan = plan_move(move, CLOCK_HZ, PARAMETERS)
    ramps = [Ramp(ramp.velocity_end, ramp.ticks, ramp.shape, ramp.mirror) for ramp in plan.ramps]
    assert any(ramp.mirror for ramp in ramps)
    every = np.array(substep_clocks(ramps, plan.tick_log2))
    (clocks,), missing = passo_side.step_clocks(plan)
    assert missing == 0
    assert clocks.tolist() == every[passo_side.step_substeps(plan.line.substeps, 300) - 1].tolist()


def test_missing_steps_are_seen() -> None:
    """A plan whose ramps are too short for its line is rejected."""
    plan = passo_side.make(Cosine(1000, 100, 50)).plan
    plan.ramps[0].ticks -= 100
    clocks, missing = passo_side.step_clocks(plan)
    assert missing > 0
    assert len(clocks[0]) < 1000


def test_sigmoid_tables_are_the_planners() -> None:
    """The tables that steps.c uses come from the formula; the planner's, in integers, are the same."""
    for alpha in (3, 3.5, 4, 4.5, 5):
        assert list(sigmoid_table(round(alpha * ALPHA_ONE))) == passo_side.tables(alpha)[1][:256].tolist()


def test_highest_safe_frequency() -> None:
    """3200 in 0.4 s at 19200 Hz: ramps of 0.4 - 3200 / 19200 = 0.23 s; but half of the time is the most."""
    move = MoveBelowSpeed((3200,), "cosine", Fraction(4, 10), Fraction(19_200))
    plan = plan_move(move, CLOCK_HZ, PARAMETERS)
    ticks = CLOCK_HZ * 2 // 10 // 128
    assert (plan.c.accelerate_ticks, plan.c.cruise_ticks, plan.c.decelerate_ticks) == (ticks, 0, ticks)


# ------------------------------------------------------------------------------------------------ tables ----


def test_page_has_all_methods_and_forms(results: dict[str, list[Result]]) -> None:
    """The page has all measured methods and forms."""
    rng = random.Random(SEED)
    forms = {name: [measure_form(make(rng))] for name, make in FORMS.items()}
    peers = {name: compare_with_peer(name, 10, SEED) for name in KINDS}
    named = [measure(case.move) for case in NAMED]
    some = [result for method in results.values() for result in method]
    report = {"cases": MOVES, "seed": SEED} | gather(Measured(some, forms, peers, 1, 1), named)
    text = page(report)
    for title in (*(method.title for method in METHODS), *FORMS, *(case.text for case in NAMED)):
        assert title in text
    assert {method_of(case.move).key for case in NAMED} == set("ABCD")
    assert "{" not in text and not re.search(r"\bnan\b", text)


def test_numbers() -> None:
    """Three digits at most, no exponents, ppm where percents are too small."""
    numbers = [number(x) for x in (0, 0.0000123, 0.012345, 0.5, 1.234, 45.67, 123.4, 12345)]
    assert numbers == ["0", "0.000012", "0.012", "0.5", "1.23", "45.7", "123", "12,345"]
    assert [relative(x) for x in (0, 1e-12, 1.5e-6, 0.0123, 1)] == ["0", "0", "1.50 ppm", "1.23 %", "100 %"]
