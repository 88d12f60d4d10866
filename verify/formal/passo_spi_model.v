// SPDX-License-Identifier: MIT
// In place of the SPI slave, for the proof of the top: what comes in continues to the core and comes back.
`default_nettype none

module passo_spi (
  input  wire        clk,
  input  wire        spi_sclk,
  input  wire        spi_mosi,
  input  wire        spi_cs_n,
  output wire        spi_miso,
  output wire        frame_start,
  output wire        frame_end,
  output wire        half_valid,
  output wire        half_low,
  output wire [15:0] half,
  input  wire [31:0] reply_word
);
  assign {frame_start, frame_end, half_valid, half_low} = {spi_cs_n, 1'b0, spi_sclk, 1'b0};
  assign half = {spi_mosi, 15'd0};
  assign spi_miso = ^reply_word;
endmodule
