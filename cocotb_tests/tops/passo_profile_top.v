// SPDX-License-Identifier: MIT
// Profile of a channel, the last of CHANNELS, with the shape tables; enable and bus come from the test.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_profile_top #(
  parameter CHANNELS   = 1,
  parameter DEPTH_LOG2 = 4,
  parameter TICK_LOG2  = 7
) (
  input  wire                clk,
  input  wire                rst,
  input  wire                bus_frame,
  input  wire                bus_commit,
  input  wire                bus_check,
  input  wire                bus_write,
  input  wire                select,
  input  wire [        31:0] bus_data,
  input  wire [         4:0] bus_msb,
  output wire [         3:0] refusal,
  output wire                incomplete,
  output wire                needs_motion,
  output wire [DEPTH_LOG2:0] room,
  input  wire                prepare,
  input  wire                begin_profile,
  input  wire                stopped,
  input  wire                drain,
  input  wire [        31:0] drain_velocity,
  input  wire                now_coming,
  input  wire                enable,
  output wire                valid,
  output wire                ready,
  output wire                dry,
  output wire                stall,
  output reg                 ended_q,
  output wire [        47:0] velocity         // that counts in this clock
);

  wire                   ended;
  wire                   ends_next;
  wire                   table_request;
  wire [            9:0] table_address;
  wire [   CHANNELS-1:0] table_served;
  wire [           15:0] table_point;
  wire [           15:0] table_point_next;
  wire [   CHANNELS-1:0] table_requests;
  wire [CHANNELS*10-1:0] table_addresses;

  // the other channels always ask
  genvar channel;
  generate
    for (channel = 0; channel < CHANNELS; channel = channel + 1) begin : g_channel
      assign table_requests[channel]         = channel == CHANNELS - 1 ? table_request : 1'b1;
      assign table_addresses[channel*10+:10] = channel == CHANNELS - 1 ? table_address : 10'd5;
    end
  endgenerate

  always @(posedge clk) ended_q <= ended;

  passo_tables #(
    .CHANNELS(CHANNELS)
  ) u_tables (
    .clk        (clk),
    .rst        (rst),
    .bus_frame  (1'b0),
    .bus_commit (1'b0),
    .bus_check  (1'b0),
    .bus_write  (1'b0),
    .bus_read   (1'b0),
    .bus_push   (1'b0),
    .select     (1'b0),
    .bus_address(10'd0),
    .bus_data   (16'd0),
    .bus_msb    (5'd0),
    .refusal    (),
    .wanted     (),
    .request    (table_requests),
    .address    (table_addresses),
    .served     (table_served),
    .point      (table_point),
    .point_next (table_point_next)
  );

  passo_profile #(
    .TICK_LOG2 (TICK_LOG2),
    .DEPTH_LOG2(DEPTH_LOG2)
  ) u_profile (
    .clk             (clk),
    .rst             (rst),
    .bus_frame       (bus_frame),
    .bus_commit      (bus_commit),
    .bus_check       (bus_check),
    .bus_write       (bus_write),
    .select          (select),
    .bus_data        (bus_data),
    .bus_msb         (bus_msb),
    .refusal         (refusal),
    .incomplete      (incomplete),
    .needs_motion    (needs_motion),
    .room            (room),
    .prepare         (prepare),
    .begin_profile   (begin_profile),
    .stopped         (stopped),
    .drain           (drain),
    .drain_velocity  (drain_velocity),
    .now_coming      (now_coming),
    .valid           (valid),
    .ready           (ready),
    .ended           (ended),
    .dry             (dry),
    .ends_next       (ends_next),
    .enable          (enable),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served[CHANNELS-1]),
    .table_point     (table_point),
    .table_point_next(table_point_next),
    .velocity        (),
    .substep         ()
  );

  assign stall = u_profile.stall;
  // the path's upper half comes a clock late
  assign velocity[23:0] = u_profile.u_path.velocity_low;
  assign velocity[47:24] = !u_profile.u_path.take_q ? u_profile.u_path.velocity_high :
                           drain                    ? drain_velocity[31:8] :
                           ends_next                ? 24'd0 : u_profile.velocity_next[47:24];

endmodule
`resetall
