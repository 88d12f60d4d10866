// SPDX-License-Identifier: MIT
// Passo on the iCE40-HX8K Breakout Board: everything on header J2, heartbeat on LED D9.
//
// The PLL makes clk of the 12 MHz oscillator: 12 MHz / (DIVR + 1) * (DIVF + 1) / 2^DIVQ.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module top #(
  parameter AXES         = 4,
  parameter CLOCK_HZ     = 108_000_000,
  parameter DIVR         = 0,
  parameter DIVF         = 71,
  parameter DIVQ         = 3,
  parameter FILTER_RANGE = 1
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
  output wire            led
);

  wire clk;
  wire locked;
  wire sclk;
  wire miso;
  wire miso_enable;

  SB_PLL40_CORE #(
    .FEEDBACK_PATH("SIMPLE"),
    .DIVR         (DIVR),
    .DIVF         (DIVF),
    .DIVQ         (DIVQ),
    .FILTER_RANGE (FILTER_RANGE)
  ) u_pll (
    .REFERENCECLK(oscillator),
    .PLLOUTGLOBAL(clk),
    .LOCK        (locked),
    .RESETB      (1'b1),
    .BYPASS      (1'b0)
  );

  // from the pad straight to the clock network
  SB_GB_IO #(
    .PIN_TYPE(6'b000001)
  ) u_sclk (
    .PACKAGE_PIN         (spi_sclk),
    .GLOBAL_BUFFER_OUTPUT(sclk)
  );

  // driven while selected
  SB_IO #(
    .PIN_TYPE(6'b101001)
  ) u_miso (
    .PACKAGE_PIN  (spi_miso),
    .OUTPUT_ENABLE(miso_enable),
    .D_OUT_0      (miso)
  );

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
    .heartbeat      (led)
  );

endmodule
`resetall
