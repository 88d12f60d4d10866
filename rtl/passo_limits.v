// SPDX-License-Identifier: MIT
// Limit switches and alarms of a channel: which steps are blocked, and when to stop.
//
// Each axis shows its next queued step. `closed_low` and `closed_high` block steps in that direction: while a hard
// limit is active, or a soft-stop limit that was already active when the channel was quiet or a motion was prepared.
// Promise: a step toward an active limit stops the channel one clock after it is shown: hard if it is blocked, else
// soft. So the steps of a soft stop pass, later ones into the switch do not; steps away always pass. An active alarm
// keeps the channel stopped. `named` has the axes of the first such event since `clear`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_limits #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // filtered inputs and settings
  input  wire [AXES-1:0] limit_low,
  input  wire [AXES-1:0] limit_high,
  input  wire [AXES-1:0] alarm,
  input  wire [AXES-1:0] limit_soft,
  input  wire [AXES-1:0] alarm_soft,
  // axes
  input  wire [AXES-1:0] waits,         // a step waits
  input  wire [AXES-1:0] negative,      // its direction
  input  wire            may_close,     // quiet, or a motion is being prepared
  output reg  [AXES-1:0] closed_low,
  output reg  [AXES-1:0] closed_high,
  // stops
  input  wire            clear,
  output reg             limit_hard,
  output reg             limit_softly,
  output reg             alarm_hard,
  output reg             alarm_softly,
  output reg  [AXES-1:0] named
);

  wire [AXES-1:0] to_low = waits & negative;
  wire [AXES-1:0] to_high = waits & ~negative;
  wire [AXES-1:0] hit = (to_low & limit_low) | (to_high & limit_high);
  wire [AXES-1:0] open = limit_soft & ~{AXES{may_close}};  // a limit that becomes active does not block

  always @(posedge clk) begin
    closed_low   <= limit_low & (closed_low | ~open);
    closed_high  <= limit_high & (closed_high | ~open);
    limit_hard   <= ((to_low & closed_low) | (to_high & closed_high)) != {AXES{1'b0}};
    limit_softly <= (hit & limit_soft) != {AXES{1'b0}};
    alarm_hard   <= (alarm & ~alarm_soft) != {AXES{1'b0}};
    alarm_softly <= (alarm & alarm_soft) != {AXES{1'b0}};
    if (named == {AXES{1'b0}}) named <= hit | alarm;
    if (clear) named <= {AXES{1'b0}};
    if (rst) begin
      closed_low   <= {AXES{1'b0}};
      closed_high  <= {AXES{1'b0}};
      limit_hard   <= 1'b0;
      limit_softly <= 1'b0;
      alarm_hard   <= 1'b0;
      alarm_softly <= 1'b0;
      named        <= {AXES{1'b0}};
    end
  end

`ifdef FORMAL
  `include "passo_limits_formal.vh"
`endif

endmodule
`resetall
