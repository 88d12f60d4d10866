// SPDX-License-Identifier: MIT
// Link: words to frames to bus accesses, and the replies.
//
//   write, push  MOSI  header  payload x length    crc     0       0
//                MISO  status  status ...          status  status  ack
//   read         MOSI  header  crc     0       0 x length    0
//                MISO  status  status  status  data x length  crc
//
// Promise: a frame is executed whole or not at all, and only once. Each word goes into the payload buffer and
// comes out of it onto the bus, where it turns through the CRC and is checked by its target (`bus_check`).
// When the CRC matches, no target objected, no state forbids the frame (`bus_busy`) and its sequence number is new, the
// buffer is replayed to the bus (`bus_write`), one word every 4 clocks. `bus_commit` is high from 35 clocks before the
// verdict until a clock after the last word; meanwhile the targets hold `bus_busy`. A frame may begin meanwhile. It is
// ignored if its header is complete before the replay has ended, which takes a master that omits trailing words.
//
// Rooms: passo_header decodes the header, passo_verdict judges the frame, passo_link_schedule times each word.
// Latency: payload word to bus_check 40 clocks, crc word to ack 77 clocks, to the first word of a read 91
// clocks. Address and data stand on the bus at least a clock before their strobe (of a check: two clocks),
// data a clock after it, the address of a read 16 clocks before. A target answers one clock after a strobe with
// claim (the address is mine) and refusal, and two clocks after bus_read with data; at all other times the status
// stands in the place of data.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link (
  input wire clk,
  input wire rst,
  // words from and to the SPI
  input wire frame_start,
  input wire frame_end,
  input wire half_valid,
  input wire half_low,
  input wire [15:0] half,
  output wire [31:0] reply_word,
  output reg [7:0] last_sequence,  // of the last write or push that was executed
  // bus
  output reg bus_frame,  // a pass over a frame's payload begins: to check or, in a commit, to write it
  output reg bus_commit,  // the frame is being judged or executed
  output reg bus_check,  // strobes
  output reg bus_write,
  output reg bus_read,
  output reg bus_push,  // the frame is a push
  output reg [11:0] bus_address,
  output wire [31:0] bus_data,
  output wire [4:0] bus_top_bit,  // of the data that are checked: highest bit that is set,
  output wire bus_lone_bit,  // and it is the only one
  input wire bus_claim,
  input wire [3:0] bus_refusal,
  input wire [31:0] bus_read_data,
  input wire bus_counters,  // the address is that of counters of refusals, which are kept here
  input wire bus_incomplete,  // the payload so far is not whole lines or ramps
  input wire bus_busy  // the state of a target does not allow the frame
);

  `include "passo_registers.vh"
  `include "passo_link_schedule.vh"

  // Steps, one bit each. Between frames, or when the rest of the frame means nothing, none is set.
  //
  //   write, push   header  payload  crc  ack  replay          refused   ack  count
  //   read          header           crc  read  sum            refused   as above, or read  ack  count
  reg in_header;
  reg in_payload;
  reg in_crc;
  reg in_ack;
  reg in_replay;
  reg in_read;  // fetch a word for the reply, wait until it has been taken
  reg in_sum;  // send the CRC of the reply
  reg in_count;  // count a refusal

  // Each word follows a fixed clock schedule.
  wire [6:0] count;
  wire       rests;
  wire       turn;
  wire       load;
  wire       load_ends;
  wire       act;
  wire       halves_turn;
  reg        begin_read;
  reg        begin_load;
  reg        begin_turn;
  reg        begin_rest;
  reg        answered;  // in the clock of COUNT_LOADED of a read
  reg        put;
  reg        replies;  // the reply turns along
  wire       word_valid = half_valid & half_low;

  // What is kept of the header; all of it stands in the payload buffer, too.
  reg is_read;
  reg [7:0] length;
  reg [7:0] index;  // payload word
  reg first_word;  // index is 0, and was
  reg all_words;  // index is length, and was; not yet in the clock after act
  reg frame_waits;  // a frame has begun during the replay
  wire frame_goes_on = (frame_waits || frame_start) && !frame_end && !word_valid;  // has its header to come

  // Header decode
  reg        sequence_known;  // something was executed since reset
  wire       header_is_read;
  wire       header_is_empty;
  wire       header_ok;
  wire [3:0] header_verdict;

  passo_header u_header (
    .clk           (clk),
    .hold          (turn),
    .data          (bus_data[31:12]),
    .sequence_known(sequence_known),
    .last_sequence (last_sequence),
    .is_read       (header_is_read),
    .is_empty      (header_is_empty),
    .ok            (header_ok),
    .verdict       (header_verdict)
  );

  wire [3:0] verdict;
  wire       verdict_ok;
  wire       executes;
  wire       objection;

  // Behind the payload, the buffer has a place for the header, one for whatever is not kept, and two for the
  // counters of refusals; these read as 0 until one of the word has counted.
  wire       uses_counters = in_read | in_count;
  reg        verdict_high;  // verdict is READ_ONLY or one after it
  reg  [1:0] counted;
  reg        counters_high;
  wire [1:0] counter = verdict[1:0] - VERDICT_BAD_CRC[1:0];
  wire [1:0] place = uses_counters ? {1'b1, counters_high} : {1'b0, in_crc};
  wire       counter_bit;
  wire       refuses = in_ack && act && !verdict_ok && verdict != VERDICT_DUPLICATE;

  passo_payload u_payload (
    .clk        (clk),
    .store      (half_valid),
    .store_word (in_payload ? {1'b0, index[5:0]} : {6'b100000, ~(in_header | in_replay)}),
    .store_low  (half_low),
    .half       (half),
    .put        (put),
    .put_word   ({6'b100001, counters_high}),
    .put_low    (act),
    .load       (load),
    .load_word  (in_payload || in_replay ? {1'b0, index[5:0]} : {5'b10000, place}),
    .load_low   (~begin_load & ~count[0]),
    .load_zero  (uses_counters && !counted[counters_high]),
    .turn       (turn),
    .turns      (count[4:0]),
    .count      (in_count),
    .counter    (counter),
    .data       (bus_data),
    .top_bit    (bus_top_bit),
    .lone_bit   (bus_lone_bit),
    .counter_bit(counter_bit)
  );

  // CRC of the request; that of a read's header goes on as the CRC of the reply
  wire crc_top;
  wire reply_top;

  passo_crc u_crc (
    .clk    (clk),
    .restart(load & in_header),
    .shift  (turn),
    .turn   (in_crc | in_sum),
    .data   (in_read ? reply_top : bus_data[31]),
    .top    (crc_top)
  );

  passo_reply u_reply (
    .clk        (clk),
    .rst        (rst),
    .take       (frame_start || answered),
    .data       (bus_read_data),
    .shift      (turn && replies),
    .turns      (count[4:0]),
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
    .crc_differs   (in_crc & turn & (crc_top != bus_data[31])),
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

  // A committed frame ignores chip select.
  wire goes_through = in_replay | in_count | (in_ack & act);
  wire frame_breaks = (frame_end | frame_start) & ~goes_through;
  wire reads = is_read & executes;
  wire reply_taken = in_read & word_valid;  // a word has ended

  passo_link_schedule u_schedule (
    .clk        (clk),
    .rst        (rst),
    .begin_read (begin_read),
    .begin_load (begin_load),
    .begin_turn (begin_turn),
    .begin_rest (begin_rest),
    .over       (in_replay & all_words),
    .breaks     (frame_breaks),
    .count      (count),
    .turn       (turn),
    .rests      (rests),
    .load       (load),
    .load_ends  (load_ends),
    .act        (act),
    .halves_turn(halves_turn)
  );

  always @(posedge clk) begin
    in_header <= (frame_start & ~goes_through) | (in_header & ~act & ~frame_breaks)
                 | (frame_goes_on & ((in_replay & all_words) | (in_count & act)));
    in_payload <= ((in_header & act & ~header_is_read & ~header_is_empty) | (in_payload & ~all_words)) & ~frame_breaks;
    in_crc <= ((in_header & act & (header_is_read | header_is_empty)) | (in_payload & all_words) | (in_crc & ~act))
              & ~frame_breaks;
    in_ack <= ((in_crc & act & ~reads) | (objection & ~(reply_taken & all_words)) | (in_ack & ~act)) & ~frame_breaks;
    in_replay <= (in_ack & act & verdict_ok) | (in_replay & ~all_words);
    in_read <= ((in_crc & act & reads) | (in_read & ~objection & ~(reply_taken & all_words))) & ~frame_breaks;
    in_sum <= ((reply_taken & all_words) | (in_sum & ~act)) & ~frame_breaks;
    in_count <= refuses | (in_count & ~act);
    frame_waits <= (in_replay | in_count) & frame_goes_on;

    begin_load <= (word_valid & (in_header | in_payload | in_crc)) | (in_crc & act & ~reads) | objection
                  | (in_ack & act & verdict != VERDICT_DUPLICATE)
                  | (in_replay & load_ends);
    begin_read <= (in_crc & act & reads) | (reply_taken & ~all_words);
    begin_turn <= reply_taken & all_words;
    begin_rest <= frame_breaks | (in_replay & all_words);

    if (rst) begin
      {in_header, in_payload, in_crc, in_ack, in_replay, in_read, in_sum, in_count} <= 8'd0;
      {begin_load, begin_read, begin_turn, begin_rest}                              <= 4'd0;

      frame_waits <= 1'b0;
    end
  end

  always @(posedge clk) begin
    answered      <= in_read && load_ends && !frame_breaks;
    first_word    <= index == 8'd0;
    verdict_high  <= verdict >= VERDICT_READ_ONLY;
    counters_high <= in_ack | in_count ? verdict_high : bus_address[0];
    all_words     <= index == length && !act;
    put           <= in_count && halves_turn;
    replies       <= in_ack | in_read | in_sum;
    bus_frame     <= act & (in_header | (in_ack & verdict_ok));
    bus_commit    <= (in_crc & ~rests) | in_ack | in_replay;
    bus_check     <= act & in_payload;
    bus_write     <= in_replay && count == COUNT_LOADED;
    bus_read      <= in_read && count == COUNT_LOAD && !frame_end;

    if (in_header && act) begin
      is_read  <= header_is_read;
      bus_push <= bus_data[HEADER_OPERATION_LSB+:HEADER_OPERATION_BITS] == OPERATION_PUSH;
      length   <= bus_data[HEADER_LENGTH_LSB+:HEADER_LENGTH_BITS];
    end

    if (in_ack && act && verdict_ok) begin
      last_sequence  <= bus_data[HEADER_SEQUENCE_LSB+:HEADER_SEQUENCE_BITS];
      sequence_known <= 1'b1;
    end
    if (in_count && act) counted[counters_high] <= 1'b1;

    if (act && (in_header || in_crc || in_ack)) index <= 8'd0;
    else if ((act && (in_payload || in_read)) || (in_replay && load_ends)) index <= index + 8'd1;

    // after header and ack the header has turned: it stands on the bus
    if (act && (in_header || in_ack)) bus_address <= bus_data[HEADER_ADDRESS_LSB+:HEADER_ADDRESS_BITS];
    else if (((bus_check || bus_write) && !bus_push) || (act && in_read)) bus_address <= bus_address + 12'd1;

    if (rst) begin
      answered       <= 1'b0;
      last_sequence  <= 8'd0;
      sequence_known <= 1'b0;
      counted        <= 2'b00;
      bus_frame      <= 1'b0;
      bus_commit     <= 1'b0;
      bus_push       <= 1'b0;
      bus_check      <= 1'b0;
      bus_write      <= 1'b0;
      bus_read       <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_link_formal.vh"
`endif

endmodule
`resetall
