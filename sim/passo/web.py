# SPDX-License-Identifier: MIT
"""`make web`: a page to type moves or G-code; the simulation runs in it as WebAssembly."""

import base64
import gzip
import importlib.util
import json
import sys
import zlib
from pathlib import Path

from passo import __version__
from passo.build import engine_sources
from passo.cache import cached
from passo.compiler import call, headers, includes, sources
from passo.failure import BuildError
from passo.machine_file import MachineFile, read_machine
from passo.native import planner
from passo.output import make_folder, write_text
from passo.report_page import SCRIPTS, page
from passo.run import parameters_for
from passo.toolchain import paths, short

FOLDERS = (paths.driver, paths.console, paths.protocol, paths.planner, paths.gcode, paths.core)
# Of the folder: the rest is for a sender.
GRBL = (
    "passo_player.c",
    "passo_player_input.c",
    "passo_player_line.c",
    "passo_player_probe.c",
    "passo_program.c",
)
OWN = ("engine_model.c", "passo_terminal.c", "passo_web.c", "passo_web_console.c", "passo_web_program.c")
EXAMPLE = paths.root / "examples" / "gcode"
# The warnings are those of GCC, which compiles the same sources elsewhere: Clang has others.
FLAGS = ("--target=wasm32-wasi", "-mexec-model=reactor", "-std=c11", "-O2", "-s")


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


def numbers(machine: MachineFile) -> list[float]:
    """The members of `struct web_machine` (sim/engine/passo_web_program.c)."""
    settings, pins = machine.settings, machine.pins
    profile = getattr(planner(), f"PASSO_PROFILE_{settings.profile.upper()}")
    common = (settings.clock_hz, len(settings.axes), settings.junction_deviation)
    pin_clocks = (pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold)
    limits = [
        limit
        for axis in settings.axes
        for limit in (axis.steps_per_mm, axis.speed, axis.acceleration, axis.jump, axis.jerk)
    ]
    core_axes = parameters_for(len(settings.axes)).axes
    members = (*common, machine.gcode.arc_tolerance, profile, core_axes, *pin_clocks, *limits)
    return [float(number) for number in members]


def facts() -> str:
    """The machine for G-code and a program for it, as JSON."""
    machine = read_machine(EXAMPLE / "machine.toml")
    axes = [
        {"name": name, "per_step": float(1 / axis.steps_per_mm), "speed": float(axis.speed)}
        for name, axis in zip(machine.letters, machine.settings.axes, strict=True)
    ]
    program = (EXAMPLE / "part.nc").read_text(encoding="ascii")
    made = {"numbers": numbers(machine), "clock_hz": machine.clock_hz, "axes": axes, "program": program}
    return json.dumps(made, separators=(",", ":")).replace("</", "<\\/")


def build(folder: Path) -> Path:
    """Write the page."""
    packed = base64.b64encode(zlib.compress(module().read_bytes(), 9)).decode()
    body = (
        f'<script type="text/plain" id="wasm">{packed}</script>\n'
        f'<script type="application/json" id="machine">{facts()}</script>\n'
        f"<script>document.body.dataset.version = '{__version__}'; openWeb();</script>"
    )
    make_folder(folder)
    made = folder / "index.html"
    write_text(made, page("Try Passo", body, (*SCRIPTS, "web.js")))
    return made


if __name__ == "__main__":
    made = build(paths.results / "web")
    size = len(gzip.compress(made.read_bytes()))
    print(f"open: {short(made)} ({size / 1000:.0f} kB gzipped)")
