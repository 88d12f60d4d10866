// SPDX-License-Identifier: MIT
// Registers of the encoders of a channel: address decode, strobes, settings of the channel.
//
// The values of reads come from the encoders: `read_...` is high one clock after `bus_read`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoder_registers #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            select,
  input  wire [     7:0] bus_address,    // within the channel
  input  wire [    31:0] bus_data,
  // axes: strobes, one bit per axis
  output reg  [AXES-1:0] write_setup,    // one clock after bus_write, with bus_data
  output reg  [AXES-1:0] write_ratio,
  output reg  [AXES-1:0] write_limit,
  output reg  [AXES-1:0] read_error,     // in the clock of the answer
  output reg  [AXES-1:0] read_greatest,
  output reg  [AXES-1:0] read_index,
  output reg             read_position,
  output reg             read_follow,
  // settings
  output reg             follow,
  output reg             wait_index,
  output reg  [     2:0] source,
  output reg  [     2:0] scale,
  output reg  [    31:0] follow_limit,
  output reg  [     7:0] filter
);

  `include "passo_registers.vh"

  // Decoded one clock ahead of the strobe: the address is stable by then.
  wire [     2:0] number = bus_address[2:0];
  reg  [AXES-1:0] select_axis;  // the axis of the address
  reg             in_positions;
  reg             in_settings;
  reg             write_follow;
  reg             write_follow_limit;
  reg             write_filter;

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      localparam [2:0] NUMBER = axis;
      always @(posedge clk)
        select_axis[axis] <= select && bus_address[7:3] == {CHANNEL_ENCODER_BASE[7:6], NUMBER};
    end
  endgenerate

  always @(posedge clk) begin
    in_positions       <= select && bus_address[7:3] == CHANNEL_ENCODER_POSITION_BASE[7:3];
    in_settings        <= select && bus_address[7:3] == CHANNEL_FOLLOW[7:3];
    read_error         <= select_axis & {AXES{bus_read && number == ENCODER_ERROR}};
    read_greatest      <= select_axis & {AXES{bus_read && number == ENCODER_GREATEST}};
    read_index         <= select_axis & {AXES{bus_read && number == ENCODER_INDEX}};
    read_position      <= bus_read && in_positions && {1'b0, number} < AXES[3:0];
    read_follow        <= bus_read && in_settings && number == CHANNEL_FOLLOW_STATE[2:0];
    write_setup        <= select_axis & {AXES{bus_write && number == ENCODER_SETUP}};
    write_ratio        <= select_axis & {AXES{bus_write && number == ENCODER_RATIO}};
    write_limit        <= select_axis & {AXES{bus_write && number == ENCODER_LIMIT}};
    write_follow       <= bus_write && in_settings && number == CHANNEL_FOLLOW[2:0];
    write_follow_limit <= bus_write && in_settings && number == CHANNEL_FOLLOW_LIMIT[2:0];
    write_filter       <= bus_write && in_settings && number == CHANNEL_ENCODER_FILTER[2:0];
    if (rst) begin
      {read_error, read_greatest, read_index}          <= {3 * AXES{1'b0}};
      {read_position, read_follow}                     <= 2'b00;
      {write_setup, write_ratio, write_limit}          <= {3 * AXES{1'b0}};
      {write_follow, write_follow_limit, write_filter} <= 3'b000;
    end
  end

  always @(posedge clk) begin
    if (write_follow) {scale, source, wait_index, follow} <= bus_data[7:0];
    if (write_follow_limit) follow_limit <= bus_data;
    if (write_filter) filter <= bus_data[7:0];
    if (rst) begin
      follow       <= CHANNEL_FOLLOW_FOLLOW_RESET;
      wait_index   <= CHANNEL_FOLLOW_WAIT_INDEX_RESET;
      source       <= CHANNEL_FOLLOW_SOURCE_RESET;
      scale        <= CHANNEL_FOLLOW_SCALE_RESET;
      follow_limit <= CHANNEL_FOLLOW_LIMIT_LIMIT_RESET;
      filter       <= CHANNEL_ENCODER_FILTER_FILTER_RESET;
    end
  end

`ifdef FORMAL
  `include "passo_encoder_registers_formal.vh"
`endif

endmodule
`resetall
