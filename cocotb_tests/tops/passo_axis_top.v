// SPDX-License-Identifier: MIT
// An axis whose times come from the test, which need not say which of them are short; 0 counts as 1.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_top (
  input  wire        clk,
  input  wire        rst,
  input  wire        step_request,
  input  wire        direction,
  input  wire        drop,
  output wire        step_made,
  output wire        step_direction,
  output wire        full,
  output reg         overrun,             // a step was not accepted, a clock ago
  output wire        quiet,
  input  wire        clear,
  output wire [ 3:0] lost,
  input  wire [15:0] step_high,
  input  wire [15:0] step_low,
  input  wire [15:0] dir_setup,
  input  wire [15:0] dir_hold,
  input  wire        timing_written,
  input  wire        pins_written,
  input  wire        both_edges_next,
  input  wire        both_edges,
  input  wire        step_inverted,
  input  wire        direction_inverted,
  input  wire        enable,
  input  wire        enable_inverted,
  output wire        step_pin,
  output wire        dir_pin,
  output wire        enable_pin
);

  always @(posedge clk) overrun <= step_request & full & ~rst;

  passo_axis u_axis (
    .clk               (clk),
    .rst               (rst),
    .step_request      (step_request),
    .direction         (direction),
    .drop              (drop),
    .step_made         (step_made),
    .step_direction    (step_direction),
    .full              (full),
    .quiet             (quiet),
    .clear             (clear),
    .lost              (lost),
    .step_high         (step_high | {15'd0, step_high == 16'd0}),
    .step_low          (step_low | {15'd0, step_low == 16'd0}),
    .dir_setup         (dir_setup | {15'd0, dir_setup == 16'd0}),
    .dir_hold          (dir_hold | {15'd0, dir_hold == 16'd0}),
    .high_is_minimal   (step_high < 16'd2),
    .low_is_minimal    (step_low < 16'd2),
    .setup_is_minimal  (dir_setup < 16'd2),
    .hold_is_minimal   (dir_hold < 16'd2),
    .timing_written    (timing_written),
    .pins_written      (pins_written),
    .both_edges_next   (both_edges_next),
    .both_edges        (both_edges),
    .step_inverted     (step_inverted),
    .direction_inverted(direction_inverted),
    .enable            (enable),
    .enable_inverted   (enable_inverted),
    .step_pin          (step_pin),
    .dir_pin           (dir_pin),
    .enable_pin        (enable_pin)
  );

endmodule
`resetall
