# SPDX-License-Identifier: MIT
"""`make web`: a page to type moves or G-code; the simulation runs in it as WebAssembly."""

import base64
import gzip
import importlib.util
import json
import sys
import zlib
from pathlib import Path
from typing import Any

from passo.build import engine_sources
from passo.cache import cached
from passo.compiler import call, headers, includes, sources
from passo.console import stages
from passo.failure import BuildError
from passo.output import make_folder, write_text
from passo.report_page import FOLDER, SHELL, page, source_of
from passo.toolchain import paths, short
from passo.web_python import EXPORTS, write_python
from passo.web_rules import rules

FOLDERS = (paths.driver, paths.console, paths.protocol, paths.planner, paths.gcode, paths.core)
# Of the folder: the rest is for a sender.
GRBL = (
    "passo_player.c",
    "passo_player_input.c",
    "passo_player_line.c",
    "passo_player_probe.c",
    "passo_player_thread.c",
    "passo_program.c",
)
OWN = (
    "engine_model.c",
    "passo_preview_check.c",
    "passo_rests.c",
    "passo_terminal.c",
    "passo_web.c",
    "passo_web_console.c",
    "passo_web_program.c",
)
MACHINE = ("toml.js", "values.js", "machine_file.js")  # reads machine files
WEB = ("runner.js", "share.js", "save.js", *MACHINE, "advice.js", "files.js", "web.js")
WORKER = ("bytes.js", "motion.js", "advice.js", "expand.js", "worker.js")
EXAMPLE = paths.root / "examples" / "gcode"
# The warnings are those of GCC, which compiles the same sources elsewhere: Clang has others.
FLAGS = (
    *("--target=wasm32-wasi", "-mexec-model=reactor", "-std=c11", "-O2", "-s"),
    *(f"-Wl,--export={name}" for name in EXPORTS),
)


def module() -> Path:
    """The WebAssembly module."""
    if importlib.util.find_spec("ziglang") is None:
        raise BuildError("the Python package 'ziglang' is missing: run 'tools/setup.sh web'")
    grbl, own = (paths.grbl / name for name in GRBL), (paths.engine / name for name in OWN)
    files = [*sources(*FOLDERS), *grbl, *engine_sources(), *own]
    folders = (*FOLDERS, paths.grbl, paths.engine)
    flags = [*FLAGS, *includes(*folders)]

    def make(folder: Path) -> None:
        call([sys.executable, "-m", "ziglang", "cc", *flags, *files, "-o", folder / "passo.wasm"])

    return cached("web", [*files, *headers(*folders)], flags, make) / "passo.wasm"


def facts() -> str:
    """The file of a machine for G-code, a program for it, and the rules of such files, as JSON."""
    machine, program = ((EXAMPLE / name).read_text(encoding="utf-8") for name in ("machine.toml", "part.nc"))
    return _json({"machine": machine, "program": program, "rules": rules()})


def build(folder: Path) -> Path:
    """Write the page."""
    packed = base64.b64encode(zlib.compress(module().read_bytes(), 9)).decode()
    body = (
        f"{(FOLDER / 'web.html').read_text(encoding='utf-8')}"
        f'<script type="text/plain" id="wasm">{packed}</script>\n'
        f'<script type="text/plain" id="worker">{source_of(WORKER)}</script>\n'
        f'<script type="application/json" id="shell">{_json(SHELL.read_text(encoding="utf-8"))}</script>\n'
        f'<script type="application/json" id="machine">{facts()}</script>\n'
        f"<script>{source_of(WEB)}</script>\n"
        "<script>openWeb();</script>"
    )
    make_folder(folder)
    made = folder / "index.html"
    write_text(made, page("Try Passo", body))
    write_python(folder)
    return made


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")


if __name__ == "__main__":
    tell = stages()
    tell("web: page")
    made = build(paths.results / "web")
    tell.end()
    size = len(gzip.compress(made.read_bytes()))
    print(f"open: {short(made)} ({size / 1000:.0f} kB gzipped)")
