// SPDX-License-Identifier: MIT
// Generated from spec/passo.rdl by spec/generate_registers.py.
// Registers of Passo, to be included inside a module. Addresses are word addresses.

// Each module uses its share of these.
/* verilator lint_off UNUSEDPARAM */

// Word: Header. First word of a request.
localparam HEADER_ADDRESS_LSB    = 0;
localparam HEADER_ADDRESS_BITS   = 12;
localparam HEADER_LENGTH_LSB     = 12;
localparam HEADER_LENGTH_BITS    = 8;
localparam HEADER_SEQUENCE_LSB   = 20;
localparam HEADER_SEQUENCE_BITS  = 8;
localparam HEADER_OPERATION_LSB  = 28;
localparam HEADER_OPERATION_BITS = 4;
localparam HEADER_DEFINED        = 32'hFFFFFFFF;

// Word: Ack. Last word of the reply to a write or push, and to a refused read.
localparam ACK_NOT_VERDICT_LSB   = 0;
localparam ACK_NOT_VERDICT_BITS  = 8;
localparam ACK_NOT_SEQUENCE_LSB  = 8;
localparam ACK_NOT_SEQUENCE_BITS = 8;
localparam ACK_VERDICT_LSB       = 16;
localparam ACK_VERDICT_BITS      = 8;
localparam ACK_SEQUENCE_LSB      = 24;
localparam ACK_SEQUENCE_BITS     = 8;
localparam ACK_DEFINED           = 32'hFFFFFFFF;

// Word: Status. Sent in a reply before the ack or the data; sampled when chip select fell.
localparam STATUS_RAMP_ROOM_LSB     = 0;
localparam STATUS_RAMP_ROOM_BITS    = 8;
localparam STATUS_LINE_ROOM_LSB     = 8;
localparam STATUS_LINE_ROOM_BITS    = 8;
localparam STATUS_SEQUENCE_LSB      = 16;
localparam STATUS_SEQUENCE_BITS     = 8;
localparam STATUS_CHANNEL_LSB       = 24;
localparam STATUS_CHANNEL_BITS      = 3;
localparam STATUS_ZERO_LSB          = 27;
localparam STATUS_ZERO_BITS         = 1;
localparam STATUS_ZERO_RESET        = 1'h0;
localparam STATUS_ANY_OCCUPIED_LSB  = 28;
localparam STATUS_ANY_OCCUPIED_BITS = 1;
localparam STATUS_ANY_STOPPED_LSB   = 29;
localparam STATUS_ANY_STOPPED_BITS  = 1;
localparam STATUS_MARKER_LSB        = 30;
localparam STATUS_MARKER_BITS       = 2;
localparam STATUS_MARKER_RESET      = 2'h2;
localparam STATUS_DEFINED           = 32'hFFFFFFFF;

// Word: Line control. First word of a line; then M, N_0 .. N_{AXES-1} and, with OUTPUTS, its output.
localparam LINE_CONTROL_LAST_LSB        = 0;
localparam LINE_CONTROL_LAST_BITS       = 1;
localparam LINE_CONTROL_ENDLESS_LSB     = 1;
localparam LINE_CONTROL_ENDLESS_BITS    = 1;
localparam LINE_CONTROL_DIRECTIONS_LSB  = 8;
localparam LINE_CONTROL_DIRECTIONS_BITS = 8;
localparam LINE_CONTROL_DEFINED         = 32'h0000FF03;

// Word: Ramp control. First word of a ramp; then the lower bits of v_end, T, and the progress step in two
// words.
localparam RAMP_CONTROL_LAST_LSB           = 0;
localparam RAMP_CONTROL_LAST_BITS          = 1;
localparam RAMP_CONTROL_NOW_LSB            = 1;
localparam RAMP_CONTROL_NOW_BITS           = 1;
localparam RAMP_CONTROL_MIRROR_LSB         = 2;
localparam RAMP_CONTROL_MIRROR_BITS        = 1;
localparam RAMP_CONTROL_SHAPE_LSB          = 4;
localparam RAMP_CONTROL_SHAPE_BITS         = 2;
localparam RAMP_CONTROL_VELOCITY_HIGH_LSB  = 16;
localparam RAMP_CONTROL_VELOCITY_HIGH_BITS = 16;
localparam RAMP_CONTROL_DEFINED            = 32'hFFFF0037;

// Word: Line output. With OUTPUTS the last word of a line.
localparam LINE_OUTPUT_POWER_LSB         = 0;
localparam LINE_OUTPUT_POWER_BITS        = 16;
localparam LINE_OUTPUT_LEVELS_LSB        = 16;
localparam LINE_OUTPUT_LEVELS_BITS       = 8;
localparam LINE_OUTPUT_PROPORTIONAL_LSB  = 24;
localparam LINE_OUTPUT_PROPORTIONAL_BITS = 1;
localparam LINE_OUTPUT_RASTER_LSB        = 25;
localparam LINE_OUTPUT_RASTER_BITS       = 1;
localparam LINE_OUTPUT_DEFINED           = 32'h03FFFFFF;

// Core: Identification. Reads as ASCII PASO.
localparam ADDRESS_IDENTIFICATION = 12'h000;
localparam IDENTIFICATION_LSB     = 0;
localparam IDENTIFICATION_BITS    = 32;
localparam IDENTIFICATION_RESET   = 32'h5041534F;

// Core: Version. Version of the register map and the link. That of the release is in the file VERSION of
// the repository.
localparam ADDRESS_VERSION     = 12'h001;
localparam VERSION_PATCH_LSB   = 0;
localparam VERSION_PATCH_BITS  = 8;
localparam VERSION_PATCH_RESET = 8'h00;
localparam VERSION_MINOR_LSB   = 8;
localparam VERSION_MINOR_BITS  = 8;
localparam VERSION_MINOR_RESET = 8'h04;
localparam VERSION_MAJOR_LSB   = 16;
localparam VERSION_MAJOR_BITS  = 8;
localparam VERSION_MAJOR_RESET = 8'h00;

// Core: Parameters. How the core was built.
localparam ADDRESS_PARAMETERS              = 12'h002;
localparam PARAMETERS_CHANNELS_LSB         = 0;
localparam PARAMETERS_CHANNELS_BITS        = 4;
localparam PARAMETERS_AXES_LSB             = 4;
localparam PARAMETERS_AXES_BITS            = 4;
localparam PARAMETERS_TICK_LOG2_LSB        = 8;
localparam PARAMETERS_TICK_LOG2_BITS       = 5;
localparam PARAMETERS_RASTER_LSB           = 13;
localparam PARAMETERS_RASTER_BITS          = 1;
localparam PARAMETERS_COMPARE_LSB          = 14;
localparam PARAMETERS_COMPARE_BITS         = 1;
localparam PARAMETERS_TRACKERS_LSB         = 15;
localparam PARAMETERS_TRACKERS_BITS        = 1;
localparam PARAMETERS_LINE_QUEUE_LOG2_LSB  = 16;
localparam PARAMETERS_LINE_QUEUE_LOG2_BITS = 5;
localparam PARAMETERS_TRACKED_LSB          = 21;
localparam PARAMETERS_TRACKED_BITS         = 3;
localparam PARAMETERS_RAMP_QUEUE_LOG2_LSB  = 24;
localparam PARAMETERS_RAMP_QUEUE_LOG2_BITS = 5;
localparam PARAMETERS_INPUTS_LSB           = 29;
localparam PARAMETERS_INPUTS_BITS          = 1;
localparam PARAMETERS_ENCODERS_LSB         = 30;
localparam PARAMETERS_ENCODERS_BITS        = 1;
localparam PARAMETERS_OUTPUTS_LSB          = 31;
localparam PARAMETERS_OUTPUTS_BITS         = 1;

// Core: Run. One bit per channel, all in one register: channels that are ARMED start on the same clock when
// one write clears their WAIT_SYNC.
localparam ADDRESS_RUN              = 12'h003;
localparam RUN_RUN_LSB              = 0;
localparam RUN_RUN_BITS             = 8;
localparam RUN_RUN_RESET            = 8'h00;
localparam RUN_WAIT_SYNC_LSB        = 8;
localparam RUN_WAIT_SYNC_BITS       = 8;
localparam RUN_WAIT_SYNC_RESET      = 8'h00;
localparam RUN_STATUS_CHANNEL_LSB   = 16;
localparam RUN_STATUS_CHANNEL_BITS  = 3;
localparam RUN_STATUS_CHANNEL_RESET = 3'h0;
localparam RUN_DEFINED              = 32'h0007FFFF;

// Core: Refusals 0. Counters of refused frames; they wrap.
localparam ADDRESS_REFUSALS_0               = 12'h004;
localparam REFUSALS_0_BAD_CRC_LSB           = 0;
localparam REFUSALS_0_BAD_CRC_BITS          = 8;
localparam REFUSALS_0_BAD_CRC_RESET         = 8'h00;
localparam REFUSALS_0_BAD_LENGTH_LSB        = 8;
localparam REFUSALS_0_BAD_LENGTH_BITS       = 8;
localparam REFUSALS_0_BAD_LENGTH_RESET      = 8'h00;
localparam REFUSALS_0_BAD_OPERATION_LSB     = 16;
localparam REFUSALS_0_BAD_OPERATION_BITS    = 8;
localparam REFUSALS_0_BAD_OPERATION_RESET   = 8'h00;
localparam REFUSALS_0_UNKNOWN_ADDRESS_LSB   = 24;
localparam REFUSALS_0_UNKNOWN_ADDRESS_BITS  = 8;
localparam REFUSALS_0_UNKNOWN_ADDRESS_RESET = 8'h00;

// Core: Refusals 1. Counters of refused frames; they wrap.
localparam ADDRESS_REFUSALS_1          = 12'h005;
localparam REFUSALS_1_READ_ONLY_LSB    = 0;
localparam REFUSALS_1_READ_ONLY_BITS   = 8;
localparam REFUSALS_1_READ_ONLY_RESET  = 8'h00;
localparam REFUSALS_1_QUEUE_FULL_LSB   = 8;
localparam REFUSALS_1_QUEUE_FULL_BITS  = 8;
localparam REFUSALS_1_QUEUE_FULL_RESET = 8'h00;
localparam REFUSALS_1_BUSY_LSB         = 16;
localparam REFUSALS_1_BUSY_BITS        = 8;
localparam REFUSALS_1_BUSY_RESET       = 8'h00;
localparam REFUSALS_1_BAD_VALUE_LSB    = 24;
localparam REFUSALS_1_BAD_VALUE_BITS   = 8;
localparam REFUSALS_1_BAD_VALUE_RESET  = 8'h00;

// Core: Clock. What the core runs at, as the top of the board tells it.
localparam ADDRESS_CLOCK = 12'h006;
localparam CLOCK_HZ_LSB  = 0;
localparam CLOCK_HZ_BITS = 32;

// Core: Build. Which bitstream it is.
localparam ADDRESS_BUILD = 12'h007;
localparam BUILD_LSB     = 0;
localparam BUILD_BITS    = 32;

// Core: Input filter. Glitch filter of all inputs but e-stop. After a write they are unknown.
localparam ADDRESS_INPUT_FILTER      = 12'h010;
localparam INPUT_FILTER_FILTER_LSB   = 0;
localparam INPUT_FILTER_FILTER_BITS  = 16;
localparam INPUT_FILTER_FILTER_RESET = 16'h0000;
localparam INPUT_FILTER_DEFINED      = 32'h0000FFFF;

// Core: Watchdog. Stops motions when no frame has been executed for some time. In units of 2^16 clocks.
localparam ADDRESS_WATCHDOG             = 12'h011;
localparam WATCHDOG_STOP_AFTER_LSB      = 0;
localparam WATCHDOG_STOP_AFTER_BITS     = 10;
localparam WATCHDOG_STOP_AFTER_RESET    = 10'h000;
localparam WATCHDOG_DISABLE_AFTER_LSB   = 10;
localparam WATCHDOG_DISABLE_AFTER_BITS  = 10;
localparam WATCHDOG_DISABLE_AFTER_RESET = 10'h000;
localparam WATCHDOG_DEFINED             = 32'h000FFFFF;

// Core: E-stop. State of the e-stop.
localparam ADDRESS_ESTOP       = 12'h012;
localparam ESTOP_PRESSED_LSB   = 0;
localparam ESTOP_PRESSED_BITS  = 1;
localparam ESTOP_PRESSED_RESET = 1'h0;

// Core: Clear e-stop. No effect while e-stop is pressed.
localparam ADDRESS_ESTOP_CLEAR     = 12'h013;
localparam ESTOP_CLEAR_CLEAR_LSB   = 0;
localparam ESTOP_CLEAR_CLEAR_BITS  = 1;
localparam ESTOP_CLEAR_CLEAR_RESET = 1'h0;
localparam ESTOP_CLEAR_DEFINED     = 32'h00000001;

// Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
localparam ADDRESS_COSINE_BASE  = 12'hD00;
localparam ADDRESS_COSINE_COUNT = 256;
localparam COSINE_POINT_LSB     = 0;
localparam COSINE_POINT_BITS    = 16;
localparam COSINE_DEFINED       = 32'h0000FFFF;

// Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
localparam ADDRESS_SIGMOID_BASE  = 12'hE00;
localparam ADDRESS_SIGMOID_COUNT = 256;
localparam SIGMOID_POINT_LSB     = 0;
localparam SIGMOID_POINT_BITS    = 16;
localparam SIGMOID_DEFINED       = 32'h0000FFFF;

// Core: Shape table point. One point of a shape table, UQ0.16; point 256 is always 1.0.
localparam ADDRESS_EASE_BASE  = 12'hF00;
localparam ADDRESS_EASE_COUNT = 256;
localparam EASE_POINT_LSB     = 0;
localparam EASE_POINT_BITS    = 16;
localparam EASE_DEFINED       = 32'h0000FFFF;

// Core: where each channel has its registers.
localparam ADDRESS_CHANNEL_BASE   = 12'h100;
localparam ADDRESS_CHANNEL_COUNT  = 8;
localparam ADDRESS_CHANNEL_STRIDE = 12'h100;

// Channel: Command. Each bit written as 1 takes effect once. STOP and ABORT override CLEAR and ZERO in the
// same word; ABORT has priority over STOP.
localparam CHANNEL_COMMAND             = 8'h00;
localparam CHANNEL_COMMAND_STOP_LSB    = 0;
localparam CHANNEL_COMMAND_STOP_BITS   = 1;
localparam CHANNEL_COMMAND_STOP_RESET  = 1'h0;
localparam CHANNEL_COMMAND_ABORT_LSB   = 1;
localparam CHANNEL_COMMAND_ABORT_BITS  = 1;
localparam CHANNEL_COMMAND_ABORT_RESET = 1'h0;
localparam CHANNEL_COMMAND_CLEAR_LSB   = 2;
localparam CHANNEL_COMMAND_CLEAR_BITS  = 1;
localparam CHANNEL_COMMAND_CLEAR_RESET = 1'h0;
localparam CHANNEL_COMMAND_ZERO_LSB    = 3;
localparam CHANNEL_COMMAND_ZERO_BITS   = 1;
localparam CHANNEL_COMMAND_ZERO_RESET  = 1'h0;
localparam CHANNEL_COMMAND_DEFINED     = 32'h0000000F;

// Channel: Rate target. Time scale, UQ1.16: 0 = feed hold, 65536 = 1.0 = full speed.
localparam CHANNEL_RATE_TARGET         = 8'h01;
localparam CHANNEL_RATE_TARGET_LSB     = 0;
localparam CHANNEL_RATE_TARGET_BITS    = 17;
localparam CHANNEL_RATE_TARGET_RESET   = 17'h10000;
localparam CHANNEL_RATE_TARGET_DEFINED = 32'h0001FFFF;

// Channel: Rate slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1.
localparam CHANNEL_RATE_SLEW         = 8'h02;
localparam CHANNEL_RATE_SLEW_LSB     = 0;
localparam CHANNEL_RATE_SLEW_BITS    = 17;
localparam CHANNEL_RATE_SLEW_RESET   = 17'h00400;
localparam CHANNEL_RATE_SLEW_DEFINED = 32'h0001FFFF;

// Channel: Stop slew. Change of rate in 2^TICK_LOG2 clocks, UQ1.16; 65536 = immediately; 0 counts as 1.
localparam CHANNEL_STOP_SLEW         = 8'h03;
localparam CHANNEL_STOP_SLEW_LSB     = 0;
localparam CHANNEL_STOP_SLEW_BITS    = 17;
localparam CHANNEL_STOP_SLEW_RESET   = 17'h00400;
localparam CHANNEL_STOP_SLEW_DEFINED = 32'h0001FFFF;

// Channel: Drain velocity. Velocity of the substeps still missing when the profile has ended.
localparam CHANNEL_DRAIN_VELOCITY         = 8'h04;
localparam CHANNEL_DRAIN_VELOCITY_LSB     = 0;
localparam CHANNEL_DRAIN_VELOCITY_BITS    = 32;
localparam CHANNEL_DRAIN_VELOCITY_RESET   = 32'h01000000;
localparam CHANNEL_DRAIN_VELOCITY_DEFINED = 32'hFFFFFFFF;

// Channel: State. State of the channel.
localparam CHANNEL_STATE                = 8'h08;
localparam CHANNEL_STATE_STATE_LSB      = 0;
localparam CHANNEL_STATE_STATE_BITS     = 3;
localparam CHANNEL_STATE_STATE_RESET    = 3'h0;
localparam CHANNEL_STATE_QUIET_LSB      = 3;
localparam CHANNEL_STATE_QUIET_BITS     = 1;
localparam CHANNEL_STATE_QUIET_RESET    = 1'h1;
localparam CHANNEL_STATE_CAUSE_LSB      = 4;
localparam CHANNEL_STATE_CAUSE_BITS     = 4;
localparam CHANNEL_STATE_CAUSE_RESET    = 4'h0;
localparam CHANNEL_STATE_OVERRUN_LSB    = 8;
localparam CHANNEL_STATE_OVERRUN_BITS   = 8;
localparam CHANNEL_STATE_OVERRUN_RESET  = 8'h00;
localparam CHANNEL_STATE_STOPPING_LSB   = 16;
localparam CHANNEL_STATE_STOPPING_BITS  = 1;
localparam CHANNEL_STATE_STOPPING_RESET = 1'h0;
localparam CHANNEL_STATE_DRAINED_LSB    = 17;
localparam CHANNEL_STATE_DRAINED_BITS   = 15;
localparam CHANNEL_STATE_DRAINED_RESET  = 15'h0000;

// Channel: Rate. Time scale in force.
localparam CHANNEL_RATE       = 8'h09;
localparam CHANNEL_RATE_LSB   = 0;
localparam CHANNEL_RATE_BITS  = 17;
localparam CHANNEL_RATE_RESET = 17'h10000;

// Channel: Room. Free places in the queues. A push counts from the moment its frame is accepted.
localparam CHANNEL_ROOM                = 8'h0A;
localparam CHANNEL_ROOM_RAMP_ROOM_LSB  = 0;
localparam CHANNEL_ROOM_RAMP_ROOM_BITS = 16;
localparam CHANNEL_ROOM_LINE_ROOM_LSB  = 16;
localparam CHANNEL_ROOM_LINE_ROOM_BITS = 16;

// Channel: Velocity. Velocity of the present tick, before the time scale.
localparam CHANNEL_VELOCITY       = 8'h0B;
localparam CHANNEL_VELOCITY_LSB   = 0;
localparam CHANNEL_VELOCITY_BITS  = 32;
localparam CHANNEL_VELOCITY_RESET = 32'h00000000;

// Channel: Input levels. Filtered levels, 1 = active, one bit per axis.
localparam CHANNEL_INPUT_LEVELS                  = 8'h10;
localparam CHANNEL_INPUT_LEVELS_LIMIT_LOW_LSB    = 0;
localparam CHANNEL_INPUT_LEVELS_LIMIT_LOW_BITS   = 8;
localparam CHANNEL_INPUT_LEVELS_LIMIT_LOW_RESET  = 8'h00;
localparam CHANNEL_INPUT_LEVELS_LIMIT_HIGH_LSB   = 8;
localparam CHANNEL_INPUT_LEVELS_LIMIT_HIGH_BITS  = 8;
localparam CHANNEL_INPUT_LEVELS_LIMIT_HIGH_RESET = 8'h00;
localparam CHANNEL_INPUT_LEVELS_HOME_LSB         = 16;
localparam CHANNEL_INPUT_LEVELS_HOME_BITS        = 8;
localparam CHANNEL_INPUT_LEVELS_HOME_RESET       = 8'h00;
localparam CHANNEL_INPUT_LEVELS_ALARM_LSB        = 24;
localparam CHANNEL_INPUT_LEVELS_ALARM_BITS       = 8;
localparam CHANNEL_INPUT_LEVELS_ALARM_RESET      = 8'h00;

// Channel: Input flags. Inputs that were active since their flag was cleared, one bit per axis.
localparam CHANNEL_INPUT_FLAGS                  = 8'h11;
localparam CHANNEL_INPUT_FLAGS_LIMIT_LOW_LSB    = 0;
localparam CHANNEL_INPUT_FLAGS_LIMIT_LOW_BITS   = 8;
localparam CHANNEL_INPUT_FLAGS_LIMIT_LOW_RESET  = 8'h00;
localparam CHANNEL_INPUT_FLAGS_LIMIT_HIGH_LSB   = 8;
localparam CHANNEL_INPUT_FLAGS_LIMIT_HIGH_BITS  = 8;
localparam CHANNEL_INPUT_FLAGS_LIMIT_HIGH_RESET = 8'h00;
localparam CHANNEL_INPUT_FLAGS_HOME_LSB         = 16;
localparam CHANNEL_INPUT_FLAGS_HOME_BITS        = 8;
localparam CHANNEL_INPUT_FLAGS_HOME_RESET       = 8'h00;
localparam CHANNEL_INPUT_FLAGS_ALARM_LSB        = 24;
localparam CHANNEL_INPUT_FLAGS_ALARM_BITS       = 8;
localparam CHANNEL_INPUT_FLAGS_ALARM_RESET      = 8'h00;

// Channel: Clear input flags. Each bit written as 1 clears a flag of INPUT_FLAGS; bits of axes that the
// core lacks do nothing.
localparam CHANNEL_INPUT_CLEAR                  = 8'h12;
localparam CHANNEL_INPUT_CLEAR_LIMIT_LOW_LSB    = 0;
localparam CHANNEL_INPUT_CLEAR_LIMIT_LOW_BITS   = 8;
localparam CHANNEL_INPUT_CLEAR_LIMIT_LOW_RESET  = 8'h00;
localparam CHANNEL_INPUT_CLEAR_LIMIT_HIGH_LSB   = 8;
localparam CHANNEL_INPUT_CLEAR_LIMIT_HIGH_BITS  = 8;
localparam CHANNEL_INPUT_CLEAR_LIMIT_HIGH_RESET = 8'h00;
localparam CHANNEL_INPUT_CLEAR_HOME_LSB         = 16;
localparam CHANNEL_INPUT_CLEAR_HOME_BITS        = 8;
localparam CHANNEL_INPUT_CLEAR_HOME_RESET       = 8'h00;
localparam CHANNEL_INPUT_CLEAR_ALARM_LSB        = 24;
localparam CHANNEL_INPUT_CLEAR_ALARM_BITS       = 8;
localparam CHANNEL_INPUT_CLEAR_ALARM_RESET      = 8'h00;
localparam CHANNEL_INPUT_CLEAR_DEFINED          = 32'hFFFFFFFF;

// Channel: Trigger. Every write ends what was armed before.
localparam CHANNEL_TRIGGER               = 8'h13;
localparam CHANNEL_TRIGGER_SOURCE_LSB    = 0;
localparam CHANNEL_TRIGGER_SOURCE_BITS   = 3;
localparam CHANNEL_TRIGGER_SOURCE_RESET  = 3'h0;
localparam CHANNEL_TRIGGER_AXIS_LSB      = 4;
localparam CHANNEL_TRIGGER_AXIS_BITS     = 3;
localparam CHANNEL_TRIGGER_AXIS_RESET    = 3'h0;
localparam CHANNEL_TRIGGER_FALLING_LSB   = 8;
localparam CHANNEL_TRIGGER_FALLING_BITS  = 1;
localparam CHANNEL_TRIGGER_FALLING_RESET = 1'h0;
localparam CHANNEL_TRIGGER_ACTION_LSB    = 12;
localparam CHANNEL_TRIGGER_ACTION_BITS   = 2;
localparam CHANNEL_TRIGGER_ACTION_RESET  = 2'h0;
localparam CHANNEL_TRIGGER_ARM_LSB       = 16;
localparam CHANNEL_TRIGGER_ARM_BITS      = 1;
localparam CHANNEL_TRIGGER_ARM_RESET     = 1'h0;
localparam CHANNEL_TRIGGER_DEFINED       = 32'h00013177;

// Channel: Trigger state. State of the trigger and the probe, and the axes that stopped the channel.
localparam CHANNEL_TRIGGER_STATE                     = 8'h14;
localparam CHANNEL_TRIGGER_STATE_ARMED_LSB           = 0;
localparam CHANNEL_TRIGGER_STATE_ARMED_BITS          = 1;
localparam CHANNEL_TRIGGER_STATE_ARMED_RESET         = 1'h0;
localparam CHANNEL_TRIGGER_STATE_FIRED_LSB           = 1;
localparam CHANNEL_TRIGGER_STATE_FIRED_BITS          = 1;
localparam CHANNEL_TRIGGER_STATE_FIRED_RESET         = 1'h0;
localparam CHANNEL_TRIGGER_STATE_PROBE_LSB           = 2;
localparam CHANNEL_TRIGGER_STATE_PROBE_BITS          = 1;
localparam CHANNEL_TRIGGER_STATE_PROBE_RESET         = 1'h0;
localparam CHANNEL_TRIGGER_STATE_PROBE_FLAG_LSB      = 3;
localparam CHANNEL_TRIGGER_STATE_PROBE_FLAG_BITS     = 1;
localparam CHANNEL_TRIGGER_STATE_PROBE_FLAG_RESET    = 1'h0;
localparam CHANNEL_TRIGGER_STATE_ARMING_LSB          = 4;
localparam CHANNEL_TRIGGER_STATE_ARMING_BITS         = 1;
localparam CHANNEL_TRIGGER_STATE_ARMING_RESET        = 1'h0;
localparam CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_LSB   = 5;
localparam CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_BITS  = 1;
localparam CHANNEL_TRIGGER_STATE_SOURCE_ACTIVE_RESET = 1'h0;
localparam CHANNEL_TRIGGER_STATE_UNKNOWN_LSB         = 6;
localparam CHANNEL_TRIGGER_STATE_UNKNOWN_BITS        = 1;
localparam CHANNEL_TRIGGER_STATE_AXES_LSB            = 8;
localparam CHANNEL_TRIGGER_STATE_AXES_BITS           = 8;
localparam CHANNEL_TRIGGER_STATE_AXES_RESET          = 8'h00;

// Channel: Probe. Polarity, after a change of which the inputs are unknown; and the flag of the probe.
localparam CHANNEL_PROBE                = 8'h15;
localparam CHANNEL_PROBE_INVERTED_LSB   = 0;
localparam CHANNEL_PROBE_INVERTED_BITS  = 1;
localparam CHANNEL_PROBE_INVERTED_RESET = 1'h0;
localparam CHANNEL_PROBE_CLEAR_LSB      = 1;
localparam CHANNEL_PROBE_CLEAR_BITS     = 1;
localparam CHANNEL_PROBE_CLEAR_RESET    = 1'h0;
localparam CHANNEL_PROBE_DEFINED        = 32'h00000003;

// Channel: Line queue. Control, M, N_0 .. N_{AXES-1} for each line, and with OUTPUTS its output word.
localparam CHANNEL_LINE         = 8'h20;
localparam CHANNEL_LINE_LSB     = 0;
localparam CHANNEL_LINE_BITS    = 32;
localparam CHANNEL_LINE_DEFINED = 32'hFFFFFFFF;

// Channel: Ramp queue. 5 words for each ramp: v_end(47:32) (31:16) and LAST (0), NOW (1), mirror (2), shape
// (5:4); v_end(31:0); T; du(47:32); du(31:0).
localparam CHANNEL_RAMP         = 8'h21;
localparam CHANNEL_RAMP_LSB     = 0;
localparam CHANNEL_RAMP_BITS    = 32;
localparam CHANNEL_RAMP_DEFINED = 32'hFFFFFFFF;

// Channel: Raster queue. Four values to a word, the lowest byte first. A raster line begins with a whole
// word.
localparam CHANNEL_RASTER         = 8'h22;
localparam CHANNEL_RASTER_LSB     = 0;
localparam CHANNEL_RASTER_BITS    = 32;
localparam CHANNEL_RASTER_DEFINED = 32'hFFFFFFFF;

// Channel: Output levels. Sets the digital outputs immediately, until a line changes them.
localparam CHANNEL_OUTPUT_LEVELS              = 8'h30;
localparam CHANNEL_OUTPUT_LEVELS_LEVELS_LSB   = 0;
localparam CHANNEL_OUTPUT_LEVELS_LEVELS_BITS  = 8;
localparam CHANNEL_OUTPUT_LEVELS_LEVELS_RESET = 8'h00;
localparam CHANNEL_OUTPUT_LEVELS_DEFINED      = 32'h000000FF;

// Channel: Output lag. Delay of the outputs of lines.
localparam CHANNEL_OUTPUT_LAG           = 8'h31;
localparam CHANNEL_OUTPUT_LAG_LAG_LSB   = 0;
localparam CHANNEL_OUTPUT_LAG_LAG_BITS  = 16;
localparam CHANNEL_OUTPUT_LAG_LAG_RESET = 16'h0000;
localparam CHANNEL_OUTPUT_LAG_DEFINED   = 32'h0000FFFF;

// Channel: PWM step. Frequency of the power pin.
localparam CHANNEL_PWM_STEP         = 8'h32;
localparam CHANNEL_PWM_STEP_LSB     = 0;
localparam CHANNEL_PWM_STEP_BITS    = 24;
localparam CHANNEL_PWM_STEP_RESET   = 24'h001000;
localparam CHANNEL_PWM_STEP_DEFINED = 32'h00FFFFFF;

// Channel: Power reference. Velocity at which a power in proportion to the velocity is the one of the line;
// above it, it stays that.
localparam CHANNEL_POWER_REFERENCE         = 8'h33;
localparam CHANNEL_POWER_REFERENCE_LSB     = 0;
localparam CHANNEL_POWER_REFERENCE_BITS    = 32;
localparam CHANNEL_POWER_REFERENCE_RESET   = 32'h80000000;
localparam CHANNEL_POWER_REFERENCE_DEFINED = 32'hFFFFFFFF;

// Channel: Raster pitch. Substeps from one value of a raster line to the next; counts from the next value
// on.
localparam CHANNEL_RASTER_PITCH             = 8'h34;
localparam CHANNEL_RASTER_PITCH_PITCH_LSB   = 0;
localparam CHANNEL_RASTER_PITCH_PITCH_BITS  = 30;
localparam CHANNEL_RASTER_PITCH_PITCH_RESET = 30'h00000001;
localparam CHANNEL_RASTER_PITCH_DEFINED     = 32'h3FFFFFFF;

// Channel: Compare pulse. Ends a pulse in progress, as COMPARE_DISTANCE does.
localparam CHANNEL_COMPARE_PULSE             = 8'h35;
localparam CHANNEL_COMPARE_PULSE_WIDTH_LSB   = 0;
localparam CHANNEL_COMPARE_PULSE_WIDTH_BITS  = 16;
localparam CHANNEL_COMPARE_PULSE_WIDTH_RESET = 16'h0000;
localparam CHANNEL_COMPARE_PULSE_AXIS_LSB    = 16;
localparam CHANNEL_COMPARE_PULSE_AXIS_BITS   = 3;
localparam CHANNEL_COMPARE_PULSE_AXIS_RESET  = 3'h0;
localparam CHANNEL_COMPARE_PULSE_DEFINED     = 32'h0007FFFF;

// Channel: Compare distance. Where the first pulse comes.
localparam CHANNEL_COMPARE_DISTANCE                = 8'h36;
localparam CHANNEL_COMPARE_DISTANCE_DISTANCE_LSB   = 0;
localparam CHANNEL_COMPARE_DISTANCE_DISTANCE_BITS  = 32;
localparam CHANNEL_COMPARE_DISTANCE_DISTANCE_RESET = 32'h00000000;
localparam CHANNEL_COMPARE_DISTANCE_DEFINED        = 32'hFFFFFFFF;

// Channel: Compare interval. Counts from the next pulse on.
localparam CHANNEL_COMPARE_INTERVAL                = 8'h37;
localparam CHANNEL_COMPARE_INTERVAL_INTERVAL_LSB   = 0;
localparam CHANNEL_COMPARE_INTERVAL_INTERVAL_BITS  = 32;
localparam CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET = 32'h00000001;
localparam CHANNEL_COMPARE_INTERVAL_DEFINED        = 32'hFFFFFFFF;

// Channel: Output state. State of the outputs.
localparam CHANNEL_OUTPUT_STATE                    = 8'h38;
localparam CHANNEL_OUTPUT_STATE_LEVELS_LSB         = 0;
localparam CHANNEL_OUTPUT_STATE_LEVELS_BITS        = 8;
localparam CHANNEL_OUTPUT_STATE_LEVELS_RESET       = 8'h00;
localparam CHANNEL_OUTPUT_STATE_RASTER_EMPTY_LSB   = 8;
localparam CHANNEL_OUTPUT_STATE_RASTER_EMPTY_BITS  = 1;
localparam CHANNEL_OUTPUT_STATE_RASTER_EMPTY_RESET = 1'h0;
localparam CHANNEL_OUTPUT_STATE_OVERFLOW_LSB       = 9;
localparam CHANNEL_OUTPUT_STATE_OVERFLOW_BITS      = 1;
localparam CHANNEL_OUTPUT_STATE_OVERFLOW_RESET     = 1'h0;
localparam CHANNEL_OUTPUT_STATE_RASTER_ROOM_LSB    = 16;
localparam CHANNEL_OUTPUT_STATE_RASTER_ROOM_BITS   = 16;
localparam CHANNEL_OUTPUT_STATE_RASTER_ROOM_RESET  = 16'h0100;

// Channel: Steps made. Position of an axis in steps, sampled soon after chip select fell; wraps.
localparam CHANNEL_POSITION_BASE  = 8'h40;
localparam CHANNEL_POSITION_COUNT = 8;
localparam CHANNEL_POSITION_LSB   = 0;
localparam CHANNEL_POSITION_BITS  = 32;
localparam CHANNEL_POSITION_RESET = 32'h00000000;

// Channel: Latched position. Position of an axis in steps on the clock on which the trigger fired, complete
// 130 clocks later. A ZERO less than 64 clocks after that clears it.
localparam CHANNEL_TRIGGER_POSITION_BASE           = 8'h48;
localparam CHANNEL_TRIGGER_POSITION_COUNT          = 8;
localparam CHANNEL_TRIGGER_POSITION_POSITION_LSB   = 0;
localparam CHANNEL_TRIGGER_POSITION_POSITION_BITS  = 32;
localparam CHANNEL_TRIGGER_POSITION_POSITION_RESET = 32'h00000000;

// Channel: Encoder position. Counts of the encoder of an axis, sampled on the clock of its position; wraps.
localparam CHANNEL_ENCODER_POSITION_BASE           = 8'h50;
localparam CHANNEL_ENCODER_POSITION_COUNT          = 8;
localparam CHANNEL_ENCODER_POSITION_POSITION_LSB   = 0;
localparam CHANNEL_ENCODER_POSITION_POSITION_BITS  = 32;
localparam CHANNEL_ENCODER_POSITION_POSITION_RESET = 32'h00000000;

// Channel: Follow. Whether and how the profile follows an encoder.
localparam CHANNEL_FOLLOW                  = 8'h60;
localparam CHANNEL_FOLLOW_FOLLOW_LSB       = 0;
localparam CHANNEL_FOLLOW_FOLLOW_BITS      = 1;
localparam CHANNEL_FOLLOW_FOLLOW_RESET     = 1'h0;
localparam CHANNEL_FOLLOW_WAIT_INDEX_LSB   = 1;
localparam CHANNEL_FOLLOW_WAIT_INDEX_BITS  = 1;
localparam CHANNEL_FOLLOW_WAIT_INDEX_RESET = 1'h0;
localparam CHANNEL_FOLLOW_SOURCE_LSB       = 2;
localparam CHANNEL_FOLLOW_SOURCE_BITS      = 3;
localparam CHANNEL_FOLLOW_SOURCE_RESET     = 3'h0;
localparam CHANNEL_FOLLOW_SCALE_LSB        = 5;
localparam CHANNEL_FOLLOW_SCALE_BITS       = 3;
localparam CHANNEL_FOLLOW_SCALE_RESET      = 3'h0;
localparam CHANNEL_FOLLOW_DEFINED          = 32'h000000FF;

// Channel: Follow limit. What is owed to the encoder is made at no more than this.
localparam CHANNEL_FOLLOW_LIMIT             = 8'h61;
localparam CHANNEL_FOLLOW_LIMIT_LIMIT_LSB   = 0;
localparam CHANNEL_FOLLOW_LIMIT_LIMIT_BITS  = 32;
localparam CHANNEL_FOLLOW_LIMIT_LIMIT_RESET = 32'h01000000;
localparam CHANNEL_FOLLOW_LIMIT_DEFINED     = 32'hFFFFFFFF;

// Channel: Encoder filter. Glitch filter of all encoders of the channel.
localparam CHANNEL_ENCODER_FILTER              = 8'h62;
localparam CHANNEL_ENCODER_FILTER_FILTER_LSB   = 0;
localparam CHANNEL_ENCODER_FILTER_FILTER_BITS  = 8;
localparam CHANNEL_ENCODER_FILTER_FILTER_RESET = 8'h03;
localparam CHANNEL_ENCODER_FILTER_DEFINED      = 32'h000000FF;

// Channel: Follow state. Of the motion that runs; behind and lost, of the last one, until the next is
// prepared.
localparam CHANNEL_FOLLOW_STATE              = 8'h63;
localparam CHANNEL_FOLLOW_STATE_OWED_LSB     = 0;
localparam CHANNEL_FOLLOW_STATE_OWED_BITS    = 24;
localparam CHANNEL_FOLLOW_STATE_OWED_RESET   = 24'h000000;
localparam CHANNEL_FOLLOW_STATE_BEHIND_LSB   = 24;
localparam CHANNEL_FOLLOW_STATE_BEHIND_BITS  = 1;
localparam CHANNEL_FOLLOW_STATE_BEHIND_RESET = 1'h0;
localparam CHANNEL_FOLLOW_STATE_LOST_LSB     = 25;
localparam CHANNEL_FOLLOW_STATE_LOST_BITS    = 1;
localparam CHANNEL_FOLLOW_STATE_LOST_RESET   = 1'h0;

// Channel: Tracker enable. One bit per axis. A stop of any cause and ZERO clear them; bits of axes that the
// core lacks do nothing.
localparam CHANNEL_TRACKER_ENABLE              = 8'h64;
localparam CHANNEL_TRACKER_ENABLE_ENABLE_LSB   = 0;
localparam CHANNEL_TRACKER_ENABLE_ENABLE_BITS  = 8;
localparam CHANNEL_TRACKER_ENABLE_ENABLE_RESET = 8'h00;
localparam CHANNEL_TRACKER_ENABLE_DEFINED      = 32'h000000FF;

// Channel: Tracker state. One bit per axis.
localparam CHANNEL_TRACKER_STATE                = 8'h65;
localparam CHANNEL_TRACKER_STATE_ENABLED_LSB    = 0;
localparam CHANNEL_TRACKER_STATE_ENABLED_BITS   = 8;
localparam CHANNEL_TRACKER_STATE_ENABLED_RESET  = 8'h00;
localparam CHANNEL_TRACKER_STATE_MOVES_LSB      = 8;
localparam CHANNEL_TRACKER_STATE_MOVES_BITS     = 8;
localparam CHANNEL_TRACKER_STATE_MOVES_RESET    = 8'h00;
localparam CHANNEL_TRACKER_STATE_AT_TARGET_LSB  = 16;
localparam CHANNEL_TRACKER_STATE_AT_TARGET_BITS = 8;

// Channel: Tracker position. Steps of an axis that are due to its tracker, rounded down while it moves;
// wraps. A hard stop may drop up to 7 of them.
localparam CHANNEL_TRACKER_POSITION_BASE           = 8'h68;
localparam CHANNEL_TRACKER_POSITION_COUNT          = 8;
localparam CHANNEL_TRACKER_POSITION_POSITION_LSB   = 0;
localparam CHANNEL_TRACKER_POSITION_POSITION_BITS  = 32;
localparam CHANNEL_TRACKER_POSITION_POSITION_RESET = 32'h00000000;

// Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
// moved the axis went up, or none did, the second one while it went down. Their difference is the backlash.
localparam CHANNEL_TRACKER_TARGET_BASE         = 8'h70;
localparam CHANNEL_TRACKER_TARGET_COUNT        = 8;
localparam CHANNEL_TRACKER_TARGET_TARGET_LSB   = 0;
localparam CHANNEL_TRACKER_TARGET_TARGET_BITS  = 32;
localparam CHANNEL_TRACKER_TARGET_TARGET_RESET = 32'h00000000;
localparam CHANNEL_TRACKER_TARGET_DEFINED      = 32'hFFFFFFFF;

// Channel: Tracker target. Where the tracker of an axis goes: the first array while the last line that
// moved the axis went up, or none did, the second one while it went down. Their difference is the backlash.
localparam CHANNEL_TRACKER_TARGET_DOWN_BASE         = 8'h78;
localparam CHANNEL_TRACKER_TARGET_DOWN_COUNT        = 8;
localparam CHANNEL_TRACKER_TARGET_DOWN_TARGET_LSB   = 0;
localparam CHANNEL_TRACKER_TARGET_DOWN_TARGET_BITS  = 32;
localparam CHANNEL_TRACKER_TARGET_DOWN_TARGET_RESET = 32'h00000000;
localparam CHANNEL_TRACKER_TARGET_DOWN_DEFINED      = 32'hFFFFFFFF;

// Channel: where each axis has its registers.
localparam CHANNEL_AXIS_BASE   = 8'h80;
localparam CHANNEL_AXIS_COUNT  = 8;
localparam CHANNEL_AXIS_STRIDE = 8'h08;

// Channel: where each encoder has its registers.
localparam CHANNEL_ENCODER_BASE   = 8'hC0;
localparam CHANNEL_ENCODER_COUNT  = 8;
localparam CHANNEL_ENCODER_STRIDE = 8'h08;

// Axis: Pins. Polarities and step mode. From the write on, the next step waits for the low time, the DIR
// hold and the DIR setup.
localparam AXIS_PINS                          = 3'h0;
localparam AXIS_PINS_STEP_INVERTED_LSB        = 1;
localparam AXIS_PINS_STEP_INVERTED_BITS       = 1;
localparam AXIS_PINS_STEP_INVERTED_RESET      = 1'h0;
localparam AXIS_PINS_DIRECTION_INVERTED_LSB   = 2;
localparam AXIS_PINS_DIRECTION_INVERTED_BITS  = 1;
localparam AXIS_PINS_DIRECTION_INVERTED_RESET = 1'h0;
localparam AXIS_PINS_ENABLE_INVERTED_LSB      = 3;
localparam AXIS_PINS_ENABLE_INVERTED_BITS     = 1;
localparam AXIS_PINS_ENABLE_INVERTED_RESET    = 1'h0;
localparam AXIS_PINS_BOTH_EDGES_LSB           = 4;
localparam AXIS_PINS_BOTH_EDGES_BITS          = 1;
localparam AXIS_PINS_BOTH_EDGES_RESET         = 1'h0;
localparam AXIS_PINS_DEFINED                  = 32'h0000001E;

// Axis: STEP timing. Clocks, 1 .. 65535; 0 counts as 1.
localparam AXIS_STEP_TIMING                 = 3'h1;
localparam AXIS_STEP_TIMING_STEP_LOW_LSB    = 0;
localparam AXIS_STEP_TIMING_STEP_LOW_BITS   = 16;
localparam AXIS_STEP_TIMING_STEP_LOW_RESET  = 16'h0001;
localparam AXIS_STEP_TIMING_STEP_HIGH_LSB   = 16;
localparam AXIS_STEP_TIMING_STEP_HIGH_BITS  = 16;
localparam AXIS_STEP_TIMING_STEP_HIGH_RESET = 16'h0001;
localparam AXIS_STEP_TIMING_DEFINED         = 32'hFFFFFFFF;

// Axis: DIR timing. Clocks, 1 .. 65535; 0 counts as 1.
localparam AXIS_DIR_TIMING                 = 3'h2;
localparam AXIS_DIR_TIMING_DIR_HOLD_LSB    = 0;
localparam AXIS_DIR_TIMING_DIR_HOLD_BITS   = 16;
localparam AXIS_DIR_TIMING_DIR_HOLD_RESET  = 16'h0001;
localparam AXIS_DIR_TIMING_DIR_SETUP_LSB   = 16;
localparam AXIS_DIR_TIMING_DIR_SETUP_BITS  = 16;
localparam AXIS_DIR_TIMING_DIR_SETUP_RESET = 16'h0001;
localparam AXIS_DIR_TIMING_DEFINED         = 32'hFFFFFFFF;

// Axis: Lost steps. Steps lost because the queue of the axis was full (STEP_OVERRUN).
localparam AXIS_LOST_STEPS            = 3'h3;
localparam AXIS_LOST_STEPS_LOST_LSB   = 0;
localparam AXIS_LOST_STEPS_LOST_BITS  = 4;
localparam AXIS_LOST_STEPS_LOST_RESET = 4'h0;

// Axis: Drive enable. Enables the drive of the axis.
localparam AXIS_ENABLE         = 3'h4;
localparam AXIS_ENABLE_LSB     = 0;
localparam AXIS_ENABLE_BITS    = 1;
localparam AXIS_ENABLE_RESET   = 1'h0;
localparam AXIS_ENABLE_DEFINED = 32'h00000001;

// Axis: Inputs of the axis. Polarities, and what limits and alarm do. After a write the inputs are unknown.
localparam AXIS_INPUTS                           = 3'h5;
localparam AXIS_INPUTS_LIMIT_LOW_INVERTED_LSB    = 0;
localparam AXIS_INPUTS_LIMIT_LOW_INVERTED_BITS   = 1;
localparam AXIS_INPUTS_LIMIT_LOW_INVERTED_RESET  = 1'h0;
localparam AXIS_INPUTS_LIMIT_HIGH_INVERTED_LSB   = 1;
localparam AXIS_INPUTS_LIMIT_HIGH_INVERTED_BITS  = 1;
localparam AXIS_INPUTS_LIMIT_HIGH_INVERTED_RESET = 1'h0;
localparam AXIS_INPUTS_HOME_INVERTED_LSB         = 2;
localparam AXIS_INPUTS_HOME_INVERTED_BITS        = 1;
localparam AXIS_INPUTS_HOME_INVERTED_RESET       = 1'h0;
localparam AXIS_INPUTS_ALARM_INVERTED_LSB        = 3;
localparam AXIS_INPUTS_ALARM_INVERTED_BITS       = 1;
localparam AXIS_INPUTS_ALARM_INVERTED_RESET      = 1'h0;
localparam AXIS_INPUTS_LIMIT_SOFT_LSB            = 4;
localparam AXIS_INPUTS_LIMIT_SOFT_BITS           = 1;
localparam AXIS_INPUTS_LIMIT_SOFT_RESET          = 1'h0;
localparam AXIS_INPUTS_ALARM_SOFT_LSB            = 5;
localparam AXIS_INPUTS_ALARM_SOFT_BITS           = 1;
localparam AXIS_INPUTS_ALARM_SOFT_RESET          = 1'h0;
localparam AXIS_INPUTS_ALARM_DISABLES_LSB        = 6;
localparam AXIS_INPUTS_ALARM_DISABLES_BITS       = 1;
localparam AXIS_INPUTS_ALARM_DISABLES_RESET      = 1'h0;
localparam AXIS_INPUTS_DEFINED                   = 32'h0000007F;

// Axis: Speed of the tracker. The tracker moves no faster. Below its acceleration it does not move.
localparam AXIS_TRACKER_SPEED             = 3'h6;
localparam AXIS_TRACKER_SPEED_SPEED_LSB   = 0;
localparam AXIS_TRACKER_SPEED_SPEED_BITS  = 32;
localparam AXIS_TRACKER_SPEED_SPEED_RESET = 32'h00000000;
localparam AXIS_TRACKER_SPEED_DEFINED     = 32'hFFFFFFFF;

// Axis: Acceleration of the tracker. Greatest change of its speed from one tick to the next.
localparam AXIS_TRACKER_ACCELERATION                    = 3'h7;
localparam AXIS_TRACKER_ACCELERATION_ACCELERATION_LSB   = 0;
localparam AXIS_TRACKER_ACCELERATION_ACCELERATION_BITS  = 32;
localparam AXIS_TRACKER_ACCELERATION_ACCELERATION_RESET = 32'h00000000;
localparam AXIS_TRACKER_ACCELERATION_DEFINED            = 32'hFFFFFFFF;

// Encoder: Encoder setup. How the encoder counts, and what a following error does.
localparam ENCODER_SETUP                      = 3'h0;
localparam ENCODER_SETUP_INVERTED_LSB         = 0;
localparam ENCODER_SETUP_INVERTED_BITS        = 1;
localparam ENCODER_SETUP_INVERTED_RESET       = 1'h0;
localparam ENCODER_SETUP_INDEX_INVERTED_LSB   = 1;
localparam ENCODER_SETUP_INDEX_INVERTED_BITS  = 1;
localparam ENCODER_SETUP_INDEX_INVERTED_RESET = 1'h0;
localparam ENCODER_SETUP_INDEX_GATED_LSB      = 2;
localparam ENCODER_SETUP_INDEX_GATED_BITS     = 1;
localparam ENCODER_SETUP_INDEX_GATED_RESET    = 1'h0;
localparam ENCODER_SETUP_STOP_SOFT_LSB        = 3;
localparam ENCODER_SETUP_STOP_SOFT_BITS       = 1;
localparam ENCODER_SETUP_STOP_SOFT_RESET      = 1'h0;
localparam ENCODER_SETUP_STOP_HARD_LSB        = 4;
localparam ENCODER_SETUP_STOP_HARD_BITS       = 1;
localparam ENCODER_SETUP_STOP_HARD_RESET      = 1'h0;
localparam ENCODER_SETUP_DEFINED              = 32'h0000001F;

// Encoder: Encoder ratio. Counts per step. A write sets the following error to 0.
localparam ENCODER_RATIO         = 3'h1;
localparam ENCODER_RATIO_LSB     = 0;
localparam ENCODER_RATIO_BITS    = 32;
localparam ENCODER_RATIO_RESET   = 32'h00010000;
localparam ENCODER_RATIO_DEFINED = 32'hFFFFFFFF;

// Encoder: Following error limit. Following error at which the limit is exceeded.
localparam ENCODER_LIMIT         = 3'h2;
localparam ENCODER_LIMIT_LSB     = 0;
localparam ENCODER_LIMIT_BITS    = 16;
localparam ENCODER_LIMIT_RESET   = 16'hFFFF;
localparam ENCODER_LIMIT_DEFINED = 32'h0000FFFF;

// Encoder: Following error. Position times ratio less encoder position, both as they were set to 0 by
// COMMAND.ZERO or a write of the ratio.
localparam ENCODER_ERROR       = 3'h3;
localparam ENCODER_ERROR_LSB   = 0;
localparam ENCODER_ERROR_BITS  = 32;
localparam ENCODER_ERROR_RESET = 32'h00000000;

// Encoder: Greatest following error. Since COMMAND.ZERO, COMMAND.CLEAR or a write of the ratio.
localparam ENCODER_GREATEST                = 3'h4;
localparam ENCODER_GREATEST_GREATEST_LSB   = 0;
localparam ENCODER_GREATEST_GREATEST_BITS  = 18;
localparam ENCODER_GREATEST_GREATEST_RESET = 18'h00000;
localparam ENCODER_GREATEST_EXCEEDED_LSB   = 31;
localparam ENCODER_GREATEST_EXCEEDED_BITS  = 1;
localparam ENCODER_GREATEST_EXCEEDED_RESET = 1'h0;

// Encoder: Encoder index. What the index has latched, and the transitions that were none. All 0 after
// COMMAND.ZERO.
localparam ENCODER_INDEX               = 3'h5;
localparam ENCODER_INDEX_LATCH_LSB     = 0;
localparam ENCODER_INDEX_LATCH_BITS    = 16;
localparam ENCODER_INDEX_LATCH_RESET   = 16'h0000;
localparam ENCODER_INDEX_INDEXES_LSB   = 16;
localparam ENCODER_INDEX_INDEXES_BITS  = 8;
localparam ENCODER_INDEX_INDEXES_RESET = 8'h00;
localparam ENCODER_INDEX_ILLEGAL_LSB   = 24;
localparam ENCODER_INDEX_ILLEGAL_BITS  = 8;
localparam ENCODER_INDEX_ILLEGAL_RESET = 8'h00;

// Operation of a frame.
localparam OPERATION_READ  = 4'd1; // Read consecutive registers.
localparam OPERATION_WRITE = 4'd2; // Write consecutive registers.
localparam OPERATION_PUSH  = 4'd3; // Write every word to the same address: lines and ramps.

// Outcome of a frame.
localparam VERDICT_OK              = 4'd0; // Executed.
localparam VERDICT_DUPLICATE       = 4'd1; // Not executed: its sequence number was accepted before.
localparam VERDICT_BAD_CRC         = 4'd2; // CRC wrong.
localparam VERDICT_BAD_LENGTH      = 4'd3; // Length 0 or above 60, or not whole lines or ramps.
localparam VERDICT_BAD_OPERATION   = 4'd4; // Unknown operation, or one the register does not take.
localparam VERDICT_UNKNOWN_ADDRESS = 4'd5; // No register at this address.
localparam VERDICT_READ_ONLY       = 4'd6; // The register cannot be written.
localparam VERDICT_QUEUE_FULL      = 4'd7; // Not enough room for the whole frame.
localparam VERDICT_BUSY            = 4'd8; // The state of the channel does not allow it (see the register).
localparam VERDICT_BAD_VALUE       = 4'd9; // The register does not take the value, or an undefined bit is set (see the register).

// State of a channel.
localparam STATE_IDLE    = 3'd0; // No motion.
localparam STATE_PREPARE = 3'd1; // First line and first velocity are being prepared.
localparam STATE_ARMED   = 3'd2; // Ready to start; waits while WAIT_SYNC is set.
localparam STATE_RUN     = 3'd3; // The profile runs.
localparam STATE_SETTLE  = 3'd4; // The profile has ended; its last substeps travel to the pins.
localparam STATE_DRAIN   = 3'd5; // Missing substeps of the LAST line are made at drain_velocity.
localparam STATE_STOPPED = 3'd6; // Stopped by a command or a fault; queues flushed. CLEAR leads back to IDLE.

// Why a channel has stopped.
localparam CAUSE_NONE            = 4'd0;  // Not stopped.
localparam CAUSE_STOP            = 4'd1;  // COMMAND.STOP.
localparam CAUSE_ABORT           = 4'd2;  // COMMAND.ABORT.
localparam CAUSE_LINE_UNDERRUN   = 4'd3;  // A line ended, was not LAST, and none followed.
localparam CAUSE_RAMP_UNDERRUN   = 4'd4;  // The ramps ran out at speed.
localparam CAUSE_STEP_OVERRUN    = 4'd5;  // Steps came faster than the pin timing of an axis allows.
localparam CAUSE_LIMIT           = 4'd6;  // An axis stepped toward an active limit switch.
localparam CAUSE_ALARM           = 4'd7;  // The alarm input of an axis became active.
localparam CAUSE_TRIGGER         = 4'd8;  // The trigger fired, and its action is a stop.
localparam CAUSE_WATCHDOG        = 4'd9;  // No good frame came for too long while a motion ran.
localparam CAUSE_ESTOP           = 4'd10; // The e-stop input became active.
localparam CAUSE_FOLLOWING_ERROR = 4'd11; // The following error of an axis exceeded its limit.

// What fires the trigger of a channel.
localparam TRIGGER_SOURCE_NONE       = 3'd0; // None; cannot be armed.
localparam TRIGGER_SOURCE_LIMIT_LOW  = 3'd1; // Limit switch of the axis in negative direction.
localparam TRIGGER_SOURCE_LIMIT_HIGH = 3'd2; // Limit switch of the axis in positive direction.
localparam TRIGGER_SOURCE_HOME       = 3'd3; // Home switch of the axis.
localparam TRIGGER_SOURCE_PROBE      = 3'd4; // Probe of the channel.
localparam TRIGGER_SOURCE_INDEX      = 3'd5; // Index of the axis's encoder, as its setup says; never active without ENCODERS.

// What the trigger does when it fires.
localparam TRIGGER_ACTION_LATCH       = 2'd0; // Only latch.
localparam TRIGGER_ACTION_SOFT_STOP   = 2'd1; // Latch and soft stop.
localparam TRIGGER_ACTION_HARD_STOP   = 2'd2; // Latch and hard stop.
localparam TRIGGER_ACTION_END_ENDLESS = 2'd3; // Latch, and let the current ENDLESS line end as any other line.

// Shape of a ramp: s as a function of the progress u, both 0 .. 1.
localparam SHAPE_LINEAR  = 2'd0; // s = u, no table.
localparam SHAPE_COSINE  = 2'd1; // (1 - cos(pi u)) / 2.
localparam SHAPE_SIGMOID = 2'd2; // Logistic function over -5 .. 5, scaled to begin at 0 and end at 1.
localparam SHAPE_EASE    = 2'd3; // u^2.

/* verilator lint_on UNUSEDPARAM */
