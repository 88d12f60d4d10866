// SPDX-License-Identifier: MIT
// DDA of one axis: spreads the N steps of a line evenly over its M substeps.
//
//   each substep:  e += N;  if e >= M { e -= M; a step }           e = floor(M / 2) when the line starts
//
// `e` is kept as e - M, which is below 0 whenever a substep begins: 30 bits of it are enough. Clock A adds N; if
// no carry comes out it is still below 0 (`below`), else clock B takes M off again. At the end of a line e would
// be back at its start value; A leaves 0 instead, and B adds the start value of the next line: only e and the
// addend enter the sum's carry chain.
//
// Promise: exactly N steps in M substeps, for any 0 <= N <= M. `step_request` is high in clock B.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_dda (
  input  wire               clk,
  input  wire               add_n,         // clock A of a substep
  input  wire               load_start,    // clock A when a new line begins
  input  wire               decide_step,   // clock B of a substep
  input  wire               load_start_q,  // clock B when a new line begins
  input  wire signed [30:0] line_addend,   // in A: -M, or the start value of the new line
  input  wire        [29:0] steps,         // N of the current line; in B already that of the new one
  output wire               step_request
);

  reg  [29:0] e_minus_m;
  reg  [30:0] addend;
  // e + N >= M: the carry of the sum, if N is the addend. With an operand in its place that is not constant, LUT and
  // flip-flop of the carry stay in the chain.
  reg         reached;
  wire [30:0] sum = {addend[30], e_minus_m} + addend;

  assign step_request = decide_step & reached;

  always @(posedge clk) begin
    addend  <= (add_n || load_start) ? line_addend : {1'b0, steps};
    reached <= sum[30];
    if (add_n || load_start || load_start_q || step_request) e_minus_m <= load_start ? 30'd0 : sum[29:0];
  end

`ifdef FORMAL
  `include "passo_dda_formal.vh"
`endif

endmodule
`resetall
