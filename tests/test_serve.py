# SPDX-License-Identifier: MIT
"""The command `passo serve`: options, the edges it writes, what it refuses."""

import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from passo import Machine
from passo.cli import main
from passo.ending import BAD_INPUT
from passo.engine import EVENT, moves_of
from passo.grbl_setup import machine_at
from passo.machine_file import read_machine
from passo.toolchain import paths

from tests.helpers.serving import serving
from tests.test_linux import ARRIVED, example

MACHINE = """clock_hz = 8_000_000
[[axis]]
steps_per_mm = 80
speed = 10
acceleration = 200
switches = ["home"]
"""


@contextmanager
def serve(path: Path, *options: str) -> Iterator[subprocess.Popen[str]]:
    """The command, from when it says its socket; killed at the end of the block if it has not ended."""
    command = [sys.executable, "-m", "passo.cli", "serve", str(path), *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout
            while (line := server.stdout.readline()) and line != f"unix:{path}\n":
                assert line.startswith(("Building ", "Built "))
            yield server
        finally:
            server.kill()


@pytest.mark.sample(1)
def test_a_host_and_the_edges(tmp_path: Path) -> None:
    """The command ends with its host and leaves no socket; the edges are in the file."""
    path, edges = tmp_path / "core", tmp_path / "edges.npy"
    with serve(path, "--once", "--edges", str(edges)) as server:
        done = subprocess.run([example(), f"unix:{path}"], capture_output=True, text=True, timeout=300)
        assert (done.stdout, server.wait(60)) == (ARRIVED, 0)
    assert not path.exists()
    events = np.load(edges)
    assert events.dtype == EVENT
    assert int(np.abs(moves_of(events, 1)).sum()) == 2 * 3200


def test_a_host_of_both_engines(tmp_path: Path) -> None:
    """A core with more axes than its host uses."""
    path, edges, text = tmp_path / "core", tmp_path / "edges.npy", tmp_path / "machine.toml"
    text.write_text(MACHINE.replace("speed = 10\n", "speed = 100\n").replace('switches = ["home"]\n', ""))
    options = ("--engine", "both", "--axes", "4", "--clock", "8000000", "--edges", str(edges))
    with serve(path, "--once", *options) as server:
        with Machine.from_file(text, f"unix:{path}") as machine:
            assert machine.move(X=20).run().end["X"] == 20
            assert machine.move(X=0).run().end["X"] == 0
        assert server.wait(60) == 0
    assert not path.exists()
    assert int(np.abs(moves_of(np.load(edges), 0)).sum()) == 2 * 1600


def test_a_host_that_dies(tmp_path: Path) -> None:
    """The watchdog of the core stops the axes; the next host finds them where the pins say."""
    path, text = tmp_path / "core", tmp_path / "machine.toml"
    text.write_text(MACHINE)
    with machine_at("model", read_machine(text)) as engine:
        with serving(engine, path, keep=True) as server:
            first = Machine.from_file(text, f"unix:{path}")
            turns = first.move(X=60)._turns()
            for _ in range(1000):
                next(turns)
            first.is_closed = True  # it does nothing any more, not even stop
            first.core.close()
            turns.close()
            with socket.socket(socket.AF_UNIX) as idle:
                idle.connect(str(path))
                idle.sendall(struct.pack(">2I", 0, 1_500_000))  # the watchdog waits half a second
                idle.recv(16, socket.MSG_WAITALL)
            with Machine.from_file(text, f"unix:{path}") as second:
                found = second.steps()[0]
                assert second.move(X=0).run().end["X"] == 0
        events = server.events
    ends = events["clock"][np.diff((events["running"] & 1).astype(int), append=0) == -1]
    assert 0 < found < 4800
    assert int(moves_of(events, 0)[events["clock"] <= ends[0] + 8].sum()) == found
    assert int(moves_of(events, 0).sum()) == 0


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


def test_a_place_that_is_no_socket(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is there stays as it is."""
    (tmp_path / "file").write_text("kept")
    (tmp_path / "link").symlink_to("nowhere")
    for name in ("file", "link", "."):
        path = tmp_path / name
        assert main(["serve", str(path)]) == BAD_INPUT
        assert capsys.readouterr().err == f"{path}: this is no socket: choose another path\n"
    assert (tmp_path / "file").read_text() == "kept" and (tmp_path / "link").is_symlink()


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
    with serve(path) as server:
        server.terminate()
        assert server.wait(60) == 0
