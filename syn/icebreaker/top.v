// SPDX-License-Identifier: MIT
// Passo on the iCEBreaker (iCE40-UP5K): everything on the three Pmod connectors, heartbeat on the green LED,
// `running` on the red one.
//
// The PLL makes clk of the 12 MHz oscillator: 12 MHz / (DIVR + 1) * (DIVF + 1) / 2^DIVQ.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module top #(
  parameter AXES         = 6,
  parameter CLOCK_HZ     = 48_000_000,
  parameter DIVR         = 0,
  parameter DIVF         = 63,
  parameter DIVQ         = 4,
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
  output wire            irq,
  output wire            running_n,   // the LEDs light when low
  output wire            led_n
);

  wire clk;
  wire locked;
  wire sclk;
  wire miso;
  wire miso_enable;
  wire running;
  wire heartbeat;

  SB_PLL40_PAD #(
    .FEEDBACK_PATH("SIMPLE"),
    .DIVR         (DIVR),
    .DIVF         (DIVF),
    .DIVQ         (DIVQ),
    .FILTER_RANGE (FILTER_RANGE)
  ) u_pll (
    .PACKAGEPIN  (oscillator),
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

  assign running_n = ~running;
  assign led_n     = ~heartbeat;

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
