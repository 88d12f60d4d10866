// SPDX-License-Identifier: MIT
// Tracker: the second hand of every axis of a channel. It moves an axis to a target within a speed and an acceleration,
// whatever the path does. One unit serves the axes in turn, 32 clocks each; a tick is a turn of 4 axes, or of 8 with
// more than 4 axes.
//
//   d = (target - position) * sign    distance to go     v   speed, a multiple of a; it moves the axis once per tick
//   t = v + (v - a) + ... + a         distance that v needs to its end
//
//   each tick   v + a <= speed and t + v + a <= d   v += a, t += v        (with the new v)
//               v <= speed     and t         <= d   v stays
//               otherwise                           t -= v, v -= a        (with the old v)
//               v is 0 then and 0 <= d < a          the position becomes the target, from rest if a <= speed
//               position += v * sign
//   at rest with d < 0, sign changes; so there is a tick of rest before it turns.
//
// Promise: it never passes a stationary target, moves by no more than `speed` a tick, and changes that by no more
// than the acceleration, whatever the targets do; the only exceptions are `halt`, which ends it immediately, and a target
// that jumps behind it, which it passes while it slows down. At its target it makes no step.
// Not enabled, or while `brake`, it slows down and rests; it does not begin to move while `hold`.
// `halt` and `zero` clear `enabled`; `zero` and a reset set the positions to 0.
//
// All numbers are in a memory of 16-bit words that is read twice a clock and written once: two words are added, or
// subtracted, with a carry from word to word. Positions are Q32.32 and half a step, so that their whole part is that of
// the nearest step; t is UQ32.32, the others are UQ0.32 steps. What the host writes is in a memory of its own and is
// copied: the target in each turn, speed and acceleration in every other one; but not in a turn in which it is written
// while it is read.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_tracker #(
  parameter AXES = 4
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            select,
  input  wire [     7:0] bus_address,    // within the channel
  input  wire [AXES-1:0] bus_bits,       // lower bits of the data
  input  wire [    15:0] bus_half,       // one clock late the upper half of the data, then the lower one
  output wire [    23:0] read_data,
  output reg             of_tracker,     // a position is addressed
  output wire            tracker_takes,  // strobe: show its lower half, and in the next clock its upper half
  output wire [    15:0] tracker_half,
  // motion
  input  wire            halt,           // hard stop, or stopped
  input  wire            zero,           // strobe: only at rest
  input  wire            brake,          // a soft stop is in progress
  input  wire            hold,           // no motion may begin
  // axes
  input  wire [AXES-1:0] path_down,      // the last line that moved the axis went down
  output reg  [AXES-1:0] step_made,      // strobes: a step is due
  output reg             made,           // one of them is
  output wire            step_down,      // its direction: 1 = negative
  output reg  [AXES-1:0] moves           // the tracker moves, or is about to
);

  `include "passo_registers.vh"

  localparam AXIS_BITS = AXES > 4 ? 3 : 2;

  // ---- the place in the program: two slots for each line, one word a slot ----
  reg  [          4:0] slot;
  reg  [AXIS_BITS-1:0] axis;
  reg                  odd;  // tick
  wire [          3:0] line = slot[4:1];
  wire                 word = slot[0];  // the upper one of the pair
  wire                 turn_ends = slot == 5'd31;
  wire                 tick_ends = turn_ends && axis == {AXIS_BITS{1'b1}};
  reg  [AXIS_BITS-1:0] written;  // the axis whose sums are written: until two slots after its turn

  // ---- settings of the axis whose turn it is, and what has been found ----
  reg negative;  // sign
  reg target_down;
  reg brakes;
  reg rests;  // v is 0
  reg behind;  // d < 0
  reg near;  // d < t
  reg close;  // d < t + w
  reg slow;  // v <= speed
  reg wide;  // w has more than 32 bits
  reg slower;  // w <= speed
  reg there;  // d is 0
  reg stays_zero;  // the new v is 0

  wire speeds = ~(brakes | close) & slower;
  wire keeps = ~speeds & (rests | (~(brakes | near) & slow));
  wire lands = stays_zero & ~(brakes | behind) & (rests ? close & slower : near);

  // ---- clearing: v and t after a hard stop, all numbers after a reset or `zero`, and v, which is 0, after a write of
  // an acceleration: until an odd tick is over that began after it, in which every axis has copied its own ----
  reg clearing;
  reg clears_again;  // beyond the next odd tick
  reg clears_position;
  reg cleared;  // in this turn, which then rests
  reg cleared_position;

  // ---- what this slot adds ----
  wire [3:0] first, second, result;
  wire subtracts, is_first, no_first, no_second, half;

  passo_tracker_program u_program (
    .line            (line),
    .word            (word),
    .odd             (odd),
    .negative        (negative),
    .speeds          (speeds),
    .keeps           (keeps),
    .lands           (lands),
    .cleared         (cleared),
    .cleared_position(cleared_position),
    .first           (first),
    .second          (second),
    .subtracts       (subtracts),
    .is_first        (is_first),
    .no_first        (no_first),
    .no_second       (no_second),
    .half            (half),
    .result          (result)
  );

  // ---- settings of the host: target up, target down, speed, acceleration, upper halves at odd places ----
  // The upper half is written and copied first: a copy is whole, unless it begins with the write. Then what was copied
  // before takes its place.
  wire [ 2:0] number = bus_address[2:0];
  reg         in_targets;  // decoded one clock ahead of the strobe
  reg         in_axis;
  wire        writes_acceleration = bus_write & in_axis & number[0];
  reg         writes_upper;
  reg         writes_lower;
  reg  [ 4:0] host_place;
  wire        copies = line == 4'd1 || line == 4'd10;
  reg         copies_q;  // and the host has not written
  wire [15:0] setting_word;

  wire copied = line == 4'd2 || line == 4'd11;

  // ---- memory ----
  wire [15:0] first_word;
  wire [15:0] second_word;
  reg         subtracts_q;
  reg         begins_q;  // lowest word
  reg         no_first_q;
  reg         no_second_q;
  reg         half_q;
  reg  [15:0] first_term;
  reg  [15:0] second_term;
  reg         carry;
  wire [16:0] sum = {1'b0, first_term} + {1'b0, second_term} + {16'd0, carry};
  wire [ 2:0] axis_padded = {{(3 - AXIS_BITS) {1'b0}}, axis};
  wire [ 7:0] place = {{(3 - AXIS_BITS) {1'b0}}, written, result, word ^ copied};
  wire [ 2:0] number_padded = {{(3 - AXIS_BITS) {1'b0}}, number[AXIS_BITS-1:0]};
  wire        host_reads = line == 4'd10;

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (6),
    .DATA_REGISTER(0)
  ) u_settings (
    .clk          (clk),
    .write        ((writes_upper & ~rst) | writes_lower),
    .write_address({host_place, writes_upper}),
    .write_data   (bus_half),
    .read_address ({axis_padded, line[3], line[3] ? odd : target_down, ~word}),
    .load         (1'b1),
    .read_data    (setting_word)
  );

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (8),
    .DATA_REGISTER(0)
  ) u_first (
    .clk          (clk),
    .write        (1'b1),
    .write_address(place),
    .write_data   (sum[15:0]),
    .read_address ({axis_padded, first, word ^ copies}),
    .load         (1'b1),
    .read_data    (first_word)
  );

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (8),
    .DATA_REGISTER(0)
  ) u_second (
    .clk          (clk),
    .write        (1'b1),
    .write_address(place),
    .write_data   (sum[15:0]),
    .read_address ({host_reads ? number_padded : axis_padded, second, word}),
    .load         (1'b1),
    .read_data    (second_word)
  );

  // ---- what is found in the sums ----
  // Whether the sums since the lowest word are all 0: four bits at a time, put together one clock later.
  reg     [3:0] same;
  reg           all_same;
  integer       k;

  always @(posedge clk) begin
    slot         <= slot + 5'd1;
    subtracts_q  <= subtracts;
    begins_q     <= is_first;
    no_first_q   <= no_first;
    no_second_q  <= no_second;
    half_q       <= half;
    copies_q     <= copies & ~(word ? writes_lower : writes_upper);
    first_term   <= no_first_q ? {half_q, 15'd0} : copies_q ? setting_word : first_word;
    second_term  <= (no_second_q ? {half_q, 15'd0} : second_word) ^ {16{subtracts_q}};
    carry        <= begins_q ? subtracts_q : sum[16];
    writes_lower <= writes_upper & ~rst;
    writes_upper <= bus_write & (in_targets | in_axis) & ~rst;
    if (bus_write)
      host_place <= in_axis ? {bus_address[5:3], 1'b1, number[0]} : {number, 1'b0, bus_address[3]};
    if (turn_ends) axis <= axis + 1'b1;
    if (slot == 5'd1) written <= axis;
    if (tick_ends) odd <= ~odd;

    // in the line after that of the sum; the upper word is the last one
    if (line == 4'd1) wide <= sum[16];
    if (line == 4'd3) slow <= sum[16];
    if (line == 4'd4) slower <= sum[16] & ~wide;
    if (line == 4'd6) behind <= sum[15];
    if (line == 4'd8) near <= sum[15];
    if (line == 4'd10) close <= sum[15];
    for (k = 0; k < 4; k = k + 1) same[k] <= sum[k*4+:4] == 4'd0;
    all_same <= &same & (all_same | (slot[0] & ~slot[2]));  // begins in slots 11 and 25
    if (slot == 5'd15) there <= all_same & ~cleared_position;
    if (slot == 5'd27) stays_zero <= all_same;

    if (rst) begin
      slot    <= 5'd1;  // nothing is over
      axis    <= {AXIS_BITS{1'b0}};
      odd     <= 1'b0;
      written <= {AXIS_BITS{1'b0}};
    end
  end

  // ---- state of the axes ----
  reg [AXES-1:0] enabled;
  reg [AXES-1:0] signs;
  reg [AXES-1:0] turns;  // v is not 0
  reg [AXES-1:0] at_target;
  reg            this_enabled;
  reg            this_sign;
  reg            this_turns;
  reg            this_down;

  integer i;
  always @* begin
    this_enabled = 1'b0;
    this_sign    = 1'b0;
    this_turns   = 1'b0;
    this_down    = 1'b0;
    for (i = 0; i < AXES; i = i + 1) begin
      step_made[i] = made & written == i[AXIS_BITS-1:0];
      if (axis == i[AXIS_BITS-1:0]) begin
        this_enabled = enabled[i];
        this_sign    = signs[i];
        this_turns   = turns[i];
        this_down    = path_down[i];
      end
    end
  end

  assign step_down = negative;  // still of the turn that is over

  wire    turn_over = slot == 5'd0;  // the sum of the lowest whole step of the position
  reg     write_enable;
  reg     read_state;
  integer j;

  always @(posedge clk) begin
    // settings of a turn: those of the one before are needed until it is over
    if (slot == 5'd1) begin
      negative         <= this_sign;
      rests            <= ~this_turns | clearing;
      target_down      <= this_down;
      brakes           <= ~this_enabled | brake | clearing | (hold & ~this_turns);
      cleared          <= clearing;
      cleared_position <= clears_position;
    end
    made <= turn_over & (second_term[0] ^ carry) & ~(clearing | cleared);
    for (j = 0; j < AXES; j = j + 1) begin
      if (turn_over && written == j[AXIS_BITS-1:0]) begin
        signs[j]     <= negative ^ (rests & behind & ~brakes);
        turns[j]     <= ~stays_zero;
        at_target[j] <= there;
      end
    end
    moves <= turns | (enabled & ~at_target & {AXES{~brake}});

    if (write_enable) enabled <= bus_bits;
    if (tick_ends) begin
      clearing        <= clears_again;
      clears_again    <= clears_again & odd;
      clears_position <= clears_position & clears_again;
    end
    if (halt || zero || rst) enabled <= {AXES{1'b0}};
    if (halt || zero || rst || writes_acceleration) begin
      clearing     <= 1'b1;
      clears_again <= 1'b1;
    end
    if (zero || rst) clears_position <= 1'b1;
    if (rst) begin
      signs     <= {AXES{1'b0}};
      turns     <= {AXES{1'b0}};
      at_target <= {AXES{1'b0}};
      made      <= 1'b0;
      moves     <= {AXES{1'b0}};
    end
  end

  // ---- host: registers ----
  reg  takes_upper;
  reg  in_state;
  // It is addressed for longer than a turn before it is read. Not torn: a read takes what was there before.
  wire takes_lower = slot == 5'd21 && !bus_read;

  assign tracker_takes = takes_lower | takes_upper;
  assign tracker_half  = second_word;

  always @(posedge clk) begin
    in_targets <= select && bus_address[7:4] == CHANNEL_TRACKER_TARGET_BASE[7:4];
    in_axis    <= select && bus_address[7:6] == CHANNEL_AXIS_BASE[7:6] && bus_address[2:1] == AXIS_TRACKER_SPEED[2:1];
    in_state <= select && bus_address[7:1] == CHANNEL_TRACKER_ENABLE[7:1];
    of_tracker <= select && bus_address[7:3] == CHANNEL_TRACKER_POSITION_BASE[7:3]
                   && {1'b0, number} < AXES[3:0];
    write_enable <= bus_write && in_state && !number[0];
    read_state <= bus_read && in_state && number[0];
    takes_upper <= takes_lower;

    if (rst) begin
      write_enable <= 1'b0;
      read_state   <= 1'b0;
    end
  end

  wire [7:0] enabled_padded = {{(8 - AXES) {1'b0}}, enabled};
  wire [7:0] moves_padded = {{(8 - AXES) {1'b0}}, moves};
  wire [7:0] at_target_padded = {{(8 - AXES) {1'b0}}, at_target};

  assign read_data = read_state ? {at_target_padded, moves_padded, enabled_padded} : 24'd0;

endmodule
`resetall
