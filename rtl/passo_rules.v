// SPDX-License-Identifier: MIT
// Rules of the registers: what each access of a frame is answered, from the table that is generated from their
// definition. What a register does is in its block; a word that is pushed is judged by its queue.
//
// Promise: a strobe is answered one clock later, for one clock: `claim` if there is a register at the address with
// these parameters, `refusal` if it does not take the access. `needs_quiet` is high with the strobe of a check of a
// register that needs a quiet channel. `bad_value` in the clock before a check refuses a word that its rule allows.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_rules #(
  parameter CHANNELS = 1,
  parameter AXES     = 4,
  parameter INPUTS   = 0,
  parameter ENCODERS = 0,
  parameter OUTPUTS  = 0,
  parameter RASTER   = 0,
  parameter COMPARE  = 0,
  parameter TRACKERS = 0
) (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        bus_check,
  input  wire        bus_read,
  input  wire        bus_push,
  input  wire [11:0] bus_address,
  input  wire        bus_odd,      // bit 0 of checked data
  input  wire [ 4:0] bus_msb,      // index of their highest set bit
  input  wire        bus_one_hot,  // no other bit is set
  input  wire        bad_value,
  output reg         claim,
  output reg  [ 3:0] refusal,
  output wire        needs_quiet
);

  `include "passo_registers.vh"

  // A rule: flags, and the highest bit that a word may have
  localparam [12:0] RULE_AXIS = 13'h1000;  // of each axis
  localparam [12:0] RULE_EVEN = 13'h0800;  // bit 0 is not defined
  localparam [12:0] RULE_POWER = 13'h0400;  // no other bit may be set with the highest
  localparam [12:0] RULE_NONZERO = 13'h0200;
  localparam [12:0] RULE_QUIET = 13'h0100;  // the channel must be
  localparam [12:0] RULE_PUSH = 13'h0080;
  localparam [12:0] RULE_WRITE = 13'h0040;
  localparam [12:0] RULE_READ = 13'h0020;
  localparam [12:0] WITH_INPUTS = {13{INPUTS != 0}};
  localparam [12:0] WITH_ENCODERS = {13{ENCODERS != 0}};
  localparam [12:0] WITH_OUTPUTS = {13{OUTPUTS != 0}};
  localparam [12:0] WITH_RASTER = {13{RASTER != 0}};
  localparam [12:0] WITH_COMPARE = {13{COMPARE != 0}};
  localparam [12:0] WITH_TRACKERS = {13{TRACKERS != 0}};

  `include "passo_register_rules.vh"

  // Found ahead of the strobe: the address is stable by then.
  wire        in_core = bus_address[11:8] == 4'd0;
  wire        in_tables = bus_address[11:10] == ADDRESS_COSINE_BASE[11:10] && bus_address[9:8] != 2'd0;
  wire        in_axes = bus_address[7];
  wire [ 2:0] axis = in_axes ? bus_address[5:3] : bus_address[2:0];
  wire [12:0] of_core = core_rule(bus_address[7:0]);
  wire [12:0] of_channel = channel_rule({1'b0, bus_address[6:0]});
  wire [12:0] of_axis = bus_address[6] ? encoder_rule(bus_address[2:0]) : axis_rule(bus_address[2:0]);

  reg         there;  // the core, a channel, a table
  reg         axis_there;
  reg  [12:0] rule;
  wire        each_axis = (rule & RULE_AXIS) != 13'd0;
  wire        even = (rule & RULE_EVEN) != 13'd0;
  wire        power = (rule & RULE_POWER) != 13'd0;
  wire        nonzero = (rule & RULE_NONZERO) != 13'd0;
  wire        quiet = (rule & RULE_QUIET) != 13'd0;
  wire        pushable = (rule & RULE_PUSH) != 13'd0;
  wire        writable = (rule & RULE_WRITE) != 13'd0;
  wire        readable = (rule & RULE_READ) != 13'd0;

  reg known;
  reg bad;

  assign needs_quiet = bus_check & known & quiet;

  always @(posedge clk) begin
    there <= in_tables || bus_address[11:8] <= CHANNELS[3:0];
    axis_there <= {1'b0, axis} < AXES[3:0];
    rule <= in_tables ? RULE_SHAPE : in_core ? of_core : in_axes ? of_axis | RULE_AXIS : of_channel;
    known <= there && (axis_there || !each_axis) && (pushable || writable || readable);
    bad <= {bus_msb, power & ~bus_one_hot} > {rule[4:0], 1'b0} || (nonzero && bus_msb == 5'd0 && !bus_odd)
           || (even && bus_odd) || bad_value;
    claim <= known && (bus_check || bus_read);
    refusal <= !known                ? VERDICT_OK :
               bus_read              ? (readable ? VERDICT_OK : VERDICT_BAD_OPERATION) :
               !bus_check            ? VERDICT_OK :
               bus_push != pushable  ? VERDICT_BAD_OPERATION :
               pushable              ? VERDICT_OK :
               !writable             ? VERDICT_READ_ONLY :
               bad                   ? VERDICT_BAD_VALUE : VERDICT_OK;
    if (rst) begin
      claim   <= 1'b0;
      refusal <= VERDICT_OK;
    end
  end

endmodule
`resetall
