// SPDX-License-Identifier: MIT
// Ramp strobes: which register shifts in which clock of which stage.
//
// Strobes and half-word index are registered: they act one clock after their count. A half-word comes from the queue
// three clocks after its index, so the strobe that uses it is three counts after the index. The last clock of each
// stage sets the index for the first clock of the next.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp_strobes (
  input  wire       clk,
  input  wire       prepare,
  input  wire [2:0] stage,
  input  wire [5:0] count,            // clock of the stage, from 1
  input  wire       table_served,
  input  wire       stage_ends,       // it is the last one
  input  wire       loaded,           // a ramp is being made
  input  wire       over,             // no more ticks; valid in the last clock of FETCH and SCALE
  // ramp queue
  output reg  [3:0] half_index,
  // numbers
  output reg        control_load,
  output reg        start_move,
  output reg        start_load,
  output reg        start_copy,
  output reg        u_move,
  output reg        u_load,
  output reg        u_last,
  output reg        ticks_load_low,
  output reg        ticks_load_high,
  output reg        ticks_add_low,
  output reg        ticks_add_high,
  // interpolation
  output reg        moving,
  output reg        shaping,
  output reg        load_fraction,
  output reg        clear,
  output reg        result_move       // shifts or is cleared
);

  `include "passo_ramp_stages.vh"

  wire fetch = stage == STAGE_FETCH;
  wire take = stage == STAGE_TAKE && count >= 6'd2 && count <= 6'd4;
  wire copy = stage == STAGE_COPY;
  wire shape = stage == STAGE_SHAPE;
  wire scale = stage == STAGE_SCALE;
  wire scale_begins = scale && count == 6'd1;
  wire empty = prepare || (stage == STAGE_LOOK_UP && !table_served) || scale_begins;

  always @(posedge clk) begin
    control_load    <= fetch && count == 6'd5;
    start_load      <= take;
    start_copy      <= copy;
    start_move      <= take || copy || (scale && count <= 6'd48);
    u_load          <= fetch;
    u_move          <= (fetch && count >= 6'd6) || (stage == STAGE_ADVANCE && count >= 6'd3);
    u_last          <= count == 6'd5 || count == 6'd8;
    ticks_load_low  <= fetch && count == 6'd3;
    ticks_load_high <= fetch && count == 6'd4;
    ticks_add_low   <= (fetch && count == 6'd4) || scale_begins;
    ticks_add_high  <= (fetch && count == 6'd5) || (scale && count == 6'd2);
    moving          <= shape || scale;
    shaping         <= shape;
    load_fraction   <= scale_begins;
    clear           <= empty;
    result_move     <= empty || copy || shape || scale;
  end

  // The first half-word of v_end is ready when SCALE begins, after any stage; the next ones follow every 16 bits.
  reg half_ends;

  always @(posedge clk) begin
    half_ends <= count[3:0] == 4'd12;
    case (stage)
      STAGE_CHOOSE: half_index <= loaded ? 4'd3 : 4'd5;  // of v_end, or T of the next ramp
      STAGE_FETCH:
      case (count[2:0])
        3'd1:    half_index <= 4'd4;  // T
        3'd2:    half_index <= 4'd1;  // control
        3'd3:    half_index <= 4'd9;  // du
        3'd4:    half_index <= 4'd8;
        3'd5:    half_index <= 4'd7;
        3'd6:    half_index <= 4'd3;  // v_end
        default: half_index <= over ? 4'd2 : 4'd3;
      endcase
      STAGE_TAKE: half_index <= 4'd0;
      STAGE_SCALE:
      if (stage_ends) half_index <= over ? 4'd2 : 4'd9;
      else if (half_ends) half_index <= half_index == 4'd3 ? 4'd2 : half_index == 4'd2 ? 4'd0 : 4'd3;
      STAGE_ADVANCE:
      case (count[2:0])
        3'd1, 3'd4: half_index <= 4'd8;
        3'd2, 3'd5: half_index <= 4'd7;
        3'd3:       half_index <= 4'd9;
        default:    half_index <= 4'd3;
      endcase
      default: half_index <= 4'd3;
    endcase
  end

endmodule
`resetall
