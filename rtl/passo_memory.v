// SPDX-License-Identifier: MIT
// Simple dual-port RAM that maps to block RAM everywhere, and a register behind it.
//
// Promise: `read_data` is the word that `read_address` named a clock before the last `load`. Without
// DATA_REGISTER it is the word that `read_address` named a clock ago, and `load` means nothing. A word that is
// written in the clock in which it is read means nothing; nobody here looks at one, so synthesis need not
// guard against it.
//
// Many block RAMs have such a register of their own and are slow without it; elsewhere it takes cells.
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

  (* no_rw_check, ram_style = "block" *)
  reg [WIDTH-1:0] words[0:(1<<DEPTH_LOG2)-1];
  reg [WIDTH-1:0] word;

  always @(posedge clk) begin
    if (write) words[write_address] <= write_data;
    word <= words[read_address];
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

`ifdef FORMAL
  `include "passo_memory_formal.vh"
`endif

endmodule
`resetall
