// SPDX-License-Identifier: MIT
// Path of a channel: how lines and ramps become requested steps and outputs. Control says when, lines say where, motion
// controls both. Wiring only.
//
// Promise: a line of M substeps requests exactly N_i steps of axis i, at the clocks that the profile says.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel_path #(
  parameter AXES            = 4,
  parameter TICK_LOG2       = 7,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter RAMP_QUEUE_LOG2 = 4,
  parameter STEPS_REGISTER  = 0,
  parameter INPUTS          = 0,
  parameter ENCODERS        = 0,
  parameter OUTPUTS         = 0,
  parameter RASTER          = 0,
  parameter COMPARE         = 0,
  parameter TRACKERS        = 0,
  parameter TRACKED         = 0   // the last axes have no lines
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
  input wire [7:0] bus_address,  // within the channel
  input wire [31:0] bus_data,
  input wire [4:0] bus_msb,
  input wire needs_quiet,  // strobe: a register that needs a quiet channel is being checked
  input wire tables_wanted,
  output wire bad_value,
  output wire [3:0] refusal,
  output wire [31:0] read_data,
  output wire incomplete,
  output wire busy,
  output wire [AXES-1:0] select_axis,
  output wire select_position,
  output wire command_clear,
  output wire command_zero,
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
  // drives
  output wire [AXES-1:0] path_steps,
  output wire [AXES-1:0] path_directions,
  output wire [AXES-1:0] line_moves,
  output wire path_runs,  // the profile runs, and the rate is not 0
  output wire moves_path,
  output wire quiet,
  output wire stopping,
  output wire hold,  // no motion may begin
  output wire drop,
  input wire tracking,
  input wire axes_quiet,
  input wire step_overrun,
  input wire [AXES-1:0] lost_steps,
  input wire [AXES-1:0] step_made,
  input wire [AXES-1:0] step_direction,
  // requests of the inputs
  input wire estop,
  input wire latch,
  input wire input_hard,
  input wire [3:0] input_hard_cause,
  input wire input_soft,
  input wire [3:0] input_soft_cause,
  input wire end_endless,
  input wire wait_known,
  // encoders
  input wire [AXES-1:0] encoder_a,
  input wire [AXES-1:0] encoder_b,
  input wire [AXES-1:0] encoder_index,
  output wire [AXES-1:0] index,
  // pins
  output wire [7:0] outputs,
  output wire power_wanted,
  output wire compare,
  output wire running
);

  // motion
  wire        command_stop;
  wire        command_abort;
  wire [ 2:0] state;
  wire [ 3:0] cause;
  wire [14:0] drained;
  wire        counting;
  wire        prepare;
  wire        begin_profile;
  wire        drain;
  wire        release_line;
  wire        running_next;

  // control
  wire        may_begin;
  wire        following_soft;
  wire        following_hard;
  wire        follow_waits;
  wire        ramp_valid;
  wire        ramp_ready;
  wire        ramp_ended;
  wire        ramp_dry;
  wire [16:0] rate;
  wire [31:0] velocity;
  wire        substep;
  wire [ 3:0] control_refusal;
  wire [31:0] control_read_data;
  wire        control_incomplete;

  // lines
  wire        select_line_queue;
  wire        line_valid;
  wire        line_endless;
  wire        line_ended;
  wire        line_underrun;
  wire        outputs_quiet;
  wire [ 3:0] lines_refusal;
  wire [31:0] lines_read_data;
  wire        lines_incomplete;

  assign path_runs  = moves_path && rate != 17'd0;
  assign refusal    = lines_refusal | control_refusal;
  assign read_data  = control_read_data | lines_read_data;
  assign incomplete = lines_incomplete | control_incomplete;

  passo_motion u_motion (
    .clk             (clk),
    .rst             (rst),
    .run             (run),
    .wait_sync       (wait_sync),
    .sync_edge       (sync_edge),
    .hold            (hold | (stopping & tracking) | ~outputs_quiet),
    .command_stop    (command_stop),
    .command_abort   (command_abort),
    .command_clear   (command_clear),
    .estop           (estop),
    .input_hard      (input_hard),
    .input_hard_cause(input_hard_cause),
    .input_soft      (input_soft),
    .input_soft_cause(input_soft_cause),
    .may_begin       (may_begin),
    .known           (~wait_known),
    .following_soft  (following_soft),
    .following_hard  (following_hard),
    .tracking        (tracking),
    .state           (state),
    .cause           (cause),
    .stopping        (stopping),
    .drained         (drained),
    .occupied        (occupied),
    .moving          (moves_path),
    .counting        (counting),
    .rate_is_zero    (rate == 17'd0),
    .ramp_valid      (ramp_valid),
    .ramp_ready      (ramp_ready),
    .ramp_ended      (ramp_ended),
    .ramp_dry        (ramp_dry),
    .prepare         (prepare),
    .begin_profile   (begin_profile),
    .drain           (drain),
    .line_valid      (line_valid),
    .line_ended      (line_ended),
    .line_endless    (line_endless),
    .line_underrun   (line_underrun),
    .substep_made    (substep),
    .step_overrun    (step_overrun),
    .drop            (drop),
    .release_line    (release_line),
    .stopped         (stopped),
    .running         (running),
    .running_next    (running_next)
  );

  passo_channel_control #(
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS)
  ) u_control (
    .clk              (clk),
    .rst              (rst),
    .bus_frame        (bus_frame),
    .bus_commit       (bus_commit),
    .bus_check        (bus_check),
    .bus_write        (bus_write),
    .bus_read         (bus_read),
    .bus_push         (bus_push),
    .select           (select),
    .bus_address      (bus_address),
    .bus_data         (bus_data),
    .bus_msb          (bus_msb),
    .needs_quiet      (needs_quiet),
    .tables_wanted    (tables_wanted),
    .refusal          (control_refusal),
    .read_data        (control_read_data),
    .incomplete       (control_incomplete),
    .busy             (busy),
    .select_line_queue(select_line_queue),
    .select_axis      (select_axis),
    .select_position  (select_position),
    .line_room        (line_room),
    .ramp_room        (ramp_room),
    .command_stop     (command_stop),
    .command_abort    (command_abort),
    .command_clear    (command_clear),
    .command_zero     (command_zero),
    .hold             (hold),
    .state            (state),
    .cause            (cause),
    .stopping         (stopping),
    .stopped          (stopped),
    .drained          (drained),
    .occupied         (occupied),
    .moves_path       (moves_path),
    .counting         (counting),
    .prepare          (prepare),
    .begin_profile    (begin_profile),
    .drain            (drain),
    .ramp_valid       (ramp_valid),
    .ramp_ready       (ramp_ready),
    .ramp_ended       (ramp_ended),
    .ramp_dry         (ramp_dry),
    .may_begin        (may_begin),
    .following_soft   (following_soft),
    .following_hard   (following_hard),
    .slew_tick        (slew_tick),
    .rate             (rate),
    .velocity         (velocity),
    .substep          (substep),
    .follow_waits     (follow_waits),
    .table_request    (table_request),
    .table_address    (table_address),
    .table_served     (table_served),
    .table_point      (table_point),
    .table_point_next (table_point_next),
    .outputs_quiet    (outputs_quiet),
    .tracking         (tracking),
    .axes_quiet       (axes_quiet),
    .quiet            (quiet),
    .lost_steps       (lost_steps),
    .snapshot         (snapshot),
    .latch            (latch),
    .step_made        (step_made),
    .step_direction   (step_direction),
    .encoder_a        (encoder_a),
    .encoder_b        (encoder_b),
    .encoder_index    (encoder_index),
    .index            (index)
  );

  passo_channel_lines #(
    .AXES           (AXES),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .STEPS_REGISTER (STEPS_REGISTER),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED)
  ) u_lines (
    .clk              (clk),
    .rst              (rst),
    .bus_frame        (bus_frame),
    .bus_commit       (bus_commit),
    .bus_check        (bus_check),
    .bus_write        (bus_write),
    .bus_read         (bus_read),
    .bus_push         (bus_push),
    .select           (select),
    .bus_address      (bus_address),
    .bus_data         (bus_data),
    .bus_msb          (bus_msb),
    .select_line_queue(select_line_queue),
    .bad_value        (bad_value),
    .refusal          (lines_refusal),
    .read_data        (lines_read_data),
    .incomplete       (lines_incomplete),
    .line_room        (line_room),
    .prepare          (prepare),
    .stopped          (stopped),
    .release_line     (release_line),
    .end_endless      (end_endless),
    .line_valid       (line_valid),
    .line_endless     (line_endless),
    .line_ended       (line_ended),
    .line_underrun    (line_underrun),
    .substep          (substep),
    .path_steps       (path_steps),
    .path_directions  (path_directions),
    .line_moves       (line_moves),
    .command_clear    (command_clear),
    .running          (running),
    .running_next     (running_next),
    .velocity         (velocity),
    .rate             (rate),
    .follow_waits     (follow_waits),
    .step_made        (step_made),
    .step_direction   (step_direction),
    .outputs_quiet    (outputs_quiet),
    .outputs          (outputs),
    .power_wanted     (power_wanted),
    .compare          (compare)
  );

endmodule
`resetall
