# SPDX-License-Identifier: MIT
"""Mutants of the C sources: drawn evenly from each file, all of them in a copy of the folders."""

import json
import random
import shutil
from collections import Counter
from collections.abc import Collection
from dataclasses import asdict, dataclass
from pathlib import Path

from passo.compiler import headers, sources
from passo.output import write_json
from passo.toolchain import paths

from verify.mutants.c_mutate import CHOICE, Change, changes, code, mutated
from verify.mutants.fates import BUILD, hash_of

FOLDERS = {"driver": paths.driver, "planner": paths.planner, "gcode": paths.gcode}
FOLDER = BUILD / "c"


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


def _draw(source: Path, seed: int, count: int) -> list[tuple[int, int, Change]]:
    """Draw changes of a file: their places in it, and among their kind in their function."""
    seen: Counter[tuple[str, str]] = Counter()
    found = []
    for place, change in enumerate(changes(source, _headers())):
        of = change.function, change.kind
        found.append((place, seen[of], change))
        seen[of] += 1
    random.Random(f"{seed}/{source.name}").shuffle(found)
    return found[:count]


def drawn(
    seed: int, count: int, root: Path = FOLDER, only: Collection[str] = ()
) -> tuple[list[CMutant], str]:
    """About `count` mutants, from each file as its length is, or from some; and what identifies them.

    The folders with them are below `root`.
    """
    files = [file for file in sources(*FOLDERS.values()) if not only or file.name in only]
    hashed = hash_of(
        [*files, *headers(*_headers()), Path(__file__).with_name("c_mutate.py")], f"{seed} {count}"
    )
    kept = root / "mutants.json"
    stored = json.loads(kept.read_text()) if kept.exists() else {}
    if stored.get("hash") == hashed:
        return [CMutant(**mutant) for mutant in stored["mutants"]], hashed
    shutil.rmtree(root, ignore_errors=True)
    root.mkdir(parents=True)
    mutants: list[CMutant] = []
    lines = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    for name, folder in FOLDERS.items():
        made = root / name
        made.mkdir()
        for header in headers(folder):
            shutil.copy(header, made / header.name)
        (made / f"passo_{name}_mutants.c").write_text(CHOICE, encoding="utf-8")
        for file in sources(folder):
            if file not in files:
                shutil.copy(file, made / file.name)
                continue
            share = max(2, round(count * lines[file] / sum(lines.values())))
            source = hash_of([], code(file, _headers()))
            chosen: dict[int, int] = {}
            for place, ordinal, change in _draw(file, seed, share):
                mutant = CMutant(
                    *(len(mutants) + 1, file.name, place, change.line),
                    *(change.function, change.kind, ordinal, change.text, source),
                )
                chosen[place] = mutant.number
                mutants.append(mutant)
            (made / file.name).write_text(mutated(file, _headers(), chosen), encoding="utf-8")
    write_json({"hash": hashed, "mutants": [asdict(mutant) for mutant in mutants]}, kept)
    return mutants, hashed
