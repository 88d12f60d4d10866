# SPDX-License-Identifier: MIT
"""The page to try Passo makes the same steps as `passo run`."""

import json
from pathlib import Path

import numpy as np
import pytest
from passo.engine import model_engine
from passo.machine_file import read_machine
from passo.move_file import read_moves
from passo.part import play_part, read_part
from passo.plan import plan_file
from passo.run import execute, parameters_for
from passo.web import EXAMPLE, build

from tests.helpers.browser import Browser

MOVES = (
    ([6400, 3840, -2560], "cosine", "total_time={} ramp_time={}", ("0.4", "0.2")),
    ([0, -700, 31], "sigmoid", "total_time={} ramp_time={}", ("0.25", "0.1")),
    (
        [900, 5],
        "linear",
        "start_speed={} speed={} acceleration={} stop_speed={}",
        ("400", "9000", "60000", "400"),
    ),
)


def test_the_same_steps_as_the_command(tmp_path: Path) -> None:
    page = build(tmp_path / "web")
    with Browser(tmp_path / "browser") as browser:
        browser.open(page.as_uri(), "passo || document.getElementById('verdict').textContent")
        assert browser.errors == []
        for steps, profile, keys, values in MOVES:
            names = [word.split("=")[0] for word in keys.split()]
            table = "\n".join(f"{name} = {value}" for name, value in zip(names, values, strict=True))
            moves = tmp_path / "moves.toml"
            moves.write_text(
                f'clock_hz = 16_000_000\n[[move]]\nsteps = {steps}\nprofile = "{profile}"\n{table}\n'
            )
            file = read_moves(moves)
            parameters = parameters_for(file.axes)
            with model_engine(parameters, file.clock_hz) as engine:
                run = execute(file, plan_file(file, parameters), engine)
            line = f"move steps={','.join(map(str, steps))} profile={profile} {keys.format(*values)}"
            browser.value(f"document.querySelector('.lines').value = {line!r}")
            browser.value("document.querySelector('.go').click()")
            assert browser.value("document.getElementById('verdict').textContent") == "done"
            for axis in range(file.axes):
                own = f"passo.motion.axes.find(own => own.axis === {axis})"
                clocks, directions = run.steps(axis)
                if len(clocks):
                    assert browser.value(f"Array.from({own}.rises)") == clocks.tolist()
                    assert (
                        browser.value(f"Array.from({own}.counted)")
                        == np.cumsum(directions, dtype=int).tolist()
                    )


PROGRAMS = (
    (EXAMPLE / "part.nc").read_text(),
    "G21 G90 F3000\nG1 X10 Y-2\nG2 X20 I5\nM0\nG4 P0.05\nG0 Z1 X-3.3\nG3 X-3.3 Y0 R1.1 F600\nM30\nG1 X100",
)


def run_gcode(browser: Browser, program: str) -> None:
    browser.value("document.querySelector('.language').value = 'G-code'")
    browser.value(f"document.querySelector('.lines').value = {json.dumps(program)}")
    browser.value("document.querySelector('.go').click()")


def in_motions(clocks: np.ndarray, begins: list[int]) -> np.ndarray:
    """Clocks from the begin of each motion: the host decides how long the machine rests between two."""
    return clocks - np.array(begins)[np.searchsorted(begins, clocks, "right") - 1]


def test_gcode_makes_the_same_steps_as_the_command(tmp_path: Path) -> None:
    machine = read_machine(EXAMPLE / "machine.toml")
    with Browser(tmp_path / "browser") as browser:
        browser.open(build(tmp_path / "web").as_uri(), "passo")
        for number, program in enumerate(PROGRAMS):
            path = tmp_path / f"{number}.nc"
            path.write_text(program)
            axes = len(machine.settings.axes)
            with model_engine(parameters_for(axes), machine.clock_hz) as engine:
                played = play_part(read_part(path, machine), machine, engine)
            run_gcode(browser, program)
            assert browser.value("document.getElementById('verdict').textContent") == "done"
            begins = browser.value("passo.motion.facts.events.map(event => event.clock)")[::2]
            wanted = [begin for begin, _ in played.motions]
            assert len(begins) == len(wanted)
            for axis, (clocks, positions) in enumerate(zip(played.clocks, played.positions, strict=True)):
                own = f"passo.motion.axes.find(own => own.axis === {axis})"
                assert len(clocks)
                made = np.array(browser.value(f"Array.from({own}.rises)"))
                assert in_motions(made, begins).tolist() == in_motions(clocks, wanted).tolist()
                assert browser.value(f"Array.from({own}.counted)") == positions.tolist()


def test_the_tool_path_has_the_color_of_its_speed(tmp_path: Path) -> None:
    with Browser(tmp_path / "browser") as browser:
        browser.open(build(tmp_path / "web").as_uri(), "passo")
        run_gcode(browser, "G21 G90\nG1 X30 Y40 F3000\nX-30 Y120 F1500")
        browser.wait("passo.path.speeds")
        fastest, along = browser.value("[passo.path.speeds.fastest, passo.path.speeds.speeds]")
        assert fastest == pytest.approx(50, rel=0.03)
        second = along[len(along) // 2 : 7 * len(along) // 8]  # one is as exact as its window has steps
        assert sum(second) / len(second) == pytest.approx(25, rel=0.01)


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("G1 X1", "error: line 1: the feed is not set"),
        ("G21\nF100\nG1 X1 X2", "error: line 3: "),
        ("G0 X1e9", "error: line 1: "),
        ("G38.2 Z-1 F10", "error: line 1: no probe is fitted"),
        ("", "nothing moved"),
        ("M30\nnonsense", "nothing moved"),
    ],
)
def test_bad_gcode_is_said(tmp_path: Path, program: str, said: str) -> None:
    with Browser(tmp_path / "browser") as browser:
        browser.open(build(tmp_path / "web").as_uri(), "passo")
        run_gcode(browser, program)
        assert browser.value("document.getElementById('verdict').textContent").startswith(said)


@pytest.mark.parametrize("line", ["move steps=1", "what"])
def test_errors_are_said(tmp_path: Path, line: str) -> None:
    with Browser(tmp_path / "browser") as browser:
        browser.open(build(tmp_path / "web").as_uri(), "passo")
        browser.value(f"document.querySelector('.lines').value = {line!r}")
        browser.value("document.querySelector('.go').click()")
        assert browser.value("document.getElementById('verdict').textContent").startswith("error")


def test_a_browser_without_webassembly_is_told(tmp_path: Path) -> None:
    page = build(tmp_path / "web")
    page.write_text(page.read_text().replace("openWeb();", "delete window.WebAssembly; openWeb();"))
    with Browser(tmp_path / "browser") as browser:
        said = "document.getElementById('verdict').textContent"
        browser.open(page.as_uri(), said)
        assert "no WebAssembly" in browser.value(said)
