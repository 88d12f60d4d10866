// SPDX-License-Identifier: MIT
// Shape tables: 3 banks of 256 points, UQ0.16, shared by all channels; writable over the bus while no motion is
// prepared or running.
//
// Promise: channels are served in turn, two clocks each. A channel that holds `request` with its `address` gets
// `served` for one clock, within 2 * CHANNELS + 4 clocks, with the point at the address on `point` and the one after
// it on `point_next`. Address = bank - 1 (9:8) and k (7:0); point_next after k = 255 is undefined.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_tables #(
  parameter CHANNELS = 1
) (
  input  wire                   clk,
  input  wire                   rst,
  // bus; `select`: the address is in a table
  input  wire                   bus_frame,
  input  wire                   bus_commit,
  input  wire                   bus_check,
  input  wire                   bus_write,
  input  wire                   select,
  input  wire [            9:0] bus_address,  // within the tables: bank (9:8), 1 .. 3
  input  wire [           15:0] bus_data,
  output reg                    wanted,       // the frame writes points: needs all channels at rest
  // channels
  input  wire [   CHANNELS-1:0] request,
  input  wire [CHANNELS*10-1:0] address,
  output reg  [   CHANNELS-1:0] served,
  output reg  [           15:0] point,
  output wire [           15:0] point_next
);

  `include "passo_registers.vh"

  localparam [2:0] CHANNEL_LAST = CHANNELS[2:0] - 3'd1;
  localparam [CHANNELS-1:0] CHANNEL_0 = 1;

  (* no_rw_check *)
  reg [15:0] points[0:767];
  `include "passo_shapes.vh"

  always @(posedge clk) wanted <= ~rst & ~(bus_frame & ~bus_commit) & (wanted | (select & bus_check));

  // One channel after the other: first its point, then the next one
  reg [2:0] channel;
  reg second;
  reg [CHANNELS-1:0] serves;  // one clock before `served`
  reg asked;  // the channel requested when its first point was addressed, and no answer was in flight
  wire [9:0] channel_address = address[channel*10+:10];
  wire [CHANNELS-1:0] channel_mask = CHANNEL_0 << channel;
  reg [15:0] word;
  reg [15:0] read_data;

  assign point_next = read_data;

  always @(posedge clk) begin
    if (select && bus_write) points[{bus_address[9:8]-2'd1, bus_address[7:0]}] <= bus_data;
    read_data <= word;
    word      <= points[{channel_address[9:8], channel_address[7:0]+{7'd0, second}}];
  end

  always @(posedge clk) begin
    second <= ~second;
    if (!second) asked <= (request & channel_mask & ~serves) != {CHANNELS{1'b0}};
    else channel <= channel == CHANNEL_LAST ? 3'd0 : channel + 3'd1;
    point  <= read_data;  // which holds the point in the clock after `second`, then point_next
    serves <= (second && asked) ? channel_mask : {CHANNELS{1'b0}};
    served <= serves;
    if (rst) begin
      channel <= 3'd0;
      second  <= 1'b0;
      asked   <= 1'b0;
      serves  <= {CHANNELS{1'b0}};
      served  <= {CHANNELS{1'b0}};
    end
  end

endmodule
`resetall
