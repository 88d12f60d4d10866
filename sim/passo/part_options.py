# SPDX-License-Identifier: MIT
"""Options of `passo run` with G-code and of `passo preview`."""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from passo import expand_options
from passo.failure import BadInputError
from passo.option_values import whole

if TYPE_CHECKING:
    from passo.part import Lines

PARTS = "G-code: .nc .ngc .gcode .tap, one file or several in turn; - is standard input"
LOOK_AHEAD = 48  # as on an STM32F103
LOOK_AHEAD_MIN, LOOK_AHEAD_MAX = 4, 100_000


def add(parser: argparse.ArgumentParser) -> None:
    """Add them to a command."""
    parser.add_argument(
        "--machine", type=Path, metavar="MACHINE.toml", help="of G-code: axes and limits (docs/gcode.md)"
    )
    parser.add_argument("--tools", type=Path, metavar="TOOLS.tbl", help=expand_options.TOOLS)
    expand_options.add_inputs(parser)
    parser.add_argument(
        "--surface",
        type=Path,
        metavar="MAP.csv",
        help="x,y,z in mm and machine coordinates: what probes (G38) touch",
    )
    parser.add_argument(
        "--from",
        dest="first",
        type=int,
        metavar="LINE",
        help="play G-code from this line on, with the modes of those before",
    )
    parser.add_argument("--to", dest="last", type=int, metavar="LINE", help="and up to this one")
    parser.add_argument(
        "--look-ahead",
        type=whole(LOOK_AHEAD_MIN, LOOK_AHEAD_MAX),
        default=LOOK_AHEAD,
        metavar="N",
        help=f"lines of the planner (default {LOOK_AHEAD})",
    )


def lines_of(options: argparse.Namespace) -> "Lines | None":
    """Which lines are played; None: all. Raises BadInputError."""
    from passo.part import Lines

    first, last = 1 if options.first is None else options.first, options.last
    if options.first is None and last is None:
        return None
    if first < 1 or (last is not None and last < first):
        to = "" if last is None else f" --to {last}"
        raise BadInputError(f"--from {first}{to}: lines count from 1, the first one first")
    return Lines(first, last)


def refuse(options: argparse.Namespace, suffixes: Sequence[str]) -> None:
    """Of a move file: raises BadInputError if one of them is given."""
    given = {
        "--machine": options.machine,
        "--tools": options.tools,
        "--inputs": options.inputs is not None,
        "--surface": options.surface,
        "--from": options.first is not None,
        "--to": options.last is not None,
        "--look-ahead": options.look_ahead != LOOK_AHEAD,
    }
    if named := [name for name, value in given.items() if value]:
        raise BadInputError(f"{named[0]} is for G-code: {', '.join(suffixes)}")
