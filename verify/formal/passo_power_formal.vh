// SPDX-License-Identifier: MIT
// Promises of the cost of power; included at the end of passo_power.v. The products and the division are ghost state,
// built bit by bit, which avoids products of two symbolic numbers.

// --- Assumptions: the settings are in range, and change only with `write` or after a reset
reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) power_reset : assume (rst);
  power_in_range : assume (pwm_step <= 24'h800000 && power_reference <= 32'h80000000);
  if (f_started && !$stable({pwm_step, power_reference})) power_settings_stand : assume (write || $past(rst));
end

// --- Step times reference, lowest bit first: after each bit all shifts down by one place and nothing is lost
wire        f_scales = count >= SCALE;
wire        f_rounds = count != 7'd0 && count <= LAST;
reg  [23:0] f_step, f_step_left;
reg  [31:0] f_reference, f_reference_now;
reg         f_torn;  // the settings changed meanwhile
reg  [57:0] f_product;
wire [57:0] f_product_sum = f_product + (f_step_left[0] ? {1'b0, f_reference_now, 25'd0} : 58'd0);
reg  [53:0] f_scaled;
always @(posedge clk) begin
  f_reference_now <= power_reference;
  if (count == 7'd0 && stale) begin
    f_step      <= pwm_step;
    f_step_left <= pwm_step;
    f_reference <= power_reference;
    f_product   <= 58'd0;
    f_torn      <= 1'b0;
  end else if (f_scales) begin
    f_torn <= f_torn || pwm_step != f_step || power_reference != f_reference;
    if (count != SCALE && count != SCALED) begin
      f_product   <= {1'b0, f_product_sum[57:1]};
      f_step_left <= f_step_left >> 1;
    end
    if (count == SCALED) f_scaled <= f_product[54:1];
  end
end

// --- Velocity times rate
reg  [16:0] f_rate;
reg  [31:0] f_velocity;
reg  [49:0] f_speed;
wire [49:0] f_speed_sum = f_speed + (f_rate[0] ? {1'b0, f_velocity, 17'd0} : 50'd0);
reg  [31:0] f_factor;
always @(posedge clk)
  if (count == 7'd0) begin
    f_rate     <= rate;
    f_velocity <= velocity;
    f_speed    <= 50'd0;
  end else if (count >= 7'd2 && count < DIVIDE) begin
    f_speed <= {1'b0, f_speed_sum[49:1]};
    f_rate  <= f_rate >> 1;
  end else if (count == DIVIDE) f_factor <= f_speed[48:17];

// --- The division as at school, with a remainder
reg  [53:0] f_dividend;
reg  [23:0] f_rest;  // of it
reg  [53:0] f_begun;  // what has been divided of it
reg  [24:0] f_quotient;
reg  [58:0] f_back;  // quotient times factor
reg  [31:0] f_remainder;
reg         f_large;
reg  [24:0] f_result;  // of the last round
wire        f_first = count == DIVIDE + 7'd2;
wire [32:0] f_part = f_first ? {3'd0, f_dividend[53:24]} : {f_remainder, f_rest[23]};
wire        f_fits = f_part >= {1'b0, f_factor};
wire [32:0] f_less = f_part - (f_fits ? {1'b0, f_factor} : 33'd0);
always @(posedge clk) begin
  if (count == DIVIDE) begin
    f_dividend  <= f_scaled;
    f_rest      <= f_scaled[23:0];
    f_begun     <= 54'd0;
    f_quotient  <= 25'd0;
    f_back      <= 59'd0;
    f_remainder <= 32'd0;
    f_large     <= 1'b0;
  end else if (f_rounds && count > DIVIDE && count[0]) begin
    f_quotient  <= {f_quotient[23:0], f_fits};
    f_back      <= {f_back[57:0], 1'b0} + (f_fits ? {27'd0, f_factor} : 59'd0);
    f_remainder <= f_less[31:0];
    f_begun     <= f_first ? {24'd0, f_dividend[53:24]} : {f_begun[52:0], f_rest[23]};
    if (!f_first) f_rest <= f_rest << 1;
    if (f_first) f_large <= f_fits;
  end
  if (count == LAST) f_result <= {f_large, f_large ? 24'hFFFFFF : {f_quotient[22:0], f_fits}};
  if (rst || !moves) f_result <= 25'd0;
end

// --- Clocks for which something has moved, up to 127
reg [6:0] f_moving;
always @(posedge clk) f_moving <= rst || !moves ? 7'd0 : f_moving == 7'd127 ? 7'd127 : f_moving + 7'd1;

always @(posedge clk)
  if (f_started && !$past(rst)) begin
    if (!$past(moves)) none_at_rest : assert (cost == 24'd0);
    if (f_moving < 7'd71) none_at_first : assert (cost == 24'd0);
    if ($past(count) == 7'd0 && $past(moves)) cost_is_the_quotient : assert (cost == $past(f_result[23:0]));
    else if ($past(moves)) stands_for_a_round : assert ($stable(cost));
    if ($past(count) == LAST && $past(moves) && !$past(f_large)) begin
      divides_exactly : assert ({5'd0, f_dividend} == f_back + {27'd0, f_remainder} && f_remainder < f_factor);
    end
    if ($past(count) == LAST && $past(moves))
      too_large_is_told : assert ($past(f_large) == (f_dividend[53:24] >= f_factor));
    if (count == 7'd1) begin
      settings_as_one : assert (!f_torn && (stale || write || (f_step == pwm_step && f_reference == power_reference)));
    end
  end

// --- Invariants, for the induction
integer k;
always @(posedge clk)
  if (f_started && !$past(rst)) begin
    assert (count <= LAST || (count >= SCALE && count <= SCALED));
    assert (divides == (count >= DIVIDE && count <= LAST));
    if (f_rounds) assert (f_moving >= count);
    if (f_result != 25'd0) assert (f_moving >= 7'd70);
    if (cost != 24'd0) assert (f_moving >= 7'd71);
    if (f_moving == 7'd0) assert (f_result == 25'd0 && cost == 24'd0 && !f_rounds);
    if (count != 7'd0) assert (cost == f_result[23:0]);
    if (count <= DIVIDE || f_scales)
      assert (low[24] == f_result[24] && (low[24] || low[23:0] == f_result[23:0]) && (!f_result[24] || f_result[23:0] == 24'hFFFFFF));
    else assert (!f_result[24] || f_result[23:0] == 24'hFFFFFF);
    if (!stale || f_rounds) assert (!f_torn);
    if (!stale && !write) assert (f_step == pwm_step && f_reference == power_reference);
    // the product of the settings
    if (count == SCALE) assert (product_part == 32'd0 && product == 33'd0 && f_product == 58'd0 && scaled_low == f_step_left);
    if (f_scales) assert (f_step <= 24'h800000 && f_reference_now <= 32'h80000000);
    for (k = 0; k <= 25; k = k + 1)
      if (f_scales && count == SCALE + 1 + k) begin
        assert ({1'b0, product} == f_product[57:24] && scaled_low == ({1'b0, f_step_left[23:1]} | f_product[23:0]));
        assert ((f_product & ((58'd1 << (25 - k)) - 58'd1)) == 58'd0);
        assert ({1'b0, f_step_left} < 25'd1 << (24 - (k > 24 ? 24 : k)));
        assert (f_product <= (k <= 23 ? 58'h100000000000000 : k == 24 ? 58'h80000000000000 : 58'h40000000000000));
        if (k <= 23 && f_step_left[k > 23 ? 0 : 23 - k])
          assert (f_step_left == 24'd1 << (23 - k) && f_product == 58'd0);
        if (k <= 24) assert (product_part == (f_step_left[0] ? f_reference_now : 32'd0));
      end
    if (count == SCALE) begin
      assert (f_step_left <= 24'h800000);
    end
    if (!f_scales && !stale) assert ({scaled_high, scaled_low} == f_scaled);
    if (f_rounds) assert ({scaled_high, scaled_low} == f_scaled);
    // velocity times rate
    if (count != 7'd0 && count <= DIVIDE) begin
      assert (factor == f_velocity && f_speed <= {1'b0, f_velocity, 17'd0});
      if (count == 7'd1) assert (product == 33'd0 && product_part == 32'd0 && f_speed == 50'd0 && rate_left == f_rate);
      if (count >= 7'd2) assert ({1'b0, product} == f_speed[49:16] && rate_left == f_rate >> 1);
      if (count >= 7'd2 && count < DIVIDE) assert (product_part == (f_rate[0] ? factor : 32'd0));
    end
    // the division: after k bits
    if (count != 7'd0 && count <= DIVIDE) assert (remainder == 32'd0 && !low[25]);
    if (count == DIVIDE) assert (divisor_part == {4'd0, scaled_high[29:1]});
    if (divides && count != DIVIDE) assert (factor == f_factor);
    for (k = 0; k <= 24; k = k + 1)
      if (count == DIVIDE + 1 + 2 * k || count == DIVIDE + 2 + 2 * k) begin
        if (k == 0) begin
          assert (remainder == {3'd0, f_dividend[53:25]} && low == {f_dividend[24:0], 1'b1} && f_quotient == 25'd0);
          assert (f_back == 59'd0 && f_rest == f_dividend[23:0]);
          if (count[0]) assert (divisor_part == ~{1'b0, f_factor});
        end else begin
          assert (f_large == (f_dividend[53:24] >= f_factor));
          if (f_large) assert (low[k > 0 ? k - 1 : 0]);
          else begin
            assert (f_begun == f_dividend >> (25 - k) && f_rest == (f_dividend[23:0] << (k - 1)));
            assert ({5'd0, f_begun} == f_back + {27'd0, f_remainder} && f_remainder < f_factor);
            assert (f_quotient < 25'd1 << (k - 1));
            assert (low == (({f_dividend[24:0], 1'b1} << k) | {1'b0, f_quotient}));
            assert (remainder == f_remainder - (f_quotient[0] ? 32'd0 : f_factor));
            if (count[0]) assert (divisor_part == (f_quotient[0] ? ~{1'b0, f_factor} : {1'b0, f_factor}));
          end
        end
      end
  end
