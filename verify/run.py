# SPDX-License-Identifier: MIT
"""Verify the promises by proofs, equality with the model, histories, inverted wires and mutants.

    .venv/bin/python -m verify.run [--seed N] [--scale X] [NAME ...]

A name is a part (formal, equal, wiring, soak, mutants), or what a part knows: a proof, a module, a kind of
history, a source in C. `formal axis` is one proof; `axis` alone is everything about that module. Without a
name all parts run.
"""

import argparse
import difflib
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

from passo.build import rtl_sources
from passo.compiler import sources
from passo.console import console, table
from passo.ending import ended

from verify.equal.coupling import couplings
from verify.equal.wiring import MODULES as WIRED
from verify.formal.run import proofs
from verify.mutants.c_source import FOLDERS
from verify.soak.run import PARTS as HISTORIES


@dataclass(frozen=True)
class Part:
    """One way to show it: its program, the names that it knows, and its arguments for some of them."""

    says: str
    program: str
    names: Collection[str]
    arguments: Callable[[Sequence[str], argparse.Namespace], list[str]]


def _listed(chosen: Sequence[str], seed: int) -> list[str]:
    return [*(["--only", ",".join(chosen)] if chosen else []), "--seed", str(seed)]


def parts() -> dict[str, Part]:
    """The parts, the quick ones first."""
    modules = [source.stem for source in rtl_sources()]
    files = [source.name for folder in FOLDERS.values() for source in sources(folder)]
    mutated = {name: name for name in ("rtl", "c", *modules, *files)}  # as the mutants call it
    mutated |= {name.removeprefix("passo_"): name for name in modules}
    return {
        "formal": Part(
            "proofs of the promises of the RTL",
            "verify.formal.run",
            [proof.name for proof in proofs()],
            lambda chosen, _: list(chosen),
        ),
        "equal": Part(
            "RTL = C model, module by module",
            "verify.equal.run",
            [coupling.name for coupling in couplings()],
            lambda chosen, _: list(chosen),
        ),
        "wiring": Part(
            "every connection between modules matters",
            "verify.equal.wiring",
            WIRED,
            lambda chosen, options: ["--seed", str(options.seed), *chosen],
        ),
        "soak": Part(
            "random histories, judged at the pins",
            "verify.soak.run",
            HISTORIES,
            lambda chosen, options: [*_listed(chosen, options.seed), "--scale", str(options.scale)],
        ),
        "mutants": Part(
            "small faults, seen by those who do not know the model",
            "verify.mutants.run",
            mutated,
            lambda chosen, options: _listed([mutated[name] for name in chosen], options.seed),
        ),
    }


def chosen_of(known: dict[str, Part], names: Sequence[str]) -> dict[str, list[str]]:
    """The parts to run, each with the names of what it is to do; none: everything.

    Raises:
        ValueError: No part knows a name, or none of those that are named.
    """
    named = [name for name in names if name in known] or list(known)
    others = [name for name in names if name not in known]
    for name in others:
        if not any(name in known[part].names for part in named):
            near = sorted({*known, *(one for part in named for one in known[part].names)})
            close = ", ".join(difflib.get_close_matches(name, near, 3))
            raise ValueError(f"no {name!r} in {', '.join(named)}" + (f"; near: {close}" if close else ""))
    chosen = {part: [name for name in others if name in known[part].names] for part in named}
    return {part: its for part, its in chosen.items() if its or not others or part in names}


def main() -> None:
    """Run the parts one after the other, print what came of them; exit status 1 unless all are good."""
    known = parts()
    parser = argparse.ArgumentParser(prog="python -m verify.run", description=__doc__.split("\n")[0])
    parser.add_argument("name", nargs="*", help=f"{', '.join(known)}, or a proof, module, kind or source")
    parser.add_argument(
        "--seed", type=int, default=1, help="seed of scenarios and mutants (default: %(default)s)"
    )
    parser.add_argument("--scale", type=float, default=1.0, help="multiply the number of scenarios")
    options = parser.parse_args()
    try:
        chosen = chosen_of(known, options.name)
    except ValueError as error:
        parser.error(str(error))
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    made = table("Verification", "part", "shows", "minutes", "result")
    good = True
    for name, its in chosen.items():
        console.rule(f"{name}: {known[name].says}")
        began = time.monotonic()
        command = [sys.executable, "-m", known[name].program, *known[name].arguments(its, options)]
        done = subprocess.run(command).returncode == 0
        good = good and done
        made.add_row(
            name, known[name].says, f"{(time.monotonic() - began) / 60:.1f}", "ok" if done else "FAIL"
        )
    console.print(made)
    sys.exit(not good)


if __name__ == "__main__":
    sys.exit(ended(main))
