# SPDX-License-Identifier: MIT
"""The commands that README and documents show: each runs, in the order of its page, or says here why not.

`moves.toml` is the last move file before the command, or that of the tutorial. Of README and tutorial also
those in the text, and the recipes of the targets of make; where a recipe takes too long, a test that is named
here executes what it calls. Of the targets in other documents only the recipe is made.
"""

import os
import subprocess
from pathlib import Path

import pytest
from passo import cli
from passo.toolchain import environment, paths

from tests.helpers.shown_commands import TUTORIAL, Shown, run, shown

# Only their arguments are checked.
NOT_RUN = {
    "campaign": "minutes; tests/test_campaign.py",
    "firmware": "minutes, needs the compiler; tests/test_firmware.py",
    "serve": "runs until it is stopped; tests/test_serve.py::test_a_host_and_the_edges",
    "--pty": "runs until it is stopped; tests/test_grbl_sender.py",
}
# Commands of other programs, by their beginning.
ELSEWHERE = {
    "dask scheduler": "runs until it is stopped; tests/test_campaign.py::test_a_running_cluster",
    "dask worker": "runs until it is stopped; tests/test_campaign.py::test_a_running_cluster",
    "openocd": "needs a board",
    "st-flash": "needs a board",
    "stm32flash": "needs a board",
    "examples/linux/linux unix:": "needs a server; tests/test_linux.py::test_the_example_at_a_socket",
    "examples/linux/linux /dev/spidev": "needs a device; tests/test_linux.py::test_the_example_at_spidev",
    "sudo make -C linux/linuxcnc install": "changes the system; tests/test_linuxcnc.py::test_homing_and_arcs",
    "linuxcnc examples/linuxcnc/machine.ini": "has windows; tests/test_linuxcnc.py::test_homing_and_arcs",
    "pip install .": "changes .venv; tests/test_install.py::test_moves_run_outside_of_the_repository",
    ".venv/bin/python -m verify.soak.run": "tests/test_soak.py::test_no_promise_is_broken_in_the_model",
    "gtkwave": "has windows; tests/test_waves.py::test_by_default_the_start",
}
# Targets of README and tutorial whose recipes are not executed here.
LONG = {
    "machine": "minutes of place and route; tests/test_make.py::test_images",
    "firmware-demo": "a minute; tests/test_firmware.py::test_demonstration_tells_what_it_does",
    "synth": "minutes of place and route; tests/test_synth.py::test_first_seed_that_will_do_is_taken",
    "report": "hours; tests/test_synth.py::test_report_page_and_readme",
    "accuracy": "an hour; tests/test_accuracy.py::test_bounds",
    "bench": "a minute; tests/test_bench.py::test_the_speed_of_an_engine_is_that_of_its_motion",
    "verify": "hours; tests/test_verify.py::test_it_fails_when_a_part_does",
    "test": "has this test",
    "test-all": "has this test",
}
ALL = shown()
NEWCOMER = shown((paths.root / "README.md", TUTORIAL), in_text=True)
BARE = ("passo", ".venv/bin/passo")  # names in the text
COMMANDS = {str(one): one for one in (*ALL, *NEWCOMER) if one.command not in BARE}.values()
TARGETS = {one.command: one for one in NEWCOMER if one.program == "make"}


def begins(one: Shown) -> list[str]:
    """The entries of ELSEWHERE for a command."""
    return [begin for begin in ELSEWHERE if one.command.startswith(begin)]


def test_the_pages_show_commands() -> None:
    """Those of a newcomer are among them; each exception is one of a command that there is."""
    texts = {one.command.removeprefix(".venv/bin/") for one in COMMANDS}
    assert {"make demo", "make web", "make", "pip install ."} <= texts
    assert any(text.startswith("passo run moves.toml") for text in texts)
    assert {word for word in NOT_RUN if not any(word in text for text in texts)} == set()
    assert {begin for one in COMMANDS for begin in begins(one)} == ELSEWHERE.keys()
    assert LONG.keys() < {one.words[1] for one in TARGETS.values() if one.words[1:]}


@pytest.mark.parametrize("reason", [*NOT_RUN.values(), *ELSEWHERE.values(), *LONG.values()])
def test_what_is_executed_elsewhere_is_there(reason: str) -> None:
    if "tests/" in reason:
        file, _, name = reason.rpartition(" ")[2].partition("::")
        text = (paths.root / file).read_text()
        assert f"\ndef {name or 'test_'}" in text
    else:
        assert reason in ("needs a board", "has this test")


@pytest.mark.parametrize("one", [one for one in COMMANDS if one.program == "make"], ids=str)
def test_a_target_is_there(one: Shown) -> None:
    assert recipe(one)


def recipe(one: Shown) -> list[str]:
    """The lines of a target of make, without setup."""
    own = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MAKELEVEL")}
    done = subprocess.run([*one.words, "--dry-run"], cwd=paths.root, env=own, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.replace("\\\n", " ").splitlines()
    return [line for line in lines if line and "tools/setup.sh" not in line]


@pytest.mark.parametrize("one", [one for one in TARGETS.values() if not {*one.words} & {*LONG}], ids=str)
@pytest.mark.first
def test_a_recipe_of_the_readme_runs(one: Shown) -> None:
    """As a newcomer runs it: the demonstration on both engines, the page, the list of targets."""
    assert not any("pytest" in line for line in recipe(one)), "this test would run itself"
    for line in recipe(one):
        done = subprocess.run(
            ["bash", "-euc", line], cwd=paths.root, env=environment(), capture_output=True, text=True
        )
        assert done.returncode == 0 and done.stdout, f"{line}: {done.stdout}{done.stderr}"


@pytest.mark.sample(8)
@pytest.mark.parametrize(
    "one", [one for one in COMMANDS if one.program != "make" and not begins(one)], ids=str
)
def test_a_command_runs(one: Shown, tmp_path: Path) -> None:
    """In a folder with the examples of the repository."""
    if any(word in NOT_RUN for word in one.words):
        words = one.words[1 : one.words.index("<")] if "<" in one.words else one.words[1:]
        if len(words) == 1:  # in a text
            with pytest.raises(SystemExit, match=r"^0$"):
                cli._parser().parse_args([*words, "--help"])
        else:
            cli._parser().parse_args(words)
        return
    if one.program == "passo":
        done = run(one, tmp_path)
    else:
        done = subprocess.run(
            ["bash", "-euc", one.command], cwd=paths.root, env=environment(), capture_output=True, text=True
        )
    assert done.returncode == 0, done.stdout + done.stderr
