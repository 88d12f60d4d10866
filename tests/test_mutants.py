# SPDX-License-Identifier: MIT
"""A sample of `make verify ONLY=mutants`: that judges see mutants, and that a score can be 0."""

import json
import random
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from passo import random_cases
from passo.build import TOP, Parameters
from passo.engine import model_engine
from passo.toolchain import environment

from verify.mutants import (
    c_judge,
    corners_judge,
    encoders_judge,
    engine_judge,
    equivalence,
    fates,
    formal_judge,
    frames_judge,
    inputs_judge,
    lines_judge,
    motions_judge,
    outputs_judge,
    page,
    registers_judge,
    rests_judge,
    shapes_judge,
    timings_judge,
    trackers_judge,
)
from verify.mutants.c_equal import object_code
from verify.mutants.c_judge import Worker
from verify.mutants.c_mutate import DECLARED
from verify.mutants.c_source import CMutant
from verify.mutants.c_source import drawn as drawn_c
from verify.mutants.cells import kind_of
from verify.mutants.engine_judge import Check
from verify.mutants.netlist import PLAIN, TRACKED, Core, Mutant, drawn, file_of
from verify.mutants.netlist import library as verilated
from verify.soak.parts import MACHINE, SETS
from verify.soak.program import build

SEED = random_cases.seed()
# The smallest core, two mutants of each module; in any other folder than those of `make verify ONLY=mutants`.
SAMPLE = Core("sample", SETS[0], (*PLAIN.modules, "passo_lines", "passo_tables"))
EACH = 2
FILE = "passo_gcode_angle.c"


@pytest.fixture(scope="module")
def sample() -> tuple[list[Mutant], Path]:
    """Mutants, and the library with them."""
    mutants, _ = drawn(SAMPLE, SEED, EACH)
    return mutants, verilated(SAMPLE)


def command(library: Path, *more: str) -> list[str]:
    """The soak's program with mutants of the first parameter set."""
    return [str(build()), "1", "0", "3", "--set", "0", "--rtl", str(library), "--mutants", *more]


def killed(library: Path, numbers: list[int], *more: str) -> set[int]:
    """Those that the judge at the pins kills."""
    done = subprocess.run(
        command(library, *more),
        input=" ".join(map(str, numbers)),
        env=environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    return {int(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("killed ")}


def test_the_judge_at_the_pins_kills_mutants_and_not_the_core(sample: tuple[list[Mutant], Path]) -> None:
    """More than a third of any sample within three histories; the core itself lives."""
    mutants, library = sample
    found = killed(library, [0, *(mutant.number for mutant in mutants)])
    print(f"seed {SEED}: {len(found)} of {len(mutants)}")
    assert 0 not in found
    assert len(found) > len(mutants) / 3


def test_a_judge_that_is_switched_off_scores_0(sample: tuple[list[Mutant], Path]) -> None:
    """No other fault of a core ends a history."""
    mutants, library = sample
    some = [mutant.number for mutant in mutants][:: len(mutants) // 8]
    assert killed(library, some, "--off") == set()


@pytest.mark.parametrize(
    ("check", "modules"),
    [
        (frames_judge.CHECK, ("header", "verdict", "reply", "link", "link_bus")),
        (motions_judge.CHECK, ("timescale", "motion", "dda", "profile", "axis")),
        (shapes_judge.CHECK, ("ramp", "interpolate", "ramp_tick", "path", "tables")),
        (corners_judge.CHECK, ("motion", "ramp", "timescale", "core", "channel")),
        (lines_judge.CHECK, ("line", "dda", "lines", "line_queue")),
        (timings_judge.CHECK, ("axis", "axis_settings", "axes")),
        (rests_judge.CHECK, ("line_queue", "ramp_queue", "admission", "motion", "axis")),
        (registers_judge.CHECKS[0], ("rules", "registers", "header", "verdict", "link_bus")),
    ],
)
def test_a_check_in_python_kills_mutants(
    check: Check, modules: tuple[str, ...], sample: tuple[list[Mutant], Path]
) -> None:
    """One of some modules whose work it checks; it finds no fault with the core itself."""
    mutants, library = sample
    some = [mutant.number for mutant in mutants if mutant.module.removeprefix("passo_") in modules]
    assert not engine_judge.broken(SAMPLE, library, 0, str(SEED), check)
    assert any(engine_judge.broken(SAMPLE, library, number, str(SEED), check) for number in some)


@pytest.mark.parametrize(
    ("check", "parameters"),
    [
        (inputs_judge.CHECK, MACHINE),
        (outputs_judge.CHECK, MACHINE),
        (encoders_judge.CHECK, MACHINE),
        (rests_judge.CHECK, MACHINE),
        (trackers_judge.CHECK, TRACKED.parameters),
    ],
)
def test_a_check_of_a_machine_finds_no_fault_with_the_core(check: Check, parameters: Parameters) -> None:
    """On the model: that it can fail is shown by its mutants."""
    with model_engine(parameters) as engine:
        check.play(engine, parameters, random.Random(SEED))


@pytest.mark.sample(1)
def test_a_promise_kills_a_mutant() -> None:
    """One of some, in modules whose proofs are quick; without a mutant these are proved."""
    mutants, _ = drawn(SAMPLE, SEED, EACH)
    killed = 0
    for module in ("passo_admission", "passo_line", "passo_path"):
        some = [mutant for mutant in mutants if mutant.module == module]
        problem = formal_judge.Problem(SAMPLE, some, formal_judge.proofs_of(module)[0])
        assert formal_judge.broken(problem, 0, 60) == ""
        killed += sum(bool(formal_judge.broken(problem, number, 60)) for number in problem.numbers)
    assert killed


def test_a_promise_that_fails_in_every_clock_kills_a_mutant() -> None:
    """It breaks no induction, which begins where all promises are kept."""
    drawn(SAMPLE, SEED, EACH)
    module = json.loads((SAMPLE.folder / "core.json").read_text())["modules"]["passo_spi_top"]
    name = next(name for name in module["cells"] if kind_of(name) == "not")
    mutation = f"mutate -mode inv -module passo_spi_top -cell {name} -port Y -portbit 0"
    mutant = Mutant(SAMPLE.name, 1, "passo_spi_top", mutation, "")
    problem = formal_judge.Problem(SAMPLE, [mutant], formal_judge.proofs_of("passo_spi_top")[0])
    assert formal_judge.broken(problem, 0, 60) == ""
    assert formal_judge.broken(problem, 1, 60) == "drives_miso_when_selected"


def test_what_a_judge_kills_is_not_equal(sample: tuple[list[Mutant], Path]) -> None:
    """The solver proves the module equal to itself, and no mutant that is seen at the pins."""
    mutants, library = sample
    some = [mutant for mutant in mutants if mutant.module in ("passo_axis", "passo_line", "passo_crc")]
    groups: dict[tuple[str, str], list[Mutant]] = {}
    for mutant in some:
        groups.setdefault((mutant.netlist_module, mutant.module), []).append(mutant)
    problems = equivalence.prepare(SAMPLE, groups)
    found = killed(library, [mutant.number for mutant in some])
    for problem in problems.values():
        assert equivalence.equal(problem, 0, 60)
    assert found
    for mutant in some:
        if mutant.number in found:
            assert not equivalence.equal(problems[mutant.module], mutant.number, 60), mutant.name


def test_what_nobody_reads_is_equal_in_the_core(sample: tuple[list[Mutant], Path]) -> None:
    """A core without trackers does not mind whether the path runs: its module alone does not show that."""
    mutants, library = sample
    modules = json.loads((SAMPLE.folder / "core.json").read_text())["modules"]
    name = next(name for name in modules if file_of(name) == "passo_channel_path")
    runs = modules[name]["netnames"]["path_runs"]["bits"]
    cells = modules[name]["cells"].items()
    cell = next(cell for cell, made in cells if made["connections"].get("Y") == runs)
    mutation = f"mutate -mode inv -module {name} -cell {cell} -port Y -portbit 0"
    unread = Mutant(SAMPLE.name, 1 + max(mutant.number for mutant in mutants), "", mutation, "")
    found = killed(library, [mutant.number for mutant in mutants])
    seen = next(mutant for mutant in mutants if mutant.number in found)
    module, core = (name, "module"), (TOP, "core")
    problems = equivalence.prepare(SAMPLE, {module: [unread], core: [unread, seen]})
    assert not equivalence.equal(problems["module"], unread.number, 60)
    assert equivalence.equal(problems["core"], unread.number, 60)
    assert not equivalence.equal(problems["core"], seen.number, 60)


def test_a_mutant_with_the_same_object_code_is_no_fault() -> None:
    """`0 * x + y` is `y`; `x + y` is not `x - y`."""
    text = (
        DECLARED + "int f(int x, int y) { return (passo_at(1) ? 0 * x : 0) + (passo_at(2) ? x - y : x + y); }"
    )
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "f.c"
        source.write_text(text)
        codes = [object_code(source, number) for number in range(3)]
    assert codes[0] == codes[1] != codes[2]


def test_the_names_of_mutants_are_those_of_their_functions(tmp_path: Path) -> None:
    """No two have one name, and none has a line in it."""
    mutants, _ = drawn_c(SEED, 2000, tmp_path, [FILE])
    names = [mutant.name for mutant in mutants]
    assert len(set(names)) == len(names) > 10
    assert all(name.split()[0] == FILE and name.split()[-1].isdigit() for name in names)


def test_a_change_costs_the_mutants_of_its_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a test reaches is measured again if it, or a source that it reaches, is another; what it has
    killed is then to be killed again."""
    mutants = [
        CMutant(n, f"{name}.c", 0, 1, "f", "operator", 0, "", f"{name}1") for n, name in enumerate("ab")
    ]
    asked: list[dict[str, Any]] = []

    class Answers(Worker):
        def __init__(self) -> None:
            self.root = tmp_path

        def ask(self, what: dict[str, Any]) -> dict[str, Any]:
            asked.append(what)
            if "record" in what:
                return {"seconds": {"t.py::x": 0.1}, "reached": {"t.py::x": [0]}, "failed": [], "slow": []}
            return {"mutant": what["mutant"], "test": "t.py::x", "says": ""}

    file = tmp_path / "t.py"
    file.write_text("")

    def known(changed: list[CMutant]) -> list[c_judge.Test]:
        return c_judge.record(Answers(), changed, [file], print, tmp_path / "kept")

    monkeypatch.setattr(fates, "BUILD", tmp_path)
    found = fates.Fates("c", "", again=False)
    c_judge.Judge(Answers(), known(mutants), mutants, found).play(mutants[0], 1)
    assert found.get(mutants[0].name).killed.startswith("t.py::x ") and len(asked) == 2
    other = [mutants[0], replace(mutants[1], source="b2")]  # which it does not reach
    assert c_judge.Judge(Answers(), known(other), other, found).again() == 0
    assert len(asked) == 2
    other = [replace(mutants[0], source="a2"), mutants[1]]
    assert c_judge.Judge(Answers(), known(other), other, found).again() == 1
    assert len(asked) == 4
    file.write_text("# another test")
    assert c_judge.Judge(Answers(), known(other), other, found).again() == 1
    assert len(asked) == 6


def test_what_killed_nearby_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a mutant: the test that killed in its function, then one of each file before the second; what has
    killed nothing so far is the last of its file."""
    monkeypatch.setattr(fates, "BUILD", tmp_path)
    found = fates.Fates("c", "", again=False)
    mutants = [CMutant(n, "a.c", n, 1, f"f{n % 2}", "operator", n, "", "a") for n in range(4)]
    names = frozenset(mutant.name for mutant in mutants)
    known = [c_judge.Test(name, "", 0.1, names) for name in ("x::1", "x::2", "x::3", "y::1", "z::1")]
    cases = [test.case(mutants[0]) for test in known]
    found.of[mutants[1].name] = fates.Fate(killed=cases[2], tried=[cases[0], cases[2]])
    kills = c_judge.Kills(mutants, found)
    first, *others = (test.name for test in kills.chosen(mutants[3], known, 10.0))
    assert first == "x::3" and others == ["y::1", "z::1", "x::2", "x::1"]
    assert len(kills.chosen(mutants[3], known, 0.25)) == 2


def test_the_tests_kill_mutants_in_c(tmp_path: Path) -> None:
    """Those of the angles of an arc; the sources as they are live."""
    mutants, _ = drawn_c(SEED, 400, tmp_path, [FILE])
    worker = Worker(tmp_path)
    try:
        reached = tmp_path / "reached"
        reached.write_bytes(bytes(len(mutants) + 1))
        tests = ["tests/test_gcode_arcs.py"]
        seen = worker.ask({"record": str(reached), "tests": tests, "longest": 60.0})
        assert seen["failed"] == []
        numbers = {number for test in seen["reached"].values() for number in test}
        assert numbers & {mutant.number for mutant in mutants}
        some = [mutant.number for mutant in mutants if mutant.number in numbers][:4]
        answers = [worker.ask({"mutant": n, "tests": tests, "seconds": 20})["test"] for n in [0, *some]]
    finally:
        worker.end()
    print(answers)
    assert answers[0] == ""
    assert any(answers[1:])


def test_the_page_keeps_what_was_not_played(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows and survivors stay until as many mutants have been played again."""
    kept, quoted = tmp_path / "mutants.md", tmp_path / "modules.md"
    kept.write_text(f"# Figures\n\n{page.BEGIN}{page.END}")
    monkeypatch.setattr(page, "PAGE", kept)
    monkeypatch.setattr(page.modules_page, "MUTANTS", kept)
    monkeypatch.setattr(page.modules_page, "PAGE", quoted)
    played = page.Score(
        "passo_axis", 4, {"pins": 2, "proofs": 1}, living=[("passo_axis: inv, a.v:1", "dull")]
    )
    other = page.Score("passo_crc", 2, {"frames": 1}, equal=1)
    of_c = page.Score("passo_math.c", 3, {"tests": 2}, living=[("passo_math.c a < b | c", "no property")])
    page.write([played, other], [of_c], 1)
    before = kept.read_text()
    assert "| `passo_axis` | 4 | 2 | 0 | 0 | 0 | 1 | 0 | 0 | 1 | 75% |" in before
    assert "killed in the RTL: 4 of 5 (80.0%; 1 more are equivalent); in the C sources:\n2 of 3" in before
    page.write([page.Score("passo_axis", 4, waiting=4), other], [], 1)
    assert kept.read_text() == before
    page.write([page.Score("passo_axis", 4, {"pins": 4}), other], [], 1)
    after = kept.read_text()
    assert (
        "| `passo_axis` | 4 | 4 | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 100% |" in after
        and "passo_axis: inv" not in after
    )
    assert "* passo_math.c a &lt; b \\| c" in after
    axis = next(line for line in quoted.read_text().splitlines() if line.startswith("| `passo_axis`"))
    assert axis.endswith(" 100% |")
