# SPDX-License-Identifier: MIT
"""Parameters and pins of the core. Generated from spec/pins.toml by spec/generate_pins.py."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class CoreParameters:
    """Build parameters of a core, those of rtl/passo_core.v."""

    # CHANNELS, 1 .. 8
    channels: int = 1
    # AXES, 1 .. 8
    axes: int = 4
    # TICK_LOG2, 7 .. 16
    tick_log2: int = 7
    # LINE_QUEUE_LOG2, 2 .. 8
    line_queue_log2: int = 8
    # RAMP_QUEUE_LOG2, 2 .. 8
    ramp_queue_log2: int = 4
    # INPUTS, 0 or 1: limits, home, alarm, probe, e-stop
    inputs: int = 0
    # ENCODERS, 0 or 1
    encoders: int = 0
    # OUTPUTS, 0 or 1: outputs bound to the path
    outputs: int = 0
    # RASTER, 0 or 1, with OUTPUTS: raster lines, whose power comes from a queue
    raster: int = 0
    # COMPARE, 0 or 1, with OUTPUTS: pulses at positions of an axis
    compare: int = 0
    # TRACKERS, 0 or 1: a second hand on every axis
    trackers: int = 0
    # TRACKED, 0 .. AXES - 1: the last axes, which have no lines: only their trackers move them
    tracked: int = 0
    # CLOCK_HZ, what the host reads as the clock, in Hz; 0: not told
    clock_hz: int = 0
    # BUILD, what the host reads as the identifier of the bitstream
    build: int = 0
    # pin levels after configuration, bit channel * axes + axis; the host cannot read them
    step_reset: int = field(default=0, compare=False)
    dir_reset: int = field(default=0, compare=False)
    enable_reset: int = field(default=0, compare=False)


@dataclass(frozen=True)
class Pin:
    """A pin; `width` is 1 or a product of parameters, `idle` the level of unconnected bits."""

    name: str
    width: str
    idle: int
    parameter: str  # without which it is ignored, or 0


INPUTS = (
    Pin("rst", "1", 0, ""),
    Pin("spi_sclk", "1", 0, ""),
    Pin("spi_mosi", "1", 0, ""),
    Pin("spi_cs_n", "1", 1, ""),
    Pin("sync", "1", 0, ""),
    Pin("estop_n", "1", 1, "inputs"),
    Pin("limit_low", "CHANNELS*AXES", 0, "inputs"),
    Pin("limit_high", "CHANNELS*AXES", 0, "inputs"),
    Pin("home", "CHANNELS*AXES", 0, "inputs"),
    Pin("alarm", "CHANNELS*AXES", 0, "inputs"),
    Pin("probe", "CHANNELS", 0, "inputs"),
    Pin("encoder_a", "CHANNELS*AXES", 0, "encoders"),
    Pin("encoder_b", "CHANNELS*AXES", 0, "encoders"),
    Pin("encoder_index", "CHANNELS*AXES", 0, "encoders"),
)
OUTPUTS = (  # all but MISO
    Pin("step", "CHANNELS*AXES", 0, ""),
    Pin("dir", "CHANNELS*AXES", 0, ""),
    Pin("enable", "CHANNELS*AXES", 0, ""),
    Pin("running", "CHANNELS", 0, ""),
    Pin("irq", "1", 0, ""),
    Pin("outputs", "CHANNELS*8", 0, "outputs"),
    Pin("power", "CHANNELS", 0, "outputs"),
    Pin("compare", "CHANNELS", 0, "compare"),
)
