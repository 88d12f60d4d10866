// SPDX-License-Identifier: MIT
// Settings of one axis as written, and which of its timings are one clock, which the timer needs before it counts.
// A time of 0 counts as 1.
//
// The timings are a memory of four words, of which the axis reads one per clock: `timing` is that of the place in the
// clock before, unless a half of a write was stored then (`timing_written`): the upper half with the strobe, the lower
// half in the next clock, whatever a reset does.
//
// They are configuration: a reset only clears the drive enable. Until the host writes the polarities,
// each pin has the level of its parameter.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_settings #(
  parameter       BLOCK_RAM    = 1,  // of the timings; 0: as the tool likes
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
  input  wire [ 4:0] bus_data,
  input  wire [ 1:0] write_place,         // 3: step_high, 2: step_low, 1: dir_setup, 0: dir_hold
  input  wire [15:0] write_timing,        // not 0
  input  wire        write_is_minimal,    // it is 1
  output wire        timing_written,
  input  wire [ 1:0] timing_place,
  output reg  [15:0] timing,
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

  /* verilator lint_off UNUSEDPARAM */
  localparam STYLE = BLOCK_RAM != 0 ? "block" : "auto";
  /* verilator lint_on UNUSEDPARAM */

  wire write_upper = write_step_timing | write_dir_timing;
  reg  write_lower;
  wire write = (write_upper & ~rst) | write_lower;

  assign timing_written = write_upper | write_lower;

  (* no_rw_check, ram_style = STYLE *)
  reg [15:0] timings[0:3];

  always @(posedge clk) begin
    if (write) timings[write_place] <= write_timing;
    timing <= timings[timing_place];
  end

  initial begin
    step_inverted      = STEP_RESET;
    direction_inverted = DIR_RESET;
    enable_inverted    = ENABLE_RESET;
    both_edges         = AXIS_PINS_BOTH_EDGES_RESET;
    enable             = AXIS_ENABLE_RESET;
    timings[3]         = AXIS_STEP_TIMING_STEP_HIGH_RESET;
    timings[2]         = AXIS_STEP_TIMING_STEP_LOW_RESET;
    timings[1]         = AXIS_DIR_TIMING_DIR_SETUP_RESET;
    timings[0]         = AXIS_DIR_TIMING_DIR_HOLD_RESET;
    write_lower        = 1'b0;
    high_is_minimal    = AXIS_STEP_TIMING_STEP_HIGH_RESET < 16'd2;
    low_is_minimal     = AXIS_STEP_TIMING_STEP_LOW_RESET < 16'd2;
    setup_is_minimal   = AXIS_DIR_TIMING_DIR_SETUP_RESET < 16'd2;
    hold_is_minimal    = AXIS_DIR_TIMING_DIR_HOLD_RESET < 16'd2;
  end

  always @(posedge clk) begin
    write_lower <= write_upper & ~rst;
    if (write_pins && !rst) {both_edges, enable_inverted, direction_inverted, step_inverted} <= bus_data[4:1];
    if (write_step_timing && !rst) high_is_minimal <= write_is_minimal;
    if (write_dir_timing && !rst) setup_is_minimal <= write_is_minimal;
    if (write_lower && write_place[1]) low_is_minimal <= write_is_minimal;
    if (write_lower && !write_place[1]) hold_is_minimal <= write_is_minimal;
    if (write_enable) enable <= bus_data[0];
    if (disable_axis || rst) enable <= AXIS_ENABLE_RESET;
  end

`ifdef FORMAL
  `include "passo_axis_settings_formal.vh"
`endif

endmodule
`resetall
