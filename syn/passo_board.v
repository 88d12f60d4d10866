// SPDX-License-Identifier: MIT
// Top module of every board: PLL, reset, heartbeat, the core and its pins.
//
// `make synth` generates `passo_board_pll` and the pin file from syn/<board>/board.toml; families/ has the cells.
//
// Promise: the core is in reset from configuration until 16 clocks after the PLL has locked, and again whenever it
// loses lock. From configuration until the host first writes to them, STEP, DIR and EN have the levels of their
// parameters; by default STEP and DIR are low and EN is high, which disables common drives. `led` toggles every half
// to one second while clk runs and the core is out of reset.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_board #(
  parameter            AXES             = 4,
  parameter [    31:0] CLOCK_HZ         = 100_000_000,   // of the PLL; the core tells it to the host
  parameter [    31:0] BUILD            = 0,             // of this bitstream; the core tells it to the host
  parameter            RUNNING_INVERTED = 0,
  parameter            IRQ_INVERTED     = 0,
  parameter            LED_INVERTED     = 0,
  parameter            STEPS_REGISTER   = 0,             // parameters of the core, from here on
  parameter            INPUTS           = 0,
  parameter            ENCODERS         = 0,
  parameter            OUTPUTS          = 0,
  parameter            RASTER           = 0,
  parameter            COMPARE          = 0,
  parameter            TRACKERS         = 0,
  parameter            TRACKED          = 0,
  parameter            OUTPUT_PINS      = 8,             // of the core's 8 outputs
  parameter [AXES-1:0] LOW_AT_HOME      = {AXES{1'b0}},  // axes whose limit is at the pin of their home
  parameter [AXES-1:0] HIGH_AT_HOME     = {AXES{1'b0}},
  parameter [AXES-1:0] ENCODER_WIRED    = {AXES{1'b1}},  // axes with an encoder, the only ones with cells
  parameter [AXES-1:0] STEP_RESET       = {AXES{1'b0}},
  parameter [AXES-1:0] DIR_RESET        = {AXES{1'b0}},
  parameter [AXES-1:0] ENABLE_RESET     = {AXES{1'b1}}
) (
  input  wire                   oscillator,
  input  wire                   spi_sclk,
  input  wire                   spi_mosi,
  input  wire                   spi_cs_n,
  output wire                   spi_miso,
  input  wire                   sync,
  input  wire [       AXES-1:0] limit_low,
  input  wire [       AXES-1:0] limit_high,
  input  wire [       AXES-1:0] home,
  input  wire [       AXES-1:0] alarm,
  input  wire                   probe,
  input  wire                   estop_n,
  input  wire [       AXES-1:0] encoder_a,
  input  wire [       AXES-1:0] encoder_b,
  input  wire [       AXES-1:0] encoder_index,
  output wire [       AXES-1:0] step,
  output wire [       AXES-1:0] dir,
  output wire [       AXES-1:0] enable,
  output wire [OUTPUT_PINS-1:0] outputs,
  output wire                   power,
  output wire                   compare,
  output wire                   running,
  output wire                   irq,
  output wire                   led
);

  wire       clk;
  wire       locked;  // asynchronous
  wire       sclk;
  wire       miso;
  wire       miso_enable;
  wire       core_running;
  wire       core_irq;
  wire [7:0] core_outputs;

  passo_board_pll u_pll (
    .oscillator(oscillator),
    .clk       (clk),
    .locked    (locked)
  );

  passo_clock_pin u_sclk (
    .pin(spi_sclk),
    .clk(sclk)
  );

  passo_tristate_pin u_miso (
    .data  (miso),
    .enable(miso_enable),
    .pin   (spi_miso)
  );

  // The initial value of flip-flops is 0 in all of these FPGAs, so the counter counts up to release the
  // reset.
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

  // The core has a synchronous reset: a second flip-flop synchronizes the release of the asynchronous one.
  reg rst = 1'b1;
  always @(posedge clk) rst <= ~rst_n;

  localparam BEATS = $clog2(CLOCK_HZ);

  reg [BEATS-1:0] beat = {BEATS{1'b0}};

  always @(posedge clk)
    if (rst) beat <= {BEATS{1'b0}};
    else beat <= beat + 1'b1;

  assign led     = beat[BEATS-1] ^ (LED_INVERTED != 0);
  assign running = core_running ^ (RUNNING_INVERTED != 0);
  assign irq     = core_irq ^ (IRQ_INVERTED != 0);
  assign outputs = core_outputs[OUTPUT_PINS-1:0];

  // A switch may be home and limit of its axis.
  wire [AXES-1:0] core_low = limit_low & ~LOW_AT_HOME | home & LOW_AT_HOME;
  wire [AXES-1:0] core_high = limit_high & ~HIGH_AT_HOME | home & HIGH_AT_HOME;

  // An encoder that is not fitted never counts.
  wire [AXES-1:0] core_a = encoder_a & ENCODER_WIRED;
  wire [AXES-1:0] core_b = encoder_b & ENCODER_WIRED;
  wire [AXES-1:0] core_index = encoder_index & ENCODER_WIRED;

  passo_spi_top #(
    .CHANNELS      (1),
    .AXES          (AXES),
    .STEPS_REGISTER(STEPS_REGISTER),
    .INPUTS        (INPUTS),
    .ENCODERS      (ENCODERS),
    .OUTPUTS       (OUTPUTS),
    .RASTER        (RASTER),
    .COMPARE       (COMPARE),
    .TRACKERS      (TRACKERS),
    .TRACKED       (TRACKED),
    .CLOCK_HZ      (CLOCK_HZ),
    .BUILD         (BUILD),
    .STEP_RESET    (STEP_RESET),
    .DIR_RESET     (DIR_RESET),
    .ENABLE_RESET  (ENABLE_RESET)
  ) u_core (
    .clk            (clk),
    .rst            (rst),
    .spi_sclk       (sclk),
    .spi_mosi       (spi_mosi),
    .spi_cs_n       (spi_cs_n),
    .spi_miso       (miso),
    .spi_miso_enable(miso_enable),
    .sync           (sync),
    .limit_low      (core_low),
    .limit_high     (core_high),
    .home           (home),
    .alarm          (alarm),
    .probe          (probe),
    .estop_n        (estop_n),
    .encoder_a      (core_a),
    .encoder_b      (core_b),
    .encoder_index  (core_index),
    .step           (step),
    .dir            (dir),
    .enable         (enable),
    .outputs        (core_outputs),
    .power          (power),
    .compare        (compare),
    .running        (core_running),
    .irq            (core_irq)
  );

endmodule
`resetall
