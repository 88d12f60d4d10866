// SPDX-License-Identifier: MIT
// Passo: a step-pulse generator behind a host interface. Frames in, STEP/DIR out, CHANNELS independent groups of
// AXES coordinated axes. Wiring only.
//
// The host interface delivers the words of a frame in halves of 16 bits and takes the words of the reply: passo_spi
// over SPI, passo_words for a bus in the same FPGA. Instantiate a top: passo_spi_top, passo_wishbone, passo_axi_lite.
//
// Reset: rst synchronous, active high.
// Latency: a rising edge of `sync` starts the armed channels 4 clocks later.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_core #(
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
  // host interface
  input  wire                     frame_start,    // strobes
  input  wire                     frame_end,
  input  wire                     half_valid,
  input  wire                     half_low,       // lower half of a word
  input  wire [             15:0] half,
  output wire [             31:0] reply_word,
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
  output reg                      irq             // a channel is stopped
);

  // bus
  wire [ 7:0] last_sequence;
  wire        bus_frame;
  wire        bus_commit;
  wire        bus_check;
  wire        bus_write;
  wire        bus_read;
  wire        bus_push;
  wire [11:0] bus_address;
  wire [31:0] bus_data;
  wire [ 4:0] bus_msb;
  wire        bus_one_hot;
  wire        bus_counters;
  wire        bus_claim;
  wire        bus_incomplete;
  wire        bus_busy;
  wire        needs_quiet;
  wire [ 3:0] rules_refusal;
  wire        registers_bad_value;
  wire [31:0] registers_read_data;
  wire        channels_bad_value;
  wire [ 3:0] channels_refusal;
  wire [31:0] channels_read_data;
  wire [ 3:0] bus_refusal = rules_refusal | channels_refusal;
  reg  [31:0] bus_read_data;

  // channels
  wire [                    CHANNELS-1:0] run;
  wire [                    CHANNELS-1:0] wait_sync;
  wire [                    CHANNELS-1:0] stopped;
  wire [                    CHANNELS-1:0] occupied;
  wire [CHANNELS*(LINE_QUEUE_LOG2+1)-1:0] line_room;
  wire [CHANNELS*(RAMP_QUEUE_LOG2+1)-1:0] ramp_room;

  // Unselected targets drive 0.
  always @(posedge clk) begin
    bus_read_data <= registers_read_data | channels_read_data;
    irq           <= stopped != {CHANNELS{1'b0}};
    if (rst) irq <= 1'b0;
  end

  passo_parameters #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED)
  ) u_parameters ();

  passo_link u_link (
    .clk           (clk),
    .rst           (rst),
    .frame_start   (frame_start),
    .frame_end     (frame_end),
    .half_valid    (half_valid),
    .half_low      (half_low),
    .half          (half),
    .reply_word    (reply_word),
    .last_sequence (last_sequence),
    .bus_frame     (bus_frame),
    .bus_commit    (bus_commit),
    .bus_check     (bus_check),
    .bus_write     (bus_write),
    .bus_read      (bus_read),
    .bus_push      (bus_push),
    .bus_address   (bus_address),
    .bus_data      (bus_data),
    .bus_msb       (bus_msb),
    .bus_one_hot   (bus_one_hot),
    .bus_claim     (bus_claim),
    .bus_refusal   (bus_refusal),
    .bus_read_data (bus_read_data),
    .bus_counters  (bus_counters),
    .bus_incomplete(bus_incomplete),
    .bus_busy      (bus_busy)
  );

  passo_rules #(
    .CHANNELS(CHANNELS),
    .AXES    (AXES),
    .INPUTS  (INPUTS),
    .ENCODERS(ENCODERS),
    .OUTPUTS (OUTPUTS),
    .RASTER  (RASTER),
    .COMPARE (COMPARE),
    .TRACKERS(TRACKERS)
  ) u_rules (
    .clk        (clk),
    .rst        (rst),
    .bus_check  (bus_check),
    .bus_read   (bus_read),
    .bus_push   (bus_push),
    .bus_address(bus_address),
    .bus_odd    (bus_data[0]),
    .bus_msb    (bus_msb),
    .bus_one_hot(bus_one_hot),
    .bad_value  (registers_bad_value | channels_bad_value),
    .claim      (bus_claim),
    .refusal    (rules_refusal),
    .needs_quiet(needs_quiet)
  );

  passo_registers #(
    .CHANNELS       (CHANNELS),
    .AXES           (AXES),
    .TICK_LOG2      (TICK_LOG2),
    .LINE_QUEUE_LOG2(LINE_QUEUE_LOG2),
    .RAMP_QUEUE_LOG2(RAMP_QUEUE_LOG2),
    .INPUTS         (INPUTS),
    .ENCODERS       (ENCODERS),
    .OUTPUTS        (OUTPUTS),
    .RASTER         (RASTER),
    .COMPARE        (COMPARE),
    .TRACKERS       (TRACKERS),
    .TRACKED        (TRACKED),
    .CLOCK_HZ       (CLOCK_HZ),
    .BUILD          (BUILD)
  ) u_registers (
    .clk          (clk),
    .rst          (rst),
    .bus_write    (bus_write),
    .bus_read     (bus_read),
    .bus_address  (bus_address),
    .bus_data     (bus_data[18:0]),
    .bad_value    (registers_bad_value),
    .read_data    (registers_read_data),
    .is_counters  (bus_counters),
    .last_sequence(last_sequence),
    .run          (run),
    .wait_sync    (wait_sync),
    .any_stopped  (stopped != {CHANNELS{1'b0}}),
    .any_occupied (occupied != {CHANNELS{1'b0}}),
    .line_room    (line_room),
    .ramp_room    (ramp_room)
  );

  passo_channels #(
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
    .STEP_RESET     (STEP_RESET),
    .DIR_RESET      (DIR_RESET),
    .ENABLE_RESET   (ENABLE_RESET)
  ) u_channels (
    .clk          (clk),
    .rst          (rst),
    .bus_frame    (bus_frame),
    .bus_commit   (bus_commit),
    .bus_check    (bus_check),
    .bus_write    (bus_write),
    .bus_read     (bus_read),
    .bus_push     (bus_push),
    .bus_address  (bus_address),
    .bus_data     (bus_data),
    .bus_msb      (bus_msb),
    .needs_quiet  (needs_quiet),
    .bad_value    (channels_bad_value),
    .refusal      (channels_refusal),
    .read_data    (channels_read_data),
    .incomplete   (bus_incomplete),
    .busy         (bus_busy),
    .snapshot     (frame_start),
    .run          (run),
    .wait_sync    (wait_sync),
    .stopped      (stopped),
    .occupied     (occupied),
    .line_room    (line_room),
    .ramp_room    (ramp_room),
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
    .running      (running)
  );

`ifdef FORMAL
  `include "passo_core_formal.vh"
`endif

endmodule
`resetall
