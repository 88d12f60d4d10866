# SPDX-License-Identifier: MIT
"""Prove modules of the model and of the RTL equal, and show that each proof can fail.

    .venv/bin/python -m verify.equal.run [module ...]

A module is a file couplings/MODULE.toml. With faults in the RTL, of which the solver chooses one, its proof
must fail. All work is done in build/equal; build/equal.json has the figures. A run of all modules that is
good writes the table of docs/reference/equality.md.
"""

import argparse
import shutil
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from multiprocessing import get_context

from passo.console import Estimate, console, table
from passo.ending import ended
from passo.failure import Failure
from passo.output import check_results, make_folder, write_json
from passo.toolchain import paths

from verify.equal import page
from verify.equal.coupling import HERE, Coupling, couplings, read_coupling
from verify.equal.prove import fault_seen, prove
from verify.equal.share import share_of_registers

BUILD = paths.build / "equal"
JOBS = 2
SOURCES = ("rtl", "c_model/core", "c_model/protocol")


@dataclass(frozen=True)
class Result:
    """Result of a proof, or of one with faults. ``good``: proved, or a fault was seen."""

    module: str
    what: str
    good: bool
    says: str
    seconds: float
    goals: int = 0
    bits: int = 0


def prove_module(name: str) -> Result:
    """Prove a module on the unmodified sources."""
    try:
        outcome = prove(read_coupling(HERE / f"{name}.toml"), paths.root)
    except Failure as failure:
        return Result(name, "proof", False, str(failure), 0.0)
    says = f"{outcome.goals} goals, {outcome.bits} bits of registers"
    if outcome.failed:
        says = f"not equal: {', '.join(outcome.failed)}\n{outcome.counterexample}"
    return Result(name, "proof", not outcome.failed, says, outcome.seconds, outcome.goals, outcome.bits)


def see_fault(name: str) -> Result:
    """Show that the proof of a module fails with a fault in the RTL, for a clock and for a reset."""
    folder = BUILD / f"{name}.faults"
    shutil.rmtree(folder, ignore_errors=True)
    for source in SOURCES:
        shutil.copytree(paths.root / source, folder / source)
    begin = time.monotonic()
    try:
        says, good = f"seen at {', '.join(fault_seen(read_coupling(HERE / f'{name}.toml'), folder))}", True
    except Failure as failure:
        says, good = str(failure), False
    return Result(name, "faults", good, says, time.monotonic() - begin)


def run_all(chosen: list[Coupling], jobs: int) -> list[Result]:
    """Run the proofs, with and without faults, in parallel, with a line for each result."""
    results: list[Result] = []
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        work = [pool.submit(of, coupling.name) for coupling in chosen for of in (prove_module, see_fault)]
        estimate = Estimate(len(work))
        for done in as_completed(work):
            result = done.result()
            results.append(result)
            word = "ok  " if result.good else "FAIL"
            line = f"{len(results):3}/{len(work)} {word} {result.module:12} {result.seconds:6.1f} s  "
            line += f"{result.what}: {result.says}"
            if len(results) < len(work):
                line += f"  ({estimate.left(len(results))})"
            console.print(line, highlight=False, markup=False, soft_wrap=True)
    return results


def main() -> None:
    """Run the selected proofs, print a table, and exit with 1 unless all are good."""
    parser = argparse.ArgumentParser(prog="python -m verify.equal.run", description=__doc__.split("\n")[0])
    parser.add_argument("module", nargs="*", help="modules to prove (default: all)")
    parser.add_argument("--jobs", type=int, default=JOBS, help="parallel runs (default: %(default)s)")
    arguments = parser.parse_args()

    known = couplings()
    unknown = set(arguments.module) - {coupling.name for coupling in known}
    if unknown:
        parser.error(f"no such module: {', '.join(sorted(unknown))}")
    chosen = [coupling for coupling in known if not arguments.module or coupling.name in arguments.module]

    report_file = paths.build / "equal.json"
    check_results(report_file, *[page.PAGE] * (chosen == known))
    begin = time.monotonic()
    results = run_all(chosen, arguments.jobs)
    made = table("Model and RTL", "module", "goals", "bits", "prove", "fault", "result")
    for coupling in chosen:
        mine = [result for result in results if result.module == coupling.name]
        proof, faulty = (next(one for one in mine if one.what == what) for what in ("proof", "faults"))
        made.add_row(
            coupling.name,
            str(proof.goals),
            str(proof.bits),
            f"{proof.seconds:.0f} s",
            "seen" if faulty.good else "not seen",
            "equal" if all(result.good for result in mine) else "FAIL",
        )
    console.print(made)
    proved, all_bits = share_of_registers(chosen)
    seconds = time.monotonic() - begin
    console.print(
        f"{proved:,} of {all_bits:,} bits of the registers of a core of 4 axes with all parts are in a proof"
        f" ({100 * proved / all_bits:.0f} %); {seconds:.0f} s in all.",
        highlight=False,
    )
    good = all(result.good for result in results)
    found = [asdict(result) for result in results]
    report = {"results": found, "proved_bits": proved, "bits": all_bits, "seconds": seconds}
    make_folder(BUILD)
    write_json(report, report_file)
    if good and chosen == known:
        page.write(chosen, report)
    sys.exit(not good)


if __name__ == "__main__":
    sys.exit(ended(main))
