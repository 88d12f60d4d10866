// SPDX-License-Identifier: MIT
// Filter of one encoder signal: synchronizer and glitch filter.
//
// Promise: `level` takes the level of the pin when the pin has had it for `length` + 1 clocks, 2 clocks late: a pulse
// of at most `length` clocks never passes, a longer one always does. A reset takes the level immediately.
// Latency: pin to `level` 3 + length clocks, to `sampled` 2.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_encoder_filter (
  input  wire       clk,
  input  wire       rst,
  input  wire       pin,
  input  wire [7:0] length,
  output wire       sampled,  // the pin, 2 clocks late
  output reg        level
);

  (* async_reg = "true" *)
  reg [1:0] sync;
  reg [7:0] count;  // clocks for which the pin has not been as `level`

  wire differs = sync[1] != level;
  wire accepted = count >= length;

  assign sampled = sync[1];

  always @(posedge clk) begin
    sync  <= {sync[0], pin};
    count <= differs && !accepted ? count + 8'd1 : 8'd0;
    if (differs && accepted) level <= sync[1];
    if (rst) begin
      count <= 8'd0;
      level <= sync[1];
    end
  end

  initial sync = 2'b00;

`ifdef FORMAL
  `include "passo_encoder_filter_formal.vh"
`endif

endmodule
`resetall
