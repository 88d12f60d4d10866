// SPDX-License-Identifier: MIT
// Interpolation between two numbers, bit-serial: a + floor((b - a) * f).
//
// The unit is used twice per tick: between two points of a table, at the fractional part of the progress, then
// between two velocities, at the resulting fraction.
//
//   f = F + r, F of 24 bits and r of the weight of its LSB, so that f rounds and reaches 1.0
//   bit j of a and b, LSB first:  sum = (sum + addend) / 2,  and the bit shifted out is the next of the result
//   addend:  neither 0,  only b f,  only a 1 - f,  both 1          hence a * (1 - f) + b * f, and no sign
//
// While `moving` the bits come in on a_bit and b_bit (while `shaping` from the points, loaded by `load_points`). A
// bit is in the sum 2 clocks later. `result_move` shifts the sum into the result, or clears both with `clear`, or
// rotates the two halves of the result if nothing is `moving`; after n bits and 2 clocks the result is {sum, low}:
// the integer part from bit 48 - n + 24 on, the fraction below. `load_fraction` loads f for the velocities: progress
// itself if `linear`, else the result of the points, rounded to 2^-24.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_interpolate (
  input  wire        clk,
  input  wire        clear,
  input  wire        result_move,    // sum and low
  input  wire        moving,
  input  wire        shaping,
  input  wire        load_fraction,
  input  wire        linear,
  input  wire [32:0] progress,       // UQ0.33
  input  wire        load_points,
  input  wire [15:0] point,          // UQ0.16
  input  wire [15:0] point_next,
  input  wire        point_is_last,  // the next point is 1.0
  input  wire        a_bit,
  input  wire        b_bit,
  output reg         a,              // the bit just taken
  output wire [47:0] result
);

  reg  [15:0] a_point;
  reg  [24:0] sum;  // and the bit shifted out
  reg  [22:0] low;  // while shaping b's point is shifted out at the bottom
  reg         b;
  reg  [24:0] fraction;  // F, r
  reg  [24:0] addend;
  reg         both;
  // the LSBs give r, in addend[0], the carry
  wire [24:0] sum_next;
  wire        unused_bit;

  assign {sum_next, unused_bit} = {1'b0, sum[24:1], 1'b1} + {1'b0, addend};

  assign result = {sum, low};

  always @(posedge clk) begin
    if (moving) a_point <= {1'b0, a_point[15:1]};
    if (load_points) a_point <= point;
    a <= moving & (shaping ? a_point[0] : a_bit);
    b <= moving & (shaping ? low[0] : b_bit);

    addend <= (shaping ? progress[24:0] : fraction) ^ {25{a}};
    if (a == b) addend <= 25'd0;
    both <= a & b;

    if (result_move) begin
      // without input, each half of the result rotates: a full turn takes 24 clocks
      sum <= clear ? 25'd0 : {sum_next[24] | both | (~moving & sum[1]), sum_next[23:1], moving ? sum_next[0] : low[0]};
      low <= clear ? 23'd0 : {sum[0], low[22:1]};
    end
    if (load_points) low <= {6'd0, point_is_last, point_is_last ? 16'd0 : point_next};

    // sum[24]: the points gave 1.0
    if (load_fraction) fraction <= linear ? progress[32:8] : {sum[23:0], low[22]} | {25{sum[24]}};
  end

`ifdef FORMAL
  `include "passo_interpolate_formal.vh"
`endif

endmodule
`resetall
