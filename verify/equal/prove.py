# SPDX-License-Identifier: MIT
"""Proves that a module of the model and one of the RTL are equal.

Before a clock the registers of the RTL are what the coupling says of the state of the model, and so are its
inputs. Then the C function and the transition relation of the RTL each make one clock. Proved is that the
outputs are equal, that the coupling holds again, and that nothing in the C is undefined; for a reset, that
the coupling holds after it, whatever was before, except for what a reset keeps. So both agree from then on.
"""

import re
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import z3
from passo.failure import Failure

from verify.equal.c_types import (
    Condition,
    Integer,
    Value,
    convert,
    truth,
)
from verify.equal.coupling import Coupling, Link, completed
from verify.equal.model import CLOCK, RESET, Model
from verify.equal.rtl import Rtl, read_rtl

HERE = Path(__file__).resolve().parent
TIME_LIMIT = 600  # seconds for one query
PART = re.compile(r"(.*)\[(\d+):(\d+)\]")


@dataclass(frozen=True)
class Goal:
    """Something to prove; if there are cases, which are all, in one after the other."""

    name: str
    formula: Any
    cases: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Outcome:
    """What was found: the goals that fail with the values that show it."""

    failed: tuple[str, ...]
    counterexample: str
    goals: int
    bits: int  # of registers that are coupled
    seconds: float


def _same(term: z3.ExprRef, value: Value, signed: bool) -> Condition:
    """Whether a register or port of the RTL has the value of a C expression."""
    own = value.bits
    if z3.is_bool(term):
        if isinstance(own, bool | z3.BoolRef):
            return term == own
        term = z3.If(term, z3.BitVecVal(1, 1), z3.BitVecVal(0, 1))
    more = 64 - term.size()
    return (z3.SignExt(more, term) if signed else z3.ZeroExt(more, term)) == _number(value)


def _number(value: Value) -> z3.BitVecRef:
    """The value of a C expression in 64 bits."""
    c_signed = isinstance(value.type, Integer) and value.type.signed
    number = convert(value, Integer(64, c_signed)).bits
    return z3.BitVecVal(number, 64) if isinstance(number, int) else number


def _same_bits(term: z3.BitVecRef, value: Value, bits: Value) -> Condition:
    """The same, of the bits that are 1 in another expression; without any nothing is said."""
    mask = _number(bits)
    own = z3.ZeroExt(64 - term.size(), term)
    return z3.Implies(mask != 0, own & mask == _number(value) & mask)


def _named(entry: str) -> tuple[str, int, int]:
    """The register or port of an entry, and its bits if it is of a part only: ``name[high:low]``; else -1."""
    part = PART.match(entry)
    return (part[1], int(part[2]), int(part[3])) if part else (entry, -1, -1)


def _term(entry: str, terms: dict[str, z3.ExprRef]) -> z3.ExprRef:
    name, high, low = _named(entry)
    return terms[name] if high < 0 else z3.Extract(high, low, terms[name])


def _coupled(
    links: dict[str, Link], terms: dict[str, z3.ExprRef], values: dict[str, Value]
) -> dict[str, Condition]:
    found: dict[str, Condition] = {}
    for name, link in links.items():
        term, value = _term(name, terms), values[link.expression]
        equal = _same_bits(term, value, values[link.bits]) if link.bits else _same(term, value, link.signed)
        found[name] = equal if link.when is None else z3.Implies(truth(values[link.when]), equal)
    return found


def _completed(coupling: Coupling, rtl: Rtl, root: Path) -> Coupling:
    """The coupling with what has the same name on both sides."""
    names = {"inputs": rtl.inputs, "outputs": rtl.outputs, "registers": rtl.registers}
    return completed(coupling, names, Model(coupling, root).leaves())


def _check_names(coupling: Coupling, rtl: Rtl) -> None:
    """Every register and port of the RTL is in the coupling, and nothing else is.

    Raises:
        Failure: Something is missing or unknown.
    """
    for what, own, listed in (
        ("input", rtl.inputs, coupling.inputs),
        ("output", rtl.outputs, coupling.outputs),
        ("register", rtl.registers, coupling.registers),
    ):
        bits: dict[str, int] = {}
        for entry in listed:
            name, high, low = _named(entry)
            if name not in own:
                raise Failure(f"{coupling.name}: {coupling.top} has no {what} {name}")
            bits[name] = bits.get(name, 0) + (own[name] if high < 0 else high - low + 1)
        for name in own:
            if bits.get(name, own[name]) != own[name]:
                raise Failure(f"{coupling.name}: the parts of the {what} {name} do not cover it")
            if name not in bits and name not in coupling.free and name not in ("clk", "rst"):
                raise Failure(f"{coupling.name}: no coupling entry for the {what} {name}")


def _example(assumed: list[Any], goals: list[Goal]) -> z3.ModelRef | None:
    """Values with which one of the goals fails."""
    solver = z3.Solver()  # a second question to the same one would be answered without preprocessing
    solver.set("timeout", TIME_LIMIT * 1000)
    solver.add(*assumed)
    solver.add(z3.Not(z3.And([goal.formula for goal in goals])))
    answer = solver.check()
    if answer == z3.unknown:
        raise Failure(f"no answer within {TIME_LIMIT} s: {goals[0].name}")
    return solver.model() if answer == z3.sat else None


def _search(assumed: list[Any], goals: list[Goal], apart: bool) -> tuple[tuple[str, ...], str]:
    """The goals that fail, and values with which the first ones do; all together, or one after the other."""
    solver = z3.Solver()
    solver.set("timeout", TIME_LIMIT * 1000)
    solver.add(*assumed)
    if solver.check() != z3.sat:
        raise Failure("contradictory assumptions: no state satisfies them")
    together = [goal for goal in goals if not goal.cases]
    questions = [([], [goal]) for goal in together] if apart else [([], together)]
    questions += [([case], [goal]) for goal in goals for case in goal.cases]
    for case, asked in questions:
        example = _example([*assumed, *case], asked)
        if example is None:
            continue
        failed = tuple(goal.name for goal in asked if z3.is_false(example.eval(z3.And(goal.formula), True)))
        values = sorted((str(of), example[of]) for of in example if of.arity() == 0 and "#" not in str(of))
        return failed, "\n".join(f"  {name} = {value}" for name, value in values)
    return (), ""


def _clock_goals(coupling: Coupling, rtl: Rtl, root: Path) -> tuple[list[Any], list[Goal]]:
    model = Model(coupling, root)
    before = model.values()
    model.run(CLOCK)
    after = model.values()
    assumed = [*rtl.relation]
    assumed += _coupled(coupling.inputs, rtl.before, before).values()
    assumed += _coupled(coupling.registers, rtl.before, before).values()
    assumed += [truth(before[link.expression]) for link in coupling.invariants.values()]
    assumed += [truth(before[entry["that"]]) for entry in coupling.assumptions.values()]
    if "rst" in rtl.inputs and "rst" not in coupling.inputs:
        assumed.append(z3.Not(rtl.before["rst"]))
    if coupling.asynchronous:
        assumed += _coupled(coupling.inputs, rtl.after, after).values()
    outputs = _coupled(coupling.outputs, rtl.before, before)
    registers = _coupled(coupling.registers, rtl.after, after)
    for name, link in coupling.registers.items():
        # said of it for any probe, so it is proved for the one that matters
        if link.probe:
            registers[name] = z3.Implies(truth(before[f"probe == ({link.probe})"]), registers[name])
    goals = [Goal(f"output {name}", formula) for name, formula in outputs.items()]
    goals += [Goal(f"register {name}", formula) for name, formula in registers.items()]
    for name, link in coupling.invariants.items():
        goals.append(Goal(f"invariant {name}", truth(after[link.expression])))
    goals += [Goal(f"defined: {what}", condition) for what, condition in model.evaluator.demands]
    return assumed, [_split(goal, coupling, before) for goal in goals]


def _split(goal: Goal, coupling: Coupling, before: dict[str, Value]) -> Goal:
    """The goal with its cases: each value, and the rest."""
    split = coupling.splits.get(goal.name)
    if split is None:
        return goal
    bits = before[split["by"]].bits
    values = range(split["values"])
    return replace(goal, cases=(*(bits == value for value in values), z3.UGE(bits, len(values))))


def _reset_goals(coupling: Coupling, rtl: Rtl, root: Path) -> tuple[list[Any], list[Goal]]:
    model = Model(coupling, root)
    before = model.values()
    model.run(RESET)
    after = model.values()
    kept = {name: link for name, link in coupling.registers.items() if link.kept}
    assumed = [*rtl.relation, rtl.before["rst"]]
    assumed += _coupled(coupling.inputs, rtl.before, before).values()
    assumed += _coupled(kept, rtl.before, before).values()
    assumed += [truth(before[link.expression]) for link in coupling.invariants.values() if link.kept]
    assumed += [truth(before[entry["that"]]) for entry in coupling.assumptions.values()]
    if coupling.asynchronous:
        assumed += _coupled(coupling.inputs, rtl.after, after).values()
    registers = _coupled(coupling.registers, rtl.after, after)
    goals = [Goal(f"after a reset: register {name}", formula) for name, formula in registers.items()]
    for name, link in coupling.invariants.items():
        goals.append(Goal(f"after a reset: invariant {name}", truth(after[link.expression])))
    return assumed, goals


def _questions(coupling: Coupling, rtl: Rtl, root: Path) -> list[tuple[list[Any], list[Goal]]]:
    """For a clock, and for a reset if there is one: what is assumed, and what is to be proved."""
    makers = (_clock_goals, _reset_goals) if coupling.reset is not None else (_clock_goals,)
    return [goals_of(coupling, rtl, root) for goals_of in makers]


def prove(coupling: Coupling, root: Path) -> Outcome:
    """Prove a module equal, with the sources below root.

    Raises:
        Failure: The coupling does not fit the RTL, its assumptions contradict each other, or no answer comes.
    """
    begin = time.monotonic()
    rtl = read_rtl(coupling, root / "rtl")
    coupling = _completed(coupling, rtl, root)
    _check_names(coupling, rtl)
    bits = sum(rtl.registers[name] for name in {_named(entry)[0] for entry in coupling.registers})
    questions = _questions(coupling, rtl, root)
    count = sum(len(goals) for _, goals in questions)
    for assumed, goals in questions:
        failed, example = _search(assumed, goals, coupling.apart)
        if failed:
            return Outcome(failed, example, count, bits, time.monotonic() - begin)
    if never := _never_said(*questions[0]):
        raise Failure(f"their conditions never hold: {', '.join(never)}")
    return Outcome((), "", count, bits, time.monotonic() - begin)


def _said(formula: Any) -> Any:
    """When the formula says something: the conditions before its equation."""
    conditions = []
    while z3.is_implies(formula):
        conditions.append(formula.arg(0))
        formula = formula.arg(1)
    return z3.And(conditions)


def _never_said(assumed: list[Any], goals: list[Goal]) -> list[str]:
    """The goals whose conditions contradict what is assumed, so that they would hold of any RTL."""
    solver = z3.Solver()
    solver.set("timeout", TIME_LIMIT * 1000)
    solver.add(*assumed)
    left = {goal.name: said for goal in goals if not z3.is_true(z3.simplify(said := _said(goal.formula)))}
    while left:
        solver.push()
        solver.add(z3.Or(list(left.values())))
        answer = solver.check()
        if answer == z3.unknown:
            raise Failure(f"no answer within {TIME_LIMIT} s: when {', '.join(left)}")
        if answer == z3.unsat:
            break
        model = solver.model()
        left = {name: said for name, said in left.items() if not z3.is_true(model.eval(said, True))}
        solver.pop()
    return list(left)


def fault_seen(coupling: Coupling, root: Path) -> list[str]:
    """For a clock and for a reset, the first goal that some fault in the RTL breaks.

    Args:
        coupling: Of the module.
        root: Has the sources, and takes lists of faults.

    Raises:
        Failure: No fault breaks anything.
    """
    rtl = read_rtl(coupling, root / "rtl", with_faults=True)
    coupling = _completed(coupling, rtl, root)
    seen = []
    for assumed, goals in _questions(coupling, rtl, root):
        example = _example(assumed, goals)
        if example is None:
            raise Failure("no fault in the RTL is seen")
        broken = (goal for goal in goals if z3.is_false(example.eval(z3.And(goal.formula), True)))
        seen.append(next(broken).name)
    return seen
