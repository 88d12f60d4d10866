# SPDX-License-Identifier: MIT
"""What identifies a cell of a netlist of yosys: kind, place in the source, and the wires that it leads to."""

import re
from typing import Any


def kind_of(name: str) -> str:
    """The kind of a cell; of an instance its name."""
    return name.split("$")[1] if name.startswith("$") and name.count("$") > 1 else name


def numbered(name: str) -> tuple[int, str]:
    """In the order in which yosys has made them."""
    number = re.search(r"\$(\d+)$", name)
    return (int(number[1]) if number else 0, name)


Cells = dict[tuple[str, str, str], list[str]]


def named_bits(module: dict[str, Any]) -> dict[int, tuple[str, int]]:
    """Wire and place of bits, without the numbers of yosys: of a wire, or of what a process gives it.

    Not of a wire of a proof, whose names begin with f_.
    """
    found: dict[int, tuple[str, int]] = {}
    for name, net in sorted(module["netnames"].items()):
        given = re.fullmatch(r"\$0\\(.+)\[\d+:\d+\]", name)
        if given or not name.startswith(("$", "f_")):
            for place, bit in enumerate(net["bits"]):
                if isinstance(bit, int):
                    found.setdefault(bit, (f"next {given[1]}" if given else name, place))
    return found


def targets(module: dict[str, Any]) -> dict[str, str]:
    """Of each cell the first named wires that it leads to; with the bit if it is one of many."""
    named = named_bits(module)
    wide = {wire for wire, place in named.values() if place}
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
        found: set[tuple[str, int]] = set()
        seen, front = {name}, [name]
        while front and not found:
            bits = [bit for one in front for bit in outputs(one)]
            found = {named[bit] for bit in bits if bit in named}
            next_ones = (reader for bit in bits for reader in readers.get(bit, ()) if reader not in seen)
            front = list(dict.fromkeys(next_ones))
            seen.update(front)
        bits_of: dict[str, list[int]] = {}
        for wire, place in sorted(found):
            bits_of.setdefault(wire, []).append(place)
        shown = (
            f"{wire}[{places[0]}]" if len(places) == 1 and wire in wide else wire
            for wire, places in list(bits_of.items())[:3]
        )
        return ", ".join(shown)

    return {name: follow(name) for name in module["cells"]}


def cells_by_place(module: dict[str, Any]) -> Cells:
    """The cells of a module by kind, place, and where they lead to."""
    found: Cells = {}
    leads = targets(module)
    for name, cell in sorted(module["cells"].items(), key=lambda item: numbered(item[0])):
        source = re.sub(r"[^|\s]*/", "", cell["attributes"].get("src", ""))
        wires = re.sub(r"\[\d+\]", "", leads[name])  # a core of another size has other bits
        found.setdefault((kind_of(name), source, wires), []).append(name)
    return found
