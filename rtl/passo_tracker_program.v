// SPDX-License-Identifier: MIT
// Program of the tracker: which words are added in a slot, and where their sum goes.
//
// Of a slot are the line, two slots each, and the word: 1 is the upper one of a pair. The words of an axis are
// addressed by pairs, and the sum is that of one line before.
//
//   0  w = v + a        4  d                       8  z - w                  12  t + w, t - v or t
//   1  copies target    5                          9                         13
//   2  speed - v        6  z = d - t              10  copies speed or a      14  position + new v or d, * sign
//   3  speed - w        7                         11  new v: w, v, or v - a  15
//
// A slot reads its words; one clock later they are what is added, two clocks later, so one line, the sum is written:
// it can be read three slots later. In line 10 the second word is that of a position for the host.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_tracker_program (
  input  wire [3:0] line,
  input  wire       word,
  input  wire       odd,               // tick
  input  wire       negative,          // sign
  input  wire       speeds,            // the new v is w
  input  wire       keeps,             // the new v is v
  input  wire       lands,             // the new position is the target
  input  wire       cleared,           // v and t become 0
  input  wire       cleared_position,
  output reg  [3:0] first,
  output reg  [3:0] second,
  output reg        subtracts,         // the second word
  output reg        is_first,          // the lowest word
  output reg        no_first,          // take 0
  output reg        no_second,
  output wire       half,              // instead of 0, 2^-1 step
  output reg  [3:0] result
);

  // Numbers of an axis, by pairs of words. Of 64 bits are d, z, t and the position; the lower pair of the target is
  // that of 1/2.
  localparam [2:0] LIMIT = 3'd2;  // at 2 the speed, at 10 the acceleration
  localparam [2:0] VELOCITY = 3'd3;  // at 3 of even ticks, at 11 of odd ones; before the new one its place has w
  localparam [3:0] DISTANCE = 4'd4;  // d
  localparam [3:0] NOWHERE = 4'd6;
  localparam [3:0] TARGET = 4'd7;
  localparam [3:0] LEFT = 4'd8;  // z
  localparam [3:0] STOPPING = 4'd12;  // t
  localparam [3:0] POSITION = 4'd14;

  wire [3:0] from = {
    ~negative, POSITION[2:1], line[0]
  };  // d: TARGET differs from the upper pair in this bit alone

  assign half = word & ~line[0] & line[2] & (line[3] == line[1]);  // in 4 of a target, in 14 of a position

  always @* begin
    first     = line;
    second    = {odd, VELOCITY};
    subtracts = 1'b1;
    is_first  = ~word & ~line[0];
    no_first  = 1'b0;
    no_second = 1'b0;
    case (line)
      4'd0: begin
        first     = {odd, VELOCITY};
        second    = {1'b1, LIMIT};
        subtracts = 1'b0;
      end
      4'd1: begin
        first     = TARGET;
        is_first  = ~word;
        no_second = 1'b1;
      end
      4'd2: first = {1'b0, LIMIT};
      4'd3: begin
        first    = {1'b0, LIMIT};
        second   = {~odd, VELOCITY};
        is_first = ~word;
      end
      4'd4, 4'd5: begin
        first     = {~from[3], from[2:0]};
        second    = from;
        no_first  = ~line[0] & ~negative;
        no_second = ~line[0] & negative;
      end
      4'd6, 4'd7: begin
        first  = {DISTANCE[3:1], line[0]};
        second = {STOPPING[3:1], line[0]};
      end
      4'd8, 4'd9: begin
        second    = {~odd, VELOCITY};
        no_second = line[0];
      end
      4'd10: begin
        first     = {odd, LIMIT};
        second    = {POSITION[3:1], 1'b1};
        no_second = 1'b1;
      end
      4'd11: begin
        first     = {odd ^ speeds, VELOCITY};
        second    = {1'b1, LIMIT};
        is_first  = ~word;
        no_first  = cleared;
        no_second = speeds | keeps;
      end
      4'd12, 4'd13: begin
        second    = {odd ^ speeds, VELOCITY};
        subtracts = ~speeds;
        no_first  = cleared;
        no_second = line[0] | keeps;
      end
      default: begin
        second    = lands ? {DISTANCE[3:1], line[0]} : {~odd, VELOCITY};
        subtracts = negative;
        no_first  = cleared_position;
        no_second = line[0] & ~lands;
      end
    endcase
  end

  always @* begin
    case (line)
      4'd1:    result = {~odd, VELOCITY};
      4'd2:    result = TARGET;
      4'd5:    result = DISTANCE;
      4'd6:    result = DISTANCE + 4'd1;
      4'd7:    result = LEFT;
      4'd8:    result = LEFT + 4'd1;
      4'd11:   result = {odd, LIMIT};
      4'd12:   result = speeds ? NOWHERE : {~odd, VELOCITY};
      4'd13:   result = STOPPING;
      4'd14:   result = STOPPING + 4'd1;
      4'd15:   result = POSITION;
      4'd0:    result = POSITION + 4'd1;
      default: result = NOWHERE;
    endcase
  end

endmodule
`resetall
