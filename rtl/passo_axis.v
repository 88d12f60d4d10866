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
// that finds the queue full is not made but raises `overrun` for a clock. While nothing waits, DIR follows
// `line_direction`.
// With both_edges every edge of STEP is a step, and each level lasts at least step_high or step_low. `drop`
// empties the queue; a pulse that has begun is finished. A timing of 0 counts as 1.
// Latency: step_request to STEP 3 clocks. `position` counts on the clock in which the active edge leaves the
// pin.
`resetall
`default_nettype none

module passo_axis (
  input  wire              clk,
  input  wire              rst,
  input  wire              step_request,
  input  wire              direction,           // of the step: 1 = negative
  input  wire              line_direction,      // of the steps to come
  input  wire              drop,
  input  wire              zero,                // set the position to 0
  output reg               overrun,
  output reg signed [31:0] position,
  // settings
  input  wire       [15:0] step_high,
  input  wire       [15:0] step_low,
  input  wire       [15:0] dir_setup,
  input  wire       [15:0] dir_hold,
  input  wire              both_edges,
  input  wire              step_inverted,
  input  wire              direction_inverted,
  input  wire              enable,
  input  wire              enable_inverted,
  // pins
  output reg               step_pin,
  output reg               dir_pin,
  output reg               enable_pin
);

  localparam [2:0] STATE_READY = 3'd0;
  localparam [2:0] STATE_HIGH = 3'd1;
  localparam [2:0] STATE_LOW = 3'd2;
  localparam [2:0] STATE_HOLD = 3'd3;  // a step in the same direction may interrupt it
  localparam [2:0] STATE_SETUP = 3'd4;

  reg  [ 2:0] state;
  reg  [15:0] timer;
  wire        timer_done = timer[15:1] == 15'd0;

  // steps that wait, as directions; the oldest in bit 0
  reg  [3:0] waiting;
  reg  [2:0] waiting_count;
  wire       waits = waiting_count != 3'd0;
  wire       waiting_full = waiting_count == 3'd4;

  reg step;
  reg dir;

  wire dir_wanted = waits ? waiting[0] : line_direction;
  wire dir_right = dir_wanted == dir;

  wire       free = state == STATE_READY || state == STATE_HOLD || (timer_done && state != STATE_HIGH);
  wire       step_begins = free & waits & dir_right;
  wire       turn = !dir_right && (state == STATE_READY || (state == STATE_HOLD && timer_done));
  wire       accepted = step_request & ~waiting_full;
  wire [2:0] place = waiting_count - {2'b00, step_begins};

  reg step_begins_q;
  reg dir_q;

  always @(posedge clk) begin
    // queue: take the oldest out, put the new one behind the rest
    if (step_begins) waiting <= {1'b0, waiting[3:1]};
    if (accepted) waiting[place[1:0]] <= direction;
    waiting_count <= place + {2'b00, accepted};
    overrun       <= step_request & waiting_full;

    timer <= timer - {15'd0, ~timer_done};
    case (state)
      STATE_HIGH:
      if (timer_done) begin
        step  <= 1'b0;
        timer <= step_low;
        state <= STATE_LOW;
      end
      STATE_LOW:
      if (timer_done) begin
        timer <= dir_hold;
        state <= STATE_HOLD;
      end
      STATE_HOLD, STATE_SETUP: if (timer_done) state <= STATE_READY;
      default:                 ;
    endcase
    if (turn) begin
      dir   <= ~dir;
      timer <= dir_setup;
      state <= STATE_SETUP;
    end
    if (step_begins) begin
      step  <= ~step;
      timer <= (both_edges && step) ? step_low : step_high;
      state <= both_edges ? STATE_LOW : STATE_HIGH;
    end

    step_begins_q <= step_begins;
    dir_q         <= dir;
    if (step_begins_q) position <= position + (dir_q ? -32'sd1 : 32'sd1);
    step_pin   <= step ^ step_inverted;
    dir_pin    <= dir ^ direction_inverted;
    enable_pin <= enable ^ enable_inverted;

    if (drop) waiting_count <= 3'd0;
    if (zero) position <= 32'sd0;
    if (rst) begin
      state         <= STATE_READY;
      waiting_count <= 3'd0;
      overrun       <= 1'b0;
      step          <= 1'b0;
      dir           <= 1'b0;
      step_begins_q <= 1'b0;
      position      <= 32'sd0;
      step_pin      <= 1'b0;
      dir_pin       <= 1'b0;
      enable_pin    <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_axis_formal.vh"
`endif

endmodule
`resetall
