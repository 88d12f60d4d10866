// SPDX-License-Identifier: MIT
// In place of the core and of its host interface, for the proofs of the bus fronts: what comes in goes out again, so
// that a front can promise where each of its pins leads.
`default_nettype none

module passo_core #(
  parameter CHANNELS = 1, AXES = 4, TICK_LOG2 = 7, LINE_QUEUE_LOG2 = 8, RAMP_QUEUE_LOG2 = 4, STEPS_REGISTER = 0,
  parameter INPUTS = 0, ENCODERS = 0, OUTPUTS = 0, RASTER = 0, COMPARE = 0, TRACKERS = 0, TRACKED = 0,
  parameter STEP_RESET = 0, DIR_RESET = 0, ENABLE_RESET = 0, CLOCK_HZ = 0, BUILD = 0
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        frame_start,
  input  wire        frame_end,
  input  wire        half_valid,
  input  wire        half_low,
  input  wire [15:0] half,
  output wire [31:0] reply_word,
  input  wire        sync,
  input  wire [ 3:0] limit_low,
  input  wire [ 3:0] limit_high,
  input  wire [ 3:0] home,
  input  wire [ 3:0] alarm,
  input  wire        probe,
  input  wire        estop_n,
  input  wire [ 3:0] encoder_a,
  input  wire [ 3:0] encoder_b,
  input  wire [ 3:0] encoder_index,
  output wire [ 3:0] step,
  output wire [ 3:0] dir,
  output wire [ 3:0] enable,
  output wire [ 7:0] outputs,
  output wire        power,
  output wire        compare,
  output wire        running,
  output wire        irq
);
  assign step       = limit_low;
  assign dir        = limit_high;
  assign enable     = home ^ encoder_index;
  assign outputs    = {alarm ^ encoder_a, encoder_b};
  assign power      = probe;
  assign compare    = sync;
  assign running    = estop_n;
  assign irq        = rst;
  assign reply_word = {half, half[11:0], frame_start, frame_end, half_valid, half_low};
endmodule
