// SPDX-License-Identifier: MIT
// Simple dual-port RAM that maps to block RAM everywhere.
//
// Promise: `read_data` is the word at `read_address` one clock ago, unless that word was being written on
// that clock; then it means nothing. Nobody here looks at a word in that clock, so synthesis need not guard
// against it.
`resetall
`default_nettype none

module passo_memory #(
  parameter WIDTH      = 16,
  parameter DEPTH_LOG2 = 8
) (
  input  wire                  clk,
  input  wire                  write,
  input  wire [DEPTH_LOG2-1:0] write_address,
  input  wire [     WIDTH-1:0] write_data,
  input  wire [DEPTH_LOG2-1:0] read_address,
  output reg  [     WIDTH-1:0] read_data
);

  (* no_rw_check *)
  reg [WIDTH-1:0] words[0:(1<<DEPTH_LOG2)-1];

  always @(posedge clk) begin
    if (write) words[write_address] <= write_data;
    read_data <= words[read_address];
  end

`ifdef FORMAL
  `include "passo_memory_formal.vh"
`endif

endmodule
`resetall
