// SPDX-License-Identifier: MIT
// Shape: how far the speed has come, for how far the ramp has come.
//
//   x = round(progress to 2^-24);  mirror: 1 - shape(1 - x)
//   linear:  s = x
//   others:  s = t[k] * 2^8 + floor(((t[k+1] - t[k]) * f + 2^7 - k[7]) / 2^8),
//            k = x(23:16), f = x(15:0), t[256] = 1.0
//
// Promise: `done` is high for one clock when `s` is ready; s stays until the next start. Rounded to nearest;
// ties go up in the lower half of the table and down in the upper, which keeps an odd-symmetric bank
// symmetric. Latency from `start`: linear 3 clocks; others 21 clocks and the wait for the table, at most 2 *
// CHANNELS + 3. progress, shape and mirror must stay from start to done.
`resetall
`default_nettype none

module passo_shape (
  input  wire        clk,
  input  wire        rst,
  input  wire        start,
  input  wire [24:0] progress,         // UQ0.25, the upper bits of u
  input  wire [ 1:0] shape,
  input  wire        mirror,
  output reg         done,
  output reg  [24:0] s,                // UQ1.24, 0 .. 1.0
  // tables
  output reg         table_request,
  output wire [ 9:0] table_address,
  input  wire        table_served,
  input  wire [15:0] table_point,
  input  wire [15:0] table_point_next
);

  localparam [1:0] SHAPE_LINEAR = 2'd0;
  localparam [24:0] ONE = 25'h1000000;

  localparam [2:0] STEP_IDLE = 3'd0;
  localparam [2:0] STEP_MIRROR = 3'd1;
  localparam [2:0] STEP_LOOK_UP = 3'd2;
  localparam [2:0] STEP_FETCH = 3'd3;
  localparam [2:0] STEP_MULTIPLY = 3'd4;
  localparam [2:0] STEP_SUM = 3'd5;
  localparam [2:0] STEP_FINISH = 3'd6;

  reg  [ 2:0] step;
  reg  [ 3:0] count;
  reg  [24:0] x;
  wire        mirrored = mirror && shape != SHAPE_LINEAR;  // a mirrored straight line is the same

  assign table_address = {shape - 2'd1, x[23:16]};

  // (t[k+1] - t[k]) * f, one bit of f per clock from the lowest; the sum moves right
  reg         [15:0] point;
  reg signed  [17:0] rise;
  reg         [15:0] fraction;
  reg signed  [16:0] product_high;
  reg         [ 7:0] product_low;  // what is below is only for the floor
  wire signed [17:0] addend = fraction[0] ? rise : 18'sd0;
  wire signed [17:0] product_sum = product_high + addend;

  wire [24:0] interpolated = {1'b0, point, 8'd0} + {product_high, product_low};

  always @(posedge clk) begin
    done <= 1'b0;
    case (step)
      STEP_IDLE:
      if (start) begin
        x    <= {1'b0, progress[24:1]} + {24'd0, progress[0]};
        step <= STEP_MIRROR;
      end

      STEP_MIRROR: begin
        if (mirrored) x <= ONE - x;
        step <= STEP_LOOK_UP;
      end

      STEP_LOOK_UP:
      if (shape == SHAPE_LINEAR || x[24]) begin
        s    <= mirrored ? ONE - x : x;
        done <= 1'b1;
        step <= STEP_IDLE;
      end else begin
        table_request <= 1'b1;
        step          <= STEP_FETCH;
      end

      STEP_FETCH:
      if (table_served) begin
        table_request <= 1'b0;
        point <= table_point;
        rise <= (x[23:16] == 8'hFF ? 18'sh10000 : $signed(
            {2'b00, table_point_next}
        )) - $signed(
            {2'b00, table_point}
        );
        fraction <= x[15:0];
        product_high <= x[23] ? 17'sd127 : 17'sd128;  // for rounding
        count <= 4'd15;
        step <= STEP_MULTIPLY;
      end

      STEP_MULTIPLY: begin
        {product_high, product_low[7]} <= product_sum;
        product_low[6:0]               <= product_low[7:1];
        fraction                       <= {1'b0, fraction[15:1]};
        count                          <= count - 4'd1;
        if (count == 4'd0) step <= STEP_SUM;
      end

      STEP_SUM: begin
        s    <= interpolated;
        step <= STEP_FINISH;
      end

      default: begin
        if (mirrored) s <= ONE - s;
        done <= 1'b1;
        step <= STEP_IDLE;
      end
    endcase
    if (rst) begin
      step          <= STEP_IDLE;
      table_request <= 1'b0;
      done          <= 1'b0;
    end
  end

endmodule
`resetall
