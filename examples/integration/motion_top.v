// SPDX-License-Identifier: MIT
// The core in a design of your own: three axes behind SPI, with limit switches and an e-stop.
//
// Drives with an active-low enable: EN is high, and so the drives are off, from configuration until the host
// enables them.
`timescale 1ns / 1ps

module motion_top (
  input  wire       clk,         // at least four times SCLK
  input  wire       rst,         // asynchronous, such as a button or a PLL that is not locked
  // the host, SPI mode 0; pulls: chip select up, SCLK down
  input  wire       spi_sclk,
  input  wire       spi_mosi,
  input  wire       spi_cs_n,
  output wire       spi_miso,
  output wire       irq,         // an axis was stopped
  // the machine
  input  wire       estop_n,     // asynchronous; low: EN is deasserted asynchronously
  input  wire [2:0] limit_low,
  input  wire [2:0] limit_high,
  output wire [2:0] step,
  output wire [2:0] dir,
  output wire [2:0] enable
);

  // asserted asynchronously, released on a clock
  (* async_reg = "true" *)
  reg [1:0] reset = 2'b11;

  always @(posedge clk or posedge rst)
    if (rst) reset <= 2'b11;
    else reset <= {reset[0], 1'b0};

  passo_spi_top #(
    .AXES        (3),
    .INPUTS      (1),
    .ENABLE_RESET(3'b111)
  ) core (
    .clk            (clk),
    .rst            (reset[1]),
    .spi_sclk       (spi_sclk),
    .spi_mosi       (spi_mosi),
    .spi_cs_n       (spi_cs_n),
    .spi_miso       (spi_miso),
    .spi_miso_enable(),            // for a bus with several devices: drive MISO only while it is 1
    .sync           (1'b0),
    .limit_low      (limit_low),
    .limit_high     (limit_high),
    .home           (3'b000),
    .alarm          (3'b000),
    .probe          (1'b0),
    .estop_n        (estop_n),
    .encoder_a      (3'b000),
    .encoder_b      (3'b000),
    .encoder_index  (3'b000),
    .step           (step),
    .dir            (dir),
    .enable         (enable),
    .outputs        (),
    .power          (),
    .compare        (),
    .running        (),
    .irq            (irq)
  );

endmodule
