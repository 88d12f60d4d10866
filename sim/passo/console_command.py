# SPDX-License-Identifier: MIT
"""`passo console`: the console of the STM32 board, or the protocol of grbl, with a simulated core."""

import argparse
import os
import sys

from passo import grbl, terminal
from passo.build import Parameters
from passo.failure import BadInputError
from passo.grbl_setup import SettingsFile, machine_at
from passo.machine import Machine, Switch, read_switch
from passo.machine_file import read_machine
from passo.move_forms import WHOLE_MAX
from passo.moves import AXES_MAX, CHANNELS_MAX
from passo.run import open_engine


def run_console(options: argparse.Namespace) -> None:
    """Talk until the end of the input; raises BadInputError."""
    if options.grbl or options.pty or options.machine or options.settings:
        _run_grbl(options)
    else:
        _run_lines(options)


def _run_grbl(options: argparse.Namespace) -> None:
    def write(text: str) -> None:
        print(text, end="", flush=True)

    if not options.machine:
        raise BadInputError("--grbl needs --machine MACHINE.toml (docs/gcode.md)")
    machine = read_machine(options.machine)
    settings = SettingsFile(options.settings) if options.settings else None
    with machine_at(options.engine, machine) as engine:
        if not options.pty:
            grbl.talk(sys.stdin, grbl.Grbl(engine, machine, write, settings))
            return
        with grbl.pseudo_terminal(options.pty) as line:
            write(f"{options.pty}: 115200 baud or any other\n")
            said = lambda text: os.write(line, text.encode())  # noqa: E731
            grbl.serve(grbl.Grbl(engine, machine, said, settings), line)


def _switches(options: argparse.Namespace) -> list[Switch]:
    try:
        switches = [read_switch(text) for text in options.switch]
    except ValueError as error:
        raise BadInputError(f"--switch {error}") from None
    if switches and not options.inputs:
        raise BadInputError("--switch needs --inputs")
    if any(switch.axis >= options.channels * options.axes for switch in switches):
        raise BadInputError("--switch: the core has no such axis")
    return switches


def _run_lines(options: argparse.Namespace) -> None:
    def write(text: str) -> None:
        print(text, end="", flush=text.endswith("\n"))

    if not 1 <= options.axes <= AXES_MAX or not 1 <= options.clock <= WHOLE_MAX:
        raise BadInputError(f"--axes must be 1 to {AXES_MAX}, --clock 1 to {WHOLE_MAX}")
    if not 1 <= options.channels <= CHANNELS_MAX:
        raise BadInputError(f"--channels must be 1 to {CHANNELS_MAX}")
    switches = _switches(options)
    parameters = Parameters(channels=options.channels, axes=options.axes, inputs=int(options.inputs))
    with (
        open_engine(options.engine, parameters, options.clock) as engine,
        terminal.Terminal(Machine(engine, switches) if switches else engine, write) as console,
    ):
        if sys.stdin.isatty() and sys.stdout.isatty():
            from passo.prompt import GREETING, typed  # takes over the terminal

            write(GREETING.format(f"{options.engine}, {options.axes} axes, {options.clock} Hz"))
            terminal.talk(typed(console), console)
        else:
            terminal.talk(sys.stdin, console, write if options.echo else None)
