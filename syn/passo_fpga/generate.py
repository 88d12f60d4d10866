# SPDX-License-Identifier: MIT
"""Generates the files of a board from its table: a Verilog file with the PLL, and a pin file."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from zlib import crc32

from passo.output import write_text
from passo.toolchain import paths

from passo_fpga.boards import FOLDER, TABLE, Board
from passo_fpga.design import Design

TOP = paths.syn / "passo_board.v"

PLL = """\
// Generated from {table} by `make synth`: {made:g} MHz from {oscillator:g} MHz.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_board_pll (
  input  wire oscillator,
  output wire clk,
  output wire locked
);

  passo_pll #(
{parameters}
  ) u_pll (
    .oscillator(oscillator),
    .clk(clk),
    .locked(locked)
  );

endmodule
`resetall
"""


def generate(
    board: Board,
    folder: Path,
    axes: int | None = None,
    mhz: float | None = None,
    parts: Sequence[str] = (),
    name: str = "",
    more: Mapping[str, int] = MappingProxyType({}),
) -> tuple[Design, Path]:
    """Write both files into `folder`; return the design of that name, with `more` parameters, and the pins.

    Its parameter BUILD is a checksum of all that the bitstream is made of.
    """
    family = board.device.family
    folder.mkdir(parents=True, exist_ok=True)
    pll, pins = folder / "passo_board_pll.v", folder / f"pins.{family.pins_suffix}"
    write_text(pins, pin_file(board, axes, parts))
    write_text(pll, pll_file(board, mhz, parts))
    design = Design(
        name=name or f"board-{board.name}",
        device=board.device,
        top=TOP.stem,
        parameters={**board.parameters(axes, mhz, parts), **more},
        left_out=board.left_out(parts),
        extra_sources=(TOP, paths.syn / "families" / f"{family.name}.v", pll),
    )
    return replace(design, parameters={**design.parameters, "BUILD": _checksum(design, pins)}), pins


def _checksum(design: Design, pins: Path) -> int:
    texts = [path.read_bytes() for path in (*design.sources, *sorted(paths.rtl.glob("*.vh")), pins)]
    return crc32(b"\0".join([repr((design.device.name, sorted(design.parameters.items()))).encode(), *texts]))


def pll_file(board: Board, mhz: float | None = None, parts: Sequence[str] = ()) -> str:
    """Text of the PLL module with the dividers for this clock."""
    pll = board.pll(mhz, parts)
    device = board.device
    parameters = {**pll.parameters, **device.family.pll_kind(device.part, board.pll_kind)}
    return PLL.format(
        table=_table(board),
        made=pll.mhz,
        oscillator=board.oscillator_mhz,
        parameters=",\n".join(f"    .{name}({json.dumps(value)})" for name, value in parameters.items()),
    )


def pin_file(board: Board, axes: int | None = None, parts: Sequence[str] = ()) -> str:
    """Text of the pin file in the format of the family."""
    family = board.device.family
    lines = [f"{family.comment} Made of {_table(board)} by `make synth`.\n"]
    lines += [family.pin_line(port, pin) for port, pin in board.ports(axes, parts).items()]
    return "".join(lines)


def _table(board: Board) -> str:
    return f"{FOLDER.name}/{board.folder}/{TABLE}"
