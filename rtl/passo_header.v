// SPDX-License-Identifier: MIT
// Header decode: what the header of a frame requests, and whether it is valid.
//
// Promise: two clocks after `hold` rises, the outputs describe the header that was in `data` one clock before it
// rose. They are stable while `hold`.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_header (
  input  wire         clk,
  input  wire         hold,            // the header rotates
  input  wire [31:12] data,
  input  wire         sequence_known,  // a frame was executed since reset
  input  wire [  7:0] last_sequence,
  output reg          is_read,
  output reg          is_empty,        // length 0
  output reg          ok,              // the verdict is OK
  output reg  [  3:0] verdict
);

  `include "passo_registers.vh"

  localparam [7:0] PAYLOAD_MAX = 8'd60;

  wire [3:0] operation = data[HEADER_OPERATION_LSB+:HEADER_OPERATION_BITS];
  wire [7:0] sequence_number = data[HEADER_SEQUENCE_LSB+:HEADER_SEQUENCE_BITS];
  wire [7:0] length = data[HEADER_LENGTH_LSB+:HEADER_LENGTH_BITS];
  reg        is_known;
  reg        fits;
  reg        repeats;

  always @(posedge clk) begin
    if (!hold) begin
      is_read  <= operation == OPERATION_READ;
      is_known <= operation == OPERATION_READ || operation == OPERATION_WRITE || operation == OPERATION_PUSH;
      is_empty <= length == 8'd0;
      fits     <= length <= PAYLOAD_MAX;
      repeats  <= sequence_known && sequence_number == last_sequence;
    end
    verdict <= !is_known            ? VERDICT_BAD_OPERATION :
               is_empty || !fits    ? VERDICT_BAD_LENGTH :
               repeats && !is_read  ? VERDICT_DUPLICATE : VERDICT_OK;
    ok <= is_known && !is_empty && fits && (!repeats || is_read);
  end

endmodule
`resetall
