// SPDX-License-Identifier: MIT
// In place of the host interface, for the proofs of the bus fronts: it answers when it likes, and what comes in continues
// to the core and comes back.
`default_nettype none

module passo_words (
  input  wire        clk,
  input  wire        rst,
  input  wire        request,
  input  wire        write,
  input  wire        address,
  input  wire [ 3:0] lanes,
  input  wire [31:0] write_data,
  output reg         done,
  output reg         error,
  output wire [31:0] read_data,
  output wire        frame_start,
  output wire        frame_end,
  output wire        half_valid,
  output wire        half_low,
  output wire [15:0] half,
  input  wire [31:0] reply_word
);
  (* anyseq *) wire answers;
  assign {frame_start, frame_end, half_valid, half_low} = lanes;
  assign half      = write_data[31:16];
  assign read_data = reply_word ^ {20'd0, write_data[7:0], 1'b0, request, write, address};
  always @(posedge clk) begin
    done  <= ~rst & request & ~done & answers;
    error <= write_data[15] ^ address;
  end
endmodule
