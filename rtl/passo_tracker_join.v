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

  reg signed [2:0] owed;  // steps of the tracker that wait, signed
  reg              some;  // owed is not 0
  reg              turned;  // the axis went against the path last
  reg              ready;  // a step may join, decided one clock ago

  wire several = owed[2] ? owed[1:0] != 2'd3 : owed[1];  // two or more
  wire many = owed == 3'sd3 || owed == -3'sd3;
  wire against = some & (owed[2] ^ path_down);
  wire leaves = path_step ? against : ready;  // it cancels a step of the path, or joins
  wire may_join = (~waits & ~path_step) | many;
  wire turns = path_step ? turned & against : ready ? against : turned & ~(path_moves & ~some);

  assign step_request = path_step ? ~against : ready;
  assign direction    = path_down ^ turns;
  assign owes         = some;

  wire       [1:0] events = {leaves, made};
  reg signed [2:0] change;

  always @* begin
    case (events)
      2'b00:   change = 3'sd0;
      2'b01:   change = made_down ? -3'sd1 : 3'sd1;
      2'b10:   change = owed[2] ? 3'sd1 : -3'sd1;
      default: change = made_down == owed[2] ? 3'sd0 : made_down ? -3'sd2 : 3'sd2;
    endcase
  end

  wire signed [2:0] owed_next = owed + change;

  always @(posedge clk) begin
    ready  <= some & may_join & (~against | ~path_moves | several) & ~(leaves | made | halt | rst);
    turned <= turns;
    owed   <= owed_next;
    some   <= owed_next != 3'sd0;
    if (path_moves) went_down <= path_down;
    if (halt || rst) begin
      owed <= 3'sd0;
      some <= 1'b0;
    end
    if (rst) begin
      went_down <= 1'b0;
      turned    <= 1'b0;
    end
  end

endmodule
`resetall
