# SPDX-License-Identifier: MIT
"""Many adversarial paths on all cores: the worst figures, and the smallest case of each kind of fault.

    python -m benchmarks.path_adversary [PATHS [SEED [--keep] [--motors]]]

With --motors on machines whose motors are not their axes. With --keep the smallest cases go to
benchmarks/path_worst.json; tests/test_path_search.py has all of it. Batches that are done are kept in
build/path_search, by what they depend on, with all cases beyond a bound: an interrupted run continues.
"""

import hashlib
import json
import os
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from passo.console import console, progress
from passo.ending import ended
from passo.output import write_text
from passo.toolchain import paths

from benchmarks.path_measure import KINDS, Measured, compare, measure, play
from benchmarks.path_paths import MACHINES, MOTORS, Case, case_of, read_cases, write_cases
from benchmarks.path_search import BeyondError, search

PATHS, BATCH = 10_000, 50
WORST = paths.root / "benchmarks" / "path_worst.json"
OPEN = paths.root / "benchmarks" / "path_open.json"  # beyond a bound to this day
DONE = paths.build / "path_search"
SOURCES = ("c_model", "sim/passo", "benchmarks", "tests/helpers")  # what a figure depends on
FIGURES: dict[str, Callable[[Measured], float]] = {
    "unlimited": lambda one: one.unlimited,
    "look_ahead": lambda one: one.look_ahead,
    "shaped": lambda one: one.shaped,
    "soft": lambda one: one.soft,
    "paced": lambda one: one.paced,
    **{name: lambda one, name=name: one.share(name) for name in ("speed", "acceleration", "jerk")},
    "off": lambda one: one.off,
}
Machines = tuple[str, ...]  # names


@dataclass
class Found:
    """Of some paths: the worst figures with their cases, and how many are beyond a bound."""

    paths: int = 0
    worst: dict[str, tuple[float, Case]] = field(default_factory=dict)
    beyond: dict[str, int] = field(default_factory=dict)
    batches: dict[str, int] = field(default_factory=dict)  # seed of the first batch with a fault of a kind
    failed: list[tuple[dict[str, str], Case]] = field(default_factory=list)  # what is beyond, by kind

    def see(self, case: Case, measured: Measured) -> None:
        """Count a case."""
        self.paths += 1
        for name, figure in FIGURES.items():
            if figure(measured) > self.worst.get(name, (0.0, case))[0]:
                self.worst[name] = (figure(measured), case)
        for kind in measured.faults:
            self.beyond[kind] = self.beyond.get(kind, 0) + 1
        if measured.faults:
            self.failed.append((measured.faults, case))

    def add(self, other: "Found", seed: int) -> None:
        """Count those of a batch."""
        self.paths += other.paths
        self.failed += other.failed
        for name, (value, case) in other.worst.items():
            if value > self.worst.get(name, (0.0, case))[0]:
                self.worst[name] = (value, case)
        for kind, count in other.beyond.items():
            self.beyond[kind] = self.beyond.get(kind, 0) + count
            self.batches.setdefault(kind, seed)

    def to_json(self) -> str:
        """In a line."""
        worst = {name: (value, case.to_json()) for name, (value, case) in self.worst.items()}
        failed = [(faults, case.to_json()) for faults, case in self.failed]
        return json.dumps({"paths": self.paths, "worst": worst, "beyond": self.beyond, "failed": failed})


def found_of(text: str) -> Found:
    """Those of a batch, from its line."""
    data = json.loads(text)
    worst = {name: (value, case_of(case)) for name, (value, case) in data["worst"].items()}
    failed = [(faults, case_of(case)) for faults, case in data["failed"]]
    return Found(data["paths"], worst, data["beyond"], failed=failed)


def done_in() -> Path:
    """The directory of the batches that these sources have done."""
    digest = hashlib.sha256()
    for top in SOURCES:
        for path in sorted((paths.root / top).rglob("*.[chp]*")):
            if path.suffix in (".c", ".h", ".py"):
                digest.update(path.read_bytes())
    return DONE / digest.hexdigest()[:16]


def kept_batch(folder: Path, seed: int, count: int, machines: Machines) -> Found:
    """A batch, or what an earlier run has kept of it."""
    kept = folder / f"{seed}-{count}-{'-'.join(machines)}.json"
    if kept.exists():
        return found_of(kept.read_text(encoding="utf-8"))
    found = batch(seed, count, machines)
    write_text(kept, found.to_json() + "\n")
    return found


def batch(seed: int, count: int, machines: Machines) -> Found:
    """Draw and measure `count` paths."""
    found = Found()
    search(count, seed, known=frozenset(KINDS), seen=found.see, machines=machines)
    return found


def only(kind: str) -> Callable[[Case], Measured]:
    """Measures no more than a kind of fault needs."""

    def check(case: Case) -> Measured:
        if kind in ("slow", "slow48"):
            return compare(case)
        measured = Measured()
        play(case, measured)
        return measured

    return check


def smallest(kind: str, seed: int, count: int, machines: Machines = tuple(MACHINES)) -> BeyondError | None:
    """Draw a batch again, and shrink its first case of this kind."""
    return search(count, seed, only(kind), frozenset(KINDS) - {kind}, machines=machines)


def adversaries(count: int = PATHS, seed: int = 1, machines: Machines = tuple(MACHINES)) -> Found:
    """Measure `count` paths on all cores."""
    found, jobs, told, folder = Found(), {}, 0, done_in()
    folder.mkdir(parents=True, exist_ok=True)
    with progress("adversarial paths", count) as report, ProcessPoolExecutor(os.cpu_count()) as pool:
        for number in range(-(-count // BATCH)):
            own = seed * 1_000_003 + number
            size = min(BATCH, count - number * BATCH)
            jobs[pool.submit(kept_batch, folder, own, size, machines)] = own
        for job in as_completed(jobs):
            found.add(job.result(), jobs[job])
            report(min(found.paths, count))
            if found.paths * 20 // count > told and not console.is_terminal:
                told = found.paths * 20 // count
                console.print(
                    f"{found.paths:,} of {count:,} adversarial paths, beyond a bound: {found.beyond}"
                )
    return found


def show(found: Found) -> None:
    """Print the figures."""
    console.print(f"{found.paths:,} adversarial paths; the worst:")
    for name, (value, case) in found.worst.items():
        console.print(f"{name:14}{value:8.4f}  {case}", soft_wrap=True)
    counts = ", ".join(f"{kind} {found.beyond.get(kind, 0)}" for kind in KINDS)
    console.print(f"beyond a bound: {counts}", soft_wrap=True)


def show_open() -> None:
    """Print how far the cases that are known to be beyond a bound are beyond it."""
    for name, case in read_cases(OPEN).items():
        faults = measure(case).faults
        console.print(
            f"known: {name}: {', '.join(faults.values()) or 'within all bounds now'}", soft_wrap=True
        )


def figures(found: Found) -> dict[str, Any]:
    """For the report."""
    worst = {name: value for name, (value, _) in found.worst.items()}
    return {"paths": found.paths, "worst": worst, "beyond": found.beyond}


def main(words: list[str]) -> None:
    """Search, show and keep."""
    machines = tuple(MOTORS if "--motors" in words else MACHINES)
    numbers = [int(word) for word in words if word.isdigit()]
    count, seed = (numbers + [PATHS, 1][len(numbers) :])[:2]
    found = adversaries(count, seed, machines)
    show(found)
    show_open()
    kept = read_cases(WORST)
    for kind, own in found.batches.items():
        if (error := smallest(kind, own, BATCH, machines)) is not None:
            console.print(str(error))
            kept[f"{kind} {own}"] = error.case
    if "--keep" in words:
        write_cases(WORST, kept)
    if found.beyond:
        raise SystemExit("a path exceeds a bound")


if __name__ == "__main__":
    sys.exit(ended(lambda: main(sys.argv[1:])))
