// SPDX-License-Identifier: MIT
// Axis with its timings, which the test sets, as the memory of the settings gives them.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis_top;

  reg clk, rst;
  reg step_request, direction, drop, closed_low, closed_high, clear, timing_written;
  reg pins_written, both_edges_next, both_edges, step_inverted, direction_inverted, enable, enable_inverted;
  reg [15:0] step_high, step_low, dir_setup, dir_hold;

  wire waits_next, negative_next, step_made, step_direction, full, quiet;
  wire step_pin, dir_pin, enable_pin;
  wire [3:0] lost;
  wire [1:0] timing_place;

  wire high_is_minimal = step_high == 16'd1;
  wire low_is_minimal = step_low == 16'd1;
  wire setup_is_minimal = dir_setup == 16'd1;
  wire hold_is_minimal = dir_hold == 16'd1;

  reg [15:0] timing;
  reg overrun;  // the axis did not accept a step, a clock ago
  always @(posedge clk) begin
    timing  <= timing_place[1] ? (timing_place[0] ? step_high : step_low) : timing_place[0] ? dir_setup : dir_hold;
    overrun <= step_request & full & ~rst;
  end

  passo_axis u_axis (.*);

endmodule
`resetall
