// SPDX-License-Identifier: MIT
// Settings of one axis, as they are written.
`resetall
`default_nettype none

module passo_axis_settings (
  input  wire        clk,
  input  wire        rst,
  // strobes with bus_data
  input  wire        write_pins,
  input  wire        write_step_timing,
  input  wire        write_dir_timing,
  input  wire [31:0] bus_data,
  output reg  [15:0] step_high,
  output reg  [15:0] step_low,
  output reg  [15:0] dir_setup,
  output reg  [15:0] dir_hold,
  output reg         both_edges,
  output reg         step_inverted,
  output reg         direction_inverted,
  output reg         enable,
  output reg         enable_inverted
);

  `include "passo_registers.vh"

  always @(posedge clk) begin
    if (write_pins)
      {both_edges, enable_inverted, direction_inverted, step_inverted, enable} <= bus_data[4:0];
    if (write_step_timing) {step_high, step_low} <= bus_data;
    if (write_dir_timing) {dir_setup, dir_hold} <= bus_data;

    if (rst) begin
      enable             <= AXIS_PINS_ENABLE_RESET;
      step_inverted      <= AXIS_PINS_STEP_INVERTED_RESET;
      direction_inverted <= AXIS_PINS_DIRECTION_INVERTED_RESET;
      enable_inverted    <= AXIS_PINS_ENABLE_INVERTED_RESET;
      both_edges         <= AXIS_PINS_BOTH_EDGES_RESET;
      step_high          <= AXIS_STEP_TIMING_STEP_HIGH_RESET;
      step_low           <= AXIS_STEP_TIMING_STEP_LOW_RESET;
      dir_setup          <= AXIS_DIR_TIMING_DIR_SETUP_RESET;
      dir_hold           <= AXIS_DIR_TIMING_DIR_HOLD_RESET;
    end
  end

endmodule
`resetall
