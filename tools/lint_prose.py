# SPDX-License-Identifier: MIT
"""Check the words of the documents: American spelling, and phrases that the project does not use.

    tools/lint_prose.py [PAGE...]

Without PAGE it reads the pages listed in tools/prose.toml, which also has the words that the dictionary lacks
and the banned phrases. Code, links, comments and names (capitals inside, digits, underscores) are skipped.
"""

import re
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from spylls.hunspell import Dictionary

ROOT = Path(__file__).resolve().parent.parent
RULES = ROOT / "tools" / "prose.toml"

# What is not prose: blocks of code, comments, code in sentences, targets of links, addresses.
_CODE = re.compile(
    r"^```.*?^```|<!--.*?-->|`[^`]*`|(?<=\])\([^)]*\)|<?https?://\S+|<[a-z/][^>]*>", re.M | re.S
)
_WORD = re.compile(r"(?<![\w'’/.])[A-Za-z]?[a-z]+(?:['’][a-z]+)?(?![\w/]|\.\w)")


@cache
def rules() -> Mapping[str, Any]:
    """The lists of tools/prose.toml."""
    return tomllib.loads(RULES.read_text(encoding="utf-8"))


@cache
def _dictionary() -> Dictionary:
    return Dictionary.from_files("en_US")


@cache
def _is_known(word: str) -> bool:
    base = re.sub(r"['’]s$", "", word)
    small = base[0].lower() + base[1:]
    forms = {base, base.removesuffix("s"), small, small.removesuffix("s")}
    return not forms.isdisjoint(rules()["words"]) or _dictionary().lookup(base)


def pages() -> list[Path]:
    """The pages that `make lint` checks."""
    return sorted({path for name in rules()["pages"] for path in ROOT.glob(name)})


def prose(text: str) -> str:
    """The text with everything else blanked out; lines and columns stay."""
    return _CODE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def objections(text: str) -> Iterator[tuple[int, str]]:
    """Line numbers and messages."""
    words = prose(text)
    found = []
    for word in _WORD.finditer(words):
        if len(word[0]) > 1 and not _is_known(word[0]):
            found.append((word.start(), f"'{word[0]}' is neither American English nor in {RULES.name}"))
    for rule in rules()["banned"]:
        pattern = rf"(?<![\w-])(?:{rule['phrase']})(?![\w-])".replace(" ", r"\s+")
        for phrase in re.finditer(pattern, words, re.I):
            shown = " ".join(phrase[0].split())
            found.append((phrase.start(), f"'{shown}': write {rule['write']}"))
    for at, message in sorted(found):
        yield text.count("\n", 0, at) + 1, message


def main(arguments: Sequence[str]) -> int:
    """Print all objections; 1 if there is any."""
    status = 0
    for page in map(Path, arguments or pages()):
        for line, message in objections(page.read_text(encoding="utf-8")):
            print(f"{page.relative_to(ROOT) if page.is_relative_to(ROOT) else page}:{line}: {message}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
