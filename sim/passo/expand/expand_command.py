# SPDX-License-Identifier: MIT
"""`passo expand` and `passo heightmap`: from a program to plain lines."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from passo.expand.expander import Options, expand_file
from passo.expand.follow import follow
from passo.expand.height_map import PLACE_MAX, Grid, probing_program, read_height_map
from passo.expand.output import PlainLine
from passo.expand.tools import read_tools
from passo.failure import BadInputError
from passo.machine_file import read_machine
from passo.output import check_file, write_text

PROBING = ("step", "depth", "feed")


def run_expand(asked: argparse.Namespace) -> None:
    """Write the plain lines of a file, to standard output if no other is asked for. Raises BadInputError."""
    _check_out(asked)
    _write_lines(_expanded(asked.part, _options(asked)), asked)


def run_height_map(asked: argparse.Namespace) -> None:
    """Write the lines of a file that follow a map, or those that probe it. Raises BadInputError."""
    _check_out(asked)
    if asked.probe is not None:
        _refuse(asked, ("map", "origin", "tools"), "is for a program, not for --probe")
        x0, y0, x1, y1 = _numbers(asked.probe, 4, "--probe")
        chosen = {name: value for name in PROBING if (value := getattr(asked, name)) is not None}
        lines = probing_program(Grid((x0, x1), (y0, y1), **chosen))
        points = sum("G38.2" in line for line in lines)
        _write("".join(f"{line}\n" for line in lines), asked.out, f"{points} points")
        return
    _refuse(asked, PROBING, "is for --probe")
    if not asked.map:
        raise BadInputError("--map is missing: a file with x,y,z")
    options = _options(asked)
    origin = _numbers(asked.origin, 3, "--origin") if asked.origin is not None else (0.0, 0.0, 0.0)
    height_map = read_height_map(asked.map, origin)
    _write_lines(follow(_expanded(asked.part, options), height_map, options), asked)


def _check_out(asked: argparse.Namespace) -> None:
    if asked.out:
        reads = (asked.part, asked.machine, asked.tools, getattr(asked, "map", None))
        check_file(asked.out, "--out", reads=reads)


def _refuse(asked: argparse.Namespace, names: Sequence[str], why: str) -> None:
    if given := [name for name in names if getattr(asked, name) is not None]:
        raise BadInputError(f"--{given[0]} {why}")


def _options(asked: argparse.Namespace) -> Options:
    gcode = read_machine(asked.machine, takes_up=True).gcode if asked.machine else Options().gcode
    return Options(replace(gcode, levels=asked.inputs), read_tools(asked.tools), asked.at_zero)


def _expanded(part: Path, options: Options) -> list[PlainLine]:
    return expand_file(part, options, lambda text: print(text, file=sys.stderr))


def _write_lines(lines: Sequence[PlainLine], asked: argparse.Namespace) -> None:
    text = "".join(
        f"{line.text} ;{line.place.path.name}:{line.place.line}\n" if asked.numbers else f"{line.text}\n"
        for line in lines
    )
    _write(text, asked.out, f"{asked.part.name}: {len(lines)} plain lines")


def _write(text: str, out: Path | None, what: str) -> None:
    if out is None:
        sys.stdout.write(text)
    else:
        write_text(out, text)
        print(f"{what}: {out}")


def _numbers(text: str, count: int, option: str) -> list[float]:
    try:
        values = [float(value) for value in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(abs(value) <= PLACE_MAX for value in values):  # false of nan
        raise BadInputError(
            f"{option} takes {count} numbers of up to {PLACE_MAX:,} mm with commas between them, not '{text}'"
        )
    return values
