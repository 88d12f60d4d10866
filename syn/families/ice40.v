// SPDX-License-Identifier: MIT
// iCE40 cells for the board top.
`resetall
`timescale 1ns / 1ps
`default_nettype none

// clk = oscillator / (DIVR + 1) * (DIVF + 1) / 2^DIVQ
module passo_pll #(
  parameter PAD          = 0,  // 1: the oscillator is at the dedicated pin of the PLL
  parameter DIVR         = 0,
  parameter DIVF         = 0,
  parameter DIVQ         = 0,
  parameter FILTER_RANGE = 0
) (
  input  wire oscillator,
  output wire clk,
  output wire locked
);

  generate
    if (PAD) begin : g_pad
      SB_PLL40_PAD #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR         (DIVR),
        .DIVF         (DIVF),
        .DIVQ         (DIVQ),
        .FILTER_RANGE (FILTER_RANGE)
      ) u_pll (
        .PACKAGEPIN  (oscillator),
        .PLLOUTGLOBAL(clk),
        .LOCK        (locked),
        .RESETB      (1'b1),
        .BYPASS      (1'b0)
      );
    end else begin : g_core
      SB_PLL40_CORE #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR         (DIVR),
        .DIVF         (DIVF),
        .DIVQ         (DIVQ),
        .FILTER_RANGE (FILTER_RANGE)
      ) u_pll (
        .REFERENCECLK(oscillator),
        .PLLOUTGLOBAL(clk),
        .LOCK        (locked),
        .RESETB      (1'b1),
        .BYPASS      (1'b0)
      );
    end
  endgenerate

endmodule

// Input buffer onto the clock network.
module passo_clock_pin (
  input  wire pin,
  output wire clk
);

  SB_GB_IO #(
    .PIN_TYPE(6'b000001)
  ) u_pin (
    .PACKAGE_PIN         (pin),
    .GLOBAL_BUFFER_OUTPUT(clk)
  );

endmodule

// Tristate output.
module passo_tristate_pin (
  input  wire data,
  input  wire enable,
  output wire pin
);

  SB_IO #(
    .PIN_TYPE(6'b101001)
  ) u_pin (
    .PACKAGE_PIN  (pin),
    .OUTPUT_ENABLE(enable),
    .D_OUT_0      (data)
  );

endmodule
`resetall
