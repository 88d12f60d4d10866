// SPDX-License-Identifier: MIT
// Promises of the time scale; included at the end of passo_timescale.v.

localparam [16:0] F_ONE = 17'h10000;

// --- Assumptions: rates and slews of at most 1.0, slew ticks at least 8 clocks apart, some clocks of rest before a
// motion; a reset at the beginning and at any time
reg       f_started = 1'b0;
reg [2:0] f_since_tick = 3'd7;
reg       f_moved = 1'b0;
reg [1:0] f_rest = 2'd0;
wire      f_begun = ~rst;
always @(posedge clk) begin
  f_started    <= 1'b1;
  f_since_tick <= slew_tick ? 3'd0 : f_since_tick == 3'd7 ? 3'd7 : f_since_tick + 3'd1;
  if (!f_started) timescale_reset : assume (rst);
  timescale_rates : assume (rate_target <= F_ONE && rate_slew <= F_ONE && stop_slew <= F_ONE);
  if (slew_tick) timescale_ticks_apart : assume (f_since_tick == 3'd7);
  f_rest <= moving | rst ? 2'd0 : f_rest == 2'd3 ? 2'd3 : f_rest + 2'd1;
  if (moving) timescale_rest : assume (rst || f_moved || f_rest == 2'd3);
end

// --- Effect of a slew tick: it samples the goal and whether it is that of a stop, then the slew, and 7 clocks later
// the rate changes; a change in progress when a stop is commanded is dropped
reg [ 6:1] f_after = 6'd0;
reg [16:0] f_goal;
reg        f_stops;
reg [16:0] f_slew;
always @(posedge clk) begin
  f_after <= moving && !rst ? {f_after[5:1], slew_tick} : 6'd0;
  if (slew_tick) begin
    f_goal  <= stopping ? 17'd0 : rate_target;
    f_stops <= stopping;
  end
  if (f_after[2]) f_slew <= f_stops ? stop_slew : rate_slew;
end

reg [16:0] f_rate_q;
reg [16:0] f_goal_q;
reg [16:0] f_slew_q;
reg        f_ticked = 1'b0;  // the rate has changed
reg        f_given_up = 1'b0;  // it may have
always @(posedge clk) begin
  f_rate_q <= rate;
  f_goal_q <= f_goal;
  f_slew_q <= f_slew == 17'd0 ? 17'd1 : f_slew;
  f_ticked <= f_after[6] & moving & f_begun & (f_stops | ~stopping);
  f_given_up <= f_after[6] & moving & f_begun & ~f_stops & stopping;
  f_moved  <= moving & ~rst;
end
wire [16:0] f_change = rate > f_rate_q ? rate - f_rate_q : f_rate_q - rate;
wire [16:0] f_way = f_goal_q > f_rate_q ? f_goal_q - f_rate_q : f_rate_q - f_goal_q;

// --- Enables and rates since the motion began
reg [31:0] f_rates = 32'd0;
reg [15:0] f_enables = 16'd0;
always @(posedge clk) begin
  f_rates   <= moving && !rst ? f_rates + {15'd0, rate} : 32'd0;
  f_enables <= f_moved && moving && !rst ? f_enables + {15'd0, enable} : 16'd0;
end
wire [31:0] f_missing = f_rates - {f_enables + {15'd0, enable}, 16'd0};

always @(posedge clk)
  if (f_begun) begin
    if (!f_moved) enable_only_when_moving : assert (!enable);
    if (f_moved && f_rate_q == 17'd0) none_at_rate_0 : assert (!enable);
    if (f_moved && f_rate_q == F_ONE) every_clock_at_rate_1 : assert (enable);
    if (f_moved) enables_are_the_sum : assert (f_missing < 32'h10000);
    rate_at_most_1 : assert (rate <= F_ONE);
    if (f_moved && !f_ticked && !f_given_up) rate_stays_between_ticks : assert (rate == f_rate_q);
    if ($past(f_begun && moving && stopping)) never_faster_after_stop : assert (rate <= f_rate_q);
    if (f_ticked) begin
      if (f_goal_q >= f_rate_q) rate_rises_to_goal : assert (rate >= f_rate_q && rate <= f_goal_q);
      else rate_falls_to_goal : assert (rate <= f_rate_q && rate >= f_goal_q);
      change_is_the_slew : assert (f_change == (f_way < f_slew_q ? f_way : f_slew_q));
    end
    if (f_rest == 2'd3) rate_is_target_at_rest : assert (rate == $past(rate_target, 2));
  end

wire [16:0] f_step = f_slew == 17'd0 ? 17'd1 : f_slew;
wire [17:0] f_moved_rate = down ? {1'b0, rate} - {1'b0, f_step} : {1'b0, rate} + {1'b0, f_step};
always @(posedge clk)
  if (f_begun) begin
    assert (after == f_after);
    if (f_after != 6'd0) assert (goal == f_goal && stops == f_stops && f_moved);
    if (f_after != 6'd0 && f_stops) assert (f_goal == 17'd0);
    if (f_moved || f_rest != 2'd0) assert (goal <= F_ONE);
    if (f_moved) assert (rate_sum == f_rates[15:0]);
    else assert (f_enables == 16'd0 && f_rates == 32'd0);
    if (!f_moved && $past(f_begun) && $past(!moving)) assert (rate_sum == 16'd0);
    if (f_since_tick == 3'd7) assert (f_after == 6'd0);
    else if (f_after != 6'd0) assert (f_after == 6'd1 << f_since_tick);
    // one after the other: direction, slew, carry, new rate, overshoot
    if (f_after[3:1] != 3'd0 || (f_moved && f_since_tick == 3'd7)) assert (not_moved == ~{1'b0, rate});
    if (f_after[4:3] == 2'b00 && f_since_tick != 3'd2 && f_since_tick != 3'd3) assert (change == 17'd0 || f_after == 6'd0);
    if (f_moved && f_since_tick == 3'd7) assert (change == 17'd0 && !change_carry);
    if (f_after[1] || f_after[2]) assert (change == 17'd0 && !change_carry);
    if (f_after[6:2] != 5'd0) assert (down == (goal < rate));
    if (f_after[3]) assert (change == (f_slew ^ {17{down}}) && !change_carry && f_slew <= F_ONE);
    if (f_after[4]) assert (change == (f_slew ^ {17{down}}) && change_carry == (down ^ (f_slew == 17'd0)) && f_slew <= F_ONE);
    if (f_after[5]) assert (not_moved == ~f_moved_rate && change == 17'd0 && !change_carry && f_slew <= F_ONE);
    if (f_after[6]) assert (not_moved == ~f_moved_rate && change == 17'd0 && !change_carry && f_slew <= F_ONE);
    if (f_after[6]) assert (land == (down ? f_moved_rate[17] || f_moved_rate <= {1'b0, goal} : f_moved_rate > {1'b0, goal}));
  end
