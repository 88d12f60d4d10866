// SPDX-License-Identifier: MIT
// Promises of the interpolation; included at the end of passo_interpolate.v.

// --- Assumptions: it is used as by the ramp, first for the points of a table (or not), then for velocities; a stop
// ends this at any time, for at least 3 clocks
localparam [1:0] F_REST = 2'd0;
localparam [1:0] F_LOADED = 2'd1;  // the points are loaded
localparam [1:0] F_SHAPE = 2'd2;
localparam [1:0] F_SCALE = 2'd3;
localparam [5:0] F_SHAPE_CLOCKS = 6'd19;
localparam [5:0] F_SCALE_CLOCKS = 6'd50;
reg       f_begun = 1'b0;
reg [1:0] f_phase = F_REST;
reg [1:0] f_rested = 2'd0;
reg [5:0] f_clock;  // of the phase, from 1
reg       f_shaped;
reg       f_same;  // without a ramp: a = b, and any shape
(* anyseq *) reg f_any_same;
(* anyseq *) reg f_go;
(* anyseq *) reg f_stop;
wire f_scale_begins = f_phase == F_SCALE && f_clock == 6'd1;
always @(posedge clk) begin
  f_begun   <= 1'b1;
  f_clock   <= f_clock + 6'd1;
  f_rested  <= f_phase != F_REST ? 2'd0 : f_rested == 2'd3 ? 2'd3 : f_rested + 2'd1;
  case (f_phase)
    F_REST:
    if (load_points) f_phase <= F_LOADED;
    else if (f_go && f_rested == 2'd3) begin
      f_phase  <= F_SCALE;
      f_clock  <= 6'd1;
      f_shaped <= 1'b0;
      f_same   <= f_any_same;
    end
    F_LOADED: begin
      f_phase <= F_SHAPE;
      f_clock <= 6'd1;
    end
    F_SHAPE:
    if (f_clock == F_SHAPE_CLOCKS) begin
      f_phase  <= F_SCALE;
      f_clock  <= 6'd1;
      f_shaped <= 1'b1;
      f_same   <= 1'b0;
    end
    F_SCALE: if (f_clock == F_SCALE_CLOCKS) f_phase <= F_REST;
  endcase
  if (f_stop) f_phase <= F_REST;
  interpolate_moving : assume (moving == (f_phase == F_SHAPE || f_phase == F_SCALE));
  interpolate_shaping : assume (shaping == (f_phase == F_SHAPE));
  interpolate_fraction : assume (load_fraction == f_scale_begins);
  if (f_phase != F_REST) interpolate_clear : assume (clear == f_scale_begins && result_move == moving);
  if (load_points)
    interpolate_points : assume (f_phase == F_REST && f_rested == 2'd3 && clear && result_move);
  if (f_phase == F_LOADED || f_phase == F_SHAPE || (f_scale_begins && f_shaped))
    interpolate_progress : assume ($stable(progress));
  if (f_scale_begins) interpolate_linear : assume (linear == !f_shaped || f_same);
  if (f_phase == F_SCALE && f_same) interpolate_same_bits : assume (a_bit == b_bit);
end

// --- a (1 - f) + b f: the products of the bits of a and b, LSB first, exact. After each bit everything shifts down
// by one place and nothing is lost; the last of 48 bits is at 2^(47 + 24).
reg  [15:0] f_point;
reg  [16:0] f_next;
reg  [24:0] f_fraction;  // of velocities, 0 .. 2^24
wire [24:0] f_at = {1'b0, progress[24:1]} + {24'd0, progress[0]};  // of points
wire [24:0] f_f = f_phase == F_SHAPE || (f_scale_begins && f_shaped) ? f_at : f_fraction;
reg         f_a, f_b, f_a_q, f_b_q;  // the bits, one and two clocks ago
reg  [71:0] f_product;
wire [24:0] f_bits_product = (f_a_q ? 25'h1000000 - f_f : 25'd0) + (f_b_q ? f_f : 25'd0);
wire [71:0] f_product_next = {1'b0, f_product[71:1]} + {f_bits_product, 47'd0};
wire        f_counts = (f_phase == F_SHAPE || f_phase == F_SCALE) && f_clock >= 6'd3;
always @(posedge clk) begin
  if (load_points) begin
    f_point <= point;
    f_next  <= point_is_last ? 17'h10000 : {1'b0, point_next};
  end else if (f_phase == F_SHAPE) begin
    f_point <= f_point >> 1;
    f_next  <= f_next >> 1;
  end
  f_a   <= f_phase == F_SHAPE ? f_point[0] : f_phase == F_SCALE ? a_bit : 1'b0;
  f_b   <= f_phase == F_SHAPE ? f_next[0] : f_phase == F_SCALE ? b_bit : 1'b0;
  f_a_q <= f_a;
  f_b_q <= f_b;
  f_product <= f_counts ? f_product_next : 72'd0;
  // rounded to the nearest 2^-24, ties up
  if (f_scale_begins) f_fraction <= f_shaped ? {1'b0, f_product[71:47]} + f_product[46] : {1'b0, progress[32:9]} + progress[8];
end

reg f_done;  // the last of 48 bits is in the result
reg [47:0] f_velocity;
always @(posedge clk) begin
  f_done     <= f_phase == F_SCALE && f_clock == F_SCALE_CLOCKS;
  f_velocity <= f_product_next[71:24];
  if (f_begun) begin
    if (f_done && $past(f_begun)) interpolates_exactly : assert (result == f_velocity);
    if (f_phase == F_SCALE && !f_scale_begins && !f_same)
      fraction_as_rounded : assert ({1'b0, fraction[24:1]} + {24'd0, fraction[0]} == f_fraction);
    if ((f_phase == F_SHAPE || f_phase == F_SCALE) && f_clock >= 6'd2) bit_is_told : assert (a == f_a);
  end
end

// --- Invariants, for the induction
reg f_last_point;
always @(posedge clk) if (load_points) f_last_point <= point_is_last;
wire [24:0] f_of_bit = f_phase == F_SHAPE ? progress[24:0] : fraction;
integer k;
always @(posedge clk)
  if (f_begun) begin
    if (f_phase == F_SHAPE) assert (f_clock >= 6'd1 && f_clock <= F_SHAPE_CLOCKS);
    if (f_phase == F_SCALE) assert (f_clock >= 6'd1 && f_clock <= F_SCALE_CLOCKS);
    if (f_phase != F_REST || f_rested >= 2'd2) assert (a == f_a && b == f_b);
    if (f_phase == F_REST && f_rested >= 2'd2) assert (!a && !b);
    if (f_phase == F_REST && f_rested == 2'd3) assert (addend == 25'd0 && !both);
    if (f_phase == F_LOADED || (f_phase == F_SHAPE && f_clock == 6'd1) || (f_scale_begins && !f_shaped))
      assert (!a && !b && addend == 25'd0 && !both);
    // points
    if (f_phase == F_LOADED) assert (sum == 25'd0 && a_point == f_point && low == {6'd0, f_next});
    if (f_phase == F_LOADED) assert (f_last_point ? f_next == 17'h10000 : !f_next[16]);
    if (f_phase == F_SHAPE) begin
      assert (a_point == f_point);
      if (f_clock <= 6'd3) assert (sum == 25'd0);
      if (f_clock == 6'd2) assert (addend == 25'd0 && !both);
      for (k = 1; k <= 19; k = k + 1)
        if (f_clock == k) begin
          assert (((low ^ f_next) & ((23'd1 << (24 - k)) - 23'd1)) == 23'd0 || k == 1);
          assert (f_point <= 16'hFFFF >> (k - 1));
          assert (f_last_point ? f_next == 17'h10000 >> (k - 1) : f_next <= 17'h0FFFF >> (k - 1));
        end
      if (f_clock == 6'd1) assert (low == {6'd0, f_next});
      if (f_clock >= 6'd2) assert (f_b == (f_clock == 6'd18) || !f_last_point);
      if (f_clock >= 6'd3) assert (f_b_q == (f_clock == 6'd19) || !f_last_point);
      if (f_clock == 6'd18) assert (!f_a && f_b == f_last_point);
      if (f_clock == 6'd19) assert (!f_a && !f_b && !f_a_q && f_b_q == f_last_point);
      if (f_clock >= 6'd3) assert ({sum, low[22]} == f_product[71:46]);
      if (f_clock >= 6'd3 && f_last_point) assert (f_product[71:0] <= {25'h1000000 - f_at, 48'd0});
    end
    if (f_scale_begins && f_shaped) begin
      assert (!a && !b && {sum, low[22]} == f_product[71:46] && (!sum[24] || {sum[23:0], low[22]} == 25'd0));
    end
    // velocities
    if (f_phase == F_SCALE && f_clock == 6'd2) assert (addend == 25'd0 && !both);
    if (f_phase == F_SCALE && (f_clock == 6'd2 || f_clock == 6'd3)) assert (sum == 25'd0);
    if (f_phase == F_SCALE && f_same && f_clock >= 6'd2) assert (f_a == f_b);
    if (f_phase == F_SCALE && f_same && f_clock >= 6'd3) assert (f_a_q == f_b_q);
    // both
    if (f_counts) begin
      assert (addend == (f_a_q == f_b_q ? 25'd0 : f_of_bit ^ {25{f_a_q}}) && both == (f_a_q && f_b_q));
      if (f_phase == F_SCALE) assert (result == f_product[71:24]);
    end
  end
