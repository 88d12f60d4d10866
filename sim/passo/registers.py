# SPDX-License-Identifier: MIT
# Generated from registers/passo.rdl by tools/generate_registers.py.
"""Registers of Passo: word addresses, fields, reset values, enumerations."""

from enum import IntEnum
from typing import Self


class _DescribedEnum(IntEnum):
    """Numbers with a name and a description."""

    description: str

    def __new__(cls, value: int, description: str) -> Self:
        member = int.__new__(cls, value)
        member._value_ = value
        member.description = description
        return member


class Operation(_DescribedEnum):
    """What a frame asks for."""

    READ = 1, "Read consecutive registers."
    WRITE = 2, "Write consecutive registers."
    PUSH = 3, "Write every word to the same address: lines and ramps."


class Verdict(_DescribedEnum):
    """What became of a frame."""

    OK = 0, "Executed."
    DUPLICATE = 1, "Not executed: its sequence number was accepted before."
    BAD_CRC = 2, "CRC wrong."
    BAD_LENGTH = 3, "Length 0 or above 60, or not whole lines or ramps."
    BAD_OPERATION = 4, "Unknown operation, or one the register does not take."
    UNKNOWN_ADDRESS = 5, "No register at this address."
    READ_ONLY = 6, "The register cannot be written."
    QUEUE_FULL = 7, "Not enough room for the whole frame."
    BUSY = 8, "The state of the channel does not allow it (see the register)."
    BAD_VALUE = 9, "M = 0 or M >= 2^30, N_i > M, a velocity above 1/2, drain velocity 0, reserved bits set."


class State(_DescribedEnum):
    """What a channel does."""

    IDLE = 0, "No motion."
    PREPARE = 1, "First line and first velocity are being made ready."
    ARMED = 2, "Ready to start; waits while WAIT_SYNC is set."
    RUN = 3, "The profile runs."
    SETTLE = 4, "The profile has ended, its last substeps reach the pins."
    DRAIN = 5, "Missing substeps of the LAST line are made at drain_velocity."
    STOPPED = 6, "Stopped by a command or a fault; queues flushed. CLEAR leads back to IDLE."


class Cause(_DescribedEnum):
    """Why a channel stopped."""

    NONE = 0, "Not stopped."
    STOP = 1, "COMMAND.STOP."
    ABORT = 2, "COMMAND.ABORT."
    LINE_UNDERRUN = 3, "A line ended, was not LAST, and none followed."
    RAMP_UNDERRUN = 4, "The ramps ran out at speed."
    STEP_OVERRUN = 5, "Steps came faster than the pin timing of an axis allows."


# Core: Identification. Reads as ASCII PASO.
ADDRESS_IDENTIFICATION = 0x000
IDENTIFICATION_LSB = 0
IDENTIFICATION_BITS = 32
IDENTIFICATION_RESET = 0x5041534F

# Core: Version. Version of the register map and the link.
ADDRESS_VERSION = 0x001
VERSION_PATCH_LSB = 0
VERSION_PATCH_BITS = 8
VERSION_PATCH_RESET = 0x00
VERSION_MINOR_LSB = 8
VERSION_MINOR_BITS = 8
VERSION_MINOR_RESET = 0x01
VERSION_MAJOR_LSB = 16
VERSION_MAJOR_BITS = 8
VERSION_MAJOR_RESET = 0x00

# Core: Parameters. How the core was built.
ADDRESS_PARAMETERS = 0x002
PARAMETERS_CHANNELS_LSB = 0
PARAMETERS_CHANNELS_BITS = 4
PARAMETERS_AXES_LSB = 4
PARAMETERS_AXES_BITS = 4
PARAMETERS_TICK_LOG2_LSB = 8
PARAMETERS_TICK_LOG2_BITS = 5
PARAMETERS_LINE_QUEUE_LOG2_LSB = 16
PARAMETERS_LINE_QUEUE_LOG2_BITS = 5
PARAMETERS_RAMP_QUEUE_LOG2_LSB = 24
PARAMETERS_RAMP_QUEUE_LOG2_BITS = 5

# Core: Run. One bit per channel, all in one register: channels that are ARMED start on the same clock when
# one write clears their WAIT_SYNC.
ADDRESS_RUN = 0x003
RUN_RUN_LSB = 0
RUN_RUN_BITS = 8
RUN_RUN_RESET = 0x00
RUN_WAIT_SYNC_LSB = 8
RUN_WAIT_SYNC_BITS = 8
RUN_WAIT_SYNC_RESET = 0x00
RUN_STATUS_CHANNEL_LSB = 16
RUN_STATUS_CHANNEL_BITS = 3
RUN_STATUS_CHANNEL_RESET = 0x0
RUN_DEFINED = 0x0007FFFF

# Core: Refusals 0. Counters of refused frames; they wrap.
ADDRESS_REFUSALS_0 = 0x004
REFUSALS_0_BAD_CRC_LSB = 0
REFUSALS_0_BAD_CRC_BITS = 8
REFUSALS_0_BAD_CRC_RESET = 0x00
REFUSALS_0_BAD_LENGTH_LSB = 8
REFUSALS_0_BAD_LENGTH_BITS = 8
REFUSALS_0_BAD_LENGTH_RESET = 0x00
REFUSALS_0_BAD_OPERATION_LSB = 16
REFUSALS_0_BAD_OPERATION_BITS = 8
REFUSALS_0_BAD_OPERATION_RESET = 0x00
REFUSALS_0_UNKNOWN_ADDRESS_LSB = 24
REFUSALS_0_UNKNOWN_ADDRESS_BITS = 8
REFUSALS_0_UNKNOWN_ADDRESS_RESET = 0x00

# Core: Refusals 1. Counters of refused frames; they wrap.
ADDRESS_REFUSALS_1 = 0x005
REFUSALS_1_READ_ONLY_LSB = 0
REFUSALS_1_READ_ONLY_BITS = 8
REFUSALS_1_READ_ONLY_RESET = 0x00
REFUSALS_1_QUEUE_FULL_LSB = 8
REFUSALS_1_QUEUE_FULL_BITS = 8
REFUSALS_1_QUEUE_FULL_RESET = 0x00
REFUSALS_1_BUSY_LSB = 16
REFUSALS_1_BUSY_BITS = 8
REFUSALS_1_BUSY_RESET = 0x00
REFUSALS_1_BAD_VALUE_LSB = 24
REFUSALS_1_BAD_VALUE_BITS = 8
REFUSALS_1_BAD_VALUE_RESET = 0x00

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. Refused with BUSY
# while a motion runs.
ADDRESS_COSINE_BASE = 0xD00
ADDRESS_COSINE_COUNT = 256
COSINE_POINT_LSB = 0
COSINE_POINT_BITS = 16
COSINE_DEFINED = 0x0000FFFF

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. Refused with BUSY
# while a motion runs.
ADDRESS_SIGMOID_BASE = 0xE00
ADDRESS_SIGMOID_COUNT = 256
SIGMOID_POINT_LSB = 0
SIGMOID_POINT_BITS = 16
SIGMOID_DEFINED = 0x0000FFFF

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. Refused with BUSY
# while a motion runs.
ADDRESS_EASE_BASE = 0xF00
ADDRESS_EASE_COUNT = 256
EASE_POINT_LSB = 0
EASE_POINT_BITS = 16
EASE_DEFINED = 0x0000FFFF

# Core: where each channel has its registers.
ADDRESS_CHANNEL_BASE = 0x100
ADDRESS_CHANNEL_COUNT = 8
ADDRESS_CHANNEL_STRIDE = 0x100

# Channel: Command. Each bit written as 1 is done once. With STOP or ABORT, CLEAR and ZERO in the same word
# are ignored; ABORT wins over STOP.
CHANNEL_COMMAND = 0x00
CHANNEL_COMMAND_STOP_LSB = 0
CHANNEL_COMMAND_STOP_BITS = 1
CHANNEL_COMMAND_STOP_RESET = 0x0
CHANNEL_COMMAND_ABORT_LSB = 1
CHANNEL_COMMAND_ABORT_BITS = 1
CHANNEL_COMMAND_ABORT_RESET = 0x0
CHANNEL_COMMAND_CLEAR_LSB = 2
CHANNEL_COMMAND_CLEAR_BITS = 1
CHANNEL_COMMAND_CLEAR_RESET = 0x0
CHANNEL_COMMAND_ZERO_LSB = 3
CHANNEL_COMMAND_ZERO_BITS = 1
CHANNEL_COMMAND_ZERO_RESET = 0x0
CHANNEL_COMMAND_DEFINED = 0x0000000F

# Channel: Rate target. Time scale, UQ1.16: 0 = feed hold, 65536 = 1.0 = full speed. Refused with BAD_VALUE
# above 1.0.
CHANNEL_RATE_TARGET = 0x01
CHANNEL_RATE_TARGET_LSB = 0
CHANNEL_RATE_TARGET_BITS = 17
CHANNEL_RATE_TARGET_RESET = 0x10000
CHANNEL_RATE_TARGET_DEFINED = 0x0001FFFF

# Channel: Rate slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = at once; 0 counts as 1.
CHANNEL_RATE_SLEW = 0x02
CHANNEL_RATE_SLEW_LSB = 0
CHANNEL_RATE_SLEW_BITS = 17
CHANNEL_RATE_SLEW_RESET = 0x00400
CHANNEL_RATE_SLEW_DEFINED = 0x0001FFFF

# Channel: Stop slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = at once; 0 counts as 1.
CHANNEL_STOP_SLEW = 0x03
CHANNEL_STOP_SLEW_LSB = 0
CHANNEL_STOP_SLEW_BITS = 17
CHANNEL_STOP_SLEW_RESET = 0x00400
CHANNEL_STOP_SLEW_DEFINED = 0x0001FFFF

# Channel: Drain velocity. Velocity of the substeps that are still missing when the profile has ended.
CHANNEL_DRAIN_VELOCITY = 0x04
CHANNEL_DRAIN_VELOCITY_LSB = 0
CHANNEL_DRAIN_VELOCITY_BITS = 32
CHANNEL_DRAIN_VELOCITY_RESET = 0x01000000
CHANNEL_DRAIN_VELOCITY_DEFINED = 0xFFFFFFFF

# Channel: State. What the channel does now.
CHANNEL_STATE = 0x08
CHANNEL_STATE_STATE_LSB = 0
CHANNEL_STATE_STATE_BITS = 3
CHANNEL_STATE_STATE_RESET = 0x0
CHANNEL_STATE_QUIET_LSB = 3
CHANNEL_STATE_QUIET_BITS = 1
CHANNEL_STATE_QUIET_RESET = 0x1
CHANNEL_STATE_CAUSE_LSB = 4
CHANNEL_STATE_CAUSE_BITS = 3
CHANNEL_STATE_CAUSE_RESET = 0x0
CHANNEL_STATE_STOPPING_LSB = 7
CHANNEL_STATE_STOPPING_BITS = 1
CHANNEL_STATE_STOPPING_RESET = 0x0
CHANNEL_STATE_OVERRUN_LSB = 8
CHANNEL_STATE_OVERRUN_BITS = 8
CHANNEL_STATE_OVERRUN_RESET = 0x00
CHANNEL_STATE_DRAINED_LSB = 16
CHANNEL_STATE_DRAINED_BITS = 16
CHANNEL_STATE_DRAINED_RESET = 0x0000

# Channel: Rate. Time scale in force.
CHANNEL_RATE = 0x09
CHANNEL_RATE_LSB = 0
CHANNEL_RATE_BITS = 17
CHANNEL_RATE_RESET = 0x10000

# Channel: Room. Free places in the queues. A push counts from the moment its frame is accepted.
CHANNEL_ROOM = 0x0A
CHANNEL_ROOM_RAMP_ROOM_LSB = 0
CHANNEL_ROOM_RAMP_ROOM_BITS = 16
CHANNEL_ROOM_LINE_ROOM_LSB = 16
CHANNEL_ROOM_LINE_ROOM_BITS = 16

# Channel: Velocity. Velocity of the present tick, before the time scale.
CHANNEL_VELOCITY = 0x0B
CHANNEL_VELOCITY_LSB = 0
CHANNEL_VELOCITY_BITS = 32
CHANNEL_VELOCITY_RESET = 0x00000000

# Channel: Line queue. PUSH only: control, M, N_0 .. N_{AXES-1} for each line.
CHANNEL_LINE = 0x20
CHANNEL_LINE_LSB = 0
CHANNEL_LINE_BITS = 32
CHANNEL_LINE_DEFINED = 0xFFFFFFFF

# Channel: Ramp queue. PUSH only: 5 words for each ramp: v_end(47:32) (31:16) and LAST (0), NOW (1), mirror
# (2), shape (5:4); v_end(31:0); T; du(47:32); du(31:0).
CHANNEL_RAMP = 0x21
CHANNEL_RAMP_LSB = 0
CHANNEL_RAMP_BITS = 32
CHANNEL_RAMP_DEFINED = 0xFFFFFFFF

# Channel: Steps made. Position of an axis in steps, as it was soon after chip select fell; wraps.
CHANNEL_POSITION_BASE = 0x40
CHANNEL_POSITION_COUNT = 8
CHANNEL_POSITION_LSB = 0
CHANNEL_POSITION_BITS = 32
CHANNEL_POSITION_RESET = 0x00000000

# Channel: where each axis has its registers.
CHANNEL_AXIS_BASE = 0x80
CHANNEL_AXIS_COUNT = 8
CHANNEL_AXIS_STRIDE = 0x08

# Axis: Pins. Polarities and step mode. Refused with BUSY unless the channel is quiet. The next step waits
# for the low time, the DIR hold and the DIR set-up from here on. Kept over a reset of the core.
AXIS_PINS = 0x0
AXIS_PINS_STEP_INVERTED_LSB = 1
AXIS_PINS_STEP_INVERTED_BITS = 1
AXIS_PINS_STEP_INVERTED_RESET = 0x0
AXIS_PINS_DIRECTION_INVERTED_LSB = 2
AXIS_PINS_DIRECTION_INVERTED_BITS = 1
AXIS_PINS_DIRECTION_INVERTED_RESET = 0x0
AXIS_PINS_ENABLE_INVERTED_LSB = 3
AXIS_PINS_ENABLE_INVERTED_BITS = 1
AXIS_PINS_ENABLE_INVERTED_RESET = 0x0
AXIS_PINS_BOTH_EDGES_LSB = 4
AXIS_PINS_BOTH_EDGES_BITS = 1
AXIS_PINS_BOTH_EDGES_RESET = 0x0
AXIS_PINS_DEFINED = 0x0000001E

# Axis: STEP timing. Clocks, 1 .. 65535; 0 counts as 1. Kept over a reset of the core.
AXIS_STEP_TIMING = 0x1
AXIS_STEP_TIMING_STEP_LOW_LSB = 0
AXIS_STEP_TIMING_STEP_LOW_BITS = 16
AXIS_STEP_TIMING_STEP_LOW_RESET = 0x0001
AXIS_STEP_TIMING_STEP_HIGH_LSB = 16
AXIS_STEP_TIMING_STEP_HIGH_BITS = 16
AXIS_STEP_TIMING_STEP_HIGH_RESET = 0x0001
AXIS_STEP_TIMING_DEFINED = 0xFFFFFFFF

# Axis: DIR timing. Clocks, 1 .. 65535; 0 counts as 1. Kept over a reset of the core.
AXIS_DIR_TIMING = 0x2
AXIS_DIR_TIMING_DIR_HOLD_LSB = 0
AXIS_DIR_TIMING_DIR_HOLD_BITS = 16
AXIS_DIR_TIMING_DIR_HOLD_RESET = 0x0001
AXIS_DIR_TIMING_DIR_SETUP_LSB = 16
AXIS_DIR_TIMING_DIR_SETUP_BITS = 16
AXIS_DIR_TIMING_DIR_SETUP_RESET = 0x0001
AXIS_DIR_TIMING_DEFINED = 0xFFFFFFFF

# Axis: Lost steps. Steps that found the queue of the axis full (STEP_OVERRUN).
AXIS_LOST_STEPS = 0x3
AXIS_LOST_STEPS_LOST_LSB = 0
AXIS_LOST_STEPS_LOST_BITS = 4
AXIS_LOST_STEPS_LOST_RESET = 0x0

# Axis: Drive enable. May be written at any time.
AXIS_ENABLE = 0x4
AXIS_ENABLE_LSB = 0
AXIS_ENABLE_BITS = 1
AXIS_ENABLE_RESET = 0x0
AXIS_ENABLE_DEFINED = 0x00000001
