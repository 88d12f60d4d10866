// SPDX-License-Identifier: MIT
// Watchdog: soft-stops motions when no frame arrives in time.
//
// Times are in units of 2^UNIT_LOG2 clocks from the last `feed`. Promise: with stop_after 0 it is off. `stop` rises
// when stop_after units are over and a motion runs, not earlier; `disable_drives` disable_after units after that,
// unless disable_after is 0. Both last until the next `feed`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_watchdog #(
  parameter UNIT_LOG2 = 16  // clocks of a unit
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        write,          // strobe with bus_data: the register WATCHDOG
  input  wire [19:0] bus_data,
  input  wire        feed,           // a frame is being executed
  input  wire        moving,         // a motion runs
  output reg         stop,
  output reg         disable_drives
);

  reg  [          9:0] stop_after;
  reg  [          9:0] disable_after;
  reg                  stops;  // stop_after is not 0
  reg                  disables;  // disable_after is not 0
  reg  [          9:0] count;  // units since it was fed, or since `stop`
  reg  [UNIT_LOG2-1:0] unit;
  reg                  fed;
  reg                  silent;  // stop_after units are over
  wire [          9:0] wanted = stop ? disable_after : stop_after;
  wire                 over = count == wanted;
  wire                 trips = silent & moving & ~stop;

  always @(posedge clk) begin
    fed           <= feed;
    {count, unit} <= {count, unit} + 1'b1;
    if (over && stops) silent <= 1'b1;
    if (trips) stop <= 1'b1;
    if (over && stop && disables) disable_drives <= 1'b1;
    if (write) begin
      {disable_after, stop_after} <= bus_data;
      {disables, stops}           <= {bus_data[19:10] != 10'd0, bus_data[9:0] != 10'd0};
    end
    if (fed || trips || rst) {count, unit} <= {(10 + UNIT_LOG2) {1'b0}};
    if (fed || rst) begin
      silent         <= 1'b0;
      stop           <= 1'b0;
      disable_drives <= 1'b0;
    end
    if (rst) begin
      fed                         <= 1'b1;
      {disable_after, stop_after} <= 20'd0;
      {disables, stops}           <= 2'b00;
    end
  end

`ifdef FORMAL
  `include "passo_watchdog_formal.vh"
`endif

endmodule
`resetall
