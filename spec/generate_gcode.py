# SPDX-License-Identifier: MIT
"""Generate what docs say of G-code: from spec/gcode_differences.toml what lines mean elsewhere, from the
interpreter and the build options of the firmware which image takes which word, and the errors."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

from generated import is_check, keep
from passo.expand.refusals import ADVICE, LETTER_ERRORS, LETTERS

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "spec" / "gcode_differences.toml"
PAGE = "docs/reference/gcode_differences.md"
HEAD = """# G-code: differences

Generated from `spec/gcode_differences.toml` by `spec/generate_gcode.py`.

What the last line of each program does on Passo, grbl 1.1 and LinuxCNC 2.9. `same`: as on Passo; `other`:
moves, but elsewhere or at another feed; a number is the [error](../gcode.md#errors). `make gcode-peer`
compares Passo and LinuxCNC.

| program | Passo | grbl 1.1 | LinuxCNC | |
|---|---|---|---|---|
"""

REFUSED = """
## Refused words

By the error of a firmware with all words; others say 20 for what they lack. `passo run`, `passo preview` and
`passo expand` say norm and advice themselves.

| error | word | norm | what to do |
|---:|---|---|---|
"""
TABLES = "docs/gcode.md"
BEGIN, END = "<!-- report: make generate writes {} from here -->\n", "<!-- to here -->"
# Images, as the makefile of the firmware calls them; what is left out on the PC: nothing.
IMAGES = {
    "console C8": (),
    "grbl C8": ("GRBL=1",),
    "grbl CB": ("CHIP=cb", "GRBL=1"),
    "both CB": ("CHIP=cb",),
}
PC = "PC"
EXPANDED = ("G41", "G41.1", "G42", "G42.1", "M98", "M99", "O", "#", "[")  # by passo expand and passo run
MARKS = {True: "x", False: ""}
SOURCE_OF_WORDS = "c_model/gcode/passo_gcode_block.c"
ERRORS = Path("c_model/gcode/passo_gcode_error")


def options_of(image: tuple[str, ...]) -> list[str]:
    """Options that leave words out, and the folder of the interpreter, if it is in the image."""
    command = ["make", "-s", "-C", "stm32_bridge/firmware", "options", *image]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()


def preprocessed(text: str, defined: set[str]) -> str:
    """The lines of a source that are compiled; its conditions are #ifdef and #ifndef."""
    kept, conditions = [], []
    for line in text.splitlines():
        if opens := re.match(r"#if(n?)def (\w+)", line):
            conditions.append((opens[2] in defined) != bool(opens[1]))
        elif line.startswith("#else"):
            conditions[-1] = not conditions[-1]
        elif line.startswith("#endif"):
            conditions.pop()
        elif line.startswith("#if"):
            raise ValueError(f"{SOURCE_OF_WORDS}: {line}")
        elif all(conditions):
            kept.append(line)
    return "\n".join(kept)


def words_with(options: list[str]) -> list[str]:
    """The commands of an interpreter compiled with these options, then its letters."""
    defined = dict((f"{option[2:]}=1".split("=")[:2]) for option in options if option.startswith("-D"))
    text = preprocessed((ROOT / SOURCE_OF_WORDS).read_text(encoding="utf-8"), set(defined))
    g, m = text.split("M_CODES[] = {")
    commands = [
        f"{letter}{int(tenths) / 10:g}"
        for letter, table in (("G", g), ("M", m))
        for tenths in re.findall(r"\{(\d+), PASSO_GCODE_", table)
    ]
    axes = re.search(r'AXIS_LETTERS\[.*\] = "(\w+)"', text)[1]
    axes = axes[: int(defined.get("PASSO_PATH_AXES_MAX", "8").rstrip("u"))]
    letters = dict.fromkeys(re.findall(r"PASSO_GCODE_WORD\('(\w)'\)", text))
    return [*commands, *axes, *letters]


def words_of_images() -> dict[str, list[str]]:
    """What each image takes, and the PC."""
    found = {}
    for name, image in IMAGES.items():
        options = options_of(image)
        found[name] = words_with(options) if any(not option.startswith("-") for option in options) else []
    return found | {PC: [*words_with([]), *EXPANDED]}


def image_table() -> str:
    """A row for all words that the same images take."""
    found = words_of_images()
    rows: dict[tuple[bool, ...], list[str]] = {}
    for word in found[PC]:
        rows.setdefault(tuple(word in words for words in found.values()), []).append(f"`{word}`")
    head = f"| word | {' | '.join(found)} |\n|---|{':-:|' * len(found)}\n"
    return head + "".join(
        f"| {' '.join(words)} | {' | '.join(map(MARKS.get, takes))} |\n" for takes, words in rows.items()
    )


def error_table() -> str:
    """The message of each error."""
    header = (ROOT / ERRORS).with_suffix(".h").read_text(encoding="utf-8")
    source = (ROOT / ERRORS).with_suffix(".c").read_text(encoding="utf-8")
    numbers = {name: int(number) for name, number in re.findall(r"PASSO_GCODE_(\w+) = (\d+)", header)}
    texts = dict(re.findall(r'case PASSO_GCODE_(\w+):\s+return "([^"]*)";', source))
    rows = sorted((number, texts[name]) for name, number in numbers.items() if number)
    return "| error | |\n|---:|---|\n" + "".join(f"| {number} | {text} |\n" for number, text in rows)


def write_tables() -> str:
    """The page with both."""
    page = (ROOT / TABLES).read_text(encoding="utf-8")
    for name, table in (("words", image_table()), ("errors", error_table())):
        head, begin, rest = page.partition(BEGIN.format(name))
        page = head + begin + table + rest[rest.index(END) :]
    return page


def write_page() -> str:
    """A row for each program."""
    rows = tomllib.loads(SOURCE.read_text(encoding="utf-8"))["rows"]
    lines = [(" ".join(f"`{line}`" for line in program), *told) for program, *told in rows]
    return HEAD + "".join(f"| {' | '.join(row)} |\n" for row in lines) + REFUSED + refused_rows()


def refused_rows() -> str:
    """What passo.expand.refusals says."""
    rows = []
    for letter, codes, error, norm, advice in ADVICE:
        whole = 1 if letter == "G" else 10  # M has no tenths
        ends = dict.fromkeys(code // whole * whole for code in (codes.start, codes.stop - 1))
        words = [f"`{letter}{code / 10:g}`" for code in ends]
        rows.append((error, " to ".join(words), norm, advice))
    for letter, told in LETTERS.items():
        norm, advice = told.split(": ", 1)
        rows.append((LETTER_ERRORS[letter], f"`{letter}`", norm, advice))
    rows.sort(key=lambda row: row[0])
    return "".join(f"| {' | '.join(map(str, row))} |\n" for row in rows)


if __name__ == "__main__":
    sys.exit(keep(ROOT, {PAGE: write_page(), TABLES: write_tables()}, is_check(__doc__)))
