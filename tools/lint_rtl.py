# SPDX-License-Identifier: MIT
"""Lint the core with four front ends at the corners of its parameter space; any message is an error.

    tools/lint_rtl.py [FOLDER]

FOLDER has the Verilog, default rtl/. Verilator, Icarus Verilog and slang read all corners. Surelog, which is
slower, reads the three that are furthest apart. It elaborates with a front end of its own; tools that only
parse, such as hdlConvertor or Verible, would miss an undeclared name or a missing port.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import surelog
from passo.toolchain import environment, paths
from pyslang.driver import Driver

TOPS = ("passo_spi_top", "passo_wishbone", "passo_axi_lite")  # only the first is read at all corners
SURELOG = paths.build / "lint" / "surelog"

Parameters = Mapping[str, int | str]
Reader = Callable[[Path, str, Parameters], str]  # returns the messages; "" if there are none

ENDS = {
    "CHANNELS": (1, 8),
    "AXES": (1, 8),
    "TICK_LOG2": (7, 16),
    "LINE_QUEUE_LOG2": (2, 8),
    "RAMP_QUEUE_LOG2": (2, 8),
    "STEPS_REGISTER": (0, 1),
    "INPUTS": (0, 1),
    "ENCODERS": (0, 1),
    "OUTPUTS": (0, 1),
    "TRACKERS": (0, 1),
}
# Those whose ends depend on others.
DEPENDENT: dict[str, list[Parameters]] = {
    "TRACKED": [
        {"AXES": axes, "TRACKERS": 1, "TRACKED": tracked} for axes, tracked in ((8, 7), (8, 1), (4, 3))
    ],
    "RASTER": [{"OUTPUTS": 1, "RASTER": 1}],
    "COMPARE": [{"OUTPUTS": 1, "COMPARE": 1}],
}
LEVELS = ("STEP_RESET", "DIR_RESET", "ENABLE_RESET")  # a bit for each axis, default 0
TOLD = ("CLOCK_HZ", "BUILD")  # a word, default 0
AXES = 4  # the default


def _high(axes: int) -> Parameters:
    """Parameters with all bits of the levels and words set."""
    return dict.fromkeys(LEVELS, f"{axes}'h{(1 << axes) - 1:x}") | dict.fromkeys(TOLD, "32'hffffffff")


LOWEST: Parameters = {name: low for name, (low, _) in ENDS.items()}
HIGHEST: Parameters = {name: high for name, (_, high) in ENDS.items()} | _high(8 * 8)
FAR_APART: list[Parameters] = [{}, LOWEST, HIGHEST]
CORNERS = [*FAR_APART, *({name: end} for name, ends in ENDS.items() for end in ends), _high(AXES)]
CORNERS += [corner for corners in DEPENDENT.values() for corner in corners]


def read_with_verilator(rtl: Path, top: str, parameters: Parameters) -> str:
    """With all warnings."""
    options = ["--lint-only", "--quiet", "-Wall", f"-I{rtl}", "--top-module", top]
    return _call("verilator", *options, *_set("-G{}={}", parameters), *_sources(rtl))


def read_with_icarus(rtl: Path, top: str, parameters: Parameters) -> str:
    """With all warnings."""
    options = ["-Wall", "-g2005", f"-I{rtl}", "-t", "null", "-s", top]
    return _call("iverilog", *options, *_set(f"-P{top}.{{}}={{}}", parameters), *_sources(rtl))


def read_with_slang(rtl: Path, top: str, parameters: Parameters) -> str:
    """With all warnings except unused parameters. slang prints its messages itself."""
    options = ["--std=1364-2005", "-Wextra", "-Wno-unused-parameter", "-Werror", f"-I{rtl}", "--top", top]
    words = ["slang", *options, *_set("-G{}={}", parameters), *_sources(rtl)]
    driver = Driver()
    driver.addStandardArgs()
    good = driver.parseCommandLine(" ".join(f'"{word}"' for word in words)) and driver.processOptions()
    good = good and driver.parseAllSources() and driver.runFullCompilation(quiet=True)
    return "" if good else "slang rejects this"


def read_with_surelog(rtl: Path, top: str, parameters: Parameters) -> str:
    """Surelog caches what it has parsed for the next set of parameters."""
    options = ["-parse", "-nouhdm", "-nobuiltin", "-noinfo", "-nonote", f"-I{rtl}", "-top", top]
    program = surelog.get_path() / surelog.get_bin()
    said = _call(program, *options, *_set("-P{}={}", parameters), *_sources(rtl), folder=SURELOG)
    counts = re.findall(r"^\[ *(?:FATAL|SYNTAX|ERROR|WARNING)\] : (\d+)$", said, re.M)
    return said if len(counts) != 4 or set(counts) != {"0"} else ""


READERS: dict[str, tuple[Reader, Sequence[Parameters]]] = {
    "Verilator": (read_with_verilator, CORNERS),
    "Icarus Verilog": (read_with_icarus, CORNERS),
    "slang": (read_with_slang, CORNERS),
    "Surelog": (read_with_surelog, FAR_APART),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Return 0 if there are no messages, else 1."""
    parser = argparse.ArgumentParser(description="Read the core with four front ends.")
    parser.add_argument("rtl", nargs="?", type=Path, default=paths.rtl, metavar="FOLDER")
    rtl = parser.parse_args(arguments).rtl.resolve()
    shutil.rmtree(SURELOG, ignore_errors=True)
    SURELOG.mkdir(parents=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        good = list(pool.map(partial(_read_all, rtl), READERS))
    return 0 if all(good) else 1


def _read_all(rtl: Path, name: str) -> bool:
    """Read all parameter sets with one front end; stop at the first with messages."""
    read, sets = READERS[name]
    began = time.monotonic()
    calls = [*((TOPS[0], parameters) for parameters in sets), *((top, sets[0]) for top in TOPS[1:])]
    for top, parameters in calls:
        if said := read(rtl, top, parameters):
            chosen = " ".join(f"{key}={value}" for key, value in parameters.items()) or "the defaults"
            print(f"== {name}, {top}, {chosen}:\n{said.rstrip()}", file=sys.stderr)
            return False
    seconds = time.monotonic() - began
    print(f"== {name}: {len(calls)} tops and sets of parameters ({seconds:.0f} s)", flush=True)
    return True


def _set(form: str, parameters: Parameters) -> list[str]:
    return [form.format(name, value) for name, value in parameters.items()]


def _sources(rtl: Path) -> list[Path]:
    return sorted(rtl.glob("*.v"))


def _call(*command: str | Path, folder: Path | None = None) -> str:
    """Output of a program; its exit status if it fails silently."""
    done = subprocess.run(
        list(map(str, command)),
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    return done.stdout or (f"exit status {done.returncode}" if done.returncode else "")


if __name__ == "__main__":
    sys.exit(main())
