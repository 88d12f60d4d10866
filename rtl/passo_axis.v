// SPDX-License-Identifier: MIT
// Axis: STEP and DIR pins of one axis, with all four pin timings.
//
//   DIR  ____/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\____
//   STEP _________/~~~~\______/~~~~\_______________________
//            |setup|high|  low |    |  low  |  hold  |
//
// Promise: STEP is active for exactly step_high and inactive for at least step_low clocks; DIR never changes
// from dir_setup clocks before an active edge to dir_hold clocks after the low time of the pulse. With high =
// low = 1 it makes a step every two clocks. A step that must wait keeps its direction in a queue of 4; one
// that finds the queue full is not made but raises `overrun` for a clock and counts in `lost`, which stops at
// 15. While nothing waits, DIR follows `direction`, that of the line whose steps are being made.
// With both_edges every edge of STEP is a step, and each level lasts at least step_high or step_low. `drop`
// empties the queue; a pulse that has begun is finished. A timing of 0 counts as 1. `timing_written` starts
// the time that runs anew, as the timings change with it.
// Latency: step_request to STEP 3 clocks, `direction` to DIR 3 clocks. `step_made`, with `step_direction`, is
// high in the clock before the active edge leaves the pin.
`resetall
`default_nettype none

module passo_axis (
  input  wire        clk,
  input  wire        rst,
  input  wire        step_request,
  input  wire        direction,           // of the step and of the steps to come: 1 = negative
  input  wire        drop,
  output reg         step_made,
  output wire        step_direction,
  output reg         overrun,
  input  wire        clear,               // of `lost`
  output reg  [ 3:0] lost,
  // settings
  input  wire [15:0] step_high,
  input  wire [15:0] step_low,
  input  wire [15:0] dir_setup,
  input  wire [15:0] dir_hold,
  input  wire        short_high,          // 1: the time is 0 or 1
  input  wire        short_low,
  input  wire        short_setup,
  input  wire        short_hold,
  input  wire        timing_written,
  input  wire        both_edges,
  input  wire        step_inverted,
  input  wire        direction_inverted,
  input  wire        enable,
  input  wire        enable_inverted,
  // pins
  output reg         step_pin,
  output reg         dir_pin,
  output reg         enable_pin
);

  // States. With both_edges there is no high, a step leads to low at once.
  reg high;  // STEP is active for step_high; then it falls
  reg low;  // STEP keeps its level for step_low or, with both_edges, for the time of that level
  reg setup;
  reg idle;  // a step or, unless in hold, a turn may begin
  reg hold;  // a step in the same direction may interrupt it
  reg step;
  reg dir;

  // The timer tells the number of the next clock of the state. `done` is high in the last clock: of a short
  // time that is the first one.
  reg  [15:0] timer;
  reg         done;
  reg         timing_changed;  // times were written in the clock before
  // Kept, so that a bit of the choice and of the comparison goes into one LUT.
  (* keep *)
  wire [15:0] level_equal;
  (* keep *)
  wire [15:0] dir_equal;
  assign level_equal = timer ^ ~(step ? step_high : step_low);
  assign dir_equal   = timer ^ ~(setup ? dir_setup : dir_hold);
  wire level_short = step ? short_high : short_low;
  wire dir_short = setup ? short_setup : short_hold;
  wire at_level = high | low;
  wire reached = at_level ? &level_equal : &dir_equal;

  // Steps that wait, as directions, the oldest in bit 0. Free places hold the latest direction.
  reg  [3:0] waiting;
  reg  [3:0] waits;  // which places are taken
  wire       dir_right = waiting[0] == dir;
  wire       accepted = step_request & ~waits[3];

  wire falls = high & done;
  wire low_over = low & done;
  wire free = idle | low_over | (setup & done);
  wire step_begins = free & waits[0] & dir_right;
  wire turn = idle & ~dir_right & (~hold | done);
  wire restart = step_begins | turn | falls | low_over | timing_changed;
  wire begins_short = step_begins ? (step ? short_low : short_high) :
                      falls       ? short_low :
                      turn        ? short_setup :
                      low_over    ? short_hold :
                      at_level    ? level_short : dir_short;

  assign step_direction = dir;  // does not change in the clock after step_begins

  integer i;
  always @(posedge clk) begin
    for (i = 0; i < 4; i = i + 1)
    if (step_begins || !waits[i]) waiting[i] <= i < 3 && waits[(i+1)%4] ? waiting[(i+1)%4] : direction;
    if (step_begins != accepted) waits <= step_begins ? {1'b0, waits[3:1]} : {waits[2:0], 1'b1};
    overrun <= step_request & waits[3];
    if (overrun && lost != 4'hF) lost <= lost + 4'd1;

    timer          <= restart ? 16'd2 : timer + 16'd1;
    done           <= restart ? begins_short : reached;
    timing_changed <= timing_written;
    if (timing_written) done <= 1'b0;

    high  <= (high & ~falls) | (step_begins & ~both_edges);
    low   <= (low & ~low_over) | falls | (step_begins & both_edges);
    setup <= (setup & ~done) | turn;
    idle  <= free & ~step_begins & ~turn;
    hold  <= ((hold & ~done) | low_over) & ~step_begins & ~turn;
    step  <= step ^ (step_begins | falls);
    dir   <= dir ^ turn;

    step_made  <= step_begins;
    step_pin   <= step ^ step_inverted;
    dir_pin    <= dir ^ direction_inverted;
    enable_pin <= enable ^ enable_inverted;

    if (drop) waits <= 4'd0;
    if (clear) lost <= 4'd0;
    if (rst) begin
      high           <= 1'b0;
      low            <= 1'b0;
      setup          <= 1'b0;
      idle           <= 1'b1;
      hold           <= 1'b0;
      done           <= 1'b0;
      timing_changed <= 1'b0;
      waits          <= 4'd0;
      waiting        <= 4'd0;
      overrun        <= 1'b0;
      lost           <= 4'd0;
      step           <= 1'b0;
      dir            <= 1'b0;
      step_made      <= 1'b0;
      step_pin       <= 1'b0;
      dir_pin        <= 1'b0;
      enable_pin     <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_axis_formal.vh"
`endif

endmodule
`resetall
