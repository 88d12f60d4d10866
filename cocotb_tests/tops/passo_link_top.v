// SPDX-License-Identifier: MIT
// SPI slave and link as in passo_spi_top; the bus and the status come from the test, which sets the registers.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_link_top;

  reg clk, rst;
  reg spi_sclk, spi_mosi, spi_cs_n;
  reg [31:0] status;
  reg bus_claim, bus_counters, bus_incomplete, bus_busy;
  reg [3:0] bus_refusal;
  reg [31:0] bus_read_data;

  wire spi_miso;
  wire frame_start, frame_end, half_valid, half_low;
  wire [15:0] half;
  wire [31:0] reply_word;
  wire [7:0] last_sequence;
  wire bus_frame, bus_commit, bus_check, bus_write, bus_read, bus_push, bus_one_hot;
  wire [11:0] bus_address;
  wire [31:0] bus_data;
  wire [4:0] bus_msb;

  wire word_valid = half_valid & half_low;
  wire refused = u_link.in_ack & u_link.act & ~u_link.verdict_ok & ~u_link.u_states.is_duplicate;
  wire [3:0] verdict = u_link.verdict;

  // the status replaces the data except in the clock after a strobe; it reaches the link one clock later
  reg answers;
  reg [31:0] read_data;
  always @(posedge clk) begin
    answers   <= bus_read;
    read_data <= answers ? bus_read_data : status;
  end

  passo_spi u_spi (.*);
  passo_link u_link (
    .*,
    .bus_read_data(read_data)
  );

endmodule
`resetall
