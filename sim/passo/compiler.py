# SPDX-License-Identifier: MIT
"""Compilers and their flags."""

import re
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

from passo.cache import LIBRARY, cached, hash_of
from passo.failure import BuildError
from passo.toolchain import environment

CC = "cc"
CXX = "c++"
CORTEX_M3 = ("arm-none-eabi-gcc", "-mcpu=cortex-m3", "-mthumb", "-Os", "-std=c11")

STRICT = ("-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror")
SHARED = ("-fPIC", "-shared", "-Wl,--no-undefined")
# Every error is fatal. The address sanitizer must be linked into the program itself, so libraries for Python
# use only the undefined behavior sanitizer. Rare paths are not inlined: their large locals would be marked
# at every call of the common one, which doubles the time.
SANITIZED = (
    *("-O1", "-g", "-fno-inline-functions-called-once"),
    *("-fsanitize=address,undefined", "-fno-sanitize-recover=all"),
)
DEFINED = ("-O2", "-fsanitize=undefined", "-fno-sanitize-recover=all")

MESSAGE_LINES = 30  # of compiler messages
FULL = ("No space left on device", "Disk quota exceeded", "File too large")  # says a tool of its disk


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
        raise BuildError(f"'{words[0]}' not found: on Debian, install g++, make and perl") from None
    if done.returncode:
        raise failed(words[0], done.stderr or done.stdout)
    return done.stdout


def failed(tool: str, text: str) -> BuildError:
    """What to raise: of what a tool has said the one line that tells of a full disk, or the first ones."""
    said = text.splitlines()
    if full := next((line for line in said if any(reason in line for reason in FULL)), None):
        return BuildError(f"{tool} failed: {full.strip()}")
    return BuildError("\n".join([f"{tool} failed:", *said[:MESSAGE_LINES]]))


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
    made = made.with_name(f"{made.stem}-{hash_of(inputs, [*compiler, *flags])}{made.suffix}")
    return made if made.exists() else compile_to(made, *flags, *rest, compiler=compiler)


def library(name: str, folders: Sequence[Path], files: Sequence[Path], *flags: str) -> Path:
    """Compile C sources to a cached shared library, with the headers of folders; return its path."""
    flags = (*STRICT, *SHARED, *includes(*folders), *flags)

    def make(folder: Path) -> None:
        call([CC, *files, *flags, "-o", folder / LIBRARY])

    return cached(name, [*files, *headers(*folders)], flags, make) / LIBRARY


def declarations(files: Iterable[Path]) -> str:
    """Preprocessed headers for cffi, without #include, as it knows the standard types, and inlines."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in files)
    dropped = r"(?ms)^#include[^\n]*$|^static inline .*?^}$"
    return call([CC, "-E", "-P", "-x", "c", "-"], re.sub(dropped, "", text))
