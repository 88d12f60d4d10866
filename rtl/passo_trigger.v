// SPDX-License-Identifier: MIT
// Trigger of a channel: one-shot edge capture.
//
// A write makes it `arming`; it is `armed` once the source has kept one `level` for more than `filter` clocks, and
// again after `forget`. Promise: once armed, the first selected edge fires it, if the new level lasts for more than
// `filter` clocks, and nothing else does. `latch` is a strobe, `filter` + 2 clocks after the first clock on which
// `sources` has the new level, and the action comes with it. A write replaces an earlier trigger. Armed while the
// source is active, it waits for the next selected edge.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_trigger #(
  parameter AXES = 4
) (
  input wire clk,
  input wire rst,
  input wire write,  // strobe with bus_data: the register TRIGGER
  input wire [16:0] bus_data,
  input wire [15:0] filter,  // clocks
  input wire forget,  // strobe: polarity or filter change with the next clock
  input wire [AXES*4-1:0] sources,  // limit_low, limit_high, home, index, each of all axes, not filtered
  input wire probe,
  output reg arming,
  output reg armed,
  output reg level,  // of the source, once armed: what it was last for more than `filter` clocks
  output reg fired,
  output reg latch,  // strobe
  output wire hard_stop,  // strobes, with latch: what it does
  output wire soft_stop,
  output wire end_endless
);

  `include "passo_registers.vh"

  reg [ 2:0] source;
  /* verilator lint_off UNUSEDSIGNAL */
  reg [ 2:0] axis;
  /* verilator lint_on UNUSEDSIGNAL */
  reg        falling;
  reg [ 1:0] action;
  reg [ 1:0] stale;  // clocks until `picked` is that of the source
  reg        picked;
  reg [15:0] count;  // clocks that `filter` still demands

  // The source among those of all axes: as many bits of `axis` as there are axes, and of `source` the lower two, which
  // tell all but limit_low and index.
  localparam AXIS_BITS = AXES > 4 ? 3 : AXES > 2 ? 2 : 1;
  wire [(1<<AXIS_BITS)-1:0] of_axis [0:3];
  wire [               3:0] of_kind;
  genvar kind;
  generate
    for (kind = 0; kind < 4; kind = kind + 1) begin : g_kind
      assign of_axis[kind] = {{((1 << AXIS_BITS) - AXES) {1'b0}}, sources[kind*AXES+:AXES]};
      assign of_kind[kind] = of_axis[kind][axis[AXIS_BITS-1:0]];
    end
  endgenerate
  wire chosen = source[1:0] == TRIGGER_SOURCE_LIMIT_HIGH[1:0] ? of_kind[1] :
                source[1:0] == TRIGGER_SOURCE_HOME[1:0]       ? of_kind[2] :
                source[1:0] == TRIGGER_SOURCE_PROBE[1:0]      ? probe :
                source[2] == TRIGGER_SOURCE_INDEX[2]          ? of_kind[3] : of_kind[0];

  wire differs = picked ^ level;
  wire counts = armed ? differs : arming & ~differs;  // an edge that may be one; a level that may be known
  // The count goes down to 0, and what enables it selects what it takes, so that each bit is one LUT.
  wire is_last = count == 16'd0;
  wire accepts = counts & is_last & (stale == 2'd0);
  wire runs = counts & ~is_last & (stale == 2'd0);
  wire fires = accepts & armed & (level == falling);

  assign hard_stop   = latch && action == TRIGGER_ACTION_HARD_STOP;
  assign soft_stop   = latch && action == TRIGGER_ACTION_SOFT_STOP;
  assign end_endless = latch && action == TRIGGER_ACTION_END_ENDLESS;

  always @(posedge clk) begin
    picked <= chosen;
    stale  <= write || forget ? 2'd3 : stale == 2'd0 ? 2'd0 : stale - 2'd1;
    latch  <= fires;
    arming <= forget ? arming | (armed & ~fires) : arming & ~accepts;
    armed  <= ~forget & ((armed & ~fires) | (arming & accepts));
    fired  <= fired | fires;
    count  <= runs ? count + {16{runs}} : filter;
    if (accepts || !armed) level <= picked;
    if (write) begin
      source  <= bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS];
      axis    <= bus_data[CHANNEL_TRIGGER_AXIS_LSB+:CHANNEL_TRIGGER_AXIS_BITS];
      falling <= bus_data[CHANNEL_TRIGGER_FALLING_LSB];
      action  <= bus_data[CHANNEL_TRIGGER_ACTION_LSB+:CHANNEL_TRIGGER_ACTION_BITS];
      arming  <= bus_data[CHANNEL_TRIGGER_ARM_LSB];
      armed   <= 1'b0;
      fired   <= 1'b0;
      latch   <= 1'b0;
    end
    if (rst) begin
      arming <= 1'b0;
      armed  <= 1'b0;
      fired  <= 1'b0;
      latch  <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_trigger_formal.vh"
`endif

endmodule
`resetall
