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
// When the CRC is right, nobody objected and the sequence number is new, the buffer is replayed to the bus
// (`bus_write`), one word every 4 clocks. A frame may begin meanwhile; it is ignored if its header is complete
// before the replay has ended, which takes a master that leaves out trailing words.
//
// Verdict: BAD_CRC goes before all others, then the first objection; a duplicate is not asked for objections.
// Latency: payload word to bus_check 39 clocks, crc word to ack 75 clocks, to the first word of a read 91
// clocks. Address and data stand on the bus at least a clock before their strobe (of a check: two clocks),
// data a clock after it, the address of a read 16 clocks before. A target answers one clock after a strobe with claim (the address is
// mine), refusal and, to bus_read, data; at all other times the status stands in the place of data.
`resetall
`default_nettype none

module passo_link (
  input  wire        clk,
  input  wire        rst,
  // words from and to the SPI
  input  wire        frame_start,
  input  wire        frame_end,
  input  wire        half_valid,
  input  wire        half_low,
  input  wire [15:0] half,
  output wire [31:0] reply_word,
  output reg  [ 7:0] last_sequence,  // of the last write or push that was executed
  // bus
  output reg         bus_frame,      // a pass over a frame's payload begins
  output reg         bus_check,      // strobes
  output reg         bus_write,
  output reg         bus_read,
  output reg         bus_push,       // the frame is a push
  output reg  [11:0] bus_address,
  output wire [31:0] bus_data,
  output wire [ 4:0] bus_top_bit,    // of the data that are checked: highest bit that is set,
  output wire        bus_lone_bit,   // and it is the only one
  input  wire        bus_claim,
  input  wire [ 3:0] bus_refusal,
  input  wire [31:0] bus_read_data,
  input  wire        bus_counters,   // the address is that of counters of refusals, which are kept here
  input  wire        bus_incomplete  // the payload so far is not whole lines or ramps
);

  `include "passo_registers.vh"

  localparam [7:0] PAYLOAD_MAX = 8'd60;

  localparam [3:0] STEP_IDLE = 4'd0;  // between frames, or the rest of the frame means nothing
  localparam [3:0] STEP_HEADER = 4'd1;
  localparam [3:0] STEP_PAYLOAD = 4'd2;
  localparam [3:0] STEP_CRC = 4'd3;
  localparam [3:0] STEP_ACK = 4'd4;
  localparam [3:0] STEP_REPLAY = 4'd5;
  localparam [3:0] STEP_READ = 4'd6;  // fetch a word for the reply, wait until it has been taken
  localparam [3:0] STEP_SUM = 4'd7;  // send the CRC of the reply
  localparam [3:0] STEP_COUNT = 4'd8;  // count a refusal

  // What is done with a word takes a run of clocks: load it, turn it, judge it, act on it, rest.
  localparam [5:0] COUNT_ACT = 6'd1;
  localparam [5:0] COUNT_REST = 6'd3;
  localparam [5:0] COUNT_READ = 6'd12;
  localparam [5:0] COUNT_LOAD = 6'd28;
  localparam [5:0] COUNT_ANSWER = 6'd30;
  localparam [5:0] COUNT_LOADED = 6'd31;
  localparam [5:0] COUNT_TURN = 6'd32;  // .. 63

  reg  [3:0] step;
  reg  [5:0] count;
  reg        act;  // in the clock of COUNT_ACT
  reg        half_turned;
  reg        replies;  // the reply turns along
  wire       load = count == COUNT_LOAD + 6'd1 || count == COUNT_LOAD + 6'd2;
  wire       answered = step == STEP_READ && count == COUNT_ANSWER;
  wire       turn = count[5];
  wire       word_valid = half_valid & half_low;

  // What is kept of the header; all of it stands in the payload buffer, too.
  reg is_read;
  reg [7:0] length;
  reg [7:0] index;  // payload word
  wire all_words = index == length;
  reg frame_waits;  // a frame has begun during the replay
  wire frame_goes_on = (frame_waits || frame_start) && !frame_end && !word_valid;  // has its header to come

  // What the header amounts to, a clock before it is acted on
  wire [3:0] operation = bus_data[31:28];
  reg        sequence_known;  // something was executed since reset
  reg        header_is_read;
  reg        header_is_known;
  reg        header_is_empty;
  reg        header_fits;
  reg        header_repeats;

  always @(posedge clk) begin
    header_is_read <= operation == OPERATION_READ;
    header_is_known <= operation == OPERATION_READ || operation == OPERATION_WRITE || operation == OPERATION_PUSH;
    header_is_empty <= bus_data[19:12] == 8'd0;
    header_fits <= bus_data[19:12] <= PAYLOAD_MAX;
    header_repeats <= sequence_known && bus_data[27:20] == last_sequence;
  end

  // The answer to a strobe arrives one clock after the bus shows the strobe, and is judged in the next.
  reg       answer_due;
  reg       answer_came;
  reg [3:0] answer;

  // Behind the payload, the buffer has a place for the header, one for whatever is not kept, and two for the
  // counters of refusals; these read as 0 until one of the word has counted.
  wire       is_header = step == STEP_HEADER || step == STEP_REPLAY;
  wire       is_payload = step == STEP_PAYLOAD;
  wire       is_counting = step == STEP_COUNT;
  wire       uses_counters = step == STEP_READ || is_counting;
  reg  [3:0] verdict;
  reg  [1:0] counted;
  wire       counters_high = is_counting ? verdict >= VERDICT_READ_ONLY : bus_address[0];
  wire [1:0] counter = verdict[1:0] - VERDICT_BAD_CRC[1:0];
  wire [1:0] place = uses_counters ? {1'b1, counters_high} : {1'b0, step == STEP_CRC};
  wire       refuses = act && step == STEP_ACK && verdict != VERDICT_OK && verdict != VERDICT_DUPLICATE;

  passo_payload u_payload (
    .clk        (clk),
    .store      (half_valid),
    .store_word (is_payload ? {1'b0, index[5:0]} : {6'b100000, ~is_header}),
    .store_low  (half_low),
    .half       (half),
    .put        (is_counting && (act || half_turned)),
    .put_word   ({6'b100001, counters_high}),
    .put_low    (act),
    .load       (load),
    .load_word  (is_payload || step == STEP_REPLAY ? {1'b0, index[5:0]} : {5'b10000, place}),
    .load_low   (count[0]),
    .load_zero  (uses_counters && !counted[counters_high]),
    .turn       (turn),
    .turns      (count[4:0]),
    .count      (is_counting),
    .counter    (counter),
    .data       (bus_data),
    .top_bit    (bus_top_bit),
    .lone_bit   (bus_lone_bit),
    .counter_bit(counter_bit)
  );

  // CRC of the request; that of a read's header goes on as the CRC of the reply
  wire crc_top;
  wire reply_top;
  wire counter_bit;
  reg  crc_wrong;

  passo_crc u_crc (
    .clk    (clk),
    .restart(load && step == STEP_HEADER),
    .shift  (turn),
    .turn   (step == STEP_CRC || step == STEP_SUM),
    .data   (step == STEP_READ ? reply_top : bus_data[31]),
    .top    (crc_top)
  );

  passo_reply u_reply (
    .clk        (clk),
    .take       (frame_start || answered),
    .data       (bus_read_data),
    .shift      (turn && replies),
    .turns      (count[4:0]),
    .acknowledge(step == STEP_ACK),
    .header_11  (bus_data[11]),
    .header_27  (bus_data[27]),
    .verdict    (verdict),
    .crc_next   (step == STEP_SUM),
    .crc_top    (crc_top),
    .counters   (step == STEP_READ && bus_counters),
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
        verdict != VERDICT_OK  ? verdict :
        bus_incomplete         ? VERDICT_BAD_LENGTH : VERDICT_OK;
    executes <= !crc_wrong && verdict == VERDICT_OK && !bus_incomplete;
  end

  always @(posedge clk) begin
    if (count != COUNT_REST) count <= count + 6'd1;
    act <= count == COUNT_ACT - 6'd1;
    half_turned <= count == COUNT_TURN + 6'd15;
    replies <= step == STEP_ACK || step == STEP_READ || step == STEP_SUM;
    bus_frame <= act && (step == STEP_HEADER || step == STEP_ACK);
    bus_check <= act && step == STEP_PAYLOAD;
    bus_write <= count == COUNT_LOADED && step == STEP_REPLAY;
    bus_read <= count == COUNT_LOAD && step == STEP_READ && !frame_end;
    answer_due <= bus_check;
    answer_came <= answer_due;
    answer <= bus_claim ? bus_refusal : VERDICT_UNKNOWN_ADDRESS;
    crc_wrong <= step != STEP_HEADER && (crc_wrong || (step == STEP_CRC && turn && crc_top != bus_data[31]));

    if (answer_came && verdict == VERDICT_OK) verdict <= answer;
    if ((bus_check || bus_write) && !bus_push) bus_address <= bus_address + 12'd1;

    case (step)
      STEP_HEADER: begin
        if (word_valid) count <= COUNT_LOAD;
        if (act) begin
          is_read <= header_is_read;
          bus_push <= operation == OPERATION_PUSH;
          length <= bus_data[19:12];
          verdict  <= !header_is_known                   ? VERDICT_BAD_OPERATION :
                      header_is_empty || !header_fits    ? VERDICT_BAD_LENGTH :
                      header_repeats && !header_is_read  ? VERDICT_DUPLICATE : VERDICT_OK;
          step <= header_is_read || header_is_empty ? STEP_CRC : STEP_PAYLOAD;
        end
      end

      STEP_PAYLOAD: begin
        if (word_valid) count <= COUNT_LOAD;
        if (act) index <= index + 8'd1;
        if (all_words) step <= STEP_CRC;
      end

      STEP_CRC: begin
        if (word_valid) count <= COUNT_LOAD;
        if (act) begin
          verdict <= verdict_final;
          index   <= 8'd0;
          count   <= is_read && executes ? COUNT_READ : COUNT_LOAD;
          step    <= is_read && executes ? STEP_READ : STEP_ACK;
        end
      end

      STEP_ACK:
      if (act) begin
        step <= STEP_IDLE;
        if (verdict == VERDICT_OK) begin
          last_sequence  <= bus_data[27:20];
          sequence_known <= 1'b1;
          count          <= COUNT_LOAD;
          step           <= STEP_REPLAY;
        end
        if (refuses) begin
          count <= COUNT_LOAD;
          step  <= STEP_COUNT;
        end
      end

      STEP_REPLAY: begin
        if (count == COUNT_LOADED) begin
          index <= index + 8'd1;
          count <= COUNT_LOAD;
        end
        if (all_words) begin
          count <= COUNT_REST;
          step  <= frame_goes_on ? STEP_HEADER : STEP_IDLE;
        end
      end

      STEP_READ: begin
        if (count == COUNT_LOADED && index == 8'd0 && answer != VERDICT_OK) begin
          verdict <= answer;
          count   <= COUNT_LOAD;
          step    <= STEP_ACK;
        end
        if (act) begin
          index       <= index + 8'd1;
          bus_address <= bus_address + 12'd1;
        end
        // a word has ended: the reply has been taken
        if (word_valid) begin
          count <= all_words ? COUNT_TURN : COUNT_READ;
          if (all_words) step <= STEP_SUM;
        end
      end

      STEP_SUM: if (act) step <= STEP_IDLE;

      STEP_COUNT:
      if (act) begin
        counted[counters_high] <= 1'b1;
        step                   <= frame_goes_on ? STEP_HEADER : STEP_IDLE;
      end

      default: ;
    endcase

    // the header has turned: it stands on the bus
    if (act && (step == STEP_HEADER || step == STEP_ACK)) begin
      bus_address <= bus_data[11:0];
      index       <= 8'd0;
    end

    frame_waits <= (step == STEP_REPLAY || is_counting) && frame_goes_on;
    // chip select does not come between a verdict and what it promises
    if (step != STEP_REPLAY && !is_counting && !(step == STEP_ACK && act)) begin
      if (frame_end) step <= STEP_IDLE;
      if (frame_start) step <= STEP_HEADER;
      if (frame_end || frame_start) count <= COUNT_REST;
    end

    if (rst) begin
      step           <= STEP_IDLE;
      count          <= COUNT_REST;
      last_sequence  <= 8'd0;
      sequence_known <= 1'b0;
      counted        <= 2'b00;
      bus_push       <= 1'b0;
      bus_check      <= 1'b0;
      bus_write      <= 1'b0;
      bus_read       <= 1'b0;
      answer_due     <= 1'b0;
      answer_came    <= 1'b0;
      frame_waits    <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_link_formal.vh"
`endif

endmodule
`resetall
