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
// Blocks: passo_link_states sequences the frame and times each word, passo_link_frame stores the words, checks them and
// generates the bus accesses and the reply.
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

  wire header_is_read;
  wire header_is_empty;

  wire [3:0] verdict;
  wire       verdict_ok;
  wire       executes;
  wire       objection;

  wire is_read;
  wire all_words;

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

  passo_link_frame u_frame (
    .clk            (clk),
    .rst            (rst),
    .frame_start    (frame_start),
    .frame_end      (frame_end),
    .half_valid     (half_valid),
    .half_low       (half_low),
    .half           (half),
    .reply_word     (reply_word),
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
    .half_rotated   (half_rotated),
    .is_read        (is_read),
    .all_words      (all_words),
    .header_is_read (header_is_read),
    .header_is_empty(header_is_empty),
    .verdict        (verdict),
    .verdict_ok     (verdict_ok),
    .executes       (executes),
    .objection      (objection),
    .last_sequence  (last_sequence),
    .bus_frame      (bus_frame),
    .bus_commit     (bus_commit),
    .bus_check      (bus_check),
    .bus_write      (bus_write),
    .bus_read       (bus_read),
    .bus_push       (bus_push),
    .bus_address    (bus_address),
    .bus_data       (bus_data),
    .bus_msb        (bus_msb),
    .bus_one_hot    (bus_one_hot),
    .bus_claim      (bus_claim),
    .bus_refusal    (bus_refusal),
    .bus_read_data  (bus_read_data),
    .bus_counters   (bus_counters),
    .bus_incomplete (bus_incomplete),
    .bus_busy       (bus_busy)
  );

`ifdef FORMAL
  `include "passo_link_formal.vh"
`endif

endmodule
`resetall
