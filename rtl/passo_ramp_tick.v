// SPDX-License-Identifier: MIT
// Ramp tick: end of one velocity and start of the next.
//
//   advance        _|-|_|-|_ ... _|-|_|-|_____|-|_|-|_      a tick has 2^TICK_LOG2
//   tick_ends      ________________|---|_____|---|____      in the last clock of the tick, if a velocity is ready
//   stall          _____________________|----|________      in the last clock, while none is ready
//
// A computed velocity is `ready` until it is taken: by begin_profile, then at the end of each tick. After
// `profile_over` the next one taken is the end of the profile (`ends_next`, `ended`).
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp_tick #(
  parameter TICK_LOG2 = 7
) (
  input  wire clk,
  input  wire rst,
  input  wire prepare,
  input  wire begin_profile,
  input  wire drain,          // does not wait for velocities
  input  wire advance,        // enabled clock: not while `stall`
  input  wire tick,           // the last one of a tick: while `tick_ends`
  input  wire velocity_made,
  input  wire profile_over,
  output reg  ready,          // velocity_next is valid one clock later
  output reg  ends_next,      // no next tick: rest
  output wire ended,
  output reg  tick_ends,
  output reg  stall
);

  localparam [TICK_LOG2-1:0] TICK_LAST = {TICK_LOG2{1'b1}};

  reg [TICK_LOG2-1:0] tick_count;
  reg tick_last;  // the next enabled clock is the last
  wire tick_last_next = !begin_profile && (advance ? tick_count == TICK_LAST - 1'b1 : tick_last);
  wire take_velocity = begin_profile | tick;

  assign ended = take_velocity & ends_next;

  always @(posedge clk) begin
    if (advance) tick_count <= tick_count + 1'b1;
    if (begin_profile) tick_count <= {TICK_LOG2{1'b0}};
    tick_last <= tick_last_next;
    tick_ends <= tick_last_next && (ready || drain);
    stall     <= tick_last_next && !(ready || drain);

    if (velocity_made || profile_over) ready <= 1'b1;
    if (profile_over) ends_next <= 1'b1;
    if (take_velocity) ready <= 1'b0;
    if (prepare) begin
      ready     <= 1'b0;
      ends_next <= 1'b0;
    end
    if (rst) begin
      ready     <= 1'b0;
      ends_next <= 1'b1;
      tick_last <= 1'b0;
      tick_ends <= 1'b0;
      stall     <= 1'b0;
    end
  end

endmodule
`resetall
