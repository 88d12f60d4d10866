// SPDX-License-Identifier: MIT
// Positions of the axes of a channel. Each axis counts its steps modulo 256; the full positions are in a block RAM
// and updated in rounds of 64 clocks, axis by axis:
//
//   slot = 63      all counters are captured, on one clock (`captured`)
//   8 slots each   lower half: the captured byte, and a carry or borrow if it has wrapped;
//                  upper half: the remaining carry or borrow
//
// Promise: `snapshot` makes one round also copy the positions, as they were in its slot 63: they are coherent. It is
// the next round, or the one after it if the positions are being zeroed, which takes a round; the copies are complete
// 194 clocks after `snapshot`, or 258 if `latch` came before it. `position` is the copy of axis `address` once
// `address` has been stable for 13 clocks; of a tracker (`of_tracker`) it is what that shifts in.
//
// `latch` captures all counters simultaneously. The next round, or the one after it if positions are being zeroed,
// takes them instead of the current ones and copies the positions as they were on the clock of `latch`, complete 130
// clocks later (194 with a zero); zeroed meanwhile, they are 0. The round after it covers at most 127 clocks.
//
// Requires at most n / 2 + 4 steps of an axis in n clocks, so at most 67 between two updates of a position. The upper
// three bits of a byte give the direction of a wrap for up to 96.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_positions #(
  parameter AXES     = 4,
  parameter LATCH    = 0,  // 1: positions can be latched
  parameter TRACKERS = 0   // 1: positions of trackers are shown too
) (
  input  wire            clk,
  input  wire            rst,
  input  wire [AXES-1:0] step_made,
  input  wire [AXES-1:0] step_direction,  // 1 = negative
  input  wire            zero,            // set all positions to 0
  input  wire            snapshot,
  input  wire            latch,           // positions of this clock are kept
  input  wire [     3:0] address,         // of an axis; 8 and more: of its latched position
  // ignored without TRACKERS
  input  wire            of_tracker,      // show what a tracker has
  input  wire            tracker_takes,   // strobe: the lower half of it, and in the next clock the upper one
  input  wire [    15:0] tracker_half,
  output reg  [    31:0] position
);

  reg  [5:0] slot;
  reg        round_ends;  // slot 63
  reg        axis_ends;  // the last slot of an axis
  wire       upper = slot[2];
  wire [1:0] phase = slot[1:0];

  reg  clear_waits;
  reg  clears;  // this round sets the positions to 0
  reg  snapshot_waits;
  reg  copies_next;
  reg  copies;  // this round copies the positions; delayed, as the last half is
  reg  latch_waits;
  reg  latches_next;  // this round is that of the latched counters
  reg  latches;  // delayed
  wire latch_round = latch_waits & ~clear_waits;

  // If they can be latched, what is captured are the counters of one clock ago, one clock later: a latched counter is
  // one that has not followed since. So neither has to be chosen, and the round still is that of its slot 63.
  reg  round_begins;
  reg  axis_begins;
  reg  wipes;  // zeroed one clock ago
  wire takes = LATCH != 0 ? round_begins : round_ends;
  wire shifts = LATCH != 0 ? axis_begins : axis_ends;

  // Counters, and the shift chain of captured bytes
  wire [7:0] captured[0:AXES];
  assign captured[AXES] = 8'd0;

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      reg [7:0] count;
      reg [7:0] capture;
      reg [7:0] recent;  // `count` one clock ago, or on the clock of `latch` while it waits
      assign captured[axis] = capture;
      always @(posedge clk) begin
        if (step_made[axis]) count <= count + {{7{step_direction[axis]}}, 1'b1};
        if (rst || zero) count <= 8'd0;
        if (shifts) capture <= !takes ? captured[axis+1] : LATCH != 0 ? recent : count;
        if (latch || !latch_waits) recent <= count;
        if (wipes) recent <= 8'd0;
      end
    end
  endgenerate

  // One half of a position: read in phase 0, examined in phase 2, computed in phase 3, written in the next phase 0,
  // copied in phase 1. Bytes 0 and 1 are swapped in memory. Phases 2 and 3 read the halves for `position`.
  wire [15:0] half;
  reg  [15:0] half_q;
  reg  [15:0] half_next;
  reg         byte_is_first;  // half[7:0] is 0, one clock late
  reg         byte_is_last;  // it is 255
  reg         up;
  reg         down;
  reg  [ 3:0] place;  // address of half_next
  wire [ 7:0] low_byte = captured[0];
  wire        shows_tracker = TRACKERS != 0 && of_tracker;
  wire [15:0] sum = half_q + {16{down}} + {15'd0, up};

  // Positions, copies, and latched ones
  /* verilator lint_off UNUSEDSIGNAL */
  wire [5:0] write_address = {phase[0] & latches, phase[0] & ~latches, place};
  wire [5:0] read_address = phase[1] ? {address[3], ~address[3], address[2:0], phase[0]} : {2'b00, slot[5:2]};
  /* verilator lint_on UNUSEDSIGNAL */

  passo_memory #(
    .WIDTH     (16),
    .DEPTH_LOG2(LATCH != 0 ? 6 : 5)
  ) u_memory (
    .clk          (clk),
    .write        (phase == 2'd0 || (phase == 2'd1 && (copies || latches))),
    .write_address(write_address[(LATCH!=0?5 : 4):0]),
    .write_data   (half_next),
    .read_address (read_address[(LATCH!=0?5 : 4):0]),
    .load         (1'b1),
    .read_data    (half)
  );

  always @(posedge clk) begin
    slot         <= slot + 6'd1;
    round_ends   <= slot == 6'd62;
    axis_ends    <= slot[2:0] == 3'd6;
    round_begins <= round_ends;
    axis_begins  <= axis_ends;
    wipes        <= zero;
    if (phase == 2'd3) place <= slot[5:2];
    if (phase == 2'd1) copies <= copies_next;
    if (phase == 2'd1) latches <= latches_next;
    half_q        <= half;
    byte_is_first <= half[7:0] == 8'd0;
    byte_is_last  <= half[7:0] == 8'd255;
    if (phase == 2'd2 && !upper) begin
      up   <= half[15] && !low_byte[7] && half[14:13] >= low_byte[6:5];
      down <= !half[15] && low_byte[7] && half[14:13] <= low_byte[6:5];
    end
    if (phase == 2'd3) begin
      half_next <= upper ? sum : {low_byte, sum[7:0]};
      up        <= up & byte_is_last;
      down      <= down & byte_is_first;
      if (clears) half_next <= 16'd0;
    end
    if (clears) begin
      up   <= 1'b0;
      down <= 1'b0;
    end
    if (shows_tracker ? tracker_takes : phase == 2'd1)
      position <= shows_tracker ? {tracker_half, position[31:16]} : {half, half_q[7:0], half_q[15:8]};

    if (round_ends) begin
      clears <= clear_waits;
      clear_waits <= 1'b0;
      copies_next <= snapshot_waits & ~latch_round;
      snapshot_waits <= snapshot_waits & (clear_waits | latch_round);  // copied once more after the positions are cleared
      latches_next <= latch_round;
      latch_waits <= latch_waits & clear_waits;
    end
    if (zero) clear_waits <= 1'b1;
    if (snapshot) snapshot_waits <= 1'b1;
    if (latch && LATCH != 0) latch_waits <= 1'b1;

    if (rst) begin
      slot           <= 6'd0;
      clears         <= 1'b1;
      clear_waits    <= 1'b0;
      copies_next    <= 1'b0;
      snapshot_waits <= 1'b0;
      latch_waits    <= 1'b0;
      latches_next   <= LATCH != 0;  // zeroes the latched positions
      latches        <= 1'b0;
    end
  end

endmodule
`resetall
