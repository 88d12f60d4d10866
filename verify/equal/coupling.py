# SPDX-License-Identifier: MIT
"""Couplings: which field of the model is which register of the RTL. See docs/equality.md.

A coupling is a file couplings/NAME.toml. Every expression in it is C, of the objects that it declares.
"""

import tomllib
from collections.abc import Collection
from dataclasses import dataclass, replace
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
    bits: str | None = None  # a C expression: nothing is said of the bits that are 0 in it


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
    # structs of the model; what is not listed is the field of the same name of the first that has one
    same: dict[str, tuple[str, ...]]  # by section
    free: dict[str, str]  # registers or inputs without coupling, and why
    invariants: dict[str, Link]  # hold before the clock, and are proved to hold after it
    assumptions: dict[str, dict[str, str]]  # ``that`` holds of the inputs, ``because`` of a neighbor
    # registers with an asynchronous reset; the clock then gives the inputs their next values
    asynchronous: tuple[str, ...]
    # leaves of the objects that a parameter fixes: member after member
    fixed: dict[str, int]
    # long arrays of integers: unknown as a whole, which z3 decides faster; without indices: ``a[].b``
    arrays: tuple[str, ...]
    memory: str  # a file of memory/, for rtl/passo_memory.v
    cut: tuple[str, ...]  # modules in it that are proved on their own: their ports are outputs and inputs
    apart: bool  # each goal is proved on its own, which z3 may decide faster than all together
    slow: bool  # takes too long for the tests
    opaque: bool  # products and quotients of unknown numbers are unknown functions
    # goals that z3 decides faster value by value of an expression: the expression, and how many values
    splits: dict[str, dict[str, Any]]
    clocks: tuple[str, ...]  # inputs that clock registers, too, which are all of asynchronous


SECTIONS = ("inputs", "outputs", "registers")


def _same(table: dict[str, Any]) -> dict[str, tuple[str, ...]]:
    """Take the structs of the entries ``"*"`` out of the sections."""
    found = {section: table.get(section, {}).pop("*", ()) for section in SECTIONS}
    return {section: (names,) if isinstance(names, str) else tuple(names) for section, names in found.items()}


def _link(entry: str | dict[str, Any]) -> Link:
    return Link(entry) if isinstance(entry, str) else Link(entry["is"], *_rest(entry))


def _rest(entry: dict[str, Any]) -> tuple[str | None, bool, bool, str | None, str | None]:
    flags = entry.get("signed", False), entry.get("kept", False)
    return entry.get("when"), *flags, entry.get("probe"), entry.get("bits")


def read_coupling(path: Path) -> Coupling:
    """Read a file of couplings.

    Raises:
        Failure: It has an unknown key, or lacks one.
    """
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    same = _same(table)
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
            same,
            table.pop("free", {}),
            {name: _link(entry) for name, entry in table.pop("invariants", {}).items()},
            table.pop("assumptions", {}),
            tuple(table.pop("asynchronous", ())),
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


def completed(coupling: Coupling, names: dict[str, Collection[str]], fields: Collection[str]) -> Coupling:
    """The coupling with the entries that have the same name on both sides.

    Args:
        coupling: As in its file.
        names: Of the RTL's ports and registers, by section; in an instance: ``instance.register``.
        fields: Of the model's objects: ``object.field``.
    """
    made: dict[str, Any] = {}
    for section in SECTIONS:
        listed: dict[str, Link] = getattr(coupling, section)
        whole = {name.split("[")[0] for name in listed}
        made[section] = dict(listed)
        for name in names[section]:
            own = name.split(".")[-1]
            found = [it for struct in coupling.same[section] if (it := f"{struct}.{own}") in fields]
            if found and name not in whole and name not in coupling.free:
                made[section][name] = Link(found[0])
    return replace(coupling, **made)


def couplings() -> list[Coupling]:
    """All couplings, by name."""
    return [read_coupling(path) for path in sorted(HERE.glob("*.toml"))]
