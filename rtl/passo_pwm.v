// SPDX-License-Identifier: MIT
// Power PWM with a credit accumulator: each period adds the duty, each on-clock subtracts its cost, and the pin is on
// while there is credit.
//
//   every period of 2^24 / step clocks:  credit += duty * 2^24             duty = (power + power[15]) / 2^16
//   every on-clock:                      credit -= cost                    cost = `step`, or more if proportional
//
// The excess of a pulse's last clock is carried into the next pulse, so the average share of on-clocks is
// duty * step / cost, even if that is not a whole number of clocks or below one clock per period.
//
// Promise: with `go` low the pin is low from the next clock on. If power is not 0, the pin rises on the clock after
// `go` rises, or two clocks after `restart`, which starts a period; otherwise only at the start of a period, once.
// With power 0 the pin is low, with power 65535 and cost = step it is high on every clock. Step and cost may change at
// any time.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_pwm (
  input  wire        clk,
  input  wire        rst,
  input  wire        go,            // power is wanted and something moves
  input  wire        restart,       // strobe: power or proportional changes in the next clock
  input  wire [15:0] power,         // UQ0.16, but 65535 is 1.0
  input  wire        proportional,
  input  wire [23:0] step,          // UQ0.24 periods per clock, above 0, at most 1/2
  input  wire [23:0] cost,          // of a clock, if proportional; below `step` counts as `step`
  output reg         pin
);

  reg [23:0] phase;  // of the period, one clock ahead
  reg        fresh;  // restart: a period begins, regardless of credit and paid
  reg [16:0] paid;  // in this clock, if not fresh: power is that of the clock before
  reg [23:0] cost_now;
  reg [25:0] credit;  // less 1, signed: the pin is on while it is not negative

  wire        renew = restart | ~go | rst;
  wire [24:0] phase_next = {1'b0, phase} + {1'b0, step};
  wire [16:0] duty = {1'b0, power} + {16'd0, power[15]};
  wire [16:0] duty_less = {1'b0, power} + {17{~power[15]}};  // by 1
  wire [25:0] spent = {2'd0, cost_now & {24{~credit[25]}}};  // the pin is on, or fresh
  wire [25:0] balance = credit + {1'b0, paid, 8'd0} - spent;
  wire [25:0] sum = fresh ? {duty_less[16], duty_less, 8'hFF} : balance;

  always @(posedge clk) begin
    phase    <= phase_next[23:0];
    fresh    <= renew;
    paid     <= phase_next[24] ? duty : 17'd0;
    cost_now <= proportional && cost > step ? cost : step;
    credit   <= sum;
    pin      <= go & ~sum[25];
    if (renew) phase <= 24'd0;
    if (rst) pin <= 1'b0;
  end

`ifdef FORMAL
  `include "passo_pwm_formal.vh"
`endif

endmodule
`resetall
