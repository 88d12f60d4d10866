// SPDX-License-Identifier: MIT
// Power in proportion to the velocity: what a clock of the PWM costs.
//
//   cost = pwm_step * power_reference / (velocity * rate)
//
// One bit-serial unit multiplies and divides, over and over while something moves. A step takes two clocks: the first
// shifts and chooses what to add, the second adds.
//
//   step     0          velocity and rate are sampled
//         1 .. 17       velocity * rate
//        18             pwm_step is sampled
//        19 .. 43       pwm_step * power_reference
//        44             is the quotient too large?
//        45 .. 68       the division, non-restoring
//        69             the new cost
//
// Promise: `cost` follows velocity and rate within 280 clocks. It is the quotient of pwm_step * power_reference / 2,
// rounded down, and velocity * rate / 2, rounded down; 2^24 - 1 if that is more; 0 for 139 clocks when `moves` has risen.
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

  // What a step adds
  localparam [1:0] NOTHING = 2'd0;
  localparam [1:0] FACTOR = 2'd1;
  localparam [1:0] REFERENCE = 2'd2;
  localparam [1:0] MINUS_FACTOR = 2'd3;

  reg [ 6:0] count;  // of steps
  reg        adds;  // the second clock of a step
  reg        multiplies_step;  // from SAMPLE_STEP on
  reg        divides;  // from CHECK on
  reg        shifts_left;  // after it
  reg [31:0] factor;  // velocity, then velocity * rate
  reg [32:0] shifted;
  reg [32:0] addend;  // one's complement
  reg [32:0] sum;  // two's complement in the division
  reg [24:0] low;  // multiplier or dividend, and what follows it: product or quotient

  wire samples = count == 7'd0;
  wire samples_step = count == SAMPLE_STEP;
  wire ends = count == DONE;
  wire loads = samples | samples_step;
  wire fits = ~sum[32];  // a bit of the quotient
  wire [ 1:0] pick =
    loads   ? NOTHING :
    divides ? (fits ? MINUS_FACTOR : FACTOR) :
    !low[0] ? NOTHING : multiplies_step ? REFERENCE : FACTOR;

  always @(posedge clk) begin
    adds <= !adds;
    sum  <= shifted + addend + {32'd0, addend[32]};
    if (!adds) begin
      count           <= ends ? 7'd0 : count + 7'd1;
      multiplies_step <= (multiplies_step | samples_step) & ~ends;
      divides         <= (divides | count == CHECK - 7'd1) & ~ends;
      shifts_left     <= divides & ~ends;
      shifted         <= loads ? 33'd0 : shifts_left ? {sum[31:0], low[24]} : {1'b0, sum[32:1]};
      case (pick)
        NOTHING:   addend <= 33'd0;
        FACTOR:    addend <= {1'b0, factor};
        REFERENCE: addend <= {1'b0, power_reference};
        default:   addend <= {1'b1, ~factor};
      endcase
      if (samples) low <= {8'd0, rate};
      else if (samples_step) low <= {1'b0, pwm_step};
      else if (shifts_left) low <= {low[23:0], fits};
      else low <= {sum[0], low[24:1]};
      if (loads) factor <= samples ? velocity : sum[32:1];
      if (ends) cost <= low[23] ? 24'hFFFFFF : {low[22:0], fits};
    end
    if (rst || !moves) begin
      count           <= 7'd0;
      adds            <= 1'b0;
      multiplies_step <= 1'b0;
      divides         <= 1'b0;
      shifts_left     <= 1'b0;
      cost            <= 24'd0;
    end
  end

endmodule
`resetall
