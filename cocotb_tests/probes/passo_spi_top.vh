// SPDX-License-Identifier: MIT
// The core, and a recorder of its pins.
//
// Clock 1 is the first rising edge ever without rst. Whenever a pin is not as it was a clock before, a row goes to pins.log:
//
//   clock; rst, sclk, mosi, cs_n, sync as bits 4 .. 0 and miso, all as they stand at its rising edge;
//   step, dir, enable, running, irq as the rising edge before left them
//
// in decimal numbers; one with an X in it is not a number.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_core_top #(
  parameter CHANNELS        = 1,
  parameter AXES            = 4,
  parameter TICK_LOG2       = 7,
  parameter LINE_QUEUE_LOG2 = 8,
  parameter RAMP_QUEUE_LOG2 = 4
) (
  input  wire                     clk,
  input  wire                     rst,
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
  output reg  [             31:0] clock
);

  localparam PINS = 6 + 3 * CHANNELS * AXES + CHANNELS + 1;

  wire    [PINS-1:0] pins = {rst, spi_sclk, spi_mosi, spi_cs_n, sync, spi_miso, step, dir, enable, running, irq};
  reg     [PINS-1:0] pins_before;
  reg                begun = 1'b0;
  integer            file;

  initial begin
    clock = 0;
    file  = $fopen("pins.log", "w");
  end

  always @(posedge clk) begin
    pins_before <= pins;
    if (begun || rst === 1'b0) begin
      begun <= 1'b1;
      clock <= clock + 1;
      if (!begun || pins !== pins_before) begin
        $fwrite(file, "%0d %0d %0d %0d %0d %0d %0d %0d\n", clock + 1,
                {rst, spi_sclk, spi_mosi, spi_cs_n, sync}, spi_miso, step, dir, enable, running, irq);
        $fflush(file);
      end
    end
  end

  passo_spi_top #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2)
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
