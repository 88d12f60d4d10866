# SPDX-License-Identifier: MIT
"""`passo console`: a core with the simulated machine of the options, and its terminal."""

import argparse
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from passo.build import Parameters
from passo.expand.tools import lengths, read_tools
from passo.failure import BadInputError
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.grbl import talk as talk_grbl
from passo.grbl_setup import SettingsFile
from passo.machine import Machine, Switch, read_switch
from passo.machine_file import read_machine
from passo.move_forms import WHOLE_MAX
from passo.moves import AXES_MAX, CHANNELS_MAX
from passo.run import open_engine
from passo.shafts import SHAFTS_MAX, Shaft, Shafts, read_encoder, read_spindle
from passo.spindle_at import turning_machine_at
from passo.terminal import Terminal, talk


def run_console(options: argparse.Namespace) -> None:
    """Talk to standard input and output, or as grbl."""
    if options.grbl or options.pty or options.machine or options.settings or options.tools:
        _grbl(options)
        return
    parameters = _parameters(options)
    switches, fitted = _switches(options), _shafts(options)

    def write(text: str) -> None:
        print(text, end="", flush=text.endswith("\n"))

    with open_engine(options.engine, parameters, options.clock) as engine:
        shafts = Shafts(engine, fitted) if fitted else None
        with Terminal(Machine(engine, switches) if switches else engine, write, shafts=shafts) as terminal:
            if sys.stdin.isatty() and sys.stdout.isatty():
                from passo.prompt import GREETING, typed

                write(GREETING.format(f"{options.engine}, {options.axes} axes, {options.clock} Hz"))
                talk(typed(terminal), terminal)
            else:
                talk(sys.stdin, terminal, write if options.echo else None)


def _parameters(options: argparse.Namespace) -> Parameters:
    if not 1 <= options.axes <= AXES_MAX or not 1 <= options.clock <= WHOLE_MAX:
        raise BadInputError(f"--axes must be 1 to {AXES_MAX}, --clock 1 to {WHOLE_MAX}")
    if not 1 <= options.channels <= CHANNELS_MAX:
        raise BadInputError(f"--channels must be 1 to {CHANNELS_MAX}")
    if options.tracked and not options.trackers:
        raise BadInputError("--tracked needs --trackers")
    if not 0 <= options.tracked < options.axes:
        raise BadInputError(f"--tracked must be 0 to {options.axes - 1}: lines move an axis at least")
    return Parameters(
        channels=options.channels,
        axes=options.axes,
        inputs=int(options.inputs),
        encoders=int(options.encoders),
        outputs=int(options.outputs),
        raster=int(options.outputs),
        compare=int(options.outputs),
        trackers=int(options.trackers),
        tracked=options.tracked,
    )


def _switches(options: argparse.Namespace) -> list[Switch]:
    return _read_parts(options, "switch", "inputs", read_switch)


def _shafts(options: argparse.Namespace) -> list[Shaft]:
    found = _read_parts(options, "encoder", "encoders", read_encoder)
    found += _read_parts(options, "spindle", "encoders", lambda text: read_spindle(text, options.clock))
    if len({shaft.axis for shaft in found}) < len(found):
        raise BadInputError("--encoder and --spindle: an axis has one encoder")
    if len(found) > SHAFTS_MAX:
        raise BadInputError(f"--encoder and --spindle: at most {SHAFTS_MAX}")
    return found


def _read_parts(options: argparse.Namespace, name: str, needs: str, read: Callable[[str], Any]) -> list[Any]:
    """The parts of an option that needs another one."""
    try:
        parts = [read(text) for text in getattr(options, name)]
    except ValueError as error:
        raise BadInputError(f"--{name} {error}") from None
    if parts and not getattr(options, needs):
        raise BadInputError(f"--{name} needs --{needs}")
    if any(part.axis >= options.channels * options.axes for part in parts):
        raise BadInputError(f"--{name}: the core has no such axis")
    return parts


def _grbl(options: argparse.Namespace) -> None:
    def write(text: str) -> None:
        print(text, end="", flush=True)

    if not options.machine:
        raise BadInputError("--grbl needs --machine MACHINE.toml (docs/gcode.md)")
    machine = read_machine(options.machine, takes_up=True)
    settings = SettingsFile(options.settings) if options.settings else None
    tools = lengths(read_tools(options.tools))
    with turning_machine_at(options.engine, machine) as (engine, spindle):
        if not options.pty:
            talk_grbl(sys.stdin, Grbl(engine, machine, write, settings, tools, spindle))
            return
        with pseudo_terminal(options.pty) as terminal:
            write(f"{options.pty}: 115200 baud or any other\n")

            def said(text: str) -> None:
                with suppress(BlockingIOError):  # nobody reads: lost, as on a wire
                    os.write(terminal, text.encode())

            serve(Grbl(engine, machine, said, settings, tools, spindle), terminal)
