// SPDX-License-Identifier: MIT
// Speed-proportional power: PWM cost per on-clock at the current velocity.
//
//   cost = pwm_step * power_reference / (velocity * rate)
//
// Everything is bit-serial: products take one clock per bit, the quotient two: one selects whether to add or subtract
// the divisor, the other does it (non-restoring division). The product of the settings is computed once after they are
// written. While something moves, this repeats:
//
//   clock    0          velocity and rate are sampled, the previous cost holds
//         1 .. 18       velocity * rate, which becomes the divisor
//        18, 19         the product of the settings becomes the dividend
//        20 .. 69       the quotient, MSB first; the MSB is set if it is too large
//
// Promise: `cost` follows velocity and rate within 141 clocks, and 28 more when the settings are written. It is the
// quotient of pwm_step * power_reference / 2, rounded down, and velocity * rate / 2, rounded down; 2^24 - 1 if that is
// more; 0 for 71 clocks when `moves` has risen, and up to 28 more if the settings were written just before.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_power (
  input  wire        clk,
  input  wire        rst,
  input  wire        moves,            // velocity and rate are not 0
  input  wire [31:0] velocity,         // UQ0.32 substeps per clock
  input  wire [16:0] rate,             // UQ1.16
  input  wire        write,            // strobe: step and reference may be new from this clock on
  input  wire [31:0] power_reference,  // UQ0.32: the velocity of full power
  input  wire [23:0] pwm_step,         // UQ0.24
  output reg  [23:0] cost              // UQ0.24
);

  localparam [6:0] DIVIDE = 7'd19;
  localparam [6:0] LAST = 7'd69;
  localparam [6:0] SCALE = 7'd96;  // .. SCALED: the product of the settings
  localparam [6:0] SCALED = 7'd122;

  reg [ 6:0] count;
  reg        stale;  // the settings were written since their product was begun
  reg        divides;
  reg [31:0] factor;  // velocity, then velocity * rate
  reg [16:0] rate_left;  // bits of the rate, the next one lowest
  reg [29:0] scaled_high;  // pwm_step * power_reference / 2
  reg [23:0] scaled_low;  // first the bits of pwm_step, the next one lowest
  reg [31:0] product_part;  // of a bit
  reg [32:0] product;
  reg [32:0] divisor_part;  // + or - factor
  reg [31:0] remainder;  // or less than that, by the factor
  reg [25:0] low;  // the rest of the dividend above the quotient; lowest, whether to subtract

  wire        scales = count[6] & count[5];
  wire        adds_reference = scales & scaled_low[0];
  wire        adds_factor = ~scales & rate_left[0];
  wire [32:0] reduced = {remainder, low[25]} + divisor_part + {32'd0, divisor_part[32]};

  always @(posedge clk) begin
    count        <= count == LAST || count == SCALED ? 7'd0 : count + 7'd1;
    divides      <= count >= DIVIDE - 7'd1 && count < LAST;
    product_part <= (power_reference & {32{adds_reference}}) | (factor & {32{adds_factor}});
    product      <= {1'b0, product[32:1]} + {1'b0, product_part};
    rate_left    <= rate_left >> 1;
    if (scales) scaled_low <= {product[0], scaled_low[23:1]};
    if (count == SCALED) scaled_high <= product[30:1];
    divisor_part <= !divides ? {4'd0, scaled_high[29:1]} : {33{low[0]}} ^ {1'b0, factor};
    if (divides && count[0]) begin
      remainder <= reduced[31:0];
      low       <= {low[24:0], ~reduced[32]};
    end
    if (!divides) remainder <= 32'd0;
    if (count == DIVIDE) begin
      factor <= product[32:1];
      low    <= {scaled_high[0], scaled_low, 1'b1};
    end
    if (count == 7'd0) begin
      factor       <= velocity;
      rate_left    <= rate;
      product_part <= 32'd0;
      product      <= 33'd0;
      cost         <= low[24] ? 24'hFFFFFF : low[23:0];
      low[25]      <= 1'b0;
      stale        <= 1'b0;
      if (stale) begin
        count      <= SCALE;
        scaled_low <= pwm_step;
      end
    end
    if (!moves) begin
      low     <= 26'd0;
      cost    <= 24'd0;
      divides <= 1'b0;
      if (!scales && !(count == 7'd0 && stale)) count <= 7'd0;
    end
    if (write) stale <= 1'b1;
    if (rst) begin
      count   <= 7'd0;
      stale   <= 1'b1;
      low     <= 26'd0;
      cost    <= 24'd0;
      divides <= 1'b0;
    end
  end

`ifdef FORMAL
  `include "passo_power_formal.vh"
`endif

endmodule
`resetall
