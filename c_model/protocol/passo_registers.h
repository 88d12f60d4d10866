/* SPDX-License-Identifier: MIT
 * Generated from spec/passo.rdl by spec/generate_registers.py.
 *
 * Registers of Passo. Addresses are word addresses.
 */
#ifndef PASSO_REGISTERS_H
#define PASSO_REGISTERS_H

/* Word: Header. First word of a request. */
#define PASSO_HEADER_ADDRESS_LSB    0u
#define PASSO_HEADER_ADDRESS_BITS   12u
#define PASSO_HEADER_LENGTH_LSB     12u
#define PASSO_HEADER_LENGTH_BITS    8u
#define PASSO_HEADER_SEQUENCE_LSB   20u
#define PASSO_HEADER_SEQUENCE_BITS  8u
#define PASSO_HEADER_OPERATION_LSB  28u
#define PASSO_HEADER_OPERATION_BITS 4u
#define PASSO_HEADER_DEFINED        0xFFFFFFFFu

/* Word: Ack. Last word of the reply to a write or push, and to a refused read. */
#define PASSO_ACK_NOT_VERDICT_LSB   0u
#define PASSO_ACK_NOT_VERDICT_BITS  8u
#define PASSO_ACK_NOT_SEQUENCE_LSB  8u
#define PASSO_ACK_NOT_SEQUENCE_BITS 8u
#define PASSO_ACK_VERDICT_LSB       16u
#define PASSO_ACK_VERDICT_BITS      8u
#define PASSO_ACK_SEQUENCE_LSB      24u
#define PASSO_ACK_SEQUENCE_BITS     8u
#define PASSO_ACK_DEFINED           0xFFFFFFFFu

/* Word: Status. Sent in a reply before the ack or the data; sampled when chip select fell. */
#define PASSO_STATUS_RAMP_ROOM_LSB     0u
#define PASSO_STATUS_RAMP_ROOM_BITS    8u
#define PASSO_STATUS_LINE_ROOM_LSB     8u
#define PASSO_STATUS_LINE_ROOM_BITS    8u
#define PASSO_STATUS_SEQUENCE_LSB      16u
#define PASSO_STATUS_SEQUENCE_BITS     8u
#define PASSO_STATUS_CHANNEL_LSB       24u
#define PASSO_STATUS_CHANNEL_BITS      3u
#define PASSO_STATUS_ZERO_LSB          27u
#define PASSO_STATUS_ZERO_BITS         1u
#define PASSO_STATUS_ZERO_RESET        0x0u
#define PASSO_STATUS_ANY_OCCUPIED_LSB  28u
#define PASSO_STATUS_ANY_OCCUPIED_BITS 1u
#define PASSO_STATUS_ANY_STOPPED_LSB   29u
#define PASSO_STATUS_ANY_STOPPED_BITS  1u
#define PASSO_STATUS_MARKER_LSB        30u
#define PASSO_STATUS_MARKER_BITS       2u
#define PASSO_STATUS_MARKER_RESET      0x2u
#define PASSO_STATUS_DEFINED           0xFFFFFFFFu

/* Word: Line control. First word of a line; then M, N_0 .. N_{AXES-1} and, with OUTPUTS, its output. */
#define PASSO_LINE_CONTROL_LAST_LSB        0u
#define PASSO_LINE_CONTROL_LAST_BITS       1u
#define PASSO_LINE_CONTROL_ENDLESS_LSB     1u
#define PASSO_LINE_CONTROL_ENDLESS_BITS    1u
#define PASSO_LINE_CONTROL_DIRECTIONS_LSB  8u
#define PASSO_LINE_CONTROL_DIRECTIONS_BITS 8u
#define PASSO_LINE_CONTROL_DEFINED         0x0000FF03u

/* Word: Ramp control. First word of a ramp; then the lower bits of v_end, T, and the progress step in two
 * words. */
#define PASSO_RAMP_CONTROL_LAST_LSB           0u
#define PASSO_RAMP_CONTROL_LAST_BITS          1u
#define PASSO_RAMP_CONTROL_NOW_LSB            1u
#define PASSO_RAMP_CONTROL_NOW_BITS           1u
#define PASSO_RAMP_CONTROL_MIRROR_LSB         2u
#define PASSO_RAMP_CONTROL_MIRROR_BITS        1u
#define PASSO_RAMP_CONTROL_SHAPE_LSB          4u
#define PASSO_RAMP_CONTROL_SHAPE_BITS         2u
#define PASSO_RAMP_CONTROL_VELOCITY_HIGH_LSB  16u
#define PASSO_RAMP_CONTROL_VELOCITY_HIGH_BITS 16u
#define PASSO_RAMP_CONTROL_DEFINED            0xFFFF0037u

/* Word: Line output. With OUTPUTS the last word of a line. */
#define PASSO_LINE_OUTPUT_POWER_LSB         0u
#define PASSO_LINE_OUTPUT_POWER_BITS        16u
#define PASSO_LINE_OUTPUT_LEVELS_LSB        16u
#define PASSO_LINE_OUTPUT_LEVELS_BITS       8u
#define PASSO_LINE_OUTPUT_PROPORTIONAL_LSB  24u
#define PASSO_LINE_OUTPUT_PROPORTIONAL_BITS 1u
#define PASSO_LINE_OUTPUT_RASTER_LSB        25u
#define PASSO_LINE_OUTPUT_RASTER_BITS       1u
#define PASSO_LINE_OUTPUT_DEFINED           0x03FFFFFFu

/* Core: Identification. Reads as ASCII PASO. */
#define PASSO_ADDRESS_IDENTIFICATION 0x000u
#define PASSO_IDENTIFICATION_LSB     0u
#define PASSO_IDENTIFICATION_BITS    32u
#define PASSO_IDENTIFICATION_RESET   0x5041534Fu

/* Core: Version. Version of the register map and the link. That of the release is in the file VERSION of
 * the repository. */
#define PASSO_ADDRESS_VERSION     0x001u
#define PASSO_VERSION_PATCH_LSB   0u
#define PASSO_VERSION_PATCH_BITS  8u
#define PASSO_VERSION_PATCH_RESET 0x00u
#define PASSO_VERSION_MINOR_LSB   8u
#define PASSO_VERSION_MINOR_BITS  8u
#define PASSO_VERSION_MINOR_RESET 0x04u
#define PASSO_VERSION_MAJOR_LSB   16u
#define PASSO_VERSION_MAJOR_BITS  8u
#define PASSO_VERSION_MAJOR_RESET 0x00u

/* Core: Parameters. How the core was built. */
#define PASSO_ADDRESS_PARAMETERS              0x002u
#define PASSO_PARAMETERS_CHANNELS_LSB         0u
#define PASSO_PARAMETERS_CHANNELS_BITS        4u
#define PASSO_PARAMETERS_AXES_LSB             4u
#define PASSO_PARAMETERS_AXES_BITS            4u
#define PASSO_PARAMETERS_TICK_LOG2_LSB        8u
#define PASSO_PARAMETERS_TICK_LOG2_BITS       5u
#define PASSO_PARAMETERS_RASTER_LSB           13u
#define PASSO_PARAMETERS_RASTER_BITS          1u
#define PASSO_PARAMETERS_COMPARE_LSB          14u
#define PASSO_PARAMETERS_COMPARE_BITS         1u
#define PASSO_PARAMETERS_TRACKERS_LSB         15u
#define PASSO_PARAMETERS_TRACKERS_BITS        1u
#define PASSO_PARAMETERS_LINE_QUEUE_LOG2_LSB  16u
#define PASSO_PARAMETERS_LINE_QUEUE_LOG2_BITS 5u
#define PASSO_PARAMETERS_TRACKED_LSB          21u
#define PASSO_PARAMETERS_TRACKED_BITS         3u
#define PASSO_PARAMETERS_RAMP_QUEUE_LOG2_LSB  24u
#define PASSO_PARAMETERS_RAMP_QUEUE_LOG2_BITS 5u
#define PASSO_PARAMETERS_INPUTS_LSB           29u
#define PASSO_PARAMETERS_INPUTS_BITS          1u
#define PASSO_PARAMETERS_ENCODERS_LSB         30u
#define PASSO_PARAMETERS_ENCODERS_BITS        1u
#define PASSO_PARAMETERS_OUTPUTS_LSB          31u
#define PASSO_PARAMETERS_OUTPUTS_BITS         1u

/* Core: Run. One bit per channel, all in one register: channels that are ARMED start on the same clock when
 * one write clears their WAIT_SYNC. */
#define PASSO_ADDRESS_RUN              0x003u
#define PASSO_RUN_RUN_LSB              0u
#define PASSO_RUN_RUN_BITS             8u
#define PASSO_RUN_RUN_RESET            0x00u
#define PASSO_RUN_WAIT_SYNC_LSB        8u
#define PASSO_RUN_WAIT_SYNC_BITS       8u
#define PASSO_RUN_WAIT_SYNC_RESET      0x00u
#define PASSO_RUN_STATUS_CHANNEL_LSB   16u
#define PASSO_RUN_STATUS_CHANNEL_BITS  3u
#define PASSO_RUN_STATUS_CHANNEL_RESET 0x0u
#define PASSO_RUN_DEFINED              0x0007FFFFu

/* Core: Refusals 0. Counters of refused frames; they wrap. */
#define PASSO_ADDRESS_REFUSALS_0               0x004u
#define PASSO_REFUSALS_0_BAD_CRC_LSB           0u
#define PASSO_REFUSALS_0_BAD_CRC_BITS          8u
#define PASSO_REFUSALS_0_BAD_CRC_RESET         0x00u
#define PASSO_REFUSALS_0_BAD_LENGTH_LSB        8u
#define PASSO_REFUSALS_0_BAD_LENGTH_BITS       8u
#define PASSO_REFUSALS_0_BAD_LENGTH_RESET      0x00u
#define PASSO_REFUSALS_0_BAD_OPERATION_LSB     16u
#define PASSO_REFUSALS_0_BAD_OPERATION_BITS    8u
#define PASSO_REFUSALS_0_BAD_OPERATION_RESET   0x00u
#define PASSO_REFUSALS_0_UNKNOWN_ADDRESS_LSB   24u
#define PASSO_REFUSALS_0_UNKNOWN_ADDRESS_BITS  8u
#define PASSO_REFUSALS_0_UNKNOWN_ADDRESS_RESET 0x00u

/* Core: Refusals 1. Counters of refused frames; they wrap. */
#define PASSO_ADDRESS_REFUSALS_1          0x005u
#define PASSO_REFUSALS_1_READ_ONLY_LSB    0u
#define PASSO_REFUSALS_1_READ_ONLY_BITS   8u
#define PASSO_REFUSALS_1_READ_ONLY_RESET  0x00u
#define PASSO_REFUSALS_1_QUEUE_FULL_LSB   8u
#define PASSO_REFUSALS_1_QUEUE_FULL_BITS  8u
#define PASSO_REFUSALS_1_QUEUE_FULL_RESET 0x00u
#define PASSO_REFUSALS_1_BUSY_LSB         16u
#define PASSO_REFUSALS_1_BUSY_BITS        8u
#define PASSO_REFUSALS_1_BUSY_RESET       0x00u
#define PASSO_REFUSALS_1_BAD_VALUE_LSB    24u
#define PASSO_REFUSALS_1_BAD_VALUE_BITS   8u
#define PASSO_REFUSALS_1_BAD_VALUE_RESET  0x00u

/* Core: Clock. What the core runs at, as the top of the board tells it. */
#define PASSO_ADDRESS_CLOCK 0x006u
#define PASSO_CLOCK_HZ_LSB  0u
#define PASSO_CLOCK_HZ_BITS 32u

/* Core: Build. Which bitstream it is. */
#define PASSO_ADDRESS_BUILD 0x007u
#define PASSO_BUILD_LSB     0u
#define PASSO_BUILD_BITS    32u

/* Core: Input filter. Glitch filter of all inputs but e-stop. After a write they are unknown. */
#define PASSO_ADDRESS_INPUT_FILTER      0x010u
#define PASSO_INPUT_FILTER_FILTER_LSB   0u
#define PASSO_INPUT_FILTER_FILTER_BITS  16u
#define PASSO_INPUT_FILTER_FILTER_RESET 0x0000u
#define PASSO_INPUT_FILTER_DEFINED      0x0000FFFFu

/* Core: Watchdog. Stops motions when no frame has been executed for some time. In units of 2^16 clocks. */
#define PASSO_ADDRESS_WATCHDOG             0x011u
#define PASSO_WATCHDOG_STOP_AFTER_LSB      0u
#define PASSO_WATCHDOG_STOP_AFTER_BITS     10u
#define PASSO_WATCHDOG_STOP_AFTER_RESET    0x000u
#define PASSO_WATCHDOG_DISABLE_AFTER_LSB   10u
#define PASSO_WATCHDOG_DISABLE_AFTER_BITS  10u
#define PASSO_WATCHDOG_DISABLE_AFTER_RESET 0x000u
#define PASSO_WATCHDOG_DEFINED             0x000FFFFFu

/* Core: E-stop. State of the e-stop. */
#define PASSO_ADDRESS_ESTOP       0x012u
#define PASSO_ESTOP_PRESSED_LSB   0u
#define PASSO_ESTOP_PRESSED_BITS  1u
#define PASSO_ESTOP_PRESSED_RESET 0x0u

/* Core: Clear e-stop. No effect while e-stop is pressed. */
#define PASSO_ADDRESS_ESTOP_CLEAR     0x013u
#define PASSO_ESTOP_CLEAR_CLEAR_LSB   0u
#define PASSO_ESTOP_CLEAR_CLEAR_BITS  1u
#define PASSO_ESTOP_CLEAR_CLEAR_RESET 0x0u
#define PASSO_ESTOP_CLEAR_DEFINED     0x00000001u

/* Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. */
#define PASSO_ADDRESS_COSINE_BASE  0xD00u
#define PASSO_ADDRESS_COSINE_COUNT 256u
#define PASSO_COSINE_POINT_LSB     0u
#define PASSO_COSINE_POINT_BITS    16u
#define PASSO_COSINE_DEFINED       0x0000FFFFu

/* Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. */
#define PASSO_ADDRESS_SIGMOID_BASE  0xE00u
#define PASSO_ADDRESS_SIGMOID_COUNT 256u
#define PASSO_SIGMOID_POINT_LSB     0u
#define PASSO_SIGMOID_POINT_BITS    16u
#define PASSO_SIGMOID_DEFINED       0x0000FFFFu

/* Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0. */
#define PASSO_ADDRESS_EASE_BASE  0xF00u
#define PASSO_ADDRESS_EASE_COUNT 256u
#define PASSO_EASE_POINT_LSB     0u
#define PASSO_EASE_POINT_BITS    16u
#define PASSO_EASE_DEFINED       0x0000FFFFu

/* Core: where each channel has its registers. */
#define PASSO_ADDRESS_CHANNEL_BASE   0x100u
#define PASSO_ADDRESS_CHANNEL_COUNT  8u
#define PASSO_ADDRESS_CHANNEL_STRIDE 0x100u

/* Channel: Command. Each bit written as 1 takes effect once. STOP and ABORT override CLEAR and ZERO in the
 * same word; ABORT has priority over STOP. */
#define PASSO_CHANNEL_COMMAND             0x00u
#define PASSO_CHANNEL_COMMAND_STOP_LSB    0u
#define PASSO_CHANNEL_COMMAND_STOP_BITS   1u
#define PASSO_CHANNEL_COMMAND_STOP_RESET  0x0u
#define PASSO_CHANNEL_COMMAND_ABORT_LSB   1u
#define PASSO_CHANNEL_COMMAND_ABORT_BITS  1u
#define PASSO_CHANNEL_COMMAND_ABORT_RESET 0x0u
#define PASSO_CHANNEL_COMMAND_CLEAR_LSB   2u
#define PASSO_CHANNEL_COMMAND_CLEAR_BITS  1u
#define PASSO_CHANNEL_COMMAND_CLEAR_RESET 0x0u
#define PASSO_CHANNEL_COMMAND_ZERO_LSB    3u
#define PASSO_CHANNEL_COMMAND_ZERO_BITS   1u
#define PASSO_CHANNEL_COMMAND_ZERO_RESET  0x0u
#define PASSO_CHANNEL_COMMAND_DEFINED     0x0000000Fu

/* Channel: Rate target. Time scale, UQ1.16: 0 = feed hold, 65536 = 1.0 = full speed. */
#define PASSO_CHANNEL_RATE_TARGET         0x01u
#define PASSO_CHANNEL_RATE_TARGET_LSB     0u
#define PASSO_CHANNEL_RATE_TARGET_BITS    17u
#define PASSO_CHANNEL_RATE_TARGET_RESET   0x10000u
#define PASSO_CHANNEL_RATE_TARGET_DEFINED 0x0001FFFFu

/* Channel: Rate slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1. */
#define PASSO_CHANNEL_RATE_SLEW         0x02u
#define PASSO_CHANNEL_RATE_SLEW_LSB     0u
#define PASSO_CHANNEL_RATE_SLEW_BITS    17u
#define PASSO_CHANNEL_RATE_SLEW_RESET   0x00400u
#define PASSO_CHANNEL_RATE_SLEW_DEFINED 0x0001FFFFu

/* Channel: Stop slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1. */
#define PASSO_CHANNEL_STOP_SLEW         0x03u
#define PASSO_CHANNEL_STOP_SLEW_LSB     0u
#define PASSO_CHANNEL_STOP_SLEW_BITS    17u
#define PASSO_CHANNEL_STOP_SLEW_RESET   0x00400u
#define PASSO_CHANNEL_STOP_SLEW_DEFINED 0x0001FFFFu

/* Channel: Drain velocity. Velocity of the substeps still missing when the profile has ended. */
#define PASSO_CHANNEL_DRAIN_VELOCITY         0x04u
#define PASSO_CHANNEL_DRAIN_VELOCITY_LSB     0u
#define PASSO_CHANNEL_DRAIN_VELOCITY_BITS    32u
#define PASSO_CHANNEL_DRAIN_VELOCITY_RESET   0x01000000u
#define PASSO_CHANNEL_DRAIN_VELOCITY_DEFINED 0xFFFFFFFFu

/* Channel: State. State of the channel. */
#define PASSO_CHANNEL_STATE                0x08u
#define PASSO_CHANNEL_STATE_STATE_LSB      0u
#define PASSO_CHANNEL_STATE_STATE_BITS     3u
#define PASSO_CHANNEL_STATE_STATE_RESET    0x0u
#define PASSO_CHANNEL_STATE_QUIET_LSB      3u
#define PASSO_CHANNEL_STATE_QUIET_BITS     1u
#define PASSO_CHANNEL_STATE_QUIET_RESET    0x1u
#define PASSO_CHANNEL_STATE_CAUSE_LSB      4u
#define PASSO_CHANNEL_STATE_CAUSE_BITS     4u
#define PASSO_CHANNEL_STATE_CAUSE_RESET    0x0u
#define PASSO_CHANNEL_STATE_OVERRUN_LSB    8u
#define PASSO_CHANNEL_STATE_OVERRUN_BITS   8u
#define PASSO_CHANNEL_STATE_OVERRUN_RESET  0x00u
#define PASSO_CHANNEL_STATE_STOPPING_LSB   16u
#define PASSO_CHANNEL_STATE_STOPPING_BITS  1u
#define PASSO_CHANNEL_STATE_STOPPING_RESET 0x0u
#define PASSO_CHANNEL_STATE_DRAINED_LSB    17u
#define PASSO_CHANNEL_STATE_DRAINED_BITS   15u
#define PASSO_CHANNEL_STATE_DRAINED_RESET  0x0000u

/* Channel: Rate. Time scale in force. */
#define PASSO_CHANNEL_RATE       0x09u
#define PASSO_CHANNEL_RATE_LSB   0u
#define PASSO_CHANNEL_RATE_BITS  17u
#define PASSO_CHANNEL_RATE_RESET 0x10000u

/* Channel: Room. Free places in the queues. A push counts from the moment its frame is accepted. */
#define PASSO_CHANNEL_ROOM                0x0Au
#define PASSO_CHANNEL_ROOM_RAMP_ROOM_LSB  0u
#define PASSO_CHANNEL_ROOM_RAMP_ROOM_BITS 16u
#define PASSO_CHANNEL_ROOM_LINE_ROOM_LSB  16u
#define PASSO_CHANNEL_ROOM_LINE_ROOM_BITS 16u

/* Channel: Velocity. Velocity of the present tick, before the time scale. */
#define PASSO_CHANNEL_VELOCITY       0x0Bu
#define PASSO_CHANNEL_VELOCITY_LSB   0u
#define PASSO_CHANNEL_VELOCITY_BITS  32u
#define PASSO_CHANNEL_VELOCITY_RESET 0x00000000u

/* Channel: Input levels. Filtered levels, 1 = active, one bit per axis. */
#define PASSO_CHANNEL_INPUT_LEVELS                  0x10u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_LOW_LSB    0u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_LOW_BITS   8u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_LOW_RESET  0x00u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_HIGH_LSB   8u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_HIGH_BITS  8u
#define PASSO_CHANNEL_INPUT_LEVELS_LIMIT_HIGH_RESET 0x00u
#define PASSO_CHANNEL_INPUT_LEVELS_HOME_LSB         16u
#define PASSO_CHANNEL_INPUT_LEVELS_HOME_BITS        8u
#define PASSO_CHANNEL_INPUT_LEVELS_HOME_RESET       0x00u
#define PASSO_CHANNEL_INPUT_LEVELS_ALARM_LSB        24u
#define PASSO_CHANNEL_INPUT_LEVELS_ALARM_BITS       8u
#define PASSO_CHANNEL_INPUT_LEVELS_ALARM_RESET      0x00u

/* Channel: Input flags. Inputs that were active since their flag was cleared, one bit per axis. */
#define PASSO_CHANNEL_INPUT_FLAGS                  0x11u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_LOW_LSB    0u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_LOW_BITS   8u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_LOW_RESET  0x00u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_HIGH_LSB   8u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_HIGH_BITS  8u
#define PASSO_CHANNEL_INPUT_FLAGS_LIMIT_HIGH_RESET 0x00u
#define PASSO_CHANNEL_INPUT_FLAGS_HOME_LSB         16u
#define PASSO_CHANNEL_INPUT_FLAGS_HOME_BITS        8u
#define PASSO_CHANNEL_INPUT_FLAGS_HOME_RESET       0x00u
#define PASSO_CHANNEL_INPUT_FLAGS_ALARM_LSB        24u
#define PASSO_CHANNEL_INPUT_FLAGS_ALARM_BITS       8u
#define PASSO_CHANNEL_INPUT_FLAGS_ALARM_RESET      0x00u

/* Channel: Clear input flags. Each bit written as 1 clears a flag of INPUT_FLAGS; bits of axes that the
 * core lacks do nothing. */
#define PASSO_CHANNEL_INPUT_CLEAR                  0x12u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_LOW_LSB    0u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_LOW_BITS   8u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_LOW_RESET  0x00u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_HIGH_LSB   8u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_HIGH_BITS  8u
#define PASSO_CHANNEL_INPUT_CLEAR_LIMIT_HIGH_RESET 0x00u
#define PASSO_CHANNEL_INPUT_CLEAR_HOME_LSB         16u
#define PASSO_CHANNEL_INPUT_CLEAR_HOME_BITS        8u
#define PASSO_CHANNEL_INPUT_CLEAR_HOME_RESET       0x00u
#define PASSO_CHANNEL_INPUT_CLEAR_ALARM_LSB        24u
#define PASSO_CHANNEL_INPUT_CLEAR_ALARM_BITS       8u
#define PASSO_CHANNEL_INPUT_CLEAR_ALARM_RESET      0x00u
#define PASSO_CHANNEL_INPUT_CLEAR_DEFINED          0xFFFFFFFFu

/* Channel: Trigger. Every write ends what was armed before. */
#define PASSO_CHANNEL_TRIGGER               0x13u
#define PASSO_CHANNEL_TRIGGER_SOURCE_LSB    0u
#define PASSO_CHANNEL_TRIGGER_SOURCE_BITS   3u
#define PASSO_CHANNEL_TRIGGER_SOURCE_RESET  0x0u
#define PASSO_CHANNEL_TRIGGER_AXIS_LSB      4u
#define PASSO_CHANNEL_TRIGGER_AXIS_BITS     3u
#define PASSO_CHANNEL_TRIGGER_AXIS_RESET    0x0u
#define PASSO_CHANNEL_TRIGGER_FALLING_LSB   8u
#define PASSO_CHANNEL_TRIGGER_FALLING_BITS  1u
#define PASSO_CHANNEL_TRIGGER_FALLING_RESET 0x0u
#define PASSO_CHANNEL_TRIGGER_ACTION_LSB    12u
#define PASSO_CHANNEL_TRIGGER_ACTION_BITS   2u
#define PASSO_CHANNEL_TRIGGER_ACTION_RESET  0x0u
#define PASSO_CHANNEL_TRIGGER_ARM_LSB       16u
#define PASSO_CHANNEL_TRIGGER_ARM_BITS      1u
#define PASSO_CHANNEL_TRIGGER_ARM_RESET     0x0u
#define PASSO_CHANNEL_TRIGGER_DEFINED       0x00013177u

/* Channel: Trigger state. State of the trigger and the probe, and the axes that stopped the channel. */
#define PASSO_CHANNEL_TRIGGER_STATE                     0x14u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMED_LSB           0u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMED_BITS          1u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMED_RESET         0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_FIRED_LSB           1u
#define PASSO_CHANNEL_TRIGGER_STATE_FIRED_BITS          1u
#define PASSO_CHANNEL_TRIGGER_STATE_FIRED_RESET         0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_LSB           2u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_BITS          1u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_RESET         0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_FLAG_LSB      3u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_FLAG_BITS     1u
#define PASSO_CHANNEL_TRIGGER_STATE_PROBE_FLAG_RESET    0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMING_LSB          4u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMING_BITS         1u
#define PASSO_CHANNEL_TRIGGER_STATE_ARMING_RESET        0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_LSB   5u
#define PASSO_CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_BITS  1u
#define PASSO_CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_RESET 0x0u
#define PASSO_CHANNEL_TRIGGER_STATE_UNKNOWN_LSB         6u
#define PASSO_CHANNEL_TRIGGER_STATE_UNKNOWN_BITS        1u
#define PASSO_CHANNEL_TRIGGER_STATE_AXES_LSB            8u
#define PASSO_CHANNEL_TRIGGER_STATE_AXES_BITS           8u
#define PASSO_CHANNEL_TRIGGER_STATE_AXES_RESET          0x00u

/* Channel: Probe. Polarity, after a change of which the inputs are unknown; and the flag of the probe. */
#define PASSO_CHANNEL_PROBE                0x15u
#define PASSO_CHANNEL_PROBE_INVERTED_LSB   0u
#define PASSO_CHANNEL_PROBE_INVERTED_BITS  1u
#define PASSO_CHANNEL_PROBE_INVERTED_RESET 0x0u
#define PASSO_CHANNEL_PROBE_CLEAR_LSB      1u
#define PASSO_CHANNEL_PROBE_CLEAR_BITS     1u
#define PASSO_CHANNEL_PROBE_CLEAR_RESET    0x0u
#define PASSO_CHANNEL_PROBE_DEFINED        0x00000003u

/* Channel: Line queue. Control, M, N_0 .. N_{AXES-1} for each line, and with OUTPUTS its output word. */
#define PASSO_CHANNEL_LINE         0x20u
#define PASSO_CHANNEL_LINE_LSB     0u
#define PASSO_CHANNEL_LINE_BITS    32u
#define PASSO_CHANNEL_LINE_DEFINED 0xFFFFFFFFu

/* Channel: Ramp queue. 5 words for each ramp: v_end(47:32) (31:16) and LAST (0), NOW (1), mirror (2), shape
 * (5:4); v_end(31:0); T; du(47:32); du(31:0). */
#define PASSO_CHANNEL_RAMP         0x21u
#define PASSO_CHANNEL_RAMP_LSB     0u
#define PASSO_CHANNEL_RAMP_BITS    32u
#define PASSO_CHANNEL_RAMP_DEFINED 0xFFFFFFFFu

/* Channel: Raster queue. Four values to a word, the lowest byte first. A raster line begins with a whole
 * word. */
#define PASSO_CHANNEL_RASTER         0x22u
#define PASSO_CHANNEL_RASTER_LSB     0u
#define PASSO_CHANNEL_RASTER_BITS    32u
#define PASSO_CHANNEL_RASTER_DEFINED 0xFFFFFFFFu

/* Channel: Output levels. Sets the digital outputs immediately, until a line changes them. */
#define PASSO_CHANNEL_OUTPUT_LEVELS              0x30u
#define PASSO_CHANNEL_OUTPUT_LEVELS_LEVELS_LSB   0u
#define PASSO_CHANNEL_OUTPUT_LEVELS_LEVELS_BITS  8u
#define PASSO_CHANNEL_OUTPUT_LEVELS_LEVELS_RESET 0x00u
#define PASSO_CHANNEL_OUTPUT_LEVELS_DEFINED      0x000000FFu

/* Channel: Output lag. Delay of the outputs of lines. */
#define PASSO_CHANNEL_OUTPUT_LAG           0x31u
#define PASSO_CHANNEL_OUTPUT_LAG_LAG_LSB   0u
#define PASSO_CHANNEL_OUTPUT_LAG_LAG_BITS  16u
#define PASSO_CHANNEL_OUTPUT_LAG_LAG_RESET 0x0000u
#define PASSO_CHANNEL_OUTPUT_LAG_DEFINED   0x0000FFFFu

/* Channel: PWM step. Frequency of the power pin. */
#define PASSO_CHANNEL_PWM_STEP         0x32u
#define PASSO_CHANNEL_PWM_STEP_LSB     0u
#define PASSO_CHANNEL_PWM_STEP_BITS    24u
#define PASSO_CHANNEL_PWM_STEP_RESET   0x001000u
#define PASSO_CHANNEL_PWM_STEP_DEFINED 0x00FFFFFFu

/* Channel: Power reference. Velocity at which a power in proportion to the velocity is the one of the line;
 * above it, it stays that. */
#define PASSO_CHANNEL_POWER_REFERENCE         0x33u
#define PASSO_CHANNEL_POWER_REFERENCE_LSB     0u
#define PASSO_CHANNEL_POWER_REFERENCE_BITS    32u
#define PASSO_CHANNEL_POWER_REFERENCE_RESET   0x80000000u
#define PASSO_CHANNEL_POWER_REFERENCE_DEFINED 0xFFFFFFFFu

/* Channel: Raster pitch. Substeps from one value of a raster line to the next; counts from the next value
 * on. */
#define PASSO_CHANNEL_RASTER_PITCH             0x34u
#define PASSO_CHANNEL_RASTER_PITCH_PITCH_LSB   0u
#define PASSO_CHANNEL_RASTER_PITCH_PITCH_BITS  30u
#define PASSO_CHANNEL_RASTER_PITCH_PITCH_RESET 0x00000001u
#define PASSO_CHANNEL_RASTER_PITCH_DEFINED     0x3FFFFFFFu

/* Channel: Compare pulse. Ends a pulse in progress, as COMPARE_DISTANCE does. */
#define PASSO_CHANNEL_COMPARE_PULSE             0x35u
#define PASSO_CHANNEL_COMPARE_PULSE_WIDTH_LSB   0u
#define PASSO_CHANNEL_COMPARE_PULSE_WIDTH_BITS  16u
#define PASSO_CHANNEL_COMPARE_PULSE_WIDTH_RESET 0x0000u
#define PASSO_CHANNEL_COMPARE_PULSE_AXIS_LSB    16u
#define PASSO_CHANNEL_COMPARE_PULSE_AXIS_BITS   3u
#define PASSO_CHANNEL_COMPARE_PULSE_AXIS_RESET  0x0u
#define PASSO_CHANNEL_COMPARE_PULSE_DEFINED     0x0007FFFFu

/* Channel: Compare distance. Where the first pulse comes. */
#define PASSO_CHANNEL_COMPARE_DISTANCE                0x36u
#define PASSO_CHANNEL_COMPARE_DISTANCE_DISTANCE_LSB   0u
#define PASSO_CHANNEL_COMPARE_DISTANCE_DISTANCE_BITS  32u
#define PASSO_CHANNEL_COMPARE_DISTANCE_DISTANCE_RESET 0x00000000u
#define PASSO_CHANNEL_COMPARE_DISTANCE_DEFINED        0xFFFFFFFFu

/* Channel: Compare interval. Counts from the next pulse on. */
#define PASSO_CHANNEL_COMPARE_INTERVAL                0x37u
#define PASSO_CHANNEL_COMPARE_INTERVAL_INTERVAL_LSB   0u
#define PASSO_CHANNEL_COMPARE_INTERVAL_INTERVAL_BITS  32u
#define PASSO_CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET 0x00000001u
#define PASSO_CHANNEL_COMPARE_INTERVAL_DEFINED        0xFFFFFFFFu

/* Channel: Output state. State of the outputs. */
#define PASSO_CHANNEL_OUTPUT_STATE                    0x38u
#define PASSO_CHANNEL_OUTPUT_STATE_LEVELS_LSB         0u
#define PASSO_CHANNEL_OUTPUT_STATE_LEVELS_BITS        8u
#define PASSO_CHANNEL_OUTPUT_STATE_LEVELS_RESET       0x00u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB   8u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_EMPTY_BITS  1u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_EMPTY_RESET 0x0u
#define PASSO_CHANNEL_OUTPUT_STATE_OVERFLOW_LSB       9u
#define PASSO_CHANNEL_OUTPUT_STATE_OVERFLOW_BITS      1u
#define PASSO_CHANNEL_OUTPUT_STATE_OVERFLOW_RESET     0x0u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_ROOM_LSB    16u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_ROOM_BITS   16u
#define PASSO_CHANNEL_OUTPUT_STATE_RASTER_ROOM_RESET  0x0100u

/* Channel: Steps made. Position of an axis in steps, sampled soon after chip select fell; wraps. */
#define PASSO_CHANNEL_POSITION_BASE  0x40u
#define PASSO_CHANNEL_POSITION_COUNT 8u
#define PASSO_CHANNEL_POSITION_LSB   0u
#define PASSO_CHANNEL_POSITION_BITS  32u
#define PASSO_CHANNEL_POSITION_RESET 0x00000000u

/* Channel: Latched position. Position of an axis in steps on the clock on which the trigger fired, complete
 * 130 clocks later. A ZERO less than 64 clocks after that clears it. */
#define PASSO_CHANNEL_TRIGGER_POSITION_BASE           0x48u
#define PASSO_CHANNEL_TRIGGER_POSITION_COUNT          8u
#define PASSO_CHANNEL_TRIGGER_POSITION_POSITION_LSB   0u
#define PASSO_CHANNEL_TRIGGER_POSITION_POSITION_BITS  32u
#define PASSO_CHANNEL_TRIGGER_POSITION_POSITION_RESET 0x00000000u

/* Channel: Encoder position. Counts of the encoder of an axis, sampled on the clock of its position; wraps. */
#define PASSO_CHANNEL_ENCODER_POSITION_BASE           0x50u
#define PASSO_CHANNEL_ENCODER_POSITION_COUNT          8u
#define PASSO_CHANNEL_ENCODER_POSITION_POSITION_LSB   0u
#define PASSO_CHANNEL_ENCODER_POSITION_POSITION_BITS  32u
#define PASSO_CHANNEL_ENCODER_POSITION_POSITION_RESET 0x00000000u

/* Channel: Follow. Whether and how the profile follows an encoder. */
#define PASSO_CHANNEL_FOLLOW                  0x60u
#define PASSO_CHANNEL_FOLLOW_FOLLOW_LSB       0u
#define PASSO_CHANNEL_FOLLOW_FOLLOW_BITS      1u
#define PASSO_CHANNEL_FOLLOW_FOLLOW_RESET     0x0u
#define PASSO_CHANNEL_FOLLOW_WAIT_INDEX_LSB   1u
#define PASSO_CHANNEL_FOLLOW_WAIT_INDEX_BITS  1u
#define PASSO_CHANNEL_FOLLOW_WAIT_INDEX_RESET 0x0u
#define PASSO_CHANNEL_FOLLOW_SOURCE_LSB       2u
#define PASSO_CHANNEL_FOLLOW_SOURCE_BITS      3u
#define PASSO_CHANNEL_FOLLOW_SOURCE_RESET     0x0u
#define PASSO_CHANNEL_FOLLOW_SCALE_LSB        5u
#define PASSO_CHANNEL_FOLLOW_SCALE_BITS       3u
#define PASSO_CHANNEL_FOLLOW_SCALE_RESET      0x0u
#define PASSO_CHANNEL_FOLLOW_DEFINED          0x000000FFu

/* Channel: Follow limit. What is owed to the encoder is made at no more than this. */
#define PASSO_CHANNEL_FOLLOW_LIMIT             0x61u
#define PASSO_CHANNEL_FOLLOW_LIMIT_LIMIT_LSB   0u
#define PASSO_CHANNEL_FOLLOW_LIMIT_LIMIT_BITS  32u
#define PASSO_CHANNEL_FOLLOW_LIMIT_LIMIT_RESET 0x01000000u
#define PASSO_CHANNEL_FOLLOW_LIMIT_DEFINED     0xFFFFFFFFu

/* Channel: Encoder filter. Glitch filter of all encoders of the channel. */
#define PASSO_CHANNEL_ENCODER_FILTER              0x62u
#define PASSO_CHANNEL_ENCODER_FILTER_FILTER_LSB   0u
#define PASSO_CHANNEL_ENCODER_FILTER_FILTER_BITS  8u
#define PASSO_CHANNEL_ENCODER_FILTER_FILTER_RESET 0x03u
#define PASSO_CHANNEL_ENCODER_FILTER_DEFINED      0x000000FFu

/* Channel: Follow state. Of the motion that runs; behind and lost, of the last one, until the next is
 * prepared. */
#define PASSO_CHANNEL_FOLLOW_STATE              0x63u
#define PASSO_CHANNEL_FOLLOW_STATE_OWED_LSB     0u
#define PASSO_CHANNEL_FOLLOW_STATE_OWED_BITS    24u
#define PASSO_CHANNEL_FOLLOW_STATE_OWED_RESET   0x000000u
#define PASSO_CHANNEL_FOLLOW_STATE_BEHIND_LSB   24u
#define PASSO_CHANNEL_FOLLOW_STATE_BEHIND_BITS  1u
#define PASSO_CHANNEL_FOLLOW_STATE_BEHIND_RESET 0x0u
#define PASSO_CHANNEL_FOLLOW_STATE_LOST_LSB     25u
#define PASSO_CHANNEL_FOLLOW_STATE_LOST_BITS    1u
#define PASSO_CHANNEL_FOLLOW_STATE_LOST_RESET   0x0u

/* Channel: Tracker enable. One bit per axis. A stop of any cause and ZERO clear them; bits of axes that the
 * core lacks do nothing. */
#define PASSO_CHANNEL_TRACKER_ENABLE              0x64u
#define PASSO_CHANNEL_TRACKER_ENABLE_ENABLE_LSB   0u
#define PASSO_CHANNEL_TRACKER_ENABLE_ENABLE_BITS  8u
#define PASSO_CHANNEL_TRACKER_ENABLE_ENABLE_RESET 0x00u
#define PASSO_CHANNEL_TRACKER_ENABLE_DEFINED      0x000000FFu

/* Channel: Tracker state. One bit per axis. */
#define PASSO_CHANNEL_TRACKER_STATE                0x65u
#define PASSO_CHANNEL_TRACKER_STATE_ENABLED_LSB    0u
#define PASSO_CHANNEL_TRACKER_STATE_ENABLED_BITS   8u
#define PASSO_CHANNEL_TRACKER_STATE_ENABLED_RESET  0x00u
#define PASSO_CHANNEL_TRACKER_STATE_MOVES_LSB      8u
#define PASSO_CHANNEL_TRACKER_STATE_MOVES_BITS     8u
#define PASSO_CHANNEL_TRACKER_STATE_MOVES_RESET    0x00u
#define PASSO_CHANNEL_TRACKER_STATE_AT_TARGET_LSB  16u
#define PASSO_CHANNEL_TRACKER_STATE_AT_TARGET_BITS 8u

/* Channel: Tracker position. Steps of an axis that are due to its tracker, rounded down while it moves;
 * wraps. A hard stop may drop up to 7 of them. */
#define PASSO_CHANNEL_TRACKER_POSITION_BASE           0x68u
#define PASSO_CHANNEL_TRACKER_POSITION_COUNT          8u
#define PASSO_CHANNEL_TRACKER_POSITION_POSITION_LSB   0u
#define PASSO_CHANNEL_TRACKER_POSITION_POSITION_BITS  32u
#define PASSO_CHANNEL_TRACKER_POSITION_POSITION_RESET 0x00000000u

/* Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
 * moved the axis went up, or none did, the second one while it went down. Their difference is the backlash. */
#define PASSO_CHANNEL_TRACKER_TARGET_BASE         0x70u
#define PASSO_CHANNEL_TRACKER_TARGET_COUNT        8u
#define PASSO_CHANNEL_TRACKER_TARGET_TARGET_LSB   0u
#define PASSO_CHANNEL_TRACKER_TARGET_TARGET_BITS  32u
#define PASSO_CHANNEL_TRACKER_TARGET_TARGET_RESET 0x00000000u
#define PASSO_CHANNEL_TRACKER_TARGET_DEFINED      0xFFFFFFFFu

/* Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
 * moved the axis went up, or none did, the second one while it went down. Their difference is the backlash. */
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_BASE         0x78u
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_COUNT        8u
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_TARGET_LSB   0u
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_TARGET_BITS  32u
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_TARGET_RESET 0x00000000u
#define PASSO_CHANNEL_TRACKER_TARGET_DOWN_DEFINED      0xFFFFFFFFu

/* Channel: where each axis has its registers. */
#define PASSO_CHANNEL_AXIS_BASE   0x80u
#define PASSO_CHANNEL_AXIS_COUNT  8u
#define PASSO_CHANNEL_AXIS_STRIDE 0x08u

/* Channel: where each encoder has its registers. */
#define PASSO_CHANNEL_ENCODER_BASE   0xC0u
#define PASSO_CHANNEL_ENCODER_COUNT  8u
#define PASSO_CHANNEL_ENCODER_STRIDE 0x08u

/* Axis: Pins. Polarities and step mode. From the write on, the next step waits for the low time, the DIR
 * hold and the DIR setup. */
#define PASSO_AXIS_PINS                          0x0u
#define PASSO_AXIS_PINS_STEP_INVERTED_LSB        1u
#define PASSO_AXIS_PINS_STEP_INVERTED_BITS       1u
#define PASSO_AXIS_PINS_STEP_INVERTED_RESET      0x0u
#define PASSO_AXIS_PINS_DIRECTION_INVERTED_LSB   2u
#define PASSO_AXIS_PINS_DIRECTION_INVERTED_BITS  1u
#define PASSO_AXIS_PINS_DIRECTION_INVERTED_RESET 0x0u
#define PASSO_AXIS_PINS_ENABLE_INVERTED_LSB      3u
#define PASSO_AXIS_PINS_ENABLE_INVERTED_BITS     1u
#define PASSO_AXIS_PINS_ENABLE_INVERTED_RESET    0x0u
#define PASSO_AXIS_PINS_BOTH_EDGES_LSB           4u
#define PASSO_AXIS_PINS_BOTH_EDGES_BITS          1u
#define PASSO_AXIS_PINS_BOTH_EDGES_RESET         0x0u
#define PASSO_AXIS_PINS_DEFINED                  0x0000001Eu

/* Axis: STEP timing. Clocks, 1 .. 65535; 0 counts as 1. */
#define PASSO_AXIS_STEP_TIMING                 0x1u
#define PASSO_AXIS_STEP_TIMING_STEP_LOW_LSB    0u
#define PASSO_AXIS_STEP_TIMING_STEP_LOW_BITS   16u
#define PASSO_AXIS_STEP_TIMING_STEP_LOW_RESET  0x0001u
#define PASSO_AXIS_STEP_TIMING_STEP_HIGH_LSB   16u
#define PASSO_AXIS_STEP_TIMING_STEP_HIGH_BITS  16u
#define PASSO_AXIS_STEP_TIMING_STEP_HIGH_RESET 0x0001u
#define PASSO_AXIS_STEP_TIMING_DEFINED         0xFFFFFFFFu

/* Axis: DIR timing. Clocks, 1 .. 65535; 0 counts as 1. */
#define PASSO_AXIS_DIR_TIMING                 0x2u
#define PASSO_AXIS_DIR_TIMING_DIR_HOLD_LSB    0u
#define PASSO_AXIS_DIR_TIMING_DIR_HOLD_BITS   16u
#define PASSO_AXIS_DIR_TIMING_DIR_HOLD_RESET  0x0001u
#define PASSO_AXIS_DIR_TIMING_DIR_SETUP_LSB   16u
#define PASSO_AXIS_DIR_TIMING_DIR_SETUP_BITS  16u
#define PASSO_AXIS_DIR_TIMING_DIR_SETUP_RESET 0x0001u
#define PASSO_AXIS_DIR_TIMING_DEFINED         0xFFFFFFFFu

/* Axis: Lost steps. Steps lost because the queue of the axis was full (STEP_OVERRUN). */
#define PASSO_AXIS_LOST_STEPS            0x3u
#define PASSO_AXIS_LOST_STEPS_LOST_LSB   0u
#define PASSO_AXIS_LOST_STEPS_LOST_BITS  4u
#define PASSO_AXIS_LOST_STEPS_LOST_RESET 0x0u

/* Axis: Drive enable. Enables the drive of the axis. */
#define PASSO_AXIS_ENABLE         0x4u
#define PASSO_AXIS_ENABLE_LSB     0u
#define PASSO_AXIS_ENABLE_BITS    1u
#define PASSO_AXIS_ENABLE_RESET   0x0u
#define PASSO_AXIS_ENABLE_DEFINED 0x00000001u

/* Axis: Inputs of the axis. Polarities, and what limits and alarm do. After a write the inputs are unknown. */
#define PASSO_AXIS_INPUTS                           0x5u
#define PASSO_AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB    0u
#define PASSO_AXIS_INPUTS_LIMIT_LOW_INVERTED_BITS   1u
#define PASSO_AXIS_INPUTS_LIMIT_LOW_INVERTED_RESET  0x0u
#define PASSO_AXIS_INPUTS_LIMIT_HIGH_INVERTED_LSB   1u
#define PASSO_AXIS_INPUTS_LIMIT_HIGH_INVERTED_BITS  1u
#define PASSO_AXIS_INPUTS_LIMIT_HIGH_INVERTED_RESET 0x0u
#define PASSO_AXIS_INPUTS_HOME_INVERTED_LSB         2u
#define PASSO_AXIS_INPUTS_HOME_INVERTED_BITS        1u
#define PASSO_AXIS_INPUTS_HOME_INVERTED_RESET       0x0u
#define PASSO_AXIS_INPUTS_ALARM_INVERTED_LSB        3u
#define PASSO_AXIS_INPUTS_ALARM_INVERTED_BITS       1u
#define PASSO_AXIS_INPUTS_ALARM_INVERTED_RESET      0x0u
#define PASSO_AXIS_INPUTS_LIMIT_SOFT_LSB            4u
#define PASSO_AXIS_INPUTS_LIMIT_SOFT_BITS           1u
#define PASSO_AXIS_INPUTS_LIMIT_SOFT_RESET          0x0u
#define PASSO_AXIS_INPUTS_ALARM_SOFT_LSB            5u
#define PASSO_AXIS_INPUTS_ALARM_SOFT_BITS           1u
#define PASSO_AXIS_INPUTS_ALARM_SOFT_RESET          0x0u
#define PASSO_AXIS_INPUTS_ALARM_DISABLES_LSB        6u
#define PASSO_AXIS_INPUTS_ALARM_DISABLES_BITS       1u
#define PASSO_AXIS_INPUTS_ALARM_DISABLES_RESET      0x0u
#define PASSO_AXIS_INPUTS_DEFINED                   0x0000007Fu

/* Axis: Speed of the tracker. The tracker moves no faster. Below its acceleration it does not move. */
#define PASSO_AXIS_TRACKER_SPEED             0x6u
#define PASSO_AXIS_TRACKER_SPEED_SPEED_LSB   0u
#define PASSO_AXIS_TRACKER_SPEED_SPEED_BITS  32u
#define PASSO_AXIS_TRACKER_SPEED_SPEED_RESET 0x00000000u
#define PASSO_AXIS_TRACKER_SPEED_DEFINED     0xFFFFFFFFu

/* Axis: Acceleration of the tracker. Greatest change of its speed from one tick to the next. */
#define PASSO_AXIS_TRACKER_ACCELERATION                    0x7u
#define PASSO_AXIS_TRACKER_ACCELERATION_ACCELERATION_LSB   0u
#define PASSO_AXIS_TRACKER_ACCELERATION_ACCELERATION_BITS  32u
#define PASSO_AXIS_TRACKER_ACCELERATION_ACCELERATION_RESET 0x00000000u
#define PASSO_AXIS_TRACKER_ACCELERATION_DEFINED            0xFFFFFFFFu

/* Encoder: Encoder setup. How the encoder counts, and what a following error does. */
#define PASSO_ENCODER_SETUP                      0x0u
#define PASSO_ENCODER_SETUP_INVERTED_LSB         0u
#define PASSO_ENCODER_SETUP_INVERTED_BITS        1u
#define PASSO_ENCODER_SETUP_INVERTED_RESET       0x0u
#define PASSO_ENCODER_SETUP_INDEX_INVERTED_LSB   1u
#define PASSO_ENCODER_SETUP_INDEX_INVERTED_BITS  1u
#define PASSO_ENCODER_SETUP_INDEX_INVERTED_RESET 0x0u
#define PASSO_ENCODER_SETUP_INDEX_GATED_LSB      2u
#define PASSO_ENCODER_SETUP_INDEX_GATED_BITS     1u
#define PASSO_ENCODER_SETUP_INDEX_GATED_RESET    0x0u
#define PASSO_ENCODER_SETUP_STOP_SOFT_LSB        3u
#define PASSO_ENCODER_SETUP_STOP_SOFT_BITS       1u
#define PASSO_ENCODER_SETUP_STOP_SOFT_RESET      0x0u
#define PASSO_ENCODER_SETUP_STOP_HARD_LSB        4u
#define PASSO_ENCODER_SETUP_STOP_HARD_BITS       1u
#define PASSO_ENCODER_SETUP_STOP_HARD_RESET      0x0u
#define PASSO_ENCODER_SETUP_DEFINED              0x0000001Fu

/* Encoder: Encoder ratio. Counts per step. A write sets the following error to 0. */
#define PASSO_ENCODER_RATIO         0x1u
#define PASSO_ENCODER_RATIO_LSB     0u
#define PASSO_ENCODER_RATIO_BITS    32u
#define PASSO_ENCODER_RATIO_RESET   0x00010000u
#define PASSO_ENCODER_RATIO_DEFINED 0xFFFFFFFFu

/* Encoder: Following error limit. Following error at which the limit is exceeded. */
#define PASSO_ENCODER_LIMIT         0x2u
#define PASSO_ENCODER_LIMIT_LSB     0u
#define PASSO_ENCODER_LIMIT_BITS    16u
#define PASSO_ENCODER_LIMIT_RESET   0xFFFFu
#define PASSO_ENCODER_LIMIT_DEFINED 0x0000FFFFu

/* Encoder: Following error. Position times ratio less encoder position, both as they were set to 0 by
 * COMMAND.ZERO or a write of the ratio. */
#define PASSO_ENCODER_ERROR       0x3u
#define PASSO_ENCODER_ERROR_LSB   0u
#define PASSO_ENCODER_ERROR_BITS  32u
#define PASSO_ENCODER_ERROR_RESET 0x00000000u

/* Encoder: Greatest following error. Since COMMAND.ZERO, COMMAND.CLEAR or a write of the ratio. */
#define PASSO_ENCODER_GREATEST                0x4u
#define PASSO_ENCODER_GREATEST_GREATEST_LSB   0u
#define PASSO_ENCODER_GREATEST_GREATEST_BITS  18u
#define PASSO_ENCODER_GREATEST_GREATEST_RESET 0x00000u
#define PASSO_ENCODER_GREATEST_EXCEEDED_LSB   31u
#define PASSO_ENCODER_GREATEST_EXCEEDED_BITS  1u
#define PASSO_ENCODER_GREATEST_EXCEEDED_RESET 0x0u

/* Encoder: Encoder index. What the index has latched, and the transitions that were none. All 0 after
 * COMMAND.ZERO. */
#define PASSO_ENCODER_INDEX               0x5u
#define PASSO_ENCODER_INDEX_LATCH_LSB     0u
#define PASSO_ENCODER_INDEX_LATCH_BITS    16u
#define PASSO_ENCODER_INDEX_LATCH_RESET   0x0000u
#define PASSO_ENCODER_INDEX_INDEXES_LSB   16u
#define PASSO_ENCODER_INDEX_INDEXES_BITS  8u
#define PASSO_ENCODER_INDEX_INDEXES_RESET 0x00u
#define PASSO_ENCODER_INDEX_ILLEGAL_LSB   24u
#define PASSO_ENCODER_INDEX_ILLEGAL_BITS  8u
#define PASSO_ENCODER_INDEX_ILLEGAL_RESET 0x00u

/* Operation of a frame. */
enum passo_operation {
	PASSO_OPERATION_READ  = 1, /* Read consecutive registers. */
	PASSO_OPERATION_WRITE = 2, /* Write consecutive registers. */
	PASSO_OPERATION_PUSH  = 3  /* Write every word to the same address: lines and ramps. */
};
#define PASSO_OPERATION_NAMES \
	{[1] = "READ", [2] = "WRITE", [3] = "PUSH"}

/* Outcome of a frame. */
enum passo_verdict {
	PASSO_VERDICT_OK              = 0, /* Executed. */
	PASSO_VERDICT_DUPLICATE       = 1, /* Not executed: its sequence number was accepted before. */
	PASSO_VERDICT_BAD_CRC         = 2, /* CRC wrong. */
	PASSO_VERDICT_BAD_LENGTH      = 3, /* Length 0 or above 60, or not whole lines or ramps. */
	PASSO_VERDICT_BAD_OPERATION   = 4, /* Unknown operation, or one the register does not take. */
	PASSO_VERDICT_UNKNOWN_ADDRESS = 5, /* No register at this address. */
	PASSO_VERDICT_READ_ONLY       = 6, /* The register cannot be written. */
	PASSO_VERDICT_QUEUE_FULL      = 7, /* Not enough room for the whole frame. */
	PASSO_VERDICT_BUSY            = 8, /* The state of the channel does not allow it (see the register). */
	PASSO_VERDICT_BAD_VALUE       = 9  /* The register does not take the value, or an undefined bit is set (see the register). */
};
#define PASSO_VERDICT_NAMES \
	{[0] = "OK", [1] = "DUPLICATE", [2] = "BAD_CRC", [3] = "BAD_LENGTH", [4] = "BAD_OPERATION", \
	 [5] = "UNKNOWN_ADDRESS", [6] = "READ_ONLY", [7] = "QUEUE_FULL", [8] = "BUSY", [9] = \
	 "BAD_VALUE"}

/* State of a channel. */
enum passo_state {
	PASSO_STATE_IDLE    = 0, /* No motion. */
	PASSO_STATE_PREPARE = 1, /* First line and first velocity are being prepared. */
	PASSO_STATE_ARMED   = 2, /* Ready to start; waits while WAIT_SYNC is set. */
	PASSO_STATE_RUN     = 3, /* The profile runs. */
	PASSO_STATE_SETTLE  = 4, /* The profile has ended; its last substeps travel to the pins. */
	PASSO_STATE_DRAIN   = 5, /* Missing substeps of the LAST line are made at drain_velocity. */
	PASSO_STATE_STOPPED = 6  /* Stopped by a command or a fault; queues flushed. CLEAR leads back to IDLE. */
};
#define PASSO_STATE_NAMES \
	{[0] = "IDLE", [1] = "PREPARE", [2] = "ARMED", [3] = "RUN", [4] = "SETTLE", [5] = "DRAIN", \
	 [6] = "STOPPED"}

/* Why a channel has stopped. */
enum passo_cause {
	PASSO_CAUSE_NONE            = 0,  /* Not stopped. */
	PASSO_CAUSE_STOP            = 1,  /* COMMAND.STOP. */
	PASSO_CAUSE_ABORT           = 2,  /* COMMAND.ABORT. */
	PASSO_CAUSE_LINE_UNDERRUN   = 3,  /* A line ended, was not LAST, and none followed. */
	PASSO_CAUSE_RAMP_UNDERRUN   = 4,  /* The ramps ran out at speed. */
	PASSO_CAUSE_STEP_OVERRUN    = 5,  /* Steps came faster than the pin timing of an axis allows. */
	PASSO_CAUSE_LIMIT           = 6,  /* An axis stepped toward an active limit switch. */
	PASSO_CAUSE_ALARM           = 7,  /* The alarm input of an axis became active. */
	PASSO_CAUSE_TRIGGER         = 8,  /* The trigger fired, and its action is a stop. */
	PASSO_CAUSE_WATCHDOG        = 9,  /* No good frame came for too long while a motion ran. */
	PASSO_CAUSE_ESTOP           = 10, /* The e-stop input became active. */
	PASSO_CAUSE_FOLLOWING_ERROR = 11  /* The following error of an axis exceeded its limit. */
};
#define PASSO_CAUSE_NAMES \
	{[0] = "NONE", [1] = "STOP", [2] = "ABORT", [3] = "LINE_UNDERRUN", [4] = "RAMP_UNDERRUN", \
	 [5] = "STEP_OVERRUN", [6] = "LIMIT", [7] = "ALARM", [8] = "TRIGGER", [9] = "WATCHDOG", \
	 [10] = "ESTOP", [11] = "FOLLOWING_ERROR"}

/* What fires the trigger of a channel. */
enum passo_trigger_source {
	PASSO_TRIGGER_SOURCE_NONE       = 0, /* None; cannot be armed. */
	PASSO_TRIGGER_SOURCE_LIMIT_LOW  = 1, /* Limit switch of the axis in negative direction. */
	PASSO_TRIGGER_SOURCE_LIMIT_HIGH = 2, /* Limit switch of the axis in positive direction. */
	PASSO_TRIGGER_SOURCE_HOME       = 3, /* Home switch of the axis. */
	PASSO_TRIGGER_SOURCE_PROBE      = 4, /* Probe of the channel. */
	PASSO_TRIGGER_SOURCE_INDEX      = 5  /* Index of the axis's encoder, as its setup says; never active without ENCODERS. */
};
#define PASSO_TRIGGER_SOURCE_NAMES \
	{[0] = "NONE", [1] = "LIMIT_LOW", [2] = "LIMIT_HIGH", [3] = "HOME", [4] = "PROBE", [5] = \
	 "INDEX"}

/* What the trigger does when it fires. */
enum passo_trigger_action {
	PASSO_TRIGGER_ACTION_LATCH       = 0, /* Only latch. */
	PASSO_TRIGGER_ACTION_SOFT_STOP   = 1, /* Latch and soft stop. */
	PASSO_TRIGGER_ACTION_HARD_STOP   = 2, /* Latch and hard stop. */
	PASSO_TRIGGER_ACTION_END_ENDLESS = 3  /* Latch, and let the current ENDLESS line end as any other line. */
};
#define PASSO_TRIGGER_ACTION_NAMES \
	{[0] = "LATCH", [1] = "SOFT_STOP", [2] = "HARD_STOP", [3] = "END_ENDLESS"}

/* Shape of a ramp: s as a function of the progress u, both 0 .. 1. */
enum passo_shape {
	PASSO_SHAPE_LINEAR  = 0, /* s = u, no table. */
	PASSO_SHAPE_COSINE  = 1, /* (1 - cos(pi u)) / 2. */
	PASSO_SHAPE_SIGMOID = 2, /* Logistic function over -5 .. 5, scaled to begin at 0 and end at 1. */
	PASSO_SHAPE_EASE    = 3  /* u^2. */
};
#define PASSO_SHAPE_NAMES \
	{[0] = "LINEAR", [1] = "COSINE", [2] = "SIGMOID", [3] = "EASE"}

#endif
