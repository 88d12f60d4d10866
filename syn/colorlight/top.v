// SPDX-License-Identifier: MIT
// Passo on the Colorlight 5A-75B V7.0 (ECP5-25): two axes on each of J1, J2, J3, the host on J5, heartbeat on the LED.
//
// The PLL makes clk of the 25 MHz oscillator: 25 MHz / CLKI_DIV * CLKFB_DIV; inside it runs CLKOP_DIV times faster.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module top #(
  parameter AXES           = 6,
  parameter CLOCK_HZ       = 150_000_000,
  parameter STEPS_REGISTER = 1,
  parameter CLKI_DIV       = 1,
  parameter CLKFB_DIV      = 6,
  parameter CLKOP_DIV      = 4
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
  wire miso;
  wire miso_enable;
  wire heartbeat;

  EHXPLLL #(
    .CLKI_DIV    (CLKI_DIV),
    .CLKFB_DIV   (CLKFB_DIV),
    .CLKOP_DIV   (CLKOP_DIV),
    .CLKOP_CPHASE(CLKOP_DIV - 1),
    .CLKOP_ENABLE("ENABLED"),
    .FEEDBK_PATH ("CLKOP")
  ) u_pll (
    .CLKI        (oscillator),
    .CLKFB       (clk),
    .CLKOP       (clk),
    .LOCK        (locked),
    .RST         (1'b0),
    .STDBY       (1'b0),
    .PHASESEL0   (1'b0),
    .PHASESEL1   (1'b0),
    .PHASEDIR    (1'b0),
    .PHASESTEP   (1'b0),
    .PHASELOADREG(1'b0),
    .PLLWAKESYNC (1'b0),
    .ENCLKOP     (1'b0)
  );

  // driven while selected
  OBZ u_miso (
    .I(miso),
    .T(~miso_enable),
    .O(spi_miso)
  );

  // on the other end of the LED is its supply
  assign led_n = ~heartbeat;

  passo_board #(
    .AXES          (AXES),
    .CLOCK_HZ      (CLOCK_HZ),
    .STEPS_REGISTER(STEPS_REGISTER)
  ) u_board (
    .clk            (clk),
    .locked         (locked),
    .spi_sclk       (spi_sclk),
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
