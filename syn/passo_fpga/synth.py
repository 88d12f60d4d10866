# SPDX-License-Identifier: MIT
"""`make synth BOARD=...`: a bitstream for a board, in build/synth."""

import argparse
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from passo.console import console, stages, table
from passo.toolchain import paths

from passo_fpga import parts
from passo_fpga.boards import OSCILLATOR, Board, board, boards
from passo_fpga.design import Design
from passo_fpga.devices import SPI_MHZ
from passo_fpga.flow import Placed, cells, moved_registers, pack, place, synthesis_complaints
from passo_fpga.generate import generate
from passo_fpga.pll import PllError
from passo_fpga.table import BoardError
from passo_fpga.tools import ToolError, prepare, relative, workers

OUT = paths.build / "synth"
SEEDS = range(1, 9)
COMPLAINTS_SHOWN = 3  # per seed


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if the bitstream was made and all clocks are met, 1 if not, 2 for an unknown board."""
    parser = argparse.ArgumentParser(prog="make synth", description="Make the bitstream of a board.")
    parser.add_argument("--board", default="", help="one of the folders in syn/")
    parser.add_argument("--axes", type=int, help="number of axes (default: of the board)")
    parser.add_argument(
        "--clock", type=float, metavar="MHZ", help="clock of the core (default: of the board)"
    )
    parser.add_argument("--parts", default="", help=f"optional blocks: {','.join(parts.PORTS)}")
    options = parser.parse_args(arguments)
    try:
        if not options.board:
            _list()
            return 0
        return (
            0 if make(board(options.board), options.axes, options.clock, parts.chosen(options.parts)) else 1
        )
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
    for each in boards().values():
        if each.parts:
            print(f"{each.name} has pins for PARTS={','.join(each.parts)}")


def make(
    chosen: Board, axes: int | None = None, mhz: float | None = None, wanted: Sequence[str] = ()
) -> bool:
    """Make the bitstream of the first good seed and print the result; return whether there is one."""
    tell = stages()
    (design, pins), pll = generate(chosen, OUT / chosen.name, axes, mhz, wanted), chosen.pll(mhz)
    family = chosen.device.family
    OUT.mkdir(parents=True, exist_ok=True)
    bitstream = OUT / f"{chosen.name}.{family.suffix}"
    bitstream.unlink(missing_ok=True)

    prepare(family.programs, tell)
    tell(f"{chosen.name}: synthesis")
    made = cells(design)
    problems = synthesis_complaints(design)
    problems += family.held_pins(
        {port: pin.pin for port, pin in chosen.ports(axes, wanted).items()}, chosen.pack
    )
    tried = {} if problems else _try_seeds(chosen, design, pins, pll.mhz, tell)
    good = next((seed for seed, placed in tried.items() if not _problems(placed, pll.mhz)), None)
    if good is not None:
        tell("bitstream")
        problems = pack(design, tried[good], chosen.pack, bitstream)

    print(", ".join((chosen.title, f"{design.parameters['AXES']} axes", *wanted)))
    for problem in problems:
        print(f"  PROBLEM    {problem}")
    if not tried:
        return False
    best = tried[good] if good is not None else max(tried.values(), key=_slack)
    used, capacity = best.used, chosen.device.capacity
    size = f"{used:,} of {capacity:,} {family.size_unit} ({used / capacity:.0%})"
    print(f"  build      {design.parameters['BUILD']}, as the core tells it")
    print(f"  size       {size}, {made['FF']:,} FF, {best.bram} BRAM, {made['DSP']} DSP")
    if moved := moved_registers(design):
        print(f"  registers  {moved} more packed into block RAMs")
    if good is None:
        seeds = (
            f"none of {len(tried)} seeds meets timing" if len(tried) > 1 else "the seed does not meet timing"
        )
        print(f"  FAILED     {seeds}; logs: {relative(best.folder.parent, paths.root)}")
        return False
    reached = f"{best.main_clock[0]:.1f} MHz for a clock of {pll.mhz:g} MHz"
    print(f"  f_max      {reached}: seed {good}, the first that meets timing ({len(tried)} tried)")
    if problems:
        return False
    print(f"  bitstream  {relative(bitstream, paths.root)} (load it with: {chosen.load})")
    return True


def _try_seeds(
    chosen: Board, design: Design, pins: Path, mhz: float, tell: Callable[[str], None]
) -> dict[int, Placed]:
    """Place and route seeds in parallel until one of them is good."""
    ports = {OSCILLATOR: chosen.oscillator_mhz, "spi_sclk": SPI_MHZ}
    tried: dict[int, Placed] = {}

    def run(seed: int) -> Placed:
        tell(f"{chosen.name}: place and route, seed {seed}")
        placed = place(design, seed, mhz, ports, pins)
        problems = _problems(placed, mhz)
        tell(f"{chosen.name}: seed {seed}: {'; '.join(problems) or f'{placed.main_clock[0]:.1f} MHz'}")
        return placed

    step = workers()
    with ThreadPoolExecutor(step) as pool:
        for first in range(0, len(SEEDS), step):
            some = SEEDS[first : first + step]
            tried |= zip(some, pool.map(run, some), strict=True)
            if any(placed.too_large or not _problems(placed, mhz) for placed in tried.values()):
                break
    return tried


def _slack(placed: Placed) -> float:
    """Achieved over required frequency of the worst clock."""
    return min((achieved / wanted for achieved, wanted in placed.clocks.values()), default=0.0)


def _problems(placed: Placed, mhz: float) -> tuple[str, ...]:
    """Why a result cannot be used: clocks missed, absent or wrong, or complaints of nextpnr."""
    if not placed.fits:
        return ("does not fit" if placed.too_large else "no place or no route",)
    missed = [
        f"{name}: {achieved:.1f} MHz of {wanted:.1f} MHz"
        for name, (achieved, wanted) in placed.clocks.items()
        if achieved < wanted
    ]
    if not any("sclk" in name for name in placed.clocks):
        missed.append("no clock from SCLK")
    if abs(placed.main_clock[1] - mhz) > mhz / 100:
        missed.append(f"the PLL of the top makes {placed.main_clock[1]:g} MHz instead of {mhz:g} MHz")
    said = placed.complaints[:COMPLAINTS_SHOWN]
    more = len(placed.complaints) - len(said)
    return (*missed, *said, *([f"and {more} more of the kind"] if more else []))


if __name__ == "__main__":
    sys.exit(main())
