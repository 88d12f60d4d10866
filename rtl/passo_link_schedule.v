// SPDX-License-Identifier: MIT
// Link schedule: the clocks in which a word is loaded, turned and acted on.
//
//   count     what happens                                       enters with
//   13 .. 27  the target of a read is looked up                  begin_read
//   28, 29    the halves of the word are read from the buffer    begin_load
//   30, 31    `load`: they come; in 29 `load_ends`
//   31        the word stands on the bus
//   32 .. 63  `rotate`: it turns, bit by bit                       begin_turn
//   47, 48    its upper half has come by
//   65        `act`: what follows from the word
//   67        rest                                               begin_rest
//
// Each begin_* is a strobe a clock before the first clock of its part; begin_rest has priority, then as listed. A replay
// loads word after word and is over before the word behind the last one would be loaded: `over`. `breaks` is a strobe:
// the frame is given up, nothing is acted on.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_schedule (
  input  wire       clk,
  input  wire       rst,
  input  wire       begin_read,
  input  wire       begin_load,
  input  wire       begin_rotate,
  input  wire       begin_rest,
  input  wire       over,
  input  wire       breaks,
  output reg  [6:0] count,
  output wire       rotate,
  output wire       rests,
  output reg        load,
  output reg        load_ends,     // in the last clock but one before the word is there
  output reg        act,
  output wire       half_rotated   // count is before that in which a half has turned
);

  `include "passo_link_schedule.vh"

  assign rotate       = count[5];
  assign rests        = count[6] & count[1] & count[0];
  assign half_rotated = count == COUNT_HALF || count == COUNT_ACT - 7'd1;

  always @(posedge clk) begin
    if (begin_rest) count <= COUNT_REST;
    else if (begin_read) count <= COUNT_READ;
    else if (begin_rotate) count <= COUNT_ROTATE;
    else if (begin_load) count <= COUNT_LOAD;
    else if (!rests) count <= count + 7'd1;

    load      <= (count == COUNT_LOAD && !over) || (count == COUNT_LOAD + 7'd1 && !begin_rest);
    load_ends <= count == COUNT_LOADED - 7'd2;
    act       <= count == COUNT_ACT - 7'd1 && !begin_rest && !breaks;

    if (rst) begin
      count <= COUNT_REST;
      act   <= 1'b0;
    end
  end

endmodule
`resetall
