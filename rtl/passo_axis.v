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

  localparam [1:0] STATE_READY = 2'd0;
  localparam [1:0] STATE_PULSE = 2'd1;  // STEP holds its level
  localparam [1:0] STATE_HOLD = 2'd2;  // a step in the same direction may interrupt it
  localparam [1:0] STATE_SETUP = 2'd3;

  reg [1:0] state;
  reg       step;
  reg       dir;

  // Timer: 1 in the first clock of a state. The time is over when they are equal; bit 0 lets 0 count as 1.
  reg  [15:0] timer;
  wire [15:0] pulse_time = step ? step_high : step_low;
  wire [15:0] dir_time = state == STATE_SETUP ? dir_setup : dir_hold;
  wire        pulse_done = timer[15:1] == pulse_time[15:1] && (timer[0] || !pulse_time[0]);
  wire        dir_done = timer[15:1] == dir_time[15:1] && (timer[0] || !dir_time[0]);

  // Steps that wait, as directions, the oldest in bit 0. Free places hold the latest direction.
  reg  [ 3:0] waiting;
  reg  [ 3:0] waits;  // which places are taken
  wire        dir_right = waiting[0] == dir;
  wire        accepted = step_request & ~waits[3];

  wire        level_done = state == STATE_PULSE && pulse_done;
  wire        falls = level_done && step && !both_edges;
  wire        free = state == STATE_READY || state == STATE_HOLD || (level_done && !falls)
                     || (state == STATE_SETUP && dir_done);
  wire        step_begins = free & waits[0] & dir_right;
  wire        turn = !dir_right && (state == STATE_READY || (state == STATE_HOLD && dir_done));

  assign step_direction = dir;  // does not change in the clock after step_begins

  integer i;
  always @(posedge clk) begin
    for (i = 0; i < 4; i = i + 1)
      if (step_begins || !waits[i]) waiting[i] <= i < 3 && waits[(i+1)%4] ? waiting[(i+1)%4] : direction;
    if (step_begins != accepted) waits <= step_begins ? {1'b0, waits[3:1]} : {waits[2:0], 1'b1};
    overrun <= step_request & waits[3];
    if (overrun && lost != 4'hF) lost <= lost + 4'd1;

    timer <= timer + 16'd1;
    if (step_begins || turn || level_done || timing_written) timer <= 16'd1;

    case (state)
      STATE_PULSE: if (level_done && !falls) state <= STATE_HOLD;
      STATE_HOLD, STATE_SETUP: if (dir_done) state <= STATE_READY;
      default: ;
    endcase
    if (turn) state <= STATE_SETUP;
    if (step_begins) state <= STATE_PULSE;
    step       <= step ^ (step_begins | falls);
    dir        <= dir ^ turn;

    step_made  <= step_begins;
    step_pin   <= step ^ step_inverted;
    dir_pin    <= dir ^ direction_inverted;
    enable_pin <= enable ^ enable_inverted;

    if (drop) waits <= 4'd0;
    if (clear) lost <= 4'd0;
    if (rst) begin
      state      <= STATE_READY;
      waits      <= 4'd0;
      waiting    <= 4'd0;
      overrun    <= 1'b0;
      lost       <= 4'd0;
      step       <= 1'b0;
      dir        <= 1'b0;
      step_made  <= 1'b0;
      step_pin   <= 1'b0;
      dir_pin    <= 1'b0;
      enable_pin <= 1'b0;
    end
  end

endmodule
`resetall
