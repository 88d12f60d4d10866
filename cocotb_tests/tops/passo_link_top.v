// SPDX-License-Identifier: MIT
// SPI slave and link as in passo_spi_top; the bus and the status come from the test.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_top (
  input  wire        clk,
  input  wire        rst,
  input  wire        spi_sclk,
  input  wire        spi_mosi,
  input  wire        spi_cs_n,
  output wire        spi_miso,
  input  wire [31:0] status,
  output wire [ 7:0] last_sequence,
  output wire        refused,
  output wire [ 3:0] verdict,
  output wire        word_valid,
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

  wire        frame_start;
  wire        frame_end;
  wire        half_valid;
  wire        half_low;
  wire [15:0] half;
  wire [31:0] reply_word;

  assign word_valid = half_valid & half_low;
  assign refused    = u_link.in_ack & u_link.act & ~u_link.verdict_ok & ~u_link.u_states.is_duplicate;
  assign verdict    = u_link.verdict;

  // the status stands in the place of data, but for the clock after a strobe; a clock later it comes to the link
  reg        answers;
  reg [31:0] read_data;
  always @(posedge clk) begin
    answers   <= bus_read;
    read_data <= answers ? bus_read_data : status;
  end

  passo_spi u_spi (
    .clk        (clk),
    .spi_sclk   (spi_sclk),
    .spi_mosi   (spi_mosi),
    .spi_cs_n   (spi_cs_n),
    .spi_miso   (spi_miso),
    .frame_start(frame_start),
    .frame_end  (frame_end),
    .half_valid (half_valid),
    .half_low   (half_low),
    .half       (half),
    .reply_word (reply_word)
  );

  passo_link u_link (
    .clk           (clk),
    .rst           (rst),
    .frame_start   (frame_start),
    .frame_end     (frame_end),
    .half_valid    (half_valid),
    .half_low      (half_low),
    .half          (half),
    .reply_word    (reply_word),
    .last_sequence (last_sequence),
    .bus_frame     (bus_frame),
    .bus_commit    (bus_commit),
    .bus_check     (bus_check),
    .bus_write     (bus_write),
    .bus_read      (bus_read),
    .bus_push      (bus_push),
    .bus_address   (bus_address),
    .bus_data      (bus_data),
    .bus_msb       (bus_msb),
    .bus_one_hot   (bus_one_hot),
    .bus_claim     (bus_claim),
    .bus_refusal   (bus_refusal),
    .bus_counters  (bus_counters),
    .bus_read_data (read_data),
    .bus_incomplete(bus_incomplete),
    .bus_busy      (bus_busy)
  );

endmodule
`resetall
