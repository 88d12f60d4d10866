# SPDX-License-Identifier: MIT
"""Couplings: which field of the model is which register of the RTL. See docs/equality.md.

A coupling is a file couplings/NAME.toml. Every expression in it is C, of the objects that it declares.
"""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from passo.failure import Failure

HERE = Path(__file__).resolve().parent / "couplings"


@dataclass(frozen=True)
class Link:
    """What a register or port is: a C expression; nothing is said of it while ``when`` is not true."""

    expression: str
    when: str | None = None
    signed: bool = False
    kept: bool = False  # by a reset
    probe: str | None = None  # the address of a memory on which its next value depends


@dataclass(frozen=True)
class Coupling:
    """A file of couplings."""

    name: str
    says: str
    top: str  # module of the RTL
    parameters: dict[str, int]
    sources: tuple[str, ...]  # of the model, first the module's own
    objects: tuple[str, ...]  # declarations
    state: tuple[str, ...]  # those of them that are the module's state
    clock: str
    reset: str | None
    types: str  # that the declarations need
    prelude: str
    inputs: dict[str, Link]
    outputs: dict[str, Link]
    registers: dict[str, Link]
    free: dict[str, str]  # registers or inputs without coupling, and why
    invariants: dict[str, Link]  # hold before the clock, and are proved to hold after it
    assumptions: dict[str, dict[str, str]]  # ``that`` holds of the inputs, ``because`` of a neighbour
    # registers with an asynchronous reset; the clock then gives the inputs their next values
    at_once: tuple[str, ...]
    # leaves of the objects that a parameter fixes: member after member
    fixed: dict[str, int]
    # long arrays of integers: unknown as a whole, which z3 decides faster; without indices: ``a[].b``
    arrays: tuple[str, ...]
    memory: str  # a file of memory/, for rtl/passo_memory.v
    cut: tuple[str, ...]  # modules in it that are proved on their own: their ports are outputs and inputs
    apart: bool  # each goal is proved on its own, which z3 may decide faster than all at once
    slow: bool  # takes too long for ``make test``
    opaque: bool  # products and quotients of unknown numbers are unknown functions
    # goals that z3 decides faster value by value of an expression: the expression, and how many values
    splits: dict[str, dict[str, Any]]
    clocks: tuple[str, ...]  # inputs that clock registers, too, which are all of at_once


def _link(entry: str | dict[str, Any]) -> Link:
    return Link(entry) if isinstance(entry, str) else Link(entry["is"], *_rest(entry))


def _rest(entry: dict[str, Any]) -> tuple[str | None, bool, bool, str | None]:
    return entry.get("when"), entry.get("signed", False), entry.get("kept", False), entry.get("probe")


def read_coupling(path: Path) -> Coupling:
    """Read a file of couplings.

    Raises:
        Failure: It has an unknown key, or lacks one.
    """
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    try:
        coupling = Coupling(
            path.stem,
            table.pop("says"),
            table.pop("top"),
            table.pop("parameters", {}),
            tuple(table.pop("sources")),
            tuple(table.pop("objects")),
            tuple(table.pop("state")),
            table.pop("clock"),
            table.pop("reset", None),
            table.pop("types", ""),
            table.pop("prelude", ""),
            {name: _link(entry) for name, entry in table.pop("inputs", {}).items()},
            {name: _link(entry) for name, entry in table.pop("outputs", {}).items()},
            {name: _link(entry) for name, entry in table.pop("registers", {}).items()},
            table.pop("free", {}),
            {name: _link(entry) for name, entry in table.pop("invariants", {}).items()},
            table.pop("assumptions", {}),
            tuple(table.pop("at_once", ())),
            table.pop("fixed", {}),
            tuple(table.pop("arrays", ())),
            table.pop("memory", "passo_memory.v"),
            tuple(table.pop("cut", ())),
            table.pop("apart", False),
            table.pop("slow", False),
            table.pop("opaque", False),
            table.pop("splits", {}),
            tuple(table.pop("clocks", ())),
        )
    except KeyError as missing:
        raise Failure(f"{path.name}: {missing} is missing") from None
    if table:
        raise Failure(f"{path.name}: unknown key {next(iter(table))}")
    return coupling


def couplings() -> list[Coupling]:
    """All couplings, by name."""
    return [read_coupling(path) for path in sorted(HERE.glob("*.toml"))]
