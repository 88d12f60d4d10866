// SPDX-License-Identifier: MIT
// E-stop: a latch on an asynchronous input.
//
// Promise: `pressed` becomes 1 asynchronously when `estop_n` falls and stays 1 until `clear` (or rst) while `estop_n`
// has been high for at least two clocks. `stop` is `pressed`, synchronized: 2 clocks later. From configuration until
// the first reset it is pressed: the latch powers up to the value that its asynchronous input sets, because some FPGAs
// have one value for both.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_estop (
  input  wire clk,
  input  wire rst,
  input  wire estop_n,
  input  wire clear,
  output reg  pressed,
  output wire stop
);

  reg [1:0] released;  // synchronized: estop_n is high
  (* async_reg = "true" *)
  reg [1:0] seen;

  assign stop = seen[1];

  always @(posedge clk or negedge estop_n)
    if (!estop_n) released <= 2'b00;
    else released <= {released[0], 1'b1};

  always @(posedge clk or negedge estop_n)
    if (!estop_n) pressed <= 1'b1;
    else if (released[1] && (clear || rst)) pressed <= 1'b0;

  always @(posedge clk) seen <= {seen[0], pressed};

  initial begin
    pressed  = 1'b1;
    released = 2'b00;
    seen     = 2'b11;
  end

`ifdef FORMAL
  `include "passo_estop_formal.vh"
`endif

endmodule
`resetall
