// SPDX-License-Identifier: MIT
// Verdict: what is to be said of the frame that is received. BAD_CRC has priority, then what the header decode says, then
// the first objection of a target, then BAD_LENGTH of a push that is not whole, then BUSY.
//
// Promise: `header` and `conclude` are strobes; a clock after them `verdict` is what the header decode says, and what is said of
// the whole frame. Between them the first objection to a word counts: the answer to `bus_check` comes a clock after the bus
// shows it, and is judged in the next; that to the first word of a read is there in the clock of `read_answered`.
// `verdict_ok` says that the verdict is OK, `executes` that it would be now if the frame ended here.
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
  input  wire       in_header,       // nothing is wrong with the CRC yet
  input  wire       crc_differs,     // a bit of the CRC that has come
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
  reg       objects;  // it is not OK
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
