// SPDX-License-Identifier: MIT
// Link states: the current part of the frame, one-hot, and the clock schedule of its word. No bit is set between
// frames, or while the rest of a frame is ignored.
//
//   write, push   header  payload  crc  ack  replay          refused   ack  count
//   read          header           crc  read  sum            refused   as above, or read  ack  count
//
// A committed frame ignores chip select; a frame that starts meanwhile waits (`frame_waits`).
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_states (
  input  wire       clk,
  input  wire       rst,
  // host interface
  input  wire       frame_start,
  input  wire       frame_end,
  input  wire       word_valid,
  // what is known of the frame
  input  wire       header_is_read,
  input  wire       header_is_empty,
  input  wire       all_words,
  input  wire       reads,            // a read that is executed
  input  wire       objection,
  input  wire       verdict_ok,
  input  wire       is_duplicate,
  // states
  output reg        in_header,
  output reg        in_payload,
  output reg        in_crc,
  output reg        in_ack,
  output reg        in_replay,
  output reg        in_read,          // fetch a word for the reply, wait until it is taken
  output reg        in_sum,           // send the CRC of the reply
  output reg        in_count,         // count a refusal
  output wire       frame_breaks,     // the frame is abandoned
  // clock of the word
  output wire [6:0] count,
  output wire       rotate,
  output wire       rests,
  output reg        begin_load,
  output wire       load,
  output wire       load_ends,
  output wire       act,
  output wire       half_rotated
);

  reg frame_waits;
  reg begin_read;
  reg begin_rotate;
  reg begin_rest;

  wire reply_taken = in_read & word_valid;
  wire last_taken = reply_taken & all_words;  // the CRC of the reply follows
  wire goes_through = in_replay | in_count | (in_ack & act);
  wire header_comes = (frame_waits || frame_start) && !frame_end && !word_valid;  // of the waiting frame

  assign frame_breaks = (frame_end | frame_start) & ~goes_through;

  passo_link_schedule u_schedule (
    .clk         (clk),
    .rst         (rst),
    .begin_read  (begin_read),
    .begin_load  (begin_load),
    .begin_rotate(begin_rotate),
    .begin_rest  (begin_rest),
    .over        (in_replay & all_words),
    .breaks      (frame_breaks),
    .count       (count),
    .rotate      (rotate),
    .rests       (rests),
    .load        (load),
    .load_ends   (load_ends),
    .act         (act),
    .half_rotated(half_rotated)
  );

  always @(posedge clk) begin
    in_header <= (frame_start & ~goes_through) | (in_header & ~act & ~frame_breaks)
                 | (header_comes & ((in_replay & all_words) | (in_count & act)));
    in_payload <= ((in_header & act & ~header_is_read & ~header_is_empty) | (in_payload & ~all_words)) & ~frame_breaks;
    in_crc <= ((in_header & act & (header_is_read | header_is_empty)) | (in_payload & all_words) | (in_crc & ~act))
              & ~frame_breaks;
    in_ack <= ((in_crc & act & ~reads) | (objection & ~last_taken) | (in_ack & ~act)) & ~frame_breaks;
    in_replay <= (in_ack & act & verdict_ok) | (in_replay & ~all_words);
    in_read <= ((in_crc & act & reads) | (in_read & ~objection & ~last_taken)) & ~frame_breaks;
    in_sum <= (last_taken | (in_sum & ~act)) & ~frame_breaks;
    in_count <= (in_ack & act & ~verdict_ok & ~is_duplicate) | (in_count & ~act);
    frame_waits <= (in_replay | in_count) & header_comes;

    begin_load <= (word_valid & (in_header | in_payload | in_crc)) | (in_crc & act & ~reads) | objection
                  | (in_ack & act & ~is_duplicate) | (in_replay & load_ends);
    begin_read <= (in_crc & act & reads) | (reply_taken & ~all_words);
    begin_rotate <= last_taken;
    begin_rest <= frame_breaks | (in_replay & all_words);

    if (rst) begin
      {in_header, in_payload, in_crc, in_ack, in_replay, in_read, in_sum, in_count} <= 8'd0;
      {begin_load, begin_read, begin_rotate, begin_rest}                            <= 4'd0;

      frame_waits <= 1'b0;
    end
  end

endmodule
`resetall
