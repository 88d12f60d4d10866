# SPDX-License-Identifier: MIT
"""`make synth BOARD=...`: a bitstream for a board, in build/synth."""

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

from passo.console import console, table
from passo.fpga.boards import Board, BoardError, board, boards
from passo.fpga.devices import SPI_MHZ
from passo.fpga.flow import Placed, cells, moved_registers, pack, place
from passo.fpga.pll import PllError
from passo.fpga.tools import ToolError, prepare
from passo.toolchain import paths

OUT = paths.build / "synth"
SEEDS = (1, 2, 3)
WORKERS = 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if the bitstream is there and all clocks are met, 1 if not, 2 if the board is unknown."""
    parser = argparse.ArgumentParser(prog="make synth", description="Make the bitstream of a board.")
    parser.add_argument("--board", default="", help="one of the folders in syn/")
    parser.add_argument("--axes", type=int, help="another number of axes")
    parser.add_argument("--clock", type=float, metavar="MHZ", help="another clock")
    options = parser.parse_args(arguments)
    try:
        if not options.board:
            _list()
            return 0
        return 0 if make(board(options.board), options.axes, options.clock) else 1
    except (BoardError, PllError) as error:
        print(f"make synth: {error}", file=sys.stderr)
        return 2
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1


def _list() -> None:
    shown = table("make synth BOARD=...", "board", "axes", "clock", "")
    shown.columns[-1].justify = "left"
    for each in boards().values():
        shown.add_row(each.name, str(each.axes), f"{each.clock_mhz:g} MHz", each.title)
    console.print(shown)


def make(chosen: Board, axes: int | None = None, mhz: float | None = None) -> bool:
    """Make the bitstream of the best of some seeds, tell what came of it, return whether it can be used."""
    design, pll = chosen.design(axes, mhz), chosen.pll(mhz)
    family = chosen.device.family
    prepare(family.programs)
    ports = {"oscillator": chosen.oscillator_mhz, "spi_sclk": SPI_MHZ}

    with console.status(f"{chosen.name}: synthesis"):
        made = cells(design)
    with (
        console.status(f"{chosen.name}: place and route, seeds {', '.join(map(str, SEEDS))}"),
        ThreadPoolExecutor(WORKERS) as pool,
    ):
        tried = list(pool.map(lambda seed: place(design, seed, pll.mhz, ports, chosen.pins), SEEDS))

    used, capacity = tried[0].used, chosen.device.capacity
    size = f"{used:,} of {capacity:,} {family.size_unit} ({used / capacity:.0%})"
    print(f"{chosen.title}, {design.parameters['AXES']} axes")
    print(f"  size       {size}, {made['FF']:,} FF, {tried[0].bram} BRAM, {made['DSP']} DSP")
    if moved := moved_registers(design):
        print(f"  registers  {moved} more in the block RAMs")
    fitting = [each for each in tried if each.fits]
    if not fitting:
        print(f"  does not fit: {tried[0].folder.relative_to(paths.root)}/nextpnr.log")
        return False
    best = max(fitting, key=_slack)
    reached = ", ".join(f"{each.main_clock[0]:.1f}" for each in fitting)
    print(f"  f_max      {best.main_clock[0]:.1f} MHz for a clock of {pll.mhz:g} MHz (seeds: {reached})")

    OUT.mkdir(parents=True, exist_ok=True)
    bitstream = OUT / f"{chosen.name}.{family.suffix}"
    bitstream.unlink(missing_ok=True)
    problems = _problems(best, pll.mhz)
    for problem in problems:
        print(f"  NOT MET    {problem}")
    if problems:
        return False
    pack(design, best, bitstream)
    print(f"  bitstream  {bitstream.relative_to(paths.root)} (load it with: {chosen.load})")
    return True


def _slack(placed: Placed) -> float:
    """By which factor the worst clock is met."""
    return min(achieved / wanted for achieved, wanted in placed.clocks.values())


def _problems(placed: Placed, mhz: float) -> list[str]:
    """Clocks that are not met; and the core's, if the tools take it for another one."""
    problems = [
        f"{name}: {achieved:.1f} MHz of {wanted:.1f} MHz"
        for name, (achieved, wanted) in placed.clocks.items()
        if achieved < wanted
    ]
    if abs(placed.main_clock[1] - mhz) > mhz / 100:
        problems.append(f"the PLL of the top makes {placed.main_clock[1]:g} MHz instead of {mhz:g} MHz")
    return problems


if __name__ == "__main__":
    sys.exit(main())
