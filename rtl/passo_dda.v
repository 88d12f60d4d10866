// SPDX-License-Identifier: MIT
// DDA of one axis: spreads the N steps of a line evenly over its M substeps.
//
//   each substep:  e += N;  if e >= M { e -= M; a step }           e = floor(M / 2) when the line starts
//
// `e` is kept as e - M, so that the test is a sign bit: clock A adds N, clock B takes M off again when the
// sign is clear. At the end of a line e is back at its start value, so B loads that of the next line instead.
//
// Promise: exactly N steps in M substeps, for any 0 <= N <= M. `step_request` is high in clock B.
`resetall
`default_nettype none

module passo_dda (
  input  wire               clk,
  input  wire               slot_add,     // clock A of a substep
  input  wire               slot_load,    // clock A when a new line begins
  input  wire               slot_step,    // clock B of a substep
  input  wire               slot_load_q,  // clock B when a new line begins
  input  wire signed [32:0] broadcast,    // in A: -M, or the start value of the new line
  input  wire        [31:0] steps,        // N of the current line; in B already that of the new one
  output wire               step_request
);

  reg signed [32:0] e_minus_m;
  reg signed [32:0] addend;

  // A cell of the carry chain chooses between sum and addend as well. All but three of them: placers count the
  // inputs of eight neighbours and the clock enable, and would cut the chain if these were too many.
  wire [32:0] sum;
  (* keep *)
  wire [2:0] sum_apart;
  wire [32:0] e_next = slot_load_q ? addend : {sum[32:28], sum_apart[2], sum[26:20], sum_apart[1],
                                               sum[18:12], sum_apart[0], sum[10:0]};

  assign sum       = e_minus_m + addend;
  assign sum_apart = {sum[27], sum[19], sum[11]};

  assign step_request = slot_step & ~e_minus_m[32];

  always @(posedge clk) begin
    addend <= (slot_add || slot_load) ? broadcast : $signed({1'b0, steps});
    if (slot_load_q || slot_add || step_request) e_minus_m <= e_next;
  end

`ifdef FORMAL
  `include "passo_dda_formal.vh"
`endif

endmodule
`resetall
