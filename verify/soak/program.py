# SPDX-License-Identifier: MIT
"""The program that plays histories: build it, run it, and parse its output."""

import json
import os
import subprocess
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from passo.build import model_library, planner_library
from passo.cache import hash_of
from passo.compiler import STRICT, compile_to, headers, includes, kept, sources
from passo.output import write_json
from passo.toolchain import environment, paths

HERE = Path(__file__).resolve().parent
BUILD = paths.build / "soak"
FLAGS = (*STRICT, "-std=gnu11", "-O2")
FOLDERS = {
    "c_model/core": paths.core,
    "c_model/planner": paths.planner,
    "c_model/protocol": paths.protocol,
    "stm32_bridge/driver": paths.driver,
    "verify/soak": HERE,
}


# Histories of a core with inputs, encoders and outputs: events, drives into switches, motions that begin at
# switches with filters of any length, anything at all.
KINDS = ("machine", "tries", "starts", "pokes")
# Of the driver, by a program of their own: operations that end early, hosts that die.
DRIVER_KINDS = ("endings", "sessions")


class SoakError(RuntimeError):
    """The program could not be run."""


@dataclass(frozen=True)
class Failure:
    """A failed history."""

    part: str
    seed: int
    history: int
    clock: int
    text: str

    @property
    def again(self) -> str:
        """The command that reproduces it."""
        kind = self.part.split()[0]
        kinds = (*KINDS, *DRIVER_KINDS, "trackers")
        more = " --driver" if kind == "driver" else f" --kind {kind}" if kind in kinds else ""
        return f"python -m verify.soak.run --seed {self.seed} --history {self.history}{more}"


def _object(file: Path, folders: Sequence[Path]) -> Path:
    """Compile a source with the headers of folders; return the object file."""
    made = BUILD / "objects" / f"{file.stem}.o"
    return kept(made, [file, *headers(*folders)], FLAGS, *includes(*folders), "-c", file)


def build(root: Path = paths.root, program: Path = BUILD / "soak") -> Path:
    """Build the program from the sources under root; return its path."""
    folders = list(FOLDERS.values()) if root == paths.root else [root / folder for folder in FOLDERS]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(lambda file: _object(file, [*folders, paths.engine]), sources(*folders)))
    return compile_to(program, *objects, "-ldl")


def build_endings(root: Path = paths.root, program: Path = BUILD / "endings") -> Path:
    """Build the program of DRIVER_KINDS, with planner and driver of the sources under root."""
    here = HERE / "endings"
    folders = (root / "stm32_bridge/driver", root / "c_model/planner", paths.protocol)
    libraries = [model_library()]
    files = sources(here)
    if root == paths.root:
        folders = (paths.driver, paths.planner, paths.protocol)
        libraries.append(planner_library())
    else:
        files += sources(*folders)
    known = (*folders, here, paths.core, paths.engine)
    linked = [*map(str, libraries), *(f"-Wl,-rpath,{library.parent}" for library in libraries)]
    inputs = [*files, *libraries, *headers(*known)]
    return kept(program, inputs, FLAGS, *includes(*known), *files, *linked, "-lm")


def play_kept(command: Sequence[str | Path], part: str, seed: int) -> tuple[Counter[str], list[Failure]]:
    """The same as play_program(); what did not fail is kept, so a run continues where the last one ended.

    The name of a program that loads libraries has their hash.
    """
    program, *arguments = command
    key = hash_of([Path(program)], [Path(program).name, *map(str, arguments)])
    kept_counts = BUILD / "played" / f"{part}-{key}.json"
    if kept_counts.exists():
        return Counter(json.loads(kept_counts.read_text(encoding="utf-8"))), []
    counts, failures = play_program(command, part, seed)
    if not failures:
        kept_counts.parent.mkdir(parents=True, exist_ok=True)
        write_json(counts, kept_counts)
    return counts, failures


playing: set[subprocess.Popen] = set()  # killed when this program ends


def say(command: Sequence[str | Path]) -> tuple[int, str, str]:
    """Run a program; return its exit status and output."""
    process = subprocess.Popen(
        [*map(str, command)], env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    playing.add(process)
    said, complaints = process.communicate()
    playing.discard(process)
    return process.returncode, said, complaints


def play_program(command: Sequence[str | Path], part: str, seed: int) -> tuple[Counter[str], list[Failure]]:
    """Play histories; return the counts and the failures."""
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
