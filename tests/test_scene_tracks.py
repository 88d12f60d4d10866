# SPDX-License-Identifier: MIT
"""Targets of trackers in move files, judged at the pins by closed forms."""

import json
import math
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from passo import cli
from passo import registers as r
from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.engine import model_engine
from passo.form_table import Place
from passo.host import Channel, PinTiming
from passo.link import Link
from passo.move_file import read_channels
from passo.move_forms import MachineTrack
from passo.moves import MoveFileError
from passo.registers import Cause
from passo.rig import most
from passo.run import open_engine
from passo.scene import Scene
from passo.scene_driver import track_of
from passo.scene_plan import scene_parameters
from passo.scene_report import summarize_scene
from passo.scene_run import SceneRun
from passo.setup_tracks import tick_of
from passo.toolchain import paths

from tests.helpers.scenes import CLOCK_HZ, MOVE, event, machine, play, write

TICK = 128  # clocks, of a core of up to 4 axes
SPEED, ACCELERATION = 5000, 200_000  # of trackers
LIMITS = f"speed = {SPEED}\nacceleration = {ACCELERATION}\n"
FRAMES = 8000  # clocks of the frames of a target, and those in progress
# Three axes, of which the last one has no path.
PATH = MOVE.replace("[2000, -1000]", "[2000, -1000, 0]") + MOVE.replace("[2000, -1000]", "[-2000, 1000, 0]")


def track(text: str, limits: str = LIMITS) -> str:
    return f"[[track]]\n{limits}{text}\n"


def least_clocks(steps: int) -> float:
    """Of a motion from rest to rest within the limits of the tracker."""
    if steps < SPEED**2 / ACCELERATION:
        return 2 * math.sqrt(steps / ACCELERATION) * CLOCK_HZ
    return (steps / SPEED + SPEED / ACCELERATION) * CLOCK_HZ


@pytest.mark.parametrize(("engine", "tracked"), [("model", 0), ("both", 0), ("both", 1)])
def test_a_motor_beside_the_path(tmp_path: Path, engine: str, tracked: int) -> None:
    """It lands on each target in the least time; the path does not know of it, nor has lines of it."""
    tracks = track("axis = 2\ntarget = 200\nposition = 300") + track("axis = 2\ntarget = -40\ntime = 0.3", "")
    run = play(tmp_path, machine(f"tracked = {tracked}") + tracks + PATH, engine)
    assert run.problems() == [] and run.machine == [0, 0, -40]
    clocks, directions = run.steps(2)
    assert directions.tolist() == [1] * 200 + [-1] * 240
    for own, sent in ((clocks[:200], run.events[0]), (clocks[200:], run.events[1])):
        assert sent.clock and sent.answered
        length = int(own[-1] - own[0])
        assert least_clocks(len(own)) * 0.9 < length <= least_clocks(len(own)) + 3 * TICK
        gaps = np.diff(own)
        assert gaps.min() >= CLOCK_HZ / SPEED - TICK
        assert sent.clock - run.start < own[0] < sent.answered - run.start + least_clocks(2)
    alone = play(tmp_path, machine() + PATH)
    for axis in (0, 1):
        assert np.array_equal(run.steps(axis)[0], alone.steps(axis)[0])
    summary = summarize_scene(run, engine)
    assert summary["outcome"] == "complete" and summary["events"] == []
    assert [(one["number"], one["target"]) for one in summary["tracks"]] == [(1, 200), (2, -40)]
    assert summary["trackers"] == [{"axis": 2, "position": -40, "at_target": True}]
    assert summary["moves"][0]["steps_asked"] == 6000


def test_both_hands_of_an_axis(tmp_path: Path) -> None:
    """It is at the sum, in millimeters as in steps."""
    tracks = track('target = "1.5mm"\ntime = "50ms"')
    run = play(tmp_path, machine("steps_per_mm = 80") + tracks + MOVE)
    assert run.problems() == []
    assert run.machine == [2120, -1000] and run.positions == [2000, -1000]
    assert summarize_scene(run, "model")["outcome"] == "complete"


def test_backlash_from_the_beginning(tmp_path: Path) -> None:
    """The way down is 25 steps lower, from the first steps after the turn on."""
    run = play(tmp_path, track("backlash = 25") + PATH)
    assert run.problems() == [] and run.events == []
    clocks, directions = run.steps(0)
    places = np.cumsum(directions, dtype=np.int64)
    assert places.max() == 2000 and places[-1] == -25
    assert run.positions == [0, 0, 0]
    turned = clocks[np.argmax(directions < 0)]
    taken = clocks[np.argmax(places == 1975)]
    assert taken - turned <= least_clocks(25) + 3 * TICK


def test_untrack_and_a_later_target(tmp_path: Path) -> None:
    """The tracker slows down, rests, and continues."""
    tracks = track("axis = 2\ntarget = 600\ntime = 0") + track("axis = 2\ntarget = 700\ntime = 0.2", "")
    run = play(tmp_path, tracks + event('do = "untrack"\naxis = 2\ntime = "60ms"') + PATH)
    assert run.problems() == [] and run.machine[2] == 700
    clocks, _ = run.steps(2)
    rest = int(np.argmax(np.diff(clocks)))
    slowing = SPEED / ACCELERATION * CLOCK_HZ
    assert 60_000 < clocks[rest] < 60_000 + slowing + FRAMES
    assert 200_000 < clocks[rest + 1] < 200_000 + FRAMES


def test_a_tracker_arrives_after_the_path(tmp_path: Path) -> None:
    """The run waits for it."""
    run = play(tmp_path, track("axis = 1\ntarget = -4000\ntime = 0.2") + MOVE)
    assert run.problems() == [] and run.machine == [2000, -5000]
    assert run.shown_clocks > run.total_clocks


def test_a_stop_ends_both_hands(tmp_path: Path) -> None:
    run = play(tmp_path, track("axis = 1\ntarget = 4000\ntime = 0") + event('do = "stop"\ntime = 0.1') + MOVE)
    assert [stop.cause for stop in run.stops] == [Cause.STOP] and run.problems() == []
    assert run.trackers[0].position < 4000 and not run.trackers[0].enabled
    assert summarize_scene(run, "model")["outcome"] == "stopped"


def test_backlash_is_taken_up_after_a_home(tmp_path: Path) -> None:
    """Its stops end the trackers; each goes to its target again."""
    home = '[[move]]\nmethod = "home"\nsteps = [-900, 0]\nspeed = 5000\nslow_speed = 500\n'
    home += "acceleration = 200_000\nback_off = 40\n"
    text = machine("start = [300, 0]", 'role = "home"\naxis = 0\nat = 0') + track("backlash = 25") + home
    run = play(tmp_path, text + MOVE + MOVE.replace("[2000, -1000]", "[-1500, 1000]"))
    assert run.problems() == [] and run.trackers[0].enabled and run.trackers[0].at_target
    first = run.sections[1].begin - run.start
    clocks, directions = run.steps(0)
    own = clocks >= first
    places = np.cumsum(directions[own], dtype=np.int64)
    assert run.trackers[0].position == -25 and places.max() - places[-1] == 1525


def test_what_the_pins_cannot_make_is_a_problem(tmp_path: Path) -> None:
    """The path fills 90 % of what they can, so the steps of the tracker do not fit."""
    pins = '[pins]\nstep_high = "45us"\nstep_low = "45us"\n'
    run = play(tmp_path, pins + track("target = 900\ntime = 0.05") + MOVE)
    assert run.stops[-1].cause == Cause.STEP_OVERRUN
    assert "the core stopped: STEP_OVERRUN" in run.problems()


def test_a_tracker_that_does_not_arrive_is_a_problem(tmp_path: Path) -> None:
    run = play(tmp_path, track("axis = 1\ntarget = 30\ntime = 0.1") + MOVE)
    assert run.problems() == []
    run.trackers[0].at_target, run.trackers[0].position = False, 29
    assert run.problems() == [
        "axis 1: its tracker is at 29, not at 30",
        "axis 1 is at -970, not at the -1000 of its path and the 29 of its tracker",
    ]
    run = play(tmp_path, track("axis = 1\ntarget = 30\ntime = 9") + MOVE)
    assert run.problems() == ["track 1: it never occurred"]


def feeder() -> SceneRun:
    file = read_channels(paths.examples / "feeder.toml")
    with open_engine("model", scene_parameters(file), file.clock_hz) as core:
        return Scene(file, core).run()


def test_the_feeder(tmp_path: Path) -> None:
    """The example: two parts further, while the head is on its way."""
    run = feeder()
    assert run.problems() == [] and run.machine == [-8, 0, 320]
    clocks, _ = run.steps(2)
    path = run.steps(1)[0]
    for own in (clocks[:160], clocks[160:]):
        assert ((path > own[0]) & (path < own[-1])).sum() > 250
    out = tmp_path / "out"
    file = str(paths.examples / "feeder.toml")
    arguments = ["run", file, "--engine", "model", "--out", str(out), "--plot", "--report"]
    assert cli.main(arguments) == 0
    assert (out / "motion.png").read_bytes().startswith(b"\x89PNG")
    assert "track 2: axis 2 to 160" in (out / "report.html").read_text()
    assert json.loads((out / "summary.json").read_text())["ok"]
    rows = (out / "pulses.csv").read_text().splitlines()
    assert sum(row.split(",")[1] == "2" for row in rows) == 320


@pytest.mark.parametrize("axes", [3, 4, 8])
def test_the_limits_are_those_of_the_driver(tmp_path: Path, axes: int) -> None:
    """The file is refused where the driver refuses, to one part in 2^32."""
    rate = CLOCK_HZ / tick_of(axes)
    move = MOVE.replace("[2000, -1000]", str([100] * axes))
    with model_engine(Parameters(axes=axes, trackers=1), CLOCK_HZ) as engine:
        driver = Driver(engine)
        for speed, acceleration, taken in (
            (rate * (1 - 1e-9), 1000, True),
            (rate, 1000, False),
            (rate / 2, rate**2 / 2 * (1 - 1e-9), True),
            (rate / 2, rate**2 / 2 * (1 + 1e-9), False),
            (rate / 2, rate**2 / 2**32 * 1.01, True),
            (rate / 2, rate**2 / 2**32 * 0.99, False),
        ):
            limits = f"speed = {speed:.12f}\nacceleration = {acceleration:.12f}\n"
            file = write(tmp_path, track("", limits) + move)
            if taken:
                setup = read_channels(file).setup
                assert setup
                driver.call("configure_tracker", track_of(setup.trackers[0]))
                continue
            with pytest.raises(MoveFileError, match=r"track 1: (speed|acceleration) must be"):
                read_channels(file)
            own = track_of(_unchecked(speed, acceleration))
            with pytest.raises(DriverError, match="TRACKER_LIMITS"):
                driver.call("configure_tracker", own)


def _unchecked(speed: float, acceleration: float) -> MachineTrack:
    zero = Place(Fraction(0))
    when = (None, None, None, False, 0)
    return MachineTrack(*when, 0, zero, Fraction(speed), Fraction(acceleration), zero)


AT = "time = 0.1\n"
BAD = [
    (track(AT + "target = 2_147_483_648"), "track 1: target must be -2147483647 to 2147483647"),
    (
        machine("steps_per_mm = 1000") + track(AT + 'target = "2147484mm"'),
        "track 1: target is 2147484000 steps; must be -2147483647 to 2147483647",
    ),
    (track(AT + 'target = "1mm"'), "track 1: target in mm needs steps_per_mm in"),
    (track(AT + "target = 1.5"), "track 1: target must be a whole number, not 1.5"),
    (
        track(AT, "speed = 7813\nacceleration = 1000\n"),
        "track 1: speed must be less than 7812.5 steps/s, a step per 128 clocks",
    ),
    (track(AT, "speed = 0\nacceleration = 1000\n"), "track 1: speed must be greater than 0"),
    (track(AT, "speed = 100\nacceleration = 0\n"), "track 1: acceleration must be greater than 0"),
    (track(AT, "speed = 100\nacceleration = 0.001\n"), "track 1: acceleration must be at least 0.0142"),
    (track(AT, "speed = 100\nacceleration = 1_000_000\n"), "track 1: acceleration must be at most 781250"),
    (track(AT, "speed = 100\n"), "track 1: acceleration is missing"),
    (track(AT, "acceleration = 100\n"), "track 1: speed is missing"),
    (track(AT + "axis = 2"), "track 1: axis must be 0 to 1: the moves have no other drives"),
    (track("target = 5"), "track 1: target needs time, position or trigger"),
    (track(AT) + track("", ""), "track 2: time, position or trigger is missing"),
    (track(AT + "position = 5"), "track 1: time and position are mutually exclusive"),
    (track('trigger = "home"'), "track 1: home of axis 0 is not connected"),
    (track("at_axis = 1"), "track 1: time, position or trigger is missing"),
    (track("falling = true"), "track 1: time, position or trigger is missing"),
    (track(AT + "backlash = -1"), "track 1: backlash is -1 steps; must be 0 to 65535"),
    (track(AT + "backlash = 65_536"), "track 1: backlash is 65536 steps; must be 0 to 65535"),
    (
        track("backlash = 5") + track(AT + "backlash = 6", ""),
        "track 2: backlash is another one than in track 1, and changes only at rest",
    ),
    (track("") + track(AT + "speed = 4999", ""), "track 2: speed is another one than in track 1"),
    (track("") + track(AT + "acceleration = 9", ""), "track 2: acceleration is another one than in track 1"),
    (track(AT + "targte = 5"), "track 1: unknown key 'targte'; did you mean target"),
    (machine("tracked = 2"), "machine: tracked must be 0 to 1: lines move an axis at least"),
    (machine("tracked = 1"), "move 1: steps of axis 1 must be 0: it has no lines, as tracked says"),
    ("track = 3\n", "track must be an array of tables"),
    (track("") + event(AT + 'do = "untrack"\naxis = 1'), r"event 1: axis 1 has no target: \[\[track"),
    (event(AT + 'do = "track"'), "event 1: do must be one of .*, not 'track'"),
    (
        track("") + track(AT, "") * (most("event") + 1),
        "there are 65 events and targets of trackers; must be at most 64",
    ),
    (track("") + MOVE + "channel = 1\n", r"\[\[track\]\], .* are for files of channel 0 only"),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_bad_input(tmp_path: Path, text: str, message: str) -> None:
    """One line, with the table and the key."""
    with pytest.raises(MoveFileError, match=message) as raised:
        read_channels(write(tmp_path, text if MOVE in text else text + MOVE))
    assert "\n" not in str(raised.value)


def test_a_position_that_was_read_is_not_in_the_status_of_the_next_frame() -> None:
    """The address stands on the position of the next axis, which is not 0."""
    parameters = Parameters(axes=3, inputs=1, encoders=1, outputs=1, trackers=1)
    with open_engine("both", parameters, CLOCK_HZ) as engine:
        channel = Channel(Link(engine), parameters)
        link, base = channel.link, channel.base
        for axis in range(3):
            channel.configure_axis(axis, PinTiming(2, 2, 2, 2))
            link.write(channel.axis_base(axis) + r.AXIS_TRACKER_SPEED, 1 << 30, 1 << 28)
            link.write(base + r.CHANNEL_TRACKER_TARGET_BASE + axis, -5 - axis & 0xFFFFFFFF)
        link.write(base + r.CHANNEL_TRACKER_ENABLE, 7)
        engine.run(50_000)
        for axis in range(3):
            (position,) = link.read(base + r.CHANNEL_TRACKER_POSITION_BASE + axis, 1)
            assert position == 0xFFFFFFFB - axis
            engine.run(300)
            assert channel.state().quiet
