// SPDX-License-Identifier: MIT
// Profile of a channel, the last of CHANNELS, with the shape tables; enable and bus come from the test, which sets
// the registers.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_profile_top #(
  parameter CHANNELS   = 1,
  parameter DEPTH_LOG2 = 4,
  parameter TICK_LOG2  = 7
);

  reg clk, rst;
  reg bus_frame, bus_commit, bus_check, bus_write, select;
  reg [31:0] bus_data;
  reg [4:0] bus_msb;
  reg prepare, begin_profile, stopped, now_coming, enable;
  reg drain;
  reg [31:0] drain_velocity;

  wire [3:0] refusal;
  wire incomplete, needs_motion;
  wire [DEPTH_LOG2:0] room;
  wire valid, ready, ended, dry, ends_next;
  wire stall;
  wire [47:0] velocity;  // that counts in this clock

  wire [CHANNELS-1:0] tables_served;
  wire table_request;
  wire [9:0] table_address;
  wire table_served = tables_served[CHANNELS-1];
  wire [15:0] table_point, table_point_next;

  // this channel, and others that always ask, one too many
  wire [CHANNELS:0] requests = {table_request, {CHANNELS{1'b1}}};
  wire [CHANNELS*10+9:0] addresses = {table_address, {CHANNELS{10'd5}}};
  wire [CHANNELS-1:0] table_requests = requests[CHANNELS:1];

  reg ended_q;
  always @(posedge clk) ended_q <= ended;

  passo_tables #(
    .CHANNELS(CHANNELS)
  ) u_tables (
    .*,
    .bus_frame  (1'b0),
    .bus_commit (1'b0),
    .bus_check  (1'b0),
    .bus_write  (1'b0),
    .select     (1'b0),
    .bus_address(10'd0),
    .bus_data   (16'd0),
    .wanted     (),
    .request    (table_requests),
    .address    (addresses[CHANNELS*10+9:10]),
    .served     (tables_served),
    .point      (table_point),
    .point_next (table_point_next)
  );

  passo_profile #(
    .TICK_LOG2 (TICK_LOG2),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_profile (
    .*,
    .velocity(),
    .substep ()
  );

  // the path's upper half comes a clock late
  assign velocity[23:0]  = u_profile.u_path.velocity_low;
  assign velocity[47:24] = !u_profile.u_path.take_q ? u_profile.u_path.velocity_high :
                           drain                    ? drain_velocity[31:8] :
                           ends_next                ? 24'd0 : u_profile.velocity_next[47:24];

endmodule
`resetall
