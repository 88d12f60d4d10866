# SPDX-License-Identifier: MIT
"""The C side of a proof: a function of the model, evaluated on an unknown state."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from passo import compiler

from verify.equal.c_aggregates import filled, leaves
from verify.equal.c_evaluate import Evaluator
from verify.equal.c_program import Program
from verify.equal.c_types import BOOL, Type, Value
from verify.equal.coupling import Coupling

HERE = Path(__file__).resolve().parent
EXPRESSIONS = "equal_expressions"
CLOCK = "equal_clock"
RESET = "equal_reset"


def harness(coupling: Coupling, expressions: list[str], root: Path) -> str:
    """The C sources of a module, with the coupling's objects and expressions, preprocessed."""
    lines = [f'#include "{root}/{source}"' for source in coupling.sources]
    lines.append(coupling.types)
    lines += [f"{declaration};" for declaration in coupling.objects]
    lines.append(coupling.prelude)
    lines.append(f"static void {CLOCK}(void) {{ {coupling.clock} }}")
    lines.append(f"static void {RESET}(void) {{ {coupling.reset or ''} }}")
    lines.append(f"static void {EXPRESSIONS}(void) {{ {' '.join(f'{e};' for e in expressions)} }}")
    folders = (HERE / "headers", root / "c_model/core", root / "c_model/protocol")
    command = [compiler.CC, "-E", "-P", "-nostdinc", *compiler.includes(*folders), "-x", "c", "-"]
    return compiler.call(command, "\n".join(lines))


class Model:
    """The C side: the state before and after a clock, and expressions of both."""

    def __init__(self, coupling: Coupling, root: Path) -> None:
        links = [*coupling.inputs.values(), *coupling.outputs.values(), *coupling.registers.values()]
        self.expressions = [link.expression for link in links]
        self.expressions += [text for link in links for text in (link.when, link.bits) if text]
        self.expressions += [f"probe == ({link.probe})" for link in links if link.probe]
        self.expressions += [link.expression for link in coupling.invariants.values()]
        self.expressions += [assumption["that"] for assumption in coupling.assumptions.values()]
        self.expressions += [split["by"] for split in coupling.splits.values()]
        program = Program(harness(coupling, self.expressions, root))
        self.nodes = program.functions[EXPRESSIONS].body.block_items or []
        self.evaluator = Evaluator(program, coupling.opaque)
        self.objects = [re.findall(r"\w+", declaration)[-1] for declaration in coupling.objects]
        for name in self.objects:
            self.evaluator.make_unknown(name, coupling.arrays)
        for leaf, value in coupling.fixed.items():
            name, *members, last = leaf.split(".")
            bits = self.evaluator.cells[name].bits
            for member in members:
                bits = bits[member]
            bits[last] = value

    def values(self) -> dict[str, Value]:
        """The expressions of the coupling, with the state as it is now."""
        kept = self.evaluator.demands
        self.evaluator.demands = []
        found = {
            text: self.evaluator.value(node) for text, node in zip(self.expressions, self.nodes, strict=True)
        }
        self.evaluator.demands = kept
        return found

    def run(self, function: str) -> None:
        """Execute the clock or the reset."""
        self.evaluator.call(function, [])

    def set_all(self, values: Mapping[str, int]) -> None:
        """Give all leaves of the objects known values, by their names in C."""
        for name in self.objects:
            cell = self.evaluator.cells[name]
            cell.bits = filled(cell.type, name, lambda kind, leaf: typed(values[leaf], kind))

    def leaves(self) -> dict[str, tuple[Type, Any]]:
        """Types and bits of all leaves of the objects, by their names in C."""
        found: dict[str, tuple[Type, Any]] = {}
        for name in self.objects:
            cell = self.evaluator.cells[name]
            found |= {leaf: (kind, bits) for leaf, kind, bits in leaves(cell.type, cell.bits, name)}
        return found


def typed(value: int, kind: Type) -> int | bool:
    """A number as bits of a type."""
    return value != 0 if kind == BOOL else value
