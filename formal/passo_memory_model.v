// SPDX-License-Identifier: MIT
// Model of passo_memory for proofs: only one address, `f_address`, keeps its word (`f_word`); every other one, and a
// word being written, reads as anything. A proof leaves the address free: its script connects `f_address` and
// `f_word` by name.
`resetall
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

  (* keep *) wire [DEPTH_LOG2-1:0] f_address;
  (* keep *) reg [WIDTH-1:0] f_word;
  (* anyseq *) wire [WIDTH-1:0] f_anything;

  reg [WIDTH-1:0] word;

  wire f_written = write && write_address == f_address;

  always @(posedge clk) begin
    if (f_written) f_word <= write_data;
    word <= read_address == f_address && !f_written ? f_word : f_anything;
  end

  generate
    if (DATA_REGISTER != 0) begin : g_register
      reg [WIDTH-1:0] data;
      always @(posedge clk) if (load) data <= word;
      assign read_data = data;
    end else begin : g_direct
      assign read_data = word;
    end
  endgenerate

endmodule
`resetall
