# SPDX-License-Identifier: MIT
"""The page to try Passo makes the same steps as `passo run`."""

from pathlib import Path

import numpy as np
import pytest
from passo.engine import model_engine
from passo.move_file import read_moves
from passo.plan import plan_file
from passo.run import execute, parameters_for
from passo.web import build

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
