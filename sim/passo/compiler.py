# SPDX-License-Identifier: MIT
"""Compilers and their flags; outputs are cached until a source, header or flag changes."""

import fcntl
import hashlib
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from passo.failure import Failure
from passo.toolchain import BUILD_VARIABLE, environment, paths

CC = "cc"
CXX = "c++"
CORTEX_M3 = ("arm-none-eabi-gcc", "-mcpu=cortex-m3", "-mthumb", "-Os", "-std=c11")

STRICT = ("-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror")
SHARED = ("-fPIC", "-shared", "-Wl,--no-undefined")
# Every error is fatal. The address sanitizer must be linked into the program itself, so libraries for Python
# use only the undefined behaviour sanitizer. Rare paths are not inlined: their large locals would be marked
# at every call of the common one, which doubles the time.
SANITIZED = (
    *("-O1", "-g", "-fno-inline-functions-called-once"),
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=all"),
)
DEFINED = ("-O2", "-fsanitize=undefined", "-fno-sanitize-recover=all")

LIBRARY = "library.so"
MESSAGE_LINES = 30  # of compiler messages


class BuildError(Failure):
    """A compiler failed; the text is its message."""


def sources(*folders: Path) -> list[Path]:
    """All C sources of folders."""
    return [path for folder in folders for path in sorted(folder.glob("*.c"))]


def headers(*folders: Path) -> list[Path]:
    """All headers of folders."""
    return [path for folder in folders for path in sorted(folder.glob("*.h"))]


def includes(*folders: Path) -> list[str]:
    """Compiler flags for the headers of folders."""
    return [f"-I{folder}" for folder in folders]


def call(command: Sequence[str | Path], text: str | None = None) -> str:
    """Run a compiler with a text on its standard input; return its standard output.

    Raises:
        BuildError: The compiler failed.
    """
    words = [str(word) for word in command]
    try:
        done = subprocess.run(words, env=environment(), input=text, capture_output=True, text=True)
    except FileNotFoundError:
        raise BuildError(f"there is no '{words[0]}': on Debian, install g++, make and perl") from None
    if done.returncode:
        said = (done.stderr or done.stdout).splitlines()
        raise BuildError("\n".join([f"{words[0]} failed:", *said[:MESSAGE_LINES]]))
    return done.stdout


def compile_to(made: Path, *arguments: str | Path, compiler: Sequence[str] = (CC,)) -> Path:
    """Compile to a file, which appears only when it is complete."""
    made.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f"{made.stem}.", dir=made.parent) as folder:
        part = Path(folder) / made.name
        call([*compiler, *arguments, "-o", part])
        part.rename(made)
    return made


def kept(
    made: Path,
    inputs: Iterable[Path],
    flags: Sequence[str],
    *rest: str | Path,
    compiler: Sequence[str] = (CC,),
) -> Path:
    """The same, but only once for the same inputs and flags, a hash of which is added to the file name.

    `rest` are further arguments that only locate the inputs; they are not hashed.
    """
    made = made.with_name(f"{made.stem}-{_hash(inputs, [*compiler, *flags])}{made.suffix}")
    return made if made.exists() else compile_to(made, *flags, *rest, compiler=compiler)


def library(name: str, folders: Sequence[Path], files: Sequence[Path], *flags: str) -> Path:
    """Compile C sources to a cached shared library, with the headers of folders; return its path."""
    flags = (*STRICT, *SHARED, *includes(*folders), *flags)

    def make(folder: Path) -> None:
        call([CC, *files, *flags, "-o", folder / LIBRARY])

    return cached(name, [*files, *headers(*folders)], flags, make) / LIBRARY


def cached(name: str, inputs: Iterable[Path], flags: Sequence[str], make: Callable[[Path], None]) -> Path:
    """The folder lib/NAME-HASH below `paths.build`, which `make` fills from these inputs if it is not there.

    Older folders of the same name are deleted.
    """
    libraries = paths.build / "lib"
    folder = libraries / f"{name}-{_hash(inputs, flags)}"
    if folder.exists():
        return folder
    try:
        libraries.mkdir(parents=True, exist_ok=True)
        (libraries / f"{name}.lock").touch()
    except OSError as error:
        raise BuildError(f"{libraries}: {error.strerror}; {BUILD_VARIABLE} names another folder") from None
    with _lock(libraries / f"{name}.lock"):
        if not folder.exists():
            print(f"Building {name} ...", flush=True)
            began = time.monotonic()
            with tempfile.TemporaryDirectory(prefix=f"{name}.", dir=libraries) as temporary:
                work = Path(temporary) / "work"
                work.mkdir()
                make(work)
                for stale in libraries.glob(f"{name}-*"):
                    shutil.rmtree(stale)
                work.rename(folder)
            print(f"Built {name} in {time.monotonic() - began:.1f} s", flush=True)
    return folder


def declarations(files: Iterable[Path]) -> str:
    """Preprocessed headers for cffi, without #include, as it knows the standard types, and inlines."""
    text = "\n".join(path.read_text() for path in files)
    dropped = r"(?ms)^#include[^\n]*$|^static inline .*?^}$"
    return call([CC, "-E", "-P", "-x", "c", "-"], re.sub(dropped, "", text))


def _hash(inputs: Iterable[Path], flags: Sequence[str]) -> str:
    """Of what is compiled, wherever the sources and what was built before are."""
    text = repr(list(flags)).replace(str(paths.build), "BUILD").replace(str(paths.root), "ROOT")
    digest = hashlib.sha256(text.encode())
    for path in inputs:
        digest.update(f"\0{path.name}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:12]


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Hold a file lock, so that only one process builds the same folder."""
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
