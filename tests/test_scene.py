# SPDX-License-Identifier: MIT
"""Move files with a machine and events: `passo run`, judged by closed forms."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo import cli
from passo.engine import NUMBERS
from passo.move_file import read_channels
from passo.moves import MoveFileError
from passo.registers import Cause
from passo.rig import most
from passo.run import RunError, open_engine
from passo.scene import Scene
from passo.scene_plan import scene_parameters
from passo.scene_report import measured_curve, summarize_scene
from passo.scene_run import SceneRun
from passo.toolchain import paths

from tests.helpers.scenes import CLOCK_HZ, MOVE, SPEED, event, machine, play, write

HARD = 4  # clocks from the level to the last edge of STEP that may begin


def level_clock(run: SceneRun, pin: str, number: int = -1) -> int:
    """Clock since the start after which an input has changed."""
    own = run.inputs[run.inputs["input"] == NUMBERS[pin]]
    return int(own["clock"][number]) - run.start


def last_edge(run: SceneRun) -> int:
    return max(int(run.steps(axis)[0][-1]) for axis in range(run.file.axes))


# ----------------------------------------------------------------------------------------------- events ----


@pytest.mark.parametrize("position", [1, 777, 1500])
def test_an_event_at_a_position(tmp_path: Path, position: int) -> None:
    """It comes on the clock of the step that arrives there; a hold makes the same pulses, later."""
    events = event(f'do = "hold"\nposition = {position}') + event('do = "resume"\ntime = 0.4')
    run = play(tmp_path, MOVE + events)
    assert run.problems() == []
    clocks, directions = run.steps(0)
    assert run.events[0].clock == clocks[position - 1] + run.start
    assert run.events[0].positions[0] == np.cumsum(directions)[position - 1] == position
    assert run.events[1].clock == run.start + 400_000
    assert run.machine == run.positions == [2000, -1000]
    made = int((clocks < 400_000).sum())
    # the rate falls from 1 to 0 in 50 ms: at most half of the way of full speed, and what a frame takes
    assert position <= made <= position + SPEED * (0.05 / 2 + 0.002)
    assert run.stops == []


def test_override(tmp_path: Path) -> None:
    """From the cruise on at half the speed."""
    run = play(
        tmp_path, machine('stop_time = "1ms"') + MOVE + event('do = "override"\ntime = 0.1\npercent = 50')
    )
    assert run.problems() == []
    clocks, _ = run.steps(0)
    gaps = np.diff(clocks[(clocks > 105_000) & (clocks < 150_000)])
    assert abs(gaps.mean() - 2 * CLOCK_HZ / SPEED) < 1


def test_soft_stop(tmp_path: Path) -> None:
    """From the cruise: half of what full speed makes in the time, give or take a frame."""
    run = play(tmp_path, machine('stop_time = "20ms"') + MOVE + event('do = "stop"\ntime = 0.1'))
    (stop,) = run.stops
    assert run.problems() == [] and stop.cause == Cause.STOP
    clocks, _ = run.steps(0)
    assert 0 <= (clocks >= 100_000).sum() - SPEED * 0.02 / 2 <= SPEED * 0.002
    assert stop.positions == run.machine and abs(2 * run.machine[1] + run.machine[0]) <= 2


def test_abort(tmp_path: Path) -> None:
    run = play(tmp_path, MOVE + event('do = "abort"\ntime = 0.1'))
    assert run.problems() == [] and run.stops[0].cause == Cause.ABORT
    assert run.events[0].answered is not None
    assert 100_000 < last_edge(run) <= run.events[0].answered - run.start


@pytest.mark.parametrize("engine", ["model", "both"])
def test_estop(tmp_path: Path, engine: str) -> None:
    """The pin changes on its clock, the drives are off on the next, and nothing is made afterwards."""
    run = play(tmp_path, MOVE + event('do = "estop"\ntime = 0.1'), engine)
    assert run.problems() == [] and [stop.cause for stop in run.stops] == [Cause.ESTOP]
    assert level_clock(run, "estop_n") == 100_000
    off = run.pins["clock"][run.pins["enable"] == 0].astype(np.int64)
    assert int(off[off > run.start][0]) - run.start == 100_001
    assert last_edge(run) <= 100_000 + 2 + HARD
    assert run.stops[0].positions == run.machine


@pytest.mark.parametrize("filter_clocks", [0, 100])
def test_alarm(tmp_path: Path, filter_clocks: int) -> None:
    """A hard stop within the filter and 4 clocks."""
    text = machine(f'filter = "{filter_clocks}clocks"', 'role = "alarm"\naxis = 1')
    run = play(tmp_path, text + MOVE + event('do = "input"\ninput = "alarm"\naxis = 1\ntime = "80ms"'))
    (stop,) = run.stops
    assert (stop.cause, stop.axes) == (Cause.ALARM, [1]) and run.problems() == []
    assert level_clock(run, "alarm") == 80_000
    assert last_edge(run) <= 80_000 + 2 * max(1, filter_clocks) + 2 + HARD
    assert run.machine[0] == len(run.steps(0)[0])


def test_a_glitch_of_an_input_does_nothing(tmp_path: Path) -> None:
    text = machine('filter = "100us"', 'role = "alarm"\npolarity = "low"')
    glitch = event('do = "input"\ninput = "alarm"\ntime = "80ms"\nlength = "100us"')
    run = play(tmp_path, text + MOVE + glitch)
    assert run.problems() == [] and run.stops == [] and run.machine == [2000, -1000]
    assert level_clock(run, "alarm") - level_clock(run, "alarm", -2) == 100


def test_an_event_at_a_trigger(tmp_path: Path) -> None:
    """On the very clock of the edge; events may lead to each other."""
    text = machine("", 'role = "home"', 'role = "alarm"\naxis = 1')
    text += event('do = "input"\ninput = "alarm"\naxis = 1\ntrigger = "home"\nfalling = true')
    text += event('do = "input"\ninput = "home"\ntime = "50ms"\nlength = "10ms"')
    run = play(tmp_path, text + MOVE)
    assert run.problems() == [] and run.stops[0].cause == Cause.ALARM
    assert [happened.clock - run.start for happened in run.events] == [60_000, 50_000]


def test_arm(tmp_path: Path) -> None:
    """The latch has the positions 3 + filter clocks after the edge, and the motion continues."""
    text = machine('filter = "20us"', 'role = "probe"\nat = 900\nside = "above"')
    text += event('do = "arm"\nsource = "probe"\ntime = "10ms"')
    run = play(tmp_path, text + MOVE)
    assert run.problems() == [] and run.machine == [2000, -1000] and run.stops == []
    (latch,) = run.latches
    edge = level_clock(run, "probe")
    assert edge == run.steps(0)[0][899]
    made = [int((run.steps(axis)[0] <= edge + 20 + 4).sum()) for axis in (0, 1)]
    assert latch.positions == [made[0], -made[1]]


def test_an_event_that_does_not_come_is_a_problem(tmp_path: Path) -> None:
    run = play(tmp_path, MOVE + event('do = "hold"\nposition = 2001'))
    assert run.problems() == ["event 1: it never occurred"]


def test_a_hold_without_end(tmp_path: Path) -> None:
    """What is said names the event, also where the resume comes before it, or never."""
    hold, resume = event('do = "hold"\ntime = 0.1'), event('do = "resume"\ntime = 0.05')
    never = event('do = "resume"\nposition = 2001')
    for events, number in ((hold, 1), (resume + hold, 2), (hold + never, 1)):
        with pytest.raises(RunError) as caught:
            play(tmp_path, MOVE + events)
        told = f"move 1 does not end: held by event {number}, and no resume follows"
        assert str(caught.value).endswith(told)


# --------------------------------------------------------------------------------------------- switches ----


@pytest.mark.parametrize("soft", [False, True])
def test_a_limit(tmp_path: Path, soft: bool) -> None:
    """Hard: not a step more than the filter lets pass. Soft: the way of the stop."""
    text = machine(
        'filter = "20us"\nstop_time = "10ms"',
        f'role = "limit_high"\nat = 1000\nside = "above"\nsoft = {str(soft).lower()}',
    )
    run = play(tmp_path, text + MOVE)
    (stop,) = run.stops
    assert (stop.cause, stop.axes) == (Cause.LIMIT, [0]) and run.problems() == []
    most_beyond = SPEED * 0.01 / 2 + 2 if soft else 1 + (2 * 20 + 2 + HARD) * SPEED / CLOCK_HZ
    assert 0 <= stop.positions[0] - 1000 <= most_beyond
    assert run.machine == stop.positions and run.sections[-1].outcome == "LIMIT"


HOME = """
[[move]]
method = "home"
steps = [-900, 0]
speed = 8000
slow_speed = 1000
acceleration = 200_000
back_off = 40
pull_off = 30
edge_position = -7
"""
HOME_SWITCH = 'role = "home"\nat = 100\nhysteresis = 10\nbounce = "200us"\nnoise = 500\nglitch = "10us"'


def test_home(tmp_path: Path) -> None:
    """The position of the edge is as commanded, to the steps made during its filter and chatter."""
    text = machine('filter = "40us"\nstop_time = "4ms"\nstart = [500, 0]', HOME_SWITCH)
    run = play(tmp_path, text + HOME + MOVE)
    assert run.problems() == []
    assert [section.kind for section in run.sections] == ["home", "moves"]
    assert [stop.cause for stop in run.stops] == [Cause.TRIGGER] * 2
    assert all(run.sought(stop) for stop in run.stops)
    offset = run.machine[0] - run.positions[0]
    assert abs(offset - (100 + 7)) <= 1
    assert run.machine[0] == offset - 7 + 30 + 2000


def test_home_of_several_axes(tmp_path: Path) -> None:
    """One line, one after the other, each at its own switch; a stop at the second one ends the task."""
    switches = [f'role = "home"\naxis = {axis}\nat = {at}' for axis, at in ((0, 100), (1, -300))]
    text = machine('filter = "20us"\nstop_time = "4ms"\nstart = [500, 0]', *switches)
    home = HOME.replace("-900, 0", "-900, -700")
    run = play(tmp_path, text + home + MOVE)
    assert run.problems() == [] and [section.kind for section in run.sections] == ["home", "moves"]
    assert [stop.cause for stop in run.stops] == [Cause.TRIGGER] * 4
    offsets = [run.machine[axis] - run.positions[axis] for axis in (0, 1)]
    assert abs(offsets[0] - (100 + 7)) <= 1 and abs(offsets[1] - (-300 + 7)) <= 1
    first, second = run.steps(0)[0], run.steps(1)[0]
    begins = run.sections[1].begin - run.start
    assert first[first < begins].max() < second.min()
    missed = play(tmp_path, text + home.replace("-700", "-200") + MOVE)
    assert missed.problems() == ["move 1: SWITCH_MISSED"] and len(missed.sections) == 1


def test_a_switch_that_is_missed(tmp_path: Path) -> None:
    text = machine('start = [5000, 0]\nfilter = "20us"', 'role = "home"\nat = 100')
    run = play(tmp_path, text + HOME + MOVE)
    assert run.problems() == ["move 1: SWITCH_MISSED"]
    assert run.machine == [4100, 0] and len(run.sections) == 1


def test_estop_in_the_midst_of_home(tmp_path: Path) -> None:
    text = machine('start = [500, 0]\nfilter = "40us"', HOME_SWITCH) + event('do = "estop"\nposition = 300')
    run = play(tmp_path, text + HOME + MOVE)
    assert run.problems() == [] and run.sections[-1].outcome == "ESTOP"
    assert run.machine[0] in (299, 300) and len(run.sections) == 1


def test_probe(tmp_path: Path) -> None:
    """In millimeters; the latch is the touch, to the steps made during the filter."""
    text = machine(
        'filter = "50us"\nstop_time = "5ms"\nsteps_per_mm = 160', 'role = "probe"\naxis = 1\nat = "-5mm"'
    )
    probe = '[[move]]\nmethod = "probe"\nsteps = [0, -1500]\nspeed = 6000\nacceleration = 200_000\n'
    run = play(tmp_path, text + probe)
    (stop,) = run.stops
    assert run.problems() == [] and stop.latch is not None
    assert 0 <= -800 - stop.latch[1] <= 1 + (50 + 4) * 6000 / CLOCK_HZ
    assert 0 <= stop.latch[1] - stop.positions[1] <= 6000 * 0.005 / 2 + 2


# --------------------------------------------------------------------------------------------- encoders ----

ENCODER = "axis = 0\ncounts_per_step = 4"


def test_the_encoder_follows(tmp_path: Path) -> None:
    """Forth and back: what is measured is the commanded curve, to a step and what the filter delays."""
    run = play(tmp_path, machine(encoder=ENCODER) + MOVE + MOVE.replace("2000, -1000", "-2000, 1000"))
    assert run.problems() == [] and run.stops == []
    curve = measured_curve(run, run.setup.encoders[0])
    assert len(curve.errors) > 70
    assert np.abs(curve.errors).max() < 0.5 + 0.25 + 20 * SPEED / CLOCK_HZ
    assert np.abs(curve.made - curve.measured).max() <= 1
    assert 0 < run.greatest[0] <= 1


@pytest.mark.parametrize("stop", ["soft", "hard", "none"])
def test_a_lost_step_is_seen(tmp_path: Path, stop: str) -> None:
    """A limit of 1.5 steps sees one lost step with the next one, and stops as configured."""
    text = machine('stop_time = "4ms"', encoder=ENCODER + f'\nlimit = 1.5\nstop = "{stop}"')
    run = play(tmp_path, text + MOVE + event('do = "slip"\nposition = 1000\ncounts = -4'))
    assert run.problems() == []
    assert 1.5 <= run.greatest[0] <= 2
    if stop == "none":
        assert run.stops == [] and run.machine == [2000, -1000]
        return
    assert run.stops[0].cause == Cause.FOLLOWING_ERROR
    way = SPEED * 0.004 / 2 + 2 if stop == "soft" else 2
    assert 1000 <= run.stops[0].positions[0] <= 1000 + way


# ------------------------------------------------------------------------------------------ the command ----


def test_files_of_the_command(tmp_path: Path) -> None:
    out = tmp_path / "out"
    text = machine('stop_time = "5ms"', 'role = "probe"\nat = 900\nside = "above"', encoder=ENCODER)
    text += event('do = "arm"\nsource = "probe"\ntime = 0') + event('do = "estop"\ntime = 0.15')
    file = write(tmp_path, text + MOVE)
    assert cli.main(["run", str(file), "--engine", "model", "--out", str(out), "--plot"]) == 0
    assert (out / "motion.png").read_bytes().startswith(b"\x89PNG")
    summary = json.loads((out / "summary.json").read_text())
    assert summary["ok"] and summary["problems"] == []
    (stop,) = summary["stops"]
    assert stop["cause"] == "ESTOP" and 150_000 < stop["clock"] < 150_010
    assert stop["machine_positions"] == [axis["machine_position"] for axis in summary["axes"]]
    assert [one["do"] for one in summary["events"]] == ["arm", "estop"]
    assert summary["triggers"][0]["positions"][0] in (900, 901)
    assert summary["encoders"][0]["rms_error_steps"] < 1
    rows = (out / "pulses.csv").read_text().splitlines()
    assert len(rows) - 1 == sum(axis["pulses"] for axis in summary["axes"])
    assert cli.main(["run", str(file), "--waves", "--out", str(out)]) == 2


@pytest.mark.parametrize("name", ["homing", "probing", "hold_and_estop", "closed_loop", "laser", "threading"])
def test_examples(name: str) -> None:
    """On the model; `make demo` compares them with the Verilated core."""
    file = read_channels(paths.examples / f"{name}.toml")
    with open_engine("model", scene_parameters(file), file.clock_hz) as core:
        run = Scene(file, core).run()
    assert run.problems() == []
    summary: dict[str, Any] = summarize_scene(run, "model")
    causes = [stop["cause"] for stop in summary["stops"]]
    ends = {"hold_and_estop": "ESTOP", "closed_loop": "FOLLOWING_ERROR", "laser": None, "threading": None}
    assert (causes or [None])[-1] == ends.get(name, "TRIGGER")


def test_a_move_that_fails_after_a_home_is_a_problem() -> None:
    """The stops that a home has sought do not excuse it."""
    file = read_channels(paths.examples / "homing.toml")
    with open_engine("model", scene_parameters(file), file.clock_hz) as core:
        run = Scene(file, core).run()
    assert run.stops and not run.problems()
    run.sections[-1].outcome = "LATE"
    assert run.problems() == ["move 3: LATE"]
    assert summarize_scene(run, "model")["outcome"] == "failed"


INPUT = "[[machine.input]]\n"
ENCODER_4 = "[[machine.encoder]]\ncounts_per_step = 4\n"
BAD = [
    ("[machine]\nfiltre = 1\n" + MOVE, "machine: unknown key 'filtre'; did you mean filter"),
    ('[machine]\nfilter = "70ms"\n' + MOVE, "machine: filter is 70000 clocks; must be at most 65535"),
    ("[machine]\nstart = [1]\n" + MOVE, "machine: start has 1 axes, but the moves have 2"),
    ("machine = 1\n" + MOVE, "machine: it must be a table"),
    (
        INPUT + 'role = "hom"\n' + MOVE,
        "input 1: role must be one of .* not 'hom'; did you mean home",
    ),
    (INPUT + 'role = "home"\naxis = 2\n' + MOVE, "machine: input 1: axis must be 0 to 1"),
    (INPUT + 'role = "home"\nat = "5cm"\n' + MOVE, 'at must be steps or a text such as "12.5mm"'),
    (INPUT + 'role = "home"\nat = "5mm"\n' + MOVE, "at in mm needs steps_per_mm in"),
    (INPUT + 'role = "home"\nat = 2.5\n' + MOVE, "at must be a whole number, not 2.5"),
    (INPUT + 'role = "home"\nnoise = 5\n' + MOVE, "noise needs glitch"),
    (INPUT + 'role = "home"\nhysteresis = 5\n' + MOVE, "hysteresis needs at"),
    (INPUT + 'role = "home"\nsoft = true\n' + MOVE, "soft is for limits and alarms, not for home"),
    (INPUT + 'role = "home"\nsoft = 1\n' + MOVE, "soft must be true or false, not 1"),
    ((INPUT + 'role = "home"\n') * 2 + MOVE, "machine: input 2: home is input 1 already"),
    (
        ENCODER_4.replace("4", "0") + MOVE,
        "encoder 1: counts_per_step must be greater than 0",
    ),
    (
        ENCODER_4 + "limit = 0\n" + MOVE,
        "encoder 1: limit must be greater than 0",
    ),
    (
        ENCODER_4 + "limit = 0.1\n" + MOVE,
        "limit is 0.4 counts; must be 1 to",
    ),
    (ENCODER_4 + 'stop = "soft"\n' + MOVE, "stop needs limit"),
    (MOVE + event("time = 1"), "event 1: do is missing"),
    (MOVE + event('do = "holt"\ntime = 1'), "event 1: do must be one of .* not 'holt'; did you mean hold"),
    (MOVE + event('do = "hold"'), "event 1: time, position or trigger is missing"),
    (
        MOVE + event('do = "hold"\ntime = 1\nposition = 2'),
        "event 1: time and position are mutually exclusive",
    ),
    (MOVE + event('do = "hold"\ntime = -1'), "event 1: time must not be negative"),
    (MOVE + event('do = "hold"\ntime = 1\nfalling = true'), "event 1: falling needs trigger"),
    (MOVE + event('do = "hold"\nposition = 1\nat_axis = 2'), "event 1: at_axis must be 0 to 1"),
    (MOVE + event('do = "hold"\ntrigger = "home"'), "event 1: home of axis 0 is not connected"),
    (MOVE + event('do = "input"\ninput = "probe"\ntime = 1'), "event 1: probe is not connected"),
    (MOVE + event('do = "override"\ntime = 1\npercent = 0'), "event 1: percent must be 1 to 100"),
    (MOVE + event('do = "slip"\ntime = 1\ncounts = 1'), "event 1: axis 0 has no encoder"),
    (MOVE + event('do = "hold"\ntime = 1') * (most("event") + 1), "there are 65 events; must be at most 64"),
    ("event = 3\n" + MOVE, "event must be an array of tables"),
    (HOME, "move 1: home of axis 0 is not connected"),
    (INPUT + 'role = "home"\n' + HOME.replace("-900, 0", "5, 5"), "move 1: home of axis 1 is not connected"),
    (INPUT + 'role = "home"\n' + HOME.replace("-900, 0", "0, 0"), "move 1: steps of home must move an axis"),
    (INPUT + 'role = "home"\n' + HOME.replace("back_off = 40", ""), "move 1: back_off is missing"),
    (MOVE + "channel = 1\n" + event('do = "hold"\ntime = 1'), "are for files of channel 0 only"),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_bad_input(tmp_path: Path, text: str, message: str) -> None:
    """One line, with the entry and the key."""
    with pytest.raises(MoveFileError, match=message) as raised:
        read_channels(write(tmp_path, text))
    assert "\n" not in str(raised.value)
