// SPDX-License-Identifier: MIT
// Settings of one axis as written, and which of its timings are one clock, which the timer needs before it counts.
// A time of 0 counts as 1.
//
// They are configuration: a reset only clears the drive enable. Until the host writes the polarities,
// each pin has the level of its parameter.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_settings #(
  parameter [0:0] STEP_RESET   = 0,
  parameter [0:0] DIR_RESET    = 0,
  parameter [0:0] ENABLE_RESET = 0
) (
  input  wire        clk,
  input  wire        rst,
  // strobes with bus_data
  input  wire        write_pins,
  input  wire        write_step_timing,
  input  wire        write_dir_timing,
  input  wire        write_enable,
  input  wire        disable_axis,        // clears `enable` while it is high
  input  wire [31:0] bus_data,
  input  wire        upper_is_minimal,    // upper half is 0 or 1
  input  wire        lower_is_minimal,
  output reg  [15:0] step_high,
  output reg  [15:0] step_low,
  output reg  [15:0] dir_setup,
  output reg  [15:0] dir_hold,
  output reg         high_is_minimal,     // step_high is 1
  output reg         low_is_minimal,
  output reg         setup_is_minimal,
  output reg         hold_is_minimal,
  output reg         both_edges,
  output reg         step_inverted,
  output reg         direction_inverted,
  output reg         enable,
  output reg         enable_inverted
);

  `include "passo_registers.vh"

  wire [31:0] times = bus_data | {15'd0, upper_is_minimal, 15'd0, lower_is_minimal};

  initial begin
    step_inverted      = STEP_RESET;
    direction_inverted = DIR_RESET;
    enable_inverted    = ENABLE_RESET;
    both_edges         = AXIS_PINS_BOTH_EDGES_RESET;
    enable             = AXIS_ENABLE_RESET;
    step_high          = AXIS_STEP_TIMING_STEP_HIGH_RESET;
    step_low           = AXIS_STEP_TIMING_STEP_LOW_RESET;
    dir_setup          = AXIS_DIR_TIMING_DIR_SETUP_RESET;
    dir_hold           = AXIS_DIR_TIMING_DIR_HOLD_RESET;
    high_is_minimal    = AXIS_STEP_TIMING_STEP_HIGH_RESET < 16'd2;
    low_is_minimal     = AXIS_STEP_TIMING_STEP_LOW_RESET < 16'd2;
    setup_is_minimal   = AXIS_DIR_TIMING_DIR_SETUP_RESET < 16'd2;
    hold_is_minimal    = AXIS_DIR_TIMING_DIR_HOLD_RESET < 16'd2;
  end

  always @(posedge clk) begin
    if (write_pins && !rst) {both_edges, enable_inverted, direction_inverted, step_inverted} <= bus_data[4:1];
    if (write_step_timing && !rst) begin
      {step_high, step_low}             <= times;
      {high_is_minimal, low_is_minimal} <= {upper_is_minimal, lower_is_minimal};
    end
    if (write_dir_timing && !rst) begin
      {dir_setup, dir_hold}               <= times;
      {setup_is_minimal, hold_is_minimal} <= {upper_is_minimal, lower_is_minimal};
    end
    if (write_enable) enable <= bus_data[0];
    if (disable_axis || rst) enable <= AXIS_ENABLE_RESET;
  end

endmodule
`resetall
