# SPDX-License-Identifier: MIT
"""The defects in defects.toml: each is planted in a copy of the sources and must be caught."""

import re
import shutil
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from passo.failure import BuildError
from passo.planted import plant

from verify.soak.parts import chunks, console
from verify.soak.program import (
    BUILD,
    DRIVER_KINDS,
    FOLDERS,
    HERE,
    Failure,
    build,
    build_endings,
    play_program,
)


@dataclass(frozen=True)
class Defect:
    """A known defect: description, edits that plant it, and the pattern of the failure it must cause."""

    name: str
    says: str
    edits: tuple[tuple[str, str, str], ...]  # file, old, new
    red: str  # regular expression
    driver: bool = False
    kind: str = ""  # of the history, one of KINDS or DRIVER_KINDS
    blind: bool = False  # the rate is judged by the steps alone
    histories: int = 20_000  # within which it must be caught

    def folder(self) -> Path:
        """Folder of its copy of the sources."""
        return BUILD / "defects" / self.name


@dataclass(frozen=True)
class Catch:
    """Result of a defect."""

    defect: Defect
    good: bool
    history: int  # the one that failed; -1: none
    seconds: float
    says: str


def defects() -> list[Defect]:
    """Read defects.toml."""
    found = []
    for entry in tomllib.loads((HERE / "defects.toml").read_text(encoding="utf-8"))["defect"]:
        if other := entry.pop("edits_of", None):
            edits = next(defect.edits for defect in found if defect.name == other)
        else:
            edits = tuple((edit["file"], edit["old"], edit["new"]) for edit in entry.pop("edit"))
        found.append(Defect(edits=edits, **entry))
    return found


def _play(defect: Defect, root: Path, seed: int) -> list[Failure]:
    """Build what the defect is planted in; the first failures of its histories."""
    if defect.kind in DRIVER_KINDS:
        program = build_endings(root, root / "program")
        for first, count in chunks(defect.histories):
            command = [program, defect.kind, str(seed), str(first), str(count)]
            if failures := play_program(command, defect.name, seed)[1]:
                return failures
        return []
    program = build(root, root / "program")
    command = [program, str(seed), "0", str(defect.histories), *(["--driver"] if defect.driver else [])]
    command += ["--blind"] if defect.blind else []
    command += [f"--{defect.kind}"] if defect.kind else []
    return play_program(command, defect.name, seed)[1]


def catch(defect: Defect, seed: int) -> Catch:
    """Plant the defect in a copy of the sources; a history must fail with its pattern."""
    began = time.monotonic()
    root = defect.folder()
    shutil.rmtree(root, ignore_errors=True)
    for folder, source in FOLDERS.items():
        shutil.copytree(source, root / folder, ignore=shutil.ignore_patterns("__pycache__", "*.py"))
    try:
        for file, old, new in defect.edits:
            plant(root / file, old, new)
        failures = _play(defect, root, seed)
    except (ValueError, BuildError) as error:
        return Catch(defect, False, -1, time.monotonic() - began, f"not planted: {error}")
    seconds = time.monotonic() - began
    if not failures:
        return Catch(defect, False, -1, seconds, f"not caught in {defect.histories:,} histories")
    failure = failures[0]
    good = re.search(defect.red, failure.text) is not None
    says = failure.text if good else f"red, but not for this: {failure.text}"
    return Catch(defect, good, failure.history, seconds, says)


def catch_all(seed: int, jobs: int) -> list[Catch]:
    """Plant and catch all defects, several in parallel."""
    chosen = defects()
    caught = []
    with ThreadPoolExecutor(jobs) as pool:
        for done in pool.map(lambda defect: catch(defect, seed), chosen):
            caught.append(done)
            word = "caught" if done.good else "FAIL  "
            console.print(
                f"defect {len(caught)}/{len(chosen)} {word} {done.defect.name}: history {done.history}, "
                f"{done.seconds:.0f} s: {done.says}",
                highlight=False,
                markup=False,
                soft_wrap=True,
            )
    return caught
