// SPDX-License-Identifier: MIT
// Promises of the PWM; included at the end of passo_pwm.v.

// --- Assumptions: a period is at least 2 clocks; power and mode change only after `restart`, or while `go` is low
reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) pwm_reset : assume (rst);
  pwm_step_in_range : assume (step != 24'd0 && step <= 24'h800000);
  if (f_started && !$past(restart) && $past(go)) pwm_power_stands : assume ($stable({power, proportional}));
end

// --- Where a period begins at the pin
reg f_pays = 1'b0;
reg f_begins = 1'b0;
always @(posedge clk) begin
  f_pays   <= renew | phase_next[24];
  f_begins <= f_pays;
end

// --- Clocks on times step, less what the periods paid, since the last beginning; from -2^26 on
reg signed  [27:0] f_over;
wire signed [27:0] f_base = fresh ? 28'sd0 : f_over;
wire signed [27:0] f_sum = f_base - (f_pays ? $signed({3'd0, {1'b0, power} + {16'd0, power[15]}, 8'd0}) : 28'sd0);
reg         [23:0] f_step;
always @(posedge clk) begin
  f_step <= step;
  f_over <= (f_sum < -28'sh4000000 ? -28'sh4000000 : f_sum) + (!fresh && pin ? $signed({4'd0, f_step}) : 28'sd0);
end

always @(posedge clk)
  if (f_started && !$past(rst)) begin
    if (!fresh && pin) never_more_than_asked : assert (f_over < 28'sd0);
    if (!$past(go)) off_when_told : assert (!pin);
    if ($past(go && fresh)) begins_immediately : assert (pin == $past(power != 16'd0));
    if (pin && !$past(pin)) rises_with_a_period : assert (f_begins);
    if ($past(power == 16'd0)) zero_is_off : assert (!pin);
    if ($past(go && power == 16'hFFFF && !proportional)) full_is_on : assert (pin);
  end

// What has been paid, less what the present period has had: at most this much
wire signed [27:0] f_credit = {{2{credit[25]}}, credit};
wire signed [27:0] f_phase = {3'd0, f_pays, phase};
wire signed [27:0] f_ahead = f_credit + f_phase - $signed({4'd0, cost_now});
reg f_full = 1'b0;
always @(posedge clk) f_full <= go & power == 16'hFFFF & ~proportional & ~rst;
always @(posedge clk)
  if (f_started && !$past(rst) && fresh)
    assert (f_pays && phase == 24'd0);
  else if (f_started && !$past(rst)) begin
    assert (cost_now != 24'd0);
    assert (cost_now >= f_step && f_over <= -f_credit - 28'sd1 && f_over >= -28'sh4000000 && f_over < 28'sh2000000);
    assert (f_ahead < $signed(28'h1800000) && f_credit < $signed(28'h1800000));
    assert (f_credit >= -$signed(28'h1000000));
    assert (pin == ~credit[25]);
    assert (paid == (f_pays ? duty : 17'd0));
    if (f_pays) assert (phase < 24'h800000);
    if (f_full) assert (f_credit == $signed(28'h0FFFFFF) + $signed({4'd0, cost_now}) - f_phase);
    if (f_full && f_pays) assert (phase < cost_now);
    if ($past(power == 16'd0)) assert (credit[25]);
  end
