# SPDX-License-Identifier: MIT
"""What README.md and docs/ print is typed here as printed there."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from passo.build import waves_possible
from passo.cli import _parser
from passo.toolchain import paths

README, TUTORIAL, PLANNING = paths.root / "README.md", paths.docs / "tutorial.md", paths.docs / "planning.md"
PAGES = [README, paths.root / "CONTRIBUTING.md", *sorted(paths.docs.rglob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), re.M | re.S)
    return [text for own, text in found if own == language]


def shell(folder: Path, command: str, stdin: str = "") -> str:
    """Type it in a folder, in the environment that README.md names; it has to succeed."""
    (folder / ".venv").symlink_to(paths.root / ".venv")
    done = subprocess.run(
        ["bash", "-c", f"source .venv/bin/activate && {command}"],
        cwd=folder, input=stdin, text=True, capture_output=True, timeout=500,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.skipif(not waves_possible(), reason="liblz4-dev and zlib1g-dev are not installed")
def test_the_moves_of_the_tutorial(tmp_path: Path) -> None:
    (moves,) = blocks(TUTORIAL, "toml")
    (tmp_path / "moves.toml").write_text(moves)
    (command,) = [block for block in blocks(TUTORIAL, "sh") if "passo run" in block]
    said = shell(tmp_path, command)
    assert "edges agree" in said and "gtkwave out/waves.gtkw" in said and "open: out/motion.png" in said
    for name in ("pulses.csv", "summary.json", "motion.png", "report.html", "waves.fst", "waves.gtkw"):
        assert f"out/{name}" in TUTORIAL.read_text()
        assert (tmp_path / "out" / name).stat().st_size > 0
    assert (tmp_path / "out" / "waves.fst").stat().st_size < 2_000_000


def test_the_session_of_the_readme(tmp_path: Path) -> None:
    (session,) = [block for block in blocks(README, "") if block.startswith("enable\n")]
    said = shell(tmp_path, "passo console --engine model --echo", session)
    answers = [line for line in said.splitlines() if line.startswith(("ok", "error"))]
    assert answers == ["ok"] * len(session.splitlines())


def test_the_moves_of_the_planning(tmp_path: Path) -> None:
    """Each is run, after the table of its own shape has been made."""
    (command,) = [block for block in blocks(PLANNING, "sh") if block.startswith("passo shape")]
    moves = blocks(PLANNING, "toml")
    assert len(moves) == 11
    for number, text in enumerate(moves):
        clock = "" if "clock_hz" in text else "clock_hz = 4_000_000\n"  # a whole file, or a move
        (tmp_path / f"move{number}.toml").write_text(clock + text)
    runs = "".join(f"passo run --engine model move{number}.toml --out out{number}\n" for number in range(11))
    assert shell(tmp_path, f"set -e\n{command}{runs}").count(" clocks (") == 11
    assert (tmp_path / "my.png").exists()


def commands(page: Path) -> set[str]:
    """The lines of blocks, and the code in sentences, that call `passo`."""
    text = page.read_text()
    code = "".join(body for _, body in re.findall(r"^```(sh|)\n(.*?)^```", text, re.M | re.S))
    lines = re.findall(r"^(?:\.venv/bin/)?(passo [a-z-].*?)(?: *#.*)?$", code, re.M)
    return {*lines, *re.findall(r"`(?:\.venv/bin/)?(passo [^`]+)`", text)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_exist(page: Path) -> None:
    """With these options; a name without its arguments is one of a subcommand."""
    for command in commands(page):
        words = shlex.split(command.split(" < ")[0])[1:]
        if len(words) == 1:
            words.append("--help")
        elif words[0] == "run" and not any(word.endswith((".toml", ".nc")) for word in words):
            words.insert(1, "moves.toml")
        try:
            _parser().parse_args(words)
        except SystemExit as status:
            assert status.code == 0, command


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_make_targets_exist(page: Path) -> None:
    targets = set(re.findall(r"^([a-z-]+):", (paths.root / "Makefile").read_text(), re.M))
    named = re.findall(r"(?:^|`)make ([a-z][a-z-]+)", page.read_text(), re.M)
    assert set(named) <= targets


def test_help_imports_nothing_heavy() -> None:
    """`passo --help` answers immediately."""
    code = (
        "import sys; from passo import cli\ntry: cli.main(['--help'])\nexcept SystemExit: print(*sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    modules = set(done.stdout.splitlines()[-1].split())
    assert "passo.cli" in modules
    heavy = {"numpy", "matplotlib", "rich", "cffi", "unicorn", "passo.registers", "passo.native"}
    assert not modules & heavy
