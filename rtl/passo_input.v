// SPDX-License-Identifier: MIT
// Inputs: synchronizer, polarity, glitch filter and sticky flag for WIDTH pins.
//
// `tick` ends the periods of the filter, which all inputs share: `level` follows an input that has differed from it on
// every clock from one tick to the next. Promise: with ticks every P clocks, a change of at most P clocks never reaches
// `level`, one of 2 P clocks or more always does, at most 2 P + 2 clocks after the pin. `was_active` is set while
// `level` is, and until it is cleared.
//
// `unknown` is 1 from a reset or `forget` until no input has changed for a whole period. Promise: when it falls, every
// `level` is that of its input, which it has had for P clocks; stable inputs are known at most 2 P + 2 clocks later.
// Latency: pin to `synced` 2 clocks.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_input #(
  parameter WIDTH = 1
) (
  input  wire             clk,
  input  wire             rst,
  input  wire [WIDTH-1:0] pins,
  input  wire [WIDTH-1:0] inverted,
  input  wire             tick,
  input  wire             forget,      // strobe: polarity or filter change with the next clock
  input  wire [WIDTH-1:0] clear,
  output wire [WIDTH-1:0] synced,      // 1 = active, not filtered
  output reg  [WIDTH-1:0] level,       // filtered
  output reg  [WIDTH-1:0] was_active,
  output reg              unknown
);

  (* async_reg = "true" *)
  reg  [WIDTH-1:0] first;
  (* async_reg = "true" *)
  reg  [WIDTH-1:0] second;
  reg  [WIDTH-1:0] pending;  // has differed since the last tick
  wire [WIDTH-1:0] differs = second ^ level;

  // Kept: a LUT for two inputs.
  localparam PAIRS = (WIDTH + 1) / 2;
  (* keep *)
  wire [PAIRS-1:0] changes;
  genvar pair;
  generate
    for (pair = 0; pair < PAIRS; pair = pair + 1) begin : g_changes
      if (pair * 2 + 1 < WIDTH) begin : g_two
        assign changes[pair] = first[pair*2+:2] != second[pair*2+:2];
      end else begin : g_one
        assign changes[pair] = first[pair*2] != second[pair*2];
      end
    end
  endgenerate

  reg changed;  // an input has changed since the last tick
  reg forgot;  // one clock ago: the synchronizer still holds old levels

  assign synced = second;

  always @(posedge clk) begin
    first      <= pins ^ inverted;
    second     <= first;
    level      <= level ^ (differs & pending & {WIDTH{tick}});
    pending    <= differs & (pending ^ {WIDTH{tick}});
    was_active <= (was_active & ~clear) | level;
    changed    <= forgot | (changes != {PAIRS{1'b0}}) | (changed & ~tick);
    forgot     <= 1'b0;
    if (tick && !changed) unknown <= 1'b0;
    if (rst || forget) begin
      changed <= 1'b1;
      forgot  <= 1'b1;
      unknown <= 1'b1;
    end
    if (rst) begin
      first      <= {WIDTH{1'b0}};
      second     <= {WIDTH{1'b0}};
      level      <= {WIDTH{1'b0}};
      pending    <= {WIDTH{1'b0}};
      was_active <= {WIDTH{1'b0}};
    end
  end

`ifdef FORMAL
  `include "passo_input_formal.vh"
`endif

endmodule
`resetall
