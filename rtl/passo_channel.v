// SPDX-License-Identifier: MIT
// Channel: one coordinated group of AXES axes. The path requests steps, the drives output them. Wiring only.
//
// Promise: a step due n enabled clocks into the profile leaves its pin n clocks after `running` rose.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel #(
  parameter            AXES            = 4,
  parameter            TICK_LOG2       = 7,
  parameter            LINE_QUEUE_LOG2 = 8,
  parameter            RAMP_QUEUE_LOG2 = 4,
  parameter            STEPS_REGISTER  = 0,
  parameter            INPUTS          = 0,
  parameter            ENCODERS        = 0,
  parameter            OUTPUTS         = 0,
  parameter            RASTER          = 0,
  parameter            COMPARE         = 0,
  parameter            TRACKERS        = 0,
  parameter            TRACKED         = 0,  // the last axes have no lines
  parameter [AXES-1:0] STEP_RESET      = 0,
  parameter [AXES-1:0] DIR_RESET       = 0,
  parameter [AXES-1:0] ENABLE_RESET    = 0
) (
  input wire clk,
  input wire rst,
  // bus
  input wire bus_frame,
  input wire bus_commit,
  input wire bus_check,
  input wire bus_write,
  input wire bus_read,
  input wire bus_push,
  input wire select,
  input wire [7:0] bus_address,
  input wire [31:0] bus_data,
  input wire [4:0] bus_msb,
  input wire needs_quiet,  // strobe: a register that needs a quiet channel is being checked
  output wire bad_value,  // one of its registers objects to the word
  output wire [3:0] refusal,  // of its queues, of a push
  output wire [31:0] read_data,
  output wire incomplete,
  output wire busy,
  input wire tables_wanted,
  // core
  input wire run,
  input wire wait_sync,
  input wire sync_edge,
  input wire slew_tick,
  input wire snapshot,
  output wire stopped,
  output wire occupied,
  output wire [LINE_QUEUE_LOG2:0] line_room,
  output wire [RAMP_QUEUE_LOG2:0] ramp_room,
  // tables
  output wire table_request,
  output wire [9:0] table_address,
  input wire table_served,
  input wire [15:0] table_point,
  input wire [15:0] table_point_next,
  // inputs of the machine
  input wire filter_tick,
  input wire [15:0] filter,
  input wire write_filter,
  input wire estop_pressed,  // asynchronous
  input wire estop,
  input wire watchdog_stop,
  input wire disable_drives,
  input wire [AXES-1:0] limit_low,
  input wire [AXES-1:0] limit_high,
  input wire [AXES-1:0] home,
  input wire [AXES-1:0] alarm,
  input wire probe,
  input wire [AXES-1:0] encoder_a,
  input wire [AXES-1:0] encoder_b,
  input wire [AXES-1:0] encoder_index,
  output wire moving,
  // pins
  output wire [AXES-1:0] step,
  output wire [AXES-1:0] dir,
  output wire [AXES-1:0] enable,
  output wire [7:0] outputs,
  output wire power,
  output wire compare,
  output wire running
);

  // path
  wire [AXES-1:0] select_axis;
  wire            select_position;
  wire            command_clear;
  wire            command_zero;
  wire [AXES-1:0] path_steps;
  wire [AXES-1:0] path_directions;
  wire [AXES-1:0] line_moves;
  wire            path_runs;
  wire            moves_path;
  wire            quiet;
  wire            stopping;
  wire            hold;
  wire            drop;
  wire [AXES-1:0] index;
  wire            power_wanted;

  // drives
  wire            tracking;
  wire            axes_quiet;
  wire            step_overrun;
  wire [AXES-1:0] lost_steps;
  wire [AXES-1:0] step_made;
  wire [AXES-1:0] step_direction;
  wire            latch;
  wire            input_hard;
  wire [     3:0] input_hard_cause;
  wire            input_soft;
  wire [     3:0] input_soft_cause;
  wire            end_endless;
  wire            wait_known;

  wire        path_bad_value;
  wire        drives_bad_value;
  wire [31:0] path_read_data;
  wire [31:0] drives_read_data;

  // Unselected targets drive 0.
  assign bad_value = path_bad_value | drives_bad_value;
  assign read_data = path_read_data | drives_read_data;

  passo_channel_path #(
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .STEPS_REGISTER (STEPS_REGISTER),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED)
  ) u_path (
    .clk             (clk),
    .rst             (rst),
    .bus_frame       (bus_frame),
    .bus_commit      (bus_commit),
    .bus_check       (bus_check),
    .bus_write       (bus_write),
    .bus_read        (bus_read),
    .bus_push        (bus_push),
    .select          (select),
    .bus_address     (bus_address),
    .bus_data        (bus_data),
    .bus_msb         (bus_msb),
    .needs_quiet     (needs_quiet),
    .tables_wanted   (tables_wanted),
    .bad_value       (path_bad_value),
    .refusal         (refusal),
    .read_data       (path_read_data),
    .incomplete      (incomplete),
    .busy            (busy),
    .select_axis     (select_axis),
    .select_position (select_position),
    .command_clear   (command_clear),
    .command_zero    (command_zero),
    .run             (run),
    .wait_sync       (wait_sync),
    .sync_edge       (sync_edge),
    .slew_tick       (slew_tick),
    .snapshot        (snapshot),
    .stopped         (stopped),
    .occupied        (occupied),
    .line_room       (line_room),
    .ramp_room       (ramp_room),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served),
    .table_point     (table_point),
    .table_point_next(table_point_next),
    .path_steps      (path_steps),
    .path_directions (path_directions),
    .line_moves      (line_moves),
    .path_runs       (path_runs),
    .moves_path      (moves_path),
    .quiet           (quiet),
    .stopping        (stopping),
    .hold            (hold),
    .drop            (drop),
    .tracking        (tracking),
    .axes_quiet      (axes_quiet),
    .step_overrun    (step_overrun),
    .lost_steps      (lost_steps),
    .step_made       (step_made),
    .step_direction  (step_direction),
    .estop           (estop),
    .latch           (latch),
    .input_hard      (input_hard),
    .input_hard_cause(input_hard_cause),
    .input_soft      (input_soft),
    .input_soft_cause(input_soft_cause),
    .end_endless     (end_endless),
    .wait_known      (wait_known),
    .encoder_a       (encoder_a),
    .encoder_b       (encoder_b),
    .encoder_index   (encoder_index),
    .index           (index),
    .outputs         (outputs),
    .power_wanted    (power_wanted),
    .compare         (compare),
    .running         (running)
  );

  passo_channel_drives #(
    .AXES          (AXES),
    .STEPS_REGISTER(STEPS_REGISTER),
    .INPUTS        (INPUTS),
    .TRACKERS      (TRACKERS),
    .STEP_RESET    (STEP_RESET),
    .DIR_RESET     (DIR_RESET),
    .ENABLE_RESET  (ENABLE_RESET)
  ) u_drives (
    .clk             (clk),
    .rst             (rst),
    .bus_write       (bus_write),
    .bus_read        (bus_read),
    .select          (select),
    .bus_address     (bus_address),
    .bus_data        (bus_data),
    .select_axis     (select_axis),
    .select_position (select_position),
    .bad_value       (drives_bad_value),
    .read_data       (drives_read_data),
    .command_clear   (command_clear),
    .command_zero    (command_zero),
    .snapshot        (snapshot),
    .path_steps      (path_steps),
    .path_directions (path_directions),
    .line_moves      (line_moves),
    .path_runs       (path_runs),
    .moves_path      (moves_path),
    .occupied        (occupied),
    .quiet           (quiet),
    .stopped         (stopped),
    .stopping        (stopping),
    .hold            (hold),
    .drop            (drop),
    .moving          (moving),
    .tracking        (tracking),
    .axes_quiet      (axes_quiet),
    .step_overrun    (step_overrun),
    .lost_steps      (lost_steps),
    .step_made       (step_made),
    .step_direction  (step_direction),
    .latch           (latch),
    .input_hard      (input_hard),
    .input_hard_cause(input_hard_cause),
    .input_soft      (input_soft),
    .input_soft_cause(input_soft_cause),
    .end_endless     (end_endless),
    .wait_known      (wait_known),
    .filter_tick     (filter_tick),
    .filter          (filter),
    .write_filter    (write_filter),
    .estop_pressed   (estop_pressed),
    .estop           (estop),
    .watchdog_stop   (watchdog_stop),
    .disable_drives  (disable_drives),
    .limit_low       (limit_low),
    .limit_high      (limit_high),
    .home            (home),
    .alarm           (alarm),
    .probe           (probe),
    .index           (index),
    .power_wanted    (power_wanted),
    .power           (power),
    .step            (step),
    .dir             (dir),
    .enable          (enable)
  );

endmodule
`resetall
