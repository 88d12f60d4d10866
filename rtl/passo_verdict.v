// SPDX-License-Identifier: MIT
// Response code of the frame being received. BAD_CRC has priority, then the header decode, then the first check
// failure of a target, then BAD_LENGTH of a push that is not whole, then BUSY.
//
// Promise: one clock after the strobe `header`, `verdict` is that of the header decode; one clock after the strobe
// `conclude`, that of the whole frame. In between, the first check failure counts: the answer to `bus_check`
// comes one clock after the strobe and is evaluated in the next; that to the first word of a read is ready in
// `read_answered`. `verdict_ok`: the verdict is OK; `executes`: it would be OK if the frame ended now.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_verdict (
  input  wire       clk,
  input  wire       rst,
  // the frame
  input  wire       header,          // strobe: the header decode is done
  input  wire       header_ok,
  input  wire [3:0] header_verdict,
  input  wire       in_header,       // the CRC check starts over
  input  wire       crc_differs,     // a bit of the received CRC does
  input  wire       conclude,        // strobe: the frame is whole
  input  wire       read_answered,
  // targets
  input  wire       bus_check,
  input  wire       bus_claim,
  input  wire [3:0] bus_refusal,
  input  wire       bus_incomplete,
  input  wire       bus_busy,
  output reg  [3:0] verdict,
  output reg        verdict_ok,
  output reg        executes,
  output wire       objection        // to the first word of a read
);

  `include "passo_registers.vh"

  reg       crc_wrong;
  reg       answer_due;
  reg       answer_came;
  reg [3:0] answer;
  reg       objects;  // the answer is not OK
  reg [3:0] verdict_final;

  assign objection = read_answered & objects;

  always @(posedge clk) begin
    answer_due <= bus_check;
    answer_came <= answer_due;
    answer <= bus_claim ? bus_refusal : VERDICT_UNKNOWN_ADDRESS;
    objects <= !bus_claim || bus_refusal != VERDICT_OK;
    crc_wrong <= !in_header && (crc_wrong || crc_differs);
    verdict_final <= crc_wrong       ? VERDICT_BAD_CRC :
                     !verdict_ok     ? verdict :
                     bus_incomplete  ? VERDICT_BAD_LENGTH :
                     bus_busy        ? VERDICT_BUSY : VERDICT_OK;
    executes <= !crc_wrong && verdict_ok && !bus_incomplete && !bus_busy;

    if (header) {verdict_ok, verdict} <= {header_ok, header_verdict};
    else if (conclude) {verdict_ok, verdict} <= {executes, verdict_final};
    else if ((answer_came || objection) && verdict_ok) {verdict_ok, verdict} <= {~objects, answer};

    if (rst) begin
      answer_due  <= 1'b0;
      answer_came <= 1'b0;
    end
  end

endmodule
`resetall
