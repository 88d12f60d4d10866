// SPDX-License-Identifier: MIT
// Path: accumulates the velocity; each carry is a substep.
//
//   every enabled clock:  phase += velocity;  carry out = substep         phase = 1/4 on `restart`
//
// With velocity <= 1/2 there is a carry exactly when the highest bit of the phase falls. The 48-bit adder is split into two halves of 24 bits, the upper one clock behind the lower, and so is the velocity.
// Promise: `substep` comes 2 clocks after its `advance`; with velocity <= 1/2 never on two clocks in a row.
// On `begin_profile` and `tick` velocity_next takes effect in the next clock (its upper half is read one clock
// later), or 0 if `rest`. While `drain` is high drain_velocity is used, from the second clock on. At rest, `stop` or
// the end of drain makes the velocity 0, 2 clocks later.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_path (
  input  wire        clk,
  input  wire        rst,
  input  wire        restart,
  input  wire        stop,
  input  wire        begin_profile,
  input  wire        advance,         // enabled clock
  input  wire        tick,            // it ends a tick
  input  wire        rest,
  input  wire [47:0] velocity_next,   // UQ0.48 substeps per clock, 0 .. 1/2
  input  wire        drain,
  input  wire [31:0] drain_velocity,  // UQ0.32
  output wire [31:0] velocity,        // UQ0.32
  output wire        substep
);

  localparam [23:0] QUARTER = 24'h400000;

  reg [23:0] velocity_low;
  reg [23:0] velocity_high;
  reg        take_q;
  reg        refresh;
  reg [23:0] phase_low;
  reg        phase_low_carry;
  reg [23:0] phase_high;
  reg        advance_q;
  reg        was_high;  // the highest bit of the phase before the addition; 0 if there was none

  wire [24:0] phase_low_sum = {1'b0, phase_low} + {1'b0, velocity_low};

  assign substep  = was_high & ~phase_high[23];
  assign velocity = {velocity_high, velocity_low[23:16]};

  wire take = begin_profile | tick | refresh;
  wire [47:0] velocity_wanted = ({drain_velocity, 16'd0} & {48{drain}}) | (velocity_next & {48{~drain & ~rest}});

  always @(posedge clk) begin
    refresh   <= rst | stop | drain;
    take_q    <= take;
    advance_q <= advance;
    if (take) velocity_low <= velocity_wanted[23:0];
    if (take_q) velocity_high <= velocity_wanted[47:24];
    if (advance) phase_low <= phase_low_sum[23:0];
    phase_low_carry <= advance & phase_low_sum[24];
    if (advance_q) phase_high <= phase_high + velocity_high + {23'd0, phase_low_carry};
    was_high <= advance_q & phase_high[23];
    if (rst || restart) begin
      advance_q       <= 1'b0;
      phase_low       <= 24'd0;
      phase_low_carry <= 1'b0;
      phase_high      <= QUARTER;
      was_high        <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_path_formal.vh"
`endif

endmodule
`resetall
