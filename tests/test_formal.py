# SPDX-License-Identifier: MIT
"""The quick proofs hold, and some of them, which PASSO_SEED chooses, catch a planted bug.

``make verify ONLY=formal`` runs all proofs with all bugs; docs/reference/promises.md lists them.
"""

import re
from random import Random

import pytest
from passo.random_cases import seed

from verify import page as verification
from verify.formal import page, run

PROOFS = run.proofs()
QUICK = [proof for proof in PROOFS if not proof.slow]
BUGS = Random(f"formal {seed()}").sample(
    [(proof, promise) for proof in QUICK for promise in proof.promises if not promise.slow], 10
)

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


@pytest.mark.parametrize("proof", QUICK, ids=lambda proof: proof.name)
def test_promises_hold(proof):
    result = run.prove(proof)
    assert result.good, result.says


@pytest.mark.parametrize(("proof", "promise"), BUGS, ids=[f"{a.name}-{b.name}" for a, b in BUGS])
def test_planted_bug_is_caught(proof, promise):
    result = run.catch(proof, promise)
    assert result.good, result.says


@pytest.mark.parametrize(
    ("proof", "promise"),
    [(proof, promise) for proof in PROOFS for promise in proof.promises],
    ids=[f"{proof.name}-{promise.name}" for proof in PROOFS for promise in proof.promises],
)
def test_every_bug_can_be_planted(proof, promise, tmp_path):
    file = tmp_path / promise.file
    file.parent.mkdir(parents=True)
    source = run.paths.root / promise.file
    file.write_bytes(source.read_bytes())
    run.plant(promise, tmp_path)
    assert file.read_text(encoding="utf-8") != source.read_text(encoding="utf-8")


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
    """Names of ``small_...`` shorten only the search for planted bugs; HOLDS assumes what was proved."""
    there = set()
    for source in SOURCES:
        code = re.sub(r"//.*|`define.*", "", source.read_text(encoding="utf-8"))
        named = re.findall(r"(\w+) :\s+assume\b", code)
        assert len(named) == len(re.findall(r"\bassume\b", code)), (
            f"{source.name}: an assumption without a name"
        )
        there |= set(named)
    assert {name for name in there if not name.startswith("small_")} == set(assumed())


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
