# SPDX-License-Identifier: MIT
"""The command `passo`. Subcommands import lazily, so that `passo --help` is fast."""

import argparse
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from passo import __version__, campaign_options, console_options, expand_options, part_options, serve_options
from passo.ending import FAILED, INTERRUPTED, OK, ended
from passo.failure import BadInputError

PART_SUFFIXES = (".nc", ".ngc", ".gcode", ".tap")
LINES_MAX = 1_000_000  # of the long file of `passo firmware --grbl`


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit status (passo.ending)."""

    def command() -> int:
        options = _parser().parse_args(arguments)
        return options.command(options)

    return ended(command)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="passo", description="Simulate the Passo step-pulse generator.")
    parser.add_argument("--version", action="version", version=f"passo {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    run = commands.add_parser("run", help="run a move file or G-code and check every edge")
    run.set_defaults(command=_run)
    run.add_argument(
        "moves", type=Path, nargs="+", metavar="MOVES.toml", help=f"move file, or {part_options.PARTS}"
    )
    run.add_argument(
        "--engine",
        choices=console_options.ENGINES,
        help="engine to run; both: RTL and model, compared edge for edge "
        "(default; G-code without waves: model)",
    )
    run.add_argument("--out", type=Path, metavar="DIR", help="output folder (default build/run/NAME)")
    run.add_argument(
        "--waves",
        nargs="?",
        const="2ms",
        metavar="WINDOW",
        help="write waves.fst, all signals of the RTL: 2ms (default) is from reset to 2 ms after the "
        "start of motion, 100ms..102ms a window of it",
    )
    run.add_argument("--plot", action="store_true", help="write motion.png, for G-code path.png")
    run.add_argument("--report", action="store_true", help="write report.html, zoomable to single clocks")
    part_options.add(run)
    preview = commands.add_parser("preview", help="time, extent, speeds and limits of G-code, in seconds")
    preview.set_defaults(command=_preview)
    preview.add_argument("parts", type=Path, nargs="+", metavar="PART.nc", help=part_options.PARTS)
    preview.add_argument("--out", type=Path, metavar="DIR", help="output folder (default build/run/NAME)")
    part_options.add(preview)
    expand, height_map = expand_options.add(commands)
    expand.set_defaults(command=_expand)
    height_map.set_defaults(command=_height_map)
    shape = commands.add_parser("shape", help="create and check the table of a user-defined shape")
    shape.set_defaults(command=_shape)
    source = shape.add_mutually_exclusive_group(required=True)
    source.add_argument("--formula", metavar="F", help="formula in u, 0 to 1: 'u^2 * (3 - 2 * u)'")
    source.add_argument("--csv", type=Path, metavar="FILE", help="read a curve (u,s) or a table (k,point)")
    shape.add_argument("--out", type=Path, metavar="FILE", help="write the table: FILE.csv or FILE.toml")
    shape.add_argument("--plot", type=Path, metavar="FILE.png", help="draw it")
    made = commands.add_parser("make", help="from a machine file: bitstream, firmware, settings, wiring")
    made.set_defaults(command=_make)
    made.add_argument(
        "machine",
        type=Path,
        nargs="?",
        metavar="MACHINE.toml",
        help="machine file (docs/gcode.md); without it, a few questions write machine.toml",
    )
    made.add_argument("--out", type=Path, metavar="DIR", help="output folder (default build/machines/NAME)")
    made.add_argument("--no-build", action="store_true", help="no images: only check, and write the texts")
    checked = commands.add_parser(
        "check", help="first power-on: try each input, output and motor of a machine"
    )
    checked.set_defaults(command=_check)
    checked.add_argument("machine", type=Path, metavar="MACHINE.toml", help="machine file (docs/gcode.md)")
    checked.add_argument(
        "--port", type=Path, help="serial port of the grbl image; without it, the machine is simulated"
    )
    console_options.add(commands).set_defaults(command=_console)
    serve_options.add(commands).set_defaults(command=_serve)
    firmware = commands.add_parser(
        "firmware",
        help="type moves at the console of the emulated STM32 firmware, with a simulated core at its pins",
    )
    firmware.set_defaults(command=_firmware)
    firmware.add_argument(
        "moves",
        type=Path,
        nargs="*",
        metavar="MOVES.toml",
        help="move files (default: short ones in examples/)",
    )
    firmware.add_argument("--engine", choices=("rtl", "model"), default="rtl", help="the core (default rtl)")
    firmware.add_argument(
        "--table",
        action="store_true",
        help="measure it and write docs/reference/firmware_report.md",
    )
    firmware.add_argument(
        "--grbl",
        action="store_true",
        help="with --table: measure the grbl image and write docs/reference/firmware_gcode_report.md",
    )
    firmware.add_argument("--lines", type=int, metavar="N", help="with --grbl: length of the long file")
    rtl = commands.add_parser("rtl", help="list the Verilog sources of the core, for makefiles")
    rtl.set_defaults(command=_rtl)
    rtl.add_argument("--folder", action="store_true", help="print only their folder, the include path")
    campaign_options.add(commands).set_defaults(command=_campaign)
    demo = commands.add_parser("demo", help="run the moves in examples/; pictures in build/demo/")
    demo.set_defaults(command=_demo)
    bench = commands.add_parser("bench", help="measure the speed of the engines")
    bench.set_defaults(command=_bench)
    return parser


def _run(options: argparse.Namespace) -> int:
    first = options.moves[0]
    named = first.suffix.lower() in PART_SUFFIXES or str(first) == "-"
    if named or (options.machine and first.suffix.lower() != ".toml"):
        from passo.part_command import Asked, run_part

        asked = Asked(
            options.machine,
            options.tools,
            options.engine or ("both" if options.waves else "model"),
            options.out,
            options.plot,
            options.report,
            options.waves,
            options.look_ahead,
            part_options.lines_of(options),
            options.inputs,
            options.surface,
        )
        return OK if run_part(options.moves, asked) else FAILED
    from passo.run_command import Wanted, run_file

    part_options.refuse(options, PART_SUFFIXES)
    if len(options.moves) > 1:
        raise BadInputError(f"{options.moves[1]}: a move file runs alone")
    wanted = Wanted(options.waves, options.plot, options.report)
    return OK if run_file(first, options.engine or "both", options.out, wanted) else FAILED


def _preview(options: argparse.Namespace) -> int:
    from passo.preview_command import run_preview

    done = run_preview(
        options.parts,
        options.machine,
        options.tools,
        options.out,
        options.look_ahead,
        part_options.lines_of(options),
        options.inputs,
        options.surface,
    )
    return OK if done else FAILED


def _expand(options: argparse.Namespace) -> int:
    from passo.expand.expand_command import run_expand

    run_expand(options)
    return OK


def _height_map(options: argparse.Namespace) -> int:
    from passo.expand.expand_command import run_height_map

    run_height_map(options)
    return OK


def _shape(options: argparse.Namespace) -> int:
    from passo import shape
    from passo.formula import formula
    from passo.output import check_file

    for option in ("out", "plot"):
        if path := getattr(options, option):
            check_file(path, f"--{option}", reads=[options.csv])
    if options.out:
        shape.check_table(options.out)
    if options.plot:
        shape.check_picture(options.plot)
    points = (
        shape.read_table(options.csv) if options.formula is None else shape.sample(formula(options.formula))
    )
    facts = shape.check(points)
    if options.out:
        shape.write_table(points, options.out)
    if options.plot:
        shape.plot_table(points, options.plot)
    steepest = max(b - a for a, b in pairwise((*points, shape.ONE))) * shape.POINTS / shape.ONE
    symmetric = "symmetric" if facts.symmetric else "not symmetric"
    print(f"mean {float(facts.mean):.6f}, {symmetric}, slope at most {steepest:.3f}")
    return OK


def _make(options: argparse.Namespace) -> int:
    if not options.machine:
        from passo.machine_questions import ask_machine

        ask_machine(Path("machine.toml"))
        return OK
    from passo.make_command import make_machine

    return OK if make_machine(options.machine, options.out, not options.no_build) else FAILED


def _check(options: argparse.Namespace) -> int:
    from passo.machine_check import check_machine

    check_machine(options.machine, options.port)
    return OK


def _console(options: argparse.Namespace) -> int:
    from passo.console_command import run_console

    run_console(options)
    return OK


def _serve(options: argparse.Namespace) -> int:
    from passo.serve_command import run_serve

    run_serve(options)
    return OK


def _firmware(options: argparse.Namespace) -> int:
    from passo_stm32 import MachineError

    from passo.toolchain import need_repository

    need_repository("the firmware")
    if (options.grbl and not options.table) or (options.lines is not None and not options.grbl):
        raise BadInputError("--grbl needs --table, and --lines needs --grbl")
    if options.table and options.moves:
        raise BadInputError(f"{options.moves[0]}: --table takes no move files")
    if options.lines is not None and not 1 <= options.lines <= LINES_MAX:
        raise BadInputError(f"--lines must be 1 to {LINES_MAX}, not {options.lines}")
    try:
        if options.grbl:
            from passo_stm32 import grbl_bench

            grbl_bench.bench(options.lines or grbl_bench.LINES)
            return OK
        if options.table:
            from passo_stm32.bench import bench

            bench()
            return OK
        from passo_stm32.demo import demo

        return OK if demo(options.moves, options.engine) else FAILED
    except (MachineError, TimeoutError) as error:
        print(error, file=sys.stderr)
        return FAILED


def _rtl(options: argparse.Namespace) -> int:
    from passo.build import rtl_sources
    from passo.toolchain import paths

    print(*([paths.rtl] if options.folder else rtl_sources()), sep="\n")
    return OK


def _campaign(options: argparse.Namespace) -> int:
    from passo.campaign_command import campaign_of, run_campaign

    return OK if run_campaign(*campaign_of(options)) else FAILED


def _demo(options: argparse.Namespace) -> int:
    from passo.demo import demo

    return OK if demo() else FAILED


def _bench(options: argparse.Namespace) -> int:
    from passo.bench import bench

    return OK if bench() else INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
