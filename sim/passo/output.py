# SPDX-License-Identifier: MIT
"""Files that the command writes: each appears under its name when it is complete, or not at all."""

import errno
import fcntl
import json
import os
import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from passo.failure import BadInputError, Failure

BROKEN_PIPE = 128 + signal.SIGPIPE  # exit status, as of a program that the signal ends
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_held: dict[Path, int] = {}  # folders for results, by the handles that lock them


def refusal(path: Path, error: OSError) -> Failure | BadInputError:
    """What to raise if a file cannot be written: a full disk is a fault, other places are bad input."""
    text = f"{path}: {error.strerror or error}"
    return Failure(text) if error.errno in FULL else BadInputError(text)


def check_file(path: Path, option: str, makes: bool = False, reads: Iterable[Path | None] = ()) -> None:
    """Refuse a file that cannot be written, before the work for it begins. Raises BadInputError.

    `makes`: its folder is made if it is missing; `reads`: files that the command reads, which it must not be.
    """
    with _refused(path, option):
        if path.is_file() and any(one and one.exists() and path.samefile(one) for one in reads):
            raise BadInputError(f"{option} {path}: the command reads this file: choose another one")
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if path.exists() and not path.is_file():
            check_access(path)
        else:
            _check_folder(path.resolve().parent, makes)


def check_results(*files: Path) -> None:
    """The same of files whose places are fixed; their folders are made."""
    for path in files:
        check_file(path, "result", makes=True)


def check_folder(folder: Path, option: str) -> None:
    """The same of a folder for results."""
    with _refused(folder, option):
        _check_folder(folder.resolve(), makes=True)


@contextmanager
def _refused(path: Path, option: str) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError) as error:  # the latter of links in a circle
        reason = getattr(error, "strerror", None) or "cannot be written"
        raise BadInputError(f"{option} {path}: {reason}") from None


def _check_folder(place: Path, makes: bool) -> None:
    while makes and not place.exists():
        place = place.parent
    place.stat()  # says if it is missing
    if not place.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    check_access(place)


def check_access(place: Path, mode: int = os.W_OK) -> None:
    """Raises PermissionError."""
    if not os.access(place, mode):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


@contextmanager
def complete(path: Path) -> Iterator[Path]:
    """Yield a path beside `path`, of the same suffix, that takes its place when the block has ended.

    A device or pipe is itself. Raises Failure or BadInputError in one sentence.
    """
    try:
        if path.exists() and not path.is_file():
            yield path
            return
        made = path.resolve()
        part = made.with_name(f".{os.getpid()}.{made.name}")
        try:
            yield part
            part.replace(made)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise refusal(path, error) from None


def make_folder(folder: Path) -> None:
    """Make a folder for results. Raises Failure or BadInputError."""
    empty_folder(folder, ())


def empty_folder(folder: Path, results: Iterable[str]) -> None:
    """Make a folder for results, delete those of an earlier run, and keep other runs out.

    Raises Failure or BadInputError, also while another process has the folder.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name in results:
            _hold(folder.resolve())
            (folder / name).unlink(missing_ok=True)
    except BlockingIOError:
        text = f"{folder}: another run writes its results there: wait for its end, or choose another folder"
        raise BadInputError(text) from None
    except OSError as error:
        raise refusal(folder, error) from None


def _hold(folder: Path) -> None:
    """Lock a folder until the end of the command, where the file system can. Raises BlockingIOError."""
    if folder in _held:
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise
    except OSError:  # a file system without locks
        os.close(handle)
        return
    _held[folder] = handle


def release_folders() -> None:
    """Let other runs have the folders."""
    while _held:
        os.close(_held.popitem()[1])


def write_text(path: Path, text: str) -> None:
    """Write a text in UTF-8, with a `?` for what a name that is in another code has beyond it."""
    with complete(path) as part:
        part.write_text(text, encoding="utf-8", errors="replace")


def write_bytes(path: Path, data: bytes) -> None:
    """Write bytes."""
    with complete(path) as part:
        part.write_bytes(data)


def write_json(data: Any, path: Path) -> None:
    """Write indented JSON."""
    write_text(path, json.dumps(data, indent=2) + "\n")


def drop_output() -> None:
    """Drop what standard output has not taken: the interpreter would try again at its end."""
    with suppress(OSError, ValueError, AttributeError):  # closed, or no file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
