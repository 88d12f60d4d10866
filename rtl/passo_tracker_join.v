// SPDX-License-Identifier: MIT
// Joins the steps of path and tracker of one axis.
//
//   the tracker's step is   in the direction of the path   inserted when no step of the axis waits
//                           against it                     kept until the path makes a step, and neither is made;
//                                                          a second one turns the axis
//   the path does not move the axis                        made when no step of the axis waits
//
// Promise: the steps requested are those of the path and of the tracker, summed; at most 3 steps of the tracker wait.
// A step of the path is requested on the clock on which it is due, or cancels one of the tracker. The tracker delays
// it by at most one step time, and the DIR times where the axis turns. Without steps of a tracker, requests and
// directions are those of the path. A third waiting step does not wait for the others: if the axis has no room for
// it, the axis loses it and says so.
// Latency: path to request 0 clocks, a tracker's step 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_tracker_join (
  input  wire clk,
  input  wire rst,
  input  wire halt,          // drop what waits
  // tracker
  input  wire made,          // strobe
  input  wire made_down,
  // path
  input  wire path_step,
  input  wire path_down,
  input  wire path_moves,    // the line that runs moves the axis
  // axis
  input  wire waits,         // a step waits
  output wire step_request,
  output wire direction,     // 1 = negative
  output wire owes,          // a step of the tracker waits
  output reg  went_down      // direction of the last line that moved the axis
);

  reg [1:0] size;  // of what is owed: steps of the tracker that wait
  reg       down;  // its sign; of 0 any
  reg       turned;  // the axis went against the path last
  reg       ready;  // a step may join, decided one clock ago

  wire some = size != 2'd0;
  wire several = size[1];
  wire many = size == 2'd3;
  wire against = some & (down ^ path_down);
  wire leaves = path_step ? against : ready;  // it cancels a step of the path, or joins
  wire may_join = (~waits & ~path_step) | many;
  wire keeps = turned & ~(path_moves & ~some);
  wire turns = path_step ? keeps & against : ready ? against : keeps;

  assign step_request = path_step ? ~against : ready;
  assign direction    = path_down ^ turns;
  assign owes         = some;

  // the size changes by +1, 0, -1 or -2
  wire changes = leaves ^ made;  // by one
  wire less = made ? down ^ made_down : leaves;

  always @(posedge clk) begin
    ready   <= some & may_join & (~against | ~path_moves | several) & ~(leaves | made);
    turned  <= turns;
    size[0] <= size[0] ^ changes;
    size[1] <= changes ? (less ? many : some) : several & ~less;
    if (made && !several) down <= made_down;
    if (path_moves) went_down <= path_down;
    if (halt || rst) begin
      size  <= 2'd0;
      ready <= 1'b0;
    end
    if (rst) begin
      went_down <= 1'b0;
      turned    <= 1'b0;
    end
  end

endmodule
`resetall
