// SPDX-License-Identifier: MIT
// Registers of one axis: its settings (write only), its lost steps and the snapshot of its position.
//
// Promise: the answer to a strobe comes one clock later, for one clock; it is 0 unless one of these registers
// is meant. `select` is the block of this axis, `select_position` its position. The snapshot is taken on
// `snapshot`.
`resetall
`default_nettype none

module passo_axis_registers (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        bus_check,
  input  wire        bus_write,
  input  wire        bus_read,
  input  wire        bus_push,
  input  wire        select,
  input  wire        select_position,
  input  wire [ 2:0] bus_address,         // within the block
  input  wire [31:0] bus_data,
  output reg         claim,
  output reg  [ 3:0] refusal,
  output reg  [31:0] read_data,
  // axis
  input  wire        snapshot,
  input  wire [31:0] position,
  input  wire        overrun,
  input  wire        clear,
  output wire        was_overrun,
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

  reg [31:0] position_snapshot;
  reg [ 3:0] lost;

  wire is_pins = select && bus_address == AXIS_PINS;
  wire is_step_timing = select && bus_address == AXIS_STEP_TIMING;
  wire is_dir_timing = select && bus_address == AXIS_DIR_TIMING;
  wire is_lost = select && bus_address == AXIS_LOST_STEPS;
  wire readable = is_lost | select_position;
  wire writable = is_pins | is_step_timing | is_dir_timing;
  wire undefined = is_pins && (bus_data & ~AXIS_PINS_DEFINED) != 32'd0;

  assign was_overrun = lost != 4'd0;

  always @(posedge clk) begin
    claim     <= 1'b0;
    refusal   <= VERDICT_OK;
    read_data <= 32'd0;
    if (bus_check && (readable || writable)) begin
      claim <= 1'b1;
      refusal <= bus_push  ? VERDICT_BAD_OPERATION :
                 readable  ? VERDICT_READ_ONLY :
                 undefined ? VERDICT_BAD_VALUE : VERDICT_OK;
    end
    if (bus_read && (readable || writable)) begin
      claim     <= 1'b1;
      refusal   <= readable ? VERDICT_OK : VERDICT_BAD_OPERATION;
      read_data <= select_position ? position_snapshot : is_lost ? {28'd0, lost} : 32'd0;
    end

    if (bus_write && is_pins)
      {both_edges, enable_inverted, direction_inverted, step_inverted, enable} <= bus_data[4:0];
    if (bus_write && is_step_timing) {step_high, step_low} <= bus_data;
    if (bus_write && is_dir_timing) {dir_setup, dir_hold} <= bus_data;

    if (snapshot) position_snapshot <= position;
    if (overrun && lost != 4'hF) lost <= lost + 4'd1;
    if (clear) lost <= 4'd0;

    if (rst) begin
      claim              <= 1'b0;
      refusal            <= VERDICT_OK;
      read_data          <= 32'd0;
      lost               <= AXIS_LOST_STEPS_LOST_RESET;
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
