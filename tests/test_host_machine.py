# SPDX-License-Identifier: MIT
"""Machine, for Python programs: plans, runs, homing, timed points, in simulation and at a socket."""

import asyncio
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import passo
import pytest
from passo import Machine
from passo.build import Parameters
from passo.driver import DriverError
from passo.engine import model_engine
from passo.failure import BadInputError, Failure
from passo.grbl_setup import machine_at
from passo.host_core import OpenError
from passo.machine_file import read_machine
from passo.motion import Done
from passo.timed import spline
from passo.toolchain import paths

from tests.helpers.serving import serving

PYTHON = paths.examples / "python"
PAGE = paths.docs / "hosts.md"
AXIS = 'steps_per_mm = 80\nspeed = 200\nacceleration = 1000\ntravel = 60\nhome = "{}"\nswitches = ["{}"]\n'
HOMES = f"""clock_hz = 16_000_000
[[axis]]
{AXIS.format("low", "home")}
[[axis]]
{AXIS.format("high", "limit_high")}
[[axis]]
{AXIS.format("low", "limit_low")}
"""
COREXY = 'kinematics = "corexy"\n' + HOMES.replace('"limit_high"', '"home"')
PLAIN = re.sub(r"(travel|home|switches) = .*\n", "", HOMES)


@pytest.fixture
def plain(tmp_path: Path) -> Path:
    path = tmp_path / "plain.toml"
    path.write_text(PLAIN)
    return path


def test_the_examples(tmp_path: Path) -> None:
    """They run; the first one has at most 15 lines of code, and the page shows it."""
    said = {}
    for example in sorted(PYTHON.glob("*.py")):
        done = subprocess.run(
            [sys.executable, example], capture_output=True, text=True, cwd=paths.root, timeout=120
        )
        assert (done.returncode, done.stderr) == (0, "")
        said[example.stem] = done.stdout
    assert "'X': 40.0, 'Y': 20.0, 'Z': 0.0} 3200 steps of X in 0.945674 s" in said["first_move"]
    assert said["timed_points"].endswith("{'X': 0.0, 'Y': 0.0, 'Z': 0.0}\n")
    code = (PYTHON / "first_move.py").read_text().split('"""')[2].strip()
    assert len([line for line in code.splitlines() if line]) <= 15
    assert f"```python\n{code}\n```" in PAGE.read_text()


def test_the_examples_have_types() -> None:
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent"]
    done = subprocess.run(
        [*command, "--cache-dir", str(paths.build / "mypy_cache"), str(PYTHON)],
        capture_output=True,
        text=True,
        cwd=paths.root,
        env=os.environ | {"MYPYPATH": str(paths.sim)},
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("on", ["model", "both"])
def test_a_move_and_a_path(plain: Path, on: str) -> None:
    """They end exactly; by the pins they are within a step of the plan; the engines agree."""
    with Machine.from_file(plain, on) as machine:
        small = 1.0 if on == "model" else 0.05
        corner = [[30 * small, 0, 0], [30 * small, 10 * small, 5 * small], [1, 1, 1]]
        for motion, end in (
            (machine.move(X=4 * small, z=-2 * small, speed=40), None),
            (None, [1.0, 1.0, 1.0]),
        ):
            motion = motion or machine.path(corner)
            done = motion.run()
            assert list(done.end.values()) == (end or [4 * small, 0.0, -2 * small])
            assert done.duration == pytest.approx(motion.seconds, abs=1e-9)
            times = np.linspace(0, motion.seconds, 200)
            assert np.abs(done.positions_at(times) - motion.positions_at(times)).max() < 1.001 / 80
            assert motion.course and max(motion.course.speeds().values()) <= 200.001
            assert (done.matched_edges is not None) == (on == "both")
        assert done.matched_edges is None or done.matched_edges > 100
        assert done.steps["X"][-1] == 80 and len(done.seconds["X"]) == len(done.steps["X"])


def test_nothing_to_do(plain: Path) -> None:
    """A move to where the machine is."""
    with Machine.from_file(plain) as machine:
        motion = machine.move(X=0)
        assert motion.seconds == 0
        assert motion.run().end == {"X": 0.0, "Y": 0.0, "Z": 0.0}


@pytest.mark.parametrize("text", [HOMES, COREXY], ids=["cartesian", "corexy"])
def test_homing(tmp_path: Path, text: str) -> None:
    """All axes, or one; the low end is 0, the high end the travel; less the pull-off."""
    path = tmp_path / "machine.toml"
    path.write_text(text)
    with Machine.from_file(path) as machine:
        assert machine.home("z").run().end == pytest.approx({"X": 0, "Y": 0, "Z": 1}, abs=0.02)
        done = machine.home().run()
        assert done.end == pytest.approx({"X": 1, "Y": 59, "Z": 1}, abs=0.02)
        assert machine.move(X=30, Y=30).run().end == pytest.approx({"X": 30, "Y": 30, "Z": 1}, abs=0.02)


def test_timed_points(plain: Path) -> None:
    """Each point is reached, from wherever the machine is; with `smooth` few points are enough."""
    with Machine.from_file(plain) as machine:
        machine.move(X=5).run()
        times, places = [0, 0.5, 1.2, 2], [[5, 0, 0], [20, 5, 0], [30, -5, 1], [5, 1, 0]]
        motion = machine.follow(times, places, smooth=True)
        done = motion.run()
        assert motion.seconds == 2 and done.duration == 2
        assert np.abs(done.positions_at(np.array(times)) - places).max() <= 0.5 / 80
        fine = np.linspace(0, 2, 500)
        assert np.abs(done.positions_at(fine) - motion.positions_at(fine)).max() <= 1.01 / 80


def test_a_spline() -> None:
    """Through all points, at rest at both ends, smooth between; a cubic is itself."""
    times = np.array([0, 0.1, 0.35, 1.0])
    cubic = (3 * times**2 - 2 * times**3)[:, None]
    made, places, leads = spline(times, cubic, 0.01)
    assert np.allclose(places[:, 0], 3 * made**2 - 2 * made**3)
    assert leads[0] == 1 and leads[-1] == 3 and made[-1] == 1
    made, places, _ = spline(times, np.array([[0], [1], [-1], [0.5]]), 0.001)
    assert np.allclose(places[np.searchsorted(made, times[1:] - 1e-9), 0], [1, -1, 0.5])
    speed = np.diff(places[:, 0], prepend=0) / np.diff(made, prepend=0)
    change = np.diff(speed, prepend=0, append=0)
    assert np.abs(np.diff(change)[1:-1]).max() < 0.01 and np.abs(change).max() < 0.5


def test_what_is_refused(plain: Path) -> None:
    """In one sentence, and nothing has moved."""
    with Machine.from_file(plain) as machine:
        for ask, sentence in (
            (lambda: machine.move(W=1), "there is no axis W: axes are X, Y, Z"),
            (lambda: machine.path([[1, 2]]), "points must be rows of 3 numbers: X, Y, Z"),
            (lambda: machine.path([[0, 0, 0], [1e10, 0, 0]]), "positions must be numbers, less than"),
            (lambda: machine.move(X=1, speed=0), "point 0: NO_FEED"),
            (lambda: machine.move(X=float("nan")), "positions must be numbers, less than"),
            (lambda: machine.follow([1], [[0, 0, 0]] * 2), "there are 1 times for 2 positions"),
            (lambda: machine.follow([0, 1], [[1, 0, 0]] * 2), "point 0: at time 0 the machine is at [0.0"),
            (lambda: machine.follow([0], [[0, 0, 0]]), "there is no point after time 0"),
            (lambda: machine.follow([1, 2, 2], [[0, 0, 0]] * 3), "point 2: its time must be above that of"),
            (lambda: machine.follow([-1], [[0, 0, 0]]), "times must be numbers from 0 on"),
            (
                lambda: machine.follow([0, 0.1, 0.2], [[0, 0, 0], [0, 0, 0], [0, 21, 0]]),
                "point 2: Y: the way to it is faster than the speed of the axis",
            ),
            (
                lambda: machine.follow([0.1, 0.2], [[9, 0, 0], [20, 0, 0]], smooth=True),
                "point 0: X: the speed changes by more than the acceleration allows",
            ),
            (lambda: machine.home(), 'no axis has a home: home = "low" or "high" in '),
            (lambda: machine.home("W"), "there is no axis W"),
            (lambda: machine.home("X"), "axis X has no home"),
        ):
            with pytest.raises(BadInputError, match=re.escape(sentence)):
                ask()
        assert machine.steps().tolist() == [0, 0, 0]
        old = machine.move(X=1)
        machine.move(X=2).run()
        with pytest.raises(Failure, match=r"planned from .* plan again"):
            old.run()
    with pytest.raises(OpenError, match="No such file or directory: start the simulation: passo serve"):
        Machine.from_file(plain, on="unix:/no/socket")
    with pytest.raises(AttributeError):
        passo.nothing  # noqa: B018


def test_a_core_without_inputs(tmp_path: Path) -> None:
    """A machine with switches is refused, one without them is not."""
    path, core = tmp_path / "machine.toml", Parameters(axes=3, clock_hz=16_000_000)
    with model_engine(core, 16_000_000) as engine, serving(engine, tmp_path / "core") as server:
        path.write_text(HOMES)
        sentence = "its switches need inputs, the core has none: build it with INPUTS=1"
        with pytest.raises(BadInputError, match=sentence):
            Machine.from_file(path, f"unix:{server.path}")
        path.write_text(PLAIN)
        with Machine.from_file(path, f"unix:{server.path}") as machine:
            assert machine.steps().tolist() == [0, 0, 0]


def test_other_tasks_go_on(plain: Path) -> None:
    """Hold, resume and override while a motion is awaited; the same steps, later."""

    async def play() -> Done:
        with Machine.from_file(plain) as machine:
            running = asyncio.ensure_future(machine.move(X=20))
            while machine.position["X"] == 0:
                await asyncio.sleep(0.01)
            machine.hold()
            held = None
            while held != machine.position["X"]:
                held = machine.position["X"]
                await asyncio.sleep(0.05)
            assert 0 < held < 20 and not running.done()
            machine.override(50)
            machine.resume()
            return await running

    done = asyncio.run(play())
    assert done.end["X"] == 20


def test_a_canceled_motion_comes_to_rest(plain: Path) -> None:
    """With a soft stop; the next motion begins there."""

    async def play() -> None:
        with Machine.from_file(plain) as machine:
            running = asyncio.ensure_future(machine.move(X=50))
            while machine.position["X"] == 0:
                await asyncio.sleep(0.01)
            running.cancel()
            with pytest.raises(asyncio.CancelledError):
                await running
            here = machine.position["X"]
            assert 0 < here < 50
            assert (await machine.move(X=0)).end["X"] == 0

    asyncio.run(play())


def test_a_stop_by_the_core(tmp_path: Path) -> None:
    """A limit: the error says so; after `clear` the machine can move away."""
    path = tmp_path / "machine.toml"
    path.write_text(HOMES)
    with Machine.from_file(path) as machine:
        with pytest.raises(DriverError, match="LIMIT"):
            machine.move(Y=40).run()
        machine.clear()
        assert 29 < machine.position["Y"] < 40
        assert machine.move(Y=0).run().end["Y"] == 0


def test_a_device_is_the_same(plain: Path, tmp_path: Path) -> None:
    """At a socket: the same ends and the same pulses as in this process; the server sees the edges."""
    file = read_machine(plain)
    with Machine.from_file(plain) as machine:
        wanted = machine.move(X=10, Y=-4).run()
    with machine_at("model", file) as engine:
        with serving(engine, tmp_path / "core", keep=True) as server:
            with Machine.from_file(plain, f"unix:{server.path}") as machine:
                done = machine.move(X=10, Y=-4).run()
                assert done.end == wanted.end
                with pytest.raises(Failure, match="only a simulation sees the pins"):
                    _ = done.seconds
            with Machine.from_file(plain, f"unix:{server.path}") as machine:
                assert machine.position == wanted.end
                assert asyncio.run(_back(machine)).end == {"X": 0.0, "Y": 0.0, "Z": 0.0}
        events = server.events
    rises = events["clock"][np.flatnonzero(np.diff(events["step"].astype(int) & 1, prepend=0) == 1)]
    start = events["clock"][np.flatnonzero(events["running"] & 1)[0]]
    clocks = np.rint(wanted.seconds["X"] * file.clock_hz).astype(np.int64)
    assert np.array_equal(rises[:800].astype(np.int64) - int(start), clocks)


async def _back(machine: Machine) -> Done:
    return await machine.follow([0, 1], [[10, -4, 0], [0, 0, 0]], smooth=True)
