// SPDX-License-Identifier: MIT
// Passo on the Tang Nano 9K (GW1NR-9C): heartbeat on the first LED, the pins of 3.3 V for all the rest.
//
// The PLL makes clk of the 27 MHz oscillator: 27 MHz / (IDIV_SEL + 1) * (FBDIV_SEL + 1); inside it runs ODIV_SEL
// times faster.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module top #(
  parameter AXES      = 6,
  parameter CLOCK_HZ  = 81_000_000,
  parameter IDIV_SEL  = 0,
  parameter FBDIV_SEL = 2,
  parameter ODIV_SEL  = 8
) (
  input  wire            oscillator,
  input  wire            spi_sclk,
  input  wire            spi_mosi,
  input  wire            spi_cs_n,
  output wire            spi_miso,
  input  wire            sync,
  output wire [AXES-1:0] step,
  output wire [AXES-1:0] dir,
  output wire [AXES-1:0] enable,
  output wire            running,
  output wire            irq,
  output wire            led_n
);

  wire clk;
  wire locked;
  wire sclk;
  wire miso;
  wire miso_enable;
  wire heartbeat;

  rPLL #(
    .FCLKIN   ("27"),
    .DEVICE   ("GW1NR-9C"),
    .IDIV_SEL (IDIV_SEL),
    .FBDIV_SEL(FBDIV_SEL),
    .ODIV_SEL (ODIV_SEL)
  ) u_pll (
    .CLKIN  (oscillator),
    .CLKOUT (clk),
    .LOCK   (locked),
    .RESET  (1'b0),
    .RESET_P(1'b0),
    .CLKFB  (1'b0),
    .IDSEL  (6'd0),
    .FBDSEL (6'd0),
    .ODSEL  (6'd0),
    .PSDA   (4'd0),
    .DUTYDA (4'd0),
    .FDLY   (4'd0)
  );

  BUFG u_sclk (
    .I(spi_sclk),
    .O(sclk)
  );

  // driven while selected
  TBUF u_miso (
    .I  (miso),
    .OEN(~miso_enable),
    .O  (spi_miso)
  );

  assign led_n = ~heartbeat;

  passo_board #(
    .AXES    (AXES),
    .CLOCK_HZ(CLOCK_HZ)
  ) u_board (
    .clk            (clk),
    .locked         (locked),
    .spi_sclk       (sclk),
    .spi_mosi       (spi_mosi),
    .spi_cs_n       (spi_cs_n),
    .spi_miso       (miso),
    .spi_miso_enable(miso_enable),
    .sync           (sync),
    .step           (step),
    .dir            (dir),
    .enable         (enable),
    .running        (running),
    .irq            (irq),
    .heartbeat      (heartbeat)
  );

endmodule
`resetall
