// SPDX-License-Identifier: MIT
// Scale: the velocity between two velocities.
//
//   velocity = v_start + floor((v_end - v_start) * s)        s = 1.0 gives v_end
//
// The product is made one bit of s after the other, from the lowest; the sum moves right, so dropping its
// lower bits is the floor. All 48-bit sums go in two halves, the upper one a clock later, so that no carry
// chain is longer than 26 bits.
//
// Promise: `done` is high for one clock, 53 clocks after `start`, when `velocity` is ready; it stays until
// the next start. The inputs must stay from start to done.
`resetall
`default_nettype none

module passo_scale (
  input  wire        clk,
  input  wire        rst,
  input  wire        start,
  input  wire [47:0] v_start,  // UQ0.48
  input  wire [47:0] v_end,
  input  wire [24:0] s,        // UQ1.24
  output reg         done,
  output reg  [47:0] velocity
);

  localparam [1:0] STEP_IDLE = 2'd0;
  localparam [1:0] STEP_DIFFERENCE = 2'd1;
  localparam [1:0] STEP_MULTIPLY = 2'd2;
  localparam [1:0] STEP_SUM = 2'd3;

  reg [ 1:0] step;
  reg        high;  // the upper half's clock
  reg        carry;  // from the lower half
  reg [ 4:0] count;
  reg [23:0] multiplier;

  reg        [23:0] difference_low;
  reg signed [24:0] difference_high;
  reg        [23:0] product_low;
  reg signed [24:0] product_high;
  reg        [22:0] sum_low;
  reg               unused_bit;  // of the sum: it moves out

  wire        [23:0] addend_low = multiplier[0] ? difference_low : 24'd0;
  wire signed [24:0] addend_high = multiplier[0] ? difference_high : 25'sd0;
  wire signed [25:0] sum_high = product_high + addend_high + $signed({25'd0, carry});

  always @(posedge clk) begin
    done <= 1'b0;
    high <= ~high;
    case (step)
      STEP_IDLE: begin
        high <= 1'b0;
        if (start) step <= STEP_DIFFERENCE;
      end

      STEP_DIFFERENCE:
      if (!high) {carry, difference_low} <= {1'b0, v_end[23:0]} - {1'b0, v_start[23:0]};
      else begin
        difference_high <= $signed(
            {1'b0, v_end[47:24]}
        ) - $signed(
            {1'b0, v_start[47:24]}
        ) - $signed(
            {24'd0, carry}
        );
        product_low <= 24'd0;
        product_high <= 25'sd0;
        multiplier <= s[23:0];
        count <= 5'd23;
        step <= STEP_MULTIPLY;
      end

      STEP_MULTIPLY:
      if (!high) {carry, sum_low, unused_bit} <= {1'b0, product_low} + {1'b0, addend_low};
      else begin
        product_high <= sum_high[25:1];
        product_low  <= {sum_high[0], sum_low};
        multiplier   <= {1'b0, multiplier[23:1]};
        count        <= count - 5'd1;
        if (count == 5'd0) step <= STEP_SUM;
      end

      default:
      if (!high) {carry, velocity[23:0]} <= {1'b0, v_start[23:0]} + {1'b0, product_low};
      else begin
        velocity[47:24] <= v_start[47:24] + product_high[23:0] + {23'd0, carry};
        if (s[24]) velocity <= v_end;
        done <= 1'b1;
        step <= STEP_IDLE;
      end
    endcase
    if (rst) begin
      step <= STEP_IDLE;
      done <= 1'b0;
    end
  end

endmodule
`resetall
