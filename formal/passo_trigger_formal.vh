// SPDX-License-Identifier: MIT
// Promises of the trigger; included at the end of passo_trigger.v.

// --- Assumptions: a reset at the beginning; the filter does not change while the trigger is armed
reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) trigger_reset : assume (rst);
  if (f_started && armed) trigger_filter : assume (filter == $past(filter));
end

// --- On how many clocks up to the last one the source has had the level that was not accepted yet; time since arming
reg [16:0] f_run = 17'd0;
reg [31:0] f_clocks;
reg f_was_armed = 1'b0;  // by a write, and not used since
always @(posedge clk) begin
  f_run       <= armed && (picked ^ level) && !changes && !rst && !write ? f_run + 17'd1 : 17'd0;
  f_clocks    <= !armed ? 32'd0 : f_clocks + 32'd1;
  f_was_armed <= !rst && (write ? bus_data[CHANNEL_TRIGGER_ARM_LSB] : f_was_armed && !latch);
end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (latch) fires_only_when_armed : assert ($past(armed) && f_was_armed);
    if (latch) fires_once : assert (!armed && fired);
    if (latch) only_the_wanted_edge : assert ($past(picked) != $past(falling));
    if (latch) longer_than_the_filter : assert ($past(f_run) >= {1'b0, $past(filter)});
    if ($past(armed && picked != falling && level == falling && f_run == {1'b0, filter}) && !$past(write))
      always_fires : assert (latch);
    if (armed && (picked ^ level)) not_later : assert (f_run <= {1'b0, filter});
    if (armed && $past(armed)) counts_from_arming : assert (clocks == f_clocks);
    if (latch) keeps_its_clock : assert (clocks == $past(clocks) + 32'd1);
    if ($past(fired) && !$past(write)) stays_fired : assert (fired);
    if (hard_stop || soft_stop || end_endless) acts_with_the_latch : assert (latch);
    if ($past(f_begun, 2) && $past(!write) && source == TRIGGER_SOURCE_PROBE) source_is_seen : assert (picked == $past(probe));
  end

`ifdef INVARIANTS
always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (armed || arming != 2'b00) assert (f_was_armed);
    if (armed) assert (f_run == {1'b0, count} && clocks == f_clocks && !fired && !latch);
    if (armed && !(picked ^ level)) assert (1'b1);
    if (!armed) assert (count == 16'd0 || $past(armed));
    if (latch) assert (f_was_armed);
  end
`endif
