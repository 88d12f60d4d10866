// SPDX-License-Identifier: MIT
// DDA of one axis: spreads the N steps of a line evenly over its M substeps.
//
//   each substep:  e += N;  if e >= M { e -= M; a step }           e = floor(M / 2) when the line starts
//
// The register holds e - M, negative whenever a substep begins, so 30 bits suffice. Clock A adds N; without a carry
// the sum is still negative, with one clock B makes a step and subtracts M. At the end of a line e would be back at
// its start value; A clears the register instead and B adds the start value of the next line: only the register and
// the addend enter the carry chain.
//
// Promise: exactly N steps in M substeps, for any 0 <= N <= M. `step_request` is high in clock B.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_dda (
  input  wire               clk,
  input  wire               add_n,         // A: e += N
  input  wire               load_start,    // A at the start of a line: clear
  input  wire               decide_step,   // B: if e >= M, a step and e -= M
  input  wire               load_start_q,  // B at the start of a line: e = start value
  input  wire signed [30:0] line_addend,   // in A: -M, or the start value of the new line
  input  wire        [29:0] steps,         // N of the current line; in B already that of the new one
  output wire               step_request
);

  reg  [29:0] e_minus_m;
  reg  [30:0] addend;
  // e + N >= M: the carry of the sum in clock A, when addend[30] is 0. That bit, as an operand that is not constant,
  // keeps the LUT and flip-flop of the carry in the chain; on both inputs it may leave the router without an end.
  reg         reached;
  wire [30:0] sum = {1'b0, e_minus_m} + addend;

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
