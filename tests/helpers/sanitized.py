# SPDX-License-Identifier: MIT
"""C programs under the sanitizers of addresses and undefined behavior; what they share is compiled once."""

from collections.abc import Iterable
from pathlib import Path

from passo.build import engine_sources
from passo.cache import cached
from passo.compiler import CC, SANITIZED, STRICT, call, compile_to, headers, includes, sources
from passo.toolchain import paths

FOLDERS = (
    *(paths.grbl, paths.driver, paths.console, paths.gcode, paths.planner, paths.protocol),
    *(paths.engine, paths.core),
)
FLAGS = (*STRICT, *SANITIZED, *includes(*FOLDERS))


def program(made: Path, main: Path, folders: Iterable[Path], *more: Path) -> Path:
    """Compile `main` with all sources of the folders (of the engine: that of the model), and more."""
    return compile_to(made, *FLAGS, main, *more, *map(object_of, folders))


def object_of(folder: Path) -> Path:
    """The sources of a folder, linked into one object."""
    model = [*engine_sources(), paths.engine / "engine_model.c"]
    files = model if folder == paths.engine else sources(folder)

    def make(made: Path) -> None:
        call([CC, *FLAGS, "-r", *files, "-o", made / "all.o"])

    name = f"sanitized_{folder.name}"
    return cached(name, [*files, *headers(*FOLDERS)], [*FLAGS, "-r"], make) / "all.o"
