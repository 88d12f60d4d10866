# SPDX-License-Identifier: MIT
"""The commands that README and documents show: each runs, in the order of its page, or says here why not.

`moves.toml` is the last move file before the command, or that of the tutorial. Of `make` only the recipe is
made: its targets have tests of their own, or take too long.
"""

import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from passo import cli
from passo.toolchain import environment, paths

PAGES = (paths.root / "README.md", *sorted(paths.docs.glob("*.md")))
TUTORIAL = paths.docs / "tutorial.md"
BLOCKS = re.compile(r"^```(sh|toml)\n(.*?)^```", re.S | re.M)
COMMAND = re.compile(r"^(?:\.venv/bin/)?(passo|make) [^#&\n]*", re.M)
LINES = "help\n"  # for the console
# Only their arguments are checked.
NOT_RUN = {
    "campaign": "minutes; tests/test_campaign.py",
    "firmware": "minutes, needs the compiler; tests/test_firmware.py",
    "serve": "runs until it is stopped; tests of hosts",
    "--pty": "runs until it is stopped; tests/test_grbl_sender.py",
}


@dataclass(frozen=True)
class Shown:
    """A command of a page, and the move file before it."""

    page: Path
    command: str
    moves: str

    def __str__(self) -> str:
        return f"{self.page.stem}: {self.command}"


def shown() -> list[Shown]:
    """Of all pages; a command that a page shows twice is one."""
    (tutorial,) = (text for kind, text in BLOCKS.findall(TUTORIAL.read_text()) if kind == "toml")
    found = []
    for page in PAGES:
        moves = tutorial
        for kind, text in BLOCKS.findall(page.read_text(encoding="utf-8")):
            if kind == "toml" and "[[move]]" in text and "clock_hz" in text:
                moves = text
            elif kind == "sh":
                found += [Shown(page, match[0].strip(), moves) for match in COMMAND.finditer(text)]
    return list({str(one): one for one in found}.values())


ALL = shown()


def words_of(one: Shown) -> list[str]:
    return shlex.split(one.command.removeprefix(".venv/bin/"))


def test_the_pages_show_commands() -> None:
    """Those of a newcomer are among them."""
    texts = {one.command.removeprefix(".venv/bin/") for one in ALL}
    assert {"make demo", "make web"} <= texts and any(
        text.startswith("passo run moves.toml") for text in texts
    )
    assert {word for word in NOT_RUN if not any(word in text for text in texts)} == set()


@pytest.mark.parametrize("one", [one for one in ALL if words_of(one)[0] == "make"], ids=str)
def test_a_target_is_there(one: Shown) -> None:
    own = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL")}
    done = subprocess.run(
        [*words_of(one), "--dry-run"], cwd=paths.root, env=own, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("one", [one for one in ALL if words_of(one)[0] == "passo"], ids=str)
def test_a_command_runs(one: Shown, tmp_path: Path) -> None:
    """In a folder with the examples of the repository."""
    words = words_of(one)
    if any(word in NOT_RUN for word in words):
        cli._parser().parse_args(words[1 : words.index("<")] if "<" in words else words[1:])
        return
    (tmp_path / "examples").symlink_to(paths.examples)
    (tmp_path / "moves.toml").write_text(one.moves)
    (tmp_path / "lines.txt").write_text(LINES)
    program = Path(sys.executable).with_name("passo")
    line = one.command.removeprefix(".venv/bin/").replace("passo", str(program), 1)
    done = subprocess.run(
        ["sh", "-c", line],
        cwd=tmp_path,
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
