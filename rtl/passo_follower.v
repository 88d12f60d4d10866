// SPDX-License-Identifier: MIT
// Follower: makes the counts of an encoder the clock of a profile.
//
//   a count: owed += 2^scale, down: owed -= 2^scale;  `advance`: owed -= 1
//   credit: every enabled clock without one:  sum += limit;  carry out = credit
//
// Promise: while following, 2^scale * counts = advances + owed. There is no advance unless a count was owed in the clock
// before, none without `enable`, and none on two clocks in a row; so counts back are paid back before the profile goes
// on, and it never gets ahead of the furthest count. In any time there are at most 1 + limit * (enabled clocks)
// advances. When owed is positive and credit is there, an advance follows with the next enabled clock but one.
// `behind`: two counts or more are owed, one clock late. `lost`: 2^22 or more are owed, either way; then nothing is
// counted any more.
// Latency: count_made to advance 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_follower (
  input  wire        clk,
  input  wire        rst,
  input  wire        following,   // else nothing is owed
  input  wire        count_made,
  input  wire        count_down,
  input  wire [ 2:0] scale,
  input  wire [31:0] limit,       // UQ0.32 advances per enabled clock, up to 1/2
  input  wire        enable,
  input  wire        stall,       // not in this clock
  output wire        advance,
  output reg  [23:0] owed,        // signed
  output reg         behind,
  output reg         lost
);

  reg        due;  // owed was positive; credit is not there again before it knows of an advance
  reg        credit;
  reg [31:0] sum;

  wire        add = count_made & ~count_down & ~lost;
  wire        take = count_made & count_down & ~lost;
  wire [ 7:0] one_count = 8'd1 << scale;
  // 2^scale, or its inverse; an advance takes 1, or gives the carry of the inverse away
  wire [23:0] change = ({16'd0, one_count} & {24{add | take}}) ^ {24{take}};
  wire [23:0] paid = {24{advance & ~take}};
  wire        carry = take & ~advance;

  // bits of owed above two counts
  wire [22:0] above = 23'h7FFFFE << scale;

  assign advance = enable & due & credit & ~stall;

  always @(posedge clk) begin
    owed   <= owed + change + paid + {23'd0, carry};
    due    <= ~owed[23] & (owed[22:0] != 23'd0);
    behind <= ~owed[23] & ((owed[22:0] & above) != 23'd0);
    lost   <= lost | (owed[23] ^ owed[22]);
    if (enable && (!credit || advance)) {credit, sum} <= {1'b0, sum} + {1'b0, limit};
    if (rst || !following) begin
      owed   <= 24'd0;
      due    <= 1'b0;
      behind <= 1'b0;
      lost   <= 1'b0;
      credit <= 1'b1;
      sum    <= 32'd0;
    end
  end

`ifdef FORMAL
  `include "passo_follower_formal.vh"
`endif

endmodule
`resetall
