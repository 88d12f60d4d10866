// SPDX-License-Identifier: MIT
// Words of a frame: their buffer, CRC, header, verdict and bus accesses, the reject counters, and the words of the
// reply. The states of the link say which word it is, and its clock.
//
// Promise: the words that the states let through are on the bus as they were stored, at their addresses; `verdict` is
// that of the frame so far; `reply_word` is the word of the reply that the state asks for.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_frame (
  input  wire        clk,
  input  wire        rst,
  // host interface
  input  wire        frame_start,
  input  wire        frame_end,
  input  wire        half_valid,
  input  wire        half_low,
  input  wire [15:0] half,
  output wire [31:0] reply_word,
  // states
  input  wire        in_header,
  input  wire        in_payload,
  input  wire        in_crc,
  input  wire        in_ack,
  input  wire        in_replay,
  input  wire        in_read,
  input  wire        in_sum,
  input  wire        in_count,
  input  wire        frame_breaks,
  // clock of the word
  input  wire [ 6:0] count,
  input  wire        rotate,
  input  wire        rests,
  input  wire        begin_load,
  input  wire        load,
  input  wire        load_ends,
  input  wire        act,
  input  wire        half_rotated,
  // what is known of the frame
  output wire        is_read,
  output wire        all_words,        // the payload, or the reply, is whole
  output wire        header_is_read,
  output wire        header_is_empty,
  output wire [ 3:0] verdict,
  output wire        verdict_ok,
  output wire        executes,         // the verdict would be OK if the frame ended now
  output wire        objection,
  output wire [ 7:0] last_sequence,
  // bus
  output wire        bus_frame,
  output wire        bus_commit,
  output wire        bus_check,
  output wire        bus_write,
  output wire        bus_read,
  output wire        bus_push,
  output wire [11:0] bus_address,
  output wire [31:0] bus_data,
  output wire [ 4:0] bus_msb,
  output wire        bus_one_hot,
  input  wire        bus_claim,
  input  wire [ 3:0] bus_refusal,
  input  wire [31:0] bus_read_data,
  input  wire        bus_counters,
  input  wire        bus_incomplete,
  input  wire        bus_busy
);

  `include "passo_registers.vh"

  wire       header_ok;
  wire [3:0] header_verdict;
  wire [5:0] index;  // payload word
  wire       first_word;
  wire       sequence_known;

  passo_link_bus u_bus (
    .clk           (clk),
    .rst           (rst),
    .in_header     (in_header),
    .in_payload    (in_payload),
    .in_crc        (in_crc),
    .in_ack        (in_ack),
    .in_replay     (in_replay),
    .in_read       (in_read),
    .count         (count),
    .rests         (rests),
    .load_ends     (load_ends),
    .act           (act),
    .frame_end     (frame_end),
    .verdict_ok    (verdict_ok),
    .data          (bus_data),
    .is_read       (is_read),
    .index         (index),
    .first_word    (first_word),
    .all_words     (all_words),
    .sequence_known(sequence_known),
    .last_sequence (last_sequence),
    .bus_frame     (bus_frame),
    .bus_commit    (bus_commit),
    .bus_check     (bus_check),
    .bus_write     (bus_write),
    .bus_read      (bus_read),
    .bus_push      (bus_push),
    .bus_address   (bus_address)
  );

  passo_header u_header (
    .clk           (clk),
    .hold          (rotate),
    .data          (bus_data[31:12]),
    .sequence_known(sequence_known),
    .last_sequence (last_sequence),
    .is_read       (header_is_read),
    .is_empty      (header_is_empty),
    .ok            (header_ok),
    .verdict       (header_verdict)
  );

  // Behind the payload the buffer holds the header, one scratch word (also the CRC), and two words of refusal
  // counters, each of which reads as 0 until one of its counters has counted.
  reg        put;
  wire       uses_counters = in_read | in_count;
  reg        verdict_high;  // verdict >= READ_ONLY
  reg  [1:0] counted;
  reg        counters_high;
  wire [1:0] counter = verdict[1:0] - VERDICT_BAD_CRC[1:0];
  wire [1:0] place = uses_counters ? {1'b1, counters_high} : {1'b0, in_crc};
  wire       counter_bit;

  passo_payload u_payload (
    .clk        (clk),
    .store      (half_valid),
    .store_word (in_payload ? {1'b0, index} : {6'b100000, ~(in_header | in_replay)}),
    .store_low  (half_low),
    .half       (half),
    .put        (put),
    .put_word   ({6'b100001, counters_high}),
    .put_low    (act),
    .load       (load),
    .load_word  (in_payload || in_replay ? {1'b0, index} : {5'b10000, place}),
    .load_low   (~begin_load & ~count[0]),
    .load_zero  (uses_counters && !counted[counters_high]),
    .rotate     (rotate),
    .bit_index  (count[4:0]),
    .count      (in_count),
    .counter    (counter),
    .data       (bus_data),
    .msb        (bus_msb),
    .one_hot    (bus_one_hot),
    .counter_bit(counter_bit)
  );

  reg answered;  // high in COUNT_LOADED of a read
  reg replies;  // the reply rotates, too

  // CRC of the request; that of a read's header continues as the CRC of the reply
  wire crc_top;
  wire reply_top;

  passo_crc u_crc (
    .clk    (clk),
    .restart(load & in_header),
    .shift  (rotate),
    .rotate (in_crc | in_sum),
    .data   (in_read ? reply_top : bus_data[31]),
    .top    (crc_top)
  );

  passo_reply u_reply (
    .clk        (clk),
    .rst        (rst),
    .take       (frame_start || answered),
    .data       (bus_read_data),
    .shift      (rotate && replies),
    .bit_index  (count[4:0]),
    .acknowledge(in_ack),
    .header_11  (bus_data[11]),
    .header_27  (bus_data[27]),
    .verdict    (verdict),
    .crc_next   (in_sum),
    .crc_top    (crc_top),
    .counters   (in_read & bus_counters),
    .counter_bit(counter_bit),
    .word       (reply_word),
    .top        (reply_top)
  );

  passo_verdict u_verdict (
    .clk           (clk),
    .rst           (rst),
    .header        (in_header & act),
    .header_ok     (header_ok),
    .header_verdict(header_verdict),
    .in_header     (in_header),
    .crc_differs   (in_crc & rotate & (crc_top != bus_data[31])),
    .conclude      (in_crc & act),
    .read_answered (answered & first_word),
    .bus_check     (bus_check),
    .bus_claim     (bus_claim),
    .bus_refusal   (bus_refusal),
    .bus_incomplete(bus_incomplete),
    .bus_busy      (bus_busy),
    .verdict       (verdict),
    .verdict_ok    (verdict_ok),
    .executes      (executes),
    .objection     (objection)
  );

  always @(posedge clk) begin
    answered      <= in_read && load_ends && !frame_breaks;
    replies       <= in_ack | in_read | in_sum;
    put           <= in_count && half_rotated;
    verdict_high  <= verdict >= VERDICT_READ_ONLY;
    counters_high <= in_ack | in_count ? verdict_high : bus_address[0];
    if (in_count && act) counted[counters_high] <= 1'b1;
    if (rst) begin
      answered <= 1'b0;
      counted  <= 2'b00;
    end
  end

endmodule
`resetall
