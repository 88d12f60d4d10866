// SPDX-License-Identifier: MIT
// Encoders of a channel: one per axis, their positions, and the follower, which turns the counts of one of them into
// the clock of the profile. Wiring, except for the selection of that encoder.
//
// Promise: while following, the profile has 2^scale enabled clocks for each count since the motion began; `advance` is
// its clock enable. With `wait_index` an ARMED motion starts with an index (`may_begin`), at the count that leads to
// it. `waits`, two clocks late: the profile follows and owes the encoder nothing, so nothing moves. `index_active` is
// the index with the polarity of the encoder's setup, synchronized but not filtered.
// Latency: pin to `advance` 7 + filter clocks; the first enabled clock is that of the first count after the index.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoders #(
  parameter AXES  = 4,
  parameter LATCH = 0   // 1: positions can be latched
) (
  input  wire            clk,
  input  wire            rst,
  // bus
  input  wire            bus_write,
  input  wire            bus_read,
  input  wire            select,
  input  wire [     7:0] bus_address,     // within the channel
  input  wire [    31:0] bus_data,
  output wire [    31:0] read_data,
  // commands
  input  wire            zero,
  input  wire            clear,
  input  wire            snapshot,
  input  wire            latch,
  // axes
  input  wire [AXES-1:0] step_made,
  input  wire [AXES-1:0] step_direction,
  // motion
  input  wire            prepare,
  input  wire            begin_profile,
  input  wire            counting,
  input  wire            drain,
  output wire            may_begin,
  output reg             stop_soft,       // while an axis is too far from its encoder, or the phase is lost
  output reg             stop_hard,
  // profile
  input  wire            enabled,         // by the time scale
  input  wire            stall,
  output wire            follows,         // `advance` is the clock enable, not the time scale
  output wire            advance,
  output wire            waits,
  // pins
  input  wire [AXES-1:0] a,
  input  wire [AXES-1:0] b,
  input  wire [AXES-1:0] index,
  output wire [AXES-1:0] index_active
);

  wire [   AXES-1:0] write_setup;
  wire [   AXES-1:0] write_ratio;
  wire [   AXES-1:0] write_limit;
  wire [   AXES-1:0] read_error;
  wire [   AXES-1:0] read_greatest;
  wire [   AXES-1:0] read_index;
  wire               read_position;
  wire               read_follow;
  wire               follow;
  wire               wait_index;
  wire [        2:0] source;
  wire [        2:0] scale;
  wire [       31:0] follow_limit;
  wire [        7:0] filter;
  wire [   AXES-1:0] count_made;
  wire [   AXES-1:0] count_down;
  wire [   AXES-1:0] slipped;
  wire [   AXES-1:0] index_event;
  wire [   AXES-1:0] axis_stop_soft;
  wire [   AXES-1:0] axis_stop_hard;
  wire [AXES*32-1:0] axis_read_data;
  wire [       31:0] position;
  wire [       23:0] owed;
  wire               behind;
  wire               lost;
  wire               due;
  reg                was_behind;
  reg                was_lost;

  // of all axes, the one that is followed
  wire [AXES-1:0] followed;
  wire            source_made = (count_made & followed) != {AXES{1'b0}};
  wire            source_down = (count_down & followed) != {AXES{1'b0}};
  wire            source_slipped = (slipped & followed) != {AXES{1'b0}};
  wire            source_index = (index_event & followed) != {AXES{1'b0}};

  assign may_begin = ~(follow & wait_index) | source_index;
  assign follows   = follow & ~drain;
  assign waits     = follows & ~due;

  reg     [31:0] words;
  integer        i;
  always @* begin
    words = (position & {32{read_position}}) | ({6'd0, was_lost, was_behind, owed} & {32{read_follow}});
    for (i = 0; i < AXES; i = i + 1) words = words | axis_read_data[i*32+:32];
  end
  assign read_data = words;

  always @(posedge clk) begin
    stop_soft  <= axis_stop_soft != {AXES{1'b0}} || lost;
    stop_hard  <= axis_stop_hard != {AXES{1'b0}};
    was_behind <= (was_behind & ~prepare) | behind;
    was_lost   <= (was_lost & ~prepare) | lost;
    if (rst) begin
      stop_soft  <= 1'b0;
      stop_hard  <= 1'b0;
      was_behind <= 1'b0;
      was_lost   <= 1'b0;
    end
  end

  genvar axis;
  generate
    for (axis = 0; axis < AXES; axis = axis + 1) begin : g_axis
      localparam [2:0] NUMBER = axis;

      assign followed[axis] = source == NUMBER;

      passo_encoder_axis u_axis (
        .clk           (clk),
        .rst           (rst),
        .a             (a[axis]),
        .b             (b[axis]),
        .index         (index[axis]),
        .write_setup   (write_setup[axis]),
        .write_ratio   (write_ratio[axis]),
        .write_limit   (write_limit[axis]),
        .bus_data      (bus_data),
        .read_error    (read_error[axis]),
        .read_greatest (read_greatest[axis]),
        .read_index    (read_index[axis]),
        .read_data     (axis_read_data[axis*32+:32]),
        .filter        (filter),
        .zero          (zero),
        .clear         (clear),
        .step_made     (step_made[axis]),
        .step_direction(step_direction[axis]),
        .count_made    (count_made[axis]),
        .count_down    (count_down[axis]),
        .slipped       (slipped[axis]),
        .index_active  (index_active[axis]),
        .index_event   (index_event[axis]),
        .stop_soft     (axis_stop_soft[axis]),
        .stop_hard     (axis_stop_hard[axis])
      );
    end
  endgenerate

  passo_encoder_registers #(
    .AXES(AXES)
  ) u_registers (
    .clk          (clk),
    .rst          (rst),
    .bus_write    (bus_write),
    .bus_read     (bus_read),
    .select       (select),
    .bus_address  (bus_address),
    .bus_data     (bus_data),
    .write_setup  (write_setup),
    .write_ratio  (write_ratio),
    .write_limit  (write_limit),
    .read_error   (read_error),
    .read_greatest(read_greatest),
    .read_index   (read_index),
    .read_position(read_position),
    .read_follow  (read_follow),
    .follow       (follow),
    .wait_index   (wait_index),
    .source       (source),
    .scale        (scale),
    .follow_limit (follow_limit),
    .filter       (filter)
  );

  passo_follower u_follower (
    .clk       (clk),
    .rst       (rst),
    .following (follows & (begin_profile | counting)),
    .count_made(source_made),
    .count_down(source_down),
    .slipped   (source_slipped),
    .scale     (scale),
    .limit     (follow_limit),
    .enable    (enabled & counting),
    .stall     (stall),
    .advance   (advance),
    .owed      (owed),
    .due       (due),
    .behind    (behind),
    .lost      (lost)
  );

  // Counts are steps to it. It latches when the positions of the axes do, so that its copies are always of the same
  // clock as theirs.
  passo_positions #(
    .AXES (AXES),
    .LATCH(LATCH)
  ) u_positions (
    .clk           (clk),
    .rst           (rst),
    .step_made     (count_made),
    .step_direction(count_down),
    .zero          (zero),
    .snapshot      (snapshot),
    .latch         (latch),
    .address       ({1'b0, bus_address[2:0]}),
    .of_tracker    (1'b0),
    .tracker_takes (1'b0),
    .tracker_half  (16'd0),
    .position      (position)
  );

endmodule
`resetall
