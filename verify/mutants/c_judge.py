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
    *("test_driver_promises", "test_driver_trackers", "test_path_parts_rare", "test_path_promises"),
    *("test_path_pace", "test_path_cuts", "test_path_times", "test_plan_work"),
    *("test_console", "test_console_channels", "test_console_encoders", "test_console_inputs"),
    *("test_console_outputs", "test_console_trackers", "test_servo", "test_grbl", "test_grbl_backlash"),
    *("test_grbl_check", "test_grbl_histories", "test_grbl_home", "test_grbl_lines", "test_grbl_pins"),
    *("test_grbl_requests", "test_grbl_settings", "test_grbl_states", "test_grbl_threads"),
    *("test_grbl_tools", "test_axis_letters", "test_motor_encoders", "test_spindle_wait", "test_part"),
    "test_rigid_tapping",
)
RECORD = "test_plan_record"  # no judge: it sees that a plan has changed; for those that live in the end
LONG = Path(__file__).with_name("c_long.py")
MOST_FAIL = 2  # tests of a file that do not run on copies
REACHED = BUILD / "reached"
LONGEST = 20.0  # seconds of the processor: a test that takes longer is no judge here
LIMITS = (1.5, 8.0, 40.0)  # for all tests of a mutant: of each round
TEST = 0.01  # what pytest needs for each
FEW = 8  # tests that a mutant gets first
NEAR = 3  # a kill in the same function counts as that many more in the file
PLAYED = "tests"  # those that reach a mutant have judged it, if there are any


def tests(only: Collection[str] = ()) -> list[Path]:
    """The files, or some of them; LONG only if it is named."""
    files = [paths.tests / f"{name}.py" for name in (*TESTS, RECORD) if not only or name in only]
    return [file for file in (*files, *([LONG] if LONG.stem in only else [])) if file.exists()]


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
        kept = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
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
    """What is known of the tests: which have killed mutants of a function or file, and which have not."""

    def __init__(self, mutants: Sequence[CMutant], fates: Fates) -> None:
        self.killed: Counter[tuple[str, str]] = Counter()  # of a file, and once more of its function
        self.passed: Counter[tuple[str, str]] = Counter()
        self.of_file: dict[str, set[str]] = {}
        for mutant in mutants:
            self.of_file.setdefault(mutant.file, set()).add(mutant.name)
            fate = fates.get(mutant.name)
            self.add(mutant, fate.tried or [], fate.killed)

    def add(self, mutant: CMutant, tried: Sequence[str], killer: str) -> None:
        """Cases that were tried one after the other; the last of them is the one that killed, if any did."""
        for case in tried[: tried.index(killer)] if killer in tried else tried:
            self.passed[mutant.file, case] += 1
        if killer:
            self.killed[mutant.file, killer] += 1
            self.killed[f"{mutant.file} {mutant.function}", killer] += 1

    def cost(self, mutant: CMutant, test: Test) -> float:
        """Seconds for a kill, as far as is known: a test that killed in the same function is the best one,
        one of this file alone is better than one of many, and one that often did not kill is a bad one."""
        case = test.case(mutant)
        share = len(test.reached & self.of_file[mutant.file]) / len(test.reached)
        near = self.killed[f"{mutant.file} {mutant.function}", case]
        kills = share + self.killed[mutant.file, case] + NEAR * near
        return (test.seconds + TEST) * (1 + self.passed[mutant.file, case]) / kills

    def chosen(self, mutant: CMutant, reaching: Sequence[Test], limit: float) -> list[Test]:
        """As many tests as there is time for, the best ones first; of one file, each further one waits
        longer, as it mostly looks at the same."""
        ranks: Counter[str] = Counter()
        costs: list[tuple[float, Test]] = []
        for cost, test in sorted(((self.cost(mutant, test), test) for test in reaching), key=_first):
            file = test.name.partition("::")[0]
            ranks[file] += 1
            costs.append((cost * ranks[file], test))
        chosen: list[Test] = []
        total = 0.0
        for _, test in sorted(costs, key=_first):
            if total + test.seconds + TEST <= limit:
                total += test.seconds + TEST
                chosen.append(test)
        return chosen


def _first(pair: tuple[float, Test]) -> float:
    return pair[0]


def _of_record(case: str) -> bool:
    return f"/{RECORD}.py::" in case


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
        other = self.some or name.startswith(f"{LONG.relative_to(paths.root)}::")
        return other and of.endswith(f"/{mutant.source}")

    def again(self) -> int:
        """Of other sources or tests: what was killed must be killed by the same test once more; how many."""
        count = 0
        for mutant in self.mutants:
            fate = self.fates.get(mutant.name)
            fate.tried = [case for case in fate.tried or [] if "::" not in case or self._holds(case, mutant)]
            if _of_record(fate.killed):  # a judge may see it by now
                fate.tried = [case for case in fate.tried if not _of_record(case)]
                fate.killed = fate.says = ""
            if fate.killed and not self._holds(fate.killed, mutant):
                test, fate.killed, fate.says = self.by_name.get(fate.killed.rpartition(" ")[0]), "", ""
                if test:
                    self._ask(mutant, fate, [test], LIMITS[-1])
                    count += 1
        self.fates.save()
        return count

    def play(self, mutant: CMutant, limit: float, record: bool = False) -> None:
        """Those that it has not survived yet, for some seconds in all: judges, or the record."""
        fate = self.fates.get(mutant.name)
        tried = fate.tried or []
        reaching = [
            test for test in self.known if mutant.name in test.reached and _of_record(test.name) == record
        ]
        left = [test for test in reaching if test.case(mutant) not in tried]
        spent = sum(test.seconds + TEST for test in reaching if test.case(mutant) in tried)
        chosen = self.kills.chosen(mutant, left, limit - spent)
        fate.tried = list(dict.fromkeys([*tried, PLAYED, *(test.case(mutant) for test in chosen)]))
        if chosen:
            self._ask(mutant, fate, chosen, limit)

    def _ask(self, mutant: CMutant, fate: Fate, chosen: Sequence[Test], limit: float) -> None:
        """The first few alone: mostly one of them kills, and the files of the others are not read."""
        for some in filter(None, (chosen[:FEW], chosen[FEW:])):
            cases = {test.name: test.case(mutant) for test in some}
            asked = {"mutant": mutant.number, "tests": list(cases), "seconds": 1.5 * limit + 2}
            done = self.worker.ask(asked)
            # what alone needs longer than it was recorded with is no fault of the mutant
            if done["says"].startswith("ends") and self.worker.ask({**asked, "mutant": 0})["test"]:
                done = self.worker.ask({**asked, "seconds": 10 * limit + 60})
            if done["test"]:
                fate.killed, fate.says = cases[done["test"]], done["says"]
            self.kills.add(mutant, list(cases.values()), fate.killed)
            if fate.killed:
                return


def judge(
    all_mutants: Sequence[CMutant],
    mutants: Sequence[CMutant],
    fates: Fates,
    show: Callable[[str], None],
    only: Collection[str] = (),
    limits: Sequence[float] = LIMITS,
) -> None:
    """Let the tests, or those of some files, judge some of all mutants, first for a second each."""
    files = tests(only)
    modules = [".".join(file.relative_to(paths.root).with_suffix("").parts) for file in files]
    worker = Worker(ahead=modules)
    try:
        known = record(worker, all_mutants, files, show)
        judging = Judge(worker, known, mutants, fates, bool(only))
        show(f"C: {judging.again()} kills tried again")
        rounds = [*((limit, False) for limit in limits), (limits[-1], True)]
        for limit, on_record in rounds:
            for i, mutant in enumerate(mutants, 1):
                if fates.get(mutant.name).lives:
                    judging.play(mutant, limit, on_record)
                if i % 10 == 0 or i == len(mutants):
                    fates.save()
                    living = sum(fates.get(mutant.name).lives for mutant in mutants)
                    what = "the record" if on_record else f"tests of {limit} s"
                    show(f"C: {i} of {len(mutants)}, {what}: {living} live")
    finally:
        worker.end()
