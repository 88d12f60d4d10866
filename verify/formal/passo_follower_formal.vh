// SPDX-License-Identifier: MIT
// Promises of the follower; included at the end of passo_follower.v.

// --- Assumptions: a reset at the beginning and at any time; the limit is at most 1/2; scale is constant while following
reg  f_started = 1'b0;
reg  f_follows = 1'b0;  // in the clock before
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  f_follows <= following & ~rst;
  if (!f_started) follower_reset : assume (rst);
  follower_limit : assume (limit <= 32'h8000_0000);
  if (f_follows) follower_scale : assume ($stable(scale));
end

// --- Counts and advances since the motion began, as numbers
reg  signed [31:0] f_counted;  // 2^scale each
reg  signed [31:0] f_change;  // of the clock before
reg         [31:0] f_made;
reg         [31:0] f_made_q;
reg                f_made_one;
reg  signed [31:0] f_owed_q;
wire signed [31:0] f_one = 32'sd1 <<< scale;
wire signed [31:0] f_owed = $signed({{8{owed[23]}}, owed});
always @(posedge clk) begin
  f_change  <= !count_made || lost ? 32'sd0 : count_down ? -f_one : f_one;
  f_counted <= f_counted + f_change;
  f_made     <= f_made + {31'd0, advance};
  f_made_one <= advance;
  f_owed_q   <= f_owed;
  if (!following || rst) begin
    f_change   <= 32'sd0;
    f_counted  <= 32'sd0;
    f_made     <= 32'd0;
    f_made_one <= 1'b0;
    f_owed_q   <= 32'sd0;
  end
end

// --- The limit as a bucket: an advance takes 1.0, an enabled clock adds the limit, what is above 2 runs over
reg  [33:0] f_bucket;
wire [33:0] f_filled = f_bucket + (enable ? {2'd0, limit} : 34'd0) - {1'b0, advance, 32'd0};
always @(posedge clk) begin
  f_bucket <= f_filled[33] ? 34'h1_FFFF_FFFF : f_filled;
  if (!following || rst) f_bucket <= 34'h1_0000_0000;
end

always @(posedge clk)
  if (f_begun && f_started) begin
    nothing_made_or_lost : assert (f_owed + $signed(f_made) == f_counted);
    if (advance) only_when_enabled : assert (enable && !stall && f_follows);
    if (advance) advances_apart : assert (!f_made_one);
    if (advance) owed_before_made : assert (f_owed_q > 32'sd0);
    // no count takes back more than itself
    if (advance) not_ahead : assert (f_owed > -f_one);
    if (advance) no_faster_than_the_limit : assert (f_bucket >= 34'h1_0000_0000);
    if (f_follows && f_owed > 0 && f_owed_q > 0 && !f_made_one && credit && enable && !stall)
      made_when_owed : assert (advance);
    if (f_follows) behind_told : assert (behind == (f_owed_q >= 2 * f_one));
    if (f_follows)
      lost_told : assert (lost == ($past(f_follows && lost) || f_owed_q >= 32'sd4194304 || f_owed_q < -32'sd4194304
                          || $past(slipped)));
    never_wraps : assert (f_owed < 32'sd4194304 + 32'sd512 && f_owed > -32'sd4194304 - 32'sd512);
  end

always @(posedge clk)
  if (f_begun && f_started) begin
    assert (due == (f_owed_q > 32'sd0 && f_follows));
    if (!f_follows) assert (owed == 24'd0 && !lost && !behind && credit && sum == 32'd0 && f_counted == 0 && f_made == 0);
    if (credit) assert (sum < 32'h8000_0000);
    // the credit is what the sum has carried
    assert (f_bucket >= {1'b0, credit, sum} && !f_bucket[33]);
    if (f_made_one) assert (!credit);
    assert (change == f_change[7:0] - {7'd0, change_carry} && change_above == (f_change < 0) && change_carry == (f_change < 0));
    assert (f_change == 0 || f_change == f_one || f_change == -f_one);
    assert (change_advanced == (f_change > 0 ? f_change[7:0] - 8'd1 : f_change == 0 ? 8'hFF : change));
    assert (change_advanced_above == (f_change <= 0));
    if (!lost) assert (f_owed < 32'sd4194304 + 32'sd256 && f_owed > -32'sd4194304 - 32'sd256);
    if (lost && f_change != 0) assert (f_owed < 32'sd4194304 + 32'sd384 && f_owed > -32'sd4194304 - 32'sd384);
  end
