# SPDX-License-Identifier: MIT
"""Constraints for nextpnr in terms of the netlist: clocks, and pins for designs without a board."""

from collections.abc import Mapping
from typing import Any

from passo_fpga.devices import GOWIN, Device, Family


def clock_constraints(family: Family, module: Mapping[str, Any], ports: Mapping[str, float]) -> str:
    """Constraints of the clock ports (MHz); the netlist module is needed for a Gowin."""
    clocks = {f"get_ports {name}": mhz for name, mhz in ports.items()}
    if family is GOWIN:  # nextpnr does not propagate the clock of a port there
        clocks = {f"get_nets {{{_clock_net(module, name)}}}": mhz for name, mhz in ports.items()}
    return "".join(f"create_clock -period {1000 / mhz:.4f} [{what}]\n" for what, mhz in clocks.items())


def any_pins(device: Device, module: Mapping[str, Any]) -> str:
    """A pin for each port, for tools that do not choose pins; SCLK on the clock network."""
    first, second, *others = device.pins
    fixed, rest = {"clk": first, "spi_sclk": second}, iter(others)
    lines = []
    for name, port in module["ports"].items():
        width = len(port["bits"])
        for bit in range(width):
            pin = fixed.get(name) or next(rest)
            lines.append(f'IO_LOC "{name}{f"[{bit}]" if width > 1 else ""}" {pin};\n')
    return "".join([*lines, f'CLOCK_LOC "{_clock_net(module, "spi_sclk")}" BUFG;\n'])


def _clock_net(module: Mapping[str, Any], port: str) -> str:
    """The clock net driven by a Gowin port through its input and clock buffers."""
    (bit,) = module["ports"][port]["bits"]
    for buffer in ("IBUF", "BUFG"):
        pins = [cell["connections"] for cell in module["cells"].values() if cell["type"] == buffer]
        bit = next((pin["O"][0] for pin in pins if pin["I"] == [bit]), bit)
    names = [name for name, net in module["netnames"].items() if net["bits"] == [bit]]
    return min(names, key=lambda name: (name.count("."), len(name)))
