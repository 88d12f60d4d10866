# SPDX-License-Identifier: MIT
"""Packs output registers into the block RAMs of an ECP5, which synthesis does not do.

The netlist stays cycle-exact. A block RAM (DP16KD) has an output register per port with a clock enable (OCE).
It has no reset other than that of the RAM, and its initial value is 0. Registers are therefore packed only if
they are the only load of all used outputs, have the clock of the port and a common enable, and have neither a
reset nor an initial value of 1.
"""

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

Cell = dict[str, Any]
Users = Mapping[int | str, list[tuple[str, str]]]  # by net: loads as (cell, port); ("", "") is a module port

# Required parameters of a register; these are also the defaults.
PLAIN = {"LSRMUX": "LSR", "LSRMODE": "LSR", "REGSET": "RESET"}


def move_registers(netlist: dict[str, Any]) -> int:
    """Modify a netlist (Yosys JSON); return the number of registers packed."""
    return sum(_move(module) for module in netlist["modules"].values())


def move_registers_of(path: Path) -> int:
    """Modify the netlist file at `path`; return the number of registers packed."""
    netlist = json.loads(path.read_text(encoding="utf-8"))
    moved = move_registers(netlist)
    path.write_text(json.dumps(netlist), encoding="utf-8")
    return moved


def _move(module: dict[str, Any]) -> int:
    cells, users = module["cells"], _users(module)
    moved = 0
    for ram in [cell for cell in cells.values() if cell["type"] == "DP16KD"]:
        for port, sides in _ports(ram):
            registers = _registers(ram, port, sides, cells, users)
            enables = {_enable(cells[name]) for name in registers.values()}
            if len(enables) != 1:
                continue
            ((enable, inverted),) = enables
            for side in sides:
                ram["parameters"][f"REGMODE_{side}"] = "OUTREG"
                ram["parameters"][f"OCE{side}MUX"] = "INV" if inverted else f"OCE{side}"
                ram["connections"][f"OCE{side}"] = [enable]
            for output, name in registers.items():
                ram["connections"][output] = cells.pop(name)["connections"]["Q"]
            moved += len(registers)
    return moved


def _users(module: dict[str, Any]) -> Users:
    users = defaultdict(list)
    for name, cell in module["cells"].items():
        for port, bits in cell["connections"].items():
            if cell["port_directions"][port] != "output":
                for bit in bits:
                    users[bit].append((name, port))
    for port in module["ports"].values():
        for bit in port["bits"]:
            users[bit].append(("", ""))
    return dict(users)


def _ports(ram: Cell) -> Iterator[tuple[str, str]]:
    """Ports whose output register is unused and not reset, and the sides of their outputs."""
    parameters, connections = ram["parameters"], ram["connections"]
    # with 36-bit words A writes and B reads: all outputs have the clock and the enable of B
    wide = int(parameters["DATA_WIDTH_A"], 2) == 36
    for port, sides in [("B", "AB")] if wide else [("A", "A"), ("B", "B")]:
        free = all(parameters[f"REGMODE_{side}"] == "NOREG" for side in sides)
        if free and all(connections[f"RST{side}"] == ["0"] for side in sides):
            yield port, sides


def _registers(ram: Cell, port: str, sides: str, cells: Mapping[str, Cell], users: Users) -> dict[str, str]:
    """The register at each used output; empty if one of them has another load."""
    found = {}
    for output, bits in ram["connections"].items():
        if not output.startswith(tuple(f"DO{side}" for side in sides)):
            continue
        for bit in bits:
            takers = users.get(bit, [])
            if not takers:
                continue
            name, pin = takers[0]
            if len(takers) > 1 or pin != "DI" or not _fits(cells[name], ram, port):
                return {}
            found[output] = name
    return found


def _fits(cell: Cell, ram: Cell, port: str) -> bool:
    """Whether a cell is a register with the clock of the port, without reset and initial value 1."""
    parameters, of_ram = cell["parameters"], ram["parameters"]
    return (
        cell["type"] == "TRELLIS_FF"
        and cell["connections"]["CLK"] == ram["connections"][f"CLK{port}"]
        and (parameters.get("CLKMUX") == "INV") == (of_ram.get(f"CLK{port}MUX") == "INV")
        and cell["connections"].get("LSR") == ["0"]
        and all(parameters.get(name, value) == value for name, value in PLAIN.items())
        and parameters.get("GSR") == of_ram.get("GSR")
    )


def _enable(register: Cell) -> tuple[int | str, bool]:
    """The enable of a register, a net or a constant, and whether it is inverted."""
    mux = register["parameters"].get("CEMUX", "1").strip()  # Yosys writes "1 ", which cannot be a number
    return (mux, False) if mux in ("0", "1") else (register["connections"]["CE"][0], mux == "INV")
