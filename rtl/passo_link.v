// SPDX-License-Identifier: MIT
// Link: words to frames to bus accesses, and the replies.
//
//   write, push  MOSI  header  payload x length    crc     0       0
//                MISO  status  status ...          status  status  ack
//   read         MOSI  header  crc     0       0 x length    0
//                MISO  status  status  status  data x length  crc
//
// Promise: a frame is executed whole or not at all, and only once. Each payload word goes to the bus as it
// arrives, only to be checked by its target (`bus_check`), and into a buffer. When the CRC is right, nobody
// objected and the sequence number is new, the buffer is replayed to the bus (`bus_write`), one word every 4
// clocks. A frame may begin meanwhile; it is ignored if its header is complete before the replay has ended,
// which takes a master that leaves out trailing words.
//
// Verdict: BAD_CRC goes before all others, then the first objection; a duplicate is not asked for objections.
// Latency: payload word to bus_check 2 clocks, crc word to ack 36 clocks. Address and data stand on the bus
// at least a clock before their strobe; a target answers one clock after it with claim (the address is mine),
// refusal and, to bus_read, data.
`resetall
`default_nettype none

module passo_link (
  input  wire        clk,
  input  wire        rst,
  // words from and to the SPI
  input  wire        frame_start,
  input  wire        frame_end,
  input  wire        word_valid,
  input  wire [31:0] word,
  output reg  [31:0] reply_word,
  // to the status word and the counters
  input  wire [31:0] status,
  output reg  [ 7:0] last_sequence,    // of the last write or push that was executed
  output reg         refused,          // strobe with refused_verdict
  output reg  [ 3:0] refused_verdict,
  // bus
  output reg         bus_frame,        // a pass over a frame's payload begins
  output reg         bus_check,        // strobes
  output reg         bus_write,
  output reg         bus_read,
  output wire        bus_push,         // the frame is a push
  output reg  [11:0] bus_address,
  output reg  [31:0] bus_data,
  input  wire        bus_claim,
  input  wire [ 3:0] bus_refusal,
  input  wire [31:0] bus_read_data,
  input  wire        bus_incomplete    // the payload so far is not whole lines or ramps
);

  `include "passo_registers.vh"

  localparam [7:0] PAYLOAD_MAX = 8'd60;

  localparam [3:0] STEP_IDLE = 4'd0;  // between frames
  localparam [3:0] STEP_HEADER = 4'd1;
  localparam [3:0] STEP_PAYLOAD = 4'd2;
  localparam [3:0] STEP_CRC = 4'd3;
  localparam [3:0] STEP_VERDICT = 4'd4;  // wait for the CRC of the request
  localparam [3:0] STEP_REPLAY = 4'd5;
  localparam [3:0] STEP_READ = 4'd6;  // fetch a word for the reply
  localparam [3:0] STEP_SEND = 4'd7;  // wait until it has been taken
  localparam [3:0] STEP_DONE = 4'd8;  // the rest of the frame means nothing

  reg [3:0] step;
  reg [1:0] phase;  // clocks within a replayed or fetched word

  // header fields
  reg [31:0] header;
  wire [3:0] operation = header[31:28];
  wire [7:0] sequence_number = header[27:20];
  wire [7:0] length = header[19:12];
  reg [7:0] index;  // payload word
  reg frame_waits;  // a frame has begun during the replay
  wire frame_goes_on = (frame_waits || frame_start) && !frame_end && !word_valid;  // has its header to come

  wire header_is_read = word[31:28] == OPERATION_READ;
  wire header_is_known = header_is_read | word[31:28] == OPERATION_WRITE | word[31:28] == OPERATION_PUSH;
  wire header_fits = word[19:12] != 8'd0 && word[19:12] <= PAYLOAD_MAX;

  reg  sequence_known;  // something was executed since reset
  wire repeated = sequence_known & ~header_is_read & word[27:20] == last_sequence;

  reg [3:0] verdict;

  assign bus_push = operation == OPERATION_PUSH;
  wire is_read = operation == OPERATION_READ;

  // The answer to a strobe arrives one clock after the bus shows the strobe.
  reg        answer_due;
  wire [3:0] answer = bus_claim ? bus_refusal : VERDICT_UNKNOWN_ADDRESS;

  // CRC of the request, then of the reply
  reg         crc_restart;
  reg         crc_start;
  reg  [31:0] crc_word;
  wire [31:0] crc;
  wire        crc_busy;
  wire        crc_idle = ~crc_busy & ~crc_start;
  reg         crc_idle_q;
  reg         crc_wrong;
  wire        verdict_due = crc_idle & crc_idle_q;  // crc_wrong is known

  passo_crc u_crc (
    .clk    (clk),
    .rst    (rst),
    .restart(crc_restart),
    .start  (crc_start),
    .word   (crc_word),
    .crc    (crc),
    .busy   (crc_busy)
  );

  // Payload buffer in half words, so that it takes one block RAM. What a frame that is too long overwrites in
  // it does not matter: that frame is refused.
  reg         stage_high;
  reg         stage_low;
  wire        stage_half;
  wire [15:0] staged;
  reg  [15:0] staged_high;

  passo_memory #(
    .WIDTH     (16),
    .DEPTH_LOG2(7)
  ) u_payload (
    .clk          (clk),
    .write        (stage_high | stage_low),
    .write_address({index[5:0], stage_low}),
    .write_data   (stage_low ? bus_data[15:0] : bus_data[31:16]),
    .read_address ({index[5:0], stage_half}),
    .read_data    (staged)
  );

  assign stage_half = phase[0];

  wire [ 3:0] verdict_final =
      crc_wrong                             ? VERDICT_BAD_CRC :
      verdict != VERDICT_OK                 ? verdict :
      bus_incomplete                        ? VERDICT_BAD_LENGTH : VERDICT_OK;

  // Acknowledge: sequence and verdict, and their complement.
  function [31:0] acknowledge(input [7:0] of_sequence, input [3:0] of_verdict);
    acknowledge = {of_sequence, 4'd0, of_verdict, ~of_sequence, 4'hF, ~of_verdict};
  endfunction

  wire last_word = index + 8'd1 == length;

  always @(posedge clk) begin
    bus_frame   <= 1'b0;
    bus_check   <= stage_high;
    bus_write   <= 1'b0;
    bus_read    <= 1'b0;
    answer_due  <= bus_check;
    crc_restart <= 1'b0;
    crc_start   <= 1'b0;
    stage_high  <= 1'b0;
    stage_low   <= stage_high;
    refused     <= 1'b0;
    crc_idle_q  <= crc_idle;
    crc_wrong   <= crc != 32'd0;

    if (answer_due && verdict == VERDICT_OK) verdict <= answer;
    if ((bus_check || bus_write) && !bus_push) bus_address <= bus_address + 12'd1;

    case (step)
      STEP_HEADER:
      if (word_valid) begin
        header <= word;
        bus_address <= word[11:0];
        bus_frame <= 1'b1;
        index <= 8'd0;
        crc_word <= word;
        crc_start <= 1'b1;
        verdict     <= ~header_is_known ? VERDICT_BAD_OPERATION :
                       ~header_fits     ? VERDICT_BAD_LENGTH :
                       repeated         ? VERDICT_DUPLICATE : VERDICT_OK;
        step <= (header_is_read || word[19:12] == 8'd0) ? STEP_CRC : STEP_PAYLOAD;
      end

      STEP_PAYLOAD: begin
        // the word on the bus was buffered under the old index
        if (stage_low) begin
          index <= index + 8'd1;
          if (last_word) step <= STEP_CRC;
        end
        if (word_valid) begin
          bus_data   <= word;
          stage_high <= 1'b1;
          crc_word   <= word;
          crc_start  <= 1'b1;
        end
      end

      STEP_CRC:
      if (word_valid) begin
        crc_word  <= word;
        crc_start <= 1'b1;
        step      <= STEP_VERDICT;
      end

      STEP_VERDICT:
      if (verdict_due) begin
        reply_word      <= acknowledge(sequence_number, verdict_final);
        refused         <= verdict_final != VERDICT_OK && verdict_final != VERDICT_DUPLICATE;
        refused_verdict <= verdict_final;
        index           <= 8'd0;
        phase           <= 2'd0;
        bus_address     <= header[11:0];
        bus_frame       <= 1'b1;
        if (verdict_final != VERDICT_OK) step <= STEP_DONE;
        else if (is_read) begin
          // the CRC of the reply begins with the request's header
          crc_word    <= header;
          crc_restart <= 1'b1;
          crc_start   <= 1'b1;
          step        <= STEP_READ;
        end else begin
          last_sequence  <= sequence_number;
          sequence_known <= 1'b1;
          step           <= STEP_REPLAY;
        end
      end

      STEP_REPLAY: begin
        phase <= phase + 2'd1;
        if (phase == 2'd1) staged_high <= staged;
        if (phase == 2'd2) bus_data <= {staged_high, staged};
        if (phase == 2'd3) begin
          bus_write <= 1'b1;
          index     <= index + 8'd1;
          if (last_word) begin
            step        <= frame_goes_on ? STEP_HEADER : STEP_DONE;
            crc_restart <= 1'b1;
          end
        end
      end

      STEP_READ: begin
        if (phase != 2'd3) phase <= phase + 2'd1;
        if (phase == 2'd0) bus_read <= 1'b1;
        // the data stand on the bus for one clock only
        if (phase == 2'd2) crc_word <= bus_read_data;
        if (phase == 2'd2 && index == 8'd0 && answer != VERDICT_OK) begin
          reply_word      <= acknowledge(sequence_number, answer);
          refused         <= 1'b1;
          refused_verdict <= answer;
          step            <= STEP_DONE;
        end
        if (phase == 2'd3 && crc_idle) begin
          reply_word  <= crc_word;
          crc_start   <= 1'b1;
          phase       <= 2'd0;
          index       <= index + 8'd1;
          bus_address <= bus_address + 12'd1;
          step        <= STEP_SEND;
        end
      end

      STEP_SEND:
      // a word has ended: reply_word has been taken
      if (word_valid) begin
        if (index != length) step <= STEP_READ;
        else begin
          reply_word <= crc;
          step       <= STEP_DONE;
        end
      end

      default: ;
    endcase

    if (frame_start) reply_word <= status;
    frame_waits <= step == STEP_REPLAY && frame_goes_on;
    // chip select does not come between a verdict and what it promises
    if (step != STEP_REPLAY && !(step == STEP_VERDICT && verdict_due)) begin
      if (frame_end) step <= STEP_IDLE;
      if (frame_start) begin
        step        <= STEP_HEADER;
        crc_restart <= 1'b1;
      end
    end

    if (rst) begin
      step           <= STEP_IDLE;
      crc_start      <= 1'b0;
      crc_restart    <= 1'b0;
      last_sequence  <= 8'd0;
      sequence_known <= 1'b0;
      header         <= 32'd0;
      answer_due     <= 1'b0;
      frame_waits    <= 1'b0;
      reply_word     <= 32'd0;
    end
  end

endmodule
`resetall
