// SPDX-License-Identifier: MIT
// Profile: ramps become a velocity, the velocity becomes substeps. Wiring only.
//
// Promise: tick after tick of enabled clocks, substeps are output at the velocity of the ramps, in push
// order.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_profile #(
  parameter TICK_LOG2  = 7,
  parameter DEPTH_LOG2 = 4
) (
  input  wire                clk,
  input  wire                rst,
  // bus; `select`: a push to the ramp queue
  input  wire                bus_frame,
  input  wire                bus_commit,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire [         4:0] bus_msb,
  output wire [         3:0] refusal,
  output wire                incomplete,
  output wire                needs_motion,      // strobe: a NOW ramp is being checked
  output wire [DEPTH_LOG2:0] room,
  // motion
  input  wire                prepare,
  input  wire                begin_profile,
  input  wire                stopped,           // drop all ramps
  input  wire                drain,             // use drain_velocity, not the ramps
  input  wire [        31:0] drain_velocity,
  input  wire                now_coming,        // a NOW ramp is in flight
  output wire                valid,             // a ramp is queued
  output wire                ready,
  output wire                ended,
  output wire                dry,
  output wire                ends_next,
  // time scale
  input  wire                enable,            // clock enable
  output wire                stall,             // it is ignored in this clock
  // tables
  output wire                table_request,
  output wire [         9:0] table_address,
  input  wire                table_served,
  input  wire [        15:0] table_point,
  input  wire [        15:0] table_point_next,
  // lines
  output wire [        31:0] velocity,          // UQ0.32 substeps per clock
  output wire                substep
);

  wire        tick_ends;
  wire        advance = enable & ~stall;
  wire        tick = enable & tick_ends;
  wire        now_pending;
  wire        take;
  wire        take_now;
  wire [ 3:0] half_index;
  wire [15:0] half;
  wire [47:0] velocity_next;

  passo_ramp_queue #(
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_queue (
    .clk         (clk),
    .rst         (rst),
    .bus_frame   (bus_frame),
    .bus_commit  (bus_commit),
    .bus_check   (bus_check),
    .bus_write   (bus_write),
    .select      (select),
    .bus_data    (bus_data),
    .bus_msb     (bus_msb),
    .blocked     (stopped),
    .refusal     (refusal),
    .incomplete  (incomplete),
    .needs_motion(needs_motion),
    .room        (room),
    .take        (take),
    .take_now    (take_now),
    .flush       (stopped),
    .valid       (valid),
    .now_pending (now_pending),
    .half_index  (half_index),
    .half        (half)
  );

  passo_ramp #(
    .TICK_LOG2(TICK_LOG2)
  ) u_ramp (
    .clk             (clk),
    .rst             (rst),
    .prepare         (prepare),
    .begin_profile   (begin_profile),
    .stop            (stopped),
    .drain           (drain),
    .ready           (ready),
    .ended           (ended),
    .dry             (dry),
    .advance         (advance),
    .tick            (tick),
    .stall           (stall),
    .tick_ends       (tick_ends),
    .ends_next       (ends_next),
    .velocity_next   (velocity_next),
    .ramp_valid      (valid),
    .ramp_now_pending(now_pending),
    .ramp_now_coming (now_coming),
    .ramp_take       (take),
    .ramp_take_now   (take_now),
    .ramp_half_index (half_index),
    .ramp_half       (half),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served),
    .table_point     (table_point),
    .table_point_next(table_point_next)
  );

  passo_path u_path (
    .clk           (clk),
    .rst           (rst),
    .restart       (prepare),
    .stop          (stopped),
    .begin_profile (begin_profile),
    .advance       (advance),
    .tick          (tick),
    .rest          (ends_next),
    .velocity_next (velocity_next),
    .drain         (drain),
    .drain_velocity(drain_velocity),
    .velocity      (velocity),
    .substep       (substep)
  );

endmodule
`resetall
