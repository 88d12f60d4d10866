// SPDX-License-Identifier: MIT
// Simple dual-port RAM that maps to block RAM everywhere, with an output register.
//
// Promise: `read_data` is the word that `read_address` selected one clock before the last `load`. Without
// DATA_REGISTER it is the word that `read_address` selected one clock ago, and `load` is ignored. A word read in the
// clock in which it is written is undefined; nothing here uses it, so synthesis need not add a bypass.
//
// Many block RAMs have such a register built in and are slow without it; elsewhere it takes logic cells.
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
