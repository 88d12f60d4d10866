// SPDX-License-Identifier: MIT
// Channel: one coordinated group of AXES axes. Lines say where, the profile says when, the axes drive the pins, the
// motion controls them. Wiring, except for `quiet`.
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
  /* verilator lint_off UNUSEDSIGNAL */
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
  /* verilator lint_on UNUSEDSIGNAL */
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

  `include "passo_registers.vh"

  localparam LINED = AXES - TRACKED;  // axes that lines move

  // registers
  wire            select_line_queue;
  wire            select_ramp_queue;
  wire [AXES-1:0] select_axis;
  wire            select_position;
  wire [    16:0] rate_target;
  wire [    16:0] rate_slew;
  wire [    16:0] stop_slew;
  wire [    31:0] drain_velocity;
  wire            command_stop;
  wire            command_abort;
  wire            command_clear;
  wire            command_zero;
  wire            command_needs_idle;
  wire            command_needs_quiet;
  wire            ramp_needs_motion;
  wire            hold;

  // motion
  wire [ 2:0] state;
  wire [ 3:0] cause;
  wire        stopping;
  wire [14:0] drained;
  wire        moves_path;
  wire        counting;
  wire        prepare;
  wire        begin_profile;
  wire        drain;
  wire        release_line;
  wire        drop;

  // profile
  wire [16:0] rate;
  wire        enabled;
  wire        ramp_now_coming;
  wire        ramp_valid;
  wire        ramp_ready;
  wire        ramp_ended;
  wire        ramp_dry;
  wire        ends_next;
  wire [31:0] velocity;
  wire        substep;

  // lines
  wire             line_valid;
  wire             line_endless;
  wire             line_ended;
  wire             line_underrun;
  wire [ AXES-1:0] path_steps;
  wire [ AXES-1:0] path_directions;
  wire [LINED-1:0] lined_steps;
  wire [LINED-1:0] lined_directions;
  wire [LINED-1:0] lined_moves;

  // trackers
  wire            tracking;
  wire [AXES-1:0] step_request;
  wire [AXES-1:0] directions;
  wire [    23:0] trackers_read_data;
  wire            of_tracker;
  wire            tracker_takes;
  wire [    15:0] tracker_half;
  /* verilator lint_off UNUSEDSIGNAL */
  wire [    15:0] bus_half;
  /* verilator lint_on UNUSEDSIGNAL */

  // axes
  wire            axes_quiet;
  wire            step_overrun;
  wire [AXES-1:0] lost_steps;
  wire [AXES-1:0] enable_wanted;

  // for inputs, encoders, outputs and trackers only
  /* verilator lint_off UNUSEDSIGNAL */
  wire [AXES-1:0] enable_off;
  wire [AXES-1:0] waits;
  wire [AXES-1:0] negative;
  wire [AXES-1:0] write_inputs;
  wire [AXES-1:0] step_made;
  wire [AXES-1:0] step_direction;
  wire [AXES-1:0] index;
  wire            stall;
  wire            running_next;
  wire [AXES-1:0] line_moves;
  wire            line_begins;
  wire            line_substep;
  wire [    25:0] output_word;
  wire            follow_waits;
  /* verilator lint_on UNUSEDSIGNAL */

  // inputs
  wire [AXES-1:0] closed_low;
  wire [AXES-1:0] closed_high;
  wire [AXES-1:0] disable_axis;
  wire            latch;
  wire            input_hard;
  wire [     3:0] input_hard_cause;
  wire            input_soft;
  wire [     3:0] input_soft_cause;
  wire            end_endless;
  wire            wait_known;
  wire            inputs_bad_value;
  wire [    31:0] inputs_read_data;

  // encoders
  wire        may_begin;
  wire        following_soft;
  wire        following_hard;
  wire        follows;
  wire        follow_advance;
  wire [31:0] encoders_read_data;

  // outputs
  wire        power_wanted;
  wire        outputs_quiet;
  wire        outputs_bad_value;
  wire [31:0] outputs_read_data;

  wire [31:0] registers_read_data;
  wire [31:0] axes_read_data;
  wire [ 3:0] line_refusal;
  wire [ 3:0] ramp_refusal;
  wire [ 3:0] raster_refusal;
  wire        line_incomplete;
  wire        ramp_incomplete;

  assign incomplete = line_incomplete | ramp_incomplete;
  assign moving     = moves_path | tracking;

  // Axes without lines have no steps of a line.
  assign path_steps      = {{TRACKED{1'b0}}, lined_steps};
  assign path_directions = {{TRACKED{1'b0}}, lined_directions};
  assign line_moves      = {{TRACKED{1'b0}}, lined_moves};

  // Unselected targets drive 0.
  assign bad_value = inputs_bad_value | outputs_bad_value;
  assign refusal = line_refusal | ramp_refusal | raster_refusal;
  assign read_data = registers_read_data | axes_read_data | inputs_read_data | encoders_read_data | outputs_read_data
                     | {8'd0, trackers_read_data};

  reg  [2:0] occupied_q;  // a line loaded in the clock of a stop changes DIR up to 4 clocks later
  reg        at_rest;  // no motion, no step in flight to the axes, no change of the outputs that waits
  wire       quiet = at_rest & ~occupied;

  always @(posedge clk) begin
    occupied_q <= {occupied_q[1:0], occupied};
    at_rest    <= ~rst & ~occupied & (occupied_q == 3'b000) & axes_quiet & outputs_quiet & ~tracking;
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

  passo_motion u_motion (
    .clk             (clk),
    .rst             (rst),
    .run             (run),
    .wait_sync       (wait_sync),
    .sync_edge       (sync_edge),
    .hold            (hold | wait_known | (stopping & tracking)),
    .command_stop    (command_stop),
    .command_abort   (command_abort),
    .command_clear   (command_clear),
    .estop           (estop),
    .input_hard      (input_hard),
    .input_hard_cause(input_hard_cause),
    .input_soft      (input_soft),
    .input_soft_cause(input_soft_cause),
    .may_begin       (may_begin & ~wait_known),
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
    .refusal         (ramp_refusal),
    .incomplete      (ramp_incomplete),
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
    .incomplete  (line_incomplete),
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
        .bad_value     (inputs_bad_value),
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
      assign inputs_bad_value = 1'b0;
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
        .path_runs    (moves_path && rate != 17'd0),
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
        .bad_value       (outputs_bad_value),
        .read_data       (outputs_read_data),
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
      assign outputs_bad_value = 1'b0;
      assign raster_refusal    = 4'd0;
      assign outputs_read_data = 32'd0;
      assign outputs_quiet     = 1'b1;
      assign outputs           = 8'd0;
      assign power_wanted      = 1'b0;
      assign compare           = 1'b0;
    end
  endgenerate

endmodule
`resetall
