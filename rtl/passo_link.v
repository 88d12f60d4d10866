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
// When the CRC is right, nobody objected, no state forbids it (`bus_busy`) and the sequence number is new, the buffer is
// replayed to the bus (`bus_write`), one word every 4 clocks. `bus_commit` is high from 35 clocks before the verdict
// until a clock after the last word: meanwhile the targets keep `bus_busy` as it is. A frame may begin meanwhile; it is ignored if its header is complete
// before the replay has ended, which takes a master that leaves out trailing words.
//
// Verdict: BAD_CRC has priority, then the first objection, then BAD_LENGTH of a push that is not whole, then BUSY; a
// duplicate is not asked for objections.
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

  localparam [7:0] PAYLOAD_MAX = 8'd60;

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

  // What is done with a word takes a run of clocks: load it, turn it, judge it, act on it, rest. A run begins with
  // a clock of its own, begin_*.
  localparam [6:0] COUNT_READ = 7'd13;
  localparam [6:0] COUNT_LOAD = 7'd28;
  localparam [6:0] COUNT_LOADED = 7'd31;
  localparam [6:0] COUNT_TURN = 7'd32;  // .. 63
  localparam [6:0] COUNT_ACT = 7'd65;
  localparam [6:0] COUNT_REST = 7'd67;

  reg  [6:0] count;
  wire       rests = count[6] & count[1] & count[0];
  reg        act;  // in the clock of COUNT_ACT
  reg        begin_read;
  reg        begin_load;
  reg        begin_turn;
  reg        begin_rest;
  reg        load_ends;  // in the last clock but one before the word is there
  reg        load;
  reg        answered;  // in the clock of COUNT_LOADED
  reg        put;
  reg        replies;  // the reply turns along
  wire       turn = count[5];
  wire       word_valid = half_valid & half_low;

  // What is kept of the header; all of it stands in the payload buffer, too.
  reg is_read;
  reg [7:0] length;
  reg [7:0] index;  // payload word
  reg first_word;  // index is 0, and was
  reg all_words;  // index is length, and was; not yet in the clock after act
  reg frame_waits;  // a frame has begun during the replay
  wire frame_goes_on = (frame_waits || frame_start) && !frame_end && !word_valid;  // has its header to come

  // What the header amounts to, found out before it turns
  wire [3:0] operation = bus_data[31:28];
  reg        sequence_known;  // something was executed since reset
  reg        header_is_read;
  reg        header_is_known;
  reg        header_is_empty;
  reg        header_fits;
  reg        header_repeats;
  reg  [3:0] header_verdict;
  reg        header_ok;

  always @(posedge clk) begin
    if (!turn) begin
      header_is_read <= operation == OPERATION_READ;
      header_is_known <= operation == OPERATION_READ || operation == OPERATION_WRITE || operation == OPERATION_PUSH;
      header_is_empty <= bus_data[19:12] == 8'd0;
      header_fits <= bus_data[19:12] <= PAYLOAD_MAX;
      header_repeats <= sequence_known && bus_data[27:20] == last_sequence;
    end
    header_verdict <= !header_is_known                   ? VERDICT_BAD_OPERATION :
                      header_is_empty || !header_fits    ? VERDICT_BAD_LENGTH :
                      header_repeats && !header_is_read  ? VERDICT_DUPLICATE : VERDICT_OK;
    header_ok <= header_is_known && !header_is_empty && header_fits && (!header_repeats || header_is_read);
  end

  // The answer to a strobe arrives one clock after the bus shows the strobe, and is judged in the next.
  reg       answer_due;
  reg       answer_came;
  reg [3:0] answer;
  reg       objects;  // it is not OK

  // Behind the payload, the buffer has a place for the header, one for whatever is not kept, and two for the
  // counters of refusals; these read as 0 until one of the word has counted.
  wire       uses_counters = in_read | in_count;
  reg  [3:0] verdict;
  reg        verdict_ok;
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
  reg  crc_wrong;

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

  // What the verdict would be now
  reg [3:0] verdict_final;
  reg       executes;  // it is OK

  always @(posedge clk) begin
    verdict_final <=
        crc_wrong              ? VERDICT_BAD_CRC :
        !verdict_ok            ? verdict :
        bus_incomplete         ? VERDICT_BAD_LENGTH :
        bus_busy               ? VERDICT_BUSY : VERDICT_OK;
    verdict_high <= verdict >= VERDICT_READ_ONLY;
    counters_high <= in_ack | in_count ? verdict_high : bus_address[0];
    executes <= !crc_wrong && verdict_ok && !bus_incomplete && !bus_busy;
  end

  // Chip select does not come between a verdict and what it promises.
  wire goes_through = in_replay | in_count | (in_ack & act);
  wire frame_breaks = (frame_end | frame_start) & ~goes_through;
  wire reads = is_read & executes;
  wire objection = answered & first_word & objects;
  wire reply_taken = in_read & word_valid;  // a word has ended

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

    if (begin_rest) count <= COUNT_REST;
    else if (begin_read) count <= COUNT_READ;
    else if (begin_turn) count <= COUNT_TURN;
    else if (begin_load) count <= COUNT_LOAD;
    else if (!rests) count <= count + 7'd1;

    if (rst) begin
      {in_header, in_payload, in_crc, in_ack, in_replay, in_read, in_sum, in_count} <= 8'd0;
      {begin_load, begin_read, begin_turn, begin_rest}                              <= 4'd0;

      frame_waits <= 1'b0;
      count       <= COUNT_REST;
    end
  end

  always @(posedge clk) begin
    act <= count == COUNT_ACT - 7'd1 && !begin_rest && !frame_breaks;
    load <= (count == COUNT_LOAD && !(in_replay && all_words)) || (count == COUNT_LOAD + 7'd1 && !begin_rest);
    load_ends <= count == COUNT_LOADED - 7'd2;
    answered <= in_read && load_ends && !frame_breaks;
    first_word <= index == 8'd0;
    all_words <= index == length && !act;
    put <= in_count && (count == COUNT_ACT - 7'd1 || count == COUNT_TURN + 7'd15);
    replies <= in_ack | in_read | in_sum;
    bus_frame <= act & (in_header | (in_ack & verdict_ok));
    bus_commit <= (in_crc & ~rests) | in_ack | in_replay;
    bus_check <= act & in_payload;
    bus_write <= in_replay && count == COUNT_LOADED;
    bus_read <= in_read && count == COUNT_LOAD && !frame_end;
    answer_due <= bus_check;
    answer_came <= answer_due;
    answer <= bus_claim ? bus_refusal : VERDICT_UNKNOWN_ADDRESS;
    objects <= !bus_claim || bus_refusal != VERDICT_OK;
    crc_wrong <= !in_header && (crc_wrong || (in_crc && turn && crc_top != bus_data[31]));

    if (in_header && act) begin
      is_read  <= header_is_read;
      bus_push <= operation == OPERATION_PUSH;
      length   <= bus_data[19:12];
    end

    if (in_header && act) {verdict_ok, verdict} <= {header_ok, header_verdict};
    else if (in_crc && act) {verdict_ok, verdict} <= {executes, verdict_final};
    else if ((answer_came || objection) && verdict_ok) {verdict_ok, verdict} <= {~objects, answer};

    if (in_ack && act && verdict_ok) begin
      last_sequence  <= bus_data[27:20];
      sequence_known <= 1'b1;
    end
    if (in_count && act) counted[counters_high] <= 1'b1;

    if (act && (in_header || in_crc || in_ack)) index <= 8'd0;
    else if ((act && (in_payload || in_read)) || (in_replay && load_ends)) index <= index + 8'd1;

    // after header and ack the header has turned: it stands on the bus
    if (act && (in_header || in_ack)) bus_address <= bus_data[11:0];
    else if (((bus_check || bus_write) && !bus_push) || (act && in_read)) bus_address <= bus_address + 12'd1;

    if (rst) begin
      act            <= 1'b0;
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
      answer_due     <= 1'b0;
      answer_came    <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_link_formal.vh"
`endif

endmodule
`resetall
