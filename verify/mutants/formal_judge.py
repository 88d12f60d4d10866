# SPDX-License-Identifier: MIT
"""The promises as judges: a mutant of a module is put into the module as its proof sees it.

What has been proved of the module must fail now. The proofs are those of verify/formal/, with the same
assumptions; the cells of both netlists are matched by their kind, their place in the source, and the wires
that they lead to. A mutant of which this is not certain has no proof.
"""

import json
import os
import re
import shutil
import time
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from passo.failure import Failure
from passo.toolchain import paths

from verify.formal import run as formal
from verify.mutants.fates import BUILD, Fates, hash_of
from verify.mutants.netlist import Core, Mutant, yosys

LIMIT = 150  # seconds; a proof that takes longer says nothing
WORK = BUILD / "formal"
BASECASE = re.compile(r"engine_\d+\.basecase.*Status: failed", re.I)


def _script(proof: formal.Proof) -> list[str]:
    """The commands of yosys for the proof itself."""
    lines = [line.removeprefix("prove: ") for line in proof.commands if not line.startswith("bug: ")]
    return ["verilog_defines -DINVARIANTS", *lines]


def _reads(proof: formal.Proof, module: str) -> bool:
    """Whether the proof has the module, not only its ports."""
    return any(
        line.startswith("read") and " -lib " not in line and f"{module}.v" in line.split()
        for line in _script(proof)
    )


@cache
def proofs_of(module: str) -> tuple[formal.Proof, ...]:
    """The proofs that say something of a module, the one of its own name first."""
    found = [proof for proof in formal.proofs() if _reads(proof, module)]
    return tuple(sorted(found, key=lambda proof: (proof.slow, f"passo_{proof.name}" != module)))


def _kind(name: str) -> str:
    return name.split("$")[1] if name.startswith("$") and name.count("$") > 1 else name


Cells = dict[tuple[str, str, str], list[str]]


def _named(module: dict[str, Any]) -> dict[int, str]:
    """The names of bits without the numbers of yosys: of a wire, or of what a process gives it."""
    found: dict[int, str] = {}
    for name, net in sorted(module["netnames"].items()):
        given = re.fullmatch(r"\$0\\(.+)\[\d+:\d+\]", name)
        if given or not name.startswith("$"):
            for place, bit in enumerate(net["bits"]):
                shown = f"next {given[1]}" if given else name
                if isinstance(bit, int):
                    found.setdefault(bit, f"{shown} {place}")
    return found


def _targets(module: dict[str, Any]) -> dict[str, str]:
    """Of each cell the first named wires that it leads to."""
    named = _named(module)
    readers: dict[int, list[str]] = {}
    for name, cell in module["cells"].items():
        for port, bits in cell["connections"].items():
            if cell["port_directions"].get(port) == "input":
                for bit in bits:
                    if isinstance(bit, int):
                        readers.setdefault(bit, []).append(name)

    def outputs(name: str) -> list[int]:
        cell = module["cells"][name]
        return [
            bit
            for port, bits in cell["connections"].items()
            if cell["port_directions"].get(port) == "output"
            for bit in bits
            if isinstance(bit, int)
        ]

    def follow(name: str) -> str:
        found: set[str] = set()
        seen, front = {name}, [name]
        while front and not found:
            bits = [bit for one in front for bit in outputs(one)]
            found = {named[bit] for bit in bits if bit in named}
            front = [reader for bit in bits for reader in readers.get(bit, ()) if reader not in seen]
            seen.update(front)
        return ", ".join(sorted(found)[:3])

    return {name: follow(name) for name in module["cells"]}


def _cells(module: dict[str, Any]) -> Cells:
    """The cells of a module by kind, place, and where they lead to."""
    found: Cells = {}
    targets = _targets(module)
    for name, cell in module["cells"].items():
        source = re.sub(r"[^|\s]*/", "", cell["attributes"].get("src", ""))
        found.setdefault((_kind(name), source, targets[name]), []).append(name)
    return found


@cache
def _proof_modules(proof: formal.Proof) -> dict[str, Cells]:
    """The cells of the modules of a proof, when it has read them."""
    folder = WORK / f"cells_{os.getpid()}_{proof.name}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for line in proof.sources:
        names = line.split()  # where it comes from, after the name that it has there
        shutil.copy(paths.root / names[-1], folder / Path(names[0]).name)
    lines = _script(proof)
    place = _place(lines)
    yosys(folder, "\n".join([*lines[:place], *_proc(lines), "write_json cells.json"]) + "\n")
    modules = json.loads((folder / "cells.json").read_text())["modules"]
    return {name: _cells(module) for name, module in modules.items()}


def _place(lines: Sequence[str]) -> int:
    """Where the modules have been read: the first command that makes one netlist of them."""
    return next(i for i, line in enumerate(lines) if line.split()[0] in ("hierarchy", "prep"))


def _proc(lines: Sequence[str]) -> list[str]:
    top = re.findall(r"-top (\w+)", "\n".join(lines))[0]
    return [f"hierarchy -top {top}", "proc"]


@cache
def _core_modules(core: Path) -> dict[str, Cells]:
    return {name: _cells(module) for name, module in json.loads(core.read_text())["modules"].items()}


def _in_proof(core: Core, mutant: Mutant, proof: formal.Proof) -> list[str]:
    """The commands that make the mutant in the proof; none if it has no such cell."""
    found = re.search(r" -module (\S+) -cell (\S+)", mutant.command)
    assert found
    module, cell = found[1], found[2]
    cells_of = _core_modules(core.folder / "core.json")[module]
    key = next((key for key, names in cells_of.items() if cell in names), None)
    if key is None:
        return []
    names = cells_of[key]
    commands = []
    for name, cells in _proof_modules(proof).items():
        if re.sub(r"^\$paramod(?:\$[0-9a-f]+)?\\", "", name).split("\\")[0] != mutant.module:
            continue
        same = cells.get(key, [])
        if len(same) == len(names) == 1:
            made = mutant.command.replace(f"-module {module} ", f"-module {name} ")
            made = made.replace(f"-cell {cell} ", f"-cell {same[0]} ")
            commands.append(re.sub(r" -(?:src|wire|wirebit) \S+", "", made))
    return commands


def prove(core: Core, mutant: Mutant, proof: formal.Proof) -> str:
    """What is no longer proved; empty: all of it is, or the proof has no such mutant."""
    commands = _in_proof(core, mutant, proof)
    if not commands:
        return ""
    folder = WORK / f"proof_{os.getpid()}"
    lines = _script(proof)
    place = _place(lines)
    formal.fresh_copy(proof, folder, [*lines[:place], *_proc(lines), *commands, *lines[place:]])
    verdict, log, _ = formal.run_sby("prove", folder, LIMIT)
    if verdict in ("PASS", "TIMEOUT"):
        return ""
    if verdict == "ERROR":
        raise Failure(f"proof {proof.name}: {re.findall(r'ERROR.*', log)[:2]}")
    broken = sorted(set(re.findall(r"Assert failed in [\w.]+: (\S+)", log)))
    named = [name for name in broken if ":" not in name and not name.startswith("passo_")]
    how = "a counterexample" if "basecase: Assert failed" in log or BASECASE.search(log) else "no induction"
    return f"{how}: {', '.join(named[:3]) or 'what the induction relies on'}"


def judge(
    core: Core, mutants: Sequence[Mutant], fates: Fates, show: Callable[[str], None], slow: bool = False
) -> None:
    """Let the proofs judge the mutants that live."""
    folder = paths.root / "verify/formal"
    judges = hash_of([folder / "promises.toml", *sorted(folder.glob("*.v*"))])
    waiting: dict[formal.Proof, list[Mutant]] = {}
    for mutant in mutants:
        for proof in proofs_of(mutant.module):
            if slow or not proof.slow:
                waiting.setdefault(proof, []).append(mutant)
    seconds: dict[str, float] = {}
    # one mutant with each proof, to know how long it takes; then the quick ones first
    for first in (True, False):
        for proof, group in sorted(waiting.items(), key=lambda item: seconds.get(item[0].name, 0.0)):
            name = f"proof {proof.name} {judges}"
            left = [mutant for mutant in group if name not in (fates.get(mutant.name).tried or [])]
            for mutant in [mutant for mutant in left if fates.get(mutant.name).lives][: 1 if first else None]:
                began = time.monotonic()
                _try(core, mutant, proof, fates, name, show)
                seconds[proof.name] = time.monotonic() - began


def _try(
    core: Core, mutant: Mutant, proof: formal.Proof, fates: Fates, name: str, show: Callable[[str], None]
) -> None:
    """One mutant in one proof."""
    fate = fates.get(mutant.name)
    try:
        broken = prove(core, mutant, proof)
    except Failure as failure:
        show(f"{mutant.name}: {failure}")
        return
    fate.tried = [*(fate.tried or []), name]
    if broken:
        fate.killed, fate.says = f"proof {proof.name}", broken
    show(f"{core.name}: {mutant.module}: proof {proof.name}: {broken or 'lives'}")
    fates.save()
