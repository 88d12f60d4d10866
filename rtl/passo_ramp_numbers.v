// SPDX-License-Identifier: MIT
// Numbers of the current ramp: start velocity, progress, ticks. The constants (end velocity, progress step, length)
// stay in the ramp queue and are read from there in half-words.
//
//   v_start   shifts by a half-word to load v_end, by a bit to be read (a full turn takes 48 clocks)
//   u         in units of 2^-49, so that du / 2 is a whole number: u += du / 2 in 3 half-words, lowest first
//   ticks     counts up from -1 - T; `over` when 1 has been added T + 1 times
//
// The queue stores T inverted, and du inverted if the ramp is mirrored: such a ramp runs from 1 back to 0, and its u
// is the bitwise inverse of the other's.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_ramp_numbers (
  input  wire        clk,
  input  wire [15:0] half,             // half-word of the ramp queue
  // v_start
  input  wire        start_move,
  input  wire        start_load,
  input  wire        start_copy,       // 24 clocks: from two bit streams, one per half
  input  wire        copy_high,
  input  wire        copy_low,
  output wire        start_bit,
  // v_end
  input  wire [ 3:0] end_index,        // bit of `half`, from 1, modulo 16
  output reg         end_bit,
  // u
  input  wire        mirror,
  input  wire        u_move,           // by a half-word
  input  wire        u_load,           // load du / 2 instead of adding it
  input  wire        u_last,           // the last of the three
  output wire [32:0] progress,         // UQ0.33
  // ticks
  input  wire        ticks_load_low,
  input  wire        ticks_load_high,
  input  wire        ticks_add_low,
  input  wire        ticks_add_high,   // a clock after ticks_add_low
  output reg         over
);

  reg [47:0] v_start;

  assign start_bit = v_start[0];

  always @(posedge clk) begin
    if (start_move)
      v_start <= start_load ? {half, v_start[47:16]} :
                               start_copy ? {copy_high, v_start[47:25], copy_low, v_start[23:1]} :
                                            {v_start[0], v_start[47:1]};
  end

  wire [15:0] end_bits = {half[14:0], half[15]};

  always @(posedge clk) end_bit <= end_bits[end_index];

  reg  [48:0] u;
  reg         u_carry;
  wire [16:0] u_sum = {1'b0, u[15:0]} + {1'b0, half} + {16'd0, u_carry};

  assign progress = u[48:16];

  always @(posedge clk) begin
    if (u_move) u[47:0] <= {u_load ? half : u_sum[15:0], u[47:16]};
    if (u_move && u_load) u[48] <= mirror;
    else if (u_move && u_last) u[48] <= u[48] ^ mirror ^ u_sum[16];
    u_carry <= u_move && !u_load && !u_last ? u_sum[16] : mirror;
  end

  reg  [15:0] ticks_low;
  reg  [15:0] ticks_high;
  reg         ticks_carry;
  wire [16:0] ticks_low_sum = {1'b0, ticks_low} + 17'd1;
  wire [16:0] ticks_high_sum = {1'b0, ticks_high} + {16'd0, ticks_carry};

  always @(posedge clk) begin
    ticks_carry <= ticks_add_low & ticks_low_sum[16];
    if (ticks_load_low) ticks_low <= half;
    else if (ticks_add_low) ticks_low <= ticks_low_sum[15:0];
    if (ticks_load_high) ticks_high <= half;
    else if (ticks_add_high) {over, ticks_high} <= ticks_high_sum;
  end

endmodule
`resetall
