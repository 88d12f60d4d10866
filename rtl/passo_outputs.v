// SPDX-License-Identifier: MIT
// Path-synchronized outputs of a channel: digital outputs and power; with RASTER raster lines, with COMPARE position
// compare.
//
// The output word of a line: power (15:0), digital outputs (23:16), proportional (24), raster (25).
//
// Promise: the word of a line is at the pins 5 + lag clocks after the first substep of the line, that is, lag clocks
// after its STEP pin, and so is each value of a raster after its substep. The digital outputs keep their levels until
// another line or `write_levels` changes them. The power pin is low in every clock in which `running` is low, from 7
// clocks after velocity or rate is 0 or the path waits, when the last step has left, and after `overflow` (a change
// was lost) until `clear`. Pending changes are dropped when the channel stops. `quiet`, one clock late: none pending.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_outputs #(
  parameter AXES    = 4,
  parameter RASTER  = 0,  // 1: raster lines
  parameter COMPARE = 0   // 1: position compare
) (
  input  wire            clk,
  input  wire            rst,
  /* verilator lint_off UNUSEDSIGNAL */  // without RASTER or COMPARE
  // bus; `select`: a push to the raster queue
  input  wire            bus_frame,
  input  wire            bus_commit,
  input  wire            bus_check,
  input  wire            bus_write,
  input  wire            select,
  input  wire [    31:0] bus_data,
  output wire [     3:0] refusal,
  // settings
  input  wire [    15:0] lag,
  input  wire [    23:0] pwm_step,
  input  wire [    31:0] power_reference,
  input  wire [    29:0] pitch,
  input  wire [     2:0] compare_axis,
  input  wire [    15:0] compare_width,
  input  wire [    31:0] compare_interval,
  input  wire            write_pulse,       // strobes, with bus_data
  input  wire            write_distance,
  input  wire            write_levels,
  input  wire            write_power,       // strobe: pwm_step or power_reference is new
  // state
  output wire [     8:0] raster_room,       // in words
  output reg             raster_empty,      // a value was missing, since `clear`
  output reg             overflow,          // a change was lost, since `clear`
  output wire            quiet,
  // line
  input  wire            line_begins,
  input  wire            substep,
  input  wire [    25:0] word,              // of the current line, from two clocks after it began
  // motion
  input  wire            stopped,
  input  wire            clear,
  input  wire            running,
  input  wire            running_next,      // the level of `running` in the next clock
  input  wire [    31:0] velocity,
  input  wire [    16:0] rate,
  input  wire            waits,             // the path waits for an encoder
  // axes
  input  wire [AXES-1:0] step_made,
  input  wire [AXES-1:0] step_direction,
  /* verilator lint_on UNUSEDSIGNAL */
  // pins
  output reg  [     7:0] outputs,
  output wire            power,
  output wire            compare
);

  `include "passo_registers.vh"

  wire        first;
  wire        take;
  wire [ 7:0] value;
  wire        missed;
  wire        hit;
  wire        lost;
  wire [24:0] data;  // proportional, digital outputs, power

  reg  [ 7:0] outputs_now;
  reg  [15:0] power_now;
  reg         proportional;
  reg         lit;  // power_now is not 0
  reg         differs;  // the change that comes next changes the power
  reg         lights;  // it has one
  reg  [ 6:1] still;  // velocity or rate was 0, or the path waited, 1 .. 6 clocks ago
  wire [23:0] cost;

  always @(posedge clk) begin
    still   <= {still[5:1], velocity == 32'd0 || rate == 17'd0 || waits};
    differs <= {data[24], data[15:0]} != {proportional, power_now};
    lights  <= data[15:0] != 16'd0;
    if (hit) begin
      outputs_now  <= data[23:16];
      power_now    <= data[15:0];
      proportional <= data[24];
      lit          <= lights;
    end
    if (!running) begin
      power_now <= 16'd0;
      lit       <= 1'b0;
    end
    outputs <= outputs_now;
    if (write_levels) outputs_now <= bus_data[7:0];
    if (lost) overflow <= 1'b1;
    if (missed) raster_empty <= 1'b1;
    if (clear) begin
      overflow     <= 1'b0;
      raster_empty <= 1'b0;
    end
    if (rst) begin
      outputs      <= 8'd0;
      outputs_now  <= 8'd0;
      power_now    <= 16'd0;
      proportional <= 1'b0;
      lit          <= 1'b0;
      overflow     <= 1'b0;
      raster_empty <= 1'b0;
    end
  end

  generate
    if (RASTER != 0) begin : g_raster
      passo_raster u_raster (
        .clk        (clk),
        .rst        (rst),
        .bus_frame  (bus_frame),
        .bus_commit (bus_commit),
        .bus_check  (bus_check),
        .bus_write  (bus_write),
        .select     (select),
        .bus_data   (bus_data),
        .flush      (stopped),
        .refusal    (refusal),
        .room       (raster_room),
        .line_begins(line_begins),
        .substep    (substep),
        .raster     (word[25]),
        .pitch      (pitch),
        .first      (first),
        .take       (take),
        .value      (value),
        .missed     (missed)
      );
    end else begin : g_no_raster
      reg first_q;
      always @(posedge clk) first_q <= ~rst & ~stopped & (line_begins | (first_q & ~substep));
      assign first       = first_q;
      assign refusal     = VERDICT_OK;
      assign raster_room = 9'd0;
      assign take        = 1'b0;
      assign value       = 8'd0;
      assign missed      = 1'b0;
    end
  endgenerate

  passo_changes u_changes (
    .clk     (clk),
    .rst     (rst),
    .flush   (stopped),
    .lag     (lag),
    .change  (substep & first | take),
    .data_in ({word[24:16], take ? {value, value} : word[15:0]}),
    .hit     (hit),
    .data    (data),
    .overflow(lost),
    .empty   (quiet)
  );

  passo_power u_power (
    .clk            (clk),
    .rst            (rst),
    .moves          (running & ~still[1]),
    .velocity       (velocity),
    .rate           (rate),
    .write          (write_power),
    .power_reference(power_reference),
    .pwm_step       (pwm_step),
    .cost           (cost)
  );

  passo_pwm u_pwm (
    .clk         (clk),
    .rst         (rst),
    .go          (lit & ~still[6] & ~overflow & running & running_next),
    .restart     (hit & differs),
    .power       (power_now),
    .proportional(proportional),
    .step        (pwm_step),
    .cost        (cost),
    .pin         (power)
  );

  generate
    if (COMPARE != 0) begin : g_compare
      passo_compare #(
        .AXES(AXES)
      ) u_compare (
        .clk           (clk),
        .rst           (rst),
        .axis          (compare_axis),
        .width         (compare_width),
        .interval      (compare_interval),
        .write_pulse   (write_pulse),
        .write_distance(write_distance),
        .distance      (bus_data),
        .step_made     (step_made),
        .step_direction(step_direction),
        .pin           (compare)
      );
    end else begin : g_no_compare
      assign compare = 1'b0;
    end
  endgenerate

`ifdef FORMAL
  `include "passo_outputs_formal.vh"
`endif

endmodule
`resetall
