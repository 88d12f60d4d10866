# SPDX-License-Identifier: MIT
"""Lines typed at a terminal: prompt, line editing and history by GNU readline."""

import os
import readline
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from passo.terminal import Terminal

PROMPT = "> "
HISTORY_MAX = 1000  # lines
GREETING = "note: simulated core ({}); quit, exit or ctrl-D ends, ? lists the commands, ctrl-C interrupts\n"


def history_file() -> Path:
    """Where the lines of earlier sessions are kept."""
    folder = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(folder) / "passo" / "console_history"


def typed(terminal: Terminal) -> Iterator[str]:
    """The lines until ctrl-D. Ctrl-C discards the line at the prompt, or ends what lets time pass."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a script's background has it ignored
    with _history():
        while True:
            try:
                line = input(PROMPT)
            except EOFError:
                print()
                return
            except KeyboardInterrupt:
                print()
                continue
            with _interruptible(terminal):
                yield line


@contextmanager
def _history() -> Iterator[None]:
    """Load the history, and keep it; a folder that cannot be written is no error."""
    path = history_file()
    with suppress(OSError):
        readline.read_history_file(path)
    try:
        yield
    finally:
        readline.set_history_length(HISTORY_MAX)
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            readline.write_history_file(path)


@contextmanager
def _interruptible(terminal: Terminal) -> Iterator[None]:
    """Pass ctrl-C on to the terminal, which ends between two frames."""

    def interrupt(*_: object) -> None:
        terminal.interrupted = True

    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
