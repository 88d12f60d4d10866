// SPDX-License-Identifier: MIT
// Channel: one coordinated group of AXES axes, from the queues to the pins. Wiring only.
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
  parameter [AXES-1:0] STEP_RESET      = 0,
  parameter [AXES-1:0] DIR_RESET       = 0,
  parameter [AXES-1:0] ENABLE_RESET    = 0
) (
  input  wire                     clk,
  input  wire                     rst,
  // bus
  input  wire                     bus_frame,
  input  wire                     bus_commit,
  input  wire                     bus_check,
  input  wire                     bus_write,
  input  wire                     bus_read,
  input  wire                     bus_push,
  input  wire                     select,
  input  wire [              7:0] bus_address,
  input  wire [             31:0] bus_data,
  input  wire [              4:0] bus_top_bit,
  input  wire                     bus_lone_bit,
  output reg                      claim,
  output reg  [              3:0] refusal,
  output reg  [             31:0] read_data,
  output wire                     incomplete,
  output wire                     busy,
  input  wire                     tables_wanted,
  // core
  input  wire                     run,
  input  wire                     wait_sync,
  input  wire                     sync_edge,
  input  wire                     slew_tick,
  input  wire                     snapshot,
  output wire                     stopped,
  output wire                     occupied,
  output wire [LINE_QUEUE_LOG2:0] line_room,
  output wire [RAMP_QUEUE_LOG2:0] ramp_room,
  // tables
  output wire                     table_request,
  output wire [              9:0] table_address,
  input  wire                     table_served,
  input  wire [             15:0] table_point,
  input  wire [             15:0] table_point_next,
  // pins
  output wire [         AXES-1:0] step,
  output wire [         AXES-1:0] dir,
  output wire [         AXES-1:0] enable,
  output wire                     running
);

  `include "passo_registers.vh"

  // registers
  wire            select_line_queue;
  wire            select_ramp_queue;
  wire [AXES-1:0] select_axis;
  wire [AXES-1:0] select_position;
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
  wire            pins_need_quiet;
  wire            ramp_needs_motion;
  wire            hold;

  // motion
  wire [ 2:0] state;
  wire [ 2:0] cause;
  wire        stopping;
  wire [15:0] drained;
  wire        moving;
  wire        counting;
  wire        prepare;
  wire        begin_profile;
  wire        drain;
  wire        release_line;
  wire        drop;

  // when: timescale, ramp, path
  wire [16:0] rate;
  wire        enabled;
  wire        stall;
  wire        tick_ends;
  wire        advance = enabled & counting & ~stall;
  wire        tick = enabled & counting & tick_ends;
  wire        ramp_valid;
  wire        ramp_now_pending;
  wire        ramp_now_coming;
  wire        ramp_take;
  wire        ramp_take_now;
  wire [ 3:0] ramp_half_index;
  wire [15:0] ramp_half;
  wire        ramp_ready;
  wire        ramp_ended;
  wire        ramp_dry;
  wire        ends_next;
  wire [47:0] velocity_next;
  wire [31:0] velocity;
  wire        substep;

  // where: lines, DDAs
  wire                      line_valid;
  wire                      line_last;
  wire                      line_endless;
  wire        [   AXES-1:0] line_directions;
  wire        [       29:0] last_substep;
  wire        [AXES*30-1:0] steps;
  wire                      line_take;
  wire                      slot_add;
  wire                      slot_load;
  wire                      slot_step;
  wire                      slot_load_q;
  wire signed [       30:0] broadcast;
  wire        [   AXES-1:0] directions;
  wire                      current_endless;
  wire                      line_ended;
  wire                      line_underrun;

  // axes
  wire [  AXES-1:0] step_made;
  wire [  AXES-1:0] step_direction;
  wire [  AXES-1:0] reached;
  wire [  AXES-1:0] full;
  wire [  AXES-1:0] axis_quiet;
  reg               at_rest;  // no motion, and no step on its way to the axes
  wire              quiet = at_rest & ~occupied;
  reg               step_overrun;
  wire [  AXES-1:0] was_overrun;
  wire [AXES*4-1:0] lost;
  wire [  AXES-1:0] write_pins;
  wire [  AXES-1:0] write_step_timing;
  wire [  AXES-1:0] write_dir_timing;
  wire [  AXES-1:0] write_enable;
  wire              short_upper;
  wire              short_lower;
  wire [      31:0] position;  // of the axis that is read
  wire              axis_claim;
  wire [       3:0] axis_refusal;
  wire [       3:0] axis_read_data;
  wire              answers_position;

  wire        registers_claim;
  wire [ 3:0] registers_refusal;
  wire [31:0] registers_read_data;
  wire [ 3:0] line_refusal;
  wire [ 3:0] ramp_refusal;
  wire        line_incomplete;
  wire        ramp_incomplete;

  assign incomplete = line_incomplete | ramp_incomplete;

  // Whoever is not meant answers 0.
  always @* begin
    claim     = registers_claim | axis_claim;
    refusal   = registers_refusal | line_refusal | ramp_refusal | axis_refusal;
    read_data = registers_read_data | {28'd0, axis_read_data} | (position & {32{answers_position}});
  end

  passo_channel_registers #(
    .AXES           (AXES),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2)
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
    .bus_top_bit      (bus_top_bit),
    .bus_lone_bit     (bus_lone_bit),
    .claim            (registers_claim),
    .refusal          (registers_refusal),
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
    .overrun          (was_overrun),
    .drained          (drained),
    .rate             (rate),
    .velocity         (velocity),
    .line_room        (line_room),
    .ramp_room        (ramp_room)
  );

  passo_line_queue #(
    .AXES          (AXES),
    .DEPTH_LOG2    (LINE_QUEUE_LOG2),
    .STEPS_REGISTER(STEPS_REGISTER)
  ) u_line_queue (
    .clk         (clk),
    .rst         (rst),
    .bus_frame   (bus_frame),
    .bus_commit  (bus_commit),
    .bus_check   (bus_check),
    .bus_write   (bus_write),
    .select      (select_line_queue),
    .bus_data    (bus_data),
    .bus_top_bit (bus_top_bit),
    .blocked     (stopped),
    .refusal     (line_refusal),
    .incomplete  (line_incomplete),
    .room        (line_room),
    .take        (line_take),
    .release_line(release_line),
    .flush       (stopped),
    .next_valid  (line_valid),
    .last        (line_last),
    .endless     (line_endless),
    .last_substep(last_substep),
    .directions  (line_directions),
    .steps       (steps)
  );

  passo_ramp_queue #(
    .DEPTH_LOG2(RAMP_QUEUE_LOG2)
  ) u_ramp_queue (
    .clk         (clk),
    .rst         (rst),
    .bus_frame   (bus_frame),
    .bus_commit  (bus_commit),
    .bus_check   (bus_check),
    .bus_write   (bus_write),
    .select      (select_ramp_queue),
    .bus_data    (bus_data),
    .bus_top_bit (bus_top_bit),
    .blocked     (stopped),
    .refusal     (ramp_refusal),
    .incomplete  (ramp_incomplete),
    .needs_motion(ramp_needs_motion),
    .room        (ramp_room),
    .take        (ramp_take),
    .take_now    (ramp_take_now),
    .flush       (stopped),
    .valid       (ramp_valid),
    .now_pending (ramp_now_pending),
    .half_index  (ramp_half_index),
    .half        (ramp_half)
  );

  passo_motion u_motion (
    .clk          (clk),
    .rst          (rst),
    .run          (run),
    .wait_sync    (wait_sync),
    .sync_edge    (sync_edge),
    .hold         (hold),
    .command_stop (command_stop),
    .command_abort(command_abort),
    .command_clear(command_clear),
    .state        (state),
    .cause        (cause),
    .stopping     (stopping),
    .drained      (drained),
    .occupied     (occupied),
    .moving       (moving),
    .counting     (counting),
    .rate_is_zero (rate == 17'd0),
    .ramp_valid   (ramp_valid),
    .ramp_ready   (ramp_ready),
    .ramp_ended   (ramp_ended),
    .ramp_dry     (ramp_dry),
    .prepare      (prepare),
    .begin_profile(begin_profile),
    .drain        (drain),
    .line_valid   (line_valid),
    .line_ended   (line_ended),
    .line_endless (current_endless),
    .line_underrun(line_underrun),
    .substep_made (substep),
    .step_overrun (step_overrun),
    .drop         (drop),
    .release_line (release_line),
    .stopped      (stopped),
    .running      (running)
  );

  reg [2:0] occupied_q;  // a line that is loaded in the clock of a stop turns DIR up to 4 clocks later

  always @(posedge clk) begin
    step_overrun <= ~rst & slot_step & ((reached & full) != {AXES{1'b0}});
    occupied_q   <= {occupied_q[1:0], occupied};
    at_rest      <= ~rst & ~occupied & (occupied_q == 3'b000) & (axis_quiet == {AXES{1'b1}});
  end

  passo_admission u_admission (
    .clk          (clk),
    .rst          (rst),
    .bus_frame    (bus_frame),
    .bus_commit   (bus_commit),
    .needs_idle   (command_needs_idle),
    .needs_quiet  (command_needs_quiet | pins_need_quiet),
    .needs_motion (ramp_needs_motion),
    .tables_wanted(tables_wanted),
    .occupied     (occupied),
    .quiet        (quiet),
    .takes_now    (~ends_next),
    .busy         (busy),
    .hold         (hold),
    .now_coming   (ramp_now_coming)
  );

  passo_timescale u_timescale (
    .clk        (clk),
    .rst        (rst),
    .slew_tick  (slew_tick),
    .moving     (moving),
    .stopping   (stopping),
    .rate_target(rate_target),
    .rate_slew  (rate_slew),
    .stop_slew  (stop_slew),
    .rate       (rate),
    .enable     (enabled)
  );

  passo_ramp #(
    .TICK_LOG2(TICK_LOG2)
  ) u_ramp (
    .clk             (clk),
    .rst             (rst),
    .prepare         (prepare),
    .begin_profile   (begin_profile),
    .stop            (stopped),
    .drain           (drain),
    .ready           (ramp_ready),
    .ended           (ramp_ended),
    .dry             (ramp_dry),
    .advance         (advance),
    .tick            (tick),
    .stall           (stall),
    .tick_ends       (tick_ends),
    .ends_next       (ends_next),
    .velocity_next   (velocity_next),
    .ramp_valid      (ramp_valid),
    .ramp_now_pending(ramp_now_pending),
    .ramp_now_coming (ramp_now_coming),
    .ramp_take       (ramp_take),
    .ramp_take_now   (ramp_take_now),
    .ramp_half_index (ramp_half_index),
    .ramp_half       (ramp_half),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served),
    .table_point     (table_point),
    .table_point_next(table_point_next)
  );

  passo_path u_path (
    .clk           (clk),
    .rst           (rst),
    .restart       (prepare),
    .stop          (stopped),
    .begin_profile (begin_profile),
    .advance       (advance),
    .tick          (tick),
    .rest          (ends_next),
    .velocity_next (velocity_next),
    .drain         (drain),
    .drain_velocity(drain_velocity),
    .velocity      (velocity),
    .substep       (substep)
  );

  passo_line #(
    .AXES(AXES)
  ) u_line (
    .clk               (clk),
    .rst               (rst),
    .start             (prepare),
    .stop              (stopped),
    .substep           (substep),
    .next_valid        (line_valid),
    .take              (line_take),
    .last              (line_last),
    .endless           (line_endless),
    .last_substep      (last_substep),
    .current_directions(line_directions),
    .slot_add          (slot_add),
    .slot_load         (slot_load),
    .slot_step         (slot_step),
    .slot_load_q       (slot_load_q),
    .broadcast         (broadcast),
    .directions        (directions),
    .current_endless   (current_endless),
    .ended             (line_ended),
    .underrun          (line_underrun)
  );

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      wire        step_request;
      wire [15:0] step_high;
      wire [15:0] step_low;
      wire [15:0] dir_setup;
      wire [15:0] dir_hold;
      wire        short_high;
      wire        short_low;
      wire        short_setup;
      wire        short_hold;
      wire        both_edges;
      wire        step_inverted;
      wire        direction_inverted;
      wire        enable_wanted;
      wire        enable_inverted;

      passo_dda u_dda (
        .clk         (clk),
        .slot_add    (slot_add),
        .slot_load   (slot_load),
        .slot_step   (slot_step),
        .slot_load_q (slot_load_q),
        .broadcast   (broadcast),
        .steps       (steps[axis*30+:30]),
        .reached     (reached[axis]),
        .step_request(step_request)
      );

      passo_axis #(
        .STEP_RESET  (STEP_RESET[axis]),
        .DIR_RESET   (DIR_RESET[axis]),
        .ENABLE_RESET(ENABLE_RESET[axis])
      ) u_axis (
        .clk               (clk),
        .rst               (rst),
        .step_request      (step_request),
        .direction         (directions[axis]),
        .drop              (drop),
        .step_made         (step_made[axis]),
        .step_direction    (step_direction[axis]),
        .full              (full[axis]),
        .quiet             (axis_quiet[axis]),
        .clear             (command_clear),
        .lost              (lost[axis*4+:4]),
        .step_high         (step_high),
        .step_low          (step_low),
        .dir_setup         (dir_setup),
        .dir_hold          (dir_hold),
        .short_high        (short_high),
        .short_low         (short_low),
        .short_setup       (short_setup),
        .short_hold        (short_hold),
        .timing_written    (write_step_timing[axis] | write_dir_timing[axis]),
        .pins_written      (write_pins[axis]),
        .both_edges_next   (bus_data[AXIS_PINS_BOTH_EDGES_LSB]),
        .both_edges        (both_edges),
        .step_inverted     (step_inverted),
        .direction_inverted(direction_inverted),
        .enable            (enable_wanted),
        .enable_inverted   (enable_inverted),
        .step_pin          (step[axis]),
        .dir_pin           (dir[axis]),
        .enable_pin        (enable[axis])
      );

      passo_axis_settings #(
        .STEP_RESET  (STEP_RESET[axis]),
        .DIR_RESET   (DIR_RESET[axis]),
        .ENABLE_RESET(ENABLE_RESET[axis])
      ) u_settings (
        .clk               (clk),
        .rst               (rst),
        .write_pins        (write_pins[axis]),
        .write_step_timing (write_step_timing[axis]),
        .write_dir_timing  (write_dir_timing[axis]),
        .write_enable      (write_enable[axis]),
        .bus_data          (bus_data),
        .short_upper       (short_upper),
        .short_lower       (short_lower),
        .short_high        (short_high),
        .short_low         (short_low),
        .short_setup       (short_setup),
        .short_hold        (short_hold),
        .step_high         (step_high),
        .step_low          (step_low),
        .dir_setup         (dir_setup),
        .dir_hold          (dir_hold),
        .both_edges        (both_edges),
        .step_inverted     (step_inverted),
        .direction_inverted(direction_inverted),
        .enable            (enable_wanted),
        .enable_inverted   (enable_inverted)
      );

      assign was_overrun[axis] = lost[axis*4+:4] != 4'd0;
    end
  endgenerate

  passo_axis_registers #(
    .AXES(AXES)
  ) u_axis_registers (
    .clk              (clk),
    .rst              (rst),
    .bus_check        (bus_check),
    .bus_write        (bus_write),
    .bus_read         (bus_read),
    .bus_push         (bus_push),
    .select_axis      (select_axis),
    .select_position  (select_position),
    .bus_address      (bus_address[2:0]),
    .bus_data         (bus_data),
    .bus_top_bit      (bus_top_bit),
    .claim            (axis_claim),
    .refusal          (axis_refusal),
    .read_data        (axis_read_data),
    .answers_position (answers_position),
    .write_pins       (write_pins),
    .write_step_timing(write_step_timing),
    .write_dir_timing (write_dir_timing),
    .write_enable     (write_enable),
    .needs_quiet      (pins_need_quiet),
    .short_upper      (short_upper),
    .short_lower      (short_lower),
    .lost             (lost)
  );

  passo_positions #(
    .AXES(AXES)
  ) u_positions (
    .clk           (clk),
    .rst           (rst),
    .step_made     (step_made),
    .step_direction(step_direction),
    .zero          (command_zero),
    .snapshot      (snapshot),
    .address       (bus_address[2:0]),
    .position      (position)
  );

endmodule
`resetall
