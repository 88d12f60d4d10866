# SPDX-License-Identifier: MIT
"""`passo console` at a terminal: prompt, editing, history, progress, ways out."""

import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from passo.build import Parameters
from passo.engine import model_engine
from passo.terminal import Terminal

# Ignores ctrl-C as the background of a script does.
SPAWN = "import pty, signal, sys; signal.signal(2, signal.SIG_IGN); sys.exit(pty.spawn(sys.argv[1:]) >> 8)"
UP, CTRL_A, CTRL_C, CTRL_D = "\x1b[A", "\x01", "\x03", "\x04"
SECONDS = 60.0
MOVE = "move steps=400 profile=linear total_time=2 ramp_time=0.5"


class User:
    """Someone at a pseudo terminal."""

    def __init__(self, home: Path):
        command = [sys.executable, "-c", SPAWN, sys.executable, "-m", "passo.cli", "console"]
        settings = {**os.environ, "XDG_STATE_HOME": str(home), "TERM": "xterm", "INPUTRC": "/dev/null"}
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=settings, bufsize=0
        )
        os.set_blocking(self.process.stdout.fileno(), False)
        self.said = ""

    def type(self, text: str) -> None:
        self.process.stdin.write(text.encode())

    def read(self, pattern: str) -> str:
        """Everything up to a pattern, and the pattern."""
        end = time.monotonic() + SECONDS
        while not (found := re.search(pattern, self.said)):
            assert time.monotonic() < end, self.said
            self.said += (self.process.stdout.read() or b"").decode()
            time.sleep(0.01)
        text, self.said = self.said[: found.end()], self.said[found.end() :]
        return text

    def ask(self, line: str) -> str:
        """What is said to a line, up to the next prompt."""
        self.type(f"{line}\n")
        return self.read(r"(?s)(ok|error: )[^\n]*\n.*?> ")

    def leave(self, how: str) -> None:
        self.type(how)
        assert self.process.wait(SECONDS) == 0


@pytest.fixture
def user(tmp_path: Path) -> Iterator[User]:
    with model_engine(Parameters()) as engine:  # everything is built before
        Terminal(engine, print).close()
    made = User(tmp_path)
    greeting = made.read("> ")
    assert "note: Passo console" in greeting and "ctrl-D" in greeting
    yield made
    made.process.kill()
    made.process.wait()


def test_lines_are_edited_and_remembered(user: User, tmp_path: Path) -> None:
    """The cursor keys work, also on lines of the session before."""
    assert "ok position=0,0,0,0" in user.ask(f"osition{CTRL_A}p")
    assert "ok position=0,0,0,0" in user.ask(UP)
    user.leave(CTRL_D)
    again = User(tmp_path)
    again.read("> ")
    assert "ok position=0,0,0,0" in again.ask(UP)
    again.leave("quit\n")


@pytest.mark.parametrize("how", ["quit\n", "exit\n", CTRL_D])
def test_ways_out(user: User, how: str) -> None:
    """Each ends with status 0."""
    user.leave(how)


def test_progress_is_shown_and_can_be_interrupted(user: User) -> None:
    """`run` and `wait` show the time that passes; ctrl-C ends them, and the console continues."""
    user.ask(MOVE)
    user.type("wait\n")
    user.read("s simulated")
    user.read(r"ok\r?\n.*> ")
    user.type("run 3600\n")
    user.read(r"[1-9]\d*\.\d+ s simulated")
    user.type(CTRL_C)
    user.read(r"error: interrupted\r?\n.*> ")
    user.type("posi")
    user.read("posi")
    time.sleep(0.2)  # the line editor of Python misses a signal that comes between its echo and its wait
    user.type(CTRL_C)
    user.read("> ")
    assert "ok position=400,0,0,0" in user.ask("position")
    assert "quit" in user.ask("?")
    user.leave(CTRL_D)
