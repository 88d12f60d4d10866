# SPDX-License-Identifier: MIT
"""The fates of the mutants: kept in build/mutants/, so a run continues where the last one ended."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from passo.output import write_json
from passo.toolchain import paths

BUILD = paths.build / "mutants"


@dataclass
class Fate:
    """Of one mutant: who killed it, in which case; or why it is no fault; else it lives."""

    killed: str = ""  # the judge and the case that it needs to see it again
    says: str = ""  # what is broken, in the judge's words
    equal: str = ""  # how it was proved to be no fault
    tried: list[str] | None = None  # the cases that it has survived

    @property
    def lives(self) -> bool:
        """No judge has seen it, and it may be a fault."""
        return not self.killed and not self.equal

    def waits(self, case: str) -> bool:
        """It lives, and has not been tried in this case."""
        return self.lives and case not in (self.tried or [])


def hash_of(files: Iterable[Path], *more: str) -> str:
    """Of the contents of files, and texts."""
    digest = hashlib.sha256(repr(more).encode())
    for file in files:
        digest.update(f"\0{file.name}\0".encode() + file.read_bytes())
    return digest.hexdigest()[:12]


class Fates:
    """The fates of mutants, by name; `judges` identifies the sources and the judges."""

    def __init__(self, kind: str, judges: str, again: bool = True):
        self.path = BUILD / f"{kind}.json"
        self.judges = judges
        stored = (
            json.loads(self.path.read_text(encoding="utf-8"))
            if self.path.exists()
            else {"judges": judges, "fates": {}}
        )
        # what other judges have not seen, these may see; what they have seen is to be seen again
        self.other = again and stored["judges"] != judges
        self.of = {name: Fate(**fate) for name, fate in stored["fates"].items()}
        if self.other:
            for fate in self.of.values():
                # a proof that is another one has another name
                fate.tried = [case for case in fate.tried or [] if case.startswith("proof ")]

    def get(self, name: str) -> Fate:
        """Of a mutant."""
        return self.of.setdefault(name, Fate(tried=[]))

    def save(self) -> None:
        """Write the file, which appears only when it is complete."""
        BUILD.mkdir(parents=True, exist_ok=True)
        fates = {name: asdict(fate) for name, fate in self.of.items()}
        write_json({"judges": self.judges, "fates": fates}, self.path)
