// SPDX-License-Identifier: MIT
// Following error: how far the encoder is behind the steps, in counts.
//
//   a step: error += ratio, a count: error -= 1.0;  with opposite signs in the other direction
//
// So error = position * ratio - count since `zero`, exactly, without a division. It is stored as s18.16.
//
// Promise: `exceeded` is high 4 clocks after a step or count has brought the error to `limit` or above, or below
// -limit. `greatest` is the largest whole number of counts, either way, since `zero` or `clear`. An error of 2^16
// counts saturates: it then stays constant and `exceeded` until `zero`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_following (
  input  wire        clk,
  input  wire        rst,
  input  wire        zero,            // the error is 0 now
  input  wire        clear,           // forgets `greatest`
  input  wire        step_made,
  input  wire        step_direction,  // 1 = negative
  input  wire        count_made,
  input  wire        count_down,
  input  wire [31:0] ratio,           // UQ16.16 counts per step
  input  wire [15:0] limit,           // counts
  output reg  [34:0] error,           // s18.16
  output reg         exceeded,
  output reg  [17:0] greatest
);

  // What the step and the count of a clock add: the steps as ratio or its inverse and a carry, the count above it
  reg  [34:0] change;
  reg         change_carry;
  wire        down = step_made & step_direction;
  wire [31:0] step = (ratio & {32{step_made}}) ^ {32{down}};
  wire [18:0] count = {{18{count_made & ~count_down}}, count_made};
  // 2^16 counts, whatever one more clock adds, is less than 2^18
  wire        off_scale = error[34:32] != 3'b000 && error[34:32] != 3'b111;

  // Counts, rounded toward 0 where the error is positive, else toward 0 of the error + 2^-16
  reg [17:0] magnitude;

  always @(posedge clk) begin
    change       <= {{{3{down}}, step[31:16]} + count, step[15:0]};
    change_carry <= down;
    if (!off_scale) error <= error + change + {34'd0, change_carry};
    magnitude <= error[33:16] ^ {18{error[34]}};
    exceeded  <= magnitude >= {2'd0, limit};
    if (magnitude > greatest) greatest <= magnitude;
    if (clear) greatest <= 18'd0;
    if (rst || zero) begin
      change       <= 35'd0;
      change_carry <= 1'b0;
      error        <= 35'd0;
      magnitude    <= 18'd0;
      exceeded     <= 1'b0;
      greatest     <= 18'd0;
    end
  end

`ifdef FORMAL
  `include "passo_following_formal.vh"
`endif

endmodule
`resetall
