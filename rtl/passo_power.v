// SPDX-License-Identifier: MIT
// Power in proportion to the velocity: what a clock of the PWM costs.
//
//   cost = pwm_step * power_reference / (velocity * rate)
//
// One bit-serial unit multiplies and divides, over and over while something moves:
//
//   clock    0          velocity and rate are sampled
//         1 .. 17       velocity * rate
//        18             pwm_step is sampled
//        19 .. 43       pwm_step * power_reference
//        44             is the quotient too large?
//        45 .. 68       the division
//        69             the new cost
//
// Promise: `cost` follows velocity and rate within 140 clocks. It is the quotient of pwm_step * power_reference / 2,
// rounded down, and velocity * rate / 2, rounded down; 2^24 - 1 if that is more; 0 for 70 clocks when `moves` has risen.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_power (
  input  wire        clk,
  input  wire        rst,
  input  wire        moves,            // velocity and rate are not 0
  input  wire [31:0] velocity,         // UQ0.32 substeps per clock
  input  wire [16:0] rate,             // UQ1.16
  input  wire [31:0] power_reference,  // UQ0.32: the velocity of full power
  input  wire [23:0] pwm_step,         // UQ0.24
  output reg  [23:0] cost              // UQ0.24
);

  localparam [6:0] SAMPLE_STEP = 7'd18;
  localparam [6:0] CHECK = 7'd44;
  localparam [6:0] DONE = 7'd69;

  reg [ 6:0] count;
  reg        multiplies_step;  // from SAMPLE_STEP on
  reg        divides;  // from CHECK on
  reg        checks;
  reg        too_large;
  reg [31:0] factor;  // velocity, then velocity * rate
  reg [31:0] high;
  reg [24:0] low;

  wire [32:0] left = divides && !checks ? {high, low[24]} : {1'b0, high};
  wire [31:0] addend = (multiplies_step ? power_reference : factor) & {32{low[0]}};
  wire [32:0] right = divides ? {1'b1, ~factor} : {1'b0, addend};
  wire [33:0] sum = {1'b0, left} + {1'b0, right} + {33'd0, divides};
  wire        fits = sum[33];  // no borrow

  always @(posedge clk) begin
    count           <= count == DONE ? 7'd0 : count + 7'd1;
    checks          <= count == CHECK - 7'd1;
    divides         <= count >= CHECK - 7'd1 && count != DONE;
    multiplies_step <= count >= SAMPLE_STEP && count != DONE;
    if (count == 7'd0) begin
      factor <= velocity;
      high   <= 32'd0;
      low    <= {8'd0, rate};
    end else if (count == SAMPLE_STEP) begin
      factor <= high;
      high   <= 32'd0;
      low    <= {1'b0, pwm_step};
    end else if (checks) begin
      too_large <= fits;
    end else if (divides) begin
      high <= fits ? sum[31:0] : left[31:0];
      low  <= {low[23:0], fits};
    end else begin
      high <= sum[32:1];
      low  <= {sum[0], low[24:1]};
    end
    if (count == DONE) cost <= too_large ? 24'hFFFFFF : low[23:0];
    if (rst || !moves) begin
      count           <= 7'd0;
      checks          <= 1'b0;
      divides         <= 1'b0;
      multiplies_step <= 1'b0;
      cost            <= 24'd0;
    end
  end

endmodule
`resetall
