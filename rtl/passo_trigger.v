// SPDX-License-Identifier: MIT
// Trigger of a channel: one input, one edge, once.
//
// Promise: from arming on, the first wanted edge of the chosen source fires it, if the new level lasts for more than
// `filter` clocks, and only that; until it is armed it does nothing. `latch` is a strobe, `filter` + 2 clocks after the
// first clock on which `sources` has the new level: positions and `clocks`, the time since arming, are those of that
// clock. The action comes with it. A write ends what was armed before. Armed while the source is active, it waits for
// the next edge that is wanted.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_trigger #(
  parameter AXES = 4
) (
  input  wire              clk,
  input  wire              rst,
  input  wire              write,       // strobe with bus_data: the register TRIGGER
  input  wire [      16:0] bus_data,
  input  wire [      15:0] filter,      // clocks
  input  wire [AXES*4-1:0] sources,     // limit_low, limit_high, home, index, each of all axes, not filtered
  input  wire              probe,
  output reg               armed,
  output reg               fired,
  output reg  [      31:0] clocks,
  output reg               latch,       // strobe
  output wire              hard_stop,   // strobes, with latch: what it does
  output wire              soft_stop,
  output wire              end_endless
);

  `include "passo_registers.vh"

  reg [ 2:0] source;
  reg [ 2:0] axis;
  reg        falling;
  reg [ 1:0] action;
  reg [ 1:0] arming;  // clocks until `picked` is that of the source
  reg        picked;
  reg        level;  // what `picked` was last for more than `filter` clocks
  reg [15:0] count;

  // The source among those of all axes
  wire [7:0] of_axis[0:3];
  genvar kind;
  generate
    for (kind = 0; kind < 4; kind = kind + 1) begin : g_kind
      assign of_axis[kind] = {{(8 - AXES) {1'b0}}, sources[kind*AXES+:AXES]};
    end
  endgenerate
  wire chosen = source == TRIGGER_SOURCE_LIMIT_LOW  ? of_axis[0][axis] :
                source == TRIGGER_SOURCE_LIMIT_HIGH ? of_axis[1][axis] :
                source == TRIGGER_SOURCE_HOME       ? of_axis[2][axis] :
                source == TRIGGER_SOURCE_INDEX      ? of_axis[3][axis] : probe;

  wire differs = picked ^ level;
  wire changes = armed & differs & (count == filter);
  wire fires = changes & (level == falling);

  assign hard_stop   = latch && action == TRIGGER_ACTION_HARD_STOP;
  assign soft_stop   = latch && action == TRIGGER_ACTION_SOFT_STOP;
  assign end_endless = latch && action == TRIGGER_ACTION_END_ENDLESS;

  always @(posedge clk) begin
    picked <= chosen;
    arming <= {arming[0] & ~write, write & bus_data[CHANNEL_TRIGGER_ARM_LSB]};
    latch  <= fires;
    armed  <= (armed & ~fires) | arming[1];
    fired  <= fired | fires;
    count  <= count + 16'd1;
    if (!differs || changes || !armed) count <= 16'd0;
    if (changes || arming[1]) level <= picked;
    if (armed) clocks <= clocks + 32'd1;
    if (write) begin
      source  <= bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS];
      axis    <= bus_data[CHANNEL_TRIGGER_AXIS_LSB+:CHANNEL_TRIGGER_AXIS_BITS];
      falling <= bus_data[CHANNEL_TRIGGER_FALLING_LSB];
      action  <= bus_data[CHANNEL_TRIGGER_ACTION_LSB+:CHANNEL_TRIGGER_ACTION_BITS];
      armed   <= 1'b0;
      fired   <= 1'b0;
      latch   <= 1'b0;
    end
    if (arming[1]) clocks <= 32'd0;
    if (rst) begin
      arming <= 2'b00;
      armed  <= 1'b0;
      fired  <= 1'b0;
      latch  <= 1'b0;
      clocks <= 32'd0;
    end
  end

`ifdef FORMAL
  `include "passo_trigger_formal.vh"
`endif

endmodule
`resetall
