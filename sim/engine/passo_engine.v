// SPDX-License-Identifier: MIT
// The core with a clock of its own. Generated from spec/pins.toml by spec/generate_pins.py.
//
// A change of `go` runs clocks: up to `limit`, at least 1, ending with the first on which an output other
// than MISO is not as it was after the clock before. Then `clocks` is their number, and clk is low. They are
// one evaluation of a simulator: each evaluation costs time of its own.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_engine #(
  parameter integer CHANNELS = 1,
  parameter integer AXES = 4,
  parameter integer TICK_LOG2 = 7,
  parameter integer LINE_QUEUE_LOG2 = 8,
  parameter integer RAMP_QUEUE_LOG2 = 4,
  parameter integer INPUTS = 0,
  parameter integer ENCODERS = 0,
  parameter integer OUTPUTS = 0,
  parameter integer RASTER = 0,
  parameter integer COMPARE = 0,
  parameter integer TRACKERS = 0,
  parameter integer TRACKED = 0,
  parameter [31:0] CLOCK_HZ = 0,
  parameter [31:0] BUILD = 0,
  parameter [CHANNELS*AXES-1:0] STEP_RESET = 0,
  parameter [CHANNELS*AXES-1:0] DIR_RESET = 0,
  parameter [CHANNELS*AXES-1:0] ENABLE_RESET = 0
) (
  input wire rst,
  input wire spi_sclk,
  input wire spi_mosi,
  input wire spi_cs_n,
  input wire sync,
  input wire estop_n,
  input wire [CHANNELS*AXES-1:0] limit_low,
  input wire [CHANNELS*AXES-1:0] limit_high,
  input wire [CHANNELS*AXES-1:0] home,
  input wire [CHANNELS*AXES-1:0] alarm,
  input wire [CHANNELS-1:0] probe,
  input wire [CHANNELS*AXES-1:0] encoder_a,
  input wire [CHANNELS*AXES-1:0] encoder_b,
  input wire [CHANNELS*AXES-1:0] encoder_index,
  output wire [CHANNELS*AXES-1:0] step,
  output wire [CHANNELS*AXES-1:0] dir,
  output wire [CHANNELS*AXES-1:0] enable,
  output wire [CHANNELS-1:0] running,
  output wire irq,
  output wire [CHANNELS*8-1:0] outputs,
  output wire [CHANNELS-1:0] power,
  output wire [CHANNELS-1:0] compare,
  output wire spi_miso,
  input wire go,
  input wire [15:0] limit,
  output reg [15:0] clocks
);

  localparam PINS = CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS + 1 + CHANNELS*8 + CHANNELS + CHANNELS;

  reg             clk = 1'b0;
  reg             went = 1'b0;
  reg  [PINS-1:0] pins_before = {PINS{1'b0}};
  wire [PINS-1:0] pins = {step, dir, enable, running, irq, outputs, power, compare};

  always @(posedge go or negedge go or posedge clk or negedge clk) begin
    if (clk) begin
      clk    <= 1'b0;
      clocks <= clocks + 16'd1;
    end else if (went != go) begin
      clk    <= 1'b1;
      went   <= go;
      clocks <= 16'd0;
    end else begin
      clk         <= clocks != limit && pins == pins_before;
      pins_before <= pins;
    end
  end

`ifdef PASSO_NETLIST
  passo_spi_top u_core (
`else
  passo_spi_top #(
    .CHANNELS(CHANNELS),
    .AXES(AXES),
    .TICK_LOG2(TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS(INPUTS),
    .ENCODERS(ENCODERS),
    .OUTPUTS(OUTPUTS),
    .RASTER(RASTER),
    .COMPARE(COMPARE),
    .TRACKERS(TRACKERS),
    .TRACKED(TRACKED),
    .CLOCK_HZ(CLOCK_HZ),
    .BUILD(BUILD),
    .STEP_RESET(STEP_RESET),
    .DIR_RESET(DIR_RESET),
    .ENABLE_RESET(ENABLE_RESET)
  ) u_core (
`endif
    .spi_miso_enable(),
    .clk(clk),
    .rst(rst),
    .spi_sclk(spi_sclk),
    .spi_mosi(spi_mosi),
    .spi_cs_n(spi_cs_n),
    .sync(sync),
    .estop_n(estop_n),
    .limit_low(limit_low),
    .limit_high(limit_high),
    .home(home),
    .alarm(alarm),
    .probe(probe),
    .encoder_a(encoder_a),
    .encoder_b(encoder_b),
    .encoder_index(encoder_index),
    .step(step),
    .dir(dir),
    .enable(enable),
    .running(running),
    .irq(irq),
    .outputs(outputs),
    .power(power),
    .compare(compare),
    .spi_miso(spi_miso)
  );

endmodule
`resetall
