// SPDX-License-Identifier: MIT
// Rules of the registers: what each access of a frame is answered, from the table that is generated from their
// definition. What a register does is in its block; a word pushed to a queue is judged by the queue.
//
// Promise: a strobe is answered one clock later, for one clock: `claim` if there is a register at the address with
// these parameters, `refusal` if it does not take the access. `needs_quiet` is high with the strobe of a check of a
// register that needs a quiet channel. `bad_value`, in the clock before a check, refuses a word that the table
// allows; `bus_msb` and `bus_one_hot` describe the magnitude of the word.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_rules #(
  parameter CHANNELS = 1,
  parameter AXES     = 4,
  parameter INPUTS   = 0,
  parameter ENCODERS = 0,
  parameter OUTPUTS  = 0
) (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        bus_check,
  input  wire        bus_read,
  input  wire        bus_push,
  input  wire [11:0] bus_address,
  input  wire        bus_lsb,      // bit 0 of checked data
  input  wire [ 4:0] bus_msb,      // index of its highest set bit
  input  wire        bus_one_hot,  // no other bit is set
  input  wire        bad_value,
  output reg         claim,
  output reg  [ 3:0] refusal,
  output wire        needs_quiet
);

  `include "passo_registers.vh"

  // A rule: the highest bit that a word may have, and flags
  localparam [12:0] RULE_READ = 13'h0020;
  localparam [12:0] RULE_WRITE = 13'h0040;
  localparam [12:0] RULE_PUSH = 13'h0080;
  localparam [12:0] RULE_QUIET = 13'h0100;  // needs a quiet channel
  localparam [12:0] RULE_NONZERO = 13'h0200;  // not 0
  localparam [12:0] RULE_POWER = 13'h0400;  // with its highest bit a word has no other
  localparam [12:0] RULE_EVEN = 13'h0800;  // bit 0 is not defined
  localparam [12:0] RULE_AXIS = 13'h1000;  // a word for each axis
  localparam [12:0] WITH_INPUTS = {13{INPUTS != 0}};
  localparam [12:0] WITH_ENCODERS = {13{ENCODERS != 0}};
  localparam [12:0] WITH_OUTPUTS = {13{OUTPUTS != 0}};

  `include "passo_register_rules.vh"

  // Decoded ahead of the strobe: the address is stable by then.
  wire [12:0] found = bus_address[11:8] == 4'd0 ? core_rule(
      bus_address[7:0]
  ) : bus_address[11:10] == ADDRESS_COSINE_BASE[11:10] ? RULE_SHAPE : !bus_address[7] ? channel_rule(
      bus_address[7:0]
  ) : bus_address[6] ? encoder_rule(
      bus_address[2:0]
  ) : axis_rule(
      bus_address[2:0]
  );
  wire in_channels = bus_address[11:8] <= CHANNELS[3:0];
  wire in_tables = bus_address[11:10] == ADDRESS_COSINE_BASE[11:10] && bus_address[9:8] != 2'd0;
  wire [2:0] axis = bus_address[7] ? bus_address[5:3] : bus_address[2:0];

  reg there;
  reg axis_there;
  reg readable;
  reg writable;
  reg pushable;
  reg quiet;
  reg nonzero;
  reg power;
  reg even;
  reg of_axis;
  reg [4:0] msb;
  reg bad;
  wire known = there & (axis_there | ~of_axis) & (readable | writable | pushable);

  assign needs_quiet = bus_check & known & quiet;

  always @(posedge clk) begin
    there <= in_channels | in_tables;
    axis_there <= {1'b0, axis} < AXES[3:0];
    {of_axis, even, power, nonzero, quiet, pushable, writable, readable, msb} <= found;
    if (bus_address[11:8] != 4'd0 && bus_address[7]) of_axis <= 1'b1;
    if (in_tables) of_axis <= 1'b0;
    bad <= {bus_msb, power & ~bus_one_hot} > {msb, 1'b0} || (nonzero && bus_msb == 5'd0 && !bus_lsb)
           || (even && bus_lsb) || bad_value;
    claim <= known && (bus_check || bus_read);
    refusal <= !known                 ? VERDICT_OK :
               bus_read               ? (readable ? VERDICT_OK : VERDICT_BAD_OPERATION) :
               !bus_check             ? VERDICT_OK :
               bus_push != pushable   ? VERDICT_BAD_OPERATION :
               pushable               ? VERDICT_OK :
               !writable              ? VERDICT_READ_ONLY :
               bad                    ? VERDICT_BAD_VALUE : VERDICT_OK;
    if (rst) begin
      claim   <= 1'b0;
      refusal <= VERDICT_OK;
    end
  end

endmodule
`resetall
