// SPDX-License-Identifier: MIT
// Time scale: the clock enable of the profile. Feed hold, resume, override and soft stop change only this, so none
// of them changes the pulse sequence.
//
//   rate_sum += rate;  enable = carry out              rate = 1.0 -> every clock, rate = 0 -> none
//   rate moves toward the goal by the slew every 2^TICK_LOG2 real clocks (`slew_tick`), and onto it when it is closer
//   goal = rate_target, or 0 when stopping
//   outside a motion rate = rate_target, 2 clocks later
//
// Promise: `enable` is registered, low unless `moving`, and a motion begins with rate_sum = 0. Slew 0 counts as 1.
// The rate changes 7 clocks after the slew tick: goal, direction, slew, new rate and overshoot are computed one after
// the other. Slew ticks are at least 8 clocks apart. Once `stopping` is high the rate never rises: a change in
// progress when it rises is dropped.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_timescale (
  input  wire        clk,
  input  wire        rst,
  input  wire        slew_tick,
  input  wire        moving,       // the profile runs
  input  wire        stopping,
  input  wire [16:0] rate_target,  // UQ1.16
  input  wire [16:0] rate_slew,
  input  wire [16:0] stop_slew,
  output reg  [16:0] rate,
  output reg         enable
);

  reg  [15:0] rate_sum;
  wire [16:0] rate_sum_next = {1'b0, rate_sum} + rate;

  reg [ 6:1] after;  // clocks since the slew tick, one-hot
  reg [16:0] goal;
  reg        stops;  // `stopping` was high at the slew tick
  reg        down;
  reg [16:0] change;  // the slew, inverted if down; else 0
  reg        change_carry;
  reg [17:0] not_moved;  // the inverse of rate + change
  reg        land;
  reg        still;  // not moving

  // goal >= rate + change, except for the top bit of the sum
  wire        reaches;
  wire [16:0] unused_sum;
  assign {reaches, unused_sum} = {1'b0, goal} + {1'b0, not_moved[16:0]} + 18'd1;

  always @(posedge clk) begin
    after <= {after[5:1], slew_tick};
    if (slew_tick || !moving) begin
      goal  <= stopping && moving ? 17'd0 : rate_target;
      stops <= stopping && moving;
    end
    if (after[1]) down <= !reaches;
    if (after[2]) change <= (stops ? stop_slew : rate_slew) ^ {17{down}};
    else if (!after[3]) change <= 17'd0;
    change_carry <= after[3] && (down ^ (change == {17{down}}));
    if (!after[5]) not_moved <= ~({1'b0, rate} +{after[4] & down, change} +{17'd0, change_carry});
    still <= !moving;
    land  <= !moving || !not_moved[17] || reaches == down;
    if ((after[6] && (stops || !stopping)) || (still && !moving)) rate <= land ? goal : ~not_moved[16:0];

    {enable, rate_sum} <= rate_sum_next;
    if (!moving) begin
      after    <= 6'd0;
      rate_sum <= 16'd0;
      enable   <= 1'b0;
    end
    if (rst) begin
      after  <= 6'd0;
      still  <= 1'b0;
      rate   <= 17'h10000;
      enable <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_timescale_formal.vh"
`endif

endmodule
`resetall
