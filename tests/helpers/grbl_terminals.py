# SPDX-License-Identifier: MIT
"""What a sender is connected to: a console on the PC, or the firmware, behind a pseudo-terminal."""

import contextlib
import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from passo.engine import model_engine
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.grbl_setup import core_for, machine_at
from passo.machine_file import MachineFile
from passo.toolchain import paths
from passo_stm32.grbl_board import GrblBoard, grbl_elf

STEP = 0.002  # seconds between looks at the terminal


@contextlib.contextmanager
def console_at(link: Path, machine: MachineFile) -> Iterator[Grbl]:
    """The console on the C model, in real time."""
    with machine_at("model", machine) as engine, pseudo_terminal(link) as ours:
        grbl = Grbl(engine, machine, lambda text: os.write(ours, text.encode()))
        with _thread(lambda over: serve(grbl, ours, over)):
            yield grbl


@contextlib.contextmanager
def board_at(link: Path, machine: MachineFile) -> Iterator[None]:
    """The firmware in the emulated STM32F103, as fast as that is."""
    elf = grbl_elf(paths.build / "tests" / "firmware_grbl", "AXES=3")
    with model_engine(core_for(machine), machine.clock_hz) as engine, served(link, GrblBoard(engine, elf)):
        yield


@contextlib.contextmanager
def served(link: Path, board: GrblBoard) -> Iterator[None]:
    """A board that runs, its serial line behind the pseudo-terminal."""
    with pseudo_terminal(link) as ours, _thread(lambda over: _serve_board(board, ours, over)):
        yield


def _serve_board(board: GrblBoard, terminal: int, until: Callable[[], bool]) -> None:
    os.set_blocking(terminal, False)
    told = len(board.output)  # nobody has read what it said before
    while not until():
        with contextlib.suppress(BlockingIOError, OSError):
            board.type(os.read(terminal, 4096).decode("latin-1"))
        board.run(STEP)
        os.write(terminal, board.output[told:].encode("latin-1"))
        told = len(board.output)


@contextlib.contextmanager
def _thread(serving: Callable[[Callable[[], bool]], Any]) -> Iterator[None]:
    over = threading.Event()
    thread = threading.Thread(target=serving, args=(over.is_set,))
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
