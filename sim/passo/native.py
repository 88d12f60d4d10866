# SPDX-License-Identifier: MIT
"""The C code as Python sees it: its declarations are read from its own headers."""

import re
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

from cffi import FFI

from passo.build import ENGINE, console_library, cpu_library, planner_library
from passo.toolchain import environment, paths

HEADERS = (
    paths.protocol / "passo_registers.h",
    paths.protocol / "passo_command.h",
    paths.protocol / "passo_crc.h",
    paths.planner / "passo_plan.h",
    paths.protocol / "passo_frame.h",
    paths.driver / "passo_error.h",
    paths.driver / "passo_host.h",
    paths.driver / "passo.h",
    paths.driver / "passo_motor.h",
    ENGINE / "passo_engine.h",
    ENGINE / "passo_terminal.h",
    paths.stm32_bridge / "console" / "passo_decimal.h",
    ENGINE / "passo_cpu.h",
)


def _declarations() -> str:
    """The headers after the preprocessor. cffi knows the standard types, so nothing is included."""
    text = "\n".join(re.sub(r"(?m)^#include.*$", "", path.read_text()) for path in HEADERS)
    command = ["cc", "-E", "-P", "-x", "c", "-"]
    done = subprocess.run(command, input=text, env=environment(), capture_output=True, text=True, check=True)
    return done.stdout


@cache
def ffi() -> FFI:
    """All types and functions of the C code."""
    made = FFI()
    made.cdef(_declarations())
    return made


@cache
def load(library: Path) -> Any:
    """A shared library; it need not have all the functions."""
    return ffi().dlopen(str(library))


@cache
def planner() -> Any:
    """The planner, the frame codec, the link library and the driver."""
    return load(planner_library())


@cache
def processor() -> Any:
    """The microcontroller's processor."""
    return load(cpu_library())


@cache
def console() -> Any:
    """The console of the STM32 bridge."""
    return load(console_library())
