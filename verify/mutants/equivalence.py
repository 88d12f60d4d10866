# SPDX-License-Identifier: MIT
"""Mutants that are no faults: a solver proves that outputs and next states are the same from any state.

All registers of the module become inputs and outputs. Its mutants are in one netlist, of which the problem
has two copies: one without a mutant, one with the mutant that a constant selects. What the module alone does
not show, since its neighbors make the mutant harmless, is tried in the whole core.
"""

import re
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path

from passo.build import TOP
from passo.toolchain import environment

from verify.mutants.fates import Fates, hash_of
from verify.mutants.netlist import SELECT, WIDTH, Core, Mutant, read, selected, yosys

MODULE, CORE = "equal", "equal in the whole core"  # the cases, as the fates name them
LIMIT = 10  # seconds of the solver for a mutant
PREPARES = 900.0  # seconds of yosys
# Registers as inputs and outputs.
PROBLEM = """flatten
memory_map
async2sync
setundef -undriven -zero
opt -full
dffunmap
expose -evert-dff
setundef -zero
opt_clean
"""
_DECLARED = re.compile(r"\(declare-fun (\|[^|]+#\d+\|) \(\|[^|]+_s\|\) (Bool|\(_ BitVec \d+\))")
_DEFINED = re.compile(r"\(define-fun (\|[^|]+(?:#|_n )[^|]+\|) \(\(state \|[^|]+\|\)\) (.*)")
_OF_STATE = re.compile(r"\((\|[^|]+\|) state\)")


def two_copies(problem: str, number: int) -> str:
    """From a netlist in SMT-LIB: can an output of the mutant differ, for the same inputs?"""
    lines = problem.splitlines()
    inputs = [found.groups() for line in lines if (found := _DECLARED.match(line))]
    defined = [found.groups() for line in lines if (found := _DEFINED.match(line))]
    module = re.search(r"^; yosys-smt2-module (\S+)", problem, re.M)
    assert module
    select = f"|{module[1]}_n {SELECT}|"
    width = f"(_ BitVec {WIDTH})"
    chosen = next(_OF_STATE.findall(body)[0] for name, body in defined if name == select)
    made = [f"(declare-fun {name} () {kind})" for name, kind in inputs if name != chosen]
    for copy, value in (("a", 0), ("b", number)):
        made.append(f"(define-fun {chosen[:-1]}_{copy}| () {width} #b{value:0{WIDTH}b})")
        common = {name for name, _ in inputs} - {chosen}

        def renamed(found: re.Match[str], copy: str = copy, common: set[str] = common) -> str:
            return found[1] if found[1] in common else f"{found[1][:-1]}_{copy}|"

        for name, body in defined:
            made.append(f"(define-fun {name[:-1]}_{copy}| () {_OF_STATE.sub(renamed, body)}")
    # what is exposed has the number of the mutant on its way down, too, which differs by itself
    listed = re.findall(r"^; yosys-smt2-output (\S+) ", problem, re.M)
    outputs = [name for name in listed if name.split(".")[-1] != SELECT]
    same = [f"(= |{module[1]}_n {name}_a| |{module[1]}_n {name}_b|)" for name in outputs]
    return "\n".join([*made, f"(assert (not (and true {' '.join(same)})))", "(check-sat)"]) + "\n"


def prepare(core: Core, groups: dict[tuple[str, str], list[Mutant]]) -> dict[str, Path]:
    """The netlists of modules of yosys with their mutants, in SMT-LIB, by name."""
    folder = core.folder / "equal"
    script = [read(core, folder), "design -save core"]
    files = {}
    for (top, name), mutants in groups.items():
        script += ["design -load core", *(selected(mutant.command, mutant.number) for mutant in mutants)]
        script += [f"hierarchy -top {top}", PROBLEM, f"write_smt2 {name}.smt2"]
        files[name] = folder / f"{name}.smt2"
    yosys(folder, "\n".join(script) + "\n", PREPARES)
    return files


def equal(problem: Path, number: int, limit: int) -> bool:
    """Whether the netlist with the mutant is proved to be the same."""
    file = problem.with_name("mutant.smt2")
    file.write_text(two_copies(problem.read_text(encoding="utf-8"), number), encoding="utf-8")
    command = ["z3", f"-T:{limit}", file]
    done = subprocess.run([*map(str, command)], env=environment(), capture_output=True, text=True)
    said = done.stdout.split()
    assert said and said[0] in ("sat", "unsat", "unknown", "timeout"), done.stdout[:500]
    return said[0] == "unsat"


def judge(
    core: Core, mutants: Sequence[Mutant], fates: Fates, show: Callable[[str], None], case: str
) -> None:
    """Prove what can be proved of the mutants that live: each in its module, or all in the core."""
    groups: dict[tuple[str, str], list[Mutant]] = {}
    for mutant in mutants:
        if fates.get(mutant.name).waits(case):
            module = mutant.netlist_module
            group = (module, f"{mutant.module}_{hash_of([], module)}") if case == MODULE else (TOP, TOP)
            groups.setdefault(group, []).append(mutant)
    problems = prepare(core, groups) if groups else {}
    for (_, name), waiting in groups.items():
        proved = 0
        for mutant in waiting:
            fate = fates.get(mutant.name)
            fate.tried = [*(fate.tried or []), case]
            if equal(problems[name], mutant.number, LIMIT):
                fate.equal = case
                proved += 1
        fates.save()
        show(f"{core.name}: {name}: {proved} of {len(waiting)} are {case}")
