// SPDX-License-Identifier: MIT
// Reply: the next word to send, loaded in parallel or built bit by bit.
//
// Promise: `take` loads `data`, in one clock. 32 clocks of `shift` with `bit_index` 0 .. 31 rotate the word and show
// it at `top`, bit by bit; or, with `acknowledge`, `crc_next` or `counters`, replace it by the acknowledge, the CRC
// or the counters, which `top` shows as they are shifted in.
// Acknowledge: sequence (31:24), verdict (23:16) and their complement. The header rotates meanwhile; its bits 27 and
// 11 show the sequence, twice.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_reply (
  input  wire        clk,
  input  wire        rst,
  input  wire        take,
  input  wire [31:0] data,
  input  wire        shift,
  input  wire [ 4:0] bit_index,
  input  wire        acknowledge,
  input  wire        header_11,
  input  wire        header_27,
  input  wire [ 3:0] verdict,
  input  wire        crc_next,
  input  wire        crc_top,
  input  wire        counters,
  input  wire        counter_bit,
  output reg  [31:0] word,
  output wire        top
);

  wire sequence_bit = bit_index[4] ? header_11 : header_27;
  wire verdict_bit = bit_index[2] & verdict[~bit_index[1:0]];
  wire acknowledge_bit = bit_index[4] ^ (bit_index[3] ? verdict_bit : sequence_bit);

  assign top = counters ? counter_bit : word[31];

  // at most one of them is high
  wire other = ~acknowledge & ~crc_next;
  wire next_bit = (acknowledge & acknowledge_bit) | (crc_next & crc_top) | (other & top);

  always @(posedge clk) begin
    if (shift) word <= {word[30:0], next_bit};
    if (take) word <= data;
    if (rst) word <= 32'd0;
  end

endmodule
`resetall
