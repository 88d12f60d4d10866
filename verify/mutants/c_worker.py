# SPDX-License-Identifier: MIT
"""Runs tests on C sources with mutants, below the folder that is given; modules that follow are imported
before, and what their function `ahead` makes is made. Reads JSON objects, one in a line:

    {"mutant": N, "tests": [...], "seconds": S}    gives {"mutant": N, "test": what failed or "", "says": how}
    {"record": FILE, "tests": [...], "longest": S} gives {"seconds": {test: S}, "reached": {test: [N, ...]},
                                                          "failed": [...], "slow": [...]}

Each run is in a process of its own, in which what is imported and compiled is there already.
"""

import contextlib
import importlib
import json
import os
import resource
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from passo import compiler
from passo.toolchain import paths

from verify.mutants.c_source import FOLDERS

# What tests import: before the first mutant.
AHEAD = ("numpy", "pytest", "passo.build", "passo.driver", "tests.helpers.driver_wire", "tests.helpers.plans")


def _switch(root: Path) -> None:
    """Take the mutated folders for the sources; what is built from them is elsewhere."""
    for name in FOLDERS:
        setattr(paths, name, root / name)
    paths.build = root / "build"
    compiler.STRICT = ("-std=c11", "-w")


def _seconds() -> float:
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


class Recorder:
    """A plugin of pytest: how long each test takes, which mutants it reaches, what fails."""

    def __init__(self, begins: Callable[[str], None], reached: Path | None = None, longest: float = 0.0):
        self.begins = begins
        self.file = reached
        self.seconds: dict[str, float] = {}
        self.reached: dict[str, list[int]] = {}
        self.failed: list[str] = []
        self.slow: list[str] = []  # ended as they took too long
        self.began = 0.0
        self.longest = longest

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """A test begins."""
        self.begins(nodeid)
        self.began = _seconds()

        def end(*_: Any) -> None:
            self.slow.append(nodeid)
            raise TimeoutError("it takes too long")

        if self.longest:
            signal.signal(signal.SIGPROF, end)
            signal.setitimer(signal.ITIMER_PROF, self.longest)

    def pytest_runtest_logreport(self, report: Any) -> None:
        """A part of it has ended."""
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """It has ended."""
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        self.seconds[nodeid] = round(_seconds() - self.began, 3)
        if self.file:
            places = self.file.read_bytes()
            self.reached[nodeid] = [number for number, place in enumerate(places) if place]
            with self.file.open("r+b") as file:
                file.write(bytes(len(places)))


def _run(recorder: Recorder, tests: list[str]) -> int:
    import pytest

    # the tests are imported already: without assertions that are rewritten
    options = [
        "-x",
        "-q",
        "-p",
        "no:cacheprovider",
        "-p",
        "no:xdist",
        "--no-header",
        "--tb=no",
        "--assert=plain",
    ]
    if recorder.file:
        options.remove("-x")
    with (
        Path(os.devnull).open("w") as null,
        contextlib.redirect_stdout(null),
        contextlib.redirect_stderr(null),
    ):
        return int(pytest.main([*options, *tests], plugins=[recorder]))


def _answer(asked: dict[str, Any], begins: Callable[[str], None]) -> dict[str, Any]:
    """In the process of one run, which tells the tests that begin."""
    if "record" in asked:
        recorder = Recorder(begins, Path(asked["record"]), asked["longest"])
        _run(recorder, asked["tests"])
        return {
            "seconds": recorder.seconds,
            "reached": recorder.reached,
            "failed": recorder.failed,
            "slow": recorder.slow,
        }
    recorder = Recorder(begins)
    status = _run(recorder, asked["tests"])
    if status == 0:
        return {"mutant": asked["mutant"], "test": "", "says": ""}
    test = recorder.failed[0] if recorder.failed else asked["tests"][0]
    return {"mutant": asked["mutant"], "test": test, "says": f"pytest ends with {status}"}


def _forked(asked: dict[str, Any]) -> dict[str, Any]:
    """Run it in a process of its own; one that does not end or that crashes has failed."""
    os.environ["PASSO_MUTANT"] = str(asked.get("mutant", 0))
    os.environ["PASSO_REACHED"] = asked.get("record", "")
    read, write = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(read)
        os.setsid()
        if "seconds" in asked:
            limit = int(asked["seconds"]) + 1
            resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
            resource.setrlimit(resource.RLIMIT_AS, (6 << 30, 6 << 30))
            signal.alarm(20 * limit)
        with os.fdopen(write, "w", buffering=1) as pipe:
            answer = _answer(asked, lambda test: print(test, file=pipe))
            print(json.dumps(answer), file=pipe)
        os._exit(0)
    os.close(write)
    last = ""
    with os.fdopen(read) as pipe:
        for line in pipe:
            last = line.rstrip("\n")
    _, status = os.waitpid(process, 0)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)
    if last.startswith("{"):
        return dict(json.loads(last))
    ended = signal.Signals(os.WTERMSIG(status)).name if os.WIFSIGNALED(status) else f"status {status}"
    return {"mutant": asked.get("mutant"), "test": last or asked["tests"][0], "says": f"ends with {ended}"}


def main() -> None:
    """Answer each line."""
    _switch(Path(sys.argv[1]))
    for module in (*AHEAD, *sys.argv[2:]):
        getattr(importlib.import_module(module), "ahead", lambda: None)()
    for line in sys.stdin:
        print(json.dumps(_forked(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
