# SPDX-License-Identifier: MIT
"""The whole core through its SPI pins, compared with the C model on every clock.

They share helpers/core_bench.py; PASSO_SEED is the seed of the random tests.
"""

import pytest

from cocotb_tests.helpers.runner import CORE_TOP as TOP
from cocotb_tests.helpers.runner import (
    MOST_AXES,
    ONE_CHANNEL,
    TWO_CHANNELS,
    WITH_ALL,
    WITH_ENCODERS,
    WITH_INPUTS,
    WITH_OUTPUTS,
    WITH_PINS,
    WITH_TRACKED,
    WITH_TRACKERS,
    run,
    skip_icarus,
)

MOST_CHANNELS = {"CHANNELS": 8, "AXES": 1, "TICK_LOG2": 7, "LINE_QUEUE_LOG2": 8, "RAMP_QUEUE_LOG2": 8}
MOST_CHANNELS |= WITH_PINS

# Icarus Verilog is up to ten times slower: long tests run only on Verilator, Icarus gets few random moves of
# one channel; `make icarus` runs all, `make verify` a thousand more histories.
verilator_only = pytest.mark.parametrize("simulator", ["verilator"])

MODULES = {
    "core_motion": ONE_CHANNEL,  # every step on its clock, from the first clock of a motion to the last
    "core_pins": ONE_CHANNEL,  # timings, polarities, the fastest steps
    "core_commands": ONE_CHANNEL,  # jog, sync, hold, override, stop, abort
    "core_faults": ONE_CHANNEL,  # underruns and overruns
    "core_link": ONE_CHANNEL,  # duplicates, frames cut short, noise, reads, tables
    "core_refusals": TWO_CHANNELS,  # every reason to refuse a frame
    "core_channels": TWO_CHANNELS,  # both channels simultaneously
    "core_registers": ONE_CHANNEL,  # settings and states in all their bits
    "core_inputs": WITH_INPUTS,  # limits, alarms, trigger, e-stop, watchdog
    "core_encoders": WITH_ENCODERS,  # following error, threading
    "core_outputs": WITH_OUTPUTS,  # outputs bound to the path
    "core_trackers": WITH_TRACKERS,  # a second hand on every axis
    "core_tracked": WITH_TRACKED,  # axes without lines
    "core_machine": WITH_ALL,  # what they do to each other
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("module", MODULES)
def test_core(simulator: str, module: str) -> None:
    skip_icarus(simulator)
    run(f"cocotb_tests.{module}", TOP, MODULES[module], simulator)


@verilator_only
def test_long(simulator: str) -> None:
    """The longest pin timings, a counter that wraps."""
    run("cocotb_tests.core_long", TOP, ONE_CHANNEL, simulator)


@verilator_only
@pytest.mark.parametrize("module", ["core_channels", "core_most_channels"])
def test_most_channels(simulator: str, module: str) -> None:
    """As many channels and as deep queues as a core can have, and all pins."""
    run(f"cocotb_tests.{module}", TOP, MOST_CHANNELS, simulator)


@verilator_only
def test_most_axes(simulator: str) -> None:
    """All settings, and all pins of as many axes as a channel can have."""
    run("cocotb_tests.core_most_axes", TOP, MOST_AXES, simulator)


@pytest.mark.sample(1)
def test_random_moves(simulator: str) -> None:
    """Some 170 random moves of one channel."""
    sessions = {"SESSIONS": "6" if simulator == "verilator" else "1"}
    run("cocotb_tests.core_random", TOP, ONE_CHANNEL, simulator, environment_variables=sessions)


def test_random_moves_of_two_channels(simulator: str) -> None:
    """Some 50 random moves of two channels."""
    skip_icarus(simulator)
    sessions = {"SESSIONS": "2" if simulator == "verilator" else "1"}
    run("cocotb_tests.core_random", TOP, TWO_CHANNELS, simulator, environment_variables=sessions)
