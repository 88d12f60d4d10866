// SPDX-License-Identifier: MIT
// Generated from spec/passo.rdl by spec/generate_registers.py.
// What each register takes, to be included in passo_rules. It is flags, and in its lower 5 bits
// the highest bit that a word may have; without a flag there is no register. No `default`:
// yosys would make a ROM of the table, with registers of its own for the address.

localparam [12:0] RULE_SHAPE = RULE_WRITE | 13'd15;

function [12:0] core_rule(input [7:0] address);
  casez ({4'd0, address})
    ADDRESS_IDENTIFICATION: core_rule = RULE_READ;
    ADDRESS_VERSION:        core_rule = RULE_READ;
    ADDRESS_PARAMETERS:     core_rule = RULE_READ;
    ADDRESS_RUN:            core_rule = RULE_READ | RULE_WRITE | 13'd18;
    ADDRESS_REFUSALS_0:     core_rule = RULE_READ;
    ADDRESS_REFUSALS_1:     core_rule = RULE_READ;
    ADDRESS_INPUT_FILTER:   core_rule = WITH_INPUTS & (RULE_WRITE | 13'd15);
    ADDRESS_WATCHDOG:       core_rule = WITH_INPUTS & (RULE_WRITE | 13'd19);
    ADDRESS_ESTOP:          core_rule = WITH_INPUTS & RULE_READ;
    ADDRESS_ESTOP_CLEAR:    core_rule = WITH_INPUTS & (RULE_WRITE | 13'd0);
    12'b????????????:       core_rule = 13'd0;
  endcase
endfunction

function [12:0] channel_rule(input [7:0] address);
  casez (address)
    CHANNEL_COMMAND:                              channel_rule = RULE_WRITE | 13'd3;
    CHANNEL_RATE_TARGET:                          channel_rule = RULE_WRITE | RULE_POWER | 13'd16;
    CHANNEL_RATE_SLEW:                            channel_rule = RULE_WRITE | RULE_POWER | 13'd16;
    CHANNEL_STOP_SLEW:                            channel_rule = RULE_WRITE | RULE_POWER | 13'd16;
    CHANNEL_DRAIN_VELOCITY:                       channel_rule = RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31;
    CHANNEL_STATE:                                channel_rule = RULE_READ;
    CHANNEL_RATE:                                 channel_rule = RULE_READ;
    CHANNEL_ROOM:                                 channel_rule = RULE_READ;
    CHANNEL_VELOCITY:                             channel_rule = RULE_READ;
    CHANNEL_INPUT_LEVELS:                         channel_rule = WITH_INPUTS & RULE_READ;
    CHANNEL_INPUT_FLAGS:                          channel_rule = WITH_INPUTS & RULE_READ;
    CHANNEL_INPUT_CLEAR:                          channel_rule = WITH_INPUTS & (RULE_WRITE | 13'd31);
    CHANNEL_TRIGGER:                              channel_rule = WITH_INPUTS & (RULE_WRITE | 13'd16);
    CHANNEL_TRIGGER_STATE:                        channel_rule = WITH_INPUTS & RULE_READ;
    CHANNEL_PROBE:                                channel_rule = WITH_INPUTS & (RULE_WRITE | 13'd1);
    CHANNEL_LINE:                                 channel_rule = RULE_PUSH;
    CHANNEL_RAMP:                                 channel_rule = RULE_PUSH;
    CHANNEL_RASTER:                               channel_rule = WITH_OUTPUTS & RULE_PUSH;
    CHANNEL_OUTPUT_LEVELS:                        channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd7);
    CHANNEL_OUTPUT_LAG:                           channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd15);
    CHANNEL_PWM_STEP:                             channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd23);
    CHANNEL_POWER_REFERENCE:                      channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31);
    CHANNEL_RASTER_PITCH:                         channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | 13'd29);
    CHANNEL_COMPARE_PULSE:                        channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd18);
    CHANNEL_COMPARE_DISTANCE:                     channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_QUIET | 13'd31);
    CHANNEL_COMPARE_INTERVAL:                     channel_rule = WITH_OUTPUTS & (RULE_WRITE | RULE_NONZERO | 13'd31);
    CHANNEL_OUTPUT_STATE:                         channel_rule = WITH_OUTPUTS & RULE_READ;
    {CHANNEL_POSITION_BASE[7:3], 3'b???}:         channel_rule = RULE_READ | RULE_AXIS;
    {CHANNEL_TRIGGER_POSITION_BASE[7:3], 3'b???}: channel_rule = WITH_INPUTS & (RULE_READ | RULE_AXIS);
    {CHANNEL_ENCODER_POSITION_BASE[7:3], 3'b???}: channel_rule = WITH_ENCODERS & (RULE_READ | RULE_AXIS);
    CHANNEL_FOLLOW:                               channel_rule = WITH_ENCODERS & (RULE_WRITE | RULE_QUIET | 13'd7);
    CHANNEL_FOLLOW_LIMIT:                         channel_rule = WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | RULE_POWER | 13'd31);
    CHANNEL_ENCODER_FILTER:                       channel_rule = WITH_ENCODERS & (RULE_WRITE | 13'd7);
    CHANNEL_FOLLOW_STATE:                         channel_rule = WITH_ENCODERS & RULE_READ;
    8'b????????:                                  channel_rule = 13'd0;
  endcase
endfunction

function [12:0] axis_rule(input [2:0] address);
  casez (address)
    AXIS_PINS:        axis_rule = RULE_WRITE | RULE_QUIET | RULE_EVEN | 13'd4;
    AXIS_STEP_TIMING: axis_rule = RULE_WRITE | 13'd31;
    AXIS_DIR_TIMING:  axis_rule = RULE_WRITE | 13'd31;
    AXIS_LOST_STEPS:  axis_rule = RULE_READ;
    AXIS_ENABLE:      axis_rule = RULE_WRITE | 13'd0;
    AXIS_INPUTS:      axis_rule = WITH_INPUTS & (RULE_WRITE | RULE_QUIET | 13'd6);
    3'b???:           axis_rule = 13'd0;
  endcase
endfunction

function [12:0] encoder_rule(input [2:0] address);
  casez (address)
    ENCODER_SETUP:    encoder_rule = WITH_ENCODERS & (RULE_WRITE | 13'd4);
    ENCODER_RATIO:    encoder_rule = WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | 13'd31);
    ENCODER_LIMIT:    encoder_rule = WITH_ENCODERS & (RULE_WRITE | RULE_NONZERO | 13'd15);
    ENCODER_ERROR:    encoder_rule = WITH_ENCODERS & RULE_READ;
    ENCODER_GREATEST: encoder_rule = WITH_ENCODERS & RULE_READ;
    ENCODER_INDEX:    encoder_rule = WITH_ENCODERS & RULE_READ;
    3'b???:           encoder_rule = 13'd0;
  endcase
endfunction
