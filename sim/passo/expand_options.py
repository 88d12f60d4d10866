# SPDX-License-Identifier: MIT
"""Options of `passo expand` and `passo heightmap`."""

import argparse
from pathlib import Path
from typing import Any

from passo.option_values import number

TOOLS = "for G41, G42 and G43: tool table of LinuxCNC, in mm"
INPUTS_MOST = 9  # the probe, and the home inputs of eight motors
PROBING = (  # options of --probe: the range of their values, which those of the settings of grbl limit
    ("--step", (0.1, 100_000), "MM", "grid (default 10)"),
    ("--depth", (0, 100_000), "MM", "below 0 (default 2)"),
    ("--feed", (0.001, 1_000_000), "MM/MIN", "feed (default 50)"),
)
INPUTS = "of M66: those that are high, such as 0,2; the others are low"


def add_inputs(parser: argparse.ArgumentParser) -> None:
    """The option `--inputs`."""
    parser.add_argument("--inputs", type=_levels, metavar="P,P", help=INPUTS)


def _levels(text: str) -> int:
    try:
        numbers = [int(number) for number in text.split(",") if number]
    except ValueError:
        numbers = [INPUTS_MOST]
    if not all(0 <= number < INPUTS_MOST for number in numbers):
        raise argparse.ArgumentTypeError(f"must be numbers of inputs with commas between them, not '{text}'")
    return sum(1 << number for number in set(numbers))


def add(
    commands: Any,
) -> tuple[argparse.ArgumentParser, ...]:
    """Add both commands; return their parsers."""
    expand = commands.add_parser("expand", help="G-code as LinuxCNC has it, to plain lines for any Passo")
    expand.add_argument("part", type=Path, metavar="PART.ngc", help="program (docs/gcode.md)")
    height_map = commands.add_parser("heightmap", help="G-code that follows a probed surface, or probes it")
    source = height_map.add_mutually_exclusive_group(required=True)
    source.add_argument("part", type=Path, nargs="?", metavar="PART.ngc", help="program, expanded if needed")
    source.add_argument("--probe", metavar="X0,Y0,X1,Y1", help="write lines that probe this rectangle, mm")
    height_map.add_argument(
        "--map", type=Path, metavar="MAP.csv", help="x,y,z in mm, or a log with [PRB:...]"
    )
    height_map.add_argument("--origin", metavar="X,Y,Z", help="with a log: work zero in machine coordinates")
    for name, (least, most), unit, text in PROBING:
        height_map.add_argument(name, type=number(least, most), metavar=unit, help=f"probe: {text}")
    for parser in (expand, height_map):
        parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="write to a file")
        parser.add_argument("--machine", type=Path, metavar="MACHINE.toml", help="its axes (default: six)")
        parser.add_argument("--tools", type=Path, metavar="TOOLS.tbl", help=TOOLS)
        add_inputs(parser)
        parser.add_argument("--at-zero", action="store_true", help="the machine begins at 0, without offsets")
        parser.add_argument("--numbers", action="store_true", help="comments with the lines of the original")
    return expand, height_map
