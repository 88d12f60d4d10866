// SPDX-License-Identifier: MIT
// Ramp: velocity over time. A tick is 2^TICK_LOG2 enabled clocks; while one tick runs, the velocity of the
// next is made.
//
//   s        = shape(u);  velocity = v_start + floor((v_end - v_start) * s);  u += du      first u = du / 2
//   mirror:    u runs from 1 to 0, and v_start and v_end change places
//   after T ticks the next ramp begins, from exactly v_end; T = 0 sets the velocity at once
//
//   velocity   |        ____________
//              |      /              \            v_start, v_end: of the ramp being made
//              |    /                  \          velocity_next: of the tick after this one
//              |__/_____________________ \__
//                 ramp   ramp (T ticks)  ramp
//
// `prepare` makes the first velocity of a motion, from 0, and raises `ready`; `begin_profile` starts the
// first tick. With that, and with `tick`, velocity_next begins to count; with `ended` 0.
// Promise: the LAST ramp's end raises `ended`, with the last enabled clock of its last tick (a profile
// without any tick: with begin_profile). Ramps that run out at speed raise `dry`, in the tick before; the
// velocity then stays, and the next ramp is taken whenever it comes. A NOW ramp that is `coming` keeps the profile from
// ending until it is there. `stall` holds the enable back at the end
// of a tick until a clock after the next velocity is ready: later, never lost. Clocks of each step: copy 24,
// fetch 8 (T = 0: 7), take 5, look up 4 .. 2 * CHANNELS + 4, shape 19, scale 50, step 8, and one to choose
// between them.
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
  input  wire        stop,              // forget everything
  input  wire        drain,             // drain_velocity counts, not the ramps
  output reg         ready,             // velocity_next will be, a clock later
  output wire        ended,
  output reg         dry,
  // timescale and path
  input  wire        advance,           // an enabled clock that counts: not while `stall`
  input  wire        tick,              // it ends a tick: while `tick_ends`
  output reg         stall,
  output reg         tick_ends,
  output reg         ends_next,         // there is no next tick: rest
  output wire [47:0] velocity_next,     // UQ0.48 substeps per clock
  // ramp queue
  input  wire        ramp_valid,
  input  wire        ramp_now_pending,
  input  wire        ramp_now_coming,   // one will be pending
  output reg         ramp_take,
  output reg         ramp_take_now,
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
  `include "passo_ramp_steps.vh"

  localparam [TICK_LOG2-1:0] TICK_LAST = {TICK_LOG2{1'b1}};

  reg [2:0] step;
  reg [5:0] count;  // clocks of the step, from 1
  reg       step_ends;  // it is the last of them

  reg [5:0] before_end;  // count in the last clock but one; known from the second clock on
  always @(posedge clk)
    case (step)
      STEP_COPY:             before_end <= 6'd23;
      STEP_FETCH, STEP_STEP: before_end <= 6'd7;
      STEP_TAKE:             before_end <= 6'd4;
      STEP_SHAPE:            before_end <= 6'd18;
      STEP_SCALE:            before_end <= 6'd49;
      default:               before_end <= 6'd0;
    endcase

  wire over;
  reg  ticks_known;  // in the last clock of fetch but one
  wire no_ticks = ticks_known & over;

  // the ramp being made
  reg       loaded;
  reg       last;
  reg       mirror;
  reg [1:0] shape;
  reg       moves;  // the velocity is not 0

  // the tick that runs
  reg [TICK_LOG2-1:0] tick_count;
  reg                 tick_last;  // the next clock is the last

  wire take_velocity = begin_profile | tick;
  wire tick_last_next = !begin_profile && (advance ? tick_count == TICK_LAST - 1'b1 : tick_last);
  assign ended = take_velocity & ends_next;

  wire        control_load;
  wire        start_move;
  wire        start_load;
  wire        start_copy;
  wire        start_bit;
  wire        end_bit;
  wire        u_move;
  wire        u_load;
  wire        u_last;
  wire [32:0] progress;
  wire        ticks_load_low;
  wire        ticks_load_high;
  wire        ticks_add_low;
  wire        ticks_add_high;
  wire        moving;
  wire        shaping;
  wire        load_fraction;
  wire        clear;
  wire        result_move;
  wire        interpolated_bit;

  passo_ramp_strobes u_strobes (
    .clk            (clk),
    .prepare        (prepare),
    .step           (step),
    .count          (count),
    .table_served   (table_served),
    .step_ends      (step_ends),
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

  reg point_is_last;  // the progress stands still while its points are looked up

  always @(posedge clk) point_is_last <= progress[32:25] == 8'hFF;

  passo_interpolate u_interpolate (
    .clk          (clk),
    .clear        (clear),
    .result_move  (result_move),
    .moving       (moving),
    .shaping      (shaping),
    .load_fraction(load_fraction),
    .linear       (shape == SHAPE_LINEAR),
    .progress     (progress),
    .load_points  (step == STEP_LOOK_UP && table_served),
    .point        (table_point),
    .point_next   (table_point_next),
    .point_is_last(point_is_last),
    .a_bit        (loaded && mirror ? end_bit : start_bit),
    .b_bit        (loaded && !mirror ? end_bit : start_bit),
    .a            (interpolated_bit),
    .result       (velocity_next)
  );

  assign table_request = step == STEP_LOOK_UP;
  assign table_address = {shape - 2'd1, progress[32:25]};

  always @(posedge clk) begin
    ramp_take     <= step == STEP_TAKE && count == 6'd3;  // before the step ends, so that ramp_valid is true
    ramp_take_now <= 1'b0;
    dry           <= 1'b0;
    moves         <= step == STEP_SCALE && (moves || interpolated_bit);
    count         <= count + 6'd1;
    ticks_known   <= step == STEP_FETCH && count == 6'd6;
    step_ends     <= count == before_end && !no_ticks;

    case (step)
      STEP_CHOOSE: begin
        count <= 6'd1;
        if (!ready && !ends_next) begin
          if (ramp_now_pending) begin
            ramp_take_now <= 1'b1;
            loaded        <= 1'b0;
            last          <= 1'b0;
            step          <= STEP_COPY;
          end else if (loaded) step <= shape == SHAPE_LINEAR ? STEP_SCALE : STEP_LOOK_UP;
          else if (last) begin
            ends_next <= !ramp_now_coming;
            ready     <= !ramp_now_coming;
          end else step <= ramp_valid ? STEP_FETCH : STEP_SCALE;
        end
      end

      STEP_COPY: if (step_ends) step <= STEP_CHOOSE;

      STEP_FETCH:
      if (no_ticks) begin
        step  <= STEP_TAKE;
        count <= 6'd1;
      end else if (step_ends) begin
        loaded <= 1'b1;
        step   <= STEP_CHOOSE;
      end

      STEP_TAKE:
      if (step_ends) begin
        loaded <= 1'b0;
        step   <= STEP_CHOOSE;
      end

      STEP_LOOK_UP: begin
        count <= 6'd1;
        if (table_served) step <= STEP_SHAPE;
      end

      STEP_SHAPE:
      if (step_ends) begin
        step  <= STEP_SCALE;
        count <= 6'd1;
      end

      STEP_SCALE:
      if (step_ends) begin
        ready <= 1'b1;
        dry   <= !loaded && (moves || interpolated_bit);
        step  <= !loaded ? STEP_CHOOSE : over ? STEP_TAKE : STEP_STEP;
        count <= 6'd1;
      end

      default: if (step_ends) step <= STEP_CHOOSE;
    endcase

    if (control_load) begin
      shape  <= ramp_half[RAMP_CONTROL_SHAPE_LSB+:RAMP_CONTROL_SHAPE_BITS];
      mirror <= ramp_half[RAMP_CONTROL_MIRROR_LSB];
      last   <= ramp_half[RAMP_CONTROL_LAST_LSB];
    end

    if (advance) tick_count <= tick_count + 1'b1;
    if (begin_profile) tick_count <= {TICK_LOG2{1'b0}};
    tick_last <= tick_last_next;
    tick_ends <= tick_last_next && (ready || drain);
    stall     <= tick_last_next && !(ready || drain);
    if (take_velocity) ready <= 1'b0;

    if (prepare) begin
      step      <= STEP_COPY;
      count     <= 6'd1;
      ready     <= 1'b0;
      ends_next <= 1'b0;
      loaded    <= 1'b0;
      last      <= 1'b0;
    end
    if (rst || stop) begin
      step          <= STEP_CHOOSE;
      ready         <= 1'b0;
      ends_next     <= 1'b1;
      ramp_take     <= 1'b0;
      ramp_take_now <= 1'b0;
      tick_last     <= 1'b0;
      tick_ends     <= 1'b0;
      stall         <= 1'b0;
      ticks_known   <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_ramp_formal.vh"
`endif

endmodule
`resetall
