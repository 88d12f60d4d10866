# SPDX-License-Identifier: MIT
"""The check of the documents' words in `make lint` sees planted mistakes, and only those."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from passo.toolchain import paths

sys.path.insert(0, str(paths.tools))
import lint_prose

PAGE = "The core steps each axis.\n\nAn edge {} comes.\n"
GOOD = ("of STEP", "`at once`", "[here](colour.md)", "of passo_core", "<!-- colour -->", "of Passo's grbl")
BAD = (
    *("of a new colour", "of the synchroniser", "that recieves", "of verilog"),
    *("at\nonce", "At once", "that goes red"),
)


@pytest.mark.parametrize("words", GOOD)
def test_prose_without_mistakes(words: str) -> None:
    assert list(lint_prose.objections(PAGE.format(words))) == []


@pytest.mark.parametrize("words", BAD)
def test_planted_mistake(words: str) -> None:
    ((line, message),) = lint_prose.objections(PAGE.format(words))
    assert line == 3 and message


CODE = (
    (".py", '"""It acts\nat once."""'),
    (".py", "x = 1  # it acts at once"),
    (".py", "print(f'it acts at once')"),
    (".c", "/* it acts at\n * once */"),
    (".c", 'puts("it acts at "\n     "once more");'),
    (".vh", "// it acts at\n// once"),
    (".v", '$display("at once");'),
    (".rdl", 'desc = "It acts\n at once.";'),
    (".js", "`${what} acts at once`"),
    (".toml", "# it acts at once"),
    (".sh", "# the colour"),
    ("Makefile", "\t@echo 'it acts at once'"),
)
NAMES = (
    (".c", "at(once);"),
    (".c", "at = 1, once = 2; /* at */ once(); /* once */"),
    (".c", 'enum { wants }; #include "poke.h"'),
    (".py", "at = 'at', once"),
    (".py", "# what `at once` means"),
    (".py", "# that recieves"),  # the dictionary is for pages
    (".v", "wire at; // at\nwire once;"),
)


@pytest.mark.parametrize(("kind", "text"), CODE)
def test_phrase_in_a_comment_or_a_string(kind: str, text: str) -> None:
    ((line, message),) = lint_prose.objections(f"\n\n{text}\n", kind)
    assert line == 3 + ("\nat" in text) + ("\n at" in text) and "write" in message


@pytest.mark.parametrize(("kind", "text"), NAMES)
def test_names_in_code(kind: str, text: str) -> None:
    assert list(lint_prose.objections(text, kind)) == []


def test_sources_are_those_of_the_project() -> None:
    """All that git knows of these kinds, but those that are skipped."""
    kinds = ("*.py", "*.[chv]", "*.cpp", "*.vh", "*.rdl", "*.js", "*.toml", "*.sh", "*Makefile")
    command = ["git", "-C", paths.root, "ls-files", *kinds]
    known = {paths.root / name for name in subprocess.check_output(command, text=True).split()}
    skipped = [paths.root / name for name in lint_prose.rules()["skipped"]]
    read = set(lint_prose.sources())
    missing = {file for file in known - read if not any(file.is_relative_to(each) for each in skipped)}
    assert {file.relative_to(paths.root).as_posix() for file in missing} == {"pyproject.toml"}


def test_code_blocks_keep_the_lines() -> None:
    ((line, _),) = lint_prose.objections("```\ncolour at once\n```\n\nThe colour.\n")
    assert line == 5


@pytest.mark.parametrize("rule", lint_prose.rules()["banned"], ids=lambda rule: rule["phrase"])
def test_every_banned_phrase_is_a_pattern(rule: dict[str, str]) -> None:
    assert re.compile(rule["phrase"]) and rule["write"]


def test_make_lint_fails(tmp_path: Path) -> None:
    """Its recipe calls the check, which fails for a listed page with a planted word."""
    recipe = re.search(r"^lint: .*?\n\n", (paths.root / "Makefile").read_text(), re.M | re.S)
    assert recipe and "\n\t@$(CHECK) prose $(BIN)/python tools/lint_prose.py\n" in recipe[0]
    (tmp_path / "tools").mkdir()
    for name in ("lint_prose.py", "prose.toml"):
        shutil.copy(paths.tools / name, tmp_path / "tools")
    listed = lint_prose.pages()
    assert listed
    for page in listed:
        copy = tmp_path / page.relative_to(paths.root)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(page, copy)
    command = [sys.executable, tmp_path / "tools" / "lint_prose.py"]
    assert subprocess.run(command).returncode == 0
    source = tmp_path / "rtl" / "planted.v"
    source.parent.mkdir()
    source.write_text("// It acts at once.\n")
    with copy.open("a") as page:
        page.write("\nThe colour changes.\n")
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1 and "'colour'" in done.stdout and copy.name in done.stdout
    assert "rtl/planted.v:1: 'at once'" in done.stdout
