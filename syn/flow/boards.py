# SPDX-License-Identifier: MIT
"""The boards: a folder in syn/ with board.toml, top.v and a file of pins for each."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

from passo.toolchain import paths
from passo_fpga.devices import DEVICES, Device
from passo_fpga.flow import Design
from passo_fpga.pll import Pll, dividers

COMMON = paths.syn / "passo_board.v"


class BoardError(ValueError):
    """There is no such board."""


@dataclass(frozen=True)
class Board:
    """What board.toml says; `load` is the command that takes a bitstream to the board, `pack` are options."""

    name: str
    title: str
    device: Device
    pins: Path
    oscillator_mhz: float
    clock_mhz: float
    axes: int
    load: str
    pack: tuple[str, ...] = ()

    @property
    def top(self) -> Path:
        """Its Verilog."""
        return paths.syn / self.name / "top.v"

    def pll(self, mhz: float | None = None) -> Pll:
        """The PLL for its own clock or another one."""
        return dividers(self.device.family, self.oscillator_mhz, mhz or self.clock_mhz)

    def parameters(self, axes: int | None = None, mhz: float | None = None) -> dict[str, int]:
        """The parameters of its top."""
        pll = self.pll(mhz)
        clock_hz = round(pll.mhz * 1e6)
        return {"AXES": axes or self.axes, "CLOCK_HZ": clock_hz, **self.device.core, **pll.parameters}

    def design(self, axes: int | None = None, mhz: float | None = None) -> Design:
        """What is to be synthesised."""
        return Design(
            name=f"board-{self.name}",
            device=self.device,
            top="top",
            parameters=self.parameters(axes, mhz),
            extra_sources=(COMMON, self.top),
        )


def boards() -> dict[str, Board]:
    """All boards by name."""
    return {path.parent.name: _read(path) for path in sorted(paths.syn.glob("*/board.toml"))}


def board(name: str) -> Board:
    """One board; BoardError names those that are there."""
    there = boards()
    if name not in there:
        raise BoardError(f"there is no board '{name}'; choose one of {', '.join(there)}")
    return there[name]


def _read(path: Path) -> Board:
    facts = tomllib.loads(path.read_text())
    facts["device"] = DEVICES[facts["device"]]
    facts["pins"] = path.parent / facts["pins"]
    facts["pack"] = tuple(facts.get("pack", ()))
    return Board(name=path.parent.name, **facts)
