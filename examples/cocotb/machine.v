// SPDX-License-Identifier: MIT
// A machine of two axes around the core: a door that stops it, and a lamp that shows that it moves.

`timescale 1ns / 1ps

module machine (
  input  wire       clk,
  input  wire       rst,
  input  wire       spi_sclk,
  input  wire       spi_mosi,
  input  wire       spi_cs_n,
  output wire       spi_miso,
  input  wire       door_open,
  output wire [1:0] step,
  output wire [1:0] dir,
  output wire [1:0] enable,
  output reg        lamp
);

  wire running;

  initial lamp = 1'b0;

  always @(posedge clk) lamp <= running && !rst;

  passo_spi_top #(
    .CHANNELS(1),
    .AXES    (2),
    .INPUTS  (1)
  ) core (
    .clk          (clk),
    .rst          (rst),
    .spi_sclk     (spi_sclk),
    .spi_mosi     (spi_mosi),
    .spi_cs_n     (spi_cs_n),
    .spi_miso     (spi_miso),
    .sync         (1'b0),
    .estop_n      (!door_open),
    .limit_low    (2'b00),
    .limit_high   (2'b00),
    .home         (2'b00),
    .alarm        (2'b00),
    .probe        (1'b0),
    .encoder_a    (2'b00),
    .encoder_b    (2'b00),
    .encoder_index(2'b00),
    .step         (step),
    .dir          (dir),
    .enable       (enable),
    .running      (running),
    .irq          (),
    .outputs      (),
    .power        (),
    .compare      ()
  );

endmodule
