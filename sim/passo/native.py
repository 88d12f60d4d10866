# SPDX-License-Identifier: MIT
"""Access to the C code by cffi, with the declarations of its own headers."""

from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from passo.build import console_library, cpu_library, planner_library, preview_library
from passo.cache import cached
from passo.compiler import declarations
from passo.toolchain import paths

HEADERS = (
    paths.protocol / "passo_registers.h",
    paths.protocol / "passo_shapes.h",
    paths.protocol / "passo_limits.h",
    paths.protocol / "passo_command.h",
    paths.protocol / "passo_crc.h",
    paths.planner / "passo_moves.h",
    paths.planner / "passo_plan.h",
    paths.planner / "passo_motors.h",
    paths.planner / "passo_path_state.h",
    paths.planner / "passo_path.h",
    paths.planner / "passo_timed.h",
    *(
        paths.gcode / f"passo_gcode{part}.h"
        for part in ("_error", "_line", "_block", "_angle", "_arc", "_cycle", "")
    ),
    paths.protocol / "passo_frame.h",
    paths.driver / "passo_error.h",
    paths.driver / "passo_host.h",
    paths.driver / "passo.h",
    paths.driver / "passo_motor.h",
    paths.driver / "passo_path_feed.h",
    paths.driver / "passo_inputs.h",
    paths.driver / "passo_home.h",
    paths.driver / "passo_goto.h",
    paths.driver / "passo_follow.h",
    paths.driver / "passo_outputs.h",
    paths.driver / "passo_encoder.h",
    paths.driver / "passo_track.h",
    paths.linux / "passo_linux.h",
    paths.linux / "passo_servo.h",
    paths.grbl / "passo_player.h",
    paths.grbl / "passo_program.h",
    paths.grbl / "passo_storage.h",
    paths.grbl / "passo_grbl_settings.h",
    paths.grbl / "passo_grbl_state.h",
    paths.grbl / "passo_grbl.h",
    paths.core / "passo_pins.h",
    paths.engine / "passo_rig.h",
    paths.engine / "passo_engine.h",
    paths.engine / "passo_terminal.h",
    paths.engine / "passo_judge.h",
    paths.engine / "passo_pulses.h",
    paths.engine / "passo_preview.h",
    paths.engine / "passo_csv.h",
    paths.engine / "passo_rests.h",
    paths.console / "passo_decimal.h",
    paths.engine / "passo_cpu.h",
)


DECLARED = "passo_declarations.py"  # by cffi, which takes longer to parse than to load them


@cache
def ffi() -> Any:
    """All types and functions of the C code, a `cffi.FFI`."""
    path = cached("declarations", HEADERS, [f"cffi {version('cffi')}"], _declare) / DECLARED
    names: dict[str, Any] = {}
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    return names["ffi"]


def unopened(name: str) -> Any:
    """Memory for a `struct name` that its open function is to fill: of no known content, as on a stack."""
    made = ffi().new(f"struct {name} *")
    ffi().buffer(made)[:] = b"\xa5" * ffi().sizeof(made[0])
    return made


def _declare(folder: Path) -> None:
    from cffi import FFI

    made = FFI()
    made.cdef(declarations(HEADERS))
    made.set_source(Path(DECLARED).stem, None, compiler_verbose=False)
    made.emit_python_code(str(folder / DECLARED))


@cache
def load(library: Path) -> Any:
    """Load a shared library; it need not have all declared functions."""
    return ffi().dlopen(str(library))


@cache
def planner() -> Any:
    """The planner, the frame codec, the link library and the driver."""
    return load(planner_library())


@cache
def previewer() -> Any:
    """The planner, the driver and a core that makes no steps."""
    return load(preview_library())


@cache
def processor() -> Any:
    """The processor of the emulated microcontroller."""
    return load(cpu_library())


@cache
def console() -> Any:
    """The console of the STM32 bridge."""
    return load(console_library())
