# SPDX-License-Identifier: MIT
"""What nextpnr is told of the clocks, and of pins that nobody has chosen, in terms of the netlist."""

from collections.abc import Mapping
from typing import Any

from passo_fpga.devices import GOWIN, Device, Family


def clock_constraints(family: Family, module: Mapping[str, Any], ports: Mapping[str, float]) -> str:
    """Periods in ns of the clocks (MHz) that come in by ports; the module of the netlist is for a Gowin."""
    clocks = {f"get_ports {name}": mhz for name, mhz in ports.items()}
    if family is GOWIN:  # nextpnr forgets the clock of a port there
        clocks = {f"get_nets {{{_clock_net(module, name)}}}": mhz for name, mhz in ports.items()}
    return "".join(f"create_clock -period {1000 / mhz:.4f} [{what}]\n" for what, mhz in clocks.items())


def any_pins(device: Device, module: Mapping[str, Any]) -> str:
    """Some pin for each port, for the tool that does not choose one; SCLK on the clock network."""
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
    """The net behind a Gowin's port, its input buffer and its clock buffer."""
    (bit,) = module["ports"][port]["bits"]
    for buffer in ("IBUF", "BUFG"):
        pins = [cell["connections"] for cell in module["cells"].values() if cell["type"] == buffer]
        bit = next((pin["O"][0] for pin in pins if pin["I"] == [bit]), bit)
    names = [name for name, net in module["netnames"].items() if net["bits"] == [bit]]
    return min(names, key=lambda name: (name.count("."), len(name)))
