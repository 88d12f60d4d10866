# SPDX-License-Identifier: MIT
"""Measures a path: its time against the fastest motion, and its pins against the limits of the axes."""

from dataclasses import dataclass, field, replace
from itertools import product
from math import inf

import numpy as np
from passo.axis_judge import Marks, Share, shares
from passo.driver import DriverError
from passo.path import LOOK_AHEAD, PathSettings
from passo.path_rounding import SHARE, Line
from passo.plan import PlanError

from benchmarks.path_paths import Case, lengths_of
from benchmarks.path_plan import Planned, plan
from benchmarks.path_reference import fastest
from benchmarks.path_reference_jerk import soft_seconds
from tests.helpers.path_player import Played, Player

UNLIMITED_AIM, LOOK_AHEAD_AIM = 1.02, 1.05
FAST_POLLS = 1_000_000  # per second, of a host that can send any path: the fastest motion knows of no host
PACED_AIM = 2.0  # what the polls of the case cost of the time, beyond the time that each line takes to send
SOFT_AIM = 1.6  # cosine ramps, and half of the jerk in curves
SHAPED_AIM = 2.1  # a ramp over several lines has the slope of the weakest axis, doubled as often as possible
OFF_BOUND = 1.0
CHUNK = 1_000_000  # places times lines, together
LOOKS = 4000  # steps of a path whose places are checked
KINDS = ("underrun", "fault", "slow", "slow48", "paced", "speed", "acceleration", "jerk", "off")
SHORTEST = 0.03  # s: in less, ticks count
LONGEST = 4.0  # s: what takes longer is not played


@dataclass
class Measured:
    """Of one case. Ratios are of the fastest motion; 0: not measured."""

    lines: int = 0
    optimum: float = 0.0
    unlimited: float = 0.0
    look_ahead: float = 0.0
    shaped: float = 0.0  # all lines known, of another profile than linear: the reference is a bound
    soft: float = 0.0  # the same of profile jerk, against a fast motion with that
    paced: float = 0.0  # with the polls of the case, of the time with FAST_POLLS
    shares: list[Share] = field(default_factory=list)
    off: float = 0.0  # farthest place from the path and what merging permits, 1: a step of each motor
    fault: str = ""  # the core stopped, or the end is not exact

    def share(self, name: str) -> float:
        """The greatest of all axes."""
        return max((share.share for share in self.shares if share.name == name), default=0.0)

    @property
    def faults(self) -> dict[str, str]:
        """What is beyond its bound, by kind."""
        found = {}
        if self.fault:
            found["underrun" if "UNDERRUN" in self.fault else "fault"] = self.fault
        if self.unlimited > UNLIMITED_AIM:
            found["slow"] = f"{self.unlimited:.4f} times the optimum, all lines known"
        if self.look_ahead > LOOK_AHEAD_AIM:
            found["slow48"] = f"{self.look_ahead:.4f} times the optimum, {LOOK_AHEAD} lines"
        if self.shaped > SHAPED_AIM:
            found["slow"] = f"{self.shaped:.4f} times the optimum with a shape, all lines known"
        if self.soft > SOFT_AIM:
            found["slow"] = f"{self.soft:.4f} times a fast motion with this jerk, all lines known"
        if self.paced > PACED_AIM:
            found["paced"] = f"{self.paced:.4f} times as long as without a host"
        if self.off > OFF_BOUND:
            found["off"] = f"{self.off:.3f} steps of all motors off the path"
        for share in sorted(self.shares, key=lambda share: share.share):
            if share.share > share.bound:
                found[share.name] = str(share)
        return found


def compare(case: Case) -> Measured:
    """Against the fastest motion; a short path is all ticks."""
    lines, settings = case.lines, case.settings
    motion = fastest(lines, settings)
    measured = Measured(len(lines), motion.seconds)
    if measured.optimum < SHORTEST:
        return measured
    try:
        _ratios(measured, lines, settings, motion.fits(LOOK_AHEAD))
    except PlanError as error:
        measured.fault = str(error)
    return measured


def _ratios(measured: Measured, lines: list[Line], settings: PathSettings, fits: bool) -> None:
    known = max(len(lines) + 4, LOOK_AHEAD)  # with fewer places the pace allows fewer ramps
    paced = plan(lines, settings, known)
    line_seconds = paced.path.c.line_clocks / settings.clock_hz
    settings = replace(settings, polls=FAST_POLLS)
    planned = plan(lines, settings, known)
    seconds = planned.seconds
    slowest = min((feed for _, feed in lines if feed is not None), default=inf)
    rounding = 1 / planned.path.substeps_per_mm / slowest  # lines are whole substeps
    ratio, measured.paced = (seconds - rounding) / measured.optimum, paced.seconds / seconds
    if measured.paced > PACED_AIM:
        sent = fastest(sendable(sent_lines(lines, paced), line_seconds), settings).seconds
        measured.paced = paced.seconds / max(seconds, sent)
    if settings.profile == "linear":
        measured.unlimited = ratio
        if fits:
            limited = plan(lines, settings, LOOK_AHEAD).seconds
            measured.look_ahead = (limited - rounding) / measured.optimum
    elif settings.profile == "jerk":
        measured.soft = ratio * measured.optimum / soft_seconds(lines, settings)
    else:
        measured.shaped = ratio


def sent_lines(lines: list[Line], planned: Planned) -> list[Line]:
    """Those that are sent, of which each may be several that were merged: at the lowest of their feeds."""
    ends = np.cumsum(lengths_of(lines))
    places = np.cumsum([line.substeps for line in planned.lines]) / planned.path.substeps_per_mm
    last = np.abs(ends[:, None] - places).argmin(axis=0)
    found: list[Line] = []
    for i, end in enumerate(last):
        feeds = [feed for _, feed in lines[(last[i - 1] + 1 if i else 0) : end + 1] if feed is not None]
        found.append((lines[end][0], min(feeds, default=None)))
    return found


def sendable(lines: list[Line], seconds: float) -> list[Line]:
    """The same lines at feeds with which each of them takes so long, at least."""
    return [
        (target, min(feed or inf, length / seconds))
        for length, (target, feed) in zip(lengths_of(lines), lines, strict=True)
    ]


def play(case: Case, measured: Measured) -> None:
    """Through driver and link on the C model, judged at the pins."""
    lines, settings = case.lines, case.settings
    player = Player(settings, case.look_ahead, settings.clock_hz // case.polls)
    try:
        for target, feed in lines:
            player.add(target, feed)
        played = player.finish()
    except DriverError:
        measured.fault = f"{player.driver.cause.name} at {player.engine.clock / settings.clock_hz:.3f} s"
        return
    finally:
        player.engine.close()
    if played.drained:
        measured.fault = f"{played.drained} substeps were drained"
    marks = Marks.of(lines, settings, played.clocks, played.steps)
    measured.shares = shares(played.clocks, played.steps, settings, marks)
    measured.off = off_path(lines, settings, played)


def off_path(lines: list[Line], settings: PathSettings, played: Played) -> float:
    """How far the axes are off the path at the steps of their motors; 1: what a step of each is worth."""
    times = np.unique(np.concatenate(played.clocks))
    times = times[:: len(times) // LOOKS + 1]
    made = [
        np.append(0, steps)[np.searchsorted(clocks, times, "right")] / scale
        for clocks, steps, scale in zip(played.clocks, played.steps, settings.scales, strict=True)
    ]
    places = settings.motors.axes_of(np.stack(made, axis=1))
    begin = np.array([[0.0] * len(settings.axes), *(list(target) for target, _ in lines[:-1])])
    way = np.array([list(target) for target, _ in lines]) - begin
    square = np.maximum((way**2).sum(axis=1), 1e-18)
    farthest = 0.0
    for some in np.array_split(places, max(1, len(places) * len(lines) // CHUNK)):
        gone = some[:, None] - begin
        share = np.clip((gone * way).sum(axis=2) / square, 0, 1)
        least = np.linalg.norm(gone - share[..., None] * way, axis=2).min(axis=1)
        farthest = max(farthest, float(least.max(initial=0)))
    return max(0.0, farthest - float(settings.junction_deviation) * SHARE) / worth_of_a_step(settings)


def worth_of_a_step(settings: PathSettings) -> float:
    """How far the machine is off, in mm, where each motor is off by a step: at most."""
    rows = settings.motors.map(len(settings.axes))
    _, first, own = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    signs = np.array(list(product((-1, 1), repeat=len(first))))[:, own.ravel()]
    return float(np.linalg.norm(settings.motors.axes_of(signs / settings.scales), axis=1).max())


def measure(case: Case) -> Measured:
    """Both."""
    measured = compare(case)
    if measured.optimum <= LONGEST:
        play(case, measured)
    return measured
