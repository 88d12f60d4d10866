// SPDX-License-Identifier: MIT
// Follower: turns encoder counts into the clock of a profile.
//
//   a count: owed += 2^scale, down: owed -= 2^scale;  `advance`: owed -= 1
//   credit: every enabled clock without one:  sum += limit;  carry out = credit
//
// Promise: while following, 2^scale * counts = advances + owed, one clock after the count. An advance needs a count
// owed in the clock before, `enable`, and no advance on the clock before; so reverse counts are made up before the
// profile continues, and it never gets ahead of the furthest count. In any time there are at most 1 + limit * (enabled
// clocks) advances. When owed is positive and there is credit, an advance follows on the second enabled clock after
// that. `behind`, one clock late: two counts or more are owed. `lost`: 2^22 or more are owed, either way, or the
// encoder has slipped; counting then stops.
// Latency: count_made to owed 2 clocks, to advance 3.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_follower (
  input  wire        clk,
  input  wire        rst,
  input  wire        following,   // else nothing is owed
  input  wire        count_made,
  input  wire        count_down,
  input  wire        slipped,     // strobe: a count was not seen
  input  wire [ 2:0] scale,
  input  wire [31:0] limit,       // UQ0.32 advances per enabled clock, up to 1/2
  input  wire        enable,
  input  wire        stall,       // not in this clock
  output wire        advance,
  output reg  [23:0] owed,        // signed
  output reg         due,         // owed was positive
  output reg         behind,
  output reg         lost
);

  reg        credit;  // not there again before `due` knows of an advance
  reg [31:0] sum;

  wire       add = count_made & ~count_down & ~lost;
  wire       take = count_made & count_down & ~lost;
  wire [7:0] one_count = 8'd1 << scale;

  // What the count of the clock before adds, with an advance in this clock and without: one operand, bits 7:0 and all
  // above; taking is the inverse and a carry, which an advance keeps
  reg [7:0] change;
  reg change_above;
  reg [7:0] change_advanced;
  reg change_advanced_above;
  reg change_carry;
  wire [23:0] operand = advance ? {{16{change_advanced_above}}, change_advanced} : {{16{change_above}}, change};

  // bits of owed above two counts
  wire [22:0] above = 23'h7FFFFE << scale;

  assign advance = enable & due & credit & ~stall;

  always @(posedge clk) begin
    change                <= (one_count & {8{add | take}}) ^ {8{take}};
    change_above          <= take;
    change_advanced       <= add ? one_count - 8'd1 : take ? ~one_count : 8'hFF;
    change_advanced_above <= ~add;
    change_carry          <= take;
    owed                  <= owed + operand + {23'd0, change_carry & ~advance};
    due                   <= ~owed[23] & (owed[22:0] != 23'd0);
    behind                <= ~owed[23] & ((owed[22:0] & above) != 23'd0);
    lost                  <= lost | (owed[23] ^ owed[22]) | slipped;
    if (enable && (!credit || advance)) {credit, sum} <= {1'b0, sum} + {1'b0, limit};
    if (rst || !following) begin
      change                <= 8'd0;
      change_above          <= 1'b0;
      change_advanced       <= 8'hFF;
      change_advanced_above <= 1'b1;
      change_carry          <= 1'b0;
      owed                  <= 24'd0;
      due                   <= 1'b0;
      behind                <= 1'b0;
      lost                  <= 1'b0;
      credit                <= 1'b1;
      sum                   <= 32'd0;
    end
  end

`ifdef FORMAL
  `include "passo_follower_formal.vh"
`endif

endmodule
`resetall
