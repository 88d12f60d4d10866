// SPDX-License-Identifier: MIT
// Registers of the axes of a channel: write strobes, and what is read.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0; `answers_position`:
// it is a position, which this module does not have. `select_axis` has the bit of the axis whose block is addressed.
// `timing` and its place (3: step_high, 2: step_low, 1: dir_setup, 0: dir_hold) are the upper half of a timing word
// with its strobe, and the lower half in the next clock.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_registers #(
  parameter AXES   = 4,
  parameter INPUTS = 0
) (
  input wire clk,
  input wire rst,
  // bus
  input wire bus_write,
  input wire bus_read,
  input wire [AXES-1:0] select_axis,
  input wire select_position,
  input wire [2:0] bus_address,  // within the block
  input wire [31:0] bus_data,
  output reg [3:0] read_data,
  output reg answers_position,
  // axes
  output reg [AXES-1:0] write_pins,  // strobes, one clock after bus_write, with bus_data
  output reg [AXES-1:0] write_step_timing,
  output reg [AXES-1:0] write_dir_timing,
  output reg [AXES-1:0] write_enable,
  output reg [AXES-1:0] write_inputs,
  output reg [1:0] timing_place,
  output reg [15:0] timing,  // 0 counts as 1
  output reg timing_is_minimal,  // it is 1
  output reg [15:0] half,  // of bus_data: the upper one after bus_write, then the lower one
  input wire [AXES*4-1:0] lost
);

  `include "passo_registers.vh"

  always @(posedge clk) begin
    write_pins        <= select_axis & {AXES{bus_write && bus_address == AXIS_PINS}};
    write_step_timing <= select_axis & {AXES{bus_write && bus_address == AXIS_STEP_TIMING}};
    write_dir_timing  <= select_axis & {AXES{bus_write && bus_address == AXIS_DIR_TIMING}};
    write_enable      <= select_axis & {AXES{bus_write && bus_address == AXIS_ENABLE}};
    write_inputs      <= select_axis & {AXES{bus_write && bus_address == AXIS_INPUTS && INPUTS != 0}};
    if (rst) begin
      write_pins        <= {AXES{1'b0}};
      write_step_timing <= {AXES{1'b0}};
      write_dir_timing  <= {AXES{1'b0}};
      write_enable      <= {AXES{1'b0}};
      write_inputs      <= {AXES{1'b0}};
    end
  end

  reg     [3:0] selected_lost;
  integer       i;
  always @* begin
    selected_lost = 4'd0;
    for (i = 0; i < AXES; i = i + 1) selected_lost = selected_lost | (lost[i*4+:4] & {4{select_axis[i]}});
  end

  // bus_data stands in the clock of bus_write and the one after
  wire [15:0] half_next = bus_write ? bus_data[31:16] : bus_data[15:0];
  wire        next_is_minimal = half_next[15:1] == 15'd0;

  always @(posedge clk) begin
    half              <= half_next;
    timing            <= {half_next[15:1], half_next[0] | next_is_minimal};
    timing_is_minimal <= next_is_minimal;
    timing_place[0]   <= bus_write;
    if (bus_write) timing_place[1] <= bus_address == AXIS_STEP_TIMING;
    read_data        <= bus_read && bus_address == AXIS_LOST_STEPS ? selected_lost : 4'd0;
    answers_position <= bus_read & select_position;
    if (rst) begin
      read_data        <= 4'd0;
      answers_position <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_axis_registers_formal.vh"
`endif

endmodule
`resetall
