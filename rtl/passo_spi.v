// SPDX-License-Identifier: MIT
// SPI slave, mode 0, MSB first: bits to words of 32 bits, in halves of 16, and back.
//
// Promise: `half_valid` is high for one clock after each 16 bits received, with `half` and `half_low` (it is
// the second half of a word) stable until the next half is complete. `reply_word` is sampled at the end of
// each word, to be sent as the next one; the first word of a frame is `reply_word` as well, except that its
// top bit is sent as 1 (it is on the wire before the first edge).
//
// Everything that touches bits runs on SCLK, and words cross to `clk`. Timing budget at SCLK = 18 MHz, clk =
// 72 MHz:
//   MISO  falling edge of SCLK -> flip-flop -> pin -> master: 27.8 ns until the master's rising edge;
//         about 3 ns in, 5 ns logic and routing, 6 ns out, 5 ns set-up of an STM32F103 leave 8 ns for the cable.
//         Oversampling with clk would need 3 clocks = 41.7 ns.
//   half  crosses by a toggle through two flip-flops, 2 to 3 clocks after its last falling edge; it stays for
//         15 SCLK = 60 clocks.
//   reply_word  may change from half_valid of a second half until the next word's last falling edge: 125 clocks.
//   frame_start comes 2 to 3 clocks after chip select falls; reply_word must stand at the first falling edge of
//         SCLK, so chip select has to fall at least 3 clocks before the first rising edge.
//   chip select must be high for 2 clocks between two frames, or the second one is taken for a part of the first.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_spi (
  input  wire        clk,
  // pins
  input  wire        spi_sclk,
  input  wire        spi_mosi,
  input  wire        spi_cs_n,
  output reg         spi_miso,
  // words, in the domain of clk
  output wire        frame_start,  // chip select fell
  output wire        frame_end,    // chip select rose
  output wire        half_valid,
  output reg         half_low,
  output reg  [15:0] half,
  input  wire [31:0] reply_word
);

  // Chip select resets bits and words, and it is also a signal: to the toggle, and to clk behind its own
  // synchroniser.
  /* verilator lint_off SYNCASYNCNET */

  // SCLK domain. Bits come in on the rising edge; all else happens on the falling edge.
  reg [4:0] bit_count;
  reg       mosi;

  always @(posedge spi_sclk or posedge spi_cs_n)
    if (spi_cs_n) bit_count <= 5'd0;
    else bit_count <= bit_count + 5'd1;

  always @(posedge spi_sclk) mosi <= spi_mosi;

  // One register: the reply leaves it at the top while the word comes in at the bottom. In the first word the
  // reply is one bit ahead, because its top bit has gone by; so the word is one bit behind, by `mosi_late`.
  reg         first_word;
  reg  [30:0] shift;
  reg         mosi_late;
  wire        half_ends = bit_count[3:0] == 4'd0;
  wire        load_next = bit_count == 5'd0;
  wire        load_first = first_word && bit_count == 5'd1;

  always @(negedge spi_sclk or posedge spi_cs_n)
    if (spi_cs_n) begin
      first_word <= 1'b1;
      spi_miso   <= 1'b1;
    end else begin
      if (load_next) first_word <= 1'b0;
      spi_miso <= load_next ? reply_word[31] : load_first ? reply_word[30] : first_word ? shift[29] : shift[30];
    end

  always @(negedge spi_sclk) begin
    mosi_late <= mosi;
    shift     <= load_next || load_first ? reply_word[30:0] : {shift[29:0], first_word ? mosi_late : mosi};
  end

  // A half is announced only when the reply to the next word has been taken, on the same falling edge: however
  // slow SCLK is, whoever sees half_valid may change reply_word. The toggle only ever changes at the end of a
  // half, so it needs no reset, just a beginning.
  reg half_toggle;
  initial half_toggle = 1'b0;

  always @(negedge spi_sclk)
    if (!spi_cs_n && half_ends) begin
      half_toggle <= ~half_toggle;
      half_low    <= ~bit_count[4];
      half        <= first_word ? {shift[13:0], mosi_late, mosi} : {shift[14:0], mosi};
    end

  // clk domain. Both follow through a reset: what does not change after it does not look like a change, so a frame
  // begins only when chip select falls.
  (* async_reg = "true" *)
  reg [2:0] select_sync;
  initial select_sync = 3'b111;
  (* async_reg = "true" *)
  reg [2:0] toggle_sync;
  initial toggle_sync = 3'b000;

  always @(posedge clk) begin
    select_sync <= {select_sync[1:0], ~spi_cs_n};
    toggle_sync <= {toggle_sync[1:0], half_toggle};
  end

  /* verilator lint_on SYNCASYNCNET */

  assign frame_start = select_sync[1] & ~select_sync[2];
  assign frame_end   = ~select_sync[1] & select_sync[2];
  assign half_valid  = toggle_sync[1] ^ toggle_sync[2];

endmodule
`resetall
