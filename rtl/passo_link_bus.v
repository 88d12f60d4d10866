// SPDX-License-Identifier: MIT
// Link bus: the words of the frame as bus accesses. Counts and addresses them, and generates the strobes.
//
// When a header or an ack has rotated (`act`), the header is on `data`: its fields are latched then.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_bus (
  input  wire        clk,
  input  wire        rst,
  // state of the frame, clock of the word
  input  wire        in_header,
  input  wire        in_payload,
  input  wire        in_crc,
  input  wire        in_ack,
  input  wire        in_replay,
  input  wire        in_read,
  input  wire [ 6:0] count,
  input  wire        rests,
  input  wire        load_ends,
  input  wire        act,
  input  wire        frame_end,
  input  wire        verdict_ok,
  input  wire [31:0] data,
  // the frame
  output reg         is_read,
  output wire [ 5:0] index,           // payload word
  output reg         first_word,      // it is 0, registered
  output reg         all_words,       // it is length, registered; low in the clock after act
  output reg         sequence_known,  // a frame was executed since reset
  output reg  [ 7:0] last_sequence,
  // bus
  output reg         bus_frame,
  output reg         bus_commit,
  output reg         bus_check,
  output reg         bus_write,
  output reg         bus_read,
  output reg         bus_push,
  output reg  [11:0] bus_address
);

  `include "passo_registers.vh"
  `include "passo_link_schedule.vh"

  reg [7:0] length;
  reg [7:0] word;

  assign index = word[5:0];

  always @(posedge clk) begin
    first_word <= word == 8'd0;
    all_words  <= word == length && !act;
    bus_frame  <= act & (in_header | (in_ack & verdict_ok));
    bus_commit <= (in_crc & ~rests) | in_ack | in_replay;
    bus_check  <= act & in_payload;
    bus_write  <= in_replay && count == COUNT_LOADED;
    bus_read   <= in_read && count == COUNT_LOAD && !frame_end;

    if (in_header && act) begin
      is_read  <= data[HEADER_OPERATION_LSB+:HEADER_OPERATION_BITS] == OPERATION_READ;
      bus_push <= data[HEADER_OPERATION_LSB+:HEADER_OPERATION_BITS] == OPERATION_PUSH;
      length   <= data[HEADER_LENGTH_LSB+:HEADER_LENGTH_BITS];
    end

    if (in_ack && act && verdict_ok) begin
      last_sequence  <= data[HEADER_SEQUENCE_LSB+:HEADER_SEQUENCE_BITS];
      sequence_known <= 1'b1;
    end

    if (act && (in_header || in_crc || in_ack)) word <= 8'd0;
    else if ((act && (in_payload || in_read)) || (in_replay && load_ends)) word <= word + 8'd1;

    if (act && (in_header || in_ack)) bus_address <= data[HEADER_ADDRESS_LSB+:HEADER_ADDRESS_BITS];
    else if (((bus_check || bus_write) && !bus_push) || (act && in_read)) bus_address <= bus_address + 12'd1;

    if (rst) begin
      last_sequence  <= 8'd0;
      sequence_known <= 1'b0;
      bus_frame      <= 1'b0;
      bus_commit     <= 1'b0;
      bus_push       <= 1'b0;
      bus_check      <= 1'b0;
      bus_write      <= 1'b0;
      bus_read       <= 1'b0;
    end
  end

endmodule
`resetall
