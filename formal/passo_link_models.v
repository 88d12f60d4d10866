// SPDX-License-Identifier: MIT
// CRC and reply as modelled in the proof of the link: their outputs are anything.
`resetall
`default_nettype none

module passo_crc (
  input  wire clk,
  input  wire restart,
  input  wire shift,
  input  wire rotate,
  input  wire data,
  output wire top
);
  (* anyseq *) wire f_anything;
  assign top = f_anything;
endmodule

module passo_reply (
  input  wire        clk,
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
  output wire [31:0] word,
  output wire        top
);
  (* anyseq *) wire [32:0] f_anything;
  assign {word, top} = f_anything;
endmodule
`resetall
