# SPDX-License-Identifier: MIT
"""The commands that README and documents show: each runs, in the order of its page, or says here why not.

`moves.toml` is the last move file before the command, or that of the tutorial. Of `make` only the recipe is
made: its targets have tests of their own, or take too long.
"""

import os
import subprocess
from pathlib import Path

import pytest
from passo import cli
from passo.toolchain import paths

from tests.helpers.shown_commands import Shown, run, shown

# Only their arguments are checked.
NOT_RUN = {
    "campaign": "minutes; tests/test_campaign.py",
    "firmware": "minutes, needs the compiler; tests/test_firmware.py",
    "serve": "runs until it is stopped; tests of hosts",
    "--pty": "runs until it is stopped; tests/test_grbl_sender.py",
}
ALL = shown()


def test_the_pages_show_commands() -> None:
    """Those of a newcomer are among them."""
    texts = {one.command.removeprefix(".venv/bin/") for one in ALL}
    assert {"make demo", "make web"} <= texts and any(
        text.startswith("passo run moves.toml") for text in texts
    )
    assert {word for word in NOT_RUN if not any(word in text for text in texts)} == set()


@pytest.mark.parametrize("one", [one for one in ALL if one.words[0] == "make"], ids=str)
def test_a_target_is_there(one: Shown) -> None:
    own = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL")}
    done = subprocess.run([*one.words, "--dry-run"], cwd=paths.root, env=own, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("one", [one for one in ALL if one.words[0] == "passo"], ids=str)
def test_a_command_runs(one: Shown, tmp_path: Path) -> None:
    """In a folder with the examples of the repository."""
    if any(word in NOT_RUN for word in one.words):
        words = one.words
        cli._parser().parse_args(words[1 : words.index("<")] if "<" in words else words[1:])
        return
    done = run(one, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
