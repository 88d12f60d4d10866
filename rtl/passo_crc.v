// SPDX-License-Identifier: MIT
// CRC-32/MPEG-2, one bit per clock: polynomial 0x04C11DB7, start 0xFFFFFFFF, MSB first, no final inversion.
// The CRC unit of an STM32F103 computes the same over 32-bit words.
//
// Promise: a clock of `shift` takes in `data`. With `rotate` it rotates the CRC by one bit instead, so that 32 clocks
// show the CRC at `top`, bit by bit, and leave it unchanged. `restart` starts over and has priority over a shift.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_crc (
  input  wire clk,
  input  wire restart,
  input  wire shift,
  input  wire rotate,
  input  wire data,
  output wire top
);

  localparam [31:0] POLYNOMIAL = 32'h04C11DB7;

  reg  [31:0] crc;
  wire        feedback = ~rotate & (crc[31] ^ data);

  assign top = crc[31];

  always @(posedge clk) begin
    if (shift) crc <= {crc[30:0], rotate & crc[31]} ^ (feedback ? POLYNOMIAL : 32'd0);
    if (restart) crc <= 32'hFFFF_FFFF;
  end

`ifdef FORMAL
  `include "passo_crc_formal.vh"
`endif

endmodule
`resetall
