// SPDX-License-Identifier: MIT
// ECP5 cells for the board top.
`resetall
`timescale 1ns / 1ps
`default_nettype none

// clk = oscillator / CLKI_DIV * CLKFB_DIV; VCO = clk * CLKOP_DIV
module passo_pll #(
  parameter CLKI_DIV  = 1,
  parameter CLKFB_DIV = 1,
  parameter CLKOP_DIV = 1
) (
  input  wire oscillator,
  output wire clk,
  output wire locked
);

  EHXPLLL #(
    .CLKI_DIV    (CLKI_DIV),
    .CLKFB_DIV   (CLKFB_DIV),
    .CLKOP_DIV   (CLKOP_DIV),
    .CLKOP_CPHASE(CLKOP_DIV - 1),
    .CLKOP_ENABLE("ENABLED"),
    .FEEDBK_PATH ("CLKOP")
  ) u_pll (
    .CLKI        (oscillator),
    .CLKFB       (clk),
    .CLKOP       (clk),
    .LOCK        (locked),
    .RST         (1'b0),
    .STDBY       (1'b0),
    .PHASESEL0   (1'b0),
    .PHASESEL1   (1'b0),
    .PHASEDIR    (1'b0),
    .PHASESTEP   (1'b0),
    .PHASELOADREG(1'b0),
    .PLLWAKESYNC (1'b0),
    .ENCLKOP     (1'b0)
  );

endmodule

// nextpnr promotes a clock to the clock network by itself.
module passo_clock_pin (
  input  wire pin,
  output wire clk
);

  assign clk = pin;

endmodule

// Tristate output.
module passo_tristate_pin (
  input  wire data,
  input  wire enable,
  output wire pin
);

  OBZ u_pin (
    .I(data),
    .T(~enable),
    .O(pin)
  );

endmodule
`resetall
