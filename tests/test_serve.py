# SPDX-License-Identifier: MIT
"""The command `passo serve`: options, the edges it writes, what it refuses."""

import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from passo.cli import BAD_INPUT, main
from passo.engine import EVENT, moves_of
from passo.toolchain import paths

from tests.test_linux import ARRIVED, example


@pytest.mark.parametrize("options", [["--engine", "model"], ["--engine", "both", "--axes", "4"]])
def test_a_host_and_the_edges(tmp_path: Path, options: list[str]) -> None:
    """The command ends with its host and leaves no socket; the edges are in the file."""
    path, edges = tmp_path / "core", tmp_path / "edges.npy"
    command = [sys.executable, "-m", "passo.cli", "serve", str(path), "--once", "--edges", str(edges)]
    with subprocess.Popen([*command, *options], stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout
        while (line := server.stdout.readline()) and line != f"unix:{path}\n":
            assert line.startswith(("Building ", "Built "))
        done = subprocess.run([example(), f"unix:{path}"], capture_output=True, text=True, timeout=300)
        assert (done.stdout, server.wait(60)) == (ARRIVED, 0)
    assert not path.exists()
    events = np.load(edges)
    assert events.dtype == EVENT
    assert int(np.abs(moves_of(events, 1)).sum()) == 2 * 3200


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
        assert server.stdout and server.stdout.readline() == f"unix:{path}\n"
        server.terminate()
        assert server.wait(60) == 0
