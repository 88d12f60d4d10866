// SPDX-License-Identifier: MIT
// Trackers: a second hand on every axis of a channel, and how its steps join those of the path. Wiring only.
//
// Promise: the steps requested are those of the path and of the trackers, summed. While no tracker moves and none is
// owed a step (`busy` is low), requests and directions are those of the path, on the same clock.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_trackers #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            select,
  input  wire [     7:0] bus_address,    // within the channel
  input  wire [AXES-1:0] bus_bits,       // lower bits of the data
  input  wire [    15:0] bus_half,       // one clock late the upper half of the data, then the lower one
  output wire [    23:0] read_data,
  output wire            of_tracker,     // a position of a tracker is addressed
  output wire            tracker_takes,  // strobe: show its lower half, and in the next clock its upper half
  output wire [    15:0] tracker_half,
  // motion
  input  wire            halt,           // hard stop, or stopped
  input  wire            zero,           // strobe: only at rest
  input  wire            brake,          // a soft stop is in progress
  input  wire            hold,           // no motion may begin
  output reg             busy,           // a tracker moves, is about to, or is owed a step
  // path
  input  wire [AXES-1:0] path_steps,
  input  wire [AXES-1:0] path_down,
  input  wire [AXES-1:0] line_moves,     // the line has steps of the axis
  input  wire            path_runs,      // the profile runs, and the rate is not 0
  // axes
  input  wire [AXES-1:0] waits,          // a step waits
  output wire [AXES-1:0] step_request,
  output wire [AXES-1:0] directions
);

  wire [AXES-1:0] went_down;
  wire [AXES-1:0] step_made;
  wire            made;
  wire            step_down;
  wire [AXES-1:0] moves;
  wire [AXES-1:0] owes;

  reg path_runs_q;

  always @(posedge clk) begin
    busy        <= ~rst & (made | ((moves | owes) != {AXES{1'b0}}));
    path_runs_q <= path_runs;
  end

  passo_tracker #(
    .AXES(AXES)
  ) u_tracker (
    .clk          (clk),
    .rst          (rst),
    .bus_write    (bus_write),
    .bus_read     (bus_read),
    .select       (select),
    .bus_address  (bus_address),
    .bus_bits     (bus_bits),
    .bus_half     (bus_half),
    .read_data    (read_data),
    .of_tracker   (of_tracker),
    .tracker_takes(tracker_takes),
    .tracker_half (tracker_half),
    .halt         (halt),
    .zero         (zero),
    .brake        (brake),
    .hold         (hold),
    .path_down    (went_down),
    .step_made    (step_made),
    .made         (made),
    .step_down    (step_down),
    .moves        (moves)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      passo_tracker_join u_join (
        .clk         (clk),
        .rst         (rst),
        .halt        (halt),
        .made        (step_made[axis]),
        .made_down   (step_down),
        .path_step   (path_steps[axis]),
        .path_down   (path_down[axis]),
        .path_moves  (line_moves[axis] & path_runs_q),
        .waits       (waits[axis]),
        .step_request(step_request[axis]),
        .direction   (directions[axis]),
        .owes        (owes[axis]),
        .went_down   (went_down[axis])
      );
    end
  endgenerate

endmodule
`resetall
