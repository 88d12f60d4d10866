# SPDX-License-Identifier: MIT
"""The quick proofs that model and RTL are equal, and that some of them can fail; ``make verify`` runs all.

The symbolic execution of the model is compared with the compiled model, on random states.
"""

import ctypes
import gc
import random
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import z3
from passo import compiler
from passo.failure import Failure
from passo.toolchain import paths

from tests.helpers.random_plans import SEED
from verify.equal import page, run
from verify.equal.c_types import BOOL, Integer
from verify.equal.coupling import Coupling, couplings
from verify.equal.model import CLOCK, Model, harness
from verify.equal.prove import prove

COUPLINGS = couplings()
QUICK = [coupling for coupling in COUPLINGS if not coupling.slow]
FAULTY = random.Random(f"equal {SEED}").sample(QUICK, 10)
LEAVES = 6_000  # that are made in all
DEFINED = 3  # random states that the C must define, at least
TRIES = 1_000
MASK = (1 << 64) - 1
VISIBLE = '__attribute__((visibility("default"))) void'
# A table: an assignment for each leaf would take ten times as long to compile.
LEAVES_OF_C = f"""
#define LEAF(x) {{&x, sizeof(x), (__typeof__(x))-1 < (__typeof__(x))0}}
static const struct leaf {{
\tvoid *at;
\tunsigned size;
\t_Bool has_sign;
}} leaves[] = {{
%s}};
enum {{ LEAVES = sizeof(leaves) / sizeof(leaves[0]) }};

{VISIBLE} coupling_load(const uint64_t *v)
{{
\tfor (unsigned i = 0; i < LEAVES; i++)
\t\t__builtin_memcpy(leaves[i].at, &v[i], leaves[i].size);
}}

{VISIBLE} coupling_store(uint64_t *v)
{{
\tfor (unsigned i = 0; i < LEAVES; i++) {{
\t\tint64_t value = 0;
\t\tconst unsigned unused = 64u - 8u * leaves[i].size;

\t\t__builtin_memcpy(&value, leaves[i].at, leaves[i].size);
\t\tv[i] = leaves[i].has_sign ? (uint64_t)((int64_t)((uint64_t)value << unused) >> unused) : (uint64_t)value;
\t}}
}}
"""


@pytest.fixture(autouse=True)
def one_thread_frees() -> Iterator[None]:
    """z3 is used by one thread only: a collection in a thread of pytest-xdist would be another."""
    gc.disable()
    yield
    gc.collect()
    gc.enable()


@pytest.mark.sample(4)
@pytest.mark.parametrize("coupling", QUICK, ids=lambda coupling: coupling.name)
def test_model_and_rtl_are_equal(coupling: Coupling) -> None:
    result = run.prove_module(coupling.name)
    assert result.good, result.says


@pytest.mark.sample(2)
@pytest.mark.parametrize("coupling", FAULTY, ids=lambda coupling: coupling.name)
def test_fault_is_seen(coupling: Coupling) -> None:
    result = run.see_fault(coupling.name)
    assert result.good, result.says


def test_a_condition_that_never_holds_is_seen() -> None:
    """Nothing would be said of the output then, whatever the RTL does with it."""
    coupling = next(coupling for coupling in COUPLINGS if coupling.name == "dda")
    name, link = next(iter(coupling.outputs.items()))
    empty = replace(coupling, outputs=coupling.outputs | {name: replace(link, when="0")})
    with pytest.raises(Failure, match=f"their conditions never hold: output {name}"):
        prove(empty, paths.root)


def test_page_has_every_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = page.PAGE.read_text(encoding="utf-8")
    listed = re.findall(r"^\| (\w+) \| `\w+` \|", text, re.M)
    assert listed == [coupling.name for coupling in COUPLINGS]
    copy = tmp_path / "page.md"
    copy.write_text(text, encoding="utf-8")
    monkeypatch.setattr(page, "PAGE", copy)
    proof = {"module": "dda", "what": "proof", "good": True, "goals": 7, "bits": 9, "seconds": 1.6}
    fault = {"module": "dda", "what": "faults", "good": True}
    report = {"results": [proof, fault], "proved_bits": 9, "bits": 18, "seconds": 60}
    page.write([coupling for coupling in COUPLINGS if coupling.name == "dda"], report)
    written = copy.read_text(encoding="utf-8")
    assert re.search(r"^\| dda \| `passo_dda` \| .* \| 7 \| 9 \| 2 \|$", written, re.M)
    assert "9 of the 18 bits (50 %)" in written and "| axis |" not in written


def test_bank_of_the_tables_is_as_in_the_protocol() -> None:
    """The coupling has a function of its own in the place of a loop that ends early."""
    coupling = next(coupling for coupling in COUPLINGS if coupling.name == "tables")
    own = re.search(r"^unsigned passo_bank_at\(.*?^}$", coupling.prelude, re.M | re.S)
    assert own
    lines = [
        '#include "passo_shapes.c"',
        own[0].replace("passo_bank_at", "bank_of_coupling"),
        "int differences(void) { int n = 0; for (uint32_t at = 0; at < 1u << 16; at++)",
        "n += passo_bank_at(at) != bank_of_coupling(at); return n; }",
    ]
    source = run.BUILD / "bank_at.c"
    run.BUILD.mkdir(parents=True, exist_ok=True)
    source.write_text("\n".join(lines))
    flags = (*compiler.includes(paths.protocol), *compiler.SHARED)
    made = compiler.compile_to(run.BUILD / "bank_at.so", *flags, source)
    assert ctypes.CDLL(str(made)).differences() == 0


def proved(rule: Any) -> bool:
    """Whether a rule holds for all integers."""
    solver = z3.Solver()
    solver.add(z3.Not(rule))
    return solver.check() == z3.unsat


def test_rules_of_long_multiplication_and_division() -> None:
    """Which couplings with unknown products and quotients assume: for all integers."""
    a, b, bit, place, least = z3.Ints("a b bit place least")
    assert proved(z3.And(a * 0 == 0, a * (b + bit * place) == a * b + bit * a * place))
    n, by, q, r, q2, r2 = z3.Ints("n by q r q2 r2")

    def divided(n: Any, q: Any, r: Any) -> Any:
        return z3.And(n == q * by + r, r >= 0, r < by)

    assert proved(z3.Implies(z3.And(divided(n, q, r), divided(n, q2, r2)), z3.And(q == q2, r == r2)))
    assert proved(z3.Implies(z3.And(n >= 0, n < by), divided(n, 0, n)))
    assert proved(z3.Implies(divided(n, q, r), (q >= least) == (n >= least * by)))
    fits = z3.If(2 * r + bit >= by, 1, 0)
    next_one = divided(2 * n + bit, 2 * q + fits, 2 * r + bit - fits * by)
    is_bit = z3.Or(bit == 0, bit == 1)
    assert proved(z3.Implies(z3.And(is_bit, divided(n, q, r)), next_one))
    assert not proved(z3.Implies(divided(n, q, r), next_one))


def compiled(coupling: Coupling, names: list[str]) -> ctypes.CDLL:
    """The harness of a coupling as a library, with functions that load and store all leaves."""
    leaves = "".join(f"\tLEAF({name}),\n" for name in names)
    text = f"{harness(coupling, [], paths.root)}\n{LEAVES_OF_C % leaves}"
    text += f"{VISIBLE} coupling_clock(void) {{ {CLOCK}(); }}\n"
    source = run.BUILD / f"{coupling.name}.c"
    source.parent.mkdir(parents=True, exist_ok=True)
    source.write_text(text, encoding="utf-8")
    # only what the clock calls: other functions of the sources may need more of the model
    needed = ("-fvisibility=hidden", "-ffunction-sections", "-Wl,--gc-sections", *compiler.SHARED)
    made = compiler.compile_to(run.BUILD / f"{coupling.name}.so", "-w", "-O0", *needed, source)
    return ctypes.CDLL(str(made))


@pytest.mark.parametrize("coupling", COUPLINGS, ids=lambda coupling: coupling.name)
def test_symbolic_execution_agrees_with_the_compiler(coupling: Coupling) -> None:
    """Whatever the state, unless the C leaves it undefined."""
    rng = random.Random(f"{SEED} {coupling.name}")
    model = Model(coupling, paths.root)
    kinds = {name: kind for name, (kind, _) in model.leaves().items()}
    library = compiled(coupling, list(kinds))
    words = ctypes.c_uint64 * len(kinds)
    defined = 0
    states = max(LEAVES // len(kinds), DEFINED)
    for tried in range(TRIES):
        if tried >= states and defined >= DEFINED:
            break
        values = {name: drawn(rng, kind) for name, kind in kinds.items()} | coupling.fixed
        library.coupling_load(words(*(value & MASK for value in values.values())))
        model.evaluator.demands.clear()
        model.set_all(values)
        model.run(CLOCK)
        if any(condition is False for _, condition in model.evaluator.demands):
            continue
        library.coupling_clock()
        made = words()
        library.coupling_store(made)
        evaluated = {name: int(bits) & MASK for name, (_, bits) in model.leaves().items()}
        assert evaluated == dict(zip(kinds, made, strict=True))
        defined += 1
    assert defined >= max(states // 20, DEFINED)


def drawn(rng: random.Random, kind: Any) -> int:
    """A value of a type: small, large, or any."""
    if kind == BOOL:
        return rng.randint(0, 1)
    assert isinstance(kind, Integer)
    low = -(1 << (kind.width - 1)) if kind.signed else 0
    high = low + (1 << kind.width) - 1
    return rng.choice(
        (rng.randint(0, 7), rng.randint(0, 255) if kind.width > 8 else 1, rng.randint(low, high))
    )
