# SPDX-License-Identifier: MIT
"""How a command ends: in one sentence, with an exit status, whatever ends it."""

import io
import sys
from collections.abc import Callable

from passo.failure import BadInputError, Failure
from passo.output import BROKEN_PIPE, FULL, drop_output, release_folders

OK, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
CONTROLS = {code: "\ufffd" for code in (*range(32), *range(127, 160)) if chr(code) not in "\n\t"}


def ended(command: Callable[[], int | None]) -> int:
    """Run a command; return its exit status, which it returns itself if it fails in other ways.

    0 success, 1 mismatch or fault, 2 invalid input, 130 interrupted, 141 nobody reads its output any more.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # not if the shell has closed it
            stream.reconfigure(errors="replace")  # of a terminal that lacks a letter
    try:
        try:
            return _called(command)
        finally:
            if sys.stdout:  # not if the shell has closed it
                sys.stdout.flush()
    except BrokenPipeError:
        drop_output()
        return BROKEN_PIPE
    except OSError as error:  # all others have their own words
        drop_output()
        place = error.filename or ("standard output or a temporary file" if error.errno in FULL else "")
        reason = error.strerror or str(error)
        print(f"{place}: {reason}" if place else reason, file=sys.stderr)
        return FAILED


def _called(command: Callable[[], int | None]) -> int:
    try:
        return command() or OK
    except BadInputError as error:
        _tell(error)
        return BAD_INPUT
    except Failure as error:
        _tell(error)
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        release_folders()


def _tell(error: Exception) -> None:
    """What it quotes of a file must not command the terminal."""
    print(str(error).translate(CONTROLS), file=sys.stderr)
