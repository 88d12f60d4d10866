// SPDX-License-Identifier: MIT
// Time scale: the clock enable of the profile. Feed hold, resume, override and soft stop change only this, so
// the sequence of pulses is the same under any of them.
//
//   rate_sum += rate;  enable = carry out              rate = 1.0 -> every clock, rate = 0 -> none
//   rate moves toward the goal by the slew every 2^TICK_LOG2 real clocks (`slew_tick`), and onto it when it is nearer
//   goal = rate_target, or 0 when stopping; both goal and slew are taken over at a slew tick for the next one
//   outside a motion rate = goal = rate_target
//
// Promise: `enable` is registered, low unless `moving`, and a motion begins with an empty rate_sum. A slew of
// 0 counts as 1.
`resetall
`default_nettype none

module passo_timescale (
  input  wire        clk,
  input  wire        rst,
  input  wire        slew_tick,
  input  wire        moving,       // count: the profile runs
  input  wire        stopping,
  input  wire [16:0] rate_target,  // UQ1.16
  input  wire [16:0] rate_slew,
  input  wire [16:0] stop_slew,
  output reg  [16:0] rate,
  output reg         enable
);

  reg  [15:0] rate_sum;
  wire [16:0] rate_sum_next = {1'b0, rate_sum} + rate;

  reg        [16:0] goal;
  reg        [16:0] slew;
  reg signed [17:0] distance;  // goal - rate, settled long before the next slew tick

  wire        [16:0] slew_chosen = stopping ? stop_slew : rate_slew;
  wire signed [17:0] slew_signed = {1'b0, slew};
  wire               near = distance <= slew_signed && distance > ~slew_signed;  // ~x = -x - 1

  always @(posedge clk) begin
    {enable, rate_sum} <= rate_sum_next;
    distance           <= $signed({1'b0, goal}) - $signed({1'b0, rate});
    if (slew_tick) begin
      rate <= near ? goal : distance[17] ? rate - slew : rate + slew;
      goal <= stopping ? 17'd0 : rate_target;
      slew <= slew_chosen == 17'd0 ? 17'd1 : slew_chosen;
    end
    if (!moving) begin
      rate     <= rate_target;
      goal     <= rate_target;
      slew     <= 17'd1;
      rate_sum <= 16'd0;
      enable   <= 1'b0;
    end
    if (rst) begin
      rate   <= 17'h10000;
      enable <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_timescale_formal.vh"
`endif

endmodule
`resetall
