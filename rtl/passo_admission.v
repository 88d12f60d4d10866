// SPDX-License-Identifier: MIT
// Admission: does the state of the channel allow the frame that is about to be executed?
//
// The word checks collect the requirements of a frame; its commit decides once for the whole frame. Promise: from 30
// clocks after `bus_commit` rises until it falls, `busy` does not rise, so the frame is executed in a state that
// allows it: `hold` prevents a motion from starting, `now_coming` prevents one from ending.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_admission (
  input  wire clk,
  input  wire rst,
  // bus
  input  wire bus_frame,
  input  wire bus_commit,
  // strobes: the word being checked needs ...
  input  wire needs_idle,     // ... no motion
  input  wire needs_quiet,    // ... and no step at the pins
  input  wire needs_motion,   // ... a motion that can still take a NOW ramp
  input  wire tables_wanted,  // the frame writes shape tables: no motion in any channel
  // state
  input  wire occupied,
  input  wire at_rest,        // quiet, unless `occupied`
  input  wire takes_now,
  output wire busy,
  output wire hold,
  output wire now_coming
);

  reg idle_needed;
  reg quiet_needed;
  reg motion_needed;

  always @(posedge clk) begin
    idle_needed   <= idle_needed | needs_idle | needs_quiet;
    quiet_needed  <= quiet_needed | needs_quiet;
    motion_needed <= motion_needed | needs_motion;
    if (rst || (bus_frame && !bus_commit)) begin
      idle_needed   <= 1'b0;
      quiet_needed  <= 1'b0;
      motion_needed <= 1'b0;
    end
  end

  assign busy       = (idle_needed & occupied) | (quiet_needed & ~at_rest) | (motion_needed & ~takes_now);
  assign hold       = bus_commit & (idle_needed | tables_wanted);
  assign now_coming = bus_commit & motion_needed;

endmodule
`resetall
