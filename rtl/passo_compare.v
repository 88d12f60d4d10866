// SPDX-License-Identifier: MIT
// Position-compare output: a pulse when an axis arrives at a point, which then advances by an interval.
//
// Promise: `pin` rises in the clock in which the active edge of the step onto the point leaves the pin, and stays high
// for `width` clocks after the last arrival. Only arrivals count, from either side: after the first point each of the
// others gives one pulse, in the direction of the interval, however often the axis reverses. Position wraparound is
// handled. With width 0 there are no pulses, but the points advance. Only a reset, `write_distance` or `write_pulse`,
// which change axis and width, cut a pulse short.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_compare #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // settings
  input  wire [     2:0] axis,
  input  wire [    15:0] width,
  input  wire [    31:0] interval,        // signed steps, not 0
  input  wire            write_pulse,     // strobes, while nothing moves
  input  wire            write_distance,
  input  wire [    31:0] distance,        // signed steps from here to the first point
  // axes
  input  wire [AXES-1:0] step_made,       // one clock before the edge; at least 2 clocks apart
  input  wire [AXES-1:0] step_direction,  // 1 = negative, from the clock before step_made on
  output reg             pin
);

  reg  [31:0] away;  // point - position
  reg         one_up;  // away is 1
  reg         one_down;  // away is -1
  reg  [15:0] timer;  // clocks of the pulse so far
  wire [ 7:0] made = {{(8 - AXES) {1'b0}}, step_made};
  wire [ 7:0] directions = {{(8 - AXES) {1'b0}}, step_direction};
  reg         up;  // the step in this clock
  wire        steps = made[axis];
  wire        arrives = steps & (up ? one_up : one_down);

  always @(posedge clk) begin
    up       <= ~directions[axis];
    one_up   <= away == 32'd1;
    one_down <= away == 32'hFFFFFFFF;
    if (steps) away <= arrives ? interval : away + {{31{up}}, 1'b1};
    timer <= timer + 16'd1;
    if (timer == width) pin <= 1'b0;
    if (arrives) begin
      pin   <= width != 16'd0;
      timer <= 16'd1;
    end
    if (write_distance) away <= distance;
    if (write_distance || write_pulse) pin <= 1'b0;
    if (rst) begin
      away <= 32'd0;
      pin  <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_compare_formal.vh"
`endif

endmodule
`resetall
