# SPDX-License-Identifier: MIT
"""The path planner: its pulses, as made by the C model through the driver, against its limits."""

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from passo import random_cases
from passo.axis_judge import Marks, faults, shares
from passo.build import Parameters
from passo.driver import DriverError
from passo.native import ffi, planner
from passo.path import Path, PathAxis, PathSettings
from passo.path_rounding import Line
from passo.plan import PlanError

from benchmarks import path_cases
from benchmarks.path_plan import plan
from benchmarks.path_reference import seconds
from tests.helpers.core_steps import sum_of_velocities
from tests.helpers.path_judge import judge, steps_at
from tests.helpers.path_player import Player, play
from tests.helpers.plans import ONE, Ramp

MACHINE = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)), tolerance=0)
JUMPING = replace(MACHINE, axes=(PathAxis(jump=3), PathAxis(jump=2), PathAxis(400, 12, 100, 1)))

# small steps, so that their times show the jerk
SOFT = replace(
    MACHINE,
    axes=(PathAxis(1600, jerk=50_000), PathAxis(1600, jerk=50_000), PathAxis(1600, 12, 100, jerk=5000)),
    profile="jerk",
)

CASES: dict[str, Callable[[], list[Line]]] = {
    "circle": path_cases.circle,
    "star": lambda: path_cases.star(20, 5),
    "text": lambda: path_cases.text("PA"),
    "trochoid": lambda: path_cases.trochoid(2),
    "spiral": lambda: path_cases.spiral(1500),
    "wander": lambda: path_cases.wander(random.Random(3), 60),
}


def settings_of(name: str) -> PathSettings:
    return {"jump": JUMPING, "jerk": SOFT}.get(name) or replace(MACHINE, profile=name)


@pytest.mark.parametrize("profile", ["linear", "cosine", "sigmoid", "jump", "jerk"])
@pytest.mark.parametrize("case", CASES)
def test_the_pulses_keep_all_limits(case: str, profile: str) -> None:
    """Speed, acceleration, corners and jumps of each axis, measured from the steps; ends and order exact."""
    lines, settings = CASES[case](), settings_of(profile)
    played = play(lines, settings)
    verdict = judge(lines, settings, played)
    assert verdict.problems == []
    assert len(played.motions) == 1
    least = 0.84 if profile == "jerk" else 0.9  # no slower than it must be; of jerk, part is for the curve
    assert max(verdict.acceleration, verdict.speed, verdict.corner, verdict.jerk) > least


@pytest.mark.parametrize("settings", [MACHINE, SOFT], ids=["linear", "jerk"])
@pytest.mark.parametrize("look_ahead", [4, 8, 1000])
def test_any_look_ahead_keeps_all_limits(look_ahead: int, settings: PathSettings) -> None:
    """From the shortest to one that holds the whole path."""
    lines = path_cases.circle(chords=120)
    played = play(lines, settings, look_ahead)
    assert judge(lines, settings, played).problems == []


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"axes": (PathAxis(acceleration=1050), *MACHINE.axes[1:])}, "acceleration"),
        ({"junction_deviation": 0.012}, "corner"),
    ],
)
def test_the_judge_sees_limits_that_are_too_high(wrong: dict[str, Any], named: str) -> None:
    """A planner that exceeds them by a few percent is caught."""
    lines = [*path_cases.star(20, 5), *path_cases.wander(random.Random(3), 60)]
    played = play(lines, replace(MACHINE, **wrong))
    assert any(named in problem for problem in judge(lines, MACHINE, played).problems)


def test_the_judge_sees_a_feed_that_is_too_high() -> None:
    """By half a percent."""
    lines = path_cases.circle()
    played = play([(target, path_cases.FEED * 1.005) for target, _ in lines], MACHINE)
    assert any("speed" in problem for problem in judge(lines, MACHINE, played).problems)


def test_the_judge_sees_jerk() -> None:
    """By a fifth too much; linear ramps have far more."""
    lines = path_cases.text("PA")
    stronger = tuple(replace(axis, jerk=float(axis.jerk) * 1.2) for axis in SOFT.axes)
    for change in ({"axes": stronger}, {"profile": "cosine"}, {"profile": "linear"}):
        wrong = replace(SOFT, **change)
        assert any("jerk" in problem for problem in judge(lines, SOFT, play(lines, wrong)).problems)


def test_a_limit_of_jerk_takes_little_time() -> None:
    """As a ratio of the fastest motion without it, which jumps from one acceleration to the next.

    In curves three quarters or half of the limits are for the way along them.
    """
    for case, most in ((path_cases.circle, 1.15), (path_cases.square, 1.11), (path_cases.trochoid, 1.14)):
        lines = case()
        assert 1 < plan(lines, SOFT, 48).seconds / seconds(lines, replace(SOFT, profile="linear")) < most


def test_the_judge_sees_jumps_and_steps() -> None:
    """A jump above that of an axis, a lost step, a step too many, a wrong end."""
    lines = path_cases.trochoid(2)
    played = play(lines, replace(JUMPING, axes=(PathAxis(jump=3.1), *JUMPING.axes[1:])))
    assert any("jump" in problem for problem in judge(lines, JUMPING, played).problems)
    lost = replace(played, clocks=[played.clocks[0][:-1], *played.clocks[1:]])
    assert any("steps instead of" in problem for problem in judge(lines, JUMPING, lost).problems)
    wrong = replace(played, positions=[played.positions[0] + 1, *played.positions[1:]])
    assert any("the end is" in problem for problem in judge(lines, JUMPING, wrong).problems)
    late = replace(played, clocks=[played.clocks[0] + 40_000, *played.clocks[1:]])
    assert any("order of the path" in problem for problem in judge(lines, JUMPING, late).problems)


# ---------------------------------------------------------------------------------------- exact numbers


def substeps_under(ramps: Sequence[Any], tick_log2: int) -> float:
    """Substeps by the recurrence of the core, in Python integers, less those that a fraction is missing."""
    total = velocity = 0
    for c in ramps:
        ramp = Ramp(c.ticks, c.shape, c.mirror, velocity, c.velocity_end, c.progress_step)
        total += sum_of_velocities(ramp) if c.ticks else 0
        velocity = c.velocity_end
    return (total << tick_log2) / ONE


RANDOM = {
    1: "a fast line in a curve between two slower ones, limited by its bends, not by their feeds",
    4: "a ramp that comes down over less than its length, because it may not be steeper",
    7: "the same, begun with what the ramp before has left of a steeper line",
    6: "the way down to a corner, once it is within what had been a level part before it",
    8: "the steps of a strong curve: ever shorter ramps left the core without any",
    18: "constant speed behind a corner, for as long as the speed there needs it, not that of later ramps",
}


@pytest.mark.parametrize("number", RANDOM)
def test_a_random_polyline_keeps_all_limits(number: int) -> None:
    """Each has one thing that was wrong in the planner, or in the judge."""
    *_, lines = path_cases.wanderings(number + 1)
    settings = replace(MACHINE, tolerance=0)
    verdict = judge(lines, settings, play(lines, settings))
    assert verdict.problems == []


@pytest.mark.parametrize("profile", ["linear", "cosine", "sigmoid", "jerk"])
def test_the_ramps_cover_exactly_the_substeps_of_the_lines(profile: str) -> None:
    """However many ramps there are, nothing is left at the end, and no ramp is steeper than it may be."""
    for number, lines in enumerate(path_cases.wanderings(12, random_cases.seed())):
        parameters = Parameters(tick_log2=random.Random(number).choice([7, 7, 8, 10]))
        planned = plan(lines, settings_of(profile), 48, parameters)
        wanted = sum(line.substeps for line in planned.lines)
        assert abs(substeps_under(planned.ramps, parameters.tick_log2) - wanted) < 1 / 64


def test_the_planner_knows_where_the_ramps_end() -> None:
    """To 2^-32 substep per ramp and 2^-41 per tick, also in ramps so long that progress rounds unevenly."""
    path = Path(replace(MACHINE, acceleration=77), Parameters(), 400)
    for target, feed in path_cases.wander(random.Random(5), 100):
        path.add(target, feed)
    path.end()
    ends = [0]
    while (line := path.next_line()) is not None:
        ends.append(ends[-1] + line.substeps)
    velocity = covered = ticks = count = longest = 0
    while (c := path.next_ramp()) is not None:
        ramp = Ramp(c.ticks, c.shape, c.mirror, velocity, c.velocity_end, c.progress_step)
        covered += sum_of_velocities(ramp) << 7 if c.ticks else 0
        velocity, ticks, count = c.velocity_end, ticks + c.ticks, count + 1
        longest = max(longest, c.ticks if ramp.velocity_start != velocity else 0)
        if not c.last and velocity > 0:
            known = (ends[path.c.planned] << 32) + path.c.offset
            assert abs(Fraction(covered, 1 << 48) - Fraction(known, 1 << 32)) <= count / 2**32 + ticks / 2**41
    assert longest > 20_000


def test_the_lines_are_as_long_as_the_path() -> None:
    """Rounding to substeps does not add up, and steps are rounded from absolute positions."""
    lines = path_cases.spiral(4000)
    planned = plan(lines, MACHINE, 48)
    ends = np.array([[0.0, 0.0, 0.0], *(list(target) for target, _ in lines)])
    length = np.cumsum(np.linalg.norm(np.diff(ends, axis=0), axis=1)) * planned.path.substeps_per_mm
    made = np.cumsum([line.substeps for line in planned.lines])
    assert np.abs(made - length).max() < 1
    position = [0, 0, 0]
    for (target, _), line in zip(lines, planned.lines, strict=True):
        for axis in range(3):
            position[axis] += -line.steps[axis] if line.directions >> axis & 1 else line.steps[axis]
        assert position == steps_at(target, MACHINE)


@pytest.mark.parametrize("look_ahead", [48, 100_000])
def test_it_is_as_fast_as_the_limits_allow(look_ahead: int) -> None:
    """Against the exact profile in floating point; the circle takes no more than 1.37 s."""
    for case in (path_cases.circle, path_cases.square, path_cases.star, path_cases.text):
        lines = case()
        assert 0.99 < plan(lines, MACHINE, look_ahead).seconds / seconds(lines, MACHINE) < 1.02
    for lines in path_cases.wanderings(30, random_cases.seed()):
        assert plan(lines, MACHINE, look_ahead).seconds / seconds(lines, MACHINE) < 1.02
    circle = plan(path_cases.circle(), replace(MACHINE, acceleration=1000), look_ahead)
    assert 1.356 < circle.seconds < 1.37


PROFILES = ("linear", "cosine", "sigmoid", "jerk")


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("turn", [0.0, 0.5, 3.4, 5.7])
def test_a_line_is_not_slowed_down_by_the_feeds_of_its_neighbours(profile: str, turn: float) -> None:
    """A rapid between two slow cuts, and feeds that alternate, straight on or in a bend of some degrees."""
    x, y = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    settings = replace(SOFT, profile=profile)
    rapid = [((1, 0, 0), 5.0), ((1 + 98 * x, 98 * y, 0), None), ((2 + 98 * x, 98 * y, 0), 5.0)]
    speed = 200 / max(x, y)
    # 2 mm at 5 mm/s, and the rapid with its two ramps
    fastest = 0.4 + 98 / speed + (speed - 5) ** 2 / speed / (1000 / max(x, y))
    assert plan(rapid, settings, 48).seconds < 1.002 * fastest + 0.01 + 0.32 * (profile != "linear")
    feeds = [((i * x, i * y, 0), 5.0 if i % 2 else 100.0) for i in range(1, 41)]
    assert plan(feeds, settings, 48).seconds < 5.7


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("feed", [0.0017, 0.05, 0.5, 2.0])
@pytest.mark.parametrize("size", [0.01, 0.3, 1.0])
def test_a_low_feed_takes_the_time_of_its_length(feed: float, size: float, profile: str) -> None:
    """Also where the acceleration makes the feed in a few ticks, or in less than one."""
    settings = replace(SOFT, profile=profile)
    square = [(target, feed) for target, _ in path_cases.square(size)]
    lost = 8 * (0.002 * feed + feed / 1000 + (feed / 10_000) ** 0.5 * (profile == "jerk"))
    assert 3.998 * size / feed < plan(square, settings, 48).seconds < 4.002 * size / feed + lost
    assert plan([((0, 0, -size), feed)], settings, 48).seconds < 1.001 * size / feed + 10 * lost


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("feed", [3e-6, 1.5e-6, 1e-7])
def test_the_slowest_feeds_move(feed: float, profile: str) -> None:
    """Also those that take no length to reach."""
    path = Path(settings_of(profile), Parameters())
    path.add((0.1, 0, 0), feed)
    path.add((0.1, 0.1, 0), feed)
    path.end()
    made = [path.next_ramp().velocity_end for _ in range(100)]
    unit = 64_000_000 / path.substeps_per_mm / 2**32  # mm/s, by which feeds are rounded
    assert 0 < made[0] / 2**16 * unit <= max(feed, unit) and made == made[:1] * 100


def test_curves_leave_an_axis_within_its_acceleration() -> None:
    """Along the path and across it together, where both are at their most."""
    fine = replace(MACHINE, axes=(PathAxis(1600), PathAxis(1600), PathAxis(400, 12, 100)))
    for radius, chords, feed in ((5, 128, 100.0), (20, 360, None), (20, 360, 100.0)):
        lines = [(target, feed) for target, _ in path_cases.circle(radius, chords)]
        played = play(lines, fine)
        marks = Marks.of(lines, fine, played.clocks, played.steps)
        found = shares(played.clocks, played.steps, fine, marks, ("acceleration",))
        assert faults(found) == []


def test_cosine_ramps_pass_corners() -> None:
    """A shaped ramp spans many lines, and is not split without need."""
    planned = plan(path_cases.circle(), replace(MACHINE, profile="cosine"), 360)
    shaped = [ramp for ramp in planned.ramps if ramp.shape]
    assert len(shaped) == 2
    assert sum(ramp.ticks for ramp in shaped) > 100_000


# ------------------------------------------------------------------------------------------- never dry


@pytest.mark.parametrize("number", range(10))
def test_a_slow_host_means_a_stop_without_a_fault(number: int) -> None:
    """Lines come with pauses, between dwells and ends: all limits hold, and the path is exact."""
    rng = random.Random(random_cases.seed() * 1000 + number)
    settings = rng.choice([MACHINE, JUMPING, replace(rng.choice([MACHINE, JUMPING]), profile="cosine"), SOFT])
    lines = path_cases.wander(rng, rng.randint(1, 40))
    player = Player(settings, rng.choice([4, 8, 48, 200]), rng.choice([16_000, 64_000, 200_000]))
    for target, feed in lines:
        player.wait(lambda: player.path.room > 0)
        player.rest(rng.choice([0, 0, 0.001, 0.01, 0.1]))
        if rng.random() < 0.05:
            player.path.dwell(rng.choice([0, 0.02]))
        if rng.random() < 0.05:
            player.path.end()
        player.path.add(target, feed)
    verdict = judge(lines, settings, player.finish(), rests=True)
    player.engine.close()
    assert verdict.problems == []


def small_circle(radius: float, chord: float, count: int, feed: float) -> list[Line]:
    """An arc in chords of micrometers, as a file has them."""
    angles = (chord / radius * i for i in range(1, count + 1))
    points = ((radius - radius * math.cos(a), radius * math.sin(a), 0.0) for a in angles)
    return [(tuple(round(mm, 6) for mm in point), feed) for point in points]


FAST = replace(MACHINE, axes=(PathAxis(80, 500, 20_000), PathAxis(80, 500, 20_000), PathAxis(400, 12, 100)))

DENSE: dict[str, Callable[[], list[Line]]] = {
    "circle of 2 mm": lambda: small_circle(2, 0.0041888, 300, 50),
    "circle of 20 mm": lambda: small_circle(20, 0.02, 600, 100),
    "zigzag": lambda: [((0.002 * (i % 2), 0, 0), 50.0) for i in range(1, 200)],
    "comb": lambda: [((0.002 * i, 0.01 * (i % 2), 0), 50.0) for i in range(1, 200)],
    "feeds": lambda: [((0.01 * i, 0, 0), 50.0 if i % 2 else 1.0) for i in range(1, 60)],
    "spiral": lambda: path_cases.spiral(200, 0.01),
}


@pytest.mark.parametrize("polls", [500, 1000, 8000])
@pytest.mark.parametrize("case", DENSE)
def test_no_pattern_of_lines_leaves_the_core_dry(case: str, polls: int) -> None:
    """Whatever look-ahead, profile and queues of the core: the path is slower, and does not stop."""
    rng = random.Random(f"{case} {polls}")
    profiles = [MACHINE, FAST, replace(FAST, tolerance=None), replace(FAST, profile="cosine"), SOFT]
    for settings in (MACHINE, rng.choice(profiles), rng.choice(profiles)):
        lines, log2 = DENSE[case](), rng.choice([(8, 4), (8, 4), (4, 6), (2, 4)])
        queues = {"line_queue_log2": log2[0], "ramp_queue_log2": log2[1]}
        player = Player(settings, rng.choice([4, 48, 300]), settings.clock_hz // polls, **queues)
        for target, feed in lines:
            player.add(target, feed)
        played = player.finish()
        player.engine.close()
        assert played.positions == steps_at(lines[-1][0], settings) and played.drained == 0


class Host(Player):
    """Polls at a rate that counts what a poll itself takes; adds lines in bursts, with rests between them."""

    def poll(self, until: Callable[[], bool] = lambda: True) -> None:
        begin = self.engine.clock
        self.feed.poll()
        self.turns.run(max(1, self.loop - (self.engine.clock - begin)))


def fed(
    lines: list[Line], settings: PathSettings, look_ahead: int, polls: int, burst: int = 0, **queues: int
) -> float:
    """Seconds until a path is over, fed by a host; DriverError if the core starved or a step is missing."""
    host = Host(settings, look_ahead, settings.clock_hz // polls, **queues)
    try:
        for count, (target, feed) in enumerate(lines, 1):
            host.add(target, feed)
            if burst and count % burst == 0:
                host.rest(0.02)
        played = host.finish()
        assert played.positions == steps_at(lines[-1][0], settings) and played.drained == 0
        return host.engine.clock / settings.clock_hz
    finally:
        host.engine.close()


# Ramps come down while only lines are sent; lines end while only ramps are; the last ramps wait for company.
STARVED: list[tuple[str, PathSettings, int, int, int, tuple[int, int]]] = [
    *(("spiral", FAST, 48, polls, 0, (8, 4)) for polls in (1700, 1750, 1800, 1850, 1900, 1950, 2000)),
    ("spiral", MACHINE, 4, 600, 0, (4, 6)),
    ("spiral", MACHINE, 48, 958, 0, (5, 5)),
    ("zigzag", FAST, 4, 1127, 40, (8, 4)),
    ("circle of 2 mm", FAST, 8, 1538, 40, (4, 4)),
]


def drawn(rng: random.Random) -> tuple[str, PathSettings, int, int, int, tuple[int, int]]:
    """Any of these, from 500 to 4,000 polls a second."""
    kinds = [MACHINE, FAST, FAST, replace(FAST, tolerance=None), replace(FAST, profile="cosine"), SOFT]
    queues = [(8, 4), (4, 4), (4, 6), (5, 5)]
    case, settings, look_ahead = rng.choice(list(DENSE)), rng.choice(kinds), rng.choice([4, 8, 16, 48, 300])
    polls, burst = int(500 * 8 ** rng.random()), rng.choice([0, 7, 40])
    return case, settings, look_ahead, polls, burst, rng.choice(queues)


@pytest.mark.parametrize("number", range(len(STARVED) + 12))
def test_what_the_core_needs_first_is_sent_first(number: int) -> None:
    """Lines or ramps, at exactly the stated rate or a higher one, whatever the depths of both queues."""
    rng = random.Random(random_cases.seed() * 1000 + number)
    case, settings, look_ahead, polls, burst, log2 = [*STARVED, *(drawn(rng) for _ in range(12))][number]
    queues = {"line_queue_log2": log2[0], "ramp_queue_log2": log2[1]}
    host = int(polls * rng.choice([1, rng.uniform(1, 4)])) if number >= len(STARVED) else polls
    fed(DENSE[case](), replace(settings, polls=polls), look_ahead, host, burst, **queues)


@pytest.mark.parametrize("case", ["circle of 2 mm", "circle of 20 mm", "spiral"])
def test_fewer_polls_mean_a_slower_path(case: str) -> None:
    """From 200 stated polls a second on; a quarter of what is stated is not enough."""
    took = []
    for polls in (2000, 500, 200):
        settings = replace(FAST, polls=polls)
        took.append(fed(DENSE[case](), settings, 48, polls))
        if polls == 200:
            with pytest.raises(DriverError):
                fed(DENSE[case](), settings, 48, polls // 4)
    assert took == sorted(took) and took[-1] > 2 * took[0]


def test_short_lines_are_merged_within_the_tolerance() -> None:
    """As far as they are nearly straight; the end, and the time of the whole, are kept."""
    circle = small_circle(20, 0.02, 6283, 100)
    merged = plan(circle, replace(MACHINE, tolerance=None), 48)
    assert len(merged.lines) < len(circle) / 8
    assert merged.seconds < 1.01 * plan(path_cases.circle(), MACHINE, 48).seconds
    for tolerance, most in ((0.0005, 700), (0.002, 400), (0, 6283)):
        planned = plan(circle, replace(MACHINE, tolerance=tolerance), 48)
        assert len(planned.lines) <= most and (tolerance > 0) == (len(planned.lines) < 6283)
        position = np.zeros(3, int)
        for line in planned.lines:
            signs = np.array([-1 if line.directions >> axis & 1 else 1 for axis in range(3)])
            position += signs * np.array(list(line.steps)[:3])
            mm = np.array(position[:2]) / 80
            assert abs(math.hypot(mm[0] - 20, mm[1]) - 20) < tolerance + 0.01
        assert position.tolist() == steps_at(circle[-1][0], MACHINE)


def test_what_is_not_alike_is_not_merged() -> None:
    """Another feed, another output, a dwell, a corner, a reversal."""
    step = 0.01
    for change in ("feed", "output", "dwell", "corner", "back", "nothing"):
        path = Path(replace(MACHINE, tolerance=None), Parameters(), 48)
        for i in range(1, 11):
            half = change if i > 5 else ""
            y = step * (i - 5) if half == "corner" else 0
            x = step * (10 - i) if half == "back" else step * i
            if half == "dwell" and i == 6:
                path.dwell()
            path.add((x, y, 0), 90.0 if half == "feed" else 100.0, int(half == "output"))
        assert path.c.added == (1 if change == "nothing" else 2), change


def test_silence_is_a_stop_at_the_end_of_the_known_path() -> None:
    """The motion ends there, the next line starts from there, and nothing was lost."""
    lines = path_cases.circle(chords=90)
    player = Player(MACHINE, 48)
    for count, (target, feed) in enumerate(lines):
        player.add(target, feed)
        if count == 30:
            player.wait(lambda: not player.feed.is_moving)
            assert player.driver.positions()[:3] == steps_at(target, MACHINE)
    played = player.finish()
    player.engine.close()
    assert judge(lines, MACHINE, played, rests=True).problems == []
    assert len(played.motions) == 2


def test_the_newest_line_waits_for_the_next_one() -> None:
    """LAST cannot be added to a line that was handed out."""
    path = Path(MACHINE, Parameters(), 8)
    path.add((10, 0, 0), 50)
    assert path.next_line() is None and path.next_ramp() is None
    path.add((20, 0, 0), 50)
    assert path.next_line().last is False and path.next_line() is None
    path.end()
    assert path.next_line().last is True and path.next_line() is None
    path.add((30, 0, 0), 50)
    path.end()
    assert path.next_line() is None and not path.next_motion()
    while (ramp := path.next_ramp()) is not None:
        last = ramp.last
    assert last and path.next_motion()
    assert path.next_line().last is True


# ---------------------------------------------------------------------------------- hold, resume, stop


def test_hold_and_override_change_no_step() -> None:
    """The same steps in the same order, later; a hold of any length starves nothing."""
    lines = path_cases.circle(chords=120)
    still = play(lines, MACHINE)
    player = Player(MACHINE, 48)
    for count, (target, feed) in enumerate(lines):
        player.add(target, feed)
        if count == 70:
            player.driver.call("override", 40)
        if count == 80:
            player.driver.call("hold")
            player.rest(1)
            player.driver.call("resume")
        if count == 100:
            player.driver.call("override", 100)
    played = player.finish()
    player.engine.close()
    assert len(played.motions) == 1
    assert played.moving > still.moving + MACHINE.clock_hz
    assert [steps.tolist() for steps in played.steps] == [steps.tolist() for steps in still.steps]
    assert played.positions == still.positions and played.drained == 0


def test_an_override_above_100_percent_plans_anew_what_is_not_sent() -> None:
    """From half of the circle on it is faster, within the limits of axes and corners, and exact."""
    lines = [(target, 50.0) for target, _ in path_cases.circle()]
    player = Player(MACHINE, 48)
    for count, (target, feed) in enumerate(lines):
        player.add(target, feed)
        if count == 180:
            player.path.override(1.5)
    played = player.finish()
    player.engine.close()
    faster = [(target, 75.0) for target, _ in lines]
    verdict = judge(faster, MACHINE, played)
    assert verdict.problems == []
    assert verdict.speed > 0.999
    half = (seconds(lines, MACHINE) + seconds(faster, MACHINE)) / 2
    assert abs(played.moving / MACHINE.clock_hz - half) < 0.2


@pytest.mark.parametrize("command", ["stop", "abort"])
def test_after_a_stop_the_path_begins_where_it_stopped(command: str) -> None:
    """The rest is dropped; positions are exact, and the next path ends exactly."""
    player = Player(MACHINE, 48)
    for target, feed in path_cases.circle(chords=120)[:100]:
        player.add(target, feed)
    player.driver.call(command)
    player.wait(lambda: player.driver.state.name == "STOPPED")
    player.driver.call("clear")
    positions = player.driver.positions()[:3]
    player.path.restart(positions)
    player.feed.open()
    player.add((1, 2, 3), None)
    player.add((-5, 3, 0), 80)
    played = player.finish()
    player.engine.close()
    assert played.positions == steps_at((-5, 3, 0), MACHINE)
    assert [int(steps[-1]) for steps in played.steps[:2]] == played.positions[:2]


@pytest.mark.parametrize(("command", "after"), [("stop", 20), ("stop", 70), ("abort", 45), ("abort", 80)])
def test_after_a_stop_the_rest_of_the_path_can_be_made(command: str, after: int) -> None:
    """From the step at which it stopped, and to the exact end; no step of the path is left out."""
    lines = path_cases.circle(chords=120)
    player = Player(MACHINE, 400)
    for target, feed in lines:
        player.add(target, feed)
    player.path.end()
    ends = [steps_at(target, MACHINE) for target, _ in lines]
    player.wait(lambda: player.feed.is_moving and player.driver.positions()[:2] != [0, 0])
    while player.feed.c.done < after:
        player.poll()
    player.driver.call(command)
    player.wait(lambda: player.driver.state.name == "STOPPED")
    player.driver.call("clear")
    assert player.feed.recover(player.driver.positions()[:3])
    assert player.path.c.planned >= after - 1
    played = player.finish()
    player.engine.close()
    assert len(played.motions) == 2
    assert played.positions == ends[-1] and played.drained == 0
    if command == "stop":
        assert [len(clocks) for clocks in played.clocks] == [
            int(np.abs(np.diff([0, *(end[axis] for end in ends)])).sum()) for axis in range(3)
        ]


def test_a_position_off_the_path_is_not_taken_for_a_stop() -> None:
    """Nothing changes then."""
    path = Path(MACHINE, Parameters(), 8)
    path.add((10, 0, 0), 50)
    path.add((10, 10, 0), 50)
    feed = path.c.planned, path.c.sent, path.c.added
    positions = ffi().new("int32_t[8]", [400, 100, 0])
    assert not planner().passo_path_recover(path.c, positions, 0)
    assert feed == (path.c.planned, path.c.sent, path.c.added)


# ------------------------------------------------------------------------------------------- refusals


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"axes": (PathAxis(steps_per_mm=0),)}, "NO_SCALE"),
        ({"axes": (PathAxis(speed=0),)}, "NO_AXIS_SPEED"),
        ({"axes": (PathAxis(acceleration=0),)}, "NO_AXIS_ACCELERATION"),
        ({"axes": (PathAxis(steps_per_mm=200_000, speed=200),)}, "TOO_FAST"),
        ({"axes": ()}, "BAD_AXES"),
        ({"clock_hz": 0}, "BAD_CLOCK"),
        ({"profile": "count"}, "BAD_PROFILE"),
        ({"profile": "jerk"}, "NO_JERK"),
    ],
)
def test_settings_are_checked(change: dict[str, Any], name: str) -> None:
    """Each error has its name."""
    with pytest.raises(PlanError, match=name):
        Path(replace(MACHINE, **change), Parameters())


def test_lines_are_checked() -> None:
    """A refused line leaves the path as it was; a line of no length is none."""
    path = Path(MACHINE, Parameters(), 4)
    for target, feed, name in (
        ((1, 0, 0), 0, "NO_FEED"),
        ((2**30, 0, 0), 10, "TOO_FAR"),
        ((1e6, 0, 0), 10, "TOO_LONG"),
    ):
        with pytest.raises(PlanError, match=name):
            path.add(target, feed)
    path.add((0, 0, 0), 10)
    path.add((1e-9, 0, 0), 10)
    assert path.is_empty
    for x in range(1, 5):
        path.add((x, 0, 0), 10)
    with pytest.raises(PlanError, match="PATH_FULL"):
        path.add((5, 0, 0), 10)
    with pytest.raises(PlanError, match="PATH_FULL"):
        Path(MACHINE, Parameters(), 3)
