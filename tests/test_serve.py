# SPDX-License-Identifier: MIT
"""The command `passo serve`: options, the edges it writes, what it refuses."""

import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from passo import Machine
from passo.cli import BAD_INPUT, main
from passo.engine import EVENT, moves_of
from passo.native import planner
from passo.toolchain import paths

from tests.test_linux import ARRIVED, example

MACHINE = """clock_hz = 8_000_000
[[axis]]
steps_per_mm = 80
speed = 10
acceleration = 200
switches = ["home"]
"""


def wait_for(server: subprocess.Popen[str], path: Path) -> None:
    """Until it says its socket."""
    assert server.stdout
    while (line := server.stdout.readline()) and line != f"unix:{path}\n":
        assert line.startswith(("Building ", "Built "))


@pytest.mark.parametrize("options", [["--engine", "model"], ["--engine", "both", "--axes", "4"]])
def test_a_host_and_the_edges(tmp_path: Path, options: list[str]) -> None:
    """The command ends with its host and leaves no socket; the edges are in the file."""
    path, edges = tmp_path / "core", tmp_path / "edges.npy"
    command = [sys.executable, "-m", "passo.cli", "serve", str(path), "--once", "--edges", str(edges)]
    with subprocess.Popen([*command, *options], stdout=subprocess.PIPE, text=True) as server:
        wait_for(server, path)
        done = subprocess.run([example(), f"unix:{path}"], capture_output=True, text=True, timeout=300)
        assert (done.stdout, server.wait(60)) == (ARRIVED, 0)
    assert not path.exists()
    events = np.load(edges)
    assert events.dtype == EVENT
    assert int(np.abs(moves_of(events, 1)).sum()) == 2 * 3200


def test_a_host_that_is_killed(tmp_path: Path) -> None:
    """In real time the watchdog of the core stops the axes; the next host finds them where the pins say."""
    path, edges, machine = tmp_path / "core", tmp_path / "edges.npy", tmp_path / "machine.toml"
    machine.write_text(MACHINE)
    command = [sys.executable, "-m", "passo.cli", "serve", str(path), "--edges", str(edges), "--real-time"]
    host = (
        "from passo import Machine\n"
        f"motion = Machine.from_file({str(machine)!r}, 'unix:{path}').move(X=60)\n"
        "print('it moves', flush=True)\n"
        "motion.run()\n"
    )
    planner()  # builds it
    with subprocess.Popen([*command, "--machine", str(machine)], stdout=subprocess.PIPE, text=True) as server:
        wait_for(server, path)
        with subprocess.Popen([sys.executable, "-c", host], stdout=subprocess.PIPE, text=True) as first:
            assert first.stdout and first.stdout.readline() == "it moves\n"
            time.sleep(2)  # of 6 seconds
            first.kill()
        time.sleep(1.5)  # the watchdog waits half a second
        with Machine.from_file(machine, f"unix:{path}") as second:
            found = second.steps()[0]
            assert second.move(X=0).run().end["X"] == 0
        server.terminate()
        assert server.wait(60) == 0
    events = np.load(edges)
    ends = events["clock"][np.flatnonzero(np.diff(events["running"] & 1, prepend=0) == -1)]
    moved = moves_of(events, 0)
    assert 0 < found < 4800
    assert int(moved[events["clock"] <= ends[0]].sum()) == found
    assert int(moved.sum()) == 0


def test_what_it_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    machine = str(paths.examples / "machines" / "router.toml")
    assert main(["serve", str(tmp_path / "core"), "--machine", machine, "--axes", "3"]) == BAD_INPUT
    assert main(["serve", str(tmp_path / "core"), "--axes", "9"]) == BAD_INPUT
    assert main(["serve", str(tmp_path / "no" / "core")]) == BAD_INPUT
    said = capsys.readouterr().err.splitlines()
    assert said == [
        "--machine has its own axes and clock: leave --axes and --clock out",
        "--axes must be 1 to 8, --clock 1 to 4294967295",
        f"{tmp_path}/no/core: No such file or directory",
    ]


def test_a_second_server_at_a_socket(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is refused while the first one lives; what a dead one has left is replaced."""
    path = tmp_path / "core"
    with socket.socket(socket.AF_UNIX) as first:
        first.bind(str(path))
        first.listen()
        assert main(["serve", str(path)]) == BAD_INPUT
    assert (
        capsys.readouterr().err == f"{path}: another program serves there: end it, or choose another path\n"
    )
    with subprocess.Popen(
        [sys.executable, "-m", "passo.cli", "serve", str(path)], stdout=subprocess.PIPE, text=True
    ) as server:
        wait_for(server, path)
        server.terminate()
        assert server.wait(60) == 0
