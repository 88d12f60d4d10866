// SPDX-License-Identifier: MIT
// Registers of the encoders of a channel: address decode, checks, write strobes, settings of the channel.
//
// Promise: a strobe is answered one clock later, for one clock; the answer is 0 unless one of these registers is
// addressed. The values of reads come from the encoders: `reads_...` is high in the clock of the answer.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoder_registers #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_check,
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            bus_push,
  input  wire            select,
  input  wire [     7:0] bus_address,    // within the channel
  input  wire [    31:0] bus_data,
  input  wire [     4:0] bus_msb,
  input  wire            bus_one_hot,
  output reg             claim,
  output reg  [     3:0] refusal,
  output wire            needs_quiet,    // strobe: FOLLOW is being checked
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
  reg  [AXES-1:0] select_position;
  wire            is_axis = select_axis != {AXES{1'b0}};
  reg             is_follow;
  reg             is_follow_limit;
  reg             is_filter;
  reg             is_follow_state;
  reg             is_position;
  reg             is_setup;
  reg             is_ratio;
  reg             is_limit;
  reg             is_error;
  reg             is_greatest;
  reg             is_index;
  reg             write_follow;
  reg             write_follow_limit;
  reg             write_filter;

  // Answer to a check
  wire readable = is_follow_state | is_position | is_error | is_greatest | is_index;
  wire writable = is_setup | is_ratio | is_limit | is_follow | is_follow_limit | is_filter;
  wire is_zero = bus_msb == 5'd0 & ~bus_data[0];
  reg  bad_value;

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      localparam [2:0] NUMBER = axis;
      always @(posedge clk) begin
        select_axis[axis]     <= select && bus_address[7:3] == {CHANNEL_ENCODER_BASE[7:6], NUMBER};
        select_position[axis] <= select && bus_address == CHANNEL_ENCODER_POSITION_BASE + {5'd0, NUMBER};
      end
    end
  endgenerate

  always @(posedge clk) begin
    is_position <= select_position != {AXES{1'b0}};
    is_follow <= select && bus_address == CHANNEL_FOLLOW;
    is_follow_limit <= select && bus_address == CHANNEL_FOLLOW_LIMIT;
    is_filter <= select && bus_address == CHANNEL_ENCODER_FILTER;
    is_follow_state <= select && bus_address == CHANNEL_FOLLOW_STATE;
    is_setup <= is_axis && number == ENCODER_SETUP;
    is_ratio <= is_axis && number == ENCODER_RATIO;
    is_limit <= is_axis && number == ENCODER_LIMIT;
    is_error <= is_axis && number == ENCODER_ERROR;
    is_greatest <= is_axis && number == ENCODER_GREATEST;
    is_index <= is_axis && number == ENCODER_INDEX;
    bad_value <= ((is_follow || is_filter) && bus_msb > 5'd7)
                 || (is_axis && number == ENCODER_SETUP && bus_msb > 5'd4)
                 || (is_axis && number == ENCODER_LIMIT && bus_msb > 5'd15)
                 || ((is_follow_limit || (is_axis && (number == ENCODER_RATIO || number == ENCODER_LIMIT))) && is_zero)
                 || (is_follow_limit && bus_msb == 5'd31 && !bus_one_hot);
  end

  assign needs_quiet = bus_check & is_follow;

  always @(posedge clk) begin
    claim   <= (bus_check | bus_read) & (readable | writable);
    refusal <= VERDICT_OK;
    if (bus_check && (readable || writable))
      refusal <= bus_push  ? VERDICT_BAD_OPERATION :
                 readable  ? VERDICT_READ_ONLY :
                 bad_value ? VERDICT_BAD_VALUE : VERDICT_OK;
    if (bus_read && writable) refusal <= VERDICT_BAD_OPERATION;
    read_error         <= select_axis & {AXES{bus_read & is_error}};
    read_greatest      <= select_axis & {AXES{bus_read & is_greatest}};
    read_index         <= select_axis & {AXES{bus_read & is_index}};
    read_position      <= bus_read & is_position;
    read_follow        <= bus_read & is_follow_state;
    write_setup        <= select_axis & {AXES{bus_write & is_setup}};
    write_ratio        <= select_axis & {AXES{bus_write & is_ratio}};
    write_limit        <= select_axis & {AXES{bus_write & is_limit}};
    write_follow       <= bus_write & is_follow;
    write_follow_limit <= bus_write & is_follow_limit;
    write_filter       <= bus_write & is_filter;
    if (rst) begin
      claim                                            <= 1'b0;
      refusal                                          <= VERDICT_OK;
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

endmodule
`resetall
