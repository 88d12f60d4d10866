// SPDX-License-Identifier: MIT
// Watchdog: soft-stops motions when no frame arrives in time.
//
// Times are in units of 2^UNIT_LOG2 ticks from the last `feed`. Promise: with stop_after 0 it is off. `stop` rises when
// stop_after units are over and a motion runs, not earlier; both counted in whole ticks, so it is up to one tick late.
// `disable_drives` rises disable_after units after that, unless disable_after is 0. Both last until the next `feed`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_watchdog #(
  parameter UNIT_LOG2 = 9  // ticks of a unit
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        tick,
  input  wire        write,          // strobe with bus_data: the register WATCHDOG
  input  wire [19:0] bus_data,
  input  wire        feed,           // a frame is being executed
  input  wire        moving,         // a motion runs
  output reg         stop,
  output reg         disable_drives
);

  reg  [          9:0] stop_after;
  reg  [          9:0] disable_after;
  reg  [UNIT_LOG2+9:0] count;  // ticks since it was fed, or since `stop`
  reg                  holds;  // it has reached its end, or has none
  reg                  silent;  // stop_after units are over
  wire [          9:0] wanted = stop ? disable_after : stop_after;
  wire                 over = count[UNIT_LOG2+:10] == wanted;
  wire                 ends = over & ~holds;
  wire                 trips = silent & moving & tick & ~stop;

  always @(posedge clk) begin
    count <= count + {{(UNIT_LOG2 + 9) {1'b0}}, tick & ~holds};
    holds <= over;
    if (ends) silent <= 1'b1;
    if (trips) stop <= 1'b1;
    if (ends && stop) disable_drives <= 1'b1;
    if (write) {disable_after, stop_after} <= bus_data;
    if (feed || trips || rst) begin
      count <= {(10 + UNIT_LOG2) {1'b0}};
      holds <= 1'b1;
    end
    if (feed || rst) begin
      silent         <= 1'b0;
      stop           <= 1'b0;
      disable_drives <= 1'b0;
    end
    if (rst) {disable_after, stop_after} <= 20'd0;
  end

`ifdef FORMAL
  `include "passo_watchdog_formal.vh"
`endif

endmodule
`resetall
