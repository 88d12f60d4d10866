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
//               v is 0 then and 0 <= d < a          the position becomes the target: the last tick takes the rest
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
// subtracted, with a carry from word to word. Positions are Q32.32, t is UQ32.32, the others are UQ0.32 steps. What
// the host writes stands in a memory of its own and is copied once a turn, but for the turn in which it is written.
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
  input  wire [     7:0] bus_address,  // within the channel
  input  wire [AXES-1:0] bus_bits,     // lower bits of the data
  input  wire [    15:0] bus_half,     // one clock late the upper half of the data, then the lower one
  output wire [    31:0] read_data,
  // motion
  input  wire            halt,         // hard stop, or stopped
  input  wire            zero,         // strobe: only at rest
  input  wire            brake,        // a soft stop is in progress
  input  wire            hold,         // no motion may begin
  // axes
  input  wire [AXES-1:0] path_down,    // the last line that moved the axis went down
  output reg  [AXES-1:0] step_made,    // strobes: a step is due
  output reg             step_down,    // its direction: 1 = negative
  output reg  [AXES-1:0] moves         // the tracker moves, or is about to
);

  `include "passo_registers.vh"

  localparam AXIS_BITS = AXES > 4 ? 3 : 2;

  // Words of an axis. The lower two words of the target are the fraction, 0.
  localparam [4:0] TARGET = 5'd0;
  localparam [4:0] POSITION = 5'd4;
  localparam [4:0] STOPPING = 5'd8;  // t
  localparam [4:0] SCRATCH = 5'd12;
  localparam [4:0] VELOCITY = 5'd16;  // of one tick at 16, of the next one at 18
  localparam [4:0] SPEED = 5'd20;
  localparam [4:0] ACCELERATION = 5'd22;
  localparam [4:0] SPARE = 5'd24;  // speed - v

  // ---- the program: four slots for each line, one word a slot ----
  //
  //   0  speed - v, less a; copy target   1  y = target - position   2  y -= t * sign   3  y -= v * sign
  //   4  y - a * sign; copy acceleration  5  copy speed; new v       6  new t           7  new position
  //
  // y is d * sign, less 1 if sign is negative, so that its sign bit, as one of d, is right after additions, too.

  reg  [          4:0] slot;
  reg  [AXIS_BITS-1:0] axis;
  reg                  odd;  // tick: which word is the new velocity
  wire [          1:0] word = slot[1:0];
  wire                 upper = slot[1];  // the second two words
  wire                 turn_ends = slot == 5'd31;
  wire                 tick_ends = turn_ends && axis == {AXIS_BITS{1'b1}};

  reg [2:0] line_q;  // of what is added in this clock
  reg [1:0] word_q;

  // ---- settings of the axis whose turn it is, and what has been found ----
  reg negative;  // sign
  reg target_down;
  reg brakes;
  reg rests;  // v is 0
  reg behind;  // d < 0
  reg near;  // d < t
  reg close;  // d < t + v + a
  reg slow;  // v <= speed
  reg slower;  // v + a <= speed
  reg there;  // d is 0
  reg stays_zero;  // the new v is 0

  wire speeds = ~(brakes | close) & slower;
  wire keeps = ~speeds & (rests | (~(brakes | near) & slow));
  wire lands = stays_zero & ~(brakes | behind) & (rests ? close : near);

  // ---- clearing: v and t after a hard stop, all numbers after a reset or `zero`; for what is left of a tick and one ----
  reg  [1:0] clears;
  reg        clears_position;
  wire       clearing = clears != 2'd0;
  reg        cleared;  // in this turn
  reg        cleared_position;

  // ---- addresses ----
  wire [4:0] old_velocity = {VELOCITY[4:2], odd, word[0]};
  wire [4:0] new_velocity = {VELOCITY[4:2], ~odd, word[0]};
  reg  [4:0] first;
  reg  [4:0] second;
  reg  [4:0] result;
  reg        writes;
  reg        subtracts;
  reg        is_zero;  // write 0
  reg        is_over;  // the second number has no words left, or does not count

  always @* begin
    first     = {SCRATCH[4:2], word};
    second    = {ACCELERATION[4:1], word[0]};
    result    = {SCRATCH[4:2], word};
    writes    = 1'b1;
    subtracts = ~negative;
    is_zero   = 1'b0;
    is_over   = 1'b0;
    case (slot[4:2])
      3'd0: begin
        // a word less itself is 0
        first     = {upper || clears_position ? SPARE[4:1] : SPEED[4:1], word[0]};
        second    = {upper ? ACCELERATION[4:1] : clears_position ? SPARE[4:1] : old_velocity[4:1], word[0]};
        result    = clears_position ? {TARGET[4:1], word[0]} : {SPARE[4:1], word[0]};
        writes    = ~upper;
        subtracts = 1'b1;
      end
      3'd1: begin
        first     = {TARGET[4:2], word};
        second    = {POSITION[4:2], word};
        subtracts = 1'b1;
      end
      3'd2: second = {STOPPING[4:2], word};
      3'd3: begin
        second  = old_velocity;
        is_over = upper;
      end
      3'd4: begin
        is_over = upper;
        writes  = 1'b0;
      end
      3'd5: begin
        first     = old_velocity;
        result    = new_velocity;
        writes    = upper;
        is_over   = keeps;
        subtracts = ~(speeds | keeps);
        is_zero   = cleared;
      end
      3'd6: begin
        first     = {STOPPING[4:2], word};
        second    = speeds ? new_velocity : old_velocity;
        result    = {STOPPING[4:2], word};
        is_over   = upper | keeps;
        subtracts = ~(speeds | keeps);
        is_zero   = cleared;
      end
      default: begin
        first     = lands ? {TARGET[4:2], word} : {POSITION[4:2], word};
        second    = new_velocity;
        result    = {POSITION[4:2], word};
        is_over   = upper | lands;
        subtracts = negative & ~lands;
        is_zero   = cleared_position;
      end
    endcase
    // two words of the target are 0
    if (is_zero) first = {TARGET[4:1], word[0]};
    if (is_zero || is_over) second = {TARGET[4:1], word[0]};
    if (is_zero) subtracts = 1'b0;
  end

  // ---- settings of the host: target up, target down, speed, acceleration, upper halves at odd places ----
  // The upper half is written and copied first: a copy is whole, unless it begins with the write.
  wire [2:0] number = bus_address[2:0];
  reg in_targets;  // decoded one clock ahead of the strobe
  reg in_axis;
  reg writes_upper;
  reg writes_lower;
  reg [4:0] host_place;
  wire copies = slot == 5'd2 || slot == 5'd3 || slot[4:1] == 4'd9 || slot[4:1] == 4'd10;
  wire [ 4:0] setting = slot[4] ? {slot[2] ? SPEED[4:1] : ACCELERATION[4:1], ~word[0]} : {TARGET[4:2], 1'b1, ~word[0]};
  wire [15:0] setting_word;
  reg copies_q;

  // ---- memory ----
  wire [15:0] first_word;
  wire [15:0] second_word;
  reg  [ 7:0] result_q;
  reg         writes_q;
  reg         subtracts_q;
  reg         borrows_q;  // carry into the lowest word
  reg         begins_q;  // lowest word
  reg         carry;
  wire [15:0] term = second_word ^ {16{subtracts_q}};
  wire [16:0] sum = {1'b0, first_word} + {1'b0, term} + {16'd0, begins_q ? borrows_q : carry};
  wire [ 2:0] axis_padded = {{(3 - AXIS_BITS) {1'b0}}, axis};
  wire        host_reads = slot[4:1] == 4'd10;  // the second word is not needed then

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (6),
    .DATA_REGISTER(0)
  ) u_settings (
    .clk          (clk),
    .write        ((writes_upper & ~rst) | writes_lower),
    .write_address({host_place, writes_upper}),
    .write_data   (bus_half),
    .read_address ({axis_padded, slot[4], slot[4] ? ~slot[2] : target_down, ~word[0]}),
    .load         (1'b1),
    .read_data    (setting_word)
  );

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (8),
    .DATA_REGISTER(0)
  ) u_first (
    .clk          (clk),
    .write        (writes_q),
    .write_address(result_q),
    .write_data   (copies_q ? setting_word : sum[15:0]),
    .read_address ({axis_padded, first}),
    .load         (1'b1),
    .read_data    (first_word)
  );

  passo_memory #(
    .WIDTH        (16),
    .DEPTH_LOG2   (8),
    .DATA_REGISTER(0)
  ) u_second (
    .clk          (clk),
    .write        (writes_q),
    .write_address(result_q),
    .write_data   (copies_q ? setting_word : sum[15:0]),
    .read_address (host_reads ? {number, POSITION[4:2], 1'b1, word[0]} : {axis_padded, second}),
    .load         (1'b1),
    .read_data    (second_word)
  );

  // ---- what is found in the sums ----
  // Whether a sum is all 0, or in line 1 all `negative`: three bits at a time, put together one clock later.
  wire           sign = negative & line_q == 3'd1;
  wire    [17:0] differs = {2'd0, sum[15:0] ^ {16{sign}}};
  reg     [ 5:0] same;
  wire           all_same = &same;
  reg            parity;  // of the number of steps: the position, rounded to the nearest step
  integer        k;

  always @(posedge clk) begin
    slot         <= slot + 5'd1;
    line_q       <= slot[4:2];
    word_q       <= word;
    result_q     <= {axis_padded, copies ? setting : result};
    copies_q     <= copies;
    writes_q     <= copies ? ~(word[0] ? writes_lower : writes_upper) : writes;
    subtracts_q  <= subtracts;
    borrows_q    <= slot[4:2] == 3'd1 ? ~negative : subtracts;
    begins_q     <= word == 2'd0 || ((slot[4:2] == 3'd0 || slot[4:2] == 3'd5) && word == 2'd2);
    carry        <= sum[16];
    writes_lower <= writes_upper & ~rst;
    writes_upper <= bus_write & (in_targets | in_axis) & ~rst;
    if (bus_write)
      host_place <= in_axis ? {bus_address[5:3], 1'b1, number[0]} : {number, 1'b0, bus_address[3]};
    if (turn_ends) axis <= axis + 1'b1;
    if (tick_ends) odd <= ~odd;

    if (line_q == 3'd0) begin
      slow   <= word_q[1] ? slow : sum[16];
      slower <= sum[16] & slow;
    end
    if (line_q == 3'd1) begin
      behind <= sum[15] ^ negative;
      if (word_q == 2'd1) parity <= second_word[15];
      if (word_q == 2'd2) parity <= parity ^ second_word[0];
    end
    if (line_q == 3'd2) near <= sum[15] ^ negative;
    if (line_q == 3'd4) close <= sum[15] ^ negative;
    for (k = 0; k < 6; k = k + 1) same[k] <= differs[k*3+:3] == 3'd0;
    if (slot >= 5'd6 && slot <= 5'd9) there <= all_same & (there | slot == 5'd6);
    if (slot == 5'd24 || slot == 5'd25) stays_zero <= all_same & (stays_zero | ~slot[0]);
    if (line_q == 3'd7 && word_q == 2'd1) parity <= parity ^ sum[15];

    if (rst) begin
      slot     <= 5'd0;
      axis     <= {AXIS_BITS{1'b0}};
      odd      <= 1'b0;
      writes_q <= 1'b0;
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
      if (axis == i[AXIS_BITS-1:0]) begin
        this_enabled = enabled[i];
        this_sign    = signs[i];
        this_turns   = turns[i];
        this_down    = path_down[i];
      end
    end
  end

  reg     write_enable;
  reg     read_state;
  integer j;

  always @(posedge clk) begin
    // settings of a turn; before, the sign is still needed for the last words of the turn before
    if (slot == 5'd1) begin
      negative         <= this_sign;
      rests            <= ~this_turns;
      target_down      <= this_down;
      brakes           <= ~this_enabled | brake | clearing | (hold & ~this_turns);
      cleared          <= clearing;
      cleared_position <= clears_position;
    end
    step_made <= {AXES{1'b0}};
    for (j = 0; j < AXES; j = j + 1) begin
      if (turn_ends && axis == j[AXIS_BITS-1:0]) begin
        step_made[j] <= (parity ^ sum[0]) & ~clearing;
        signs[j]     <= negative ^ (rests & behind & ~brakes);
        turns[j]     <= ~stays_zero;
        at_target[j] <= there;
      end
    end
    if (turn_ends) step_down <= negative;
    moves <= turns | (enabled & ~at_target & {AXES{~brake}});

    if (write_enable) enabled <= bus_bits;
    if (tick_ends && clearing) clears <= clears - 2'd1;
    if (tick_ends && clears == 2'd1) clears_position <= 1'b0;
    if (halt || zero || rst) begin
      enabled <= {AXES{1'b0}};
      clears  <= 2'd2;
    end
    if (zero || rst) clears_position <= 1'b1;
    if (rst) begin
      signs     <= {AXES{1'b0}};
      turns     <= {AXES{1'b0}};
      at_target <= {AXES{1'b0}};
      step_made <= {AXES{1'b0}};
      moves     <= {AXES{1'b0}};
    end
  end

  // ---- host: registers ----
  reg [31:0] position;
  reg        takes_upper;
  reg        in_state;
  reg        in_positions;

  always @(posedge clk) begin
    in_targets <= select && bus_address[7:4] == CHANNEL_TRACKER_TARGET_BASE[7:4] && {1'b0, number} < AXES[3:0];
    in_axis    <= select && bus_address[7:6] == CHANNEL_AXIS_BASE[7:6] && bus_address[2:1] == AXIS_TRACKER_SPEED[2:1]
                  && {1'b0, bus_address[5:3]} < AXES[3:0];
    in_state <= select && bus_address[7:1] == CHANNEL_TRACKER_ENABLE[7:1];
    in_positions <= select && bus_address[7:3] == CHANNEL_TRACKER_POSITION_BASE[7:3];
    write_enable <= bus_write && in_state && !number[0];
    read_state <= bus_read && in_state && number[0];

    // 0 unless it is addressed, for longer than a turn before it is read. Not torn: a read takes what was there before.
    takes_upper <= slot == 5'd21 && !bus_read;
    if (slot == 5'd21 && !bus_read) position[15:0] <= second_word & {16{in_positions}};
    if (takes_upper) position[31:16] <= second_word & {16{in_positions}};

    if (rst) begin
      write_enable <= 1'b0;
      read_state   <= 1'b0;
      position     <= 32'd0;
    end
  end

  wire [7:0] enabled_padded = {{(8 - AXES) {1'b0}}, enabled};
  wire [7:0] moves_padded = {{(8 - AXES) {1'b0}}, moves};
  wire [7:0] at_target_padded = {{(8 - AXES) {1'b0}}, at_target};

  assign read_data = (read_state ? {8'd0, at_target_padded, moves_padded, enabled_padded} : 32'd0) | position;

endmodule
`resetall
