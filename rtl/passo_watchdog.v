// SPDX-License-Identifier: MIT
// Watchdog: stops the motions when the host falls silent.
//
// Times are in units of 2^UNIT_LOG2 clocks from the last `feed`. Promise: with stop_after 0 it does nothing. `stop` rises when
// stop_after units are over and a motion runs, not earlier; `disable_drives` disable_after units after that, but not
// with disable_after 0. Both last until the next `feed`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_watchdog #(
  parameter UNIT_LOG2 = 16  // clocks of a unit
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        write,           // strobe with bus_data: the register WATCHDOG
  input  wire [19:0] bus_data,
  input  wire        feed,            // a frame is being executed
  input  wire        moving,          // a motion runs
  output reg         stop,
  output reg         disable_drives,
  output wire [19:0] settings
);

  reg  [          9:0] stop_after;
  reg  [          9:0] disable_after;
  reg  [          9:0] count;  // units left
  reg  [UNIT_LOG2-1:0] unit;
  reg                  unit_ends;
  reg                  fed;
  wire                 over = count == 10'd0;

  assign settings = {disable_after, stop_after};

  always @(posedge clk) begin
    fed       <= feed;
    unit      <= unit + 1'b1;
    unit_ends <= unit == {{(UNIT_LOG2 - 1) {1'b1}}, 1'b0};
    if (unit_ends && count != 10'd0) count <= count - 10'd1;
    if (over && !stop && stop_after != 10'd0 && moving) begin
      stop      <= 1'b1;
      count     <= disable_after;
      unit      <= {UNIT_LOG2{1'b0}};
      unit_ends <= 1'b0;
    end
    if (over && stop && disable_after != 10'd0) disable_drives <= 1'b1;
    if (write) {disable_after, stop_after} <= bus_data;
    if (fed || rst) begin
      count          <= stop_after;
      unit           <= {UNIT_LOG2{1'b0}};
      unit_ends      <= 1'b0;
      stop           <= 1'b0;
      disable_drives <= 1'b0;
    end
    if (rst) begin
      fed                         <= 1'b1;
      {disable_after, stop_after} <= 20'd0;
    end
  end

`ifdef FORMAL
  `include "passo_watchdog_formal.vh"
`endif

endmodule
`resetall
