# SPDX-License-Identifier: MIT
"""The commands that README and documents show, and a folder to run them in.

In blocks of shell, each command of a line; in README and tutorial also those in the text.
"""

import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from passo.toolchain import environment, paths

PAGES = (paths.root / "README.md", *sorted(paths.docs.glob("*.md")))
TUTORIAL = paths.docs / "tutorial.md"
BLOCKS = re.compile(r"^```(\w*)\n(.*?)^```", re.S | re.M)
COMMENT = re.compile(r"(?:^|\s)#.*", re.M)
NEXT = re.compile(r"\n|&&|&")  # between two commands
PROGRAMS = ("passo", "make", "pip", "python", "sh", "source", "gtkwave", "docker", "tools/setup.sh")
IN_TEXT = re.compile(rf"`((?:\.venv/bin/)?(?:{'|'.join(PROGRAMS)})(?: [^`]+)?)`")
LINES = "help\n"  # for the console


@dataclass(frozen=True)
class Shown:
    """A command of a page, and the move file before it, or that of the tutorial."""

    page: Path
    command: str
    moves: str

    def __str__(self) -> str:
        return f"{self.page.stem}: {self.command}"

    @property
    def words(self) -> list[str]:
        """Of the command."""
        return shlex.split(self.command.removeprefix(".venv/bin/"))

    @property
    def program(self) -> str:
        """Its first word."""
        return self.words[0]


def shown(pages: tuple[Path, ...] = PAGES, in_text: bool = False) -> list[Shown]:
    """Of the blocks of these pages, and of their text if asked for; what a page shows twice is one."""
    (tutorial,) = (text for kind, text in BLOCKS.findall(TUTORIAL.read_text()) if kind == "toml")
    found = []
    for page in pages:
        moves, whole = tutorial, page.read_text(encoding="utf-8")
        for kind, text in BLOCKS.findall(whole):
            if kind == "toml" and "[[move]]" in text and "clock_hz" in text:
                moves = text
            elif kind == "sh":
                found += [Shown(page, one.strip(), moves) for one in NEXT.split(COMMENT.sub("", text))]
        if in_text:
            found += [Shown(page, one, moves) for one in IN_TEXT.findall(BLOCKS.sub("", whole))]
    return list({str(one): one for one in found if one.command}.values())


def run(one: Shown, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command of `passo` in an empty folder, with the examples of the repository."""
    (folder / "examples").symlink_to(paths.examples)
    (folder / "moves.toml").write_text(one.moves)
    (folder / "lines.txt").write_text(LINES)
    program = Path(sys.executable).with_name("passo")
    line = one.command.removeprefix(".venv/bin/").replace("passo", str(program), 1)
    return subprocess.run(
        ["sh", "-c", line],
        cwd=folder,
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
