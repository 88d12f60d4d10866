// SPDX-License-Identifier: MIT
// Registers of one channel: commands, time scale, drain velocity, state; and the address decode of its blocks.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0. A command strobe is
// high in the clock after its write. STOP or ABORT masks CLEAR and ZERO in the same word, ABORT masks STOP: no state
// refuses either.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel_registers #(
  parameter AXES            = 4,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter RAMP_QUEUE_LOG2 = 4,
  parameter INPUTS          = 0
) (
  input  wire                     clk,
  input  wire                     rst,
  // bus
  input  wire                     bus_check,
  input  wire                     bus_write,
  input  wire                     bus_read,
  input  wire                     bus_push,
  input  wire                     select,
  input  wire [              7:0] bus_address,        // within the channel
  input  wire [             31:0] bus_data,
  output wire [             31:0] read_data,
  // blocks
  output reg                      select_line_queue,  // a push to it
  output reg                      select_ramp_queue,
  output reg  [         AXES-1:0] select_axis,
  output reg                      select_position,
  // settings
  output reg  [             16:0] rate_target,
  output reg  [             16:0] rate_slew,
  output reg  [             16:0] stop_slew,
  output reg  [             31:0] drain_velocity,
  // commands
  output reg                      command_stop,
  output reg                      command_abort,
  output reg                      command_clear,
  output reg                      command_zero,
  // strobes: what the command being checked needs
  output wire                     needs_idle,
  output wire                     needs_quiet,
  // state
  input  wire                     quiet,
  input  wire [              2:0] state,
  input  wire [              3:0] cause,
  input  wire                     stopping,
  input  wire [         AXES-1:0] overrun,
  input  wire [             14:0] drained,
  input  wire [             16:0] rate,
  input  wire [             31:0] velocity,           // upper 32 bits
  input  wire [LINE_QUEUE_LOG2:0] line_room,
  input  wire [RAMP_QUEUE_LOG2:0] ramp_room
);

  `include "passo_registers.vh"

  wire [7:0] overrun_padded = {{(8 - AXES) {1'b0}}, overrun};

  wire [2:0] number = bus_address[2:0];

  // Decoded one clock ahead of the strobe: the address is stable by then.
  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      localparam [2:0] NUMBER = axis;
      always @(posedge clk)
        select_axis[axis] <= select && bus_address[7:3] == {CHANNEL_AXIS_BASE[7:6], NUMBER};
    end
  endgenerate
  always @(posedge clk) begin
    select_line_queue <= select && bus_push && bus_address == CHANNEL_LINE;
    select_ramp_queue <= select && bus_push && bus_address == CHANNEL_RAMP;
    select_position   <= select && {1'b0, number} < AXES[3:0]
                         && (bus_address[7:3] == CHANNEL_POSITION_BASE[7:3]
                             || (INPUTS != 0 && bus_address[7:3] == CHANNEL_TRIGGER_POSITION_BASE[7:3]));
  end

  // Write-only registers, and the block of read-only ones
  reg is_command;
  reg is_rate_target;
  reg is_rate_slew;
  reg is_stop_slew;
  reg is_drain_velocity;
  reg in_state;

  always @(posedge clk) begin
    is_command        <= select && bus_address == CHANNEL_COMMAND;
    is_rate_target    <= select && bus_address == CHANNEL_RATE_TARGET;
    is_rate_slew      <= select && bus_address == CHANNEL_RATE_SLEW;
    is_stop_slew      <= select && bus_address == CHANNEL_STOP_SLEW;
    is_drain_velocity <= select && bus_address == CHANNEL_DRAIN_VELOCITY;
    in_state          <= select && bus_address[7:2] == CHANNEL_STATE[7:2];
  end

  wire abort = bus_data[CHANNEL_COMMAND_ABORT_LSB];
  wire stop = bus_data[CHANNEL_COMMAND_STOP_LSB] & ~abort;
  wire clear = bus_data[CHANNEL_COMMAND_CLEAR_LSB] & ~stop & ~abort;
  wire zero = bus_data[CHANNEL_COMMAND_ZERO_LSB] & ~stop & ~abort;

  assign needs_idle  = bus_check & is_command & clear;
  assign needs_quiet = bus_check & is_command & zero;

  // Reading
  reg     [3:0] reads;
  integer       i;

  always @(posedge clk)
    for (i = 0; i < 4; i = i + 1)
      reads[i] <= bus_read && in_state && number[1:0] == i[1:0];

  assign read_data =
      (reads[0] ? {drained, stopping, overrun_padded, cause, quiet, state} : 32'd0)
      | (reads[1] ? {15'd0, rate} : 32'd0)
      | (reads[2] ? {{(15 - LINE_QUEUE_LOG2) {1'b0}}, line_room, {(15 - RAMP_QUEUE_LOG2) {1'b0}}, ramp_room} : 32'd0)
      | (reads[3] ? velocity : 32'd0);

  // Writing
  reg drain_velocity_written;

  always @(posedge clk) begin
    {command_zero, command_clear, command_abort, command_stop} <= {zero, clear, abort, stop} & {4{bus_write & is_command}};
    if (bus_write && is_rate_target) rate_target <= bus_data[16:0];
    if (bus_write && is_rate_slew) rate_slew <= bus_data[16:0];
    if (bus_write && is_stop_slew) stop_slew <= bus_data[16:0];
    // the path takes the upper bits one clock after the lower ones
    drain_velocity_written <= bus_write && is_drain_velocity;
    if (bus_write && is_drain_velocity) drain_velocity[7:0] <= bus_data[7:0];
    if (drain_velocity_written) drain_velocity[31:8] <= bus_data[31:8];
    if (rst) begin
      rate_target                                                <= CHANNEL_RATE_TARGET_RESET;
      rate_slew                                                  <= CHANNEL_RATE_SLEW_RESET;
      stop_slew                                                  <= CHANNEL_STOP_SLEW_RESET;
      drain_velocity                                             <= CHANNEL_DRAIN_VELOCITY_RESET;
      drain_velocity_written                                     <= 1'b0;
      {command_zero, command_clear, command_abort, command_stop} <= 4'd0;
    end
  end

endmodule
`resetall
