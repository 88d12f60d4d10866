// SPDX-License-Identifier: MIT
// Registers of the axes of a channel: address decode, checks, write strobes, answers.
//
// Promise: a strobe is answered one clock later, for one clock; the answer is 0 unless one of these registers is
// addressed. `select_axis` has the bit of the axis whose block is addressed, `select_position` that of the axis whose
// position is. `answers_position`: the answer is a position, which this module does not have.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_registers #(
  parameter AXES   = 4,
  parameter INPUTS = 0
) (
  input  wire              clk,
  input  wire              rst,
  // bus
  input  wire              bus_check,
  input  wire              bus_write,
  input  wire              bus_read,
  input  wire              bus_push,
  input  wire [  AXES-1:0] select_axis,
  input  wire [  AXES-1:0] select_position,
  input  wire [       2:0] bus_address,        // within the block
  input  wire [      31:0] bus_data,
  input  wire [       4:0] bus_msb,
  output reg               claim,
  output reg  [       3:0] refusal,
  output reg  [       3:0] read_data,
  output reg               answers_position,
  // axes
  output reg  [  AXES-1:0] write_pins,         // strobes, one clock after bus_write, with bus_data
  output reg  [  AXES-1:0] write_step_timing,
  output reg  [  AXES-1:0] write_dir_timing,
  output reg  [  AXES-1:0] write_enable,
  output reg  [  AXES-1:0] write_inputs,
  output reg               upper_is_minimal,   // half of bus_data is 0 or 1: a time of one clock
  output reg               lower_is_minimal,
  output wire              needs_quiet,        // strobe: PINS or INPUTS of an axis is being checked
  input  wire [AXES*4-1:0] lost
);

  `include "passo_registers.vh"

  // Decoded one clock ahead of the strobe: the address is stable by then.
  reg  is_pins;
  reg  is_step_timing;
  reg  is_dir_timing;
  reg  is_enable;
  reg  is_lost;
  reg  is_inputs;
  wire is_axis = select_axis != {AXES{1'b0}};
  reg  readable;  // LOST_STEPS or a position
  reg  writable;
  reg  bad_value;  // undefined bits are set

  always @(posedge clk) begin
    is_pins <= is_axis && bus_address == AXIS_PINS;
    is_step_timing <= is_axis && bus_address == AXIS_STEP_TIMING;
    is_dir_timing <= is_axis && bus_address == AXIS_DIR_TIMING;
    is_enable <= is_axis && bus_address == AXIS_ENABLE;
    is_lost <= is_axis && bus_address == AXIS_LOST_STEPS;
    is_inputs <= INPUTS != 0 && is_axis && bus_address == AXIS_INPUTS;
    readable <= (is_axis && bus_address == AXIS_LOST_STEPS) || select_position != {AXES{1'b0}};
    writable          <= is_axis && (bus_address == AXIS_PINS || bus_address == AXIS_STEP_TIMING
                                     || bus_address == AXIS_DIR_TIMING || bus_address == AXIS_ENABLE
                                     || (INPUTS != 0 && bus_address == AXIS_INPUTS));
    write_pins <= select_axis & {AXES{bus_write & is_pins}};
    write_step_timing <= select_axis & {AXES{bus_write & is_step_timing}};
    write_dir_timing <= select_axis & {AXES{bus_write & is_dir_timing}};
    write_enable <= select_axis & {AXES{bus_write & is_enable}};
    write_inputs <= select_axis & {AXES{bus_write & is_inputs}};
    if (rst) begin
      write_pins        <= {AXES{1'b0}};
      write_step_timing <= {AXES{1'b0}};
      write_dir_timing  <= {AXES{1'b0}};
      write_enable      <= {AXES{1'b0}};
      write_inputs      <= {AXES{1'b0}};
    end
  end

  assign needs_quiet = bus_check & (is_pins | is_inputs);

  reg     [3:0] selected_lost;
  integer       i;
  always @* begin
    selected_lost = 4'd0;
    for (i = 0; i < AXES; i = i + 1) selected_lost = selected_lost | (lost[i*4+:4] & {4{select_axis[i]}});
  end

  always @(posedge clk) begin
    upper_is_minimal <= bus_data[31:16] < 16'd2;
    lower_is_minimal <= bus_data[15:0] < 16'd2;
    bad_value        <= bus_address == AXIS_PINS   ? bus_msb > 5'd4 || bus_data[0] :
                        bus_address == AXIS_INPUTS ? INPUTS != 0 && bus_msb > 5'd6 :
                        bus_address == AXIS_ENABLE && bus_msb != 5'd0;
    claim <= (bus_check | bus_read) & (readable | writable);
    refusal <= VERDICT_OK;
    read_data <= bus_read && is_lost ? selected_lost : 4'd0;
    answers_position <= bus_read & readable & ~is_lost;
    if (bus_check && (readable || writable))
      refusal <= bus_push             ? VERDICT_BAD_OPERATION :
                 readable             ? VERDICT_READ_ONLY :
                 bad_value            ? VERDICT_BAD_VALUE : VERDICT_OK;
    if (bus_read && writable) refusal <= VERDICT_BAD_OPERATION;
    if (rst) begin
      claim            <= 1'b0;
      refusal          <= VERDICT_OK;
      read_data        <= 4'd0;
      answers_position <= 1'b0;
    end
  end

endmodule
`resetall
