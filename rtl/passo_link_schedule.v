// SPDX-License-Identifier: MIT
// Link schedule: the clocks in which a word is loaded, rotated and acted on.
//
//   count     what happens                                       enters with
//   13 .. 27  the address of a read settles at its target        begin_read
//   28, 29    the halves of the word are read from the buffer    begin_load
//   29, 30    `load`: they are shifted in; in 30 `load_ends`
//   31        the word is on the bus
//   32 .. 63  `rotate`: one bit per clock                        begin_rotate
//   47, 64    `half_rotated`: its upper, its lower half
//   65        `act`: the word takes effect
//   67        rest                                               begin_rest
//
// Each begin_* is a strobe in the clock before the first of its part; begin_rest has priority. A replay loads word
// after word; `over` keeps it from loading one beyond the last. `breaks` is a strobe: the frame is abandoned, nothing
// is acted on.
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
  output reg        load_ends,     // in the clock before the word is on the bus
  output reg        act,
  output wire       half_rotated   // in the next clock data[15:0] is that half
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
