// SPDX-License-Identifier: MIT
// Passo behind AXI4-Lite, for a CPU in the same FPGA.
//
// The two registers of passo_words; its errors return SLVERR. One access at a time: a write is accepted once its
// address and data are valid, a read while no write is, or after a write; each is answered before the next is
// accepted. A read therefore waits for at most one write: 264 clocks, if the master accepts responses immediately.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_axi_lite #(
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
  // AXI4-Lite slave, byte addresses; bits 1:0 and the protection are ignored
  /* verilator lint_off UNUSEDSIGNAL */
  input  wire [              2:0] s_axil_awaddr,
  input  wire [              2:0] s_axil_awprot,
  input  wire                     s_axil_awvalid,
  output wire                     s_axil_awready,
  input  wire [             31:0] s_axil_wdata,
  input  wire [              3:0] s_axil_wstrb,
  input  wire                     s_axil_wvalid,
  output wire                     s_axil_wready,
  output wire [              1:0] s_axil_bresp,
  output reg                      s_axil_bvalid,
  input  wire                     s_axil_bready,
  input  wire [              2:0] s_axil_araddr,
  input  wire [              2:0] s_axil_arprot,
  input  wire                     s_axil_arvalid,
  output wire                     s_axil_arready,
  output wire [             31:0] s_axil_rdata,
  output wire [              1:0] s_axil_rresp,
  output reg                      s_axil_rvalid,
  input  wire                     s_axil_rready,
  /* verilator lint_on UNUSEDSIGNAL */
  // starts several chips on one edge
  input  wire                     sync,
  // machine: bit channel * AXES + axis; ignored without INPUTS
  input  wire [CHANNELS*AXES-1:0] limit_low,
  input  wire [CHANNELS*AXES-1:0] limit_high,
  input  wire [CHANNELS*AXES-1:0] home,
  input  wire [CHANNELS*AXES-1:0] alarm,
  input  wire [     CHANNELS-1:0] probe,
  input  wire                     estop_n,         // asynchronous
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
  output wire                     irq              // a channel is stopped
);

  wire        frame_start;
  wire        frame_end;
  wire        half_valid;
  wire        half_low;
  wire [15:0] half;
  wire [31:0] reply_word;

  wire done;
  wire error;
  reg  reads_next;  // the last access was a write
  wire write = s_axil_awvalid & s_axil_wvalid & ~(reads_next & s_axil_arvalid);
  reg  write_q;  // `done` belongs to a write
  wire answering = s_axil_bvalid | s_axil_rvalid;

  assign s_axil_awready = done & write_q;
  assign s_axil_wready  = done & write_q;
  assign s_axil_arready = done & ~write_q;
  assign s_axil_bresp   = {error, 1'b0};
  assign s_axil_rresp   = {error, 1'b0};

  always @(posedge clk) begin
    write_q <= write;
    if (done) reads_next <= write_q;
    s_axil_bvalid <= s_axil_bvalid ? ~s_axil_bready : s_axil_awready;
    s_axil_rvalid <= s_axil_rvalid ? ~s_axil_rready : s_axil_arready;
    if (rst) begin
      reads_next    <= 1'b0;
      s_axil_bvalid <= 1'b0;
      s_axil_rvalid <= 1'b0;
    end
  end

  passo_words u_words (
    .clk        (clk),
    .rst        (rst),
    .request    ((write | s_axil_arvalid) & ~answering),
    .write      (write),
    .address    (write ? s_axil_awaddr[2] : s_axil_araddr[2]),
    .lanes      (write ? s_axil_wstrb : 4'hF),
    .write_data (s_axil_wdata),
    .done       (done),
    .error      (error),
    .read_data  (s_axil_rdata),
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
  `include "passo_axi_lite_formal.vh"
`endif

endmodule
`resetall
