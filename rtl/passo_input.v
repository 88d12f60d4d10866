// SPDX-License-Identifier: MIT
// Inputs: synchroniser, polarity, glitch filter and a flag that remembers, for WIDTH pins.
//
// `tick` ends the periods of the filter, which all inputs share: `level` follows an input that has differed from it on
// every clock from one tick to the next. Promise: with ticks every F clocks, a change of at most F clocks never reaches
// `level`, one of 2 F clocks or more always does, at most 2 F + 2 clocks after the pin. `was_active` is set while
// `level` is, and until it is cleared.
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
  input  wire [WIDTH-1:0] clear,
  output wire [WIDTH-1:0] synced,     // 1 = active, not filtered
  output reg  [WIDTH-1:0] level,      // filtered
  output reg  [WIDTH-1:0] was_active
);

  (* async_reg = "true" *)
  reg  [WIDTH-1:0] first;
  (* async_reg = "true" *)
  reg  [WIDTH-1:0] second;
  reg  [WIDTH-1:0] pending;  // has differed since the last tick
  wire [WIDTH-1:0] differs = second ^ level;

  assign synced = second;

  always @(posedge clk) begin
    first      <= pins ^ inverted;
    second     <= first;
    level      <= level ^ (differs & pending & {WIDTH{tick}});
    pending    <= differs & (pending ^ {WIDTH{tick}});
    was_active <= (was_active & ~clear) | level;
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
