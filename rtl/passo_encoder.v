// SPDX-License-Identifier: MIT
// Encoder: quadrature and index of one axis.
//
//   A  ____/~~~~~~~~\________/~~~~~~~~\____        A before B: up, unless `inverted`
//   B  ________/~~~~~~~~\________/~~~~~~~~\        every edge is a count
//
// Promise: after the filter, each change of one of A and B is one count, in its direction; a simultaneous
// change is an illegal transition: not a count, but `slipped`, and counted in `illegal`, saturating at 255.
// `index_event` is high for one clock when the index becomes active or, with `index_gated`, when index, A and B are
// all high for the first time: with an index at least as wide as a count this is always at the same count, even if
// its edge coincides with one of A or B. The levels of A, B and index at the end of a reset are not an event.
// Latency: pin to count_made and index_event 4 + filter clocks. A count in the clock of index_event is the one that
// leads to the index.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoder (
  input  wire       clk,
  input  wire       rst,
  // pins
  input  wire       a,
  input  wire       b,
  input  wire       index,
  // settings
  input  wire [7:0] filter,          // clocks
  input  wire       inverted,        // B before A: up
  input  wire       index_inverted,  // the index is active low
  input  wire       index_gated,
  input  wire       clear,           // clears `illegal`
  output wire       index_active,    // not filtered, 2 clocks late
  // strobes
  output reg        count_made,
  output reg        count_down,      // with count_made: -1
  output reg        slipped,         // A and B changed together
  output reg        index_event,
  output reg  [7:0] illegal
);

  wire level_a;
  wire level_b;
  wire level_index;
  wire sampled_a;
  wire sampled_b;
  wire sampled_index;
  reg  a_q;
  reg  b_q;
  reg  active_q;

  wire changed_a = level_a ^ a_q;
  wire changed_b = level_b ^ b_q;
  wire active = (level_index ^ index_inverted) & (~index_gated | (level_a & level_b));

  assign index_active = (sampled_index ^ index_inverted) & (~index_gated | (sampled_a & sampled_b));

  passo_encoder_filter u_a (
    .clk    (clk),
    .rst    (rst),
    .pin    (a),
    .length (filter),
    .sampled(sampled_a),
    .level  (level_a)
  );

  passo_encoder_filter u_b (
    .clk    (clk),
    .rst    (rst),
    .pin    (b),
    .length (filter),
    .sampled(sampled_b),
    .level  (level_b)
  );

  passo_encoder_filter u_index (
    .clk    (clk),
    .rst    (rst),
    .pin    (index),
    .length (filter),
    .sampled(sampled_index),
    .level  (level_index)
  );

  always @(posedge clk) begin
    a_q         <= level_a;
    b_q         <= level_b;
    active_q    <= active;
    count_made  <= changed_a ^ changed_b;
    slipped     <= changed_a & changed_b;
    count_down  <= ~(level_a ^ b_q) ^ inverted;
    index_event <= active & ~active_q;
    if (changed_a && changed_b && illegal != 8'hFF) illegal <= illegal + 8'd1;
    if (clear) illegal <= 8'd0;
    if (rst) begin
      a_q         <= sampled_a;  // as the filters do
      b_q         <= sampled_b;
      active_q    <= 1'b1;
      count_made  <= 1'b0;
      count_down  <= 1'b0;
      slipped     <= 1'b0;
      index_event <= 1'b0;
      illegal     <= 8'd0;
    end
  end

`ifdef FORMAL
  `include "passo_encoder_formal.vh"
`endif

endmodule
`resetall
