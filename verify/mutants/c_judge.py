# SPDX-License-Identifier: MIT
"""The tests as judges of the C sources: each mutant gets those that reach it, the best ones first."""

import json
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from passo.failure import Failure
from passo.output import write_json
from passo.toolchain import environment, paths

from verify.mutants.c_source import FOLDER, CMutant
from verify.mutants.fates import BUILD, Fate, Fates, hash_of

# Those that do not take long.
TESTS = (
    *("test_math", "test_moves", "test_plan", "test_plan_course", "test_plan_edges", "test_plan_forms"),
    "test_plan_jerk",
    *("test_plan_methods", "test_plan_shape", "test_plan_sigmoid", "test_plan_straight", "test_plan_turn"),
    *("test_plan_user", "test_path", "test_path_changes", "test_path_lines", "test_path_relations"),
    *("test_path_parts", "test_path_limits", "test_path_ramps"),
    *("test_path_search", "test_path_motors", "test_path_feed"),
    *("test_path_reference", "test_path_reference_jerk"),
    *("test_gcode", "test_gcode_arcs", "test_gcode_cycles", "test_gcode_edges"),
    *("test_gcode_jog", "test_gcode_tools", "test_gcode_words", "test_motors"),
    *("test_driver", "test_driver_after", "test_driver_dma", "test_driver_edges", "test_driver_encoder"),
    *("test_driver_home", "test_driver_inputs", "test_driver_outputs", "test_driver_positions"),
    *("test_driver_together", "test_driver_units", "test_driver_goto", "test_driver_homed"),
    *("test_driver_sessions", "test_driver_noise", "test_driver_square", "test_driver_frames"),
    *("test_driver_waits", "test_driver_pass", "test_endings", "test_follow", "test_gcode_lathe"),
)
MOST_FAIL = 2  # tests of a file that do not run on copies
REACHED = BUILD / "reached"
LONGEST = 20.0  # seconds of the processor: a test that takes longer is no judge here
MOST = 40.0  # for all tests of a mutant
TEST = 0.01  # what pytest needs for each
PLAYED = "tests"  # those that reach a mutant have judged it, if there are any


def tests(only: Collection[str] = ()) -> list[Path]:
    """The files, or some of them."""
    names = [name for name in TESTS if not only or name in only]
    return [paths.tests / f"{name}.py" for name in names if (paths.tests / f"{name}.py").exists()]


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
    judge: str  # identifies its file and the helpers of that
    seconds: float
    reached: frozenset[str]  # names

    def case(self, mutant: CMutant) -> str:
        """As the fate of a mutant names it, while the test and the source of the mutant are the same."""
        return f"{self.name} {self.judge}/{mutant.source}"


def _imported(file: Path) -> list[Path]:
    """A file of tests and those that it takes from other ones, at any depth."""
    found = [file]
    for one in found:
        for module in re.findall(r"^from (tests[.\w]+) import", one.read_text(encoding="utf-8"), re.M):
            path = paths.root / f"{module.replace('.', '/')}.py"
            if path.exists() and path not in found:
                found.append(path)
    return found


def record(
    worker: Worker,
    mutants: Sequence[CMutant],
    files: Sequence[Path],
    show: Callable[[str], None],
    root: Path = REACHED,
) -> list[Test]:
    """The tests of files; what is measured of a file is kept while it and the sources that it reaches are the
    same.

    Raises:
        Failure: A test fails without a mutant.
    """
    found: list[Test] = []
    names: dict[tuple[str, str], list[str]] = {}
    for mutant in mutants:
        names.setdefault((mutant.file, mutant.source), []).append(mutant.name)
    of_file = {name: hash_of([], source, *those) for (name, source), those in names.items()}
    for file in files:
        judge = hash_of(_imported(file))
        path = root / f"{file.stem}.json"
        kept = json.loads(path.read_text()) if path.exists() else {}
        reached = {name.split()[0] for of in kept.get("tests", {}).values() for name in of["reached"]}
        changed = {name for name, source in of_file.items() if kept.get("sources", {}).get(name) != source}
        if kept.get("judge") != judge or changed & reached or changed - kept["sources"].keys():
            kept = {"judge": judge, "sources": of_file, "tests": _record(worker, file, mutants, show)}
            root.mkdir(parents=True, exist_ok=True)
            write_json(kept, path)
        for name, of in kept["tests"].items():
            found.append(Test(name, judge, of["seconds"], frozenset(of["reached"])))
    return found


def _record(
    worker: Worker, file: Path, mutants: Sequence[CMutant], show: Callable[[str], None]
) -> dict[str, dict[str, Any]]:
    """The tests of one file."""
    names = {mutant.number: mutant.name for mutant in mutants}
    places = worker.root / "reached"
    places.write_bytes(bytes(max(names) + 1))
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
        test: {"seconds": seconds, "reached": [names[number] for number in done["reached"][test]]}
        for test, seconds in done["seconds"].items()
        if test not in others and test not in done["slow"]
    }


class Kills:
    """Which tests kill mutants of which file, and how much of what they reach is in it."""

    def __init__(self, mutants: Sequence[CMutant], fates: Fates) -> None:
        self.count: Counter[tuple[str, str]] = Counter()
        self.of_file: dict[str, set[str]] = {}
        for mutant in mutants:
            self.of_file.setdefault(mutant.file, set()).add(mutant.name)
            self.add(mutant, fates.get(mutant.name).killed)

    def add(self, mutant: CMutant, case: str) -> None:
        """A test has killed a mutant."""
        self.count[mutant.file, case] += 1

    def cost(self, mutant: CMutant, test: Test) -> float:
        """Seconds for a kill, as far as is known; tests of this file alone are better than those of many."""
        share = len(test.reached & self.of_file[mutant.file]) / len(test.reached)
        return (test.seconds + TEST) / (share + self.count[mutant.file, test.case(mutant)])

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
        self,
        worker: Worker,
        known: Sequence[Test],
        mutants: Sequence[CMutant],
        fates: Fates,
        some: bool = False,
    ) -> None:
        self.worker, self.known, self.mutants, self.fates = worker, known, mutants, fates
        self.by_name = {test.name: test for test in known}
        self.some = some  # there are other tests, which are not known
        self.kills = Kills(mutants, fates)

    def _holds(self, case: str, mutant: CMutant) -> bool:
        """Whether it is of the same source and test."""
        name, _, of = case.rpartition(" ")
        if test := self.by_name.get(name):
            return case == test.case(mutant)
        return self.some and of.endswith(f"/{mutant.source}")

    def again(self) -> int:
        """Of other sources or tests: what was killed must be killed by the same test once more; how many."""
        count = 0
        for mutant in self.mutants:
            fate = self.fates.get(mutant.name)
            fate.tried = [case for case in fate.tried or [] if "::" not in case or self._holds(case, mutant)]
            if fate.killed and not self._holds(fate.killed, mutant):
                test, fate.killed, fate.says = self.by_name.get(fate.killed.rpartition(" ")[0]), "", ""
                if test:
                    self._ask(mutant, fate, [test], MOST)
                    count += 1
        self.fates.save()
        return count

    def play(self, mutant: CMutant, limit: float) -> None:
        """Those that it has not survived yet, for some seconds in all."""
        fate = self.fates.get(mutant.name)
        tried = fate.tried or []
        reaching = [test for test in self.known if mutant.name in test.reached]
        left = [test for test in reaching if test.case(mutant) not in tried]
        spent = sum(test.seconds + TEST for test in reaching if test.case(mutant) in tried)
        chosen = self.kills.chosen(mutant, left, limit - spent)
        fate.tried = list(dict.fromkeys([*tried, PLAYED, *(test.case(mutant) for test in chosen)]))
        if chosen:
            self._ask(mutant, fate, chosen, limit)

    def _ask(self, mutant: CMutant, fate: Fate, chosen: Sequence[Test], limit: float) -> None:
        cases = {test.name: test.case(mutant) for test in chosen}
        asked = {"mutant": mutant.number, "tests": list(cases), "seconds": 2 * limit + 5}
        done = self.worker.ask(asked)
        # what alone needs longer than it was recorded with is no fault of the mutant
        if done["says"].startswith("ends") and self.worker.ask({**asked, "mutant": 0})["test"]:
            done = self.worker.ask({**asked, "seconds": 10 * limit + 60})
        if done["test"]:
            fate.killed, fate.says = cases[done["test"]], done["says"]
            self.kills.add(mutant, fate.killed)


def judge(
    all_mutants: Sequence[CMutant],
    mutants: Sequence[CMutant],
    fates: Fates,
    show: Callable[[str], None],
    only: Collection[str] = (),
    limits: Sequence[float] = (1.5, MOST),
) -> None:
    """Let the tests, or those of some files, judge some of all mutants, first for a second."""
    files = tests(only)
    worker = Worker(ahead=[f"tests.{file.stem}" for file in files])
    try:
        known = record(worker, all_mutants, files, show)
        judging = Judge(worker, known, mutants, fates, bool(only))
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
