# SPDX-License-Identifier: MIT
"""Random histories of the core, aimed at the clocks where something changes, under a judge of its promises.

    .venv/bin/python -m soak.run [--seed N] [--only model,verilator,icarus,driver,defects] [--scale X]
    .venv/bin/python -m soak.run --seed N --history N [--driver]

The first form plays them on all cores of this machine, prints a table and writes build/soak.json; the second
one prints a single history. docs/soak.md says what is played and what is judged.
"""

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from passo.build import Parameters, rtl_library
from passo.compiler import STRICT, BuildError, call, compile_to, headers, includes, kept, sources
from passo.console import console as terminal
from passo.console import table
from passo.planted import plant
from passo.report import write_json
from passo.toolchain import environment, paths
from rich.console import Console

HERE = Path(__file__).resolve().parent
BUILD = paths.build / "soak"
REPORT = paths.build / "soak.json"
FLAGS = (*STRICT, "-std=gnu11", "-O2")
FOLDERS = {
    "model": paths.model,
    "planner": paths.planner,
    "protocol": paths.protocol,
    "stm32_bridge/driver": paths.driver,
    "soak": HERE,
}

# The same as plot_parameters() in plot.c.
SETS = (
    Parameters(1, 1, 7, 5, 3),
    Parameters(1, 3, 7, 2, 2, step_reset=5, dir_reset=3, enable_reset=6),
    Parameters(2, 2, 7, 3, 4, step_reset=1, dir_reset=4, enable_reset=15),
)
DRIVER_SET = 2  # the same as BRIDGE_SET in bridge.h

# Histories of each part.
HISTORIES = {
    "model": 20_000,
    "driver": 3_000,
    "verilator": 1_500,
    "driver on verilator": 150,
    "icarus": 1_000,
}
PARTS = ("model", "driver", "verilator", "icarus", "defects")
CHUNK = 50  # histories of one process

console = terminal if terminal.is_terminal else Console(width=118)


class SoakError(RuntimeError):
    """Something could not be played."""


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


@dataclass
class Part:
    """What came of the histories of a part."""

    name: str
    seconds: float = 0
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[Failure] = field(default_factory=list)


@dataclass(frozen=True)
class Defect:
    """A known defect: its sentence, where it is put back, and the words with which it must go red."""

    name: str
    says: str
    edits: tuple[tuple[str, str, str], ...]  # file, old, new
    red: str  # regular expression
    driver: bool = False
    blind: bool = False  # the rate is judged by the steps alone
    histories: int = 20_000  # within which it must

    def folder(self) -> Path:
        """Where its copy of the sources is."""
        return BUILD / "defects" / self.name


@dataclass(frozen=True)
class Catch:
    """What became of a defect."""

    defect: Defect
    good: bool
    history: int  # the one that went red; -1: none
    seconds: float
    says: str


# ---- building ----


def _object(file: Path, folders: Sequence[Path]) -> Path:
    """A source, compiled with the headers of folders."""
    made = BUILD / "objects" / f"{file.stem}.o"
    return kept(made, [file, *headers(*folders)], FLAGS, *includes(*folders), "-c", file)


def build(root: Path = paths.root, program: Path = BUILD / "soak") -> Path:
    """The program that plays histories, of the sources under root."""
    folders = [root / folder for folder in FOLDERS]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(lambda file: _object(file, [*folders, paths.engine]), sources(*folders)))
    return compile_to(program, *objects, "-ldl")


# ---- playing ----


playing: set[subprocess.Popen] = set()  # to be ended with this program


def _say(command: Sequence[str | Path]) -> tuple[int, str, str]:
    """Run a program to its end: exit status, and what it said."""
    process = subprocess.Popen(
        [*map(str, command)], env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    playing.add(process)
    said, complaints = process.communicate()
    playing.discard(process)
    return process.returncode, said, complaints


def _end(*_: object) -> None:
    for process in list(playing):
        process.terminate()
    sys.exit(1)


def _play(command: Sequence[str | Path], part: str, seed: int) -> tuple[Counter[str], list[Failure]]:
    """Play histories and read what came of them."""
    status, said, complaints = _say(command)
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


Work = Callable[[], tuple[Counter[str], list[Failure]]]


def _all(part: Part, wanted: int, work: Iterable[Work], jobs: int) -> Part:
    """Do the work on so many cores, and say how far it is."""
    began = last = time.monotonic()
    waiting: Iterator[Work] = iter(work)
    with ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(task) for _, task in zip(range(2 * jobs), waiting, strict=False)}
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                counts, failures = future.result()
                part.counts += counts
                part.failures += failures
                if (task := next(waiting, None)) is not None:
                    running.add(pool.submit(task))
            now = time.monotonic()
            if now - last > 10 or not running:
                last = now
                console.print(
                    f"{part.name}: {part.counts['histories']:,} of {wanted:,} histories, "
                    f"{len(part.failures)} failed, {now - began:.0f} s",
                    highlight=False,
                )
    part.seconds = time.monotonic() - began
    for failure in part.failures[:10]:
        console.print(
            f"  FAIL {failure.again}: clock {failure.clock}: {failure.text}", style="red", highlight=False
        )
    return part


def _chunks(histories: int) -> Iterator[tuple[int, int]]:
    """First history and number of each chunk."""
    return ((first, min(CHUNK, histories - first)) for first in range(0, histories, CHUNK))


def play_model(program: Path, seed: int, histories: int, jobs: int) -> Part:
    """Histories at the registers, on the C model."""

    def task(first: int, count: int) -> Work:
        return lambda: _play([program, str(seed), str(first), str(count), "--keep-on"], "model", seed)

    return _all(Part("model"), histories, (task(*chunk) for chunk in _chunks(histories)), jobs)


def play_driver(program: Path, seed: int, histories: int, jobs: int, library: Path | None = None) -> Part:
    """Histories through the driver over a bad wire, on the C model or also the Verilated core."""
    name = "driver on verilator" if library else "driver"
    more = ["--rtl", library] if library else []

    def task(first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--driver", "--keep-on", *more]
        return lambda: _play(command, name, seed)

    return _all(Part(name), histories, (task(*chunk) for chunk in _chunks(histories)), jobs)


def play_verilator(program: Path, seed: int, histories: int, jobs: int) -> Part:
    """The same histories on the Verilated core, compared with the model on every clock."""
    libraries = [rtl_library(parameters) for parameters in SETS]

    def task(number: int, first: int, count: int) -> Work:
        command = [program, str(seed), str(first), str(count), "--set", str(number), "--keep-on"]
        return lambda: _play([*command, "--rtl", libraries[number]], "verilator", seed)

    share = -(-histories // len(SETS))
    work = (
        task(number, first * len(SETS) + number, count)
        for first, count in _chunks(share)
        for number in range(len(SETS))
    )
    return _all(Part("verilator"), share * len(SETS), work, jobs)


def _bench(number: int) -> Path:
    """The player for a set of parameters, compiled by Icarus Verilog."""
    made = BUILD / f"player{number}.vvp"
    given = [f"-Psoak_player.{name}={value}" for name, value in SETS[number].verilog().items()]
    files = [HERE / "player.v", *sorted(paths.rtl.glob("*.v"))]
    call(["iverilog", "-g2005", f"-I{paths.rtl}", *given, "-s", "soak_player", "-o", made, *files])
    return made


def play_icarus(program: Path, seed: int, histories: int, jobs: int) -> Part:
    """Histories recorded from the judged model and played to the core on Icarus Verilog."""
    benches = [_bench(number) for number in range(len(SETS))]
    folder = BUILD / "records"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    def play(history: int) -> tuple[Counter[str], list[Failure]]:
        record = folder / f"{history}.txt"
        command = [program, str(seed), str(history), "1", "--record", folder, "--short"]
        counts, failures = _play(command, "icarus", seed)
        bench = ["vvp", str(benches[history % len(SETS)]), f"+record={record}"]
        said = _say(bench)[1].strip()
        record.unlink()
        if not re.fullmatch(r"same [1-9]\d*", said):
            clock = re.match(r"clock (\d+)", said)
            failures.append(Failure("icarus", seed, history, int(clock[1]) if clock else 0, said))
        return counts, failures

    return _all(
        Part("icarus"),
        histories,
        ((lambda history=history: play(history)) for history in range(histories)),
        jobs,
    )


# ---- planted defects ----


def defects() -> list[Defect]:
    """Read defects.toml."""
    found = []
    for entry in tomllib.loads((HERE / "defects.toml").read_text(encoding="utf-8"))["defect"]:
        edits = tuple((edit["file"], edit["old"], edit["new"]) for edit in entry.pop("edit"))
        found.append(Defect(edits=edits, **entry))
    return found


def catch(defect: Defect, seed: int) -> Catch:
    """Put the defect back into a copy of the sources; the histories must go red with its words."""
    began = time.monotonic()
    root = defect.folder()
    shutil.rmtree(root, ignore_errors=True)
    for folder, source in FOLDERS.items():
        shutil.copytree(source, root / folder, ignore=shutil.ignore_patterns("__pycache__", "*.py"))
    try:
        for file, old, new in defect.edits:
            plant(root / file, old, new)
        program = build(root, root / "program")
    except (ValueError, BuildError) as error:
        return Catch(defect, False, -1, time.monotonic() - began, f"not planted: {error}")
    command = [program, str(seed), "0", str(defect.histories), *(["--driver"] if defect.driver else [])]
    command += ["--blind"] if defect.blind else []
    counts, failures = _play(command, defect.name, seed)
    seconds = time.monotonic() - began
    if not failures:
        return Catch(defect, False, -1, seconds, f"not caught in {counts['histories']:,} histories")
    failure = failures[0]
    good = re.search(defect.red, failure.text) is not None
    says = failure.text if good else f"red, but not for this: {failure.text}"
    return Catch(defect, good, failure.history, seconds, says)


def catch_all(seed: int, jobs: int) -> list[Catch]:
    """All of them, several at a time."""
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


# ---- showing ----

JUDGED = {
    "steps": "steps",
    "positions": "positions read",
    "paths": "paths made exactly",
    "quiets": "states that said quiet",
    "aborts": "aborts",
    "stops": "stops",
    "gaps": "gaps after a stop",
    "gates": "words that need rest",
    "resets": "resets",
}


def show(parts: Sequence[Part], caught: Sequence[Catch]) -> None:
    """The tables."""
    shown = table(
        "Histories", "part", "histories", "clocks", "frames", "aimed", "on the clock", "failed", "s"
    )
    for part in parts:
        counts = part.counts
        aimed = counts["aimed"]
        shown.add_row(
            part.name,
            f"{counts['histories']:,}",
            f"{counts['clocks'] / 1e6:,.0f} M",
            f"{counts['frames']:,}",
            f"{aimed:,}" if aimed else "",
            f"{counts['hit'] / aimed:.0%}" if aimed else "",
            str(len(part.failures)),
            f"{part.seconds:.0f}",
        )
    console.print(shown)
    judged = table("Judged", "what", *(part.name for part in parts))
    for key, text in JUDGED.items():
        judged.add_row(text, *(f"{part.counts[key]:,}" for part in parts))
    console.print(judged)
    wires = [part for part in parts if part.name.startswith("driver")]
    if wires:
        wire = table("The driver's wire", "what", *(part.name for part in wires))
        for key in (
            "retries",
            "flips",
            "lost clocks",
            "doubled clocks",
            "cuts",
            "deaths",
            "moves",
            "lines",
            "errors",
        ):
            wire.add_row(key, *(f"{part.counts[key]:,}" for part in wires))
        console.print(wire)
    if caught:
        made = table("Defects put back by hand", "defect", "caught", "after histories", "s")
        for one in caught:
            made.add_row(
                one.defect.name,
                "yes" if one.good else "NO",
                f"{one.history + 1:,}" if one.history >= 0 else "",
                f"{one.seconds:.0f}",
            )
        console.print(made)


def report(seed: int, parts: Sequence[Part], caught: Sequence[Catch]) -> dict[str, Any]:
    """The contents of soak.json."""
    return {
        "seed": seed,
        "ok": not any(part.failures for part in parts) and all(one.good for one in caught),
        "parts": {
            part.name: {
                "seconds": round(part.seconds, 1),
                "failed": len(part.failures),
                "failures": [
                    {"history": one.history, "clock": one.clock, "text": one.text, "again": one.again}
                    for one in part.failures
                ],
                **part.counts,
            }
            for part in parts
        },
        "defects": [
            {
                "name": one.defect.name,
                "says": one.defect.says,
                "caught": one.good,
                "seed": seed,
                "histories": one.history + 1,
                "broken": one.says,
            }
            for one in caught
        ],
    }


def soak(seed: int, only: Sequence[str], scale: float, jobs: int) -> bool:
    """Everything that is wanted; true if all of it is as it must be."""
    program = build()
    wanted = {name: max(1, round(number * scale)) for name, number in HISTORIES.items()}
    parts = []
    if "model" in only:
        parts.append(play_model(program, seed, wanted["model"], jobs))
    if "driver" in only:
        parts.append(play_driver(program, seed, wanted["driver"], jobs))
    if "verilator" in only:
        parts.append(play_verilator(program, seed, wanted["verilator"], jobs))
        library = rtl_library(SETS[DRIVER_SET])
        parts.append(play_driver(program, seed, wanted["driver on verilator"], jobs, library))
    if "icarus" in only:
        parts.append(play_icarus(program, seed, wanted["icarus"], jobs))
    caught = catch_all(seed, jobs) if "defects" in only else []
    made = report(seed, parts, caught)
    write_json(made, REPORT)
    show(parts, caught)
    console.print(f"Report: {REPORT.relative_to(paths.root)}")
    return made["ok"]


def main() -> None:
    """Read the command line; the exit status is 1 if a promise was broken or a defect not caught."""
    parser = argparse.ArgumentParser(prog="python -m soak.run", description=__doc__.split("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--history", type=int, help="print this one")
    parser.add_argument("--driver", action="store_true", help="the history through the driver")
    parser.add_argument("--only", default=",".join(PARTS), help="parts to play (default: %(default)s)")
    parser.add_argument("--scale", type=float, default=1.0, help="times as many histories")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()

    signal.signal(signal.SIGTERM, _end)
    only = arguments.only.split(",")
    if unknown := set(only) - set(PARTS):
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    if arguments.history is not None:
        command = [build(), str(arguments.seed), str(arguments.history), "1", "--print"]
        sys.exit(subprocess.run([*command, *(["--driver"] if arguments.driver else [])]).returncode)
    sys.exit(not soak(arguments.seed, only, arguments.scale, arguments.jobs))


if __name__ == "__main__":
    main()
