// SPDX-License-Identifier: MIT
// SPI slave, mode 0, MSB first: bits to 32-bit words, in halves of 16, and back.
//
// Promise: `half_valid` is high for one clock after each 16 bits received; `half` and `half_low` (second half of a
// word) are stable until the next half is complete. `reply_word` is sampled at the end of each word and sent as the
// next one; the first word of a frame is `reply_word`, too, but its top bit is sent as 1 (it is on the wire before
// the first edge).
//
// Everything that touches bits runs on SCLK; words cross to `clk`. Timing budget at SCLK = 18 MHz, clk = 72 MHz:
//   MISO  falling edge of SCLK -> flip-flop -> pin -> master: 27.8 ns until the master's rising edge;
//         about 3 ns in, 5 ns logic and routing, 6 ns out, 5 ns setup of an STM32F103 leave 8 ns for the cable.
//         Oversampling with clk would need 3 clocks = 41.7 ns.
//   half  crosses by a toggle through two flip-flops, 2 to 3 clocks after its last falling edge; it is stable for
//         15 SCLK = 60 clocks.
//   reply_word  may change from half_valid of a second half until the next word's last falling edge: 125 clocks.
//   frame_start comes 2 to 3 clocks after chip select falls; reply_word must be stable at the first falling edge of
//         SCLK, so chip select must fall at least 3 clocks before the first rising edge.
//   chip select must be high for 2 clocks between two frames, or the second one is taken as part of the first.
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
  // words, in the clk domain
  output wire        frame_start,  // chip select fell
  output wire        frame_end,    // chip select rose
  output wire        half_valid,
  output reg         half_low,
  output reg  [15:0] half,
  input  wire [31:0] reply_word
);

  // Chip select resets bits and words asynchronously and is also data: for the toggle and, through a synchronizer,
  // for clk.
  /* verilator lint_off SYNCASYNCNET */

  // SCLK domain. Bits are sampled on the rising edge; all else happens on the falling edge.
  reg [4:0] bit_count;
  reg       mosi;

  always @(posedge spi_sclk or posedge spi_cs_n)
    if (spi_cs_n) bit_count <= 5'd0;
    else bit_count <= bit_count + 5'd1;

  always @(posedge spi_sclk) mosi <= spi_mosi;

  // One shift register: the reply leaves at the top while the word enters at the bottom. In the first word the reply
  // is one bit ahead, its top bit being out already; so the word is delayed by one bit, `mosi_late`.
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

  // A half is announced on the falling edge that also samples the next reply: however slow SCLK is, reply_word may
  // change once half_valid is seen. The toggle only changes at the end of a half: it needs an initial value, no
  // reset.
  reg half_toggle;
  initial half_toggle = 1'b0;

  always @(negedge spi_sclk)
    if (!spi_cs_n && half_ends) begin
      half_toggle <= ~half_toggle;
      half_low    <= ~bit_count[4];
      half        <= first_word ? {shift[13:0], mosi_late, mosi} : {shift[14:0], mosi};
    end

  // clk domain. Both synchronizers run during reset, so that it leaves no false edge behind: a frame begins only when
  // chip select falls.
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
