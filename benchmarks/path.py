# SPDX-License-Identifier: MIT
"""`make path`: the path planner against the fastest motion possible, its pulses against its limits.

    python -m benchmarks.path [PATHS]

Writes build/path.json. PATHS adversarial paths, 10,000 unless given, take most of the time;
with all of them it also writes docs/reference/paths.md.
"""

import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from passo.axis_judge import Marks, shares
from passo.console import console, each, table
from passo.ending import ended
from passo.output import check_results, write_json
from passo.path import LOOK_AHEAD, PathAxis, PathSettings
from passo.path_rounding import Line
from passo.toolchain import paths

from benchmarks import path_adversary, path_cases, path_page
from benchmarks.path_firmware import measure
from benchmarks.path_plan import plan
from benchmarks.path_reference import seconds
from tests.helpers.path_judge import judge
from tests.helpers.path_player import play

SETTINGS = PathSettings((PathAxis(), PathAxis(), PathAxis(400, 12, 100)))
ALONG = replace(SETTINGS, acceleration=1000)  # as published figures have it
UNLIMITED_AIM, LOOK_AHEAD_AIM, CIRCLE_AIM = 1.02, 1.05, 1.37
FIRMWARE_LINES = 1000  # of a path are planned on the microcontroller
SOFT_LINES = 150  # with each profile
WANDERINGS = 200
PLAYED = 10  # of the random polylines are played
PROFILES = ("linear", "cosine", "sigmoid", "jerk")
# of the comparison of profiles: small steps, so that their times show the jerk
SOFT = replace(
    SETTINGS,
    axes=(PathAxis(1600, jerk=50_000), PathAxis(1600, jerk=50_000), PathAxis(1600, 12, 100, jerk=5000)),
)

CASES: dict[str, Callable[[], list[Line]]] = {
    "circle": path_cases.circle,
    "square": path_cases.square,
    "star": path_cases.star,
    "spiral": path_cases.spiral,
    "text": path_cases.text,
    "trochoid": path_cases.trochoid,
}


SOFT_CASES: dict[str, Callable[[], list[Line]]] = {
    "circle": path_cases.circle,
    "square": path_cases.square,
    "star": path_cases.star,
    "spiral": lambda: path_cases.spiral(1500),
    "text": lambda: path_cases.text("PASSO"),
    "trochoid": lambda: path_cases.trochoid(4),
}


@dataclass
class Result:
    """Of one path; ratios are of the fastest motion possible."""

    name: str
    lines: int
    seconds: float  # with LOOK_AHEAD lines
    unlimited: float
    look_ahead: float
    ramps: int
    speed: float = 0.0  # highest share of its limit of any axis, from the pulses
    acceleration: float = 0.0
    corner: float = 0.0
    instructions: int = 0  # per line, on the STM32F103

    @property
    def met(self) -> bool:
        """Whether the aims are met."""
        return self.unlimited <= UNLIMITED_AIM and self.look_ahead <= LOOK_AHEAD_AIM


def times(name: str, lines: Sequence[Line], settings: PathSettings = SETTINGS) -> Result:
    """Plan a path with both look-aheads."""
    fastest = seconds(lines, settings)
    unlimited = plan(lines, settings, len(lines) + 4)
    limited = plan(lines, settings, LOOK_AHEAD)
    ratios = (unlimited.seconds / fastest, limited.seconds / fastest)
    return Result(name, len(lines), limited.seconds, *ratios, len(limited.ramps))


def watch(result: Result, lines: Sequence[Line]) -> None:
    """Play a path with a short look-ahead, and judge its pulses; raises AssertionError."""
    unmerged = replace(SETTINGS, tolerance=0)  # each line has a place on the path
    verdict = judge(lines, unmerged, play(lines, unmerged))
    assert not verdict.problems, (result.name, verdict.problems)
    result.corner = max(result.corner, verdict.corner)
    played = play(lines, SETTINGS)
    marks = Marks.of(lines, SETTINGS, played.clocks, played.steps)
    for share in shares(played.clocks, played.steps, SETTINGS, marks):
        setattr(result, share.name, max(getattr(result, share.name), share.share))


def count(result: Result, lines: Sequence[Line]) -> None:
    """Plan the beginning of a path on the emulated microcontroller."""
    cost = measure(lines[:FIRMWARE_LINES], SETTINGS)
    assert cost.same, f"{result.name}: the microcontroller plans something else"
    result.instructions = cost.per_line


def wanderings() -> Result:
    """The worst of many random polylines; the time is that of all."""
    worst = Result(f"{WANDERINGS} polylines", 0, 0.0, 0.0, 0.0, 0)
    for number, lines in each("random polylines", list(enumerate(path_cases.wanderings(WANDERINGS)))):
        result = times("", lines)
        worst.lines += result.lines
        worst.seconds += result.seconds
        worst.ramps += result.ramps
        worst.unlimited = max(worst.unlimited, result.unlimited)
        worst.look_ahead = max(worst.look_ahead, result.look_ahead)
        if number < PLAYED:
            watch(worst, lines)
    return worst


@dataclass
class Soft:
    """A path with one of the profiles."""

    name: str
    profile: str
    time: float  # as a ratio of linear ramps, with unlimited look-ahead
    look_ahead: float  # the same with LOOK_AHEAD lines
    peak_jerk: float  # mm/s^3 along the path, over 8 ms, from the pulses
    instructions: int  # per line, on the STM32F103


def shapes() -> list[Soft]:
    """Time and jerk of all profiles."""
    found = []
    for name, case in each("profiles", SOFT_CASES.items()):
        lines = case()
        linear = [plan(lines, SOFT, n).seconds for n in (len(lines) + 4, LOOK_AHEAD)]
        for profile in PROFILES:
            settings = replace(SOFT, profile=profile)
            times = [plan(lines, settings, n).seconds for n in (len(lines) + 4, LOOK_AHEAD)]
            verdict = judge(lines, settings, play(lines, settings))
            assert not verdict.problems, (name, profile, verdict.problems)
            cost = measure(lines[:SOFT_LINES], settings)
            assert cost.same, f"{name}, {profile}: the microcontroller plans something else"
            ratios = (times[0] / linear[0], times[1] / linear[1])
            found.append(Soft(name, profile, *ratios, verdict.peak_jerk, cost.per_line))
    return found


def main(paths_wanted: int = path_adversary.PATHS) -> None:
    """Measure, print and write the report."""
    whole = paths_wanted >= path_adversary.PATHS
    check_results(path_page.REPORT, *[path_page.PAGE] * whole)
    results = []
    for name, case in each("paths", CASES.items()):
        console.print(f"{name[0].upper()}{name[1:]} ...")
        lines = case()
        result = times(name, lines)
        watch(result, lines)
        count(result, lines)
        results.append(result)
    results.append(wanderings())
    console.print("Profiles ...")
    shaped = shapes()
    circle = plan(path_cases.circle(), ALONG, LOOK_AHEAD).seconds
    show(results, shaped, circle)
    adversarial = path_adversary.adversaries(paths_wanted)
    path_adversary.show(adversarial)
    path_adversary.show_open()
    report: dict[str, Any] = {
        "paths": [asdict(result) for result in results],
        "profiles": [asdict(soft) for soft in shaped],
        "circle_seconds": circle,
        "adversarial": path_adversary.figures(adversarial),
        "met": all(result.met for result in results) and circle <= CIRCLE_AIM and not adversarial.beyond,
    }
    write_json(report, path_page.REPORT)
    console.print(f"Report: {path_page.REPORT.relative_to(paths.root)}")
    if whole:
        path_page.write(report)
    if not report["met"]:
        raise SystemExit("a goal is missed")


def show(results: Sequence[Result], shaped: Sequence[Soft], circle: float) -> None:
    """Print the tables."""
    shown = table(
        f"Time as a ratio of the fastest motion possible (aims: {UNLIMITED_AIM}, {LOOK_AHEAD_AIM})",
        *("path", "lines", "seconds", "unlimited", f"{LOOK_AHEAD} lines", "ramps"),
    )
    limits = table(
        "Highest share of each limit, from the pulses; instructions per line, STM32F103",
        *("path", "speed", "acceleration", "corners", "instructions"),
    )
    for r in results:
        ratios = (f"{r.unlimited:.4f}", f"{r.look_ahead:.4f}")
        shown.add_row(r.name, f"{r.lines:,}", f"{r.seconds:.3f}", *ratios, f"{r.ramps:,}")
        shares = (f"{r.speed:.4f}", f"{r.acceleration:.4f}", f"{r.corner:.4f}")
        limits.add_row(r.name, *shares, f"{r.instructions:,}" if r.instructions else "")
    gentle = table(
        "Profiles: time as a ratio of linear ramps; peak jerk along the path, from the pulses; limit 50,000",
        *("path", "profile", "unlimited", f"{LOOK_AHEAD} lines", "mm/s^3", "instructions"),
    )
    for s in shaped:
        ratios = (f"{s.time:.4f}", f"{s.look_ahead:.4f}")
        gentle.add_row(s.name, s.profile, *ratios, f"{s.peak_jerk:,.0f}", f"{s.instructions:,}")
    for one in (shown, limits, gentle):
        console.print(one)
    console.print(f"The circle with 1000 mm/s^2 along the path: {circle:.4f} s (aim: {CIRCLE_AIM} s)")


if __name__ == "__main__":
    sys.exit(ended(lambda: main(*map(int, sys.argv[1:]))))
