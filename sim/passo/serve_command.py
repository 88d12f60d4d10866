# SPDX-License-Identifier: MIT
"""`passo serve`: a core with the machine of the options at a socket."""

import argparse
import io
import signal
import sys
from contextlib import suppress
from typing import Any

import numpy as np

from passo.build import Parameters
from passo.failure import BadInputError
from passo.grbl_setup import served
from passo.machine_file import read_machine
from passo.move_forms import WHOLE_MAX
from passo.moves import AXES_MAX
from passo.output import check_file, write_bytes
from passo.run import open_engine
from passo.serve import Server
from passo.serve_options import AXES, CLOCK_HZ


def run_serve(options: argparse.Namespace) -> None:
    """Serve until interrupted or terminated, or until the first host is gone."""
    if options.edges:
        check_file(options.edges, "--edges")
    ended = False

    def end(*_: object) -> None:
        nonlocal ended
        ended = True

    with (
        _engine(options) as engine,
        Server(engine, options.socket, options.real_time, keep=bool(options.edges)) as server,
    ):
        for number in (signal.SIGINT, signal.SIGTERM):
            with suppress(ValueError):  # not in the main thread
                signal.signal(number, end)
        print(f"unix:{options.socket}", flush=True)
        server.serve(lambda: ended or (options.once and server.is_idle), _warn)
        if options.edges:
            data = io.BytesIO()
            np.save(data, server.events)
            write_bytes(options.edges, data.getvalue())


def _engine(options: argparse.Namespace) -> Any:
    if options.machine:
        if options.axes is not None or options.clock is not None:
            raise BadInputError("--machine has its own axes and clock: leave --axes and --clock out")
        return served(options.engine, read_machine(options.machine))
    axes = AXES if options.axes is None else options.axes
    clock_hz = CLOCK_HZ if options.clock is None else options.clock
    if not 1 <= axes <= AXES_MAX or not 1 <= clock_hz <= WHOLE_MAX:
        raise BadInputError(f"--axes must be 1 to {AXES_MAX}, --clock 1 to {WHOLE_MAX}")
    return open_engine(options.engine, Parameters(axes=axes, clock_hz=clock_hz), clock_hz)


def _warn(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
