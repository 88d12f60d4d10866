# SPDX-License-Identifier: MIT
"""Build folders, kept until a source or flag changes, and used only if complete.

A folder appears under its name with all its files, the last of which lists the digests of the others. An
incomplete one, or one whose library does not load, is rebuilt.
"""

import ctypes
import fcntl
import hashlib
import json
import os
import shutil
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from passo.failure import BuildError
from passo.toolchain import BUILD_VARIABLE, paths

LIBRARY = "library.so"
WHOLE = "whole.json"  # digests of all other files
ROOM = 1 << 20  # bytes that must be free after a build: some tools do not notice that the disk is full


def cached(name: str, inputs: Iterable[Path], flags: Sequence[str], make: Callable[[Path], None]) -> Path:
    """The folder lib/NAME-HASH below `paths.build`, which `make` fills from these inputs if it is incomplete.

    Older folders of the same name are deleted. Raises BuildError.
    """
    libraries = paths.build / "lib"
    folder = libraries / f"{name}-{hash_of(inputs, flags)}"
    if folder.exists() and not _damage(folder):
        return folder
    with _lock(libraries / f"{name}.lock"):
        damage = _damage(folder) if folder.exists() else None
        if damage or not folder.exists():
            again = f" again, as the one in the cache {damage}" if damage else ""
            print(f"Building {name}{again} ...", flush=True)
            began = time.monotonic()
            with _disk():
                _build(name, folder, make)
            print(f"Built {name} in {time.monotonic() - began:.1f} s", flush=True)
    return folder


def discard(folder: Path) -> None:
    """Delete a folder of the cache, or what is in its place."""
    if folder.is_dir() and not folder.is_symlink():
        shutil.rmtree(folder, ignore_errors=True)
    else:
        folder.unlink(missing_ok=True)


def hash_of(inputs: Iterable[Path], flags: Sequence[str]) -> str:
    """Of what is compiled, wherever the sources and what was built before are."""
    text = repr(list(flags)).replace(str(paths.build), "BUILD").replace(str(paths.root), "ROOT")
    digest = hashlib.sha256(text.encode())
    for path in inputs:
        digest.update(f"\0{path.name}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:12]


def _build(name: str, folder: Path, make: Callable[[Path], None]) -> None:
    work = folder.with_name(f"{name}.work")
    discard(work)  # of a process that was killed
    work.mkdir()
    try:
        _fill(work, make)
        if problem := _unloadable(work):
            raise BuildError(f"{name} was built, but {problem}")
        (work / WHOLE).write_text(json.dumps(_digests(work)))
        for stale in folder.parent.glob(f"{name}-*"):
            discard(stale)
        work.rename(folder)
    finally:
        discard(work)


def _fill(work: Path, make: Callable[[Path], None]) -> None:
    """Raises BuildError; says that the disk is full whatever the tools made of it."""
    failed = None
    try:
        make(work)
    except BuildError as error:
        failed = error
    with (work / WHOLE).open("wb") as file:
        os.posix_fallocate(file.fileno(), 0, ROOM)
    if failed:
        raise failed


def _damage(folder: Path) -> str | None:
    """What is wrong with a folder of the cache.

    The digests come first: to load a library that ends too early may kill the process.
    """
    try:
        listed = json.loads((folder / WHOLE).read_text(encoding="utf-8"))
        whole = listed == _digests(folder)
    except (OSError, ValueError):
        whole = False
    return _unloadable(folder) if whole else "is incomplete"


def _digests(folder: Path) -> dict[str, str]:
    made = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path != folder / WHOLE:
            with path.open("rb") as file:
                made[str(path.relative_to(folder))] = hashlib.file_digest(file, "sha256").hexdigest()
    return made


def _unloadable(folder: Path) -> str | None:
    """Why its library, if it has one, cannot be loaded: it may be of another machine."""
    if (folder / LIBRARY).exists():
        try:
            ctypes.CDLL(str(folder / LIBRARY))
        except OSError as error:
            return f"does not load: {str(error).removeprefix(f'{folder / LIBRARY}: ')}"
    return None


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Hold a file lock, so that only one process builds the same folder."""
    with _disk():
        path.parent.mkdir(parents=True, exist_ok=True)
        file = path.open("w", encoding="utf-8")
    with file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def _disk() -> Iterator[None]:
    """Tell in a sentence what the disk refuses."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise BuildError(f"{paths.build / 'lib'}: {reason}; {BUILD_VARIABLE} names another folder") from None
