# SPDX-License-Identifier: MIT
"""The tests as judges of the C sources: each mutant gets those that reach it, the quick ones first."""

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from passo.failure import Failure
from passo.output import write_json
from passo.toolchain import environment, paths

from verify.mutants.c_source import FOLDER, CMutant
from verify.mutants.fates import Fates, hash_of

# Those that do not take long.
TESTS = (
    *("test_math", "test_moves", "test_plan", "test_plan_forms", "test_plan_jerk", "test_plan_methods"),
    *("test_plan_shape", "test_plan_sigmoid", "test_plan_straight", "test_plan_turn", "test_plan_user"),
    *("test_path", "test_gcode", "test_gcode_arcs", "test_driver", "test_driver_encoder", "test_driver_home"),
    *("test_driver_inputs", "test_driver_outputs", "test_driver_positions", "test_driver_together"),
    *("test_driver_units", "test_driver_goto", "test_driver_homed", "test_driver_sessions"),
    *("test_driver_noise", "test_endings"),
)
MOST_FAIL = 2  # tests of a file that do not run on copies
LONGEST = 20.0  # seconds of the processor: a test that takes longer is no judge here
MOST = 40.0  # for all tests of a mutant
TEST = 0.05  # what pytest needs for each


def tests() -> list[Path]:
    """The files."""
    return [paths.tests / f"{name}.py" for name in TESTS if (paths.tests / f"{name}.py").exists()]


class Worker:
    """The process that runs the tests."""

    def __init__(self, root: Path = FOLDER, ahead: Sequence[str] = ()) -> None:
        self.root = root
        self.process = subprocess.Popen(
            [sys.executable, "-m", "verify.mutants.c_worker", str(root), *ahead],
            cwd=paths.root,
            env=environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, asked: dict[str, Any]) -> dict[str, Any]:
        """Run something; its answer.

        Raises:
            Failure: The process has ended.
        """
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(json.dumps(asked) + "\n")
        self.process.stdin.flush()
        while line := self.process.stdout.readline():
            if line.startswith("{"):
                return dict(json.loads(line))
        raise Failure("the process that runs the tests has ended")

    def end(self) -> None:
        """End it."""
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()


def record(worker: Worker, count: int, show: Callable[[str], None]) -> dict[str, dict[str, Any]]:
    """Which mutants each test reaches, in how many seconds; kept while tests and mutants are the same.

    Raises:
        Failure: A test fails without a mutant.
    """
    found: dict[str, dict[str, Any]] = {}
    helpers = [*sorted((paths.tests / "helpers").glob("*.py")), worker.root / "mutants.json"]
    for file in tests():
        kept = worker.root / f"reached-{file.stem}-{hash_of([file, *helpers])}.json"
        if not kept.exists():
            one = _record(worker, file, count, show)
            write_json(one, kept)
        found |= json.loads(kept.read_text())
    return found


def _record(worker: Worker, file: Path, count: int, show: Callable[[str], None]) -> dict[str, dict[str, Any]]:
    """The tests of one file."""
    places = worker.root / "reached"
    places.write_bytes(bytes(count + 1))
    done = worker.ask({"record": str(places), "tests": [str(file)], "longest": LONGEST})
    if "seconds" not in done:
        raise Failure(f"{file.name}: {done['test']}")
    others = set(done["failed"]) - set(done["slow"])  # that read the text of a source
    if len(others) > MOST_FAIL:
        raise Failure(f"without a mutant, these fail: {', '.join(sorted(others))}")
    for test in sorted(others):
        show(f"no judge: {test}")
    show(f"{file.name}: {len(done['seconds'])} tests, {sum(done['seconds'].values()):.0f} s")
    return {
        test: {"seconds": seconds, "reached": done["reached"][test]}
        for test, seconds in done["seconds"].items()
        if test not in others and test not in done["slow"]
    }


class Kills:
    """Which tests kill mutants of which file: those come first, by how many in a second."""

    def __init__(self, mutants: Sequence[CMutant], fates: Fates) -> None:
        self.count: Counter[tuple[str, str]] = Counter()
        for mutant in mutants:
            self.add(mutant, fates.get(mutant.name).killed)

    def add(self, mutant: CMutant, test: str) -> None:
        """A test has killed a mutant."""
        self.count[mutant.file, test] += 1

    def chosen(self, mutant: CMutant, reaching: dict[str, float], limit: float) -> list[str]:
        """As many tests as there is time for."""

        def last(item: tuple[str, float]) -> float:
            test, seconds = item
            return (seconds + TEST) / (1 + self.count[mutant.file, test])

        tests: list[str] = []
        total = 0.0
        for test, seconds in sorted(reaching.items(), key=last):
            if seconds <= LONGEST and total + seconds + TEST <= limit:
                total += seconds + TEST
                tests.append(test)
        return tests


def judge(
    mutants: Sequence[CMutant],
    fates: Fates,
    show: Callable[[str], None],
    limits: Sequence[float] = (1.5, MOST),
) -> None:
    """Let the tests judge all mutants: first those of a second, then of more."""
    worker = Worker(ahead=[f"tests.{file.stem}" for file in tests()])
    try:
        reached = record(worker, len(mutants), show)
        of: dict[int, dict[str, float]] = {mutant.number: {} for mutant in mutants}
        for test, found in reached.items():
            for number in found["reached"]:
                if number in of:
                    of[number][test] = found["seconds"]
        if fates.other:
            _again(mutants, fates, worker, show)
        kills = Kills(mutants, fates)
        for limit in limits:
            name = f"{limit} s"
            for i, mutant in enumerate(mutants, 1):
                fate = fates.get(mutant.name)
                if not fate.waits(name):
                    continue
                tried = fate.tried or []
                left = {test: seconds for test, seconds in of[mutant.number].items() if test not in tried}
                if chosen := kills.chosen(mutant, left, limit):
                    done = worker.ask({"mutant": mutant.number, "tests": chosen, "seconds": 2 * limit + 5})
                    fate.killed = fate.says = done["test"]
                    if fate.killed:
                        kills.add(mutant, fate.killed)
                fate.tried = [*tried, *chosen, name]
                if i % 10 == 0:
                    fates.save()
                    living = sum(fates.get(mutant.name).lives for mutant in mutants)
                    show(f"C: {i} of {len(mutants)} within {limit} s: {living} live")
            fates.save()
    finally:
        worker.end()


def _again(mutants: Sequence[CMutant], fates: Fates, worker: Worker, show: Callable[[str], None]) -> None:
    """Other sources or judges: what was killed must be killed by the same test once more."""
    count = 0
    for mutant in mutants:
        fate = fates.get(mutant.name)
        if "::" in fate.killed:
            done = worker.ask({"mutant": mutant.number, "tests": [fate.killed], "seconds": MOST})
            if not done["test"]:
                fate.killed = fate.says = ""
            count += 1
        else:
            fate.killed = fate.says = ""
    fates.other = False
    fates.save()
    show(f"C: {count} kills tried again")
