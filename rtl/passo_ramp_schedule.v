// SPDX-License-Identifier: MIT
// Ramp schedule: the stages in which the next velocity is computed, and the clocks of each.
//
//   stage    clocks        what happens                            next stage
//   CHOOSE   while `waits` nothing                                 NOW ramp pending: COPY; a ramp is loaded: LOOK_UP,
//            then 1                                                LINEAR: SCALE; a ramp waits: FETCH; none: SCALE
//   COPY     24            v_start = current velocity              CHOOSE
//   FETCH    8; T = 0: 7   ticks, control word, u = du / 2         CHOOSE; T = 0: TAKE
//   LOOK_UP  until served  two points of the table                 SHAPE
//   SHAPE    19            s = shape(u)                            SCALE
//   SCALE    50            v_start + (v_end - v_start) s           ADVANCE; after T ticks: TAKE; no ramp: CHOOSE
//   ADVANCE  8             u += du                                 CHOOSE
//   TAKE     5             v_start = v_end, the ramp leaves        CHOOSE
//
// Strobes: `velocity_made` in the last clock of SCALE; `profile_over` in CHOOSE, once the LAST ramp has left and no
// NOW ramp is announced.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp_schedule (
  input wire clk,
  input wire rst,
  input wire prepare,  // a motion begins: COPY
  input wire waits,  // no velocity is needed
  // current ramp
  input wire control_load,
  input wire control_last,  // LAST of its control word
  input wire linear,
  input wire over,  // no more ticks; valid in the last clock but one of FETCH, the last of SCALE
  output reg loaded,  // a ramp is being made
  // ramp queue
  input wire ramp_valid,
  input wire ramp_now_pending,
  input wire ramp_now_coming,
  output reg ramp_take,
  output reg ramp_take_now,
  // tables
  input wire table_served,
  // stages
  output reg [2:0] stage,
  output reg [5:0] count,  // clock of the stage, from 1
  output reg stage_ends,  // it is the last one
  output wire velocity_made,
  output wire profile_over
);

  `include "passo_ramp_stages.vh"

  reg [5:0] before_end;  // count in the last clock but one; valid from the second clock on
  always @(posedge clk)
    case (stage)
      STAGE_COPY:    before_end <= COPY_CLOCKS - 6'd1;
      STAGE_FETCH:   before_end <= FETCH_CLOCKS - 6'd1;
      STAGE_ADVANCE: before_end <= ADVANCE_CLOCKS - 6'd1;
      STAGE_TAKE:    before_end <= TAKE_CLOCKS - 6'd1;
      STAGE_SHAPE:   before_end <= SHAPE_CLOCKS - 6'd1;
      STAGE_SCALE:   before_end <= SCALE_CLOCKS - 6'd1;
      default:       before_end <= 6'd0;
    endcase

  reg  last;
  reg  ticks_known;  // in the last clock but one of FETCH
  wire no_ticks = ticks_known & over;

  wire chooses = stage == STAGE_CHOOSE && !waits;
  wire copies = chooses & ramp_now_pending;
  wire finishes = chooses & ~ramp_now_pending & ~loaded & last;

  assign velocity_made = stage == STAGE_SCALE && stage_ends;
  assign profile_over  = finishes & ~ramp_now_coming;

  always @(posedge clk) begin
    count <= count + 6'd1;
    stage_ends <= count == before_end && !no_ticks;
    ticks_known <= stage == STAGE_FETCH && count == FETCH_CLOCKS - 6'd2;
    ramp_take <= stage == STAGE_TAKE && count == 6'd3;  // early enough for ramp_valid to be up to date in CHOOSE
    ramp_take_now <= copies;

    case (stage)
      STAGE_CHOOSE: begin
        count <= 6'd1;
        if (copies) stage <= STAGE_COPY;
        else if (chooses && loaded) stage <= linear ? STAGE_SCALE : STAGE_LOOK_UP;
        else if (chooses && !last) stage <= ramp_valid ? STAGE_FETCH : STAGE_SCALE;
      end

      STAGE_FETCH:
      if (no_ticks) begin
        stage <= STAGE_TAKE;
        count <= 6'd1;
      end else if (stage_ends) begin
        loaded <= 1'b1;
        stage  <= STAGE_CHOOSE;
      end

      STAGE_LOOK_UP: begin
        count <= 6'd1;
        if (table_served) stage <= STAGE_SHAPE;
      end

      STAGE_SHAPE:
      if (stage_ends) begin
        stage <= STAGE_SCALE;
        count <= 6'd1;
      end

      STAGE_SCALE:
      if (stage_ends) begin
        stage <= !loaded ? STAGE_CHOOSE : over ? STAGE_TAKE : STAGE_ADVANCE;
        count <= 6'd1;
      end

      STAGE_TAKE:
      if (stage_ends) begin
        loaded <= 1'b0;
        stage  <= STAGE_CHOOSE;
      end

      default: if (stage_ends) stage <= STAGE_CHOOSE;
    endcase

    if (control_load) last <= control_last;
    if (copies || prepare) begin
      loaded <= 1'b0;
      last   <= 1'b0;
    end
    if (prepare) begin
      stage <= STAGE_COPY;
      count <= 6'd1;
    end
    if (rst) begin
      stage         <= STAGE_CHOOSE;
      ramp_take     <= 1'b0;
      ramp_take_now <= 1'b0;
      ticks_known   <= 1'b0;
    end
  end

endmodule
`resetall
