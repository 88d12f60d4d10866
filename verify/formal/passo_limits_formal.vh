// SPDX-License-Identifier: MIT
// Promises of limits and alarms, of one axis; included at the end of passo_limits.v.

reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) limits_reset : assume (rst);
end

// --- The step that waits goes into an active switch
wire f_low = waits[0] & negative[0] & limit_low[0];
wire f_high = waits[0] & ~negative[0] & limit_high[0];
reg f_entered_low = 1'b0;  // the switch is active since a time at which the axis did not move
reg f_entered_high = 1'b0;
always @(posedge clk) begin
  f_entered_low  <= ~rst & limit_low[0] & (f_entered_low | may_close);
  f_entered_high <= ~rst & limit_high[0] & (f_entered_high | may_close);
end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if ($past(limit_low[0] && !limit_soft[0])) hard_low_closes : assert (closed_low[0]);
    if ($past(limit_high[0] && !limit_soft[0])) hard_high_closes : assert (closed_high[0]);
    if (f_entered_low) never_further_in_low : assert (closed_low[0]);
    if (f_entered_high) never_further_in_high : assert (closed_high[0]);
    if (!$past(limit_low[0])) low_opens : assert (!closed_low[0]);
    if (!$past(limit_high[0])) high_opens : assert (!closed_high[0]);
    if ($past(waits[0] && (negative[0] ? closed_low[0] : closed_high[0]))) refused_stops : assert (limit_hard);
    if (limit_hard) stops_only_towards : assert ($past(waits[0] && (negative[0] ? closed_low[0] : closed_high[0])));
    if ($past(f_low || f_high) && $past(limit_soft[0])) soft_stops : assert (limit_softly);
    if (limit_softly) softly_only_towards : assert ($past(f_low || f_high));
    if ($past(alarm[0])) alarm_stops : assert (alarm_soft[0] == $past(alarm_soft[0]) ? (alarm_soft[0] ? alarm_softly : alarm_hard) : 1'b1);
    if (alarm_hard || alarm_softly) alarm_for_a_reason : assert ($past(alarm[0]));
    if ($past(f_low || f_high || alarm[0]) && !$past(clear)) axis_is_named : assert (named[0]);
  end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (closed_low[0]) assert ($past(limit_low[0]));
    if (f_entered_low) assert (closed_low[0]);
    if (f_entered_high) assert (closed_high[0]);
  end
