// SPDX-License-Identifier: MIT
// Registers of the outputs of a channel: settings, state; and the decode of the raster queue.
//
// Promise: `read_data` is the addressed register one clock after `bus_read`, for one clock, else 0. `write_levels`,
// `write_pulse` and `write_distance` are high in the clock after their write, with bus_data; `write_power` in the
// first clock of a new pwm_step or power_reference. `bad_value`: a checked word of COMPARE_PULSE has an axis that the
// core lacks. `select_raster`: a push to the raster queue.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_output_registers #(
  parameter AXES = 4
) (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        bus_write,
  input  wire        bus_read,
  input  wire        bus_push,
  input  wire        select,
  input  wire [ 7:0] bus_address,       // within the channel
  input  wire [31:0] bus_data,
  output wire        bad_value,
  output wire [31:0] read_data,
  output reg         select_raster,
  // settings
  output reg  [15:0] lag,
  output reg  [23:0] pwm_step,
  output reg  [31:0] power_reference,
  output reg  [29:0] pitch,
  output reg  [ 2:0] compare_axis,
  output reg  [15:0] compare_width,
  output reg  [31:0] compare_interval,
  output reg         write_levels,
  output reg         write_power,
  output reg         write_pulse,
  output reg         write_distance,
  // state
  input  wire [ 7:0] levels,
  input  wire        raster_empty,
  input  wire        overflow,
  input  wire [ 8:0] raster_room
);

  `include "passo_registers.vh"

  // Decoded one clock ahead of the strobe: the address is stable by then.
  reg        in_settings;
  reg        in_state;
  wire [2:0] number = bus_address[2:0];

  always @(posedge clk) begin
    in_settings   <= select && bus_address[7:3] == CHANNEL_OUTPUT_LEVELS[7:3];
    in_state      <= select && bus_address == CHANNEL_OUTPUT_STATE;
    select_raster <= select && bus_push && bus_address == CHANNEL_RASTER;
  end

  wire is_levels = in_settings && number == CHANNEL_OUTPUT_LEVELS[2:0];
  wire is_lag = in_settings && number == CHANNEL_OUTPUT_LAG[2:0];
  wire is_pulse = in_settings && number == CHANNEL_COMPARE_PULSE[2:0];
  wire is_distance = in_settings && number == CHANNEL_COMPARE_DISTANCE[2:0];

  assign bad_value = is_pulse && {1'b0, bus_data[18:16]} >= AXES[3:0];

  // Reading
  reg reads;

  always @(posedge clk) reads <= ~rst & bus_read & in_state;

  assign read_data = reads ? {7'd0, raster_room, 6'd0, overflow, raster_empty, levels} : 32'd0;

  // Writing
  wire write = in_settings && bus_write;

  always @(posedge clk) begin
    write_levels   <= bus_write && is_levels;
    write_power    <= write && (number == CHANNEL_PWM_STEP[2:0] || number == CHANNEL_POWER_REFERENCE[2:0]);
    write_pulse    <= bus_write && is_pulse;
    write_distance <= bus_write && is_distance;
    if (bus_write && is_lag) lag <= bus_data[15:0];
    if (write && number == CHANNEL_PWM_STEP[2:0]) pwm_step <= bus_data[23:0];
    if (write && number == CHANNEL_POWER_REFERENCE[2:0]) power_reference <= bus_data;
    if (write && number == CHANNEL_RASTER_PITCH[2:0]) pitch <= bus_data[29:0];
    if (bus_write && is_pulse) {compare_axis, compare_width} <= bus_data[18:0];
    if (write && number == CHANNEL_COMPARE_INTERVAL[2:0]) compare_interval <= bus_data;
    if (rst) begin
      write_levels     <= 1'b0;
      write_power      <= 1'b0;
      write_pulse      <= 1'b0;
      write_distance   <= 1'b0;
      lag              <= CHANNEL_OUTPUT_LAG_LAG_RESET;
      pwm_step         <= CHANNEL_PWM_STEP_RESET;
      power_reference  <= CHANNEL_POWER_REFERENCE_RESET;
      pitch            <= CHANNEL_RASTER_PITCH_PITCH_RESET;
      compare_axis     <= CHANNEL_COMPARE_PULSE_AXIS_RESET;
      compare_width    <= CHANNEL_COMPARE_PULSE_WIDTH_RESET;
      compare_interval <= CHANNEL_COMPARE_INTERVAL_INTERVAL_RESET;
    end
  end

endmodule
`resetall
