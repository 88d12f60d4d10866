// SPDX-License-Identifier: MIT
// Axis: STEP and DIR pins of one axis, with all four pin timings.
//
//   DIR  ____/~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\____
//   STEP _________/~~~~\______/~~~~\_______________________
//            |setup|high|  low |    |  low  |  hold  |
//
// Promise: STEP is active for exactly step_high and inactive for at least step_low clocks; DIR never changes from
// dir_setup clocks before an active edge to dir_hold clocks after the low time of the pulse. With high = low = 1 the
// axis steps every two clocks. Steps that arrive during the pin timing are queued with their direction, up to 4; a
// step that finds the queue `full` is lost and counted in `lost`, saturating at 15. With an empty queue, DIR follows
// `direction`, that of the current line. With both_edges every edge of STEP is a step, and each level lasts at least
// step_high or step_low. `drop` empties the queue; a pulse in progress is finished. No timing is 0. The timings change
// in the clock after `timing_written`, when the running one restarts. `pins_written`, only while `quiet`: polarities
// and mode change with it, the pins two clocks later; the next step waits for step_low, dir_hold and dir_setup, as it
// does after a reset. A reset leaves STEP and DIR as they are and finishes a pulse in progress. `quiet`: no step is
// queued or in progress, no timing runs.
// Latency: step_request to STEP 3 clocks, `direction` to DIR 3 clocks. `step_made`, with `step_direction`, is high in
// the clock before the active edge leaves the pin. `closed_low` blocks negative steps and `closed_high` positive ones:
// they wait until they are dropped. Latency: `closed_low` to the last STEP edge in that direction 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axis #(
  parameter [0:0] STEP_RESET   = 0,  // pin levels from configuration on
  parameter [0:0] DIR_RESET    = 0,
  parameter [0:0] ENABLE_RESET = 0
) (
  input  wire        clk,
  input  wire        rst,
  input  wire        step_request,
  input  wire        direction,           // of this step and those to come: 1 = negative
  input  wire        drop,
  input  wire        closed_low,
  input  wire        closed_high,
  output wire        waits_next,          // a step waits: the next one
  output wire        negative_next,
  output reg         step_made,
  output wire        step_direction,
  output wire        full,                // no room for a step
  output reg         quiet,               // one clock late
  input  wire        clear,               // clears `lost`
  output reg  [ 3:0] lost,
  // settings
  output wire [ 1:0] timing_place,        // of the timing that runs in the next clock
  input  wire [15:0] timing,              // that runs; not used in the clock after timing_written
  input  wire        high_is_minimal,     // step_high is 1
  input  wire        low_is_minimal,
  input  wire        setup_is_minimal,
  input  wire        hold_is_minimal,
  input  wire        timing_written,
  input  wire        pins_written,
  input  wire        both_edges_next,     // with pins_written: the new mode
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

  // States. With both_edges there is no high: a step goes straight to low.
  reg high;  // STEP is active for step_high; then it falls
  reg low;  // STEP keeps its level for step_low or, with both_edges, for that level's time
  reg setup;
  reg idle;  // a step or, unless in hold, a DIR setup may begin
  reg hold;  // a step in the same direction may interrupt it
  reg settle;  // polarities and mode have changed
  reg unsettled;  // DIR has had no setup time since then
  reg step;
  reg dir;

  // `timer` is the number of the next clock of the state. `level_done`, or `dir_done` in setup and hold, is high in
  // the last clock, which is the first one if the timing is 1. Outside these states they say whether the timing that
  // would begin next is 1.
  reg  [15:0] timer;
  reg         level_done;
  reg         dir_done;
  // Kept: three LUTs from the timing, which comes late, to either. `ends` in halves.
  (* keep *)
  wire [ 7:0] differs;
  (* keep *)
  wire [ 1:0] ends;
  (* keep *)
  wire level_runs, next_level_is_minimal, dir_runs, next_dir_is_minimal;
  assign ends                  = {differs[7:4] == 4'd0, differs[3:0] == 4'd0};
  assign level_runs            = (high | low) & ~level_done;
  assign next_level_is_minimal = step ? low_is_minimal : high_is_minimal;
  assign dir_runs              = (setup | hold) & ~dir_done;
  assign next_dir_is_minimal   = low ? hold_is_minimal : setup_is_minimal;

  genvar pair;
  generate
    for (pair = 0; pair < 8; pair = pair + 1) begin : g_differs
      assign differs[pair] = timer[pair*2+:2] != timing[pair*2+:2];
    end
  endgenerate

  // Waiting steps, as directions, oldest in bit 0. Free places hold the latest direction.
  reg  [3:0] waiting;
  reg  [3:0] waits;  // occupied places
  reg        waits_up;  // waits[0] & ~waiting[0]
  reg        waits_down;  // waits[0] & waiting[0]
  (* keep *)
  wire       ready;
  assign ready = ~unsettled & (dir ? waits_down : waits_up);
  wire wrong = waiting[0] ^ dir;
  wire accepted = step_request & ~full;

  assign full          = waits[3];
  assign waits_next    = waits[0];
  assign negative_next = waiting[0];

  wire falls = high & level_done;
  wire low_over = low & level_done;
  wire free = idle | low_over | (setup & dir_done);
  wire step_begins = free & ready;
  wire needs_setup = wrong | unsettled;
  wire setup_begins = idle & needs_setup & (~hold | dir_done);
  wire edge_begins = step_begins | falls;

  // a timing begins, or none runs
  reg  restart;
  (* keep *)
  wire timing_over;
  assign timing_over = setup | idle ? dir_done | (idle & ~hold) : level_done;
  wire begins = restart | timing_over | (idle & ready);

  wire pulse = (step_pin ^ step_inverted) & ~both_edges;  // one is on the pin and will end

  assign step_direction = dir;  // stable in the clock after step_begins

  // The next oldest step: the second oldest if a step begins. Kept: one LUT each.
  (* keep *)
  wire up_behind, up_here, down_behind, down_here;
  assign up_behind   = waits[1] ? ~waiting[1] : step_request & ~direction;
  assign up_here     = waits[0] ? ~waiting[0] : step_request & ~direction;
  assign down_behind = waits[1] ? waiting[1] : step_request & direction;
  assign down_here   = waits[0] ? waiting[0] : step_request & direction;

  // The timing that runs in the next clock, from the states one LUT earlier than they are; any if none runs.
  wire level_stays = high | (low & ~level_done);
  wire dir_ends = (setup & dir_done) | settle;
  wire high_or_waits = ready & ~step & (low ? level_done : ~high);
  assign timing_place[1] = level_stays | dir_ends | ((low | idle) & ready);
  assign timing_place[0] = (~level_done & (high | (low & step))) | (setup & ~dir_done) | (settle & step)
                           | high_or_waits | setup_begins;

  integer i;
  always @(posedge clk) begin
    for (i = 0; i < 4; i = i + 1) begin
      if (step_begins || !waits[i]) waiting[i] <= i < 3 && waits[(i+1)%4] ? waiting[(i+1)%4] : direction;
    end
    if (step_begins != accepted) waits <= step_begins ? {1'b0, waits[3:1]} : {waits[2:0], 1'b1};
    waits_up   <= (step_begins ? up_behind : up_here) & ~closed_high;
    waits_down <= (step_begins ? down_behind : down_here) & ~closed_low;
    if (step_request && full && lost != 4'hF) lost <= lost + 4'd1;

    timer      <= !begins ? timer + 16'd1 : restart ? 16'd1 : 16'd2;
    level_done <= level_runs ? &ends : next_level_is_minimal;
    dir_done   <= dir_runs ? &ends : next_dir_is_minimal;
    if (restart) begin
      level_done <= 1'b0;
      dir_done   <= 1'b0;
    end

    high  <= (high & ~falls) | (step_begins & ~both_edges);
    low   <= (low & ~low_over) | falls | (step_begins & both_edges) | settle;
    setup <= (setup & ~dir_done) | setup_begins;
    idle  <= free & ~step_begins & ~setup_begins & ~settle;
    hold  <= ((hold & ~dir_done) | low_over) & ~step_begins & ~setup_begins;
    step  <= step ^ edge_begins;
    dir   <= dir ^ (setup_begins & wrong);

    restart   <= timing_written | pins_written;
    settle    <= pins_written;
    unsettled <= settle | (unsettled & ~setup_begins);
    quiet     <= idle & ~hold & ~needs_setup & ~waits[0] & ~step_request & ~pins_written & ~settle;

    step_made  <= step_begins;
    enable_pin <= enable ^ enable_inverted;
    if (!rst) begin
      step_pin <= step ^ step_inverted;
      dir_pin  <= dir ^ direction_inverted;
    end

    if (drop) begin
      waits      <= 4'd0;
      waits_up   <= 1'b0;
      waits_down <= 1'b0;
    end
    if (clear) lost <= 4'd0;
    if (rst) begin
      high       <= pulse;
      low        <= ~pulse;
      setup      <= 1'b0;
      idle       <= 1'b0;
      hold       <= 1'b0;
      settle     <= 1'b0;
      restart    <= 1'b1;  // `timing` is not that of this state yet
      unsettled  <= 1'b1;
      quiet      <= 1'b0;
      timer      <= 16'd1;
      level_done <= 1'b0;
      dir_done   <= 1'b0;
      waits      <= 4'd0;
      waits_up   <= 1'b0;
      waits_down <= 1'b0;
      lost       <= 4'd0;
      step       <= step_pin ^ step_inverted;
      dir        <= dir_pin ^ direction_inverted;
      step_made  <= 1'b0;
    end
    // no edge begins then: the axis is quiet
    if (pins_written && !both_edges_next && !rst) step <= 1'b0;
  end

  initial begin
    step_pin   = STEP_RESET;
    dir_pin    = DIR_RESET;
    enable_pin = ENABLE_RESET;
  end

`ifdef FORMAL
  `include "passo_axis_formal.vh"
`endif

endmodule
`resetall
