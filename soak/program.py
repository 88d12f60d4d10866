# SPDX-License-Identifier: MIT
"""The program that plays histories: building it, running it, and reading what it says."""

import hashlib
import os
import subprocess
import threading
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from passo.build import ENGINE
from passo.toolchain import environment, paths

HERE = Path(__file__).resolve().parent
BUILD = paths.build / "soak"
FLAGS = ("-std=gnu11", "-O2", "-Wall", "-Wextra", "-Wconversion", "-Werror")
FOLDERS = {"c_model": paths.c_model, "stm32_bridge/driver": paths.driver, "soak": HERE}


class SoakError(RuntimeError):
    """Something could not be built or played."""


@dataclass(frozen=True)
class Failure:
    """A broken promise."""

    part: str
    seed: int
    history: int
    clock: int
    text: str

    @property
    def again(self) -> str:
        """What shows it once more."""
        driver = " DRIVER=1" if self.part.startswith("driver") else ""
        return f"make soak SEED={self.seed} HISTORY={self.history}{driver}"


def run(command: Sequence[str | Path]) -> None:
    """Run a tool that must succeed."""
    done = subprocess.run([*map(str, command)], env=environment(), capture_output=True, text=True)
    if done.returncode:
        raise SoakError(f"{command[0]} failed:\n{done.stderr or done.stdout}")


def _sources(root: Path) -> list[Path]:
    return [file for folder in FOLDERS for file in sorted((root / folder).glob("*.c"))]


def _object(file: Path, root: Path) -> Path:
    """A source of root, compiled; only once for the same sources."""
    digest = hashlib.sha256(" ".join(FLAGS).encode())
    headers = [*ENGINE.glob("*.h"), *(path for folder in FOLDERS for path in (root / folder).glob("*.h"))]
    for path in [file, *sorted(headers)]:
        digest.update(path.name.encode() + path.read_bytes())
    made = BUILD / "objects" / f"{file.stem}-{digest.hexdigest()[:16]}.o"
    if not made.exists():
        part = made.with_suffix(f".{os.getpid()}.{threading.get_ident()}")
        includes = [f"-I{root / folder}" for folder in FOLDERS]
        run(["cc", *FLAGS, *includes, f"-I{ENGINE}", "-c", file, "-o", part])
        part.rename(made)
    return made


def build(root: Path = paths.root, program: Path = BUILD / "soak") -> Path:
    """The program that plays histories, of the sources under root."""
    (BUILD / "objects").mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(lambda file: _object(file, root), _sources(root)))
    run(["cc", *objects, "-ldl", "-o", program])
    return program


playing: set[subprocess.Popen] = set()  # to be ended with this program


def say(command: Sequence[str | Path]) -> tuple[int, str, str]:
    """Run a program to its end: exit status, and what it said."""
    process = subprocess.Popen(
        [*map(str, command)], env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    playing.add(process)
    said, complaints = process.communicate()
    playing.discard(process)
    return process.returncode, said, complaints


def play_program(command: Sequence[str | Path], part: str, seed: int) -> tuple[Counter[str], list[Failure]]:
    """Play histories and read what came of them."""
    status, said, complaints = say(command)
    counts: Counter[str] = Counter()
    failures = []
    for line in said.splitlines():
        word, _, rest = line.partition(" ")
        if word == "count":
            name, _, value = rest.rpartition(" ")
            counts[name] += int(value)
        elif word == "failed":
            history, clock, text = rest.split(" ", 2)
            failures.append(Failure(part, seed, int(history), int(clock), text))
    if status not in (0, 1) or (status == 1) != bool(failures):
        raise SoakError(f"{' '.join(map(str, command))}: exit status {status}\n{complaints}")
    return counts, failures
