// SPDX-License-Identifier: MIT
// Path: sums the velocity; each carry is a substep.
//
//   every enabled clock:  phase += velocity;  carry out = substep         phase = 1/4 on `restart`
//
// The 48-bit sum is cut into two halves of 24 bits, the upper one a clock behind.
// Promise: `substep` comes 2 clocks after its `advance`; with velocity <= 1/2 never on two clocks in a row.
`resetall
`default_nettype none

module passo_path (
  input  wire        clk,
  input  wire        rst,
  input  wire        restart,
  input  wire        advance,   // enabled clock
  input  wire [47:0] velocity,  // UQ0.48 substeps per clock, 0 .. 1/2
  output reg         substep
);

  localparam [23:0] QUARTER = 24'h400000;

  reg [23:0] phase_low;
  reg        phase_low_carry;
  reg [23:0] phase_high;
  reg [23:0] velocity_high_q;
  reg        advance_q;

  wire [24:0] phase_low_sum = {1'b0, phase_low} + {1'b0, velocity[23:0]};
  wire [24:0] phase_high_sum = {1'b0, phase_high} + {1'b0, velocity_high_q} + {24'd0, phase_low_carry};

  always @(posedge clk) begin
    advance_q <= advance;
    if (advance) begin
      {phase_low_carry, phase_low} <= phase_low_sum;
      velocity_high_q              <= velocity[47:24];
    end
    substep <= 1'b0;
    if (advance_q) {substep, phase_high} <= phase_high_sum;
    if (rst || restart) begin
      advance_q       <= 1'b0;
      phase_low       <= 24'd0;
      phase_low_carry <= 1'b0;
      phase_high      <= QUARTER;
      substep         <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_path_formal.vh"
`endif

endmodule
`resetall
