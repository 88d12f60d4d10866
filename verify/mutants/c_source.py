# SPDX-License-Identifier: MIT
"""Mutants of the C sources: drawn evenly from each file, all of them in a copy of the folders."""

import json
import random
import shutil
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from passo.compiler import headers, sources
from passo.output import write_json
from passo.toolchain import paths

from verify.mutants.c_mutate import CHOICE, Change, Parsed, preprocessed
from verify.mutants.fates import BUILD, hash_of

FOLDERS = {
    **{"driver": paths.driver, "planner": paths.planner, "gcode": paths.gcode},
    **{"console": paths.console, "grbl": paths.grbl, "linux": paths.linux},
}
# What the parser cannot read: a list of any arguments, and the kernel's headers.
UNREAD = ("passo_say.c", "passo_linux.c", "passo_linux_socket.c", "passo_linux_spi.c")
FOLDER = BUILD / "c"
NUMBERS = 1000  # for each file: more than it has mutants


@dataclass(frozen=True)
class CMutant:
    """A mutant of a C source."""

    number: int
    file: str
    place: int  # among all changes of the file
    line: int
    function: str
    kind: str
    ordinal: int  # among those of its kind in its function
    says: str
    source: str  # identifies the code of the file and of what it includes

    @property
    def module(self) -> str:
        """The file."""
        return self.file

    @property
    def name(self) -> str:
        """The same as long as the function is."""
        return f"{self.file} {self.function} {self.kind} {self.ordinal}"


def _headers() -> list[Path]:
    return [paths.protocol, *FOLDERS.values()]


def _draw(found: Sequence[Change], name: str, seed: int, count: int) -> list[tuple[int, int, Change]]:
    """Draw changes of a file: their places in it, and among their kind in their function."""
    seen: Counter[tuple[str, str]] = Counter()
    places = []
    for place, change in enumerate(found):
        of = change.function, change.kind
        places.append((place, seen[of], change))
        seen[of] += 1
    random.Random(f"{seed}/{name}").shuffle(places)
    return places[:count]


def _mutate(file: Path, made: Path, seed: int, share: int, first: int) -> list[CMutant]:
    """Make a copy with mutants, unless there is one of the same source; they are kept beside it."""
    text = preprocessed(file, _headers())
    key = hash_of([Path(__file__).with_name("c_mutate.py")], text, f"{seed} {share} {first}")
    kept = made.with_suffix(".json")
    stored = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() and made.exists() else {}
    if stored.get("key") == key:
        return [CMutant(**mutant) for mutant in stored["mutants"]]
    parsed = Parsed(file, text)
    source = hash_of([], parsed.code)
    mutants = [
        CMutant(
            *(first + i, file.name, place, change.line, change.function, change.kind, ordinal),
            *(change.text, source),
        )
        for i, (place, ordinal, change) in enumerate(_draw(parsed.changes(), file.name, seed, share))
    ]
    kept.unlink(missing_ok=True)
    made.write_text(parsed.mutated({mutant.place: mutant.number for mutant in mutants}), encoding="utf-8")
    write_json({"key": key, "mutants": [asdict(mutant) for mutant in mutants]}, kept)
    return mutants


def drawn(
    seed: int, count: int, root: Path = FOLDER, only: Collection[str] = ()
) -> tuple[list[CMutant], str]:
    """About `count` mutants, from each file as its length is, or from some; and what identifies them.

    The folders with them are below `root`; what is there of the same sources is used.
    """
    files = [
        file
        for file in sources(*FOLDERS.values())
        if file.name not in UNREAD and (not only or file.name in only)
    ]
    mutants: list[CMutant] = []
    lines = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    for name, folder in FOLDERS.items():
        made = root / name
        made.mkdir(parents=True, exist_ok=True)
        for old in (*sources(made), *headers(made)):
            if not (folder / old.name).exists():
                old.unlink()
        for header in headers(folder):
            shutil.copy(header, made / header.name)
        (made / f"passo_{name}_mutants.c").write_text(CHOICE, encoding="utf-8")
        for file in sources(folder):
            if file in files:
                share = max(2, round(count * lines[file] / sum(lines.values())))
                first = 1 + NUMBERS * files.index(file)
                mutants += _mutate(file, made / file.name, seed, share, first)
            else:
                shutil.copy(file, made / file.name)
    return mutants, hash_of([], *(repr(mutant) for mutant in mutants))
