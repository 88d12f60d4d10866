// SPDX-License-Identifier: MIT
// Drives of a channel: what is between the steps that a path requests and the pins. Axes, with INPUTS the switches of
// the machine, with TRACKERS the second hand of every axis. Wiring, except for what takes EN and power away.
//
// Promise: without trackers the steps of the path, and with them also theirs, leave the pins as legal waveforms,
// unless an input blocks them; while `estop_pressed` each EN disables, and the power is off.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel_drives #(
  parameter            AXES           = 4,
  parameter            STEPS_REGISTER = 0,
  parameter            INPUTS         = 0,
  parameter            TRACKERS       = 0,
  parameter [AXES-1:0] STEP_RESET     = 0,
  parameter [AXES-1:0] DIR_RESET      = 0,
  parameter [AXES-1:0] ENABLE_RESET   = 0
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  /* verilator lint_off UNUSEDSIGNAL */  // without inputs, without trackers
  input  wire            select,
  input  wire [     7:0] bus_address,       // within the channel
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire [    31:0] bus_data,
  input  wire [AXES-1:0] select_axis,
  input  wire            select_position,
  output wire            bad_value,
  output wire [    31:0] read_data,
  input  wire            command_clear,
  input  wire            command_zero,
  input  wire            snapshot,
  // path
  input  wire [AXES-1:0] path_steps,
  input  wire [AXES-1:0] path_directions,
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire [AXES-1:0] line_moves,
  input  wire            path_runs,         // the profile runs, and the rate is not 0
  // motion
  input  wire            moves_path,
  input  wire            occupied,
  input  wire            quiet,
  input  wire            stopped,
  input  wire            stopping,
  input  wire            hold,              // no motion may begin
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire            drop,
  output wire            moving,
  output wire            tracking,          // a tracker moves
  output wire            axes_quiet,
  output wire            step_overrun,
  output wire [AXES-1:0] lost_steps,
  output wire [AXES-1:0] step_made,
  output wire [AXES-1:0] step_direction,
  // what the inputs request
  output wire            latch,
  output wire            input_hard,
  output wire [     3:0] input_hard_cause,
  output wire            input_soft,
  output wire [     3:0] input_soft_cause,
  output wire            end_endless,
  output wire            wait_known,
  // inputs of the machine
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire            filter_tick,
  input  wire [    15:0] filter,
  input  wire            write_filter,
  input  wire            estop_pressed,     // asynchronous
  input  wire            estop,
  input  wire            watchdog_stop,
  input  wire            disable_drives,
  input  wire [AXES-1:0] limit_low,
  input  wire [AXES-1:0] limit_high,
  input  wire [AXES-1:0] home,
  input  wire [AXES-1:0] alarm,
  input  wire            probe,
  input  wire [AXES-1:0] index,
  /* verilator lint_on UNUSEDSIGNAL */
  // pins
  input  wire            power_wanted,
  output wire            power,
  output wire [AXES-1:0] step,
  output wire [AXES-1:0] dir,
  output wire [AXES-1:0] enable
);

  `include "passo_registers.vh"

  // trackers
  wire [AXES-1:0] step_request;
  wire [AXES-1:0] directions;
  wire [    23:0] trackers_read_data;
  wire            of_tracker;
  wire            tracker_takes;
  wire [    15:0] tracker_half;

  // axes
  wire [AXES-1:0] enable_wanted;
  wire [    31:0] axes_read_data;

  // for inputs and trackers only
  /* verilator lint_off UNUSEDSIGNAL */
  wire [    15:0] bus_half;
  wire [AXES-1:0] enable_off;
  wire [AXES-1:0] waits;
  wire [AXES-1:0] negative;
  wire [AXES-1:0] write_inputs;
  /* verilator lint_on UNUSEDSIGNAL */

  // inputs
  wire [AXES-1:0] closed_low;
  wire [AXES-1:0] closed_high;
  wire [AXES-1:0] disable_axis;
  wire [    31:0] inputs_read_data;

  assign moving    = moves_path | tracking;
  assign read_data = axes_read_data | inputs_read_data | {8'd0, trackers_read_data};

  passo_axes #(
    .AXES        (AXES),
    .INPUTS      (INPUTS),
    .TRACKERS    (TRACKERS),
    .BLOCK_RAM   (STEPS_REGISTER == 0),
    .STEP_RESET  (STEP_RESET),
    .DIR_RESET   (DIR_RESET),
    .ENABLE_RESET(ENABLE_RESET)
  ) u_axes (
    .clk            (clk),
    .rst            (rst),
    .bus_write      (bus_write),
    .bus_read       (bus_read),
    .select_axis    (select_axis),
    .select_position(select_position),
    .bus_address    (bus_address[3:0]),
    .bus_data       (bus_data),
    .read_data      (axes_read_data),
    .of_tracker     (of_tracker),
    .tracker_takes  (tracker_takes),
    .tracker_half   (tracker_half),
    .bus_half       (bus_half),
    .step_request   (step_request),
    .directions     (directions),
    .drop           (drop),
    .closed_low     (closed_low),
    .closed_high    (closed_high),
    .disable_axis   (disable_axis),
    .latch          (latch),
    .waits          (waits),
    .negative       (negative),
    .write_inputs   (write_inputs),
    .enable_off     (enable_off),
    .clear          (command_clear),
    .zero           (command_zero),
    .snapshot       (snapshot),
    .quiet          (axes_quiet),
    .step_overrun   (step_overrun),
    .lost_steps     (lost_steps),
    .step_made      (step_made),
    .step_direction (step_direction),
    .step           (step),
    .dir            (dir),
    .enable         (enable_wanted)
  );

  generate
    if (INPUTS != 0) begin : g_inputs
      assign enable = estop_pressed ? enable_off : enable_wanted;
      assign power  = power_wanted & ~estop_pressed;

      passo_inputs #(
        .AXES(AXES)
      ) u_inputs (
        .clk           (clk),
        .rst           (rst),
        .bus_write     (bus_write),
        .bus_read      (bus_read),
        .select        (select),
        .bus_address   (bus_address),
        .bus_data      (bus_data),
        .bad_value     (bad_value),
        .read_data     (inputs_read_data),
        .write_axis    (write_inputs),
        .tick          (filter_tick),
        .filter        (filter),
        .write_filter  (write_filter),
        .watchdog_stop (watchdog_stop),
        .disable_drives(disable_drives | estop),
        .limit_low     (limit_low),
        .limit_high    (limit_high),
        .home          (home),
        .alarm         (alarm),
        .probe         (probe),
        .index         (index),
        .waits         (waits),
        .negative      (negative),
        .closed_low    (closed_low),
        .closed_high   (closed_high),
        .disable_axis  (disable_axis),
        .latch         (latch),
        .may_close     (quiet | (occupied & ~moves_path & ~tracking)),
        .moving        (moving),
        .clear         (command_clear),
        .hard_stop     (input_hard),
        .hard_cause    (input_hard_cause),
        .soft_stop     (input_soft),
        .soft_cause    (input_soft_cause),
        .end_endless   (end_endless),
        .wait_known    (wait_known)
      );
    end else begin : g_no_inputs
      assign enable           = enable_wanted;
      assign power            = power_wanted;
      assign bad_value        = 1'b0;
      assign inputs_read_data = 32'd0;
      assign closed_low       = {AXES{1'b0}};
      assign closed_high      = {AXES{1'b0}};
      assign disable_axis     = {AXES{1'b0}};
      assign latch            = 1'b0;
      assign input_hard       = 1'b0;
      assign input_hard_cause = CAUSE_NONE;
      assign input_soft       = 1'b0;
      assign input_soft_cause = CAUSE_NONE;
      assign end_endless      = 1'b0;
      assign wait_known       = 1'b0;
    end
  endgenerate

  generate
    if (TRACKERS != 0) begin : g_trackers
      passo_trackers #(
        .AXES(AXES)
      ) u_trackers (
        .clk          (clk),
        .rst          (rst),
        .bus_write    (bus_write),
        .bus_read     (bus_read),
        .select       (select),
        .bus_address  (bus_address),
        .bus_bits     (bus_data[AXES-1:0]),
        .bus_half     (bus_half),
        .read_data    (trackers_read_data),
        .of_tracker   (of_tracker),
        .tracker_takes(tracker_takes),
        .tracker_half (tracker_half),
        .halt         (drop | stopped),
        .zero         (command_zero),
        .brake        (stopping),
        .hold         (hold | wait_known),
        .busy         (tracking),
        .path_steps   (path_steps),
        .path_down    (path_directions),
        .line_moves   (line_moves),
        .path_runs    (path_runs),
        .waits        (waits),
        .step_request (step_request),
        .directions   (directions)
      );
    end else begin : g_no_trackers
      assign trackers_read_data = 24'd0;
      assign of_tracker         = 1'b0;
      assign tracker_takes      = 1'b0;
      assign tracker_half       = 16'd0;
      assign tracking           = 1'b0;
      assign step_request       = path_steps;
      assign directions         = path_directions;
    end
  endgenerate

endmodule
`resetall
