# SPDX-License-Identifier: MIT
"""Outputs and threads of move files, judged at the pins."""

from pathlib import Path

import numpy as np
import pytest
from passo.move_file import read_channels
from passo.moves import MoveFileError
from passo.registers import Cause
from passo.rig import Rig
from passo.run import open_engine
from passo.scene import Scene
from passo.scene_figures import energies, thread_figures
from passo.scene_plan import plan_sections, scene_parameters
from passo.scene_report import summarize_scene
from passo.scene_run import SceneRun
from passo.toolchain import paths

from tests.helpers.scenes import CLOCK_HZ, MOVE, SPEED, event, machine, play, write

LASER = MOVE + "output = { levels = 5, power = 50, speed = 10_000 }\n"
PWM = "pwm = 50_000\n"


def levels(run: SceneRun, pin: str, clocks: np.ndarray) -> list[int]:
    """Levels of a pin on clocks since the start."""
    at = run.pins["clock"].astype(np.int64) - run.start
    return run.pins[pin][np.searchsorted(at, clocks, side="right") - 1].astype(int).tolist()


def rises(run: SceneRun, pin: str) -> np.ndarray:
    level = run.pins[pin].astype(np.int64) & 1
    return run.pins["clock"].astype(np.int64)[np.diff(level, prepend=0) > 0] - run.start


# --------------------------------------------------------------------------------------------- outputs ----


def test_levels_of_each_move(tmp_path: Path) -> None:
    """From the first substep of a move on; a move without `output` has none."""
    back = MOVE.replace("2000, -1000", "-2000, 1000")
    run = play(tmp_path, LASER + back + back + "output = { levels = 130 }\n" + LASER)
    assert run.problems() == []
    steps = run.steps(0)[0]
    assert levels(run, "outputs", steps[[0, 1999, 2000, 3999, 4000, 5999, 6000]]) == [5, 5, 0, 0, 130, 130, 5]


def test_a_lag(tmp_path: Path) -> None:
    runs = [play(tmp_path, f'[machine]\nlag = "{lag}us"\n' + LASER) for lag in (0, 300)]
    changes = [run.pins["clock"][np.flatnonzero(run.pins["outputs"])[0]] - run.start for run in runs]
    assert changes[1] == changes[0] + 300


@pytest.mark.parametrize("engine", ["model", "both"])
def test_energy_of_a_laser(tmp_path: Path, engine: str) -> None:
    """The same per step at each speed, through a hold, whose rest has no power, and an override."""
    text = machine(PWM + 'stop_time = "40ms"') + LASER.replace("400_000", "200_000")
    text += event('do = "hold"\ntime = 0.05') + event('do = "resume"\ntime = 0.12')
    text += event('do = "override"\ntime = 0.18\npercent = 30')
    run = play(tmp_path, text, engine)
    (energy,) = energies(run)
    assert run.problems() == [] and energy["windows"] >= 30 and energy["steps_per_window"] == 52
    assert -1 < energy["least_percent"] < energy["most_percent"] < 1 and abs(energy["whole_percent"]) < 0.5
    on = int(np.diff(run.pins["clock"].astype(int), append=0)[run.pins["power"] == 1].sum())
    ideal = 0.5 * 2000 * CLOCK_HZ / SPEED
    assert abs(on / ideal - 1) < 0.01
    assert not ((rises(run, "power") > 95_000) & (rises(run, "power") < 120_000)).any()


def test_moves_of_different_speeds_share_the_reference(tmp_path: Path) -> None:
    """Each has its own velocity in substeps; the energy per step is that of its line."""
    slow = LASER.replace("speed = 10000", "speed = 3000").replace("power = 50", "power = 25")
    run = play(tmp_path, machine(PWM) + (LASER + slow).replace("400_000", "100_000"))
    found = energies(run)
    assert [one["number"] for one in found] == [1, 2] and run.problems() == []
    for one in found:
        assert -1 < one["least_percent"] < one["most_percent"] < 1


def test_constant_power_and_a_stop(tmp_path: Path) -> None:
    """The power ends with a stop of any cause; the levels stay."""
    text = MOVE + "output = { levels = 1, power = 100 }\n" + event('do = "estop"\ntime = 0.1')
    run = play(tmp_path, text)
    assert run.stops[0].cause == Cause.ESTOP
    power = run.pins["power"].astype(int)
    clocks = run.pins["clock"].astype(np.int64) - run.start
    assert levels(run, "power", np.arange(1000, 100_000, 7)) == [1] * len(range(1000, 100_000, 7))
    assert power[clocks > 100_010].max(initial=0) == 0 and run.pins["outputs"][-1] == 1


def test_a_raster(tmp_path: Path) -> None:
    """Each value from half a step before its step on; what is missing is 0; the next line has its own."""
    values = [255 * (n * 7 % 3 == 0) for n in range(50)]
    raster = MOVE + f"output = {{ raster = {values}, pitch = 30 }}\n"
    run = play(tmp_path, machine("pwm = 200_000") + raster + raster)
    assert run.problems() == []
    steps = run.steps(0)[0]
    want = [value // 255 for value in values] + [0] * (67 - 50)
    for line in (steps[:2000], steps[2000:]):
        middle = line[15::30]
        assert levels(run, "power", middle) == want[: len(middle)]


def test_a_long_raster_is_fed(tmp_path: Path) -> None:
    """More values than the core's queue holds."""
    values = [255 * (n // 5 % 2) for n in range(2000)]
    run = play(tmp_path, machine("pwm = 200_000") + MOVE + f"output = {{ raster = {values} }}\n")
    assert levels(run, "power", run.steps(0)[0][2::5]) == [n % 2 for n in range(400)]


def test_compare_pulses(tmp_path: Path) -> None:
    """With the steps onto the points, in places of the machine."""
    compare = '[machine.compare]\nposition = 130\ninterval = 250\nwidth = "20us"\n'
    run = play(tmp_path, "[machine]\nstart = [30, 0]\n" + compare + MOVE)
    steps = run.steps(0)[0]
    assert rises(run, "compare").tolist() == steps[99::250].tolist() and run.problems() == []
    level = run.pins["compare"].astype(np.int64) & 1
    falls = run.pins["clock"].astype(np.int64)[np.diff(level, prepend=0) < 0] - run.start
    assert (falls - rises(run, "compare") == 20).all()


# --------------------------------------------------------------------------------------------- threads ----

SPINDLE = "[machine.spindle]\ncounts_per_turn = 500\nrpm = 1200\nwander = 30\n"
THREAD = '[[move]]\nmethod = "thread"\nsteps = [1300, -7]\nturns = 3\n'
BACK = MOVE.replace("2000, -1000", "-1300, 7")


def test_the_spindle_wanders(tmp_path: Path) -> None:
    """About its speed, up to both of its ends; the index comes once a turn."""
    file = read_channels(write(tmp_path, "[machine]\n" + SPINDLE + THREAD))
    assert file.setup
    with open_engine("model", scene_parameters(file), CLOCK_HZ) as core:
        rig = Rig(core, file.setup, 2)
        core.run(10 * CLOCK_HZ)
        changes = rig.changes()
    turned = changes["clock"][changes["input"] != changes["input"].max()]
    gaps = np.diff(turned[turned > 0].astype(int))
    assert 100 / 1.3 - 1 <= gaps.min() <= 100 / 1.2 and 100 / 0.8 <= gaps.max() <= 100 / 0.7 + 1
    assert abs(len(gaps) / (10 * CLOCK_HZ / 100) - 1) < 0.1
    index = changes[changes["input"] == changes["input"].max()]
    high = index["clock"][index["levels"] > 0].astype(int)
    counts = np.searchsorted(turned, high)
    assert (np.diff(counts) == 500).all() and len(high) > 150


@pytest.mark.parametrize("engine", ["model", "both"])
def test_a_thread(tmp_path: Path, engine: str) -> None:
    """Each step within a count of the exact pitch, each pass with the same phase."""
    run = play(tmp_path, "[machine]\n" + SPINDLE + THREAD + BACK + THREAD, engine)
    assert run.problems() == [] and run.machine == [1300, -7]
    figures = [thread_figures(run, section) for section in run.sections if section.kind == "thread"]
    assert len(figures) == 2 and figures[0]["phase_counts"] == figures[1]["phase_counts"]
    for one in figures:
        assert one["steps"] == 1300 and 0.3 < one["largest_distance_counts"] <= 1
        assert one["spindle_rpm"][1] / one["spindle_rpm"][0] > 1.15
    kinds = [move["kind"] for move in summarize_scene(run, engine)["moves"]]
    assert kinds == ["thread", "moves", "thread"]


def test_a_thread_is_held(tmp_path: Path) -> None:
    """And makes up for it, with all of its steps, on the pitch again."""
    text = '[machine]\nstop_time = "2ms"\n' + SPINDLE + THREAD + "top_rpm = 4000\n"
    run = play(tmp_path, text + event('do = "hold"\nposition = 300') + event('do = "resume"\ntime = "100ms"'))
    assert run.problems() == [] and run.machine == [1300, -7]
    clocks, _ = run.steps(0)
    assert np.diff(clocks).max() > 20_000


def test_a_thread_without_its_index(tmp_path: Path) -> None:
    """It begins immediately: the phase is that of the moment."""
    thread = THREAD + "wait_index = false\n"
    text = "[machine]\n" + SPINDLE + thread + BACK + thread
    run = play(tmp_path, text)
    phases = [
        thread_figures(run, section)["phase_counts"] for section in run.sections if section.kind == "thread"
    ]
    assert run.problems() == [] and phases[0] != phases[1]


# ------------------------------------------------------------------------------------------- bad input ----

BAD = [
    (MOVE + "output = 3\n", "move 1: output: it must be a table"),
    (MOVE + "output = { powr = 3 }\n", "output: unknown key 'powr'; did you mean power"),
    (MOVE + "output = { power = 101 }\n", "output: power must be at most 100"),
    (MOVE + "output = { levels = 256 }\n", "output: levels must be 0 to 255"),
    (MOVE + "output = { power = 1, raster = [1] }\n", "output: power and raster are mutually exclusive"),
    (MOVE + "output = { raster = [256] }\n", "output: raster must be 0 to 255"),
    (MOVE + "output = { raster = [] }\n", "output: raster must be a list of whole numbers"),
    (MOVE + "output = { raster = [1], pitch = 0 }\n", "output: pitch must be 1 to"),
    (MOVE + "output = { pitch = 3 }\n", "output: pitch needs raster"),
    (MOVE + "output = { speed = 3 }\n", "output: speed needs power"),
    (MOVE + "output = { power = 3, speed = 0 }\n", "output: speed must be greater than 0"),
    ("[machine]\npwm = 600_000\n" + MOVE, "machine: pwm must be 1 to 500000 Hz"),
    ('[machine]\nlag = "70ms"\n' + MOVE, "machine: lag is 70000 clocks; must be 0 to 65535"),
    (MOVE + "channel = 1\noutput = { power = 1 }\n", "output, home, probe and thread are for files of"),
    ("[machine]\ncompare = 1\n" + MOVE, "machine: compare: it must be a table"),
    (
        '[machine.compare]\nposition = 1\ninterval = 0\nwidth = "1us"\n' + MOVE,
        "compare: interval must not be 0",
    ),
    (
        '[machine.compare]\nposition = 1\ninterval = 1\nwidth = "1s"\n' + MOVE,
        "compare: width is 1000000 clocks",
    ),
    ('[machine.compare]\ninterval = 1\nwidth = "1us"\n' + MOVE, "compare: position is missing"),
    (
        '[machine.compare]\naxis = 2\nposition = 1\ninterval = 1\nwidth = "1us"\n' + MOVE,
        "compare: axis must be 0 to 1",
    ),
    (THREAD, "move 1: a thread needs a spindle"),
    (SPINDLE + THREAD + "output = { power = 1 }\n", "move 1: output: thread cannot have its own power"),
    (SPINDLE + THREAD.replace("turns = 3", "turns = 0"), "move 1: turns must be greater than 0"),
    (SPINDLE + THREAD.replace("turns = 3", "turns = 1e-4"), "move 1: turns are 0 counts"),
    (SPINDLE + THREAD.replace("1300, -7", "0, 0"), "move 1: steps of thread must move an axis"),
    (SPINDLE + THREAD + "top_rpm = 1500\n", "move 1: top_rpm is less than the 1560 of the spindle"),
    (SPINDLE.replace("1200", "12000") + THREAD, "spindle: rpm: one count every 7.69 clocks; must be"),
    (SPINDLE.replace("30", "91") + THREAD, "spindle: wander must be 0 to 90"),
    (SPINDLE + MOVE.replace("2000, -1000", "1, 1, 1, 1, 1, 1, 1, 1"), "moves must have at most 7 axes"),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_bad_input(tmp_path: Path, text: str, message: str) -> None:
    """One line, with the entry and the key."""
    with pytest.raises(MoveFileError, match=message) as raised:
        read_channels(write(tmp_path, text))
    assert "\n" not in str(raised.value)


BAD_PLANS = [
    ("{ power = 9, speed = 9000 }", "output: speed is below the 9996.8 steps/s that the move reaches"),
    (f"{{ raster = {[0] * 68}, pitch = 30 }}", "output: raster has 68 values; the move takes 67"),
    ("{ power = 90, speed = 1_000_000 }", ""),
]


@pytest.mark.parametrize(("output", "message"), BAD_PLANS)
def test_what_a_plan_does_not_allow(tmp_path: Path, output: str, message: str) -> None:
    """Refused before anything runs, with the move; the last one is allowed."""
    file = read_channels(write(tmp_path, MOVE + f"output = {output}\n"))
    assert file.setup
    if not message:
        assert plan_sections(file.files[0], file.setup, scene_parameters(file))
        return
    with pytest.raises(MoveFileError, match=f"move 1: {message}") as raised:
        plan_sections(file.files[0], file.setup, scene_parameters(file))
    assert "\n" not in str(raised.value)


def test_rasters_of_two_pitches(tmp_path: Path) -> None:
    both = [MOVE + f"output = {{ raster = [1], pitch = {pitch} }}\n" for pitch in (20, 30)]
    file = read_channels(write(tmp_path, "".join(both)))
    assert file.setup
    with pytest.raises(MoveFileError, match="move 2: output: pitch differs"):
        plan_sections(file.files[0], file.setup, scene_parameters(file))


def test_the_examples_reach_their_figures() -> None:
    """What docs/scenes.md says of them."""
    summaries = {}
    for name in ("laser", "threading"):
        file = read_channels(paths.examples / f"{name}.toml")
        with open_engine("model", scene_parameters(file), file.clock_hz) as core:
            summaries[name] = summarize_scene(Scene(file, core).run(), "model")
    (energy,) = summaries["laser"]["energy"]
    assert energy["windows"] > 60 and max(-energy["least_percent"], energy["most_percent"]) < 0.5
    passes = [move for move in summaries["threading"]["moves"] if move["kind"] == "thread"]
    assert len(passes) == 3 and len({one["phase_counts"] for one in passes}) == 1
    assert max(one["largest_distance_counts"] for one in passes) <= 1
