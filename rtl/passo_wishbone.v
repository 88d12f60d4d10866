// SPDX-License-Identifier: MIT
// Passo behind Wishbone B4 (classic cycles, 32 bits), for a CPU in the same FPGA.
//
// The two registers of passo_words; its errors end the cycle with ERR. ACK or ERR comes one clock after STB; an
// access that must wait for the previous word takes up to 128 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_wishbone #(
  parameter integer CHANNELS = 1,  // 1 .. 8
  parameter integer AXES = 4,  // per channel, 1 .. 8
  parameter integer TICK_LOG2 = 7,  // clocks per tick, 7 .. 16
  parameter integer LINE_QUEUE_LOG2 = 8,  // log2 of the places for lines, 2 .. 8
  parameter integer RAMP_QUEUE_LOG2 = 4,  // log2 of the places for ramps, 2 .. 8
  parameter integer STEPS_REGISTER = 0,  // 1: block RAMs have an output register
  parameter integer INPUTS = 0,  // 1: limits, home, alarm, probe, e-stop
  parameter integer ENCODERS = 0,  // 1: encoders
  parameter integer OUTPUTS = 0,  // 1: outputs bound to the path
  parameter integer RASTER = 0,  // 1, with OUTPUTS: raster lines
  parameter integer COMPARE = 0,  // 1, with OUTPUTS: pulses at positions
  parameter integer TRACKERS = 0,  // 1: a second hand on every axis
  parameter integer TRACKED = 0,  // the last axes of a channel have no lines: only their trackers move them
  parameter [31:0] CLOCK_HZ = 0,  // of clk, for the host to read; 0: not told
  parameter [31:0] BUILD = 0,  // identifies the bitstream, for the host to read
  // pin levels from configuration until the host writes polarities; bit channel * AXES + axis
  parameter [CHANNELS*AXES-1:0] STEP_RESET = 0,
  parameter [CHANNELS*AXES-1:0] DIR_RESET = 0,
  parameter [CHANNELS*AXES-1:0] ENABLE_RESET = 0
) (
  input  wire                     clk,
  input  wire                     rst,
  // Wishbone slave, byte addresses; bits 1:0 are ignored
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire                     wb_cyc_i,
  input  wire                     wb_stb_i,
  input  wire                     wb_we_i,
  input  wire [              2:0] wb_adr_i,
  input  wire [              3:0] wb_sel_i,
  input  wire [             31:0] wb_dat_i,
  output wire [             31:0] wb_dat_o,
  output wire                     wb_ack_o,
  output wire                     wb_err_o,
  /* verilator lint_on UNUSEDSIGNAL */
  // starts several chips on one edge
  input  wire                     sync,
  // machine: bit channel * AXES + axis; ignored without INPUTS
  input  wire [CHANNELS*AXES-1:0] limit_low,
  input  wire [CHANNELS*AXES-1:0] limit_high,
  input  wire [CHANNELS*AXES-1:0] home,
  input  wire [CHANNELS*AXES-1:0] alarm,
  input  wire [     CHANNELS-1:0] probe,
  input  wire                     estop_n,        // asynchronous
  // encoders; ignored without ENCODERS
  input  wire [CHANNELS*AXES-1:0] encoder_a,
  input  wire [CHANNELS*AXES-1:0] encoder_b,
  input  wire [CHANNELS*AXES-1:0] encoder_index,
  // drives: bit channel * AXES + axis
  output wire [CHANNELS*AXES-1:0] step,
  output wire [CHANNELS*AXES-1:0] dir,
  output wire [CHANNELS*AXES-1:0] enable,
  // outputs bound to the path; 0 without OUTPUTS
  output wire [   CHANNELS*8-1:0] outputs,
  output wire [     CHANNELS-1:0] power,
  output wire [     CHANNELS-1:0] compare,
  // to the host
  output wire [     CHANNELS-1:0] running,
  output wire                     irq             // a channel is stopped
);

  wire        frame_start;
  wire        frame_end;
  wire        half_valid;
  wire        half_low;
  wire [15:0] half;
  wire [31:0] reply_word;

  wire request = wb_cyc_i & wb_stb_i;
  wire address = wb_adr_i[2];
  wire done;
  wire error;

  assign wb_ack_o = done & ~error;
  assign wb_err_o = done & error;

  passo_words u_words (
    .clk        (clk),
    .rst        (rst),
    .request    (request),
    .write      (wb_we_i),
    .address    (address),
    .lanes      (wb_sel_i),
    .write_data (wb_dat_i),
    .done       (done),
    .error      (error),
    .read_data  (wb_dat_o),
    .frame_start(frame_start),
    .frame_end  (frame_end),
    .half_valid (half_valid),
    .half_low   (half_low),
    .half       (half),
    .reply_word (reply_word)
  );

  passo_core #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .STEPS_REGISTER (STEPS_REGISTER),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED),
    .CLOCK_HZ       (CLOCK_HZ),
    .BUILD          (BUILD),
    .STEP_RESET     (STEP_RESET),
    .DIR_RESET      (DIR_RESET),
    .ENABLE_RESET   (ENABLE_RESET)
  ) u_core (
    .clk          (clk),
    .rst          (rst),
    .frame_start  (frame_start),
    .frame_end    (frame_end),
    .half_valid   (half_valid),
    .half_low     (half_low),
    .half         (half),
    .reply_word   (reply_word),
    .sync         (sync),
    .limit_low    (limit_low),
    .limit_high   (limit_high),
    .home         (home),
    .alarm        (alarm),
    .probe        (probe),
    .estop_n      (estop_n),
    .encoder_a    (encoder_a),
    .encoder_b    (encoder_b),
    .encoder_index(encoder_index),
    .step         (step),
    .dir          (dir),
    .enable       (enable),
    .outputs      (outputs),
    .power        (power),
    .compare      (compare),
    .running      (running),
    .irq          (irq)
  );

`ifdef FORMAL
  `include "passo_wishbone_formal.vh"
`endif

endmodule
`resetall
