// SPDX-License-Identifier: MIT
// Encoder of one axis: settings, following error, index latch, and their registers.
//
// Promise: `stop_soft` and `stop_hard` are high while the following error is at its limit, as the setup says. The latch
// has the lower 16 bits of the count at the last index.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoder_axis (
  input  wire        clk,
  input  wire        rst,
  // pins
  input  wire        a,
  input  wire        b,
  input  wire        index,
  // registers: strobes with bus_data; a read strobe is answered immediately
  input  wire        write_setup,
  input  wire        write_ratio,
  input  wire        write_limit,
  input  wire [31:0] bus_data,
  input  wire        read_error,
  input  wire        read_greatest,
  input  wire        read_index,
  output wire [31:0] read_data,
  // channel
  input  wire [ 7:0] filter,
  input  wire        zero,
  input  wire        clear,
  input  wire        step_made,
  input  wire        step_direction,
  output wire        count_made,
  output wire        count_down,
  output wire        slipped,
  output wire        index_active,
  output wire        index_event,
  output wire        stop_soft,
  output wire        stop_hard
);

  `include "passo_registers.vh"

  reg         inverted;
  reg         index_inverted;
  reg         index_gated;
  reg         stops_soft;
  reg         stops_hard;
  reg  [31:0] ratio;
  reg  [15:0] limit;
  reg  [15:0] count;
  reg  [15:0] latch;
  reg  [ 7:0] indexes;
  reg         index_event_q;
  wire [ 7:0] illegal;
  /* verilator lint_off UNUSEDSIGNAL */
  wire [34:0] error;  // the host gets 1/256 counts
  /* verilator lint_on UNUSEDSIGNAL */
  wire        exceeded;
  wire [17:0] greatest;

  assign stop_soft = exceeded & stops_soft;
  assign stop_hard = exceeded & stops_hard;
  assign read_data = (read_error ? {{5{error[34]}}, error[34:8]} : 32'd0)
                     | (read_greatest ? {exceeded, 13'd0, greatest} : 32'd0)
                     | (read_index ? {illegal, indexes, latch} : 32'd0);

  always @(posedge clk) begin
    if (write_setup) {stops_hard, stops_soft, index_gated, index_inverted, inverted} <= bus_data[4:0];
    if (write_ratio) ratio <= bus_data;
    if (write_limit) limit <= bus_data[15:0];
    if (count_made) count <= count + {{15{count_down}}, 1'b1};
    index_event_q <= index_event;
    if (index_event_q) begin
      latch   <= count;
      indexes <= indexes + 8'd1;
    end
    if (rst || zero) begin
      count         <= 16'd0;
      latch         <= 16'd0;
      indexes       <= 8'd0;
      index_event_q <= 1'b0;
    end
    if (rst) begin
      inverted       <= ENCODER_SETUP_INVERTED_RESET;
      index_inverted <= ENCODER_SETUP_INDEX_INVERTED_RESET;
      index_gated    <= ENCODER_SETUP_INDEX_GATED_RESET;
      stops_soft     <= ENCODER_SETUP_STOP_SOFT_RESET;
      stops_hard     <= ENCODER_SETUP_STOP_HARD_RESET;
      ratio          <= ENCODER_RATIO_RESET;
      limit          <= ENCODER_LIMIT_RESET;
    end
  end

  passo_encoder u_encoder (
    .clk           (clk),
    .rst           (rst),
    .a             (a),
    .b             (b),
    .index         (index),
    .filter        (filter),
    .inverted      (inverted),
    .index_inverted(index_inverted),
    .index_gated   (index_gated),
    .clear         (zero | clear),
    .count_made    (count_made),
    .count_down    (count_down),
    .slipped       (slipped),
    .index_active  (index_active),
    .index_event   (index_event),
    .illegal       (illegal)
  );

  passo_following u_following (
    .clk           (clk),
    .rst           (rst),
    .zero          (zero | write_ratio),
    .clear         (clear),
    .step_made     (step_made),
    .step_direction(step_direction),
    .count_made    (count_made),
    .count_down    (count_down),
    .ratio         (ratio),
    .limit         (limit),
    .error         (error),
    .exceeded      (exceeded),
    .greatest      (greatest)
  );

`ifdef FORMAL
  `include "passo_encoder_axis_formal.vh"
`endif

endmodule
`resetall
