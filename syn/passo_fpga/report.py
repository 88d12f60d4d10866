# SPDX-License-Identifier: MIT
"""`make report`: size and speed of the core on all devices.

A full report writes build/report.json, docs/reference/report.md and the goals between two marks in
README.md; QUICK=1 writes only the goals. A partial report (ONLY=, QUICK=1) is printed and written to
build/report-part.json.
Each run of a netlist with a seed is cached in build/fpga: an interrupted report resumes, and after a change
only the affected runs are repeated. PARTS=1 measures the optional parts of the core instead, BOARDS=1 a
router on each board.
"""

import argparse
import statistics
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from itertools import product
from threading import Lock
from typing import Any, NamedTuple

from passo.console import Estimate, console, stages
from passo.ending import ended
from passo.failure import Failure
from passo.output import check_results, write_json
from passo.toolchain import paths

from passo_fpga import boards_report, pages, parts_report
from passo_fpga.boards import names
from passo_fpga.design import SPI, Design, core
from passo_fpga.devices import DEVICES, SPI_MHZ
from passo_fpga.flow import Placed, cells, place, synthesize
from passo_fpga.split import difference, split
from passo_fpga.table import BoardError
from passo_fpga.tools import ToolError, prepare, versions, workers

REPORT = paths.build / "report.json"
SEEDS = range(1, 4)
GOAL_SEEDS = range(1, 9)  # of the designs that have a goal
SIZES = ((1, 1), (1, 2), (1, 4), (1, 6), (1, 8), (2, 1), (2, 2), (4, 1), (4, 2))  # channels, axes
SPLIT_DEVICES = ("hx8k", "ecp5-25")
SPLIT_SIZE = (1, 4)
CHANNEL_DEVICE = "hx8k"  # of the price of a further channel, module by module
BUS_TOPS = ("passo_wishbone", "passo_axi_lite")
TOP_SIZE = (1, 4)

WHOLE = ("inputs", "encoders", "outputs", "raster", "compare")


class Key(NamedTuple):
    """A core that is measured."""

    device: str
    top: str
    size: tuple[int, int]  # channels, axes
    parts: tuple[str, ...] = ()
    without: tuple[str, ...] = ()  # ports, if the package has fewer pins


@dataclass(frozen=True)
class Goal:
    """Goal for a device: `size` in its unit, and the clocks in MHz over the seeds; 0: any that is routed."""

    device: str
    axes: int
    median_mhz: int
    minimum_mhz: int
    size: int
    parts: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    @property
    def key(self) -> Key:
        """Of the core."""
        return Key(self.device, SPI, (1, self.axes), self.parts, self.without)


GOALS = (
    Goal("hx8k", 4, 132, 122, 3400),
    Goal("hx8k", 3, 0, 0, 3650, ("inputs",)),
    Goal("hx8k", 3, 115, 105, 4500, boards_report.PARTS),
    Goal("hx8k", 3, 105, 95, 5700, WHOLE),
    Goal("up5k", 6, 49, 47, 5280),
    Goal("up5k", 3, 42, 40, 4600, boards_report.PARTS, ("irq", "running", "spi_miso_enable")),
    Goal("ecp5-25", 6, 190, 180, 6000),
    Goal("gw1nr-9c", 6, 100, 90, 8640),
    Goal("gw1nr-9c", 3, 90, 84, 5000, boards_report.PARTS),
    Goal("gw1nr-9c", 3, 0, 0, 8640, WHOLE),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if all runs ended, whether they fit or not; 2 for an unknown device."""
    parser = argparse.ArgumentParser(prog="make report", description="Measure size and speed of the core.")
    parser.add_argument("--only", default="", help=f"comma-separated devices: {','.join(DEVICES)}")
    parser.add_argument("--quick", action="store_true", help="only the rows of the goals")
    parser.add_argument("--parts", action="store_true", help="measure the optional blocks instead")
    parser.add_argument("--boards", action="store_true", help="measure a router on each board instead")
    options = parser.parse_args(arguments)
    if options.boards:
        return _boards(options.only)
    chosen = [name for name in options.only.split(",") if name] or list(DEVICES)
    if unknown := set(chosen) - set(DEVICES):
        message = f"there is no device '{min(unknown)}'; choose of {', '.join(DEVICES)}"
        print(f"make report: {message}", file=sys.stderr)
        return 2
    if options.parts:
        return _parts(chosen)
    goals = [goal.key for goal in GOALS if goal.device in chosen]
    tops = [*product(chosen, (SPI,), SIZES), *product(chosen, BUS_TOPS, (TOP_SIZE,))]
    others = [] if options.quick else [Key(*each) for each in tops]
    part = REPORT.with_name("report-part.json")
    whole = not options.quick and set(chosen) == set(DEVICES)
    try:
        check_results(*([REPORT, pages.PAGE] if whole else [part]))
        report = measure(
            list(dict.fromkeys(goals if options.quick else goals + others)), splits=not options.quick
        )
    except (ToolError, Failure) as error:
        print(error, file=sys.stderr)
        return 1
    if whole:
        write_json(report, REPORT)
        pages.write(report)
    else:
        write_json(report, part)
        unchanged = pages.PAGE.relative_to(paths.root)
        console.print(f"partial report: {part.relative_to(paths.root)}; {unchanged} is unchanged")
        if len(goals) == len(GOALS):
            pages.write_goals(report)
    pages.show(report)
    return 0


def _parts(chosen: Sequence[str]) -> int:
    try:
        parts_report.report(chosen, set(chosen) == set(DEVICES))
    except ToolError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def _boards(only: str) -> int:
    known = names()
    chosen = [name for name in only.split(",") if name] or known
    if unknown := set(chosen) - set(known):
        message = f"there is no board '{min(unknown)}'; choose of {', '.join(known)}"
        print(f"make report: {message}", file=sys.stderr)
        return 2
    try:
        boards_report.report(chosen)
    except (ToolError, BoardError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


def measure(wanted: Sequence[Key], splits: bool) -> dict[str, Any]:
    """Run what is not cached, in parallel, and collect the figures."""
    tell = stages()
    devices = list(dict.fromkeys(DEVICES[key.device] for key in wanted))
    prepare(dict.fromkeys(program for device in devices for program in device.family.programs), tell)
    designs = {key: core(DEVICES[key.device], *key[1:]) for key in wanted}
    named = {device.name for device in devices} if splits else set()
    hierarchical = {name: _hierarchical(name, SPLIT_SIZE) for name in SPLIT_DEVICES if name in named}
    channels = [_hierarchical(CHANNEL_DEVICE, (number, 1)) for number in (1, 2) if CHANNEL_DEVICE in named]
    with ThreadPoolExecutor(workers()) as pool:
        count = _counter(len(designs) + len(hierarchical) + len(channels))

        def make(design: Design) -> None:
            synthesize(design)
            tell(f"synthesis {count()}: {design.name}")

        list(pool.map(make, [*designs.values(), *hierarchical.values(), *channels]))

        routed = [key for key, design in designs.items() if design.device.family.place]
        count = _counter(sum(len(_seeds(key)) for key in routed))

        def run(key: Key, seed: int) -> Placed:
            placed = _place(designs[key], seed)
            done = count(len(_seeds(key)) if placed.too_large else 1)
            tell(f"place and route {done}: {designs[key].name}, seed {seed}: {_words(placed)}")
            return placed

        # the seeds of a design run in sequence, because a design that is too large is run only once
        def runs(key: Key) -> list[Placed]:
            seed, *seeds = _seeds(key)
            first = run(key, seed)
            return [first] if first.too_large else [first, *(run(key, seed) for seed in seeds)]

        placed = {key: [] for key in designs} | dict(zip(routed, pool.map(runs, routed), strict=True))
    return {
        "seeds": list(SEEDS),
        "goal_seeds": list(GOAL_SEEDS),
        "tools": {device.name: versions(device.family.programs) for device in devices},
        "goals": [asdict(goal) for goal in GOALS if DEVICES[goal.device] in devices],
        "designs": [_row(designs[key], key, placed[key]) for key in designs if key.top == SPI],
        "tops": [
            _row(designs[key], key, placed[key]) for key in designs if key.size == TOP_SIZE and not key.parts
        ],
        "split": {name: split(design) for name, design in hierarchical.items()},
        "split_size": list(SPLIT_SIZE),
        "channel_device": CHANNEL_DEVICE,
        "channel": difference(*map(split, channels)) if channels else [],
    }


def _hierarchical(name: str, size: tuple[int, int]) -> Design:
    design = core(DEVICES[name], size=size)
    return replace(design, name=f"{design.name}-split", flatten=False)


def _seeds(key: Key) -> Sequence[int]:
    return GOAL_SEEDS if key in [goal.key for goal in GOALS] else SEEDS


def _counter(total: int) -> Callable[..., str]:
    """A function that adds to a count and returns it as text, with an estimate of what is left."""
    done, estimate = 0, Estimate(total)
    lock = Lock()

    def count(more: int = 1) -> str:
        nonlocal done
        with lock:
            done += more
            return estimate.counted(done)

    return count


def _place(design: Design, seed: int) -> Placed:
    mhz = design.device.target_mhz
    clocks = {"clk": mhz, "spi_sclk": SPI_MHZ} if design.top == SPI else {"clk": mhz}
    return place(design, seed, mhz, clocks)


def _words(placed: Placed) -> str:
    if placed.fits:
        return f"{placed.main_clock[0]:.1f} MHz"
    return "does not fit" if placed.too_large else "no place or no route"


def _row(design: Design, key: Key, placed: Sequence[Placed]) -> dict[str, Any]:
    device, top, (channels, axes), parts, _ = key
    made = cells(design)
    # a seed that nextpnr cannot place or route counts as 0 MHz
    reached = [run.main_clock[0] if run.fits else 0.0 for run in placed]
    median = statistics.median(reached) if reached else None  # none: synthesis only
    return {
        "device": device,
        "top": top,
        "channels": channels,
        "axes": axes,
        "parts": list(parts),
        "fits": median is None or median > 0,
        "size": placed[0].used if placed else made["LUT"],
        "capacity": design.device.capacity,
        "lut": made["LUT"],
        "ff": made["FF"],
        "bram": placed[0].bram if placed else made["BRAM"],
        "dsp": made["DSP"],
        "f_max": [round(mhz, 2) for mhz in reached],
        "f_max_minimum": round(min(reached), 1) if median else None,
        "f_max_median": round(median, 1) if median else None,
    }


if __name__ == "__main__":
    sys.exit(ended(main))
