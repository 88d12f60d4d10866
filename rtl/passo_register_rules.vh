// SPDX-License-Identifier: MIT
// Generated from spec/passo.rdl by spec/generate_registers.py.
// What each register takes, to be included in passo_rules. It is flags, and in its lower 5 bits
// the highest bit that a word may have; without a flag there is no register.
// Not a `case`: yosys would make a ROM of it, with registers of its own for the address.

localparam [12:0] RULE_SHAPE = RULE_WRITE | 13'd15;

function [12:0] core_rule(input [7:0] address);
  core_rule =
    {13{address == ADDRESS_IDENTIFICATION[7:0]}} & (RULE_READ)
    | {13{address == ADDRESS_VERSION[7:0]}}        & (RULE_READ)
    | {13{address == ADDRESS_PARAMETERS[7:0]}}     & (RULE_READ)
    | {13{address == ADDRESS_RUN[7:0]}}            & (RULE_READ | RULE_WRITE | 13'd18)
    | {13{address == ADDRESS_REFUSALS_0[7:0]}}     & (RULE_READ)
    | {13{address == ADDRESS_REFUSALS_1[7:0]}}     & (RULE_READ)
    | {13{address == ADDRESS_CLOCK[7:0]}}          & (RULE_READ)
    | {13{address == ADDRESS_BUILD[7:0]}}          & (RULE_READ)
    | {13{address == ADDRESS_INPUT_FILTER[7:0]}}   & (WITH_INPUTS & (RULE_WRITE | 13'd15))
    | {13{address == ADDRESS_WATCHDOG[7:0]}}       & (WITH_INPUTS & (RULE_WRITE | 13'd19))
    | {13{address == ADDRESS_ESTOP[7:0]}}          & (WITH_INPUTS & RULE_READ)
    | {13{address == ADDRESS_ESTOP_CLEAR[7:0]}}    & (WITH_INPUTS & (RULE_WRITE | 13'd0));
endfunction

function [12:0] channel_rule(input [7:0] address);
  channel_rule =
    {13{address == CHANNEL_COMMAND}}                            & (RULE_WRITE | 13'd3)
    | {13{address == CHANNEL_RATE_TARGET}}                        & (RULE_WRITE | RULE_POWER | 13'd16)
    | {13{address == CHANNEL_RATE_SLEW}}                          & (RULE_WRITE | RULE_POWER | 13'd16)
    | {13{address == CHANNEL_STOP_SLEW}}                          & (RULE_WRITE | RULE_POWER | 13'd16)
    | {13{address == CHANNEL_DRAIN_VELOCITY}}                     & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31)
    | {13{address == CHANNEL_STATE}}                              & (RULE_READ)
    | {13{address == CHANNEL_RATE}}                               & (RULE_READ)
    | {13{address == CHANNEL_ROOM}}                               & (RULE_READ)
    | {13{address == CHANNEL_VELOCITY}}                           & (RULE_READ)
    | {13{address == CHANNEL_INPUT_LEVELS}}                       & (WITH_INPUTS & RULE_READ)
    | {13{address == CHANNEL_INPUT_FLAGS}}                        & (WITH_INPUTS & RULE_READ)
    | {13{address == CHANNEL_INPUT_CLEAR}}                        & (WITH_INPUTS & (RULE_WRITE | 13'd31))
    | {13{address == CHANNEL_TRIGGER}}                            & (WITH_INPUTS & (RULE_WRITE | 13'd16))
    | {13{address == CHANNEL_TRIGGER_STATE}}                      & (WITH_INPUTS & RULE_READ)
    | {13{address == CHANNEL_PROBE}}                              & (WITH_INPUTS & (RULE_WRITE | 13'd1))
    | {13{address == CHANNEL_LINE}}                               & (RULE_PUSH)
    | {13{address == CHANNEL_RAMP}}                               & (RULE_PUSH)
    | {13{address == CHANNEL_RASTER}}                             & (WITH_RASTER & RULE_PUSH)
    | {13{address == CHANNEL_OUTPUT_LEVELS}}                      & (WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd7))
    | {13{address == CHANNEL_OUTPUT_LAG}}                         & (WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd15))
    | {13{address == CHANNEL_PWM_STEP}}                           & (WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd23))
    | {13{address == CHANNEL_POWER_REFERENCE}}                    & (WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31))
    | {13{address == CHANNEL_RASTER_PITCH}}                       & (WITH_RASTER & (RULE_WRITE | RULE_NONZERO | 13'd29))
    | {13{address == CHANNEL_COMPARE_PULSE}}                      & (WITH_COMPARE & (RULE_WRITE | RULE_QUIET | 13'd18))
    | {13{address == CHANNEL_COMPARE_DISTANCE}}                   & (WITH_COMPARE & (RULE_WRITE | RULE_QUIET | 13'd31))
    | {13{address == CHANNEL_COMPARE_INTERVAL}}                   & (WITH_COMPARE & (RULE_WRITE | RULE_NONZERO | 13'd31))
    | {13{address == CHANNEL_OUTPUT_STATE}}                       & (WITH_OUTPUTS & RULE_READ)
    | {13{address[7:3] == CHANNEL_POSITION_BASE[7:3]}}            & (RULE_READ | RULE_AXIS)
    | {13{address[7:3] == CHANNEL_TRIGGER_POSITION_BASE[7:3]}}    & (WITH_INPUTS & (RULE_READ | RULE_AXIS))
    | {13{address[7:3] == CHANNEL_ENCODER_POSITION_BASE[7:3]}}    & (WITH_ENCODERS & (RULE_READ | RULE_AXIS))
    | {13{address == CHANNEL_FOLLOW}}                             & (WITH_ENCODERS & (RULE_WRITE | RULE_QUIET | 13'd7))
    | {13{address == CHANNEL_FOLLOW_LIMIT}}                       & (WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31))
    | {13{address == CHANNEL_ENCODER_FILTER}}                     & (WITH_ENCODERS & (RULE_WRITE | 13'd7))
    | {13{address == CHANNEL_FOLLOW_STATE}}                       & (WITH_ENCODERS & RULE_READ)
    | {13{address == CHANNEL_TRACKER_ENABLE}}                     & (WITH_TRACKERS & (RULE_WRITE | 13'd7))
    | {13{address == CHANNEL_TRACKER_STATE}}                      & (WITH_TRACKERS & RULE_READ)
    | {13{address[7:3] == CHANNEL_TRACKER_POSITION_BASE[7:3]}}    & (WITH_TRACKERS & (RULE_READ | RULE_AXIS))
    | {13{address[7:3] == CHANNEL_TRACKER_TARGET_BASE[7:3]}}      & (WITH_TRACKERS & (RULE_WRITE | RULE_AXIS | 13'd31))
    | {13{address[7:3] == CHANNEL_TRACKER_TARGET_DOWN_BASE[7:3]}} & (WITH_TRACKERS & (RULE_WRITE | RULE_AXIS | 13'd31));
endfunction

function [12:0] axis_rule(input [2:0] address);
  axis_rule =
    {13{address == AXIS_PINS}}                 & (RULE_WRITE | RULE_QUIET | RULE_EVEN | 13'd4)
    | {13{address == AXIS_STEP_TIMING}}          & (RULE_WRITE | 13'd31)
    | {13{address == AXIS_DIR_TIMING}}           & (RULE_WRITE | 13'd31)
    | {13{address == AXIS_LOST_STEPS}}           & (RULE_READ)
    | {13{address == AXIS_ENABLE}}               & (RULE_WRITE | 13'd0)
    | {13{address == AXIS_INPUTS}}               & (WITH_INPUTS & (RULE_WRITE | RULE_QUIET | 13'd6))
    | {13{address == AXIS_TRACKER_SPEED}}        & (WITH_TRACKERS & (RULE_WRITE | 13'd31))
    | {13{address == AXIS_TRACKER_ACCELERATION}} & (WITH_TRACKERS & (RULE_WRITE | RULE_QUIET | 13'd31));
endfunction

function [12:0] encoder_rule(input [2:0] address);
  encoder_rule =
    {13{address == ENCODER_SETUP}}    & (WITH_ENCODERS & (RULE_WRITE | 13'd4))
    | {13{address == ENCODER_RATIO}}    & (WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | 13'd31))
    | {13{address == ENCODER_LIMIT}}    & (WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | 13'd15))
    | {13{address == ENCODER_ERROR}}    & (WITH_ENCODERS & RULE_READ)
    | {13{address == ENCODER_GREATEST}} & (WITH_ENCODERS & RULE_READ)
    | {13{address == ENCODER_INDEX}}    & (WITH_ENCODERS & RULE_READ);
endfunction
