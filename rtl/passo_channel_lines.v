// SPDX-License-Identifier: MIT
// Lines of a channel, and what is bound to them: each substep becomes step requests and, with OUTPUTS, changes of the
// outputs. Wiring only.
//
// Promise: those of passo_lines and passo_outputs. Axes without lines have no steps of a line.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel_lines #(
  parameter AXES            = 4,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter STEPS_REGISTER  = 0,
  parameter OUTPUTS         = 0,
  parameter RASTER          = 0,
  parameter COMPARE         = 0,
  parameter TRACKERS        = 0,
  parameter TRACKED         = 0   // the last axes have no lines
) (
  input  wire                     clk,
  input  wire                     rst,
  // bus
  input  wire                     bus_frame,
  input  wire                     bus_commit,
  input  wire                     bus_check,
  input  wire                     bus_write,
  /* verilator lint_off UNUSEDSIGNAL */  // without outputs
  input  wire                     bus_read,
  input  wire                     bus_push,
  input  wire                     select,
  input  wire [              7:0] bus_address,        // within the channel
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire [             31:0] bus_data,
  input  wire [              4:0] bus_msb,
  input  wire                     select_line_queue,  // a push to it
  output wire                     bad_value,
  output wire [              3:0] refusal,
  output wire [             31:0] read_data,
  output wire                     incomplete,
  output wire [LINE_QUEUE_LOG2:0] line_room,
  // motion
  input  wire                     prepare,
  input  wire                     stopped,
  input  wire                     release_line,
  input  wire                     end_endless,
  output wire                     line_valid,
  output wire                     line_endless,
  output wire                     line_ended,
  output wire                     line_underrun,
  // profile
  input  wire                     substep,
  // axes
  output wire [         AXES-1:0] path_steps,
  output wire [         AXES-1:0] path_directions,
  output wire [         AXES-1:0] line_moves,
  // outputs
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire                     command_clear,
  input  wire                     running,
  input  wire                     running_next,
  input  wire [             31:0] velocity,
  input  wire [             16:0] rate,
  input  wire                     follow_waits,
  input  wire [         AXES-1:0] step_made,
  input  wire [         AXES-1:0] step_direction,
  /* verilator lint_on UNUSEDSIGNAL */
  output wire                     outputs_quiet,
  output wire [              7:0] outputs,
  output wire                     power_wanted,
  output wire                     compare
);

  localparam LINED = AXES - TRACKED;  // axes that lines move

  wire [      3:0] line_refusal;
  wire [      3:0] raster_refusal;
  wire [LINED-1:0] lined_steps;
  wire [LINED-1:0] lined_directions;
  wire [LINED-1:0] lined_moves;

  // for outputs only
  /* verilator lint_off UNUSEDSIGNAL */
  wire        line_begins;
  wire        line_substep;
  wire [25:0] output_word;
  /* verilator lint_on UNUSEDSIGNAL */

  assign path_steps      = {{TRACKED{1'b0}}, lined_steps};
  assign path_directions = {{TRACKED{1'b0}}, lined_directions};
  assign line_moves      = {{TRACKED{1'b0}}, lined_moves};
  assign refusal         = line_refusal | raster_refusal;

  passo_lines #(
    .AXES          (LINED),
    .DEPTH_LOG2    (LINE_QUEUE_LOG2),
    .STEPS_REGISTER(STEPS_REGISTER),
    .OUTPUTS       (OUTPUTS),
    .RASTER        (RASTER),
    .TRACKERS      (TRACKERS)
  ) u_lines (
    .clk         (clk),
    .rst         (rst),
    .bus_frame   (bus_frame),
    .bus_commit  (bus_commit),
    .bus_check   (bus_check),
    .bus_write   (bus_write),
    .select      (select_line_queue),
    .bus_data    (bus_data),
    .bus_msb     (bus_msb),
    .refusal     (line_refusal),
    .incomplete  (incomplete),
    .room        (line_room),
    .start       (prepare),
    .stopped     (stopped),
    .release_line(release_line),
    .end_endless (end_endless),
    .valid       (line_valid),
    .endless     (line_endless),
    .ended       (line_ended),
    .underrun    (line_underrun),
    .substep     (substep),
    .step_request(lined_steps),
    .directions  (lined_directions),
    .moves       (lined_moves),
    .line_begins (line_begins),
    .line_substep(line_substep),
    .output_word (output_word)
  );

  generate
    if (OUTPUTS != 0) begin : g_outputs
      wire        select_raster;
      wire [15:0] lag;
      wire [23:0] pwm_step;
      wire [31:0] power_reference;
      wire [29:0] pitch;
      wire [ 2:0] compare_axis;
      wire [15:0] compare_width;
      wire [31:0] compare_interval;
      wire        write_levels;
      wire        write_power;
      wire        write_pulse;
      wire        write_distance;
      wire        raster_empty;
      wire        overflow;
      wire [ 8:0] raster_room;

      passo_output_registers #(
        .AXES(AXES)
      ) u_output_registers (
        .clk             (clk),
        .rst             (rst),
        .bus_write       (bus_write),
        .bus_read        (bus_read),
        .bus_push        (bus_push),
        .select          (select),
        .bus_address     (bus_address),
        .bus_data        (bus_data),
        .bad_value       (bad_value),
        .read_data       (read_data),
        .select_raster   (select_raster),
        .lag             (lag),
        .pwm_step        (pwm_step),
        .power_reference (power_reference),
        .pitch           (pitch),
        .compare_axis    (compare_axis),
        .compare_width   (compare_width),
        .compare_interval(compare_interval),
        .write_levels    (write_levels),
        .write_power     (write_power),
        .write_pulse     (write_pulse),
        .write_distance  (write_distance),
        .levels          (outputs),
        .raster_empty    (raster_empty),
        .overflow        (overflow),
        .raster_room     (raster_room)
      );

      passo_outputs #(
        .AXES   (AXES),
        .RASTER (RASTER),
        .COMPARE(COMPARE)
      ) u_outputs (
        .clk             (clk),
        .rst             (rst),
        .bus_frame       (bus_frame),
        .bus_commit      (bus_commit),
        .bus_check       (bus_check),
        .bus_write       (bus_write),
        .select          (select_raster),
        .bus_data        (bus_data),
        .refusal         (raster_refusal),
        .lag             (lag),
        .pwm_step        (pwm_step),
        .power_reference (power_reference),
        .pitch           (pitch),
        .compare_axis    (compare_axis),
        .compare_width   (compare_width),
        .compare_interval(compare_interval),
        .write_pulse     (write_pulse),
        .write_distance  (write_distance),
        .write_levels    (write_levels),
        .write_power     (write_power),
        .raster_room     (raster_room),
        .raster_empty    (raster_empty),
        .overflow        (overflow),
        .quiet           (outputs_quiet),
        .line_begins     (line_begins),
        .substep         (line_substep),
        .word            (output_word),
        .stopped         (stopped),
        .clear           (command_clear),
        .running         (running),
        .running_next    (running_next),
        .velocity        (velocity),
        .rate            (rate),
        .waits           (follow_waits),
        .step_made       (step_made),
        .step_direction  (step_direction),
        .outputs         (outputs),
        .power           (power_wanted),
        .compare         (compare)
      );
    end else begin : g_no_outputs
      assign bad_value      = 1'b0;
      assign raster_refusal = 4'd0;
      assign read_data      = 32'd0;
      assign outputs_quiet  = 1'b1;
      assign outputs        = 8'd0;
      assign power_wanted   = 1'b0;
      assign compare        = 1'b0;
    end
  endgenerate

endmodule
`resetall
