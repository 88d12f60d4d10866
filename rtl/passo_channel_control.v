// SPDX-License-Identifier: MIT
// Control of a channel: its registers and commands, the admission of frames, and when its path advances: time scale,
// profile and, with ENCODERS, the encoders that it may follow. Wiring, except for `quiet`.
//
// Promise: substeps are output at the velocity of the ramps, in the clocks that the time scale or the encoder enables.
// `quiet`: no motion, no step in flight to the axes or at their pins, no pending change of the outputs, no moving
// tracker.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_channel_control #(
  parameter AXES            = 4,
  parameter TICK_LOG2       = 7,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter RAMP_QUEUE_LOG2 = 4,
  parameter INPUTS          = 0,
  parameter ENCODERS        = 0
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
  output wire [3:0] refusal,
  output wire [31:0] read_data,
  output wire incomplete,
  output wire busy,
  // blocks
  output wire select_line_queue,
  output wire [AXES-1:0] select_axis,
  output wire select_position,
  input wire [LINE_QUEUE_LOG2:0] line_room,
  output wire [RAMP_QUEUE_LOG2:0] ramp_room,
  // commands
  output wire command_stop,
  output wire command_abort,
  output wire command_clear,
  output wire command_zero,
  // motion
  output wire hold,  // no motion may begin
  input wire [2:0] state,
  input wire [3:0] cause,
  input wire stopping,
  input wire stopped,
  input wire [14:0] drained,
  input wire occupied,
  input wire moves_path,
  input wire counting,
  input wire prepare,
  input wire begin_profile,
  input wire drain,
  output wire ramp_valid,
  output wire ramp_ready,
  output wire ramp_ended,
  output wire ramp_dry,
  output wire may_begin,
  output wire following_soft,
  output wire following_hard,
  // time scale and profile
  input wire slew_tick,
  output wire [16:0] rate,
  output wire [31:0] velocity,
  output wire substep,
  output wire follow_waits,  // the path waits for an encoder
  output wire table_request,
  output wire [9:0] table_address,
  input wire table_served,
  input wire [15:0] table_point,
  input wire [15:0] table_point_next,
  // outputs, trackers, axes
  input wire outputs_quiet,
  input wire tracking,
  input wire axes_quiet,
  output wire quiet,
  input wire [AXES-1:0] lost_steps,
  // encoders
  /* verilator lint_off UNUSEDSIGNAL */
  input wire snapshot,
  input wire latch,
  input wire [AXES-1:0] step_made,
  input wire [AXES-1:0] step_direction,
  input wire [AXES-1:0] encoder_a,
  input wire [AXES-1:0] encoder_b,
  input wire [AXES-1:0] encoder_index,
  /* verilator lint_on UNUSEDSIGNAL */
  output wire [AXES-1:0] index
);

  wire [16:0] rate_target;
  wire [16:0] rate_slew;
  wire [16:0] stop_slew;
  wire [31:0] drain_velocity;
  wire        select_ramp_queue;
  wire        command_needs_idle;
  wire        command_needs_quiet;
  wire        ramp_needs_motion;
  wire        ramp_now_coming;
  wire        ends_next;
  wire        enabled;
  wire        follows;
  wire        follow_advance;
  wire [31:0] registers_read_data;
  wire [31:0] encoders_read_data;
  /* verilator lint_off UNUSEDSIGNAL */
  wire        stall;
  /* verilator lint_on UNUSEDSIGNAL */

  assign read_data = registers_read_data | encoders_read_data;

  reg [2:0] occupied_q;  // a line loaded in the clock of a stop changes DIR up to 4 clocks later
  reg       at_rest;  // no motion, no step in flight to the axes, no change of the outputs that waits

  assign quiet = at_rest & ~occupied;

  always @(posedge clk) begin
    occupied_q <= {occupied_q[1:0], occupied};
    at_rest    <= ~occupied & (occupied_q == 3'b000) & axes_quiet & outputs_quiet & ~tracking;
  end

  passo_channel_registers #(
    .AXES           (AXES),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS         (INPUTS)
  ) u_registers (
    .clk              (clk),
    .rst              (rst),
    .bus_check        (bus_check),
    .bus_write        (bus_write),
    .bus_read         (bus_read),
    .bus_push         (bus_push),
    .select           (select),
    .bus_address      (bus_address),
    .bus_data         (bus_data),
    .read_data        (registers_read_data),
    .select_line_queue(select_line_queue),
    .select_ramp_queue(select_ramp_queue),
    .select_axis      (select_axis),
    .select_position  (select_position),
    .rate_target      (rate_target),
    .rate_slew        (rate_slew),
    .stop_slew        (stop_slew),
    .drain_velocity   (drain_velocity),
    .command_stop     (command_stop),
    .command_abort    (command_abort),
    .command_clear    (command_clear),
    .command_zero     (command_zero),
    .needs_idle       (command_needs_idle),
    .needs_quiet      (command_needs_quiet),
    .quiet            (quiet),
    .state            (state),
    .cause            (cause),
    .stopping         (stopping),
    .overrun          (lost_steps),
    .drained          (drained),
    .rate             (rate),
    .velocity         (velocity),
    .line_room        (line_room),
    .ramp_room        (ramp_room)
  );

  passo_admission u_admission (
    .clk          (clk),
    .rst          (rst),
    .bus_frame    (bus_frame),
    .bus_commit   (bus_commit),
    .needs_idle   (command_needs_idle),
    .needs_quiet  (command_needs_quiet | (needs_quiet & select)),
    .needs_motion (ramp_needs_motion),
    .tables_wanted(tables_wanted),
    .occupied     (occupied),
    .at_rest      (at_rest),
    .takes_now    (~ends_next),
    .busy         (busy),
    .hold         (hold),
    .now_coming   (ramp_now_coming)
  );

  passo_timescale u_timescale (
    .clk        (clk),
    .rst        (rst),
    .slew_tick  (slew_tick),
    .moving     (moves_path),
    .stopping   (stopping),
    .rate_target(rate_target),
    .rate_slew  (rate_slew),
    .stop_slew  (stop_slew),
    .rate       (rate),
    .enable     (enabled)
  );

  passo_profile #(
    .TICK_LOG2 (TICK_LOG2),
    .DEPTH_LOG2(RAMP_QUEUE_LOG2)
  ) u_profile (
    .clk             (clk),
    .rst             (rst),
    .bus_frame       (bus_frame),
    .bus_commit      (bus_commit),
    .bus_check       (bus_check),
    .bus_write       (bus_write),
    .select          (select_ramp_queue),
    .bus_data        (bus_data),
    .bus_msb         (bus_msb),
    .refusal         (refusal),
    .incomplete      (incomplete),
    .needs_motion    (ramp_needs_motion),
    .room            (ramp_room),
    .prepare         (prepare),
    .begin_profile   (begin_profile),
    .stopped         (stopped),
    .drain           (drain),
    .drain_velocity  (drain_velocity),
    .now_coming      (ramp_now_coming),
    .valid           (ramp_valid),
    .ready           (ramp_ready),
    .ended           (ramp_ended),
    .dry             (ramp_dry),
    .ends_next       (ends_next),
    .enable          (follows ? follow_advance : enabled & counting),
    .stall           (stall),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served),
    .table_point     (table_point),
    .table_point_next(table_point_next),
    .velocity        (velocity),
    .substep         (substep)
  );

  generate
    if (ENCODERS != 0) begin : g_encoders
      passo_encoders #(
        .AXES (AXES),
        .LATCH(INPUTS)
      ) u_encoders (
        .clk           (clk),
        .rst           (rst),
        .bus_write     (bus_write),
        .bus_read      (bus_read),
        .select        (select),
        .bus_address   (bus_address),
        .bus_data      (bus_data),
        .read_data     (encoders_read_data),
        .zero          (command_zero),
        .clear         (command_clear),
        .snapshot      (snapshot),
        .latch         (latch),
        .step_made     (step_made),
        .step_direction(step_direction),
        .prepare       (prepare),
        .begin_profile (begin_profile),
        .counting      (counting),
        .drain         (drain),
        .may_begin     (may_begin),
        .stop_soft     (following_soft),
        .stop_hard     (following_hard),
        .enabled       (enabled),
        .stall         (stall),
        .follows       (follows),
        .advance       (follow_advance),
        .waits         (follow_waits),
        .a             (encoder_a),
        .b             (encoder_b),
        .index         (encoder_index),
        .index_active  (index)
      );
    end else begin : g_no_encoders
      assign encoders_read_data = 32'd0;
      assign may_begin          = 1'b1;
      assign following_soft     = 1'b0;
      assign following_hard     = 1'b0;
      assign follows            = 1'b0;
      assign follow_advance     = 1'b0;
      assign follow_waits       = 1'b0;
      assign index              = {AXES{1'b0}};
    end
  endgenerate

endmodule
`resetall
