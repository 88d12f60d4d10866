# SPDX-License-Identifier: MIT
"""The report page, opened in a browser: it shows every edge, and what the command says of them."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from passo.cli import main
from passo.curve import speeds_and_positions, step_errors
from passo.engine import model_engine
from passo.move_file import read_channels
from passo.plan import plan_channels
from passo.report_data import page_data
from passo.report_page import FOLDER, write_page, write_scene_page
from passo.run import Run, execute_channels, parameters_of
from passo.scene import Scene
from passo.scene_figures import _energy
from passo.scene_panels import lanes_of, trace_of
from passo.scene_plan import scene_parameters
from passo.scene_report import measured_curve, summarize_scene
from passo.scene_run import SceneRun
from passo.toolchain import paths

from tests.helpers.browser import Browser

READY = "passo && passo.ready"
MOVES = sorted(path for path in paths.examples.glob("*.toml") if not read_channels(path).setup)
LARGE = """
clock_hz = 100_000_000
[[move]]
steps = [600_000, -400_000]
profile = "cosine"
total_time = 4
ramp_time = 1
"""


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with Browser(tmp_path_factory.mktemp("browser")) as browser:
        yield browser


def report(moves: Path, page: Path) -> list[Run]:
    file = read_channels(moves)
    parameters = parameters_of(file)
    with model_engine(parameters, file.clock_hz) as engine:
        runs = execute_channels(file, plan_channels(file, parameters), engine)
    write_page(file, runs, "model", page)
    return runs


def shown(browser: Browser, page: Path) -> None:
    browser.errors.clear()
    browser.open(page.as_uri(), READY)
    assert browser.errors == []


def numbers(browser: Browser, expression: str) -> np.ndarray:
    return np.array(browser.value(f"Array.from({expression}, v => isNaN(v) ? null : v)"), float)


@pytest.mark.parametrize("name", [path.stem for path in MOVES])
def test_it_has_every_edge_and_the_ideal_curve(browser: Browser, tmp_path: Path, name: str) -> None:
    runs = report(paths.examples / f"{name}.toml", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    number = 0
    for run in runs:
        times, speeds, positions = speeds_and_positions(run, 200)
        inside = np.flatnonzero((np.diff(times, prepend=-1) > 0) & (np.diff(times, append=times[-1] + 1) > 0))
        for axis in range(run.file.axes):
            own = f"passo.motion.axes[{number}]"
            clocks, directions = run.steps(axis)
            assert np.array_equal(numbers(browser, f"{own}.rises"), clocks + run.late)
            assert np.array_equal(numbers(browser, f"{own}.counted"), np.cumsum(directions, dtype=int))
            rises, falls = numbers(browser, f"{own}.rises"), numbers(browser, f"{own}.falls")
            assert np.array_equal(np.unique(falls - rises), [run.file.pins.step_high][: len(falls)])
            assert np.allclose(
                numbers(browser, f"{own}.errors"), step_errors(run, axis)[1], rtol=0, atol=2e-6
            )
            asked = json.dumps((times[inside] + run.late).tolist())
            ideal = np.array(browser.value(f"{asked}.map(clock => {own}.ideal(clock))"))
            assert np.allclose(ideal[:, 0], speeds[axis][inside], rtol=1e-9, atol=1e-15)
            assert np.allclose(ideal[:, 1], positions[axis][inside], rtol=0, atol=2e-6)
            number += 1
    assert browser.value("document.getElementById('verdict').className") == "good"


def test_a_step_late_by_clocks_is_late_in_the_errors(browser: Browser, tmp_path: Path) -> None:
    """Half a clock of full speed and rounding to substeps, not more."""
    report(paths.examples / "three_axes.toml", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    lags, errors = (
        numbers(browser, "passo.motion.axes[0].lags"),
        numbers(browser, "passo.motion.axes[0].errors"),
    )
    middle = slice(len(lags) // 4, len(lags) // 2)  # at 50 kHz: 320 clocks a step
    assert np.allclose(lags[middle], errors[middle] * 320, atol=1e-3)


def test_zoom_to_a_clock(browser: Browser, tmp_path: Path) -> None:
    (run,) = report(paths.examples / "three_axes.toml", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    note = "document.querySelector('#pins .note').textContent"
    assert "edges per pixel" in browser.value(note)
    browser.drag("#pins .u-over", 0.25, 0.5)
    browser.wait("!passo.view.isAll")
    minimum, maximum = browser.value("[passo.view.min, passo.view.max]")
    length = browser.value("passo.view.limits[1] - passo.view.limits[0]")
    assert 0.24 < (maximum - minimum) / length < 0.26
    middle = int(run.steps(0)[0][10_000])
    browser.value(f"passo.view.set({middle - 20}, {middle + 20})")
    browser.wait(f"passo.view.isDrawn && {note}.includes('every edge')")
    level = browser.value(f"[-1, 0].map(d => passo.motion.axes[0].level('STEP', {middle} + d).high)")
    assert level == [False, True]
    found = browser.value("passo.histogram.found.total")
    assert found == sum(int(np.sum(np.abs(run.steps(axis)[0] - middle) < 20)) for axis in range(3))


def test_faults_are_shown(browser: Browser, tmp_path: Path) -> None:
    moves = paths.examples / "cosine.toml"
    file = read_channels(moves)
    parameters = parameters_of(file)
    with model_engine(parameters, file.clock_hz) as engine:
        runs = execute_channels(file, plan_channels(file, parameters), engine)
    runs[0].pins = runs[0].pins[: len(runs[0].pins) // 2]
    write_page(file, runs, "model", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    verdict = browser.value("document.getElementById('verdict').textContent")
    assert all(problem in verdict for problem in runs[0].problems()) and "steps of" in verdict
    assert browser.value("document.querySelectorAll('#events tr.fault').length") == len(runs[0].problems())


def test_a_million_steps(browser: Browser, tmp_path: Path) -> None:
    (tmp_path / "moves.toml").write_text(LARGE)
    report(tmp_path / "moves.toml", tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size < 5_000_000
    shown(browser, tmp_path / "page.html")
    assert browser.value("passo.ready") < 2000 * 4  # 2 s on a machine that has nothing else to do
    assert browser.value("passo.motion.axes[0].rises.length") == 600_000


def test_the_command_writes_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It names no other file or address, and says whose the library is."""
    moves = str(paths.examples / "cosine.toml")
    assert main(["run", moves, "--engine", "model", "--report", "--out", str(tmp_path)]) == 0
    assert f"open: {tmp_path / 'report.html'}" in capsys.readouterr().out
    text = (tmp_path / "report.html").read_text()
    assert not re.search(r"""(src|href)\s*=\s*["']|@import|url\(""", text)
    assert (FOLDER / "uplot/LICENSE").read_text() in text
    assert main(["run", moves, "--engine", "model", "--out", str(tmp_path)]) == 0
    assert not (tmp_path / "report.html").exists()


# ------------------------------------------------------------------------------ files with a machine ----


def scene_report(name: str, page: Path) -> SceneRun:
    file = read_channels(paths.examples / f"{name}.toml")
    with model_engine(scene_parameters(file), file.clock_hz) as engine:
        run = Scene(file, engine).run()
    write_scene_page(file, run, "model", page)
    return run


@pytest.mark.parametrize("name", ["homing", "laser", "closed_loop", "threading", "feeder"])
def test_a_machine(browser: Browser, tmp_path: Path, name: str) -> None:
    """Every edge of every pin that is shown, the samples of the encoders, events and stops."""
    run = scene_report(name, tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    for axis in range(run.file.axes):
        clocks, directions = run.steps(axis)
        assert np.array_equal(numbers(browser, f"passo.motion.axes[{axis}].rises"), clocks)
        places = run.setup.start(axis) + np.cumsum(directions)
        assert np.array_equal(numbers(browser, f"passo.motion.axes[{axis}].counted"), places)
    lanes = lanes_of(run)
    assert browser.value("passo.motion.machine.signals.map(one => one.name)") == [lane[0] for lane in lanes]
    for number, lane in enumerate(lanes):
        clocks, levels = trace_of(run, lane, -run.start - 1, run.clocks)
        changes = clocks[np.flatnonzero(np.diff(levels, prepend=np.int8(0)))]
        assert np.array_equal(numbers(browser, f"passo.motion.machine.signals[{number}].edges"), changes)
        middle = json.dumps(((clocks[1:] + clocks[:-1]) // 2)[::50].tolist())
        found = browser.value(f"{middle}.map(clock => passo.motion.machine.level({number}, clock))")
        assert found == (levels[:-1][::50] == 1).tolist()
    for number, encoder in enumerate(run.setup.encoders):
        curve, own = measured_curve(run, encoder), f"passo.motion.machine.encoders[{number}]"
        measured = run.setup.start(encoder.axis) + curve.measured
        assert np.array_equal(numbers(browser, f"{own}.measured"), measured)
        assert np.array_equal(numbers(browser, f"{own}.error"), curve.made - curve.measured)
        assert np.array_equal(numbers(browser, f"{own}.clocks"), curve.clocks)
    for number, tracker in enumerate(run.setup.trackers):
        own = f"passo.motion.machine.trackers[{number}]"
        assert np.array_equal(numbers(browser, f"{own}.tracked"), run.tracked["position"][:, tracker.axis])
        assert np.array_equal(numbers(browser, f"{own}.clocks"), run.tracked["clock"] - run.start)
    text = browser.value("document.getElementById('events').textContent")
    assert all(stop.cause.name in text for stop in run.stops)
    assert text.count("event ") + text.count("track ") >= len(run.events) and text.count("begins") == len(
        run.sections
    )
    panels = browser.value("Array.from(document.querySelectorAll('section.panel'), panel => panel.id)")
    assert "signals" in panels and ("power" in panels) == run.setup.has_outputs
    assert ("trackers" in panels) == bool(run.setup.trackers)
    assert ("following" in panels) == ("measured" in panels) == bool(run.setup.encoders)
    ends = all(map(run.sought, run.stops))
    assert browser.value("document.getElementById('verdict').className") == ("good" if ends else "stopped")


LIMIT = """
clock_hz = 2_000_000
[machine]
start = [400, 0]
[[machine.input]]
role = "limit_high"
at = 1500
side = "above"
[[machine.encoder]]
counts_per_step = 4
[[move]]
steps = [3000, 0]
profile = "cosine"
total_time = 0.4
ramp_time = 0.16
[[move]]
method = "home"
steps = [0, 100]
switch = "limit_high"
speed = 10_000
slow_speed = 1500
acceleration = 200_000
back_off = 60
[[move]]
steps = [-30, 0]
profile = "cosine"
total_time = 0.1
ramp_time = 0.05
"""
WORDS = "document.getElementById('verdict').textContent"


def test_a_stop_at_a_limit(browser: Browser, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Page, terminal and summary say what stopped it, how many steps were made, the position."""
    moves = tmp_path / "moves.toml"
    moves.write_text(LIMIT.replace("role", 'role = "limit_high"\naxis = 1\n[[machine.input]]\nrole', 1))
    command = ["run", str(moves), "--engine", "model", "--report", "--out", str(tmp_path)]
    assert main(command) == 0
    told = capsys.readouterr().out
    summary = json.loads((tmp_path / "summary.json").read_text())
    shown(browser, tmp_path / "report.html")
    assert browser.value("document.getElementById('verdict').className") == "stopped"
    said = browser.value(WORDS)
    assert said == summary["verdict"] and said in told
    assert said.startswith("stopped by LIMIT in move 1; 1,100 of 3,000 steps made; moves 2, 3 not started")
    assert said.endswith("C model alone, not compared") and "every" not in said
    assert (summary["outcome"], summary["stopped"]) == ("stopped", "LIMIT")
    assert summary["moves_not_begun"] == [2, 3]
    assert [(one["steps_asked"], one["steps_made"]) for one in summary["moves"]] == [(3000, 1100)]
    assert summary["axes"][0]["machine_position"] == 1500
    end = "passo.motion.facts.clocks"
    assert browser.value(f"[0, {end}].map(clock => passo.motion.axes[0].position(clock))") == [400, 1500]
    assert browser.value("passo.motion.axes[1].position(0)") == 0
    assert browser.value("passo.motion.machine.encoders[0].measured.at(-1)") == 1500
    title = browser.value("document.querySelector('#position h2').textContent")
    assert title == "Position of the machine"
    events = browser.value("document.getElementById('events').textContent")
    assert "move 2, 3 does not begin" in events and "move 2 begins" not in events


def test_a_good_run_says_what_was_judged(browser: Browser, tmp_path: Path) -> None:
    """Not that engines were compared if there was one, nor a timing error if nothing moved."""
    report(paths.examples / "cosine.toml", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    said = browser.value(WORDS)
    assert said.startswith("all 6,400 steps made at the pins") and said.endswith("not compared")
    assert "compared" not in browser.value("document.getElementById('settings').textContent")


def test_a_motion_cut_short_says_nothing_of_its_rest(tmp_path: Path) -> None:
    """Pins of the first half: moves that had not begun do not begin, and the motion does not end."""
    file = read_channels(paths.examples / "there_and_back.toml")
    parameters = parameters_of(file)
    with model_engine(parameters, file.clock_hz) as engine:
        (run,) = execute_channels(file, plan_channels(file, parameters), engine)
    whole = [event["text"] for event in page_data(file, [run], "model")[0]["events"]]
    assert whole[-1] == "the motion ends" and sum("begins" in text for text in whole) == len(run.plans)
    clocks = run.pins["clock"] - run.start
    run.pins = run.pins[clocks < run.plans[0].clocks // 2]
    run.__post_init__()
    cut = [event["text"] for event in page_data(file, [run], "model")[0]["events"] if not event["kind"]]
    assert cut == ["move 1 begins", "the motion has not ended"]
    run.pins = run.pins[:0]
    run.__post_init__()
    facts = page_data(file, [run], "model")[0]
    assert not [event for event in facts["events"] if not event["kind"]]
    assert facts["summary"]["outcome"] == "failed"


def test_what_was_not_measured_is_not_zero() -> None:
    """The energy of a single step, and of an encoder that no sample was taken of."""
    file = read_channels(paths.examples / "laser.toml")
    with model_engine(scene_parameters(file), file.clock_hz) as engine:
        run = Scene(file, engine).run()
    number = next(n for n, output in enumerate(run.setup.outputs, 1) if output and output.speed)
    output = run.setup.outputs[number - 1]
    assert output and _energy(run, output, np.array([100]))["whole_percent"] is None
    file = read_channels(paths.examples / "closed_loop.toml")
    with model_engine(scene_parameters(file), file.clock_hz) as engine:
        run = Scene(file, engine).run()
    run.samples = run.samples[:0]
    (encoder,) = summarize_scene(run, "model")["encoders"]
    assert encoder["samples"] == 0 and encoder["largest_error_steps"] is encoder["rms_error_steps"] is None


def test_the_power_of_a_laser(browser: Browser, tmp_path: Path) -> None:
    """Its curve has the time that the pin is high, and the page the energy per step."""
    run = scene_report("laser", tmp_path / "page.html")
    shown(browser, tmp_path / "page.html")
    percent, clocks = (
        numbers(browser, f"passo.motion.machine.power.{name}") for name in ("values", "clocks")
    )
    on = int(np.diff(run.pins["clock"].astype(np.int64))[run.pins["power"][:-1] == 1].sum())
    assert abs((percent[:-1] / 100 * np.diff(clocks)).sum() - on) < 1e-4 * on
    assert 55 < percent.max() <= 100 and percent.min() == 0
    assert "Energy per step" in browser.value("document.getElementById('energy').textContent")


def test_faults_of_a_machine_are_shown(browser: Browser, tmp_path: Path) -> None:
    """What the command calls a problem is a fault, the stop at the end a stop."""
    (tmp_path / "moves.toml").write_text(
        (paths.examples / "hold_and_estop.toml").read_text() + '\n[[event]]\ndo = "hold"\ntime = 999\n'
    )
    out = str(tmp_path / "out")
    command = ["run", str(tmp_path / "moves.toml"), "--engine", "model", "--report", "--out", out]
    assert main(command) == 1
    shown(browser, tmp_path / "out" / "report.html")
    assert "it never occurred" in browser.value("document.querySelector('#events tr.fault').textContent")
    assert "ESTOP" in browser.value("document.querySelector('#events tr.stop').textContent")
    assert browser.value("document.getElementById('verdict').className") == "bad"
