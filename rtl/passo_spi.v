// SPDX-License-Identifier: MIT
// SPI slave, mode 0, MSB first: bits to 32-bit words and back.
//
// Promise: `word_valid` is high for one clock after each 32 bits received, with `word` stable until the next
// word is complete. `reply_word` is sampled at the end of each word, to be sent as the next one; the first
// word of a frame is `reply_word` as well, except that its top bit is sent as 1 (it is on the wire before the
// first edge).
//
// Everything that touches bits runs on SCLK, and words cross to `clk`. Timing budget at SCLK = 18 MHz, clk =
// 72 MHz:
//   MISO  falling edge of SCLK -> shift register -> pin -> master: 27.8 ns until the master's rising edge;
//         about 3 ns in, 5 ns logic and routing, 6 ns out, 5 ns set-up of an STM32F103 leave 8 ns for the cable.
//         Oversampling with clk would need 3 clocks = 41.7 ns.
//   word  crosses by a toggle through two flip-flops, 2 to 3 clocks after the last falling edge; it stays for 31
//         SCLK = 124 clocks.
//   reply_word  may change from word_valid until the next word's last falling edge: 125 clocks.
//   frame_start comes 2 to 3 clocks after chip select falls; reply_word must stand at the first falling edge of
//         SCLK, so chip select has to fall at least 3 clocks before the first rising edge.
`resetall
`default_nettype none

module passo_spi (
  input  wire        clk,
  input  wire        rst,
  // pins
  input  wire        spi_sclk,
  input  wire        spi_mosi,
  input  wire        spi_cs_n,
  output wire        spi_miso,
  // words, in the domain of clk
  output wire        frame_start,  // chip select fell
  output wire        frame_end,    // chip select rose
  output wire        word_valid,
  output reg  [31:0] word,
  input  wire [31:0] reply_word
);

  // Chip select resets bits and words, and it is also a signal: to the toggle, and to clk behind its own
  // synchroniser.
  /* verilator lint_off SYNCASYNCNET */

  // SCLK domain. The toggle only ever changes at the end of a word, so it needs no reset, just a beginning.
  reg [ 4:0] bit_count;
  reg [30:0] receive;
  reg        word_toggle;
  initial word_toggle = 1'b0;

  always @(posedge spi_sclk or posedge spi_cs_n)
    if (spi_cs_n) bit_count <= 5'd0;
    else bit_count <= bit_count + 5'd1;

  always @(posedge spi_sclk) begin
    receive <= {receive[29:0], spi_mosi};
    if (bit_count == 5'd31) word <= {receive, spi_mosi};
  end

  // A word is announced only when the reply to the next one has been taken, on the same falling edge: however
  // slow SCLK is, whoever sees word_valid may change reply_word.
  always @(negedge spi_sclk) if (!spi_cs_n && bit_count == 5'd0) word_toggle <= ~word_toggle;

  reg        first_word;
  reg [31:0] send;

  always @(negedge spi_sclk or posedge spi_cs_n)
    if (spi_cs_n) begin
      first_word <= 1'b1;
      send       <= 32'h8000_0000;
    end else if (bit_count == 5'd0) begin
      first_word <= 1'b0;
      send       <= reply_word;
    end else if (first_word && bit_count == 5'd1) send <= {reply_word[30:0], 1'b0};
    else send <= {send[30:0], 1'b0};

  assign spi_miso = send[31];

  // clk domain
  reg [2:0] select_sync;
  reg [2:0] toggle_sync;

  always @(posedge clk) begin
    select_sync <= {select_sync[1:0], ~spi_cs_n};
    toggle_sync <= {toggle_sync[1:0], word_toggle};
    if (rst) begin
      select_sync <= 3'b000;
      toggle_sync <= {3{word_toggle}};
    end
  end

  /* verilator lint_on SYNCASYNCNET */

  assign frame_start = select_sync[1] & ~select_sync[2];
  assign frame_end   = ~select_sync[1] & select_sync[2];
  assign word_valid  = toggle_sync[1] ^ toggle_sync[2];

endmodule
`resetall
