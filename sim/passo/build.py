# SPDX-License-Identifier: MIT
"""Compile the C code and the Verilated core into shared libraries, once for each state of the sources.

A library lives in build/lib/NAME-HASH, where HASH covers everything that goes into it.
"""

import fcntl
import hashlib
import importlib.util
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from importlib.metadata import version
from pathlib import Path

from passo.toolchain import environment, paths

ENGINE = paths.sim / "engine"
LIBRARY = "library.so"
MESSAGE_LINES = 30  # of a compiler's complaints

FOLDERS = (paths.protocol, paths.planner, paths.model, paths.driver, ENGINE)  # of headers
INCLUDES = tuple(f"-I{folder}" for folder in FOLDERS)
C_FLAGS = ("-std=c11", "-O3", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-fPIC", *INCLUDES)
C_LINK_FLAGS = ("-shared", "-Wl,--no-undefined")
CPP_FLAGS = ("-std=gnu++17", "-O3", "-Wall", "-fPIC", "-fno-gnu-unique", *INCLUDES)

# Every register of the core has a reset, so nothing depends on what an X becomes.
VERILATOR_FLAGS = (
    *("--cc", "--build", "-j", "2", "-O3", "--x-assign", "fast", "--x-initial", "fast"),
    *("--no-timing", "--no-assert", "--top-module", "passo_core", "--prefix", "Vpasso_core"),
    *("-CFLAGS", "-fPIC -fno-gnu-unique"),
)


class BuildError(RuntimeError):
    """A compiler failed; the text is what it said."""


@dataclass(frozen=True)
class Parameters:
    """How a core is built: the parameters of rtl/passo_core.v."""

    channels: int = 1
    axes: int = 4
    tick_log2: int = 7
    line_queue_log2: int = 8
    ramp_queue_log2: int = 4
    # levels of the pins after configuration: the host cannot read them from the core
    step_reset: int = field(default=0, compare=False)
    dir_reset: int = field(default=0, compare=False)
    enable_reset: int = field(default=0, compare=False)

    @property
    def name(self) -> str:
        """Part of a file name that tells these parameters from others."""
        queues = f"{self.line_queue_log2}_{self.ramp_queue_log2}"
        levels = (self.step_reset, self.dir_reset, self.enable_reset)
        reset = "_reset{:x}_{:x}_{:x}".format(*levels) if any(levels) else ""
        return f"{self.channels}x{self.axes}_{self.tick_log2}_{queues}{reset}"

    def verilog(self) -> dict[str, str]:
        """Names and values as the Verilog has them."""
        pins = self.channels * self.axes
        return {
            name.upper(): f"{pins}'h{value:x}" if name.endswith("_reset") else str(value)
            for name, value in asdict(self).items()
        }


def planner_library() -> Path:
    """Planner, frame codec, link library and driver: what runs on a microcontroller as well."""
    return _c_library("planner", _sources(paths.planner, paths.protocol, paths.driver))


def model_library() -> Path:
    """The engine on the C model, for any parameters."""
    sources = _sources(paths.model, paths.protocol)
    return _c_library("model", [*sources, ENGINE / "engine.c", ENGINE / "engine_model.c"])


def console_library() -> Path:
    """The console of the STM32 bridge with its driver, as it runs on a microcontroller."""
    console = paths.stm32_bridge / "console"
    sources = _sources(console, paths.driver, paths.planner, paths.protocol)
    return _c_library("console", [*sources, ENGINE / "passo_terminal.c"], [console])


def _sources(*folders: Path) -> list[Path]:
    return [path for folder in folders for path in sorted(folder.glob("*.c"))]


def cpu_library() -> Path:
    """The microcontroller's processor on unicorn."""
    spec = importlib.util.find_spec("unicorn")
    if spec is None or spec.origin is None:
        raise BuildError("the Python package 'unicorn' is missing: run 'make setup'")
    unicorn = Path(spec.origin).parent
    library = unicorn / "lib" / "libunicorn.so.2"
    sources = [ENGINE / "passo_cpu.c"]
    flags = [*C_FLAGS, f"-isystem{unicorn / 'include'}"]

    def make(folder: Path) -> None:
        linked = [str(library), f"-Wl,-rpath,{library.parent}"]
        _call(["cc", "-shared", *flags, *map(str, sources), *linked, "-o", str(folder / LIBRARY)])

    versions = [version("unicorn"), str(library)]
    return _cached("cpu", [*sources, *_headers()], [*flags, *versions], make) / LIBRARY


def rtl_library(parameters: Parameters, waves: bool = False) -> Path:
    """The engine on the Verilated core."""
    verilated = _verilated(parameters, waves)
    include = Path(environment()["VERILATOR_ROOT"]) / "include"
    sources = [ENGINE / "engine.c", ENGINE / "engine_rtl.cpp"]
    defines = [f"-DPASSO_{name.upper()}={value}" for name, value in asdict(parameters).items()]
    flags = [*CPP_FLAGS, *defines, f"-I{verilated}", f"-isystem{include}", f"-isystem{include / 'vltstd'}"]
    archives = [str(verilated / "Vpasso_core__ALL.a"), str(verilated / "libverilated.a"), "-pthread"]
    if waves:
        flags.append("-DPASSO_WAVES")
        archives += ["-llz4", "-lz"]

    def make(folder: Path) -> None:
        _call(["cc", *C_FLAGS, "-c", str(sources[0]), "-o", str(folder / "engine.o")])
        objects = [str(sources[1]), str(folder / "engine.o")]
        _call(["c++", "-shared", *flags, *objects, *archives, "-o", str(folder / LIBRARY)])

    name = f"rtl_{parameters.name}{'_waves' if waves else ''}"
    return _cached(name, [*sources, *_headers()], [*flags, *archives], make) / LIBRARY


def waves_possible() -> bool:
    """Verilator's FST writer needs two libraries."""
    command = ["c++", "-E", "-include", "lz4.h", "-include", "zlib.h", "-x", "c++", "/dev/null"]
    return subprocess.run(command, env=environment(), capture_output=True).returncode == 0


def _c_library(name: str, sources: Sequence[Path], folders: Sequence[Path] = ()) -> Path:
    """A library of C sources; `folders` are where else headers are."""
    flags = [*C_LINK_FLAGS, *C_FLAGS, *(f"-I{folder}" for folder in folders)]
    headers = [*_headers(), *(path for folder in folders for path in sorted(folder.glob("*.h")))]

    def make(folder: Path) -> None:
        _call(["cc", *flags, *map(str, sources), "-o", str(folder / LIBRARY)])

    return _cached(name, [*sources, *headers], flags, make) / LIBRARY


def _verilated(parameters: Parameters, waves: bool) -> Path:
    """The folder with the C++ that Verilator made of the core, compiled."""
    sources = sorted(paths.rtl.glob("*.v"))
    flags = [*VERILATOR_FLAGS, *(f"-G{name}={value}" for name, value in parameters.verilog().items())]
    # Recording the waves takes most of the time, so that optimizing only makes the build slow.
    optimize = "OPT_FAST=-O1 OPT_SLOW=-O0" if waves else "OPT_FAST=-O3 OPT_SLOW=-O1 OPT_GLOBAL=-O2"
    flags += ["-MAKEFLAGS", optimize]
    if waves:
        flags.append("--trace-fst")
        if not waves_possible():
            raise BuildError(
                "waves need lz4.h and zlib.h: install the Debian packages liblz4-dev and zlib1g-dev"
            )

    def make(folder: Path) -> None:
        _call(["verilator", *flags, f"-I{paths.rtl}", "--Mdir", str(folder), *map(str, sources)])

    name = f"verilated_{parameters.name}{'_waves' if waves else ''}"
    return _cached(name, [*sources, *sorted(paths.rtl.glob("*.vh"))], flags, make)


def _headers() -> list[Path]:
    return [header for folder in FOLDERS for header in sorted(folder.glob("*.h"))]


def _call(command: Sequence[str]) -> None:
    done = subprocess.run(command, env=environment(), capture_output=True, text=True)
    if done.returncode:
        said = (done.stderr or done.stdout).splitlines()
        raise BuildError("\n".join([f"{command[0]} failed:", *said[:MESSAGE_LINES]]))


def _cached(name: str, inputs: Iterable[Path], flags: Sequence[str], make: Callable[[Path], None]) -> Path:
    """The folder that `make` fills from these inputs; made only if it is not there yet."""
    digest = hashlib.sha256(repr(list(flags)).encode())
    for path in inputs:
        digest.update(f"\0{path.name}\0".encode() + path.read_bytes())
    libraries = paths.build / "lib"
    folder = libraries / f"{name}-{digest.hexdigest()[:12]}"
    if folder.exists():
        return folder
    libraries.mkdir(parents=True, exist_ok=True)
    with _lock(libraries / f"{name}.lock"):
        if not folder.exists():
            print(f"Building {name} ...", end="", flush=True)
            began = time.monotonic()
            with tempfile.TemporaryDirectory(prefix=f"{name}.", dir=libraries) as temporary:
                work = Path(temporary) / "work"
                work.mkdir()
                try:
                    make(work)
                except BuildError:
                    print(" failed", flush=True)
                    raise
                for stale in libraries.glob(f"{name}-*"):
                    shutil.rmtree(stale)
                work.rename(folder)
            print(f" {time.monotonic() - began:.1f} s", flush=True)
    return folder


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Only one process at a time makes the same folder."""
    with path.open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
