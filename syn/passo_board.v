// SPDX-License-Identifier: MIT
// What all boards share: reset, heartbeat and the core.
//
// Promise: the core is in reset from configuration until 16 clocks after `locked` rose, and again whenever the PLL
// loses lock. From configuration on until the host has spoken STEP and DIR are low and EN is high, which is off at
// the usual drives. `heartbeat` changes every half second to second as long as clk runs and the core is out of reset.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_board #(
  parameter                     AXES           = 4,
  parameter                     CHANNELS       = 1,
  parameter                     CLOCK_HZ       = 100_000_000,
  parameter                     STEPS_REGISTER = 0,                        // of the core, as are these
  parameter [CHANNELS*AXES-1:0] STEP_RESET     = {CHANNELS * AXES{1'b0}},
  parameter [CHANNELS*AXES-1:0] DIR_RESET      = {CHANNELS * AXES{1'b0}},
  parameter [CHANNELS*AXES-1:0] ENABLE_RESET   = {CHANNELS * AXES{1'b1}}
) (
  input  wire                     clk,
  input  wire                     locked,           // of the PLL, asynchronous
  input  wire                     spi_sclk,
  input  wire                     spi_mosi,
  input  wire                     spi_cs_n,
  output wire                     spi_miso,
  output wire                     spi_miso_enable,
  input  wire                     sync,
  output wire [CHANNELS*AXES-1:0] step,
  output wire [CHANNELS*AXES-1:0] dir,
  output wire [CHANNELS*AXES-1:0] enable,
  output wire [     CHANNELS-1:0] running,
  output wire                     irq,
  output wire                     heartbeat
);

  // Flip-flops begin as 0 in all of these FPGAs, so this counts "out of reset" up, not "in reset" down.
  reg [3:0] reset_count = 4'd0;
  reg       rst_n = 1'b0;

  always @(posedge clk or negedge locked)
    if (!locked) begin
      reset_count <= 4'd0;
      rst_n       <= 1'b0;
    end else begin
      if (!rst_n) reset_count <= reset_count + 4'd1;
      if (reset_count == 4'd15) rst_n <= 1'b1;
    end

  // The core takes a synchronous reset: another flip-flop keeps the end of the asynchronous one away from it.
  reg rst = 1'b1;
  always @(posedge clk) rst <= ~rst_n;

  localparam BEATS = $clog2(CLOCK_HZ);

  reg [BEATS-1:0] beat = {BEATS{1'b0}};

  always @(posedge clk)
    if (rst) beat <= {BEATS{1'b0}};
    else beat <= beat + 1'b1;

  assign heartbeat = beat[BEATS-1];

  passo_spi_top #(
    .CHANNELS      (CHANNELS),
    .AXES          (AXES),
    .STEPS_REGISTER(STEPS_REGISTER),
    .STEP_RESET    (STEP_RESET),
    .DIR_RESET     (DIR_RESET),
    .ENABLE_RESET  (ENABLE_RESET)
  ) u_core (
    .clk            (clk),
    .rst            (rst),
    .spi_sclk       (spi_sclk),
    .spi_mosi       (spi_mosi),
    .spi_cs_n       (spi_cs_n),
    .spi_miso       (spi_miso),
    .spi_miso_enable(spi_miso_enable),
    .sync           (sync),
    .step           (step),
    .dir            (dir),
    .enable         (enable),
    .running        (running),
    .irq            (irq)
  );

endmodule
`resetall
