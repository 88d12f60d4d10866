// SPDX-License-Identifier: MIT
// Promises of the following error; included at the end of passo_following.v. The sum is kept in 64 bits as the steps
// and counts come, and judged as a number.

// --- Assumptions: a reset at the beginning and at any time. The ratio and the limit may change at any time.
reg  f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) following_reset : assume (rst);
end

// --- The sum, as it was with each of the last clocks; a saturated sum is not added to
wire signed [63:0] f_ratio = $signed({32'd0, ratio});
wire signed [63:0] f_step = !step_made ? 64'sd0 : step_direction ? -f_ratio : f_ratio;
wire signed [63:0] f_count = !count_made ? 64'sd0 : count_down ? -64'sd65536 : 64'sd65536;
wire signed [63:0] f_off = 64'sd65536 * 64'sd65536;
reg  signed [63:0] f_change;
reg  signed [63:0] f_sum;
reg  signed [63:0] f_judged;
reg         [15:0] f_limit;
reg         [17:0] f_greatest;
reg                f_cleared = 1'b0;
wire               f_is_off = f_sum >= f_off || f_sum < -f_off;
always @(posedge clk) begin
  f_change <= f_step - f_count;
  if (!f_is_off) f_sum <= f_sum + f_change;
  f_judged   <= f_sum;
  f_limit    <= limit;
  f_greatest <= greatest;
  f_cleared  <= clear | zero | rst;
  if (rst || zero) begin
    f_change <= 64'sd0;
    f_sum    <= 64'sd0;
    f_judged <= 64'sd0;
  end
end
reg  signed [63:0] f_judged_q;
reg                f_zeroed = 1'b0;
wire signed [63:0] f_counts = $signed({48'd0, f_limit}) * 64'sd65536;
wire signed [63:0] f_most = $signed({46'd0, greatest} + 64'sd1) * 64'sd65536;
always @(posedge clk) begin
  f_judged_q <= rst || zero ? 64'sd0 : f_judged;
  f_zeroed   <= rst | zero;
end

always @(posedge clk)
  if (f_begun && f_started) begin
    error_is_the_sum : assert ($signed(error) == f_sum);
    if ($past(f_is_off) && !f_zeroed) stays_off_scale : assert ($stable(error));
    if (!f_zeroed) judged_on_every_clock : assert (exceeded == (f_judged_q >= f_counts || f_judged_q < -f_counts));
    if (f_zeroed) zero_is_zero : assert (error == 35'd0 && !exceeded && greatest == 18'd0);
    if (!f_cleared) greatest_is_above_all : assert (f_judged_q < f_most && f_judged_q >= -f_most);
    if (!f_cleared) greatest_is_kept : assert (greatest >= f_greatest);
  end

always @(posedge clk)
  if (f_begun && f_started) begin
    assert ($signed(change) + $signed({1'b0, change_carry}) == f_change);
    assert (f_change <= 64'sd4295032831 && f_change >= -64'sd4295032831);
    assert (f_sum < 2 * f_off + 64'sd65536 && f_sum >= -2 * f_off - 64'sd65536);
    assert (f_judged < 2 * f_off + 64'sd65536 && f_judged >= -2 * f_off - 64'sd65536);
    assert ({46'd0, magnitude} == (f_judged < 0 ? (-64'sd1 - f_judged) >>> 16 : f_judged >>> 16));
  end
