# SPDX-License-Identifier: MIT
"""`make report BOARDS=1`: a router of three axes on each board, with all seeds of `make synth`.

Each seed is cached, and its board's row in docs/reference/report.md is written after it: an interrupted run
resumes.
"""

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from passo.console import console, stages, table
from passo.output import check_results

from passo_fpga.boards import OSCILLATOR, Board, boards
from passo_fpga.devices import SPI_MHZ
from passo_fpga.flow import Placed, place
from passo_fpga.generate import generate
from passo_fpga.pages import BOARDS, NONE, PAGE, block_of, markdown, mhz, write_block
from passo_fpga.synth import MARGIN, SEEDS, margin_of, problems_of
from passo_fpga.table import BoardError
from passo_fpga.tools import FOLDER, prepare

AXES = 3
PARTS = ("inputs", "outputs")
SPI = (18, 9)  # MHz of the firmware; a quarter of the clock is the most
STEP_CLOCKS = 2  # per step, at the highest rate
HEADER = (
    *("board", "FPGA", "blocks", "size", "lowest MHz", "median MHz", "clock", f"seeds with {MARGIN:.0%}"),
    *("SPI", "steps/s"),
)

Row = tuple[str, ...]


@dataclass(frozen=True)
class Router:
    """A core of three axes for a board, with those of PARTS that it has pins for."""

    board: Board
    parts: tuple[str, ...]

    @property
    def mhz(self) -> float:
        """The clock that the PLL makes."""
        return self.board.pll(None, self.parts).mhz


def router(board: Board) -> Router:
    """The router of a board; leaves parts out from the last on if they have no pins for all axes."""
    for count in range(len(PARTS), 0, -1):
        try:
            board.ports(AXES, PARTS[:count])
        except BoardError:
            continue
        return Router(board, PARTS[:count])
    return Router(board, ())


def seeds(chosen: Router, folder: Path | None = None) -> Callable[[int], Placed]:
    """A function that places and routes a seed."""
    board = chosen.board
    where = folder or FOLDER / "routers" / board.name
    design, pins = generate(board, where, AXES, None, chosen.parts, f"router-{board.name}")
    ports = {OSCILLATOR: board.oscillator_mhz, "spi_sclk": SPI_MHZ}
    return lambda seed: place(design, seed, chosen.mhz, ports, pins)


def row(chosen: Router, placed: Sequence[Placed]) -> Row:
    """What the page says of these seeds."""
    board, device = chosen.board, chosen.board.device
    reached = [run.main_clock[0] if run.fits else 0.0 for run in placed]
    good = sum(not problems_of(run, chosen.mhz) and margin_of(run) >= MARGIN for run in placed)
    spi = next((f"{most} MHz" for most in SPI if 4 * most <= chosen.mhz), NONE)
    used = max(run.used for run in placed)
    return (
        *(board.name, board.title.partition("(")[2].rstrip(")"), ", ".join(chosen.parts) or NONE),
        f"{used:,} of {device.capacity:,} {device.family.size_unit} ({used / device.capacity:.0%})",
        *(mhz(min(reached)), mhz(statistics.median(reached)), f"{chosen.mhz:g} MHz"),
        f"{good} of {len(placed)}",
        *(spi, f"{chosen.mhz / STEP_CLOCKS:g} M"),
    )


def report(names: Sequence[str]) -> None:
    """Measure boards, write and print their rows."""
    check_results(PAGE)
    tell, known = stages(), boards()
    shown = table(f"{AXES} axes on boards", *HEADER)
    for name in names:
        chosen = router(known[name])
        prepare(chosen.board.device.family.programs, tell)
        run, placed = seeds(chosen), list[Placed]()
        for seed in SEEDS:
            placed.append(run(seed))
            words = problems_of(placed[-1], chosen.mhz) or (f"{placed[-1].main_clock[0]:.1f} MHz",)
            tell(f"{name}: seed {seed}: {'; '.join(words)}")
            write(row(chosen, placed))
        shown.add_row(*row(chosen, placed))
    console.print(shown)


def write(new: Row) -> None:
    """Write the row of a board into the page; the others stay."""
    lines = block_of(PAGE, *BOARDS).splitlines()[2:]
    rows = {cells[0]: cells for cells in (tuple(line.strip("| ").split(" | ")) for line in lines)}
    rows |= {new[0]: new}
    write_block(PAGE, markdown(HEADER, [rows[name] for name in sorted(rows)]), *BOARDS)
