// SPDX-License-Identifier: MIT
// Gowin cells for the board top.
`resetall
`timescale 1ns / 1ps
`default_nettype none

// clk = oscillator / (IDIV_SEL + 1) * (FBDIV_SEL + 1); VCO = clk * ODIV_SEL
module passo_pll #(
  parameter DEVICE    = "GW1NR-9C",
  parameter FCLKIN    = "27",        // MHz of the oscillator
  parameter IDIV_SEL  = 0,
  parameter FBDIV_SEL = 0,
  parameter ODIV_SEL  = 8
) (
  input  wire oscillator,
  output wire clk,
  output wire locked
);

  rPLL #(
    .FCLKIN   (FCLKIN),
    .DEVICE   (DEVICE),
    .IDIV_SEL (IDIV_SEL),
    .FBDIV_SEL(FBDIV_SEL),
    .ODIV_SEL (ODIV_SEL)
  ) u_pll (
    .CLKIN  (oscillator),
    .CLKOUT (clk),
    .LOCK   (locked),
    .RESET  (1'b0),
    .RESET_P(1'b0),
    .CLKFB  (1'b0),
    .IDSEL  (6'd0),
    .FBDSEL (6'd0),
    .ODSEL  (6'd0),
    .PSDA   (4'd0),
    .DUTYDA (4'd0),
    .FDLY   (4'd0)
  );

endmodule

// Input buffer onto the clock network.
module passo_clock_pin (
  input  wire pin,
  output wire clk
);

  BUFG u_buffer (
    .I(pin),
    .O(clk)
  );

endmodule

// Tristate output.
module passo_tristate_pin (
  input  wire data,
  input  wire enable,
  output wire pin
);

  TBUF u_pin (
    .I  (data),
    .OEN(~enable),
    .O  (pin)
  );

endmodule
`resetall
