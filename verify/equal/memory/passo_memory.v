// SPDX-License-Identifier: MIT
// The memory as the proofs of equality see it, in the place of rtl/passo_memory.v: one address, `probe`, keeps its
// word; every other one, and a word that is being written, reads as anything. A proof holds for any `probe`, and so
// for all. That the memory keeps the words of all addresses is proved of rtl/passo_memory.v (docs/formal.md).
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_memory #(
  parameter WIDTH         = 16,
  parameter DEPTH_LOG2    = 8,
  parameter DATA_REGISTER = 1
) (
  input  wire                  clk,
  input  wire                  write,
  input  wire [DEPTH_LOG2-1:0] write_address,
  input  wire [     WIDTH-1:0] write_data,
  input  wire [DEPTH_LOG2-1:0] read_address,
  input  wire                  load,
  output wire [     WIDTH-1:0] read_data
);

  (* anyconst *) reg [DEPTH_LOG2-1:0] probe;
  (* anyseq *) reg [WIDTH-1:0] anything;
  reg [WIDTH-1:0] kept;  // at `probe`
  reg [WIDTH-1:0] word;

  wire writes = write && write_address == probe;

  always @(posedge clk) begin
    if (writes) kept <= write_data;
    word <= read_address == probe && !writes ? kept : anything;
  end

  generate
    if (DATA_REGISTER != 0) begin : g_register
      reg [WIDTH-1:0] data;
      always @(posedge clk) if (load) data <= word;
      assign read_data = data;
    end else begin : g_direct
      wire unused_load = load;
      assign read_data = word;
    end
  endgenerate

endmodule
`resetall
