// SPDX-License-Identifier: MIT
// Ramp: velocity over time. A tick is 2^TICK_LOG2 enabled clocks; during one tick the velocity of the next is
// computed.
//
//   s        = shape(u);  velocity = v_start + floor((v_end - v_start) * s);  u += du      first u = du / 2
//   mirror:    u runs from 1 to 0, v_start and v_end are swapped
//   after T ticks the next ramp begins, from exactly v_end; T = 0 sets the velocity immediately
//
//   velocity   |        ____________
//              |      /              \            v_start, v_end: of the current ramp
//              |    /                  \          velocity_next: of the tick after this one
//              |__/_____________________ \__
//                 ramp   ramp (T ticks)  ramp
//
// `prepare` computes the first velocity of a motion, from 0, and raises `ready`; `begin_profile` starts the first
// tick. On begin_profile and on `tick` velocity_next takes effect; with `ended`, 0.
// Promise: the end of the LAST ramp raises `ended` in the last enabled clock of its last tick (a profile without
// ticks: with begin_profile). If the ramps run out at speed, `dry` reports the underrun one tick earlier; the velocity
// then stays constant, and the next ramp is taken when it arrives. A NOW ramp that is `coming` prevents the profile
// from ending until it is queued. `stall` holds back the enable at the end of a tick until the next velocity is ready:
// delayed, never lost.
//
// Blocks: passo_ramp_schedule sequences the stages, passo_ramp_strobes their clocks; passo_ramp_numbers and
// passo_interpolate hold and shift the numbers; passo_ramp_tick outputs the velocities.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp #(
  parameter TICK_LOG2 = 7
) (
  input  wire        clk,
  input  wire        rst,
  // motion
  input  wire        prepare,
  input  wire        begin_profile,
  input  wire        stop,              // drop everything
  input  wire        drain,             // drain_velocity is used, not the ramps
  output wire        ready,             // velocity_next is valid one clock later
  output wire        ended,
  output reg         dry,
  // timescale and path
  input  wire        advance,           // enabled clock: not while `stall`
  input  wire        tick,              // it ends a tick: while `tick_ends`
  output wire        stall,
  output wire        tick_ends,
  output wire        ends_next,         // no next tick: rest
  output wire [47:0] velocity_next,     // UQ0.48 substeps per clock
  // ramp queue
  input  wire        ramp_valid,
  input  wire        ramp_now_pending,
  input  wire        ramp_now_coming,   // one is in flight
  output wire        ramp_take,
  output wire        ramp_take_now,
  output wire [ 3:0] ramp_half_index,
  input  wire [15:0] ramp_half,
  // tables
  output wire        table_request,
  output wire [ 9:0] table_address,
  input  wire        table_served,
  input  wire [15:0] table_point,
  input  wire [15:0] table_point_next
);

  `include "passo_registers.vh"
  `include "passo_ramp_stages.vh"

  wire forget = rst | stop;

  // schedule
  wire [2:0] stage;
  wire [5:0] count;
  wire       stage_ends;
  wire       loaded;  // a ramp is being made
  wire       velocity_made;
  wire       profile_over;

  // strobes
  wire control_load;
  wire start_move;
  wire start_load;
  wire start_copy;
  wire u_move;
  wire u_load;
  wire u_last;
  wire ticks_load_low;
  wire ticks_load_high;
  wire ticks_add_low;
  wire ticks_add_high;
  wire moving;
  wire shaping;
  wire load_fraction;
  wire clear;
  wire result_move;

  // numbers
  wire        over;
  wire        start_bit;
  wire        end_bit;
  wire [32:0] progress;
  wire        velocity_bit;  // 48 of them, LSB first

  // the current ramp
  reg        mirror;
  reg  [1:0] shape;
  wire       linear = shape == SHAPE_LINEAR;

  always @(posedge clk)
    if (control_load) begin
      shape  <= ramp_half[RAMP_CONTROL_SHAPE_LSB+:RAMP_CONTROL_SHAPE_BITS];
      mirror <= ramp_half[RAMP_CONTROL_MIRROR_LSB];
    end

  passo_ramp_schedule u_schedule (
    .clk             (clk),
    .rst             (forget),
    .prepare         (prepare),
    .waits           (ready | ends_next),
    .control_load    (control_load),
    .control_last    (ramp_half[RAMP_CONTROL_LAST_LSB]),
    .linear          (linear),
    .over            (over),
    .loaded          (loaded),
    .ramp_valid      (ramp_valid),
    .ramp_now_pending(ramp_now_pending),
    .ramp_now_coming (ramp_now_coming),
    .ramp_take       (ramp_take),
    .ramp_take_now   (ramp_take_now),
    .table_served    (table_served),
    .stage           (stage),
    .count           (count),
    .stage_ends      (stage_ends),
    .velocity_made   (velocity_made),
    .profile_over    (profile_over)
  );

  passo_ramp_tick #(
    .TICK_LOG2(TICK_LOG2)
  ) u_tick (
    .clk          (clk),
    .rst          (forget),
    .prepare      (prepare),
    .begin_profile(begin_profile),
    .drain        (drain),
    .advance      (advance),
    .tick         (tick),
    .velocity_made(velocity_made),
    .profile_over (profile_over),
    .ready        (ready),
    .ends_next    (ends_next),
    .ended        (ended),
    .tick_ends    (tick_ends),
    .stall        (stall)
  );

  passo_ramp_strobes u_strobes (
    .clk            (clk),
    .prepare        (prepare),
    .stage          (stage),
    .count          (count),
    .table_served   (table_served),
    .stage_ends     (stage_ends),
    .loaded         (loaded),
    .over           (over),
    .half_index     (ramp_half_index),
    .control_load   (control_load),
    .start_move     (start_move),
    .start_load     (start_load),
    .start_copy     (start_copy),
    .u_move         (u_move),
    .u_load         (u_load),
    .u_last         (u_last),
    .ticks_load_low (ticks_load_low),
    .ticks_load_high(ticks_load_high),
    .ticks_add_low  (ticks_add_low),
    .ticks_add_high (ticks_add_high),
    .moving         (moving),
    .shaping        (shaping),
    .load_fraction  (load_fraction),
    .clear          (clear),
    .result_move    (result_move)
  );

  passo_ramp_numbers u_numbers (
    .clk            (clk),
    .half           (ramp_half),
    .start_move     (start_move),
    .start_load     (start_load),
    .start_copy     (start_copy),
    .copy_high      (velocity_next[24]),
    .copy_low       (velocity_next[0]),
    .start_bit      (start_bit),
    .end_index      (count[3:0]),
    .end_bit        (end_bit),
    .mirror         (mirror),
    .u_move         (u_move),
    .u_load         (u_load),
    .u_last         (u_last),
    .progress       (progress),
    .ticks_load_low (ticks_load_low),
    .ticks_load_high(ticks_load_high),
    .ticks_add_low  (ticks_add_low),
    .ticks_add_high (ticks_add_high),
    .over           (over)
  );

  reg point_is_last;  // the progress is stable while its points are looked up

  always @(posedge clk) point_is_last <= progress[32:25] == 8'hFF;

  passo_interpolate u_interpolate (
    .clk          (clk),
    .clear        (clear),
    .result_move  (result_move),
    .moving       (moving),
    .shaping      (shaping),
    .load_fraction(load_fraction),
    .linear       (linear),
    .progress     (progress),
    .load_points  (table_request && table_served),
    .point        (table_point),
    .point_next   (table_point_next),
    .point_is_last(point_is_last),
    .a_bit        (loaded && mirror ? end_bit : start_bit),
    .b_bit        (loaded && !mirror ? end_bit : start_bit),
    .a            (velocity_bit),
    .result       (velocity_next)
  );

  assign table_request = stage == STAGE_LOOK_UP;
  assign table_address = {shape - 2'd1, progress[32:25]};

  reg not_zero;  // a bit of the velocity so far is 1

  always @(posedge clk) begin
    not_zero <= stage == STAGE_SCALE && (not_zero || velocity_bit);
    dry      <= velocity_made && !loaded && (not_zero || velocity_bit);
  end

`ifdef FORMAL
  `include "passo_ramp_formal.vh"
`endif

endmodule
`resetall
