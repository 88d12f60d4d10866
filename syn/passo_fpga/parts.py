# SPDX-License-Identifier: MIT
"""The optional parts of the core on a board: the pins of their ports, from the tables of a board.toml."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from passo.build import PARTS
from passo.pins import INPUTS, OUTPUTS
from passo.values import meant

from passo_fpga.table import BoardError, Table

PORTS = {  # width of each port, by part
    part: {pin.name: pin.width for pin in (*INPUTS, *OUTPUTS) if pin.parameter == part} for part in PARTS
}
NEEDS = {"raster": "outputs", "compare": "outputs"}  # parts of parts
WITH_PINS = tuple(part for part in PORTS if PORTS[part])  # those that have a table in a board.toml
OF_A_CHANNEL = {"CHANNELS": 1, "CHANNELS*8": 8, "1": 1}  # widths that do not depend on the axes
LIMITS = ("limit_low", "limit_high")
SHARED = "shared"  # key of [inputs]: the pins of `home` may be those of limits

P = TypeVar("P")  # a pin
PartPins = Mapping[str, tuple[P, ...]]  # of each port of a part


def bits(part: str, port: str, axes: int) -> int:
    """Number of bits of a port of a core with one channel."""
    return OF_A_CHANNEL.get(PORTS[part][port], axes)


def chosen(text: str) -> tuple[str, ...]:
    """The parts of a list with commas; raises BoardError."""
    wanted = [part for part in text.split(",") if part]
    if unknown := sorted(set(wanted) - set(PORTS)):
        hint = meant(unknown[0], tuple(PORTS)) or f"; must be one of {', '.join(PORTS)}"
        raise BoardError(f"unknown part '{unknown[0]}'{hint}")
    for part, needed in NEEDS.items():
        if part in wanted and needed not in wanted:
            raise BoardError(f"part '{part}' needs part '{needed}': PARTS={needed},{part}")
    return tuple(part for part in PORTS if part in wanted)


def read(table: Table, part: str, axes: int, pin: Callable[[Table, str], P]) -> PartPins[P]:
    """The pins of a part: a pin for each port, or a list with one for each bit, for up to `axes` axes.

    A port without pins is left out: an input is idle then.
    """
    found = {}
    for port in PORTS[part]:
        if not table.has(port):
            continue
        most = bits(part, port, axes)
        found[port] = (pin(table, port),) if most == 1 and not table.is_list(port) else table.pins(port, pin)
        if len(found[port]) > most:
            raise table.error(port, f"{len(found[port])} pins; must be at most {most}")
    table.end()
    return found


def check(board: str, there: Mapping[str, PartPins[Any]], parts: Sequence[str], axes: int) -> None:
    """Raise BoardError for a part that a board has no pins for, or too few for this number of axes."""
    for part in parts:
        if part not in WITH_PINS:
            continue
        if part not in there:
            known = f"it has pins for {', '.join(there)}" if there else "it has none for any part"
            raise BoardError(f"board '{board}': the table has no pins for part '{part}'; {known}")
        for port, pins in there[part].items():
            if port != "outputs" and len(pins) < bits(part, port, axes):
                wanted = f"{bits(part, port, axes)} are needed for {axes} axes"
                raise BoardError(f"board '{board}': {part}.{port}: {wanted}, the table has {len(pins)}")
