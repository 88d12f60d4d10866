# SPDX-License-Identifier: MIT
"""Check the words of documents and code: American spelling, and phrases that the project does not use.

    tools/lint_prose.py [FILE...]

Without FILE it reads the pages and sources listed in tools/prose.toml, which also has the words that the
dictionary lacks and the banned phrases. In pages it skips code, links, comments and names (capitals inside,
digits, underscores). In code it looks for the phrases only, in comments and strings; a string without a space
is a name.
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
# Comments and strings. The marks at their ends, and at the beginning of a line, are no part of a phrase.
_STRING = r'"(?:\\.|[^"\\])*"'
_QUOTED = r"'[^'\n]*'"
_HASH = re.compile(rf'"""(?:\\.|[^\\])*?"""|{_STRING}|{_QUOTED}|#[^\n]*', re.S)
_SLASH = re.compile(rf"//[^\n]*|/\*.*?\*/|{_STRING}|'\\\\?.'", re.S)
_TICKS = re.compile(rf"{_SLASH.pattern}|`[^`]*`", re.S)
_MARKS = re.compile(r"^\s*(?:/?\*+|//|#)|\\n|[\"`]|\*/$", re.M)
_KINDS = {
    **dict.fromkeys((".py", ".toml", ".sh", "Makefile"), _HASH),
    **dict.fromkeys((".c", ".cpp", ".h", ".rdl", ".v", ".vh"), _SLASH),
    ".js": _TICKS,
}
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


def sources() -> list[Path]:
    """The code that `make lint` checks."""
    named = (path for name in rules()["sources"] for path in ROOT.glob(name))
    found = (file for path in named for file in (path.rglob("*") if path.is_dir() else [path]))
    skipped = {ROOT / name for name in rules()["skipped"]}
    return sorted(
        file
        for file in found
        if (file.suffix or file.name) in _KINDS and skipped.isdisjoint((file, *file.parents))
    )


def prose(text: str) -> str:
    """The text with everything else blanked out; lines and columns stay."""
    return _CODE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def comments(text: str, kind: str) -> str:
    """Comments and strings of code, with a bar for each other character; lines and columns stay."""

    def bare(found: re.Match[str]) -> str:
        whole = found[0]
        if re.fullmatch(r"[\"'`]\S*", whole):
            return re.sub(r"\S", "|", whole)
        if whole[0] != "`":
            whole = re.sub(r"`[^`\n]*`", lambda code: "|" * len(code[0]), whole)
        return _MARKS.sub(lambda mark: re.sub(r"\S", " ", mark[0]), whole)

    kept, end = [], 0
    for found in _KINDS[kind].finditer(text):
        kept += re.sub(r"\S", "|", text[end : found.start()]), bare(found)
        end = found.end()
    return "".join((*kept, re.sub(r"\S", "|", text[end:])))


@cache
def _pattern(phrase: str, gap: str = r"\s+") -> re.Pattern[str]:
    """`gap` is what may be between words."""
    return re.compile(rf"(?<![\w-])(?:{phrase})(?![\w-])".replace(" ", gap), re.I)


@cache
def _any_phrase() -> re.Pattern[str]:
    """Finds at least all that _phrases() finds in comments, in the code as it is."""
    return _pattern("|".join(rule["phrase"] for rule in rules()["banned"]), r"\W+")


def _phrases(words: str, of_code: bool) -> Iterator[tuple[int, str]]:
    for rule in rules()["banned"]:
        if of_code or not rule.get("code_only"):
            for phrase in _pattern(rule["phrase"]).finditer(words):
                yield phrase.start(), f"'{' '.join(phrase[0].split())}': write {rule['write']}"


def _spelling(words: str) -> Iterator[tuple[int, str]]:
    for word in _WORD.finditer(words):
        if len(word[0]) > 1 and not _is_known(word[0]):
            yield word.start(), f"'{word[0]}' is neither American English nor in {RULES.name}"


def objections(text: str, kind: str = ".md") -> Iterator[tuple[int, str]]:
    """Line numbers and messages. `kind` is the suffix of the file, or its name without one."""
    found: list[tuple[int, str]] = []
    if kind not in _KINDS:
        words = prose(text)
        found = [*_spelling(words), *_phrases(words, of_code=False)]
    elif _any_phrase().search(text):  # quick, and most sources have none
        found = [*_phrases(comments(text, kind), of_code=True)]
    for at, message in sorted(found):
        yield text.count("\n", 0, at) + 1, message


def main(arguments: Sequence[str]) -> int:
    """Print all objections; 1 if there is any."""
    status = 0
    for file in map(Path, arguments or (*pages(), *sources())):
        for line, message in objections(file.read_text(encoding="utf-8"), file.suffix or file.name):
            print(f"{file.relative_to(ROOT) if file.is_relative_to(ROOT) else file}:{line}: {message}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
