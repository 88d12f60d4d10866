# SPDX-License-Identifier: MIT
# Generated from spec/passo.rdl by spec/generate_registers.py.
# fmt: off
# ruff: noqa: E501, RUF009
"""Registers of Passo: word addresses, fields, reset values, enumerations."""

from dataclasses import dataclass

from passo.register_table import Field, Register
from passo.register_word import DescribedEnum, Word, bits


class Operation(DescribedEnum):
    """Operation of a frame."""

    READ = 1, "Read consecutive registers."
    WRITE = 2, "Write consecutive registers."
    PUSH = 3, "Write every word to the same address: lines and ramps."


class Verdict(DescribedEnum):
    """Outcome of a frame."""

    OK = 0, "Executed."
    DUPLICATE = 1, "Not executed: its sequence number was accepted before."
    BAD_CRC = 2, "CRC wrong."
    BAD_LENGTH = 3, "Length 0 or above 60, or not whole lines or ramps."
    BAD_OPERATION = 4, "Unknown operation, or one the register does not take."
    UNKNOWN_ADDRESS = 5, "No register at this address."
    READ_ONLY = 6, "The register cannot be written."
    QUEUE_FULL = 7, "Not enough room for the whole frame."
    BUSY = 8, "The state of the channel does not allow it (see the register)."
    BAD_VALUE = 9, "The register does not take the value, or an undefined bit is set (see the register)."


class State(DescribedEnum):
    """State of a channel."""

    IDLE = 0, "No motion."
    PREPARE = 1, "First line and first velocity are being prepared."
    ARMED = 2, "Ready to start; waits while WAIT_SYNC is set."
    RUN = 3, "The profile runs."
    SETTLE = 4, "The profile has ended; its last substeps travel to the pins."
    DRAIN = 5, "Missing substeps of the LAST line are made at drain_velocity."
    STOPPED = 6, "Stopped by a command or a fault; queues flushed. CLEAR leads back to IDLE."


class Cause(DescribedEnum):
    """Why a channel has stopped."""

    NONE = 0, "Not stopped."
    STOP = 1, "COMMAND.STOP."
    ABORT = 2, "COMMAND.ABORT."
    LINE_UNDERRUN = 3, "A line ended, was not LAST, and none followed."
    RAMP_UNDERRUN = 4, "The ramps ran out at speed."
    STEP_OVERRUN = 5, "Steps came faster than the pin timing of an axis allows."
    LIMIT = 6, "An axis stepped toward an active limit switch."
    ALARM = 7, "The alarm input of an axis became active."
    TRIGGER = 8, "The trigger fired, and its action is a stop."
    WATCHDOG = 9, "No good frame came for too long while a motion ran."
    ESTOP = 10, "The e-stop input became active."
    FOLLOWING_ERROR = 11, "The following error of an axis exceeded its limit."


class TriggerSource(DescribedEnum):
    """What fires the trigger of a channel."""

    NONE = 0, "None; cannot be armed."
    LIMIT_LOW = 1, "Limit switch of the axis in negative direction."
    LIMIT_HIGH = 2, "Limit switch of the axis in positive direction."
    HOME = 3, "Home switch of the axis."
    PROBE = 4, "Probe of the channel."
    INDEX = 5, "Index of the axis's encoder, as its setup says; never active without ENCODERS."


class TriggerAction(DescribedEnum):
    """What the trigger does when it fires."""

    LATCH = 0, "Only latch."
    SOFT_STOP = 1, "Latch and soft stop."
    HARD_STOP = 2, "Latch and hard stop."
    END_ENDLESS = 3, "Latch, and let the current ENDLESS line end as any other line."


class Shape(DescribedEnum):
    """Shape of a ramp: s as a function of the progress u, both 0 .. 1."""

    LINEAR = 0, "s = u, no table."
    COSINE = 1, "(1 - cos(pi u)) / 2."
    SIGMOID = 2, "Logistic function over -5 .. 5, scaled to begin at 0 and end at 1."
    EASE = 3, "u^2."


@dataclass(frozen=True)
class HeaderWord(Word):
    """Header."""

    operation: Operation = bits(28, 4, "rw")  # Requested operation.
    sequence: int = bits(20, 8, "rw")  # Must differ from that of the previous write or push.
    length: int = bits(12, 8, "rw")  # Words of payload or data, 1 .. 60.
    address: int = bits(0, 12, "rw")  # Address of the first register.


@dataclass(frozen=True)
class AckWord(Word):
    """Ack."""

    sequence: int = bits(24, 8, "rw")  # Sequence number of the request.
    verdict: Verdict = bits(16, 8, "rw")  # Outcome of the frame.
    not_sequence: int = bits(8, 8, "rw")  # The same, inverted.
    not_verdict: int = bits(0, 8, "rw")  # The same, inverted.


@dataclass(frozen=True)
class StatusWord(Word):
    """Status."""

    any_stopped: bool = bits(29, 1, "rw")  # At least one channel is STOPPED.
    any_occupied: bool = bits(28, 1, "rw")  # At least one channel has a motion prepared or running.
    channel: int = bits(24, 3, "rw")  # RUN.STATUS_CHANNEL: the channel whose room follows.
    sequence: int = bits(16, 8, "rw")  # Sequence number of the last write or push executed.
    line_room: int = bits(8, 8, "rw")  # Free places for lines, 255 = 255 or more.
    ramp_room: int = bits(0, 8, "rw")  # Free places for ramps, 255 = 255 or more.
    marker: int = bits(30, 2, "rw", 2)  # Always 2.
    zero: bool = bits(27, 1, "rw", False)  # Always 0.


@dataclass(frozen=True)
class LineControlWord(Word):
    """Line control."""

    directions: int = bits(8, 8, "rw")  # Bit i: axis i counts down.
    endless: bool = bits(1, 1, "rw")  # Repeat until the profile ends.
    last: bool = bits(0, 1, "rw")  # The path ends with this line.


@dataclass(frozen=True)
class RampControlWord(Word):
    """Ramp control."""

    velocity_high: int = bits(16, 16, "rw")  # v_end, UQ0.48, bits 47:32.
    shape: Shape = bits(4, 2, "rw")  # Shape of the ramp.
    mirror: bool = bits(2, 1, "rw")  # 1 - shape(1 - u) instead of shape(u).
    now: bool = bits(1, 1, "rw")  # Drop the queued ramps before it and start from the present velocity.
    last: bool = bits(0, 1, "rw")  # The profile ends with this ramp.


@dataclass(frozen=True)
class LineOutputWord(Word):
    """Line output."""

    raster: bool = bits(25, 1, "rw")  # The power comes from the raster queue (with RASTER); the field is then 0.
    proportional: bool = bits(24, 1, "rw")  # Power in proportion to the present velocity.
    levels: int = bits(16, 8, "rw")  # Levels of the digital outputs.
    power: int = bits(0, 16, "rw")  # Power, UQ0.16, but 65535 is 1.0.


@dataclass(frozen=True)
class VersionWord(Word):
    """Version."""

    major: int = bits(16, 8, "r", 0)  # Major.
    minor: int = bits(8, 8, "r", 4)  # Minor.
    patch: int = bits(0, 8, "r", 0)  # Patch.


@dataclass(frozen=True)
class ParametersWord(Word):
    """Parameters."""

    outputs: bool = bits(31, 1, "r")  # OUTPUTS.
    encoders: bool = bits(30, 1, "r")  # ENCODERS.
    inputs: bool = bits(29, 1, "r")  # INPUTS.
    ramp_queue_log2: int = bits(24, 5, "r")  # RAMP_QUEUE_LOG2.
    tracked: int = bits(21, 3, "r")  # TRACKED.
    line_queue_log2: int = bits(16, 5, "r")  # LINE_QUEUE_LOG2.
    trackers: bool = bits(15, 1, "r")  # TRACKERS.
    compare: bool = bits(14, 1, "r")  # COMPARE.
    raster: bool = bits(13, 1, "r")  # RASTER.
    tick_log2: int = bits(8, 5, "r")  # TICK_LOG2.
    axes: int = bits(4, 4, "r")  # AXES per channel.
    channels: int = bits(0, 4, "r")  # CHANNELS.


@dataclass(frozen=True)
class RunWord(Word):
    """Run."""

    status_channel: int = bits(16, 3, "rw", 0)  # Channel whose queue room the status word reports.
    wait_sync: int = bits(8, 8, "rw", 0)  # A prepared motion stays ARMED until a rising edge of the sync input, or until this bit is cleared.
    run: int = bits(0, 8, "rw", 0)  # The channel may start motions. Clearing it lets a running motion finish.


@dataclass(frozen=True)
class Refusals0Word(Word):
    """Refusals 0."""

    unknown_address: int = bits(24, 8, "r", 0)  # UNKNOWN_ADDRESS.
    bad_operation: int = bits(16, 8, "r", 0)  # BAD_OPERATION.
    bad_length: int = bits(8, 8, "r", 0)  # BAD_LENGTH.
    bad_crc: int = bits(0, 8, "r", 0)  # BAD_CRC.


@dataclass(frozen=True)
class Refusals1Word(Word):
    """Refusals 1."""

    bad_value: int = bits(24, 8, "r", 0)  # BAD_VALUE.
    busy: int = bits(16, 8, "r", 0)  # BUSY.
    queue_full: int = bits(8, 8, "r", 0)  # QUEUE_FULL.
    read_only: int = bits(0, 8, "r", 0)  # READ_ONLY.


@dataclass(frozen=True)
class WatchdogWord(Word):
    """Watchdog."""

    disable_after: int = bits(10, 10, "w", 0)  # Time from that stop until all drive enables are cleared; 0 = never.
    stop_after: int = bits(0, 10, "w", 0)  # Silence after which a running motion is stopped softly; 0 = off.


@dataclass(frozen=True)
class ChannelCommandWord(Word):
    """Command."""

    zero: bool = bits(3, 1, "w", False)  # Set the positions of the channel's axes to 0.
    clear: bool = bits(2, 1, "w", False)  # Clear cause and lost steps and leave STOPPED.
    abort: bool = bits(1, 1, "w", False)  # Hard stop: STOPPED immediately, waiting steps dropped, no new pulse begins.
    stop: bool = bits(0, 1, "w", False)  # Soft stop: rate to 0 by STOP_SLEW, then STOPPED. In IDLE, PREPARE and ARMED: STOPPED immediately.


@dataclass(frozen=True)
class ChannelStateWord(Word):
    """State."""

    drained: int = bits(17, 15, "r", 0)  # Substeps drained since reset; wraps.
    stopping: bool = bits(16, 1, "r", False)  # A soft stop is in progress.
    overrun: int = bits(8, 8, "r", 0)  # One bit per axis: it had a STEP_OVERRUN.
    cause: Cause = bits(4, 4, "r", Cause.NONE)  # Cause of the stop.
    quiet: bool = bits(3, 1, "r", True)  # Quiet: no motion is prepared or running, and the pins of every axis are idle.
    state: State = bits(0, 3, "r", State.IDLE)  # State of the motion.


@dataclass(frozen=True)
class ChannelRoomWord(Word):
    """Room."""

    line_room: int = bits(16, 16, "r")  # Lines.
    ramp_room: int = bits(0, 16, "r")  # Ramps.


@dataclass(frozen=True)
class ChannelInputLevelsWord(Word):
    """Input levels."""

    alarm: int = bits(24, 8, "r", 0)  # alarm.
    home: int = bits(16, 8, "r", 0)  # home.
    limit_high: int = bits(8, 8, "r", 0)  # limit_high.
    limit_low: int = bits(0, 8, "r", 0)  # limit_low.


@dataclass(frozen=True)
class ChannelInputFlagsWord(Word):
    """Input flags."""

    alarm: int = bits(24, 8, "r", 0)  # alarm.
    home: int = bits(16, 8, "r", 0)  # home.
    limit_high: int = bits(8, 8, "r", 0)  # limit_high.
    limit_low: int = bits(0, 8, "r", 0)  # limit_low.


@dataclass(frozen=True)
class ChannelInputClearWord(Word):
    """Clear input flags."""

    alarm: int = bits(24, 8, "w", 0)  # alarm.
    home: int = bits(16, 8, "w", 0)  # home.
    limit_high: int = bits(8, 8, "w", 0)  # limit_high.
    limit_low: int = bits(0, 8, "w", 0)  # limit_low.


@dataclass(frozen=True)
class ChannelTriggerWord(Word):
    """Trigger."""

    arm: bool = bits(16, 1, "w", False)  # 1: armed, once.
    action: TriggerAction = bits(12, 2, "w", TriggerAction.LATCH)  # What it does.
    falling: bool = bits(8, 1, "w", False)  # 1: fires when the source becomes inactive; 0: active.
    axis: int = bits(4, 3, "w", 0)  # Axis of the source.
    source: TriggerSource = bits(0, 3, "w", TriggerSource.NONE)  # What fires it.


@dataclass(frozen=True)
class ChannelTriggerStateWord(Word):
    """Trigger state."""

    unknown: bool = bits(6, 1, "r")  # Levels of the inputs are unknown: they have not been stable for a period of the filter since the reset, or since polarity or filter were written. No motion begins.
    axes: int = bits(8, 8, "r", 0)  # Axes of the first limit or alarm since COMMAND.CLEAR.
    source_active: bool = bits(5, 1, "r", False)  # The trigger is armed, and its source is active.
    arming: bool = bits(4, 1, "r", False)  # The trigger is being armed: its source has not kept one level for longer than the filter yet. No motion begins.
    probe_flag: bool = bits(3, 1, "r", False)  # The probe was active since its flag was cleared.
    probe: bool = bits(2, 1, "r", False)  # Filtered level of the probe, 1 = active.
    fired: bool = bits(1, 1, "r", False)  # It has fired since it was armed.
    armed: bool = bits(0, 1, "r", False)  # The trigger waits for its edge.


@dataclass(frozen=True)
class ChannelProbeWord(Word):
    """Probe."""

    clear: bool = bits(1, 1, "w", False)  # 1: clear the flag.
    inverted: bool = bits(0, 1, "w", False)  # 1: probe is active low.


@dataclass(frozen=True)
class ChannelComparePulseWord(Word):
    """Compare pulse."""

    axis: int = bits(16, 3, "w", 0)  # Axis whose position is compared.
    width: int = bits(0, 16, "w", 0)  # Clocks; 0 = no pulses.


@dataclass(frozen=True)
class ChannelOutputStateWord(Word):
    """Output state."""

    raster_room: int = bits(16, 16, "r", 256)  # Free words of the raster queue; 0 without RASTER. A push counts from the moment its frame is accepted.
    overflow: bool = bits(9, 1, "r", False)  # More than 256 changes waited for the lag since COMMAND.CLEAR. One was lost, so there is no power until then.
    raster_empty: bool = bits(8, 1, "r", False)  # A raster line found no value since COMMAND.CLEAR: its power was 0.
    levels: int = bits(0, 8, "r", 0)  # Levels of the digital outputs.


@dataclass(frozen=True)
class ChannelFollowWord(Word):
    """Follow."""

    scale: int = bits(5, 3, "w", 0)  # A count is 2^scale clocks of the profile.
    source: int = bits(2, 3, "w", 0)  # Axis of the encoder. A missing encoder never counts.
    wait_index: bool = bits(1, 1, "w", False)  # 1: an ARMED motion waits for the index of that encoder.
    follow: bool = bits(0, 1, "w", False)  # 1: the clocks of the profile are counts of an encoder.


@dataclass(frozen=True)
class ChannelFollowStateWord(Word):
    """Follow state."""

    lost: bool = bits(25, 1, "r", False)  # The phase is lost: 2^22 or more were outstanding, or A and B of the encoder changed simultaneously.
    behind: bool = bits(24, 1, "r", False)  # Two counts or more were owed: the path was late.
    owed: int = bits(0, 24, "r", 0)  # Clocks of the profile that are owed to the encoder, signed.


@dataclass(frozen=True)
class ChannelTrackerStateWord(Word):
    """Tracker state."""

    at_target: int = bits(16, 8, "r")  # It is at its target.
    moves: int = bits(8, 8, "r", 0)  # It moves.
    enabled: int = bits(0, 8, "r", 0)  # The tracker is enabled.


@dataclass(frozen=True)
class AxisPinsWord(Word):
    """Pins."""

    both_edges: bool = bits(4, 1, "w", False)  # 1: every edge of STEP is a step.
    enable_inverted: bool = bits(3, 1, "w", False)  # 1: EN is active low. After configuration: parameter ENABLE_RESET.
    direction_inverted: bool = bits(2, 1, "w", False)  # 1: DIR is high for the positive direction. After configuration: parameter DIR_RESET.
    step_inverted: bool = bits(1, 1, "w", False)  # 1: STEP is active low. After configuration: parameter STEP_RESET.


@dataclass(frozen=True)
class AxisStepTimingWord(Word):
    """STEP timing."""

    step_high: int = bits(16, 16, "w", 1)  # Time that STEP is active.
    step_low: int = bits(0, 16, "w", 1)  # Minimum time that STEP is inactive.


@dataclass(frozen=True)
class AxisDirTimingWord(Word):
    """DIR timing."""

    dir_setup: int = bits(16, 16, "w", 1)  # DIR change to the next active edge of STEP.
    dir_hold: int = bits(0, 16, "w", 1)  # End of step_low to the next change of DIR.


@dataclass(frozen=True)
class AxisInputsWord(Word):
    """Inputs of the axis."""

    alarm_disables: bool = bits(6, 1, "w", False)  # 1: the alarm also clears the drive enable of this axis.
    alarm_soft: bool = bits(5, 1, "w", False)  # 1: the alarm makes a soft stop; 0: a hard one.
    limit_soft: bool = bits(4, 1, "w", False)  # 1: limits make a soft stop; 0: a hard one.
    alarm_inverted: bool = bits(3, 1, "w", False)  # 1: alarm is active low.
    home_inverted: bool = bits(2, 1, "w", False)  # 1: home is active low.
    limit_high_inverted: bool = bits(1, 1, "w", False)  # 1: limit_high is active low.
    limit_low_inverted: bool = bits(0, 1, "w", False)  # 1: limit_low is active low.


@dataclass(frozen=True)
class EncoderSetupWord(Word):
    """Encoder setup."""

    stop_hard: bool = bits(4, 1, "w", False)  # 1: it is a hard stop, whatever stop_soft says. Neither: it only shows.
    stop_soft: bool = bits(3, 1, "w", False)  # 1: a following error at the limit is a soft stop.
    index_gated: bool = bits(2, 1, "w", False)  # 1: the index counts only while A and B are high.
    index_inverted: bool = bits(1, 1, "w", False)  # 1: the index is active low.
    inverted: bool = bits(0, 1, "w", False)  # 1: up is B before A.


@dataclass(frozen=True)
class EncoderGreatestWord(Word):
    """Greatest following error."""

    exceeded: bool = bits(31, 1, "r", False)  # The error is at its limit now.
    greatest: int = bits(0, 18, "r", 0)  # Counts, either way.


@dataclass(frozen=True)
class EncoderIndexWord(Word):
    """Encoder index."""

    illegal: int = bits(24, 8, "r", 0)  # Simultaneous changes of A and B (illegal transitions), saturating at 255; also cleared by COMMAND.CLEAR.
    indexes: int = bits(16, 8, "r", 0)  # Number of indexes; wraps.
    latch: int = bits(0, 16, "r", 0)  # Encoder position at the last index, its lower 16 bits.


# Word: Header. First word of a request.
HEADER_ADDRESS_LSB = 0
HEADER_ADDRESS_BITS = 12
HEADER_LENGTH_LSB = 12
HEADER_LENGTH_BITS = 8
HEADER_SEQUENCE_LSB = 20
HEADER_SEQUENCE_BITS = 8
HEADER_OPERATION_LSB = 28
HEADER_OPERATION_BITS = 4
HEADER_DEFINED = 0xFFFFFFFF

# Word: Ack. Last word of the reply to a write or push, and to a refused read.
ACK_NOT_VERDICT_LSB = 0
ACK_NOT_VERDICT_BITS = 8
ACK_NOT_SEQUENCE_LSB = 8
ACK_NOT_SEQUENCE_BITS = 8
ACK_VERDICT_LSB = 16
ACK_VERDICT_BITS = 8
ACK_SEQUENCE_LSB = 24
ACK_SEQUENCE_BITS = 8
ACK_DEFINED = 0xFFFFFFFF

# Word: Status. Sent in a reply before the ack or the data; sampled when chip select fell.
STATUS_RAMP_ROOM_LSB = 0
STATUS_RAMP_ROOM_BITS = 8
STATUS_LINE_ROOM_LSB = 8
STATUS_LINE_ROOM_BITS = 8
STATUS_SEQUENCE_LSB = 16
STATUS_SEQUENCE_BITS = 8
STATUS_CHANNEL_LSB = 24
STATUS_CHANNEL_BITS = 3
STATUS_ZERO_LSB = 27
STATUS_ZERO_BITS = 1
STATUS_ZERO_RESET = 0x0
STATUS_ANY_OCCUPIED_LSB = 28
STATUS_ANY_OCCUPIED_BITS = 1
STATUS_ANY_STOPPED_LSB = 29
STATUS_ANY_STOPPED_BITS = 1
STATUS_MARKER_LSB = 30
STATUS_MARKER_BITS = 2
STATUS_MARKER_RESET = 0x2
STATUS_DEFINED = 0xFFFFFFFF

# Word: Line control. First word of a line; then M, N_0 .. N_{AXES-1} and, with OUTPUTS, its output.
LINE_CONTROL_LAST_LSB = 0
LINE_CONTROL_LAST_BITS = 1
LINE_CONTROL_ENDLESS_LSB = 1
LINE_CONTROL_ENDLESS_BITS = 1
LINE_CONTROL_DIRECTIONS_LSB = 8
LINE_CONTROL_DIRECTIONS_BITS = 8
LINE_CONTROL_DEFINED = 0x0000FF03

# Word: Ramp control. First word of a ramp; then the lower bits of v_end, T, and the progress step in two
# words.
RAMP_CONTROL_LAST_LSB = 0
RAMP_CONTROL_LAST_BITS = 1
RAMP_CONTROL_NOW_LSB = 1
RAMP_CONTROL_NOW_BITS = 1
RAMP_CONTROL_MIRROR_LSB = 2
RAMP_CONTROL_MIRROR_BITS = 1
RAMP_CONTROL_SHAPE_LSB = 4
RAMP_CONTROL_SHAPE_BITS = 2
RAMP_CONTROL_VELOCITY_HIGH_LSB = 16
RAMP_CONTROL_VELOCITY_HIGH_BITS = 16
RAMP_CONTROL_DEFINED = 0xFFFF0037

# Word: Line output. With OUTPUTS the last word of a line.
LINE_OUTPUT_POWER_LSB = 0
LINE_OUTPUT_POWER_BITS = 16
LINE_OUTPUT_LEVELS_LSB = 16
LINE_OUTPUT_LEVELS_BITS = 8
LINE_OUTPUT_PROPORTIONAL_LSB = 24
LINE_OUTPUT_PROPORTIONAL_BITS = 1
LINE_OUTPUT_RASTER_LSB = 25
LINE_OUTPUT_RASTER_BITS = 1
LINE_OUTPUT_DEFINED = 0x03FFFFFF

# Core: Identification. Reads as ASCII PASO.
ADDRESS_IDENTIFICATION = 0x000
IDENTIFICATION_LSB = 0
IDENTIFICATION_BITS = 32
IDENTIFICATION_RESET = 0x5041534F

# Core: Version. Version of the register map and the link. That of the release is in the file VERSION of
# the repository.
ADDRESS_VERSION = 0x001
VERSION_PATCH_LSB = 0
VERSION_PATCH_BITS = 8
VERSION_PATCH_RESET = 0x00
VERSION_MINOR_LSB = 8
VERSION_MINOR_BITS = 8
VERSION_MINOR_RESET = 0x04
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
PARAMETERS_RASTER_LSB = 13
PARAMETERS_RASTER_BITS = 1
PARAMETERS_COMPARE_LSB = 14
PARAMETERS_COMPARE_BITS = 1
PARAMETERS_TRACKERS_LSB = 15
PARAMETERS_TRACKERS_BITS = 1
PARAMETERS_LINE_QUEUE_LOG2_LSB = 16
PARAMETERS_LINE_QUEUE_LOG2_BITS = 5
PARAMETERS_TRACKED_LSB = 21
PARAMETERS_TRACKED_BITS = 3
PARAMETERS_RAMP_QUEUE_LOG2_LSB = 24
PARAMETERS_RAMP_QUEUE_LOG2_BITS = 5
PARAMETERS_INPUTS_LSB = 29
PARAMETERS_INPUTS_BITS = 1
PARAMETERS_ENCODERS_LSB = 30
PARAMETERS_ENCODERS_BITS = 1
PARAMETERS_OUTPUTS_LSB = 31
PARAMETERS_OUTPUTS_BITS = 1

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

# Core: Clock. What the core runs at, as the top of the board tells it.
ADDRESS_CLOCK = 0x006
CLOCK_HZ_LSB = 0
CLOCK_HZ_BITS = 32

# Core: Build. Which bitstream it is.
ADDRESS_BUILD = 0x007
BUILD_LSB = 0
BUILD_BITS = 32

# Core: Input filter. Glitch filter of all inputs but e-stop. After a write they are unknown.
ADDRESS_INPUT_FILTER = 0x010
INPUT_FILTER_FILTER_LSB = 0
INPUT_FILTER_FILTER_BITS = 16
INPUT_FILTER_FILTER_RESET = 0x0000
INPUT_FILTER_DEFINED = 0x0000FFFF

# Core: Watchdog. Stops motions when no frame has been executed for some time. In units of 2^16 clocks.
ADDRESS_WATCHDOG = 0x011
WATCHDOG_STOP_AFTER_LSB = 0
WATCHDOG_STOP_AFTER_BITS = 10
WATCHDOG_STOP_AFTER_RESET = 0x000
WATCHDOG_DISABLE_AFTER_LSB = 10
WATCHDOG_DISABLE_AFTER_BITS = 10
WATCHDOG_DISABLE_AFTER_RESET = 0x000
WATCHDOG_DEFINED = 0x000FFFFF

# Core: E-stop. State of the e-stop.
ADDRESS_ESTOP = 0x012
ESTOP_PRESSED_LSB = 0
ESTOP_PRESSED_BITS = 1
ESTOP_PRESSED_RESET = 0x0

# Core: Clear e-stop. No effect while e-stop is pressed.
ADDRESS_ESTOP_CLEAR = 0x013
ESTOP_CLEAR_CLEAR_LSB = 0
ESTOP_CLEAR_CLEAR_BITS = 1
ESTOP_CLEAR_CLEAR_RESET = 0x0
ESTOP_CLEAR_DEFINED = 0x00000001

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
ADDRESS_COSINE_BASE = 0xD00
ADDRESS_COSINE_COUNT = 256
COSINE_POINT_LSB = 0
COSINE_POINT_BITS = 16
COSINE_DEFINED = 0x0000FFFF

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
ADDRESS_SIGMOID_BASE = 0xE00
ADDRESS_SIGMOID_COUNT = 256
SIGMOID_POINT_LSB = 0
SIGMOID_POINT_BITS = 16
SIGMOID_DEFINED = 0x0000FFFF

# Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
ADDRESS_EASE_BASE = 0xF00
ADDRESS_EASE_COUNT = 256
EASE_POINT_LSB = 0
EASE_POINT_BITS = 16
EASE_DEFINED = 0x0000FFFF

# Core: where each channel has its registers.
ADDRESS_CHANNEL_BASE = 0x100
ADDRESS_CHANNEL_COUNT = 8
ADDRESS_CHANNEL_STRIDE = 0x100

# Channel: Command. Each bit written as 1 takes effect once. STOP and ABORT override CLEAR and ZERO in the
# same word; ABORT has priority over STOP.
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

# Channel: Rate target. Time scale, UQ1.16: 0 = feed hold, 65536 = 1.0 = full speed.
CHANNEL_RATE_TARGET = 0x01
CHANNEL_RATE_TARGET_LSB = 0
CHANNEL_RATE_TARGET_BITS = 17
CHANNEL_RATE_TARGET_RESET = 0x10000
CHANNEL_RATE_TARGET_DEFINED = 0x0001FFFF

# Channel: Rate slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1.
CHANNEL_RATE_SLEW = 0x02
CHANNEL_RATE_SLEW_LSB = 0
CHANNEL_RATE_SLEW_BITS = 17
CHANNEL_RATE_SLEW_RESET = 0x00400
CHANNEL_RATE_SLEW_DEFINED = 0x0001FFFF

# Channel: Stop slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1.
CHANNEL_STOP_SLEW = 0x03
CHANNEL_STOP_SLEW_LSB = 0
CHANNEL_STOP_SLEW_BITS = 17
CHANNEL_STOP_SLEW_RESET = 0x00400
CHANNEL_STOP_SLEW_DEFINED = 0x0001FFFF

# Channel: Drain velocity. Velocity of the substeps still missing when the profile has ended.
CHANNEL_DRAIN_VELOCITY = 0x04
CHANNEL_DRAIN_VELOCITY_LSB = 0
CHANNEL_DRAIN_VELOCITY_BITS = 32
CHANNEL_DRAIN_VELOCITY_RESET = 0x01000000
CHANNEL_DRAIN_VELOCITY_DEFINED = 0xFFFFFFFF

# Channel: State. State of the channel.
CHANNEL_STATE = 0x08
CHANNEL_STATE_STATE_LSB = 0
CHANNEL_STATE_STATE_BITS = 3
CHANNEL_STATE_STATE_RESET = 0x0
CHANNEL_STATE_QUIET_LSB = 3
CHANNEL_STATE_QUIET_BITS = 1
CHANNEL_STATE_QUIET_RESET = 0x1
CHANNEL_STATE_CAUSE_LSB = 4
CHANNEL_STATE_CAUSE_BITS = 4
CHANNEL_STATE_CAUSE_RESET = 0x0
CHANNEL_STATE_OVERRUN_LSB = 8
CHANNEL_STATE_OVERRUN_BITS = 8
CHANNEL_STATE_OVERRUN_RESET = 0x00
CHANNEL_STATE_STOPPING_LSB = 16
CHANNEL_STATE_STOPPING_BITS = 1
CHANNEL_STATE_STOPPING_RESET = 0x0
CHANNEL_STATE_DRAINED_LSB = 17
CHANNEL_STATE_DRAINED_BITS = 15
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

# Channel: Input levels. Filtered levels, 1 = active, one bit per axis.
CHANNEL_INPUT_LEVELS = 0x10
CHANNEL_INPUT_LEVELS_LIMIT_LOW_LSB = 0
CHANNEL_INPUT_LEVELS_LIMIT_LOW_BITS = 8
CHANNEL_INPUT_LEVELS_LIMIT_LOW_RESET = 0x00
CHANNEL_INPUT_LEVELS_LIMIT_HIGH_LSB = 8
CHANNEL_INPUT_LEVELS_LIMIT_HIGH_BITS = 8
CHANNEL_INPUT_LEVELS_LIMIT_HIGH_RESET = 0x00
CHANNEL_INPUT_LEVELS_HOME_LSB = 16
CHANNEL_INPUT_LEVELS_HOME_BITS = 8
CHANNEL_INPUT_LEVELS_HOME_RESET = 0x00
CHANNEL_INPUT_LEVELS_ALARM_LSB = 24
CHANNEL_INPUT_LEVELS_ALARM_BITS = 8
CHANNEL_INPUT_LEVELS_ALARM_RESET = 0x00

# Channel: Input flags. Inputs that were active since their flag was cleared, one bit per axis.
CHANNEL_INPUT_FLAGS = 0x11
CHANNEL_INPUT_FLAGS_LIMIT_LOW_LSB = 0
CHANNEL_INPUT_FLAGS_LIMIT_LOW_BITS = 8
CHANNEL_INPUT_FLAGS_LIMIT_LOW_RESET = 0x00
CHANNEL_INPUT_FLAGS_LIMIT_HIGH_LSB = 8
CHANNEL_INPUT_FLAGS_LIMIT_HIGH_BITS = 8
CHANNEL_INPUT_FLAGS_LIMIT_HIGH_RESET = 0x00
CHANNEL_INPUT_FLAGS_HOME_LSB = 16
CHANNEL_INPUT_FLAGS_HOME_BITS = 8
CHANNEL_INPUT_FLAGS_HOME_RESET = 0x00
CHANNEL_INPUT_FLAGS_ALARM_LSB = 24
CHANNEL_INPUT_FLAGS_ALARM_BITS = 8
CHANNEL_INPUT_FLAGS_ALARM_RESET = 0x00

# Channel: Clear input flags. Each bit written as 1 clears a flag of INPUT_FLAGS; bits of axes that the
# core lacks do nothing.
CHANNEL_INPUT_CLEAR = 0x12
CHANNEL_INPUT_CLEAR_LIMIT_LOW_LSB = 0
CHANNEL_INPUT_CLEAR_LIMIT_LOW_BITS = 8
CHANNEL_INPUT_CLEAR_LIMIT_LOW_RESET = 0x00
CHANNEL_INPUT_CLEAR_LIMIT_HIGH_LSB = 8
CHANNEL_INPUT_CLEAR_LIMIT_HIGH_BITS = 8
CHANNEL_INPUT_CLEAR_LIMIT_HIGH_RESET = 0x00
CHANNEL_INPUT_CLEAR_HOME_LSB = 16
CHANNEL_INPUT_CLEAR_HOME_BITS = 8
CHANNEL_INPUT_CLEAR_HOME_RESET = 0x00
CHANNEL_INPUT_CLEAR_ALARM_LSB = 24
CHANNEL_INPUT_CLEAR_ALARM_BITS = 8
CHANNEL_INPUT_CLEAR_ALARM_RESET = 0x00
CHANNEL_INPUT_CLEAR_DEFINED = 0xFFFFFFFF

# Channel: Trigger. Every write ends what was armed before.
CHANNEL_TRIGGER = 0x13
CHANNEL_TRIGGER_SOURCE_LSB = 0
CHANNEL_TRIGGER_SOURCE_BITS = 3
CHANNEL_TRIGGER_SOURCE_RESET = 0x0
CHANNEL_TRIGGER_AXIS_LSB = 4
CHANNEL_TRIGGER_AXIS_BITS = 3
CHANNEL_TRIGGER_AXIS_RESET = 0x0
CHANNEL_TRIGGER_FALLING_LSB = 8
CHANNEL_TRIGGER_FALLING_BITS = 1
CHANNEL_TRIGGER_FALLING_RESET = 0x0
CHANNEL_TRIGGER_ACTION_LSB = 12
CHANNEL_TRIGGER_ACTION_BITS = 2
CHANNEL_TRIGGER_ACTION_RESET = 0x0
CHANNEL_TRIGGER_ARM_LSB = 16
CHANNEL_TRIGGER_ARM_BITS = 1
CHANNEL_TRIGGER_ARM_RESET = 0x0
CHANNEL_TRIGGER_DEFINED = 0x00013177

# Channel: Trigger state. State of the trigger and the probe, and the axes that stopped the channel.
CHANNEL_TRIGGER_STATE = 0x14
CHANNEL_TRIGGER_STATE_ARMED_LSB = 0
CHANNEL_TRIGGER_STATE_ARMED_BITS = 1
CHANNEL_TRIGGER_STATE_ARMED_RESET = 0x0
CHANNEL_TRIGGER_STATE_FIRED_LSB = 1
CHANNEL_TRIGGER_STATE_FIRED_BITS = 1
CHANNEL_TRIGGER_STATE_FIRED_RESET = 0x0
CHANNEL_TRIGGER_STATE_PROBE_LSB = 2
CHANNEL_TRIGGER_STATE_PROBE_BITS = 1
CHANNEL_TRIGGER_STATE_PROBE_RESET = 0x0
CHANNEL_TRIGGER_STATE_PROBE_FLAG_LSB = 3
CHANNEL_TRIGGER_STATE_PROBE_FLAG_BITS = 1
CHANNEL_TRIGGER_STATE_PROBE_FLAG_RESET = 0x0
CHANNEL_TRIGGER_STATE_ARMING_LSB = 4
CHANNEL_TRIGGER_STATE_ARMING_BITS = 1
CHANNEL_TRIGGER_STATE_ARMING_RESET = 0x0
CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_LSB = 5
CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_BITS = 1
CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_RESET = 0x0
CHANNEL_TRIGGER_STATE_UNKNOWN_LSB = 6
CHANNEL_TRIGGER_STATE_UNKNOWN_BITS = 1
CHANNEL_TRIGGER_STATE_AXES_LSB = 8
CHANNEL_TRIGGER_STATE_AXES_BITS = 8
CHANNEL_TRIGGER_STATE_AXES_RESET = 0x00

# Channel: Probe. Polarity, after a change of which the inputs are unknown; and the flag of the probe.
CHANNEL_PROBE = 0x15
CHANNEL_PROBE_INVERTED_LSB = 0
CHANNEL_PROBE_INVERTED_BITS = 1
CHANNEL_PROBE_INVERTED_RESET = 0x0
CHANNEL_PROBE_CLEAR_LSB = 1
CHANNEL_PROBE_CLEAR_BITS = 1
CHANNEL_PROBE_CLEAR_RESET = 0x0
CHANNEL_PROBE_DEFINED = 0x00000003

# Channel: Line queue. Control, M, N_0 .. N_{AXES-1} for each line, and with OUTPUTS its output word.
CHANNEL_LINE = 0x20
CHANNEL_LINE_LSB = 0
CHANNEL_LINE_BITS = 32
CHANNEL_LINE_DEFINED = 0xFFFFFFFF

# Channel: Ramp queue. 5 words for each ramp: v_end(47:32) (31:16) and LAST (0), NOW (1), mirror (2), shape
# (5:4); v_end(31:0); T; du(47:32); du(31:0).
CHANNEL_RAMP = 0x21
CHANNEL_RAMP_LSB = 0
CHANNEL_RAMP_BITS = 32
CHANNEL_RAMP_DEFINED = 0xFFFFFFFF

# Channel: Raster queue. Four values to a word, the lowest byte first. A raster line begins with a whole
# word.
CHANNEL_RASTER = 0x22
CHANNEL_RASTER_LSB = 0
CHANNEL_RASTER_BITS = 32
CHANNEL_RASTER_DEFINED = 0xFFFFFFFF

# Channel: Output levels. Sets the digital outputs immediately, until a line changes them.
CHANNEL_OUTPUT_LEVELS = 0x30
CHANNEL_OUTPUT_LEVELS_LEVELS_LSB = 0
CHANNEL_OUTPUT_LEVELS_LEVELS_BITS = 8
CHANNEL_OUTPUT_LEVELS_LEVELS_RESET = 0x00
CHANNEL_OUTPUT_LEVELS_DEFINED = 0x000000FF

# Channel: Output lag. Delay of the outputs of lines.
CHANNEL_OUTPUT_LAG = 0x31
CHANNEL_OUTPUT_LAG_LAG_LSB = 0
CHANNEL_OUTPUT_LAG_LAG_BITS = 16
CHANNEL_OUTPUT_LAG_LAG_RESET = 0x0000
CHANNEL_OUTPUT_LAG_DEFINED = 0x0000FFFF

# Channel: PWM step. Frequency of the power pin.
CHANNEL_PWM_STEP = 0x32
CHANNEL_PWM_STEP_LSB = 0
CHANNEL_PWM_STEP_BITS = 24
CHANNEL_PWM_STEP_RESET = 0x001000
CHANNEL_PWM_STEP_DEFINED = 0x00FFFFFF

# Channel: Power reference. Velocity at which a power in proportion to the velocity is the one of the line;
# above it, it stays that.
CHANNEL_POWER_REFERENCE = 0x33
CHANNEL_POWER_REFERENCE_LSB = 0
CHANNEL_POWER_REFERENCE_BITS = 32
CHANNEL_POWER_REFERENCE_RESET = 0x80000000
CHANNEL_POWER_REFERENCE_DEFINED = 0xFFFFFFFF

# Channel: Raster pitch. Substeps from one value of a raster line to the next; counts from the next value
# on.
CHANNEL_RASTER_PITCH = 0x34
CHANNEL_RASTER_PITCH_PITCH_LSB = 0
CHANNEL_RASTER_PITCH_PITCH_BITS = 30
CHANNEL_RASTER_PITCH_PITCH_RESET = 0x00000001
CHANNEL_RASTER_PITCH_DEFINED = 0x3FFFFFFF

# Channel: Compare pulse. Ends a pulse in progress, as COMPARE_DISTANCE does.
CHANNEL_COMPARE_PULSE = 0x35
CHANNEL_COMPARE_PULSE_WIDTH_LSB = 0
CHANNEL_COMPARE_PULSE_WIDTH_BITS = 16
CHANNEL_COMPARE_PULSE_WIDTH_RESET = 0x0000
CHANNEL_COMPARE_PULSE_AXIS_LSB = 16
CHANNEL_COMPARE_PULSE_AXIS_BITS = 3
CHANNEL_COMPARE_PULSE_AXIS_RESET = 0x0
CHANNEL_COMPARE_PULSE_DEFINED = 0x0007FFFF

# Channel: Compare distance. Where the first pulse comes.
CHANNEL_COMPARE_DISTANCE = 0x36
CHANNEL_COMPARE_DISTANCE_DISTANCE_LSB = 0
CHANNEL_COMPARE_DISTANCE_DISTANCE_BITS = 32
CHANNEL_COMPARE_DISTANCE_DISTANCE_RESET = 0x00000000
CHANNEL_COMPARE_DISTANCE_DEFINED = 0xFFFFFFFF

# Channel: Compare interval. Counts from the next pulse on.
CHANNEL_COMPARE_INTERVAL = 0x37
CHANNEL_COMPARE_INTERVAL_INTERVAL_LSB = 0
CHANNEL_COMPARE_INTERVAL_INTERVAL_BITS = 32
CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET = 0x00000001
CHANNEL_COMPARE_INTERVAL_DEFINED = 0xFFFFFFFF

# Channel: Output state. State of the outputs.
CHANNEL_OUTPUT_STATE = 0x38
CHANNEL_OUTPUT_STATE_LEVELS_LSB = 0
CHANNEL_OUTPUT_STATE_LEVELS_BITS = 8
CHANNEL_OUTPUT_STATE_LEVELS_RESET = 0x00
CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB = 8
CHANNEL_OUTPUT_STATE_RASTER_EMPTY_BITS = 1
CHANNEL_OUTPUT_STATE_RASTER_EMPTY_RESET = 0x0
CHANNEL_OUTPUT_STATE_OVERFLOW_LSB = 9
CHANNEL_OUTPUT_STATE_OVERFLOW_BITS = 1
CHANNEL_OUTPUT_STATE_OVERFLOW_RESET = 0x0
CHANNEL_OUTPUT_STATE_RASTER_ROOM_LSB = 16
CHANNEL_OUTPUT_STATE_RASTER_ROOM_BITS = 16
CHANNEL_OUTPUT_STATE_RASTER_ROOM_RESET = 0x0100

# Channel: Steps made. Position of an axis in steps, sampled soon after chip select fell; wraps.
CHANNEL_POSITION_BASE = 0x40
CHANNEL_POSITION_COUNT = 8
CHANNEL_POSITION_LSB = 0
CHANNEL_POSITION_BITS = 32
CHANNEL_POSITION_RESET = 0x00000000

# Channel: Latched position. Position of an axis in steps on the clock on which the trigger fired, complete
# 130 clocks later. A ZERO less than 64 clocks after that clears it.
CHANNEL_TRIGGER_POSITION_BASE = 0x48
CHANNEL_TRIGGER_POSITION_COUNT = 8
CHANNEL_TRIGGER_POSITION_POSITION_LSB = 0
CHANNEL_TRIGGER_POSITION_POSITION_BITS = 32
CHANNEL_TRIGGER_POSITION_POSITION_RESET = 0x00000000

# Channel: Encoder position. Counts of the encoder of an axis, sampled on the clock of its position; wraps.
CHANNEL_ENCODER_POSITION_BASE = 0x50
CHANNEL_ENCODER_POSITION_COUNT = 8
CHANNEL_ENCODER_POSITION_POSITION_LSB = 0
CHANNEL_ENCODER_POSITION_POSITION_BITS = 32
CHANNEL_ENCODER_POSITION_POSITION_RESET = 0x00000000

# Channel: Follow. Whether and how the profile follows an encoder.
CHANNEL_FOLLOW = 0x60
CHANNEL_FOLLOW_FOLLOW_LSB = 0
CHANNEL_FOLLOW_FOLLOW_BITS = 1
CHANNEL_FOLLOW_FOLLOW_RESET = 0x0
CHANNEL_FOLLOW_WAIT_INDEX_LSB = 1
CHANNEL_FOLLOW_WAIT_INDEX_BITS = 1
CHANNEL_FOLLOW_WAIT_INDEX_RESET = 0x0
CHANNEL_FOLLOW_SOURCE_LSB = 2
CHANNEL_FOLLOW_SOURCE_BITS = 3
CHANNEL_FOLLOW_SOURCE_RESET = 0x0
CHANNEL_FOLLOW_SCALE_LSB = 5
CHANNEL_FOLLOW_SCALE_BITS = 3
CHANNEL_FOLLOW_SCALE_RESET = 0x0
CHANNEL_FOLLOW_DEFINED = 0x000000FF

# Channel: Follow limit. What is owed to the encoder is made at no more than this.
CHANNEL_FOLLOW_LIMIT = 0x61
CHANNEL_FOLLOW_LIMIT_LIMIT_LSB = 0
CHANNEL_FOLLOW_LIMIT_LIMIT_BITS = 32
CHANNEL_FOLLOW_LIMIT_LIMIT_RESET = 0x01000000
CHANNEL_FOLLOW_LIMIT_DEFINED = 0xFFFFFFFF

# Channel: Encoder filter. Glitch filter of all encoders of the channel.
CHANNEL_ENCODER_FILTER = 0x62
CHANNEL_ENCODER_FILTER_FILTER_LSB = 0
CHANNEL_ENCODER_FILTER_FILTER_BITS = 8
CHANNEL_ENCODER_FILTER_FILTER_RESET = 0x03
CHANNEL_ENCODER_FILTER_DEFINED = 0x000000FF

# Channel: Follow state. Of the motion that runs; behind and lost, of the last one, until the next is
# prepared.
CHANNEL_FOLLOW_STATE = 0x63
CHANNEL_FOLLOW_STATE_OWED_LSB = 0
CHANNEL_FOLLOW_STATE_OWED_BITS = 24
CHANNEL_FOLLOW_STATE_OWED_RESET = 0x000000
CHANNEL_FOLLOW_STATE_BEHIND_LSB = 24
CHANNEL_FOLLOW_STATE_BEHIND_BITS = 1
CHANNEL_FOLLOW_STATE_BEHIND_RESET = 0x0
CHANNEL_FOLLOW_STATE_LOST_LSB = 25
CHANNEL_FOLLOW_STATE_LOST_BITS = 1
CHANNEL_FOLLOW_STATE_LOST_RESET = 0x0

# Channel: Tracker enable. One bit per axis. A stop of any cause and ZERO clear them; bits of axes that the
# core lacks do nothing.
CHANNEL_TRACKER_ENABLE = 0x64
CHANNEL_TRACKER_ENABLE_ENABLE_LSB = 0
CHANNEL_TRACKER_ENABLE_ENABLE_BITS = 8
CHANNEL_TRACKER_ENABLE_ENABLE_RESET = 0x00
CHANNEL_TRACKER_ENABLE_DEFINED = 0x000000FF

# Channel: Tracker state. One bit per axis.
CHANNEL_TRACKER_STATE = 0x65
CHANNEL_TRACKER_STATE_ENABLED_LSB = 0
CHANNEL_TRACKER_STATE_ENABLED_BITS = 8
CHANNEL_TRACKER_STATE_ENABLED_RESET = 0x00
CHANNEL_TRACKER_STATE_MOVES_LSB = 8
CHANNEL_TRACKER_STATE_MOVES_BITS = 8
CHANNEL_TRACKER_STATE_MOVES_RESET = 0x00
CHANNEL_TRACKER_STATE_AT_TARGET_LSB = 16
CHANNEL_TRACKER_STATE_AT_TARGET_BITS = 8

# Channel: Tracker position. Steps of an axis that are due to its tracker, rounded down while it moves;
# wraps. A hard stop may drop up to 7 of them.
CHANNEL_TRACKER_POSITION_BASE = 0x68
CHANNEL_TRACKER_POSITION_COUNT = 8
CHANNEL_TRACKER_POSITION_POSITION_LSB = 0
CHANNEL_TRACKER_POSITION_POSITION_BITS = 32
CHANNEL_TRACKER_POSITION_POSITION_RESET = 0x00000000

# Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
# moved the axis went up, or none did, the second one while it went down. Their difference is the backlash.
CHANNEL_TRACKER_TARGET_BASE = 0x70
CHANNEL_TRACKER_TARGET_COUNT = 8
CHANNEL_TRACKER_TARGET_TARGET_LSB = 0
CHANNEL_TRACKER_TARGET_TARGET_BITS = 32
CHANNEL_TRACKER_TARGET_TARGET_RESET = 0x00000000
CHANNEL_TRACKER_TARGET_DEFINED = 0xFFFFFFFF

# Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
# moved the axis went up, or none did, the second one while it went down. Their difference is the backlash.
CHANNEL_TRACKER_TARGET_DOWN_BASE = 0x78
CHANNEL_TRACKER_TARGET_DOWN_COUNT = 8
CHANNEL_TRACKER_TARGET_DOWN_TARGET_LSB = 0
CHANNEL_TRACKER_TARGET_DOWN_TARGET_BITS = 32
CHANNEL_TRACKER_TARGET_DOWN_TARGET_RESET = 0x00000000
CHANNEL_TRACKER_TARGET_DOWN_DEFINED = 0xFFFFFFFF

# Channel: where each axis has its registers.
CHANNEL_AXIS_BASE = 0x80
CHANNEL_AXIS_COUNT = 8
CHANNEL_AXIS_STRIDE = 0x08

# Channel: where each encoder has its registers.
CHANNEL_ENCODER_BASE = 0xC0
CHANNEL_ENCODER_COUNT = 8
CHANNEL_ENCODER_STRIDE = 0x08

# Axis: Pins. Polarities and step mode. From the write on, the next step waits for the low time, the DIR
# hold and the DIR setup.
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

# Axis: STEP timing. Clocks, 1 .. 65535; 0 counts as 1.
AXIS_STEP_TIMING = 0x1
AXIS_STEP_TIMING_STEP_LOW_LSB = 0
AXIS_STEP_TIMING_STEP_LOW_BITS = 16
AXIS_STEP_TIMING_STEP_LOW_RESET = 0x0001
AXIS_STEP_TIMING_STEP_HIGH_LSB = 16
AXIS_STEP_TIMING_STEP_HIGH_BITS = 16
AXIS_STEP_TIMING_STEP_HIGH_RESET = 0x0001
AXIS_STEP_TIMING_DEFINED = 0xFFFFFFFF

# Axis: DIR timing. Clocks, 1 .. 65535; 0 counts as 1.
AXIS_DIR_TIMING = 0x2
AXIS_DIR_TIMING_DIR_HOLD_LSB = 0
AXIS_DIR_TIMING_DIR_HOLD_BITS = 16
AXIS_DIR_TIMING_DIR_HOLD_RESET = 0x0001
AXIS_DIR_TIMING_DIR_SETUP_LSB = 16
AXIS_DIR_TIMING_DIR_SETUP_BITS = 16
AXIS_DIR_TIMING_DIR_SETUP_RESET = 0x0001
AXIS_DIR_TIMING_DEFINED = 0xFFFFFFFF

# Axis: Lost steps. Steps lost because the queue of the axis was full (STEP_OVERRUN).
AXIS_LOST_STEPS = 0x3
AXIS_LOST_STEPS_LOST_LSB = 0
AXIS_LOST_STEPS_LOST_BITS = 4
AXIS_LOST_STEPS_LOST_RESET = 0x0

# Axis: Drive enable. Enables the drive of the axis.
AXIS_ENABLE = 0x4
AXIS_ENABLE_LSB = 0
AXIS_ENABLE_BITS = 1
AXIS_ENABLE_RESET = 0x0
AXIS_ENABLE_DEFINED = 0x00000001

# Axis: Inputs of the axis. Polarities, and what limits and alarm do. After a write the inputs are unknown.
AXIS_INPUTS = 0x5
AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB = 0
AXIS_INPUTS_LIMIT_LOW_INVERTED_BITS = 1
AXIS_INPUTS_LIMIT_LOW_INVERTED_RESET = 0x0
AXIS_INPUTS_LIMIT_HIGH_INVERTED_LSB = 1
AXIS_INPUTS_LIMIT_HIGH_INVERTED_BITS = 1
AXIS_INPUTS_LIMIT_HIGH_INVERTED_RESET = 0x0
AXIS_INPUTS_HOME_INVERTED_LSB = 2
AXIS_INPUTS_HOME_INVERTED_BITS = 1
AXIS_INPUTS_HOME_INVERTED_RESET = 0x0
AXIS_INPUTS_ALARM_INVERTED_LSB = 3
AXIS_INPUTS_ALARM_INVERTED_BITS = 1
AXIS_INPUTS_ALARM_INVERTED_RESET = 0x0
AXIS_INPUTS_LIMIT_SOFT_LSB = 4
AXIS_INPUTS_LIMIT_SOFT_BITS = 1
AXIS_INPUTS_LIMIT_SOFT_RESET = 0x0
AXIS_INPUTS_ALARM_SOFT_LSB = 5
AXIS_INPUTS_ALARM_SOFT_BITS = 1
AXIS_INPUTS_ALARM_SOFT_RESET = 0x0
AXIS_INPUTS_ALARM_DISABLES_LSB = 6
AXIS_INPUTS_ALARM_DISABLES_BITS = 1
AXIS_INPUTS_ALARM_DISABLES_RESET = 0x0
AXIS_INPUTS_DEFINED = 0x0000007F

# Axis: Speed of the tracker. The tracker moves no faster. Below its acceleration it does not move.
AXIS_TRACKER_SPEED = 0x6
AXIS_TRACKER_SPEED_SPEED_LSB = 0
AXIS_TRACKER_SPEED_SPEED_BITS = 32
AXIS_TRACKER_SPEED_SPEED_RESET = 0x00000000
AXIS_TRACKER_SPEED_DEFINED = 0xFFFFFFFF

# Axis: Acceleration of the tracker. Greatest change of its speed from one tick to the next.
AXIS_TRACKER_ACCELERATION = 0x7
AXIS_TRACKER_ACCELERATION_ACCELERATION_LSB = 0
AXIS_TRACKER_ACCELERATION_ACCELERATION_BITS = 32
AXIS_TRACKER_ACCELERATION_ACCELERATION_RESET = 0x00000000
AXIS_TRACKER_ACCELERATION_DEFINED = 0xFFFFFFFF

# Encoder: Encoder setup. How the encoder counts, and what a following error does.
ENCODER_SETUP = 0x0
ENCODER_SETUP_INVERTED_LSB = 0
ENCODER_SETUP_INVERTED_BITS = 1
ENCODER_SETUP_INVERTED_RESET = 0x0
ENCODER_SETUP_INDEX_INVERTED_LSB = 1
ENCODER_SETUP_INDEX_INVERTED_BITS = 1
ENCODER_SETUP_INDEX_INVERTED_RESET = 0x0
ENCODER_SETUP_INDEX_GATED_LSB = 2
ENCODER_SETUP_INDEX_GATED_BITS = 1
ENCODER_SETUP_INDEX_GATED_RESET = 0x0
ENCODER_SETUP_STOP_SOFT_LSB = 3
ENCODER_SETUP_STOP_SOFT_BITS = 1
ENCODER_SETUP_STOP_SOFT_RESET = 0x0
ENCODER_SETUP_STOP_HARD_LSB = 4
ENCODER_SETUP_STOP_HARD_BITS = 1
ENCODER_SETUP_STOP_HARD_RESET = 0x0
ENCODER_SETUP_DEFINED = 0x0000001F

# Encoder: Encoder ratio. Counts per step. A write sets the following error to 0.
ENCODER_RATIO = 0x1
ENCODER_RATIO_LSB = 0
ENCODER_RATIO_BITS = 32
ENCODER_RATIO_RESET = 0x00010000
ENCODER_RATIO_DEFINED = 0xFFFFFFFF

# Encoder: Following error limit. Following error at which the limit is exceeded.
ENCODER_LIMIT = 0x2
ENCODER_LIMIT_LSB = 0
ENCODER_LIMIT_BITS = 16
ENCODER_LIMIT_RESET = 0xFFFF
ENCODER_LIMIT_DEFINED = 0x0000FFFF

# Encoder: Following error. Position times ratio less encoder position, both as they were set to 0 by
# COMMAND.ZERO or a write of the ratio.
ENCODER_ERROR = 0x3
ENCODER_ERROR_LSB = 0
ENCODER_ERROR_BITS = 32
ENCODER_ERROR_RESET = 0x00000000

# Encoder: Greatest following error. Since COMMAND.ZERO, COMMAND.CLEAR or a write of the ratio.
ENCODER_GREATEST = 0x4
ENCODER_GREATEST_GREATEST_LSB = 0
ENCODER_GREATEST_GREATEST_BITS = 18
ENCODER_GREATEST_GREATEST_RESET = 0x00000
ENCODER_GREATEST_EXCEEDED_LSB = 31
ENCODER_GREATEST_EXCEEDED_BITS = 1
ENCODER_GREATEST_EXCEEDED_RESET = 0x0

# Encoder: Encoder index. What the index has latched, and the transitions that were none. All 0 after
# COMMAND.ZERO.
ENCODER_INDEX = 0x5
ENCODER_INDEX_LATCH_LSB = 0
ENCODER_INDEX_LATCH_BITS = 16
ENCODER_INDEX_LATCH_RESET = 0x0000
ENCODER_INDEX_INDEXES_LSB = 16
ENCODER_INDEX_INDEXES_BITS = 8
ENCODER_INDEX_INDEXES_RESET = 0x00
ENCODER_INDEX_ILLEGAL_LSB = 24
ENCODER_INDEX_ILLEGAL_BITS = 8
ENCODER_INDEX_ILLEGAL_RESET = 0x00

# All registers, once each.
TABLE = (
    Register("IDENTIFICATION", "CORE", 0x000, 1, (Field("IDENTIFICATION", 0, 32, "r", 0x5041534F),)),
    Register("VERSION", "CORE", 0x001, 1, VersionWord.places()),
    Register("PARAMETERS", "CORE", 0x002, 1, ParametersWord.places()),
    Register("RUN", "CORE", 0x003, 1, RunWord.places()),
    Register("REFUSALS_0", "CORE", 0x004, 1, Refusals0Word.places()),
    Register("REFUSALS_1", "CORE", 0x005, 1, Refusals1Word.places()),
    Register("CLOCK", "CORE", 0x006, 1, (Field("HZ", 0, 32, "r", None),)),
    Register("BUILD", "CORE", 0x007, 1, (Field("BUILD", 0, 32, "r", None),)),
    Register("INPUT_FILTER", "CORE", 0x010, 1, (Field("FILTER", 0, 16, "w", 0x0000),), "inputs"),
    Register("WATCHDOG", "CORE", 0x011, 1, WatchdogWord.places(), "inputs"),
    Register("ESTOP", "CORE", 0x012, 1, (Field("PRESSED", 0, 1, "r", 0x0),), "inputs"),
    Register("ESTOP_CLEAR", "CORE", 0x013, 1, (Field("CLEAR", 0, 1, "w", 0x0),), "inputs"),
    Register("COSINE", "CORE", 0xD00, 256, (Field("POINT", 0, 16, "w", None),)),
    Register("SIGMOID", "CORE", 0xE00, 256, (Field("POINT", 0, 16, "w", None),)),
    Register("EASE", "CORE", 0xF00, 256, (Field("POINT", 0, 16, "w", None),)),
    Register("CHANNEL_COMMAND", "CHANNEL", 0x00, 1, ChannelCommandWord.places()),
    Register("CHANNEL_RATE_TARGET", "CHANNEL", 0x01, 1, (Field("RATE_TARGET", 0, 17, "w", 0x10000),)),
    Register("CHANNEL_RATE_SLEW", "CHANNEL", 0x02, 1, (Field("RATE_SLEW", 0, 17, "w", 0x00400),)),
    Register("CHANNEL_STOP_SLEW", "CHANNEL", 0x03, 1, (Field("STOP_SLEW", 0, 17, "w", 0x00400),)),
    Register("CHANNEL_DRAIN_VELOCITY", "CHANNEL", 0x04, 1, (Field("DRAIN_VELOCITY", 0, 32, "w", 0x01000000),)),
    Register("CHANNEL_STATE", "CHANNEL", 0x08, 1, ChannelStateWord.places()),
    Register("CHANNEL_RATE", "CHANNEL", 0x09, 1, (Field("RATE", 0, 17, "r", 0x10000),)),
    Register("CHANNEL_ROOM", "CHANNEL", 0x0A, 1, ChannelRoomWord.places()),
    Register("CHANNEL_VELOCITY", "CHANNEL", 0x0B, 1, (Field("VELOCITY", 0, 32, "r", 0x00000000),)),
    Register("CHANNEL_INPUT_LEVELS", "CHANNEL", 0x10, 1, ChannelInputLevelsWord.places(), "inputs"),
    Register("CHANNEL_INPUT_FLAGS", "CHANNEL", 0x11, 1, ChannelInputFlagsWord.places(), "inputs"),
    Register("CHANNEL_INPUT_CLEAR", "CHANNEL", 0x12, 1, ChannelInputClearWord.places(), "inputs"),
    Register("CHANNEL_TRIGGER", "CHANNEL", 0x13, 1, ChannelTriggerWord.places(), "inputs"),
    Register("CHANNEL_TRIGGER_STATE", "CHANNEL", 0x14, 1, ChannelTriggerStateWord.places(), "inputs"),
    Register("CHANNEL_PROBE", "CHANNEL", 0x15, 1, ChannelProbeWord.places(), "inputs"),
    Register("CHANNEL_LINE", "CHANNEL", 0x20, 1, (Field("LINE", 0, 32, "w", None),)),
    Register("CHANNEL_RAMP", "CHANNEL", 0x21, 1, (Field("RAMP", 0, 32, "w", None),)),
    Register("CHANNEL_RASTER", "CHANNEL", 0x22, 1, (Field("RASTER", 0, 32, "w", None),), "raster"),
    Register("CHANNEL_OUTPUT_LEVELS", "CHANNEL", 0x30, 1, (Field("LEVELS", 0, 8, "w", 0x00),), "outputs"),
    Register("CHANNEL_OUTPUT_LAG", "CHANNEL", 0x31, 1, (Field("LAG", 0, 16, "w", 0x0000),), "outputs"),
    Register("CHANNEL_PWM_STEP", "CHANNEL", 0x32, 1, (Field("PWM_STEP", 0, 24, "w", 0x001000),), "outputs"),
    Register("CHANNEL_POWER_REFERENCE", "CHANNEL", 0x33, 1, (Field("POWER_REFERENCE", 0, 32, "w", 0x80000000),), "outputs"),
    Register("CHANNEL_RASTER_PITCH", "CHANNEL", 0x34, 1, (Field("PITCH", 0, 30, "w", 0x00000001),), "raster"),
    Register("CHANNEL_COMPARE_PULSE", "CHANNEL", 0x35, 1, ChannelComparePulseWord.places(), "compare"),
    Register("CHANNEL_COMPARE_DISTANCE", "CHANNEL", 0x36, 1, (Field("DISTANCE", 0, 32, "w", 0x00000000),), "compare"),
    Register("CHANNEL_COMPARE_INTERVAL", "CHANNEL", 0x37, 1, (Field("INTERVAL", 0, 32, "w", 0x00000001),), "compare"),
    Register("CHANNEL_OUTPUT_STATE", "CHANNEL", 0x38, 1, ChannelOutputStateWord.places(), "outputs"),
    Register("CHANNEL_POSITION", "CHANNEL", 0x40, 8, (Field("POSITION", 0, 32, "r", 0x00000000),)),
    Register("CHANNEL_TRIGGER_POSITION", "CHANNEL", 0x48, 8, (Field("POSITION", 0, 32, "r", 0x00000000),), "inputs"),
    Register("CHANNEL_ENCODER_POSITION", "CHANNEL", 0x50, 8, (Field("POSITION", 0, 32, "r", 0x00000000),), "encoders"),
    Register("CHANNEL_FOLLOW", "CHANNEL", 0x60, 1, ChannelFollowWord.places(), "encoders"),
    Register("CHANNEL_FOLLOW_LIMIT", "CHANNEL", 0x61, 1, (Field("LIMIT", 0, 32, "w", 0x01000000),), "encoders"),
    Register("CHANNEL_ENCODER_FILTER", "CHANNEL", 0x62, 1, (Field("FILTER", 0, 8, "w", 0x03),), "encoders"),
    Register("CHANNEL_FOLLOW_STATE", "CHANNEL", 0x63, 1, ChannelFollowStateWord.places(), "encoders"),
    Register("CHANNEL_TRACKER_ENABLE", "CHANNEL", 0x64, 1, (Field("ENABLE", 0, 8, "w", 0x00),), "trackers"),
    Register("CHANNEL_TRACKER_STATE", "CHANNEL", 0x65, 1, ChannelTrackerStateWord.places(), "trackers"),
    Register("CHANNEL_TRACKER_POSITION", "CHANNEL", 0x68, 8, (Field("POSITION", 0, 32, "r", 0x00000000),), "trackers"),
    Register("CHANNEL_TRACKER_TARGET", "CHANNEL", 0x70, 8, (Field("TARGET", 0, 32, "w", 0x00000000),), "trackers"),
    Register("CHANNEL_TRACKER_TARGET_DOWN", "CHANNEL", 0x78, 8, (Field("TARGET", 0, 32, "w", 0x00000000),), "trackers"),
    Register("AXIS_PINS", "AXIS", 0x0, 1, AxisPinsWord.places()),
    Register("AXIS_STEP_TIMING", "AXIS", 0x1, 1, AxisStepTimingWord.places()),
    Register("AXIS_DIR_TIMING", "AXIS", 0x2, 1, AxisDirTimingWord.places()),
    Register("AXIS_LOST_STEPS", "AXIS", 0x3, 1, (Field("LOST", 0, 4, "r", 0x0),)),
    Register("AXIS_ENABLE", "AXIS", 0x4, 1, (Field("ENABLE", 0, 1, "w", 0x0),)),
    Register("AXIS_INPUTS", "AXIS", 0x5, 1, AxisInputsWord.places(), "inputs"),
    Register("AXIS_TRACKER_SPEED", "AXIS", 0x6, 1, (Field("SPEED", 0, 32, "w", 0x00000000),), "trackers"),
    Register("AXIS_TRACKER_ACCELERATION", "AXIS", 0x7, 1, (Field("ACCELERATION", 0, 32, "w", 0x00000000),), "trackers"),
    Register("ENCODER_SETUP", "ENCODER", 0x0, 1, EncoderSetupWord.places(), "encoders"),
    Register("ENCODER_RATIO", "ENCODER", 0x1, 1, (Field("RATIO", 0, 32, "w", 0x00010000),), "encoders"),
    Register("ENCODER_LIMIT", "ENCODER", 0x2, 1, (Field("LIMIT", 0, 16, "w", 0xFFFF),), "encoders"),
    Register("ENCODER_ERROR", "ENCODER", 0x3, 1, (Field("ERROR", 0, 32, "r", 0x00000000),), "encoders"),
    Register("ENCODER_GREATEST", "ENCODER", 0x4, 1, EncoderGreatestWord.places(), "encoders"),
    Register("ENCODER_INDEX", "ENCODER", 0x5, 1, EncoderIndexWord.places(), "encoders"),
)
