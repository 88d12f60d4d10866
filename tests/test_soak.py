# SPDX-License-Identifier: MIT
"""A short form of `make verify ONLY=soak`, which plays thousands of histories and plants all defects."""

import shutil
import subprocess
from collections import Counter
from pathlib import Path

import pytest
from passo import random_cases
from passo.build import rtl_library
from passo.compiler import SANITIZED, call, includes, sources
from passo.planted import plant
from passo.toolchain import paths

from tests.helpers import sanitized
from verify.mutants import trackers_due, trackers_host
from verify.soak import defects, numbers, page, parts, trackers
from verify.soak import program as soak_program
from verify.soak.defects import Defect
from verify.soak.parts import Part
from verify.soak.program import FLAGS, FOLDERS, Failure, build, play_kept, play_program
from verify.soak.report import JUDGED, MACHINE_JUDGED

SEED = random_cases.seed()
JOBS = 1  # pytest uses the other cores

DEFECTS = {defect.name: defect for defect in defects.defects()}


@pytest.fixture(scope="module")
def program() -> Path:
    """The program that plays histories."""
    return build()


def check(part: parts.Part, histories: int) -> None:
    """All of them were played, and no promise was broken."""
    assert part.counts["histories"] == histories
    assert not part.failures, [f"{failure.again}: {failure.text}" for failure in part.failures]


def test_no_promise_is_broken_in_the_model(program: Path) -> None:
    """Histories at register level; the judge has checked something of every kind."""
    part = parts.play_model(program, SEED, 200, JOBS)
    check(part, 200)
    assert all(part.counts[kind] for kind in JUDGED)
    assert part.counts["hit"] > 0.8 * part.counts["aimed"] > 0


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("kind", "histories"), [("machine", 100), ("tries", 20), ("starts", 15), ("pokes", 5)]
)
def test_no_promise_is_broken_with_a_machine(program: Path, kind: str, histories: int) -> None:
    """Events of all kinds, drives into active switches, register fuzzing."""
    part = parts.play_model(program, SEED, histories, JOBS, kind)
    check(part, histories)
    if kind == "machine":
        assert all(part.counts[judged] for judged in set(MACHINE_JUDGED) - {"tries"})
        assert part.counts["hit"] > 0.8 * part.counts["aimed"] > 0
    if kind == "tries":
        assert part.counts["tries"] > 50 * histories


def test_no_promise_is_broken_with_trackers() -> None:
    """Both hands, on the model and on the Verilated core beside it."""
    check(parts.play_trackers(SEED, 24, JOBS), 24)
    assert trackers.play(parts.TRACKER_SETS[0], SEED, 0, paths.rtl, shows=False)["steps"] > 0


def test_a_step_of_a_tracker_that_is_not_made_goes_red(monkeypatch: pytest.MonkeyPatch) -> None:
    """As is one that comes in another tick: the judge has another recurrence then."""
    monkeypatch.setattr(trackers_host, "nearest", lambda position: (position + 1) // trackers_due.STEP)
    with pytest.raises(AssertionError, match="step"):
        trackers.play(parts.TRACKER_SETS[0], SEED, 0, None, shows=False)


@pytest.mark.sample(1)
def test_no_promise_is_broken_through_the_driver(program: Path) -> None:
    """On wires with errors of all kinds."""
    part = parts.play_driver(program, SEED, 60, JOBS)
    check(part, 60)
    for kind in ("flips", "lost clocks", "doubled clocks", "cuts", "deaths", "retries", "lines", "stops"):
        assert part.counts[kind] > 0, kind


def test_the_soak_itself_is_sound(tmp_path: Path) -> None:
    """Under the sanitizers of addresses and undefined behavior."""
    folders = (paths.driver, paths.planner, paths.protocol, paths.core)
    made = tmp_path / "soak"
    flags = [
        "-std=gnu11",
        *SANITIZED,
        *includes(*folders, FOLDERS["verify/soak"], paths.engine),
    ]  # warnings: build()
    files = [*sources(FOLDERS["verify/soak"]), *map(sanitized.object_of, folders)]
    call(["cc", *flags, *files, "-ldl", "-o", made])
    for kind in ([], ["--machine"], ["--driver"]):
        counts, failures = play_program([made, str(SEED), "0", "6", *kind], "model", SEED)
        assert counts["histories"] == 6 and not failures


@pytest.mark.sample(1)
def test_no_promise_is_broken_in_verilator(program: Path) -> None:
    """The core does the same as the model on every clock of a history."""
    check(parts.play_verilator(program, SEED, 30, JOBS), 30)
    library = rtl_library(parts.SETS[parts.DRIVER_SET])
    check(parts.play_driver(program, SEED, 4, JOBS, library), 4)


def test_no_promise_is_broken_in_icarus(program: Path) -> None:
    """The same in another simulator."""
    check(parts.play_icarus(program, SEED, 4, JOBS), 4)
    check(parts.play_icarus(program, SEED, 1, JOBS, machine=True), 1)


def test_power_keeps_its_energy_and_raster_its_substep() -> None:
    """From 5 % to 100 % of the speed, through holds."""
    laser, raster = numbers.laser(), numbers.raster(SEED)
    print(laser, raster)
    assert laser["ok"] and raster["ok"]


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "name",
    [
        *("abort leaves steps", "a lost stop counts as sent", "power after a stop"),
        *("limit closes at rest only", "cancel steeper than the jog"),
    ],
)
def test_a_defect_goes_red(name: str) -> None:
    """One at register level, one of the driver, one of a machine; `make verify` plants all."""
    caught = defects.catch(DEFECTS[name], 1)
    assert caught.good, caught.says


@pytest.mark.parametrize("defect", DEFECTS.values(), ids=DEFECTS)
def test_every_defect_can_be_put_back(defect: Defect, tmp_path: Path) -> None:
    """The sources still contain the text that it replaces, and what comes in its place compiles."""
    edited = {tmp_path / file: paths.root / file for file, _, _ in defect.edits}
    for copy, source in edited.items():
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)
    for file, old, new in defect.edits:
        plant(tmp_path / file, old, new)
    for copy, source in edited.items():
        folders = [copy.parent, source.parent, *FOLDERS.values()]
        command = ["cc", *FLAGS, "-fsyntax-only", *includes(*folders), copy]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr


def test_a_core_that_differs_from_the_model_goes_red(program: Path, tmp_path: Path, monkeypatch) -> None:
    """A defect of the RTL alone."""
    rtl = tmp_path / "rtl"
    shutil.copytree(paths.rtl, rtl)
    plant(rtl / "passo_axis.v", "restart ? 16'd1 : 16'd2;", "16'd1;")
    monkeypatch.setattr(paths, "rtl", rtl)
    assert parts.play_icarus(program, 1, 3, JOBS).failures


def test_a_run_continues_where_the_last_one_ended(program: Path, tmp_path: Path, monkeypatch) -> None:
    """What did not fail is not played again, by the same program alone."""
    monkeypatch.setattr(soak_program, "BUILD", tmp_path)
    command = [program, str(SEED), "0", "3"]
    first = play_kept(command, "model", SEED)
    monkeypatch.setattr(soak_program, "play_program", None)
    assert play_kept(command, "model", SEED) == first and first[0]["histories"] == 3
    with pytest.raises(TypeError):
        play_kept([program, str(SEED), "0", "4"], "model", SEED)


def test_the_page_has_what_was_played_in_full(tmp_path: Path, monkeypatch) -> None:
    """A part that failed, or with too few histories, leaves its section as it is."""
    kept = tmp_path / "soak.md"
    monkeypatch.setattr(page, "PAGE", kept)
    form = page.mark("core", "") + page.mark("driver", "old\n")
    kept.write_text(form)
    both = [
        Part("endings", 1, Counter({"histories": 7, "jog:stop": 7})),
        Part("sessions", 1, Counter({"histories": 3, "jog:death": 3})),
    ]
    wanted = {"endings": 7, "sessions": 3}
    assert page.write({**wanted, "sessions": 4}, both, [], {}) == []
    failed = Part("sessions", 1, both[1].counts, [Failure("sessions", 1, 2, 3, "lost")])
    assert page.write(wanted, [both[0], failed], [], {}) == []
    assert kept.read_text() == form
    assert page.write(wanted, both, [], {}) == ["driver"]
    assert "| jog | 7 | 3 |" in kept.read_text()
