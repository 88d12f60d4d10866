# SPDX-License-Identifier: MIT
"""The C code and the Verilated core as shared libraries, compiled once per version of the sources."""

import importlib.util
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path

from passo.cache import LIBRARY, cached, discard
from passo.compiler import CC, CXX, STRICT, call, headers, includes, library, sources
from passo.failure import BuildError
from passo.pins import CoreParameters
from passo.toolchain import environment, paths

ENGINE_FLAGS = (*STRICT, "-O3", "-fPIC", *includes(paths.engine, paths.core))
# A clock of the model goes through tens of small functions in as many files: inlined, it takes 3/4 as long.
WHOLE = ("-O3", "-flto", "-fno-semantic-interposition")
CPP_FLAGS = ("-std=gnu++17", "-O2", "-Wall", "-fPIC", "-fno-gnu-unique", *includes(paths.engine, paths.core))
# Nearly all of a clock of the RTL is the logic of the core. Clang's takes 7/8 of the time of GCC's, where it
# is installed, and with a profile 7/8 of that; with more optimization it takes longer.
CXX_CORE = "clang++" if shutil.which("clang++") else CXX
OPTIMIZED = "-O1"

# Every register of the core has a reset, so the value chosen for X does not matter. Hidden symbols need no
# detour over the table of a shared library: 8 % more clocks per second.
TOP = "passo_spi_top"
CLOCKED = paths.engine / "passo_engine.v"  # its top, but with waves
PROFILE = paths.engine / "engine_profile.cpp"
# A large core takes half the time to compile when it is one file, which has the headers once.
ONE_FILE = ("--output-split", "0")
VERILATOR_FLAGS = (
    *("--cc", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--no-timing", "--no-assert"),
    *ONE_FILE,
    *("--converge-limit", "10000"),  # of CLOCKS_MOST in engine_rtl.cpp
    *("--prefix", f"V{TOP}"),
)
C_FLAGS = ("-fPIC", "-fvisibility=hidden")
WAVES_FLAGS = ("--trace-fst", "--no-trace-params")  # without the constants of the registers, in every module
MAKEFILE, MODEL, RUNTIME = f"V{TOP}.mk", f"V{TOP}__ALL.a", "libverilated.a"
LEVELS = ("step_reset", "dir_reset", "enable_reset")  # parameters with a bit for each pin
TOLD = ("clock_hz", "build")  # and those with a word
PARTS = ("inputs", "encoders", "outputs", "raster", "compare", "trackers")
WORD_BITS = 32


@dataclass(frozen=True)
class Parameters(CoreParameters):
    """Build parameters of a core; ranges as in spec/pins.toml."""

    @property
    def lined(self) -> int:
        """Axes of a channel that lines move: the first ones."""
        return self.axes - self.tracked

    @property
    def name(self) -> str:
        """Unique name of these parameters, for file names."""
        queues = f"{self.line_queue_log2}_{self.ramp_queue_log2}"
        levels = (self.step_reset, self.dir_reset, self.enable_reset)
        reset = "_reset{:x}_{:x}_{:x}".format(*levels) if any(levels) else ""
        parts = "".join(f"_{part}" for part in PARTS if getattr(self, part))
        told = f"_{self.clock_hz}Hz_{self.build:x}" if self.clock_hz or self.build else ""
        tracked = f"_tracked{self.tracked}" if self.tracked else ""
        return f"{self.channels}x{self.axes}_{self.tick_log2}_{queues}{parts}{tracked}{reset}{told}"

    def verilog(self) -> dict[str, str]:
        """Verilog parameter names and values."""
        sized = dict.fromkeys(LEVELS, self.channels * self.axes) | dict.fromkeys(TOLD, WORD_BITS)
        return {
            name.upper(): f"{sized[name]}'h{value:x}" if name in sized else str(value)
            for name, value in asdict(self).items()
        }


def rtl_sources(folder: Path = paths.rtl) -> list[Path]:
    """The Verilog modules of the core."""
    return sorted(folder.glob("*.v"))


def planner_library() -> Path:
    """Planner, G-code interpreter, frame codec, link library, driver, as on a microcontroller, and tools."""
    folders = (paths.planner, paths.gcode, paths.protocol, paths.driver, paths.grbl, paths.linux)
    engine = [paths.engine / f"passo_{name}.c" for name in ("csv", "pulses", "rests")]
    return library("planner", [*folders, paths.engine], [*sources(*folders), *engine], "-O1")


def engine_sources() -> list[Path]:
    """What both engines share: time, the SPI masters, the log of the pins, the machine at the pins."""
    names = ("engine.c", "engine_spi.c", "passo_rig.c", "rig_parts.c", "rig_spindle.c")
    return [paths.engine / name for name in names]


@cache
def model_library() -> Path:
    """The C model engine, for any parameters."""
    folders = (paths.core, paths.protocol)
    engine = [*engine_sources(), paths.engine / "engine_model.c"]
    return library("model", [*folders, paths.engine], [*sources(*folders), *engine], *WHOLE)


def preview_library() -> Path:
    """The planner's library with queues in place of link and core."""
    folders = (paths.planner, paths.gcode, paths.protocol, paths.driver, paths.grbl)
    link = ("passo_host.c", "passo_link_frame.c", "passo_link_retry.c")
    names = ("passo_preview.c", "passo_preview_check.c", "passo_preview_core.c")
    own = [paths.engine / name for name in names]
    files = [path for path in sources(*folders) if path.name not in link]
    return library("preview", [*folders, paths.engine], [*files, *own], "-O1", "-lm")


def judge_library() -> Path:
    """The C model that compares itself with recorded pins."""
    folders = (paths.core, paths.protocol)
    files = [*sources(*folders), paths.engine / "passo_judge.c"]
    return library("judge", [*folders, paths.engine], files, "-O2")


def console_library() -> Path:
    """The console of the STM32 bridge with the driver, as on a microcontroller."""
    folders = (paths.console, paths.driver, paths.planner, paths.protocol)
    files = [*sources(*folders), paths.engine / "passo_terminal.c"]
    return library("console", [*folders, paths.engine], files, "-O1")


def cpu_library() -> Path:
    """The Cortex-M3 of the emulated microcontroller, on unicorn."""
    spec = importlib.util.find_spec("unicorn")
    if spec is None or spec.origin is None:
        raise BuildError("the Python package 'unicorn' is missing: run 'tools/setup.sh dev'")
    unicorn = Path(spec.origin).parent
    linked = unicorn / "lib" / "libunicorn.so.2"
    flags = [f"-isystem{unicorn / 'include'}", str(linked), f"-Wl,-rpath,{linked.parent}"]
    files = [paths.engine / name for name in ("passo_cpu.c", "passo_cpu_hooks.c", "passo_cpu_registers.c")]
    return library(f"cpu_unicorn{version('unicorn')}", [paths.engine], files, "-O3", *flags)


def rtl_library(parameters: Parameters, waves: bool = False, rtl: Path = paths.rtl) -> Path:
    """The engine of the Verilated core, for given parameters.

    `rtl`: a folder with a changed copy of it, or the netlist of a core with mutants.
    """
    verilated = _verilated(parameters, waves, rtl)
    include = Path(environment()["VERILATOR_ROOT"]) / "include"
    c_parts, cpp_part = engine_sources(), paths.engine / "engine_rtl.cpp"
    defines = [f"-DPASSO_CORE_{name.upper()}={value}" for name, value in asdict(parameters).items()]
    flags = [*CPP_FLAGS, *defines, f"-I{verilated}"]
    runtime = [f"-isystem{include}", f"-isystem{include / 'vltstd'}"]
    runtime_of = _runtime(waves)
    archives = [str(verilated / MODEL), str(runtime_of / RUNTIME), "-pthread", "-Wl,--no-undefined"]
    if waves:
        flags.append("-DPASSO_WAVES")
        archives += ["-llz4", "-lz"]

    def make(folder: Path) -> None:
        objects = [folder / f"{part.stem}.o" for part in c_parts]
        for part, made in zip(c_parts, objects, strict=True):
            call([CC, *ENGINE_FLAGS, "-c", part, "-o", made])
        try:
            call([CXX, "-shared", *flags, *runtime, cpp_part, *objects, *archives, "-o", folder / LIBRARY])
        except BuildError:
            for part in (verilated, runtime_of):  # may be what does not fit
                discard(part)
            raise

    name = f"rtl_{parameters.name}{'_waves' if waves else ''}{_copy(rtl)}"
    inputs = [*c_parts, cpp_part, *headers(paths.engine), paths.core / "passo_pins.h"]
    return cached(name, inputs, [_verilator(), *ENGINE_FLAGS, *flags, *archives], make) / LIBRARY


def waves_possible() -> bool:
    """Whether the two libraries that Verilator's FST writer needs are installed."""
    try:
        call([CXX, "-E", "-include", "lz4.h", "-include", "zlib.h", "-x", "c++", "/dev/null"])
    except BuildError:
        return False
    return True


def _copy(rtl: Path) -> str:
    return "" if rtl == paths.rtl else f"_{rtl.stem}"


def _verilated(parameters: Parameters, waves: bool, rtl: Path) -> Path:
    """The folder with the compiled C++ that Verilator generates from the core."""
    if waves and not waves_possible():
        raise BuildError("waves need lz4.h and zlib.h: install the Debian packages liblz4-dev and zlib1g-dev")
    netlist = rtl.is_file()
    modules = [*([rtl] if netlist else rtl_sources(rtl)), *([] if waves else [CLOCKED])]
    # A second compilation takes longer than it saves, and the more so the more there is in one function.
    large = parameters.channels > 1 or parameters.encoders or parameters.outputs
    profiled = not (waves or large or netlist)
    optimize = ("OPT_SLOW=-O0", f"CXX={CXX_CORE}")
    chosen = ["-Wno-fatal", "-Wno-lint", "-Wno-style", "-DPASSO_NETLIST"] if netlist else []
    chosen += [f"-G{name}={value}" for name, value in parameters.verilog().items()]
    flags = [*_verilator_flags(waves, CXX_CORE), "--top-module", TOP if waves else CLOCKED.stem, *chosen]

    def make(folder: Path) -> None:
        if " " in f"{paths.rtl}{paths.build}":
            raise BuildError(
                f"Verilator's makefiles do not support a path with a space: {paths.rtl}, {paths.build}"
            )
        call(["verilator", *flags, f"-I{modules[0].parent}", "--Mdir", folder, *modules])
        profile = _profile(folder, optimize) if profiled else []
        fast = " ".join([OPTIMIZED, *profile])
        call(["make", "-C", folder, "-f", MAKEFILE, MODEL, f"OPT_FAST={fast}", *optimize])

    name = f"verilated_{parameters.name}{'_waves' if waves else ''}{_copy(rtl)}"
    inputs = [*modules, *sorted(rtl.glob("*.vh")), *([PROFILE] if profiled else [])]
    return cached(name, inputs, [_verilator(), *flags, OPTIMIZED, *optimize], make)


def _profile(folder: Path, optimize: Sequence[str]) -> list[str]:
    """Compiler flags for the core that Verilator has made: the profile of a run; none without its tools."""
    counts, merged, program = folder / "rest.profraw", folder / "rest.profdata", folder / "rest"
    clang = CXX_CORE == "clang++"
    counted = f"-fprofile-instr-generate={counts}" if clang else "-fprofile-generate"
    include = Path(environment()["VERILATOR_ROOT"]) / "include"
    headers_of = [f"-isystem{include}", f"-isystem{include / 'vltstd'}"]
    flags = ["-std=gnu++17", *includes(folder, paths.core), *headers_of]
    archives = [str(folder / MODEL), str(_runtime(False) / RUNTIME), "-pthread"]
    try:
        call(["make", "-C", folder, "-f", MAKEFILE, MODEL, f"OPT_FAST={OPTIMIZED} {counted}", *optimize])
        call([CXX_CORE, counted, *flags, PROFILE, *archives, "-o", program])
        call([program])
        if clang:
            call(["llvm-profdata", "merge", counts, "-o", merged])
    except BuildError:
        return []
    finally:
        for made in (*folder.glob("*.[ao]"), counts, program):
            made.unlink(missing_ok=True)
    return [f"-fprofile-instr-use={merged}"] if clang else ["-fprofile-use", "-Wno-missing-profile"]


def _runtime(waves: bool) -> Path:
    """The folder with Verilator's runtime, which takes as long to compile as a core: once for all of them."""
    flags = _verilator_flags(waves)

    def make(folder: Path) -> None:
        empty = folder / "empty.v"
        empty.write_text("module empty; endmodule\n", encoding="utf-8")
        call(["verilator", *flags, "--Mdir", folder, empty])
        call(["make", "-C", folder, "-f", MAKEFILE, RUNTIME, "OPT_GLOBAL=-O1"])

    return cached(f"verilator_runtime{'_waves' if waves else ''}", [], [_verilator(), *flags], make)


def _verilator_flags(waves: bool, compiler: str = CXX) -> list[str]:
    own = C_FLAGS if compiler == "clang++" else (*C_FLAGS, "-fno-gnu-unique")
    return [*VERILATOR_FLAGS, "-CFLAGS", " ".join(own), *(WAVES_FLAGS if waves else ())]


def _verilator() -> str:
    return f"verilator {version('verilator')}"
