# SPDX-License-Identifier: MIT
"""The tests as judges of the C sources: each mutant gets those that reach it, the best ones first."""

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from passo.failure import Failure
from passo.output import write_json
from passo.toolchain import environment, paths

from verify.mutants.c_source import FOLDER, CMutant
from verify.mutants.fates import Fate, Fates, hash_of

# Those that do not take long.
TESTS = (
    *("test_math", "test_moves", "test_plan", "test_plan_course", "test_plan_edges", "test_plan_forms"),
    "test_plan_jerk",
    *("test_plan_methods", "test_plan_shape", "test_plan_sigmoid", "test_plan_straight", "test_plan_turn"),
    *("test_plan_user", "test_path", "test_path_changes", "test_path_lines", "test_path_relations"),
    *("test_path_search", "test_path_motors", "test_path_feed"),
    *("test_path_reference", "test_path_reference_jerk"),
    *("test_gcode", "test_gcode_arcs", "test_gcode_cycles", "test_gcode_edges"),
    *("test_gcode_jog", "test_gcode_tools", "test_gcode_words", "test_motors"),
    *("test_driver", "test_driver_after", "test_driver_dma", "test_driver_edges", "test_driver_encoder"),
    *("test_driver_home", "test_driver_inputs", "test_driver_outputs", "test_driver_positions"),
    *("test_driver_together", "test_driver_units", "test_driver_goto", "test_driver_homed"),
    *("test_driver_sessions", "test_driver_noise", "test_driver_square", "test_driver_frames"),
    *("test_driver_waits", "test_endings"),
)
MOST_FAIL = 2  # tests of a file that do not run on copies
LONGEST = 20.0  # seconds of the processor: a test that takes longer is no judge here
MOST = 40.0  # for all tests of a mutant
TEST = 0.01  # what pytest needs for each
PLAYED = "tests"  # those that reach a mutant have judged it, if there are any


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


@dataclass(frozen=True)
class Test:
    """A test, and the mutants that it reaches."""

    name: str
    case: str  # the name, and what identifies test and sources: as the fates name it
    seconds: float
    reached: frozenset[int]


def record(worker: Worker, show: Callable[[str], None]) -> list[Test]:
    """All tests; what is measured of them is kept while tests and mutants are the same.

    Raises:
        Failure: A test fails without a mutant.
    """
    found: list[Test] = []
    count = len(json.loads((worker.root / "mutants.json").read_text())["mutants"])
    helpers = [*sorted((paths.tests / "helpers").glob("*.py")), worker.root / "mutants.json"]
    for file in tests():
        identified = hash_of([file, *helpers])
        kept = worker.root / f"reached-{file.stem}-{identified}.json"
        if not kept.exists():
            write_json(_record(worker, file, count, show), kept)
        for name, of in json.loads(kept.read_text()).items():
            found.append(Test(name, f"{name} {identified}", of["seconds"], frozenset(of["reached"])))
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
    """Which tests kill mutants of which file, and how much of what they reach is in it."""

    def __init__(self, mutants: Sequence[CMutant], fates: Fates) -> None:
        self.count: Counter[tuple[str, str]] = Counter()
        self.of_file: dict[str, set[int]] = {}
        for mutant in mutants:
            self.of_file.setdefault(mutant.file, set()).add(mutant.number)
            self.add(mutant, fates.get(mutant.name).killed)

    def add(self, mutant: CMutant, case: str) -> None:
        """A test has killed a mutant."""
        self.count[mutant.file, case] += 1

    def cost(self, mutant: CMutant, test: Test) -> float:
        """Seconds for a kill, as far as is known; tests of this file alone are better than those of many."""
        share = len(test.reached & self.of_file[mutant.file]) / len(test.reached)
        return (test.seconds + TEST) / (share + self.count[mutant.file, test.case])

    def chosen(self, mutant: CMutant, reaching: Sequence[Test], limit: float) -> list[Test]:
        """As many tests as there is time for, the best ones first."""
        chosen: list[Test] = []
        total = 0.0
        for test in sorted(reaching, key=lambda test: self.cost(mutant, test)):
            if total + test.seconds + TEST <= limit:
                total += test.seconds + TEST
                chosen.append(test)
        return chosen


class Judge:
    """Lets tests judge mutants."""

    def __init__(
        self, worker: Worker, known: Sequence[Test], mutants: Sequence[CMutant], fates: Fates
    ) -> None:
        self.worker, self.known, self.mutants, self.fates = worker, known, mutants, fates
        self.kills = Kills(mutants, fates)

    def again(self) -> int:
        """Of other sources or tests: what was killed must be killed by the same test once more; how many."""
        cases = {test.case for test in self.known}
        by_name = {test.name: test for test in self.known}
        count = 0
        for mutant in self.mutants:
            fate = self.fates.get(mutant.name)
            fate.tried = [case for case in fate.tried or [] if case in cases or "::" not in case]
            if fate.killed and fate.killed not in cases:
                test, fate.killed, fate.says = by_name.get(fate.killed.rpartition(" ")[0]), "", ""
                if test:
                    self._ask(mutant, fate, [test], MOST)
                    count += 1
        self.fates.save()
        return count

    def play(self, mutant: CMutant, limit: float) -> None:
        """Those that it has not survived yet, for some seconds in all."""
        fate = self.fates.get(mutant.name)
        tried = fate.tried or []
        reaching = [test for test in self.known if mutant.number in test.reached]
        left = [test for test in reaching if test.case not in tried]
        spent = sum(test.seconds + TEST for test in reaching if test.case in tried)
        chosen = self.kills.chosen(mutant, left, limit - spent)
        fate.tried = list(dict.fromkeys([*tried, PLAYED, *(test.case for test in chosen)]))
        if chosen:
            self._ask(mutant, fate, chosen, limit)

    def _ask(self, mutant: CMutant, fate: Fate, chosen: Sequence[Test], limit: float) -> None:
        cases = {test.name: test.case for test in chosen}
        done = self.worker.ask({"mutant": mutant.number, "tests": list(cases), "seconds": 2 * limit + 5})
        if done["test"]:
            fate.killed, fate.says = cases[done["test"]], done["says"]
            self.kills.add(mutant, fate.killed)


def judge(
    mutants: Sequence[CMutant],
    fates: Fates,
    show: Callable[[str], None],
    limits: Sequence[float] = (1.5, MOST),
) -> None:
    """Let the tests judge all mutants: first those of a second, then of more."""
    worker = Worker(ahead=[f"tests.{file.stem}" for file in tests()])
    try:
        known = record(worker, show)
        judging = Judge(worker, known, mutants, fates)
        show(f"C: {judging.again()} kills tried again")
        for limit in limits:
            for i, mutant in enumerate(mutants, 1):
                if fates.get(mutant.name).lives:
                    judging.play(mutant, limit)
                if i % 10 == 0 or i == len(mutants):
                    fates.save()
                    living = sum(fates.get(mutant.name).lives for mutant in mutants)
                    show(f"C: {i} of {len(mutants)} within {limit} s: {living} live")
    finally:
        worker.end()
