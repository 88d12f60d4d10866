// SPDX-License-Identifier: MIT
// Promises of compare; included at the end of passo_compare.v.

// --- Assumptions: steps of an axis are at least two clocks apart; axis and distance are written while there are none
reg  f_started = 1'b0;
wire f_quiet = ~(|made);
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) compare_reset : assume (rst);
  if (f_started)
    compare_direction_stands : assume ((step_made & (step_direction ^ $past(step_direction))) == {AXES{1'b0}});
  if (f_started) compare_steps_apart : assume ((step_made & $past(step_made)) == {AXES{1'b0}});
  if (write_distance || write_pulse) compare_written_at_rest : assume (f_quiet && $past(f_quiet));
  if (f_started && $past(write_distance || write_pulse || rst)) compare_no_step_then : assume (f_quiet);
  if (f_started && !(f_quiet && $past(f_quiet))) compare_axis_stands : assume ($stable(axis));
end

// --- Position of the axis, and the point it is compared with
reg  [31:0] f_position;
reg  [31:0] f_point;
wire [31:0] f_next = f_position + (directions[axis] ? 32'hFFFFFFFF : 32'd1);
wire        f_arrives = steps && f_next == f_point;
reg         f_arrived = 1'b0;
reg  [15:0] f_high = 16'd0;  // clocks since the last arrival
reg         f_pulse = 1'b0;
always @(posedge clk) begin
  if (steps) f_position <= f_next;
  if (f_arrives) f_point <= f_point + interval;
  if (write_distance) f_point <= f_position + distance;
  if (rst) f_point <= steps ? f_next : f_position;
  f_arrived <= f_arrives & ~rst;
  f_high    <= f_arrives ? 16'd1 : f_high + 16'd1;
  f_pulse   <= ~rst & ~write_distance & ~write_pulse & (f_arrives | (f_pulse & f_high != 16'hFFFF));
end

// --- The width changes only with `write_pulse`
always @(posedge clk)
  if (f_started && f_pulse && !write_pulse) compare_width_stands : assume ($stable(width));

always @(posedge clk)
  if (f_started && !$past(rst || write_distance || write_pulse)) begin
    if (f_arrived) pulse_on_arrival : assert (pin == (width != 16'd0));
    if (pin && !$past(pin)) pulse_only_on_arrival : assert (f_arrived);
    if (f_pulse && !write_pulse && f_high <= width) pulse_lasts : assert (pin);
    if (f_pulse && !write_pulse && f_high > width) pulse_ends : assert (!pin);
  end

always @(posedge clk)
  if (f_started && !$past(rst)) begin
    assert (away == f_point - f_position);
    if ($past(!steps && !write_distance && !rst)) assert (one_up == (away == 32'd1) && one_down == (away == 32'hFFFFFFFF));
    if (pin) assert (f_pulse && timer == f_high && (f_high <= width || write_pulse));
  end
