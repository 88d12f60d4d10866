# SPDX-License-Identifier: MIT
"""The quick proofs hold, and the promises of some of them, which PASSO_SEED chooses, can fail.

``make verify ONLY=formal`` does both with all proofs; docs/reference/promises.md lists them.
"""

import re
from dataclasses import replace
from random import Random

import pytest
from passo.random_cases import seed

from verify import page as verification
from verify.faults import CELLS
from verify.formal import page, run

PROOFS = run.proofs()
QUICK = [proof for proof in PROOFS if not proof.slow]
FAULTY = Random(f"formal {seed()}").sample([proof for proof in QUICK if proof.faults == CELLS], 6)

SOURCES = sorted((*run.HERE.glob("*.vh"), *run.HERE.glob("*_proof.v")))


def labels(proof: run.Proof) -> set[str]:
    """The labels of all assertions in the files that the proof reads."""
    found = set()
    for name in re.findall(r"^verify/formal/(\S+\.vh?)$", "\n".join(proof.sources), re.M):
        text = (run.HERE / name).read_text(encoding="utf-8")
        found |= set(re.findall(r"(\w+) :\s+assert\b", text))
    return found


def assumed() -> dict[str, str]:
    """The guarantee of each assumption, from docs/reference/promises.md."""
    text = (run.paths.reference / "promises.md").read_text(encoding="utf-8")
    text = text[text.index("## What is assumed") :]
    rows = re.findall(r"^\| (`.+?`) \| .+ \| (.+) \|$", text, re.M)
    return {name: by for names, by in rows for name in re.findall(r"`(\w+)`", names)}


@pytest.mark.sample(6)
@pytest.mark.parametrize("proof", QUICK, ids=lambda proof: proof.name)
def test_promises_hold(proof):
    result = run.prove(proof)
    assert result.good, result.says


@pytest.mark.parametrize("proof", FAULTY, ids=lambda proof: proof.name)
def test_promises_can_fail(proof):
    result = run.fail(proof)
    assert result.good, result.says


def test_a_promise_that_cannot_fail_is_seen():
    proof = next(proof for proof in PROOFS if proof.name == "memory_direct")
    empty = run.Promise("empty", "", ("no_such_assertion",))
    result = run.fail(replace(proof, promises=(*proof.promises, empty)))
    assert not result.good
    assert result.says == "1 of 2 promises broken; kept: empty"


def test_every_assertion_belongs_to_a_promise():
    for source in SOURCES:
        readers = [proof for proof in PROOFS if source.name in "\n".join(proof.sources)]
        stated = {label for proof in readers for promise in proof.promises for label in promise.asserts}
        there = set().union(*(labels(proof) for proof in readers))
        assert there == stated, source.name


def test_the_pages_are_generated():
    assert (run.paths.reference / "promises.md").read_text(encoding="utf-8") == page.page()
    assert verification.PAGE.read_text(encoding="utf-8") == verification.page()


def test_every_assumption_has_a_name_in_the_table():
    there = set()
    for source in SOURCES:
        code = re.sub(r"//.*", "", source.read_text(encoding="utf-8"))
        named = re.findall(r"(\w+) :\s+assume\b", code)
        assert len(named) == len(re.findall(r"\bassume\b", code)), (
            f"{source.name}: an assumption without a name"
        )
        there |= set(named)
    assert there == set(assumed())


def test_every_assumption_is_guaranteed_by_something_that_exists():
    """By a promised assertion or by a file; or it is said that it only names something or cuts a size."""
    stated = {label for proof in PROOFS for promise in proof.promises for label in promise.asserts}
    for name, by in assumed().items():
        given = re.findall(r"`(.+?)`", by)
        assert given or by in ("names", "cut, see above"), f"{name}: {by}"
        for it in given:
            exists = (
                it in stated
                or it in {proof.name for proof in PROOFS}
                or ("/" in it and (run.paths.root / it).is_file())
            )
            assert exists, f"{name}: {it}"
