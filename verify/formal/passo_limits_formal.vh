// SPDX-License-Identifier: MIT
// Promises of limits and alarms; included at the end of passo_limits.v. A bit per axis.

reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) limits_reset : assume (rst);
end

// --- The steps that wait go into an active switch
wire [AXES-1:0] f_hit = waits & ((negative & limit_low) | (~negative & limit_high));
wire [AXES-1:0] f_refused = waits & ((negative & closed_low) | (~negative & closed_high));
reg [AXES-1:0] f_entered_low = {AXES{1'b0}};  // the switch is active since a time at which the axis did not move
reg [AXES-1:0] f_entered_high = {AXES{1'b0}};
always @(posedge clk) begin
  f_entered_low  <= {AXES{~rst}} & limit_low & (f_entered_low | {AXES{may_close}});
  f_entered_high <= {AXES{~rst}} & limit_high & (f_entered_high | {AXES{may_close}});
end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    hard_low_closes : assert (($past(limit_low & ~limit_soft) & ~closed_low) == {AXES{1'b0}});
    hard_high_closes : assert (($past(limit_high & ~limit_soft) & ~closed_high) == {AXES{1'b0}});
    never_further_in_low : assert ((f_entered_low & ~closed_low) == {AXES{1'b0}});
    never_further_in_high : assert ((f_entered_high & ~closed_high) == {AXES{1'b0}});
    low_opens : assert ((closed_low & ~$past(limit_low)) == {AXES{1'b0}});
    high_opens : assert ((closed_high & ~$past(limit_high)) == {AXES{1'b0}});
    low_closes_for_a_reason : assert ((closed_low & ~$past(closed_low | ~limit_soft | {AXES{may_close}})) == {AXES{1'b0}});
    high_closes_for_a_reason : assert ((closed_high & ~$past(closed_high | ~limit_soft | {AXES{may_close}})) == {AXES{1'b0}});
    if ($past(f_refused != {AXES{1'b0}})) refused_stops : assert (limit_hard);
    if (limit_hard) stops_only_towards : assert ($past(f_refused != {AXES{1'b0}}));
    if ($past((f_hit & limit_soft) != {AXES{1'b0}})) soft_stops : assert (limit_softly);
    if (limit_softly) softly_only_towards : assert ($past((f_hit & limit_soft) != {AXES{1'b0}}));
    if ($past((alarm & ~alarm_soft) != {AXES{1'b0}})) alarm_stops : assert (alarm_hard);
    if ($past((alarm & alarm_soft) != {AXES{1'b0}})) alarm_stops_softly : assert (alarm_softly);
    if (alarm_hard) alarm_for_a_reason : assert ($past((alarm & ~alarm_soft) != {AXES{1'b0}}));
    if (alarm_softly) softly_for_a_reason : assert ($past((alarm & alarm_soft) != {AXES{1'b0}}));
    if ($past(named == {AXES{1'b0}} && !clear)) axis_is_named : assert (named == $past(f_hit | alarm));
    if ($past(named != {AXES{1'b0}} && !clear)) first_is_named : assert (named == $past(named));
    if ($past(clear)) none_is_named : assert (named == {AXES{1'b0}});
  end
