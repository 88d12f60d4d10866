# SPDX-License-Identifier: MIT
"""`make web`: a page to type moves; console, planner and C model run in it as WebAssembly."""

import base64
import gzip
import importlib.util
import sys
import zlib
from pathlib import Path

from passo import __version__
from passo.build import engine_sources
from passo.compiler import BuildError, cached, call, headers, includes, sources
from passo.report_page import SCRIPTS, page
from passo.toolchain import paths, short

FOLDERS = (paths.model, paths.protocol, paths.planner, paths.driver, paths.console)
OWN = ("engine_model.c", "passo_terminal.c", "passo_web.c")
# The warnings are those of GCC, which compiles the same sources elsewhere: Clang has others.
FLAGS = ("--target=wasm32-wasi", "-mexec-model=reactor", "-std=c11", "-O2", "-s")


def module() -> Path:
    """The WebAssembly module."""
    if importlib.util.find_spec("ziglang") is None:
        raise BuildError("the Python package 'ziglang' is missing: run 'tools/setup.sh web'")
    files = [*sources(*FOLDERS), *engine_sources(), *(paths.engine / name for name in OWN)]
    flags = [*FLAGS, *includes(*FOLDERS, paths.engine)]

    def make(folder: Path) -> None:
        call([sys.executable, "-m", "ziglang", "cc", *flags, *files, "-o", folder / "passo.wasm"])

    return cached("web", [*files, *headers(*FOLDERS, paths.engine)], flags, make) / "passo.wasm"


def build(folder: Path) -> Path:
    """Write the page."""
    packed = base64.b64encode(zlib.compress(module().read_bytes(), 9)).decode()
    body = (
        f'<script type="text/plain" id="wasm">{packed}</script>\n'
        f"<script>document.body.dataset.version = '{__version__}'; openWeb();</script>"
    )
    folder.mkdir(parents=True, exist_ok=True)
    made = folder / "index.html"
    made.write_text(page("Try Passo", body, (*SCRIPTS, "web.js")))
    return made


if __name__ == "__main__":
    made = build(paths.results / "web")
    size = len(gzip.compress(made.read_bytes()))
    print(f"open: {short(made)} ({size / 1000:.0f} kB gzipped)")
