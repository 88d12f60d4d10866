// SPDX-License-Identifier: MIT
// Promises of the trigger; included at the end of passo_trigger.v.

// --- Assumptions: a reset at the beginning; the filter changes one clock after `forget` (passo_machine)
reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) trigger_reset : assume (rst);
  if (f_started && !$past(forget)) trigger_filter : assume (filter == $past(filter));
end

// --- The source that was written
wire f_of_axis = source == TRIGGER_SOURCE_LIMIT_LOW || source == TRIGGER_SOURCE_LIMIT_HIGH
                 || source == TRIGGER_SOURCE_HOME || source == TRIGGER_SOURCE_INDEX;
wire [4:0] f_place = (source == TRIGGER_SOURCE_LIMIT_LOW  ? 5'd0 : source == TRIGGER_SOURCE_LIMIT_HIGH ? 5'd1 :
                      source == TRIGGER_SOURCE_HOME ? 5'd2 : 5'd3) * AXES + axis;
wire f_source = source == TRIGGER_SOURCE_PROBE ? probe : sources[f_place];
wire f_exists = source == TRIGGER_SOURCE_PROBE || (f_of_axis && axis < AXES);

// --- For how many clocks, with this one, the source has kept its level; since a write and `forget` it is the right one
reg [2:0] f_age = 3'd0;  // clocks since then
reg picked_q;
reg [17:0] f_same_q = 18'd0;
wire [17:0] f_same = f_age < 3'd3 ? 18'd0 : f_age == 3'd3 || picked != picked_q ? 18'd1 : f_same_q + 18'd1;
always @(posedge clk) begin
  f_age    <= write || forget ? 3'd0 : f_age + (f_age != 3'd7);
  picked_q <= picked;
  f_same_q <= f_same[17] ? f_same_q : f_same;
end

// --- On how many clocks up to the last one the source has had the level that was not accepted yet
reg [16:0] f_run = 17'd0;
reg f_was_armed = 1'b0;  // by a write, and not used since
always @(posedge clk) begin
  f_run       <= armed && (picked ^ level) && !accepts && !rst && !write && !forget ? f_run + 17'd1 : 17'd0;
  f_was_armed <= !rst && (write ? bus_data[CHANNEL_TRIGGER_ARM_LSB] : f_was_armed && !latch);
end

reg [8:0] f_written;
always @(posedge clk)
  f_written <= {bus_data[CHANNEL_TRIGGER_ACTION_LSB+:CHANNEL_TRIGGER_ACTION_BITS], bus_data[CHANNEL_TRIGGER_FALLING_LSB],
                bus_data[CHANNEL_TRIGGER_AXIS_LSB+:CHANNEL_TRIGGER_AXIS_BITS],
                bus_data[CHANNEL_TRIGGER_SOURCE_LSB+:CHANNEL_TRIGGER_SOURCE_BITS]};

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (latch) fires_only_when_armed : assert ($past(armed) && f_was_armed);
    if (latch) fires_once : assert (!armed && !arming && fired);
    if (latch) only_the_wanted_edge : assert ($past(picked) != $past(falling));
    if (latch) longer_than_the_filter : assert ($past(f_run) >= {1'b0, $past(filter)});
    if ($past(armed && picked != falling && level == falling && f_run == {1'b0, filter}) && !$past(write))
      always_fires : assert (latch);
    if (armed && (picked ^ level)) not_later : assert (f_run <= {1'b0, filter});
    if ($past(fired) && !$past(write)) stays_fired : assert (fired);
    if (hard_stop || soft_stop || end_endless) acts_with_the_latch : assert (latch);
    settings_as_written :
    assert ({action, falling, axis, source} == ($past(write) ? f_written : $past({action, falling, axis, source})));
    acts_as_written :
    assert (hard_stop == (latch && action == TRIGGER_ACTION_HARD_STOP) && soft_stop == (latch && action == TRIGGER_ACTION_SOFT_STOP)
            && end_endless == (latch && action == TRIGGER_ACTION_END_ENDLESS));
    if ($past(f_exists)) source_is_seen : assert (picked == $past(f_source));
    if (armed && !$past(armed)) begin
      armed_at_a_known_level : assert ($past(f_same) > {2'd0, $past(filter)});
      armed_at_this_level : assert (level == $past(picked));
    end
    if (arming) armed_in_time : assert (f_same <= {2'd0, filter} + 18'd2);
    if (arming || armed) not_both : assert (!(arming && armed));
    if ($past(forget)) settings_rearm : assert (!armed && (arming == $past(write ? bus_data[CHANNEL_TRIGGER_ARM_LSB] : arming || (armed && !fires))));
    if (arming && !$past(arming)) arming_for_a_reason : assert ($past(write || forget));
  end

wire [15:0] f_count = filter - count;  // clocks counted
always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (armed || arming) assert (f_was_armed);
    if (armed) assert (f_run == {1'b0, f_count} && !fired && !latch && stale == 2'd0);
    if (latch) assert (f_was_armed);
    if (armed || arming) assert ({1'b0, stale} == (f_age < 3'd3 ? 3'd3 - f_age : 3'd0));
    if ((armed || arming) && stale == 2'd0) assert (f_count <= filter);
    if (arming && stale != 2'd3) assert (level == picked_q);
    if (arming && stale == 2'd0) begin
      assert (f_same == {2'd0, f_count} + 18'd1 || f_same == {2'd0, f_count} + 18'd2 || picked != picked_q);
    end
    if (arming) assert (!fired && !latch);
  end
