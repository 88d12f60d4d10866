// SPDX-License-Identifier: MIT
// As passo_memory.v here, but for the memory of passo_positions: all words of one axis are kept, those whose address
// is `probe` in bits 3:1. `kept` n is that with the bits {5:4, 0} = n.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_memory #(
  parameter WIDTH         = 16,
  parameter DEPTH_LOG2    = 6,
  parameter DATA_REGISTER = 1
) (
  input  wire                  clk,
  input  wire                  write,
  input  wire [DEPTH_LOG2-1:0] write_address,
  input  wire [     WIDTH-1:0] write_data,
  input  wire [DEPTH_LOG2-1:0] read_address,
  input  wire                  load,
  output reg  [     WIDTH-1:0] read_data
);

  (* anyconst *) reg [2:0] probe;
  (* anyseq *) reg [WIDTH-1:0] anything;
  reg [WIDTH-1:0] word;

  wire [2:0] writes = {write_address[5:4], write_address[0]};
  wire [2:0] reads = {read_address[5:4], read_address[0]};
  wire [WIDTH-1:0] row[0:7];

  genvar n;
  generate
    for (n = 0; n < 8; n = n + 1) begin : g_word
      reg [WIDTH-1:0] kept;
      assign row[n] = kept;
      always @(posedge clk) if (write && write_address[3:1] == probe && writes == n) kept <= write_data;
    end
  endgenerate

  always @(posedge clk) begin
    word <= read_address[3:1] == probe && !(write && write_address == read_address) ? row[reads] : anything;
    if (load) read_data <= word;
  end

endmodule
`resetall
