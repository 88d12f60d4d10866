// SPDX-License-Identifier: MIT
// Link: words to frames to bus accesses, and the replies.
//
//   write, push  MOSI  header  payload x length    crc     0       0
//                MISO  status  status ...          status  status  ack
//   read         MOSI  header  crc     0       0 x length    0
//                MISO  status  status  status  data x length  crc
//
// Promise: a frame is executed whole or not at all, and only once. Each word is stored in the payload buffer and
// loaded from it onto the bus, where it rotates through the CRC and is checked by its target (`bus_check`). If the CRC
// matches, no target refuses a word, no state forbids the frame (`bus_busy`) and its sequence number is new, the
// buffer is replayed to the bus (`bus_write`), one word every 4 clocks. `bus_commit` is high from 35 clocks before the
// verdict until one clock after the last word; meanwhile the targets hold `bus_busy`. A frame may begin meanwhile; it
// is ignored if its header is complete before the replay ends, which happens if the master omits trailing words.
//
// Blocks: passo_link_states sequences the frame and times each word, passo_header decodes the header, passo_link_bus
// generates the bus accesses, passo_verdict checks the frame.
// Latency: payload word to bus_check 40 clocks, crc word to ack 77 clocks, to the first word of a read 91 clocks.
// Address and data are stable on the bus from one clock before their strobe (of a check: two clocks), data to one
// clock after it, the address of a read from 16 clocks before. A target answers one clock after a strobe with claim
// (address match) and refusal, and two clocks after bus_read with data; at all other times the read lines carry the
// status word.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link (
  input wire clk,
  input wire rst,
  // host interface
  input wire frame_start,
  input wire frame_end,
  input wire half_valid,
  input wire half_low,
  input wire [15:0] half,
  output wire [31:0] reply_word,
  output wire [7:0] last_sequence,  // of the last executed write or push
  // bus
  output wire bus_frame,  // strobe: a pass over the payload begins, to check or, in a commit, to write it
  output wire bus_commit,  // the frame is being checked or executed
  output wire bus_check,  // strobes
  output wire bus_write,
  output wire bus_read,
  output wire bus_push,  // the frame is a push
  output wire [11:0] bus_address,
  output wire [31:0] bus_data,
  output wire [4:0] bus_msb,  // of checked data: index of the highest set bit
  output wire bus_one_hot,  // no other bit is set
  input wire bus_claim,
  input wire [3:0] bus_refusal,
  input wire [31:0] bus_read_data,
  input wire bus_counters,  // the address is that of reject counters, which are kept here
  input wire bus_incomplete,  // the payload so far is not whole lines or ramps
  input wire bus_busy  // the state of a target forbids the frame
);

  `include "passo_registers.vh"
  `include "passo_link_schedule.vh"

  wire in_header;
  wire in_payload;
  wire in_crc;
  wire in_ack;
  wire in_replay;
  wire in_read;
  wire in_sum;
  wire in_count;
  wire frame_breaks;

  wire [6:0] count;  // clock of the word
  wire       rotate;
  wire       rests;
  wire       begin_load;
  wire       load;
  wire       load_ends;
  wire       act;
  wire       half_rotated;

  wire       header_is_read;
  wire       header_is_empty;
  wire       header_ok;
  wire [3:0] header_verdict;

  wire [3:0] verdict;
  wire       verdict_ok;
  wire       executes;
  wire       objection;

  wire       is_read;
  wire [5:0] index;  // payload word
  wire       first_word;
  wire       all_words;
  wire       sequence_known;

  passo_link_states u_states (
    .clk            (clk),
    .rst            (rst),
    .frame_start    (frame_start),
    .frame_end      (frame_end),
    .word_valid     (half_valid & half_low),
    .header_is_read (header_is_read),
    .header_is_empty(header_is_empty),
    .all_words      (all_words),
    .reads          (is_read & executes),
    .objection      (objection),
    .verdict_ok     (verdict_ok),
    .is_duplicate   (verdict == VERDICT_DUPLICATE),
    .in_header      (in_header),
    .in_payload     (in_payload),
    .in_crc         (in_crc),
    .in_ack         (in_ack),
    .in_replay      (in_replay),
    .in_read        (in_read),
    .in_sum         (in_sum),
    .in_count       (in_count),
    .frame_breaks   (frame_breaks),
    .count          (count),
    .rotate         (rotate),
    .rests          (rests),
    .begin_load     (begin_load),
    .load           (load),
    .load_ends      (load_ends),
    .act            (act),
    .half_rotated   (half_rotated)
  );

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

`ifdef FORMAL
  `include "passo_link_formal.vh"
`endif

endmodule
`resetall
