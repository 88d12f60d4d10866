# SPDX-License-Identifier: MIT
"""A command whose output nobody reads any more, or that a full disk does not take, ends as others do."""

import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from passo.cli import main

from tests.helpers.commands import CONSOLE, TALKERS, WRITERS, smaller

COMMANDS = WRITERS | TALKERS
LINES = ["$$\n", "$#\n", "help\n", "?\n", "G1 X1 F600\n"] * 20
BROKEN, FULL = 128 + 13, 1


def broken() -> int:
    reader, writer = os.pipe()
    os.close(reader)
    return writer


ENDS: dict[str, tuple[Callable[[], int], int, str]] = {
    "broken pipe": (broken, BROKEN, ""),
    "full disk": (
        lambda: os.open("/dev/full", os.O_WRONLY),
        FULL,
        "standard output or a temporary file: No space left on device\n",
    ),
}


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("name", COMMANDS)
def test_it_ends_quietly(
    name: str, end: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """All commands; nothing is printed by the callbacks of C, too."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO("".join(LINES)))
    smaller(monkeypatch, tmp_path)
    opened, *ends = ENDS[end]
    with os.fdopen(opened(), "w") as output, monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", output)
        try:
            status = main([word.replace("OUT", str(tmp_path)) for word in COMMANDS[name]])
        except SystemExit as ended:  # of argparse, of the tables
            status = ended.code
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, output.fileno())  # takes what is left
        os.close(null)
    assert [status, capfd.readouterr().err] == ends


@pytest.mark.parametrize("command", [("rtl",), CONSOLE], ids=["rtl", "grbl"])
def test_in_a_shell(command: tuple[str, ...]) -> None:
    """`passo ... | head -1`, to the end of the interpreter, when nothing is to be built any more."""
    whole = [sys.executable, "-m", "passo", *command]
    subprocess.run(whole, stdin=subprocess.DEVNULL, capture_output=True, check=True)
    writer = broken()
    done = subprocess.run(whole, input="".join(LINES), stdout=writer, stderr=subprocess.PIPE, text=True)
    os.close(writer)
    assert (done.returncode, done.stderr) == (BROKEN, "")


def test_a_closed_output_is_no_error() -> None:
    done = subprocess.run(["sh", "-c", f"{sys.executable} -m passo rtl >&-"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
