# SPDX-License-Identifier: MIT
"""`make synth BOARD=...`: a bitstream for a board, in build/synth."""

import argparse
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from passo.console import console, stages, table
from passo.ending import ended
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
MARGIN = 0.03  # of every clock
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
    parser.add_argument("--tracked", type=int, default=0, help="the last axes, which have no lines")
    options = parser.parse_args(arguments)
    try:
        if not options.board:
            _list()
            return 0
        chosen, wanted = board(options.board), parts.chosen(options.parts)
        more = _without_lines(options.tracked, options.axes or chosen.axes, wanted)
        return 0 if make(chosen, options.axes, options.clock, wanted, more=more) else 1
    except (BoardError, PllError) as error:
        print(f"make synth: {error}", file=sys.stderr)
        return 2
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1


def _without_lines(tracked: int, axes: int, wanted: Sequence[str]) -> dict[str, int]:
    """The parameter of axes that only trackers move."""
    if tracked and "trackers" not in wanted:
        raise BoardError("axes without lines need trackers: PARTS=trackers")
    if not 0 <= tracked < axes:
        raise BoardError(f"axes without lines: {tracked} of {axes}; must be 0 to {axes - 1}")
    return {"TRACKED": tracked} if tracked else {}


def _list() -> None:
    shown = table("make synth BOARD=...", "board", "axes", "clock", "")
    shown.columns[-1].justify = "left"
    for each in boards().values():
        shown.add_row(each.name, str(each.axes), f"{each.clock_mhz:g} MHz", each.title)
    console.print(shown)
    for each in boards().values():
        if each.parts:
            print(f"{each.name} has pins for PARTS={','.join(each.parts)}")
    pinless = ",".join(part for part in parts.PORTS if part not in parts.WITH_PINS)
    print(f"every board, without pins: PARTS={pinless}")


@dataclass(frozen=True)
class Bitstream:
    """A bitstream, and what it is made of."""

    path: Path
    placed: Placed
    capacity: int
    unit: str  # of size and capacity
    mhz: float  # of the core
    seed: int
    build: int  # as the core tells it

    @property
    def size(self) -> str:
        """What it takes of the FPGA."""
        used = self.placed.used
        return f"{used:,} of {self.capacity:,} {self.unit} ({used / self.capacity:.0%})"

    @property
    def clock(self) -> str:
        """What it reaches."""
        reached = f"{self.placed.main_clock[0]:.1f} MHz for a clock of {self.mhz:g} MHz"
        return f"{reached}, margin {margin_of(self.placed):.1%}"


def make(
    chosen: Board,
    axes: int | None = None,
    mhz: float | None = None,
    wanted: Sequence[str] = (),
    out: Path | None = None,
    tell: Callable[[str], None] | None = None,
    more: Mapping[str, int] = MappingProxyType({}),
) -> Bitstream | None:
    """Make the bitstream of the first good seed, in build/synth or as `out`, and print the result.

    `more` are parameters of the top.

    A seed is good if every clock has MARGIN; without one, the best of those that meet all clocks is taken.
    """
    tell = tell or stages()
    name = f"machine-{re.sub(r'[^A-Za-z0-9]', '_', out.stem)}" if out else f"board-{chosen.name}"
    folder = OUT / (name if out else chosen.name)
    (design, pins), pll = generate(chosen, folder, axes, mhz, wanted, name, more), chosen.pll(mhz, wanted)
    family = chosen.device.family
    bitstream = out or OUT / f"{chosen.name}.{family.suffix}"
    bitstream.parent.mkdir(parents=True, exist_ok=True)
    bitstream.unlink(missing_ok=True)

    prepare(family.programs, tell)
    tell(f"{chosen.name}: synthesis")
    cells_made = cells(design)
    problems = synthesis_complaints(design)
    at = {port: pin.pin for port, pin in chosen.ports(axes, wanted).items()}
    problems += family.held_pins(chosen.device.part, at, chosen.pack)
    tried = {} if problems else _try_seeds(chosen, design, pins, pll.mhz, tell)
    meet = {seed: placed for seed, placed in tried.items() if not problems_of(placed, pll.mhz)}
    good = next((seed for seed, placed in meet.items() if margin_of(placed) >= MARGIN), None)
    taken = good if good is not None else max(meet, key=lambda seed: margin_of(meet[seed]), default=None)
    if taken is not None:
        tell("bitstream")
        problems = pack(design, tried[taken], chosen.pack, bitstream)

    print(", ".join((chosen.title, f"{design.parameters['AXES']} axes", *wanted)))
    for problem in problems:
        print(f"  PROBLEM    {problem}")
    if not tried:
        return None
    best = tried[taken] if taken is not None else max(tried.values(), key=margin_of)
    facts = chosen.device.capacity, family.size_unit, pll.mhz, taken or 0, int(design.parameters["BUILD"])
    made = Bitstream(bitstream, best, *facts)
    print(f"  build      {made.build}, as the core tells it")
    print(f"  size       {made.size}, {cells_made['FF']:,} FF, {best.bram} BRAM, {cells_made['DSP']} DSP")
    if moved := moved_registers(design):
        print(f"  registers  {moved} more packed into block RAMs")
    if taken is None:
        seeds = (
            f"none of {len(tried)} seeds meets timing" if len(tried) > 1 else "the seed does not meet timing"
        )
        print(f"  FAILED     {seeds}; logs: {relative(best.folder.parent, paths.root)}")
        return None
    why = f"the first with {MARGIN:.0%}" if good is not None else f"the best: none has {MARGIN:.0%}"
    print(f"  f_max      {made.clock}: seed {taken}, {why} ({len(tried)} tried)")
    if problems:
        return None
    print(f"  bitstream  {relative(bitstream, paths.root)} (load it with: {chosen.load})")
    return made


def _try_seeds(
    chosen: Board, design: Design, pins: Path, mhz: float, tell: Callable[[str], None]
) -> dict[int, Placed]:
    """Place and route seeds in parallel until one of them is good."""
    ports = {OSCILLATOR: chosen.oscillator_mhz, "spi_sclk": SPI_MHZ}
    tried: dict[int, Placed] = {}

    def run(seed: int) -> Placed:
        tell(f"{chosen.name}: place and route, seed {seed}")
        placed = place(design, seed, mhz, ports, pins)
        problems = problems_of(placed, mhz)
        tell(f"{chosen.name}: seed {seed}: {'; '.join(problems) or f'{placed.main_clock[0]:.1f} MHz'}")
        return placed

    def is_last(placed: Placed) -> bool:
        return placed.too_large or (not problems_of(placed, mhz) and margin_of(placed) >= MARGIN)

    step = workers()
    with ThreadPoolExecutor(step) as pool:
        for first in range(0, len(SEEDS), step):
            some = SEEDS[first : first + step]
            tried |= zip(some, pool.map(run, some), strict=True)
            if any(map(is_last, tried.values())):
                break
    return tried


def margin_of(placed: Placed) -> float:
    """By how much the worst clock exceeds what is required, as a ratio."""
    return min((achieved / wanted for achieved, wanted in placed.clocks.values()), default=0.0) - 1


def problems_of(placed: Placed, mhz: float) -> tuple[str, ...]:
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
    sys.exit(ended(main))
