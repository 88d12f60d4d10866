// SPDX-License-Identifier: MIT
// Promises of the axis, at its ports; included at the end of passo_axis.v.

`ifdef CLOSED
// --- Limits: two clocks after a direction is closed, the step that leaves then was the last
reg [2:0] f_age = 3'd0;
always @(posedge clk) begin
  if (f_age != 3'd7) f_age <= f_age + 3'd1;
  if (f_age == 3'd0) closed_reset : assume (rst);
  if (f_age > 3'd3 && !rst && step_made) begin
    if (step_direction) none_into_closed_low : assert (!$past(closed_low, 2));
    else none_into_closed_high : assert (!$past(closed_high, 2));
  end
end
always @(posedge clk)
  if (f_age > 3'd1 && !rst && !$past(rst)) begin
    assert (waits == 4'd0 || waits == 4'd1 || waits == 4'd3 || waits == 4'd7 || waits == 4'd15);
    assert (!waits_up || (waits[0] && !waiting[0] && !$past(closed_high)));
    assert (!waits_down || (waits[0] && waiting[0] && !$past(closed_low)));
  end
`else
always @(posedge clk) axis_open : assume (!closed_low && !closed_high);

// --- Assumptions: a reset at the beginning and at any time. Polarities and mode change one clock after
// `pins_written`, which comes only while `quiet`, with no step request and no change of direction around it. With
// WRITTEN the timings change at any time, one clock after `timing_written`; else they are constant. The memory has the
// right one, unless the timings may have changed with this clock.
(* anyseq *) reg [15:0] step_high;
(* anyseq *) reg [15:0] step_low;
(* anyseq *) reg [15:0] dir_setup;
(* anyseq *) reg [15:0] dir_hold;
reg f_started = 1'b0;
reg [2:0] f_pins = 3'b000;  // pins_written one, two and three clocks ago
reg [2:0] f_reset = 3'b000;
reg [2:0] f_restarted = 3'b000;  // likewise: the running time begins again, or reset
reg f_restart = 1'b0;
reg f_timing_written = 1'b0;
reg [1:0] f_timing_place;
reg f_mode;  // as written
wire f_disturbed = timing_written | pins_written | f_restart | (f_restarted[1:0] != 2'b00) | (f_pins[1:0] != 2'b00);
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) axis_reset : assume (rst);
  f_pins           <= rst ? 3'b000 : {f_pins[1:0], pins_written};
  f_reset          <= {f_reset[1:0], rst};
  f_restarted      <= rst ? 3'b001 : {f_restarted[1:0], f_restart};
  f_restart        <= timing_written | pins_written | rst;
  f_timing_written <= timing_written;
  f_timing_place   <= timing_place;
  f_mode           <= both_edges_next;
  if (f_started) begin
    if (!f_timing_written)
      axis_timings_stand :
      assume ($stable(step_high) && $stable(step_low) && $stable(dir_setup) && $stable(dir_hold));
    if (!f_pins[0])
      axis_pins_stand : assume ($stable(both_edges) && $stable(step_inverted) && $stable(direction_inverted));
    else axis_mode_as_written : assume (both_edges == f_mode);
  end
  if (pins_written) axis_written_when_quiet : assume (rst || quiet);
  if (pins_written || f_pins[0]) axis_not_asked_then : assume (rst || !step_request);
  if (pins_written || f_pins[1:0] != 2'b00) axis_line_stands_then : assume (rst || $stable(direction));
  if (pins_written) axis_line_stood_before : assume (rst || $past(direction) == $past(direction, 2));
`ifndef WRITTEN
  axis_no_timing_written : assume (!timing_written);
`endif
  axis_timings_not_0 : assume (step_high != 16'd0 && step_low != 16'd0 && dir_setup != 16'd0 && dir_hold != 16'd0);
  if (f_started && !f_timing_written)
    axis_timing_is_there :
    assume (timing == (f_timing_place[1] ? (f_timing_place[0] ? step_high : step_low) : (f_timing_place[0] ? dir_setup : dir_hold)));
  axis_minimal_step_times : assume (high_is_minimal == (step_high == 16'd1) && low_is_minimal == (step_low == 16'd1));
  axis_minimal_dir_times : assume (setup_is_minimal == (dir_setup == 16'd1) && hold_is_minimal == (dir_hold == 16'd1));
`ifdef NARROW
  axis_narrow :
  assume (step_high < 16'd`NARROW && step_low < 16'd`NARROW && dir_setup < 16'd`NARROW && dir_hold < 16'd`NARROW);
`endif
end

wire [17:0] f_high = {2'd0, step_high};
wire [17:0] f_low = {2'd0, step_low};
wire [17:0] f_setup = {2'd0, dir_setup};
wire [17:0] f_hold = {2'd0, dir_hold};
// of the clock before: what the state was decided with
reg [17:0] f_high_q = 18'd1;
reg [17:0] f_low_q = 18'd1;
reg [17:0] f_setup_q = 18'd1;
reg [17:0] f_hold_q = 18'd1;
always @(posedge clk) begin
  f_high_q  <= f_high;
  f_low_q   <= f_low;
  f_setup_q <= f_setup;
  f_hold_q  <= f_hold;
end

// --- The pins, interpreted with the polarities of the clock before, which produced them. A change of polarity or
// mode counts as a change of both pins.
reg f_step_pin_q;
reg f_dir_pin_q;
reg f_step_inverted = 1'b0;
reg f_direction_inverted = 1'b0;
reg f_both = 1'b0;
reg f_step_q = 1'b0;
reg f_dir_q = 1'b0;
wire f_step = step_pin ^ f_step_inverted;
wire f_dir = dir_pin ^ f_direction_inverted;
wire f_pin_edge = f_started && step_pin != f_step_pin_q;
wire f_pin_dir_change = f_started && dir_pin != f_dir_pin_q;
wire f_changed = f_pins[1];  // polarities and mode have, at the pins
wire f_edge = f_pin_edge | f_changed | (f_started & f_reset[0] & (f_step != f_step_q));
wire f_dir_change = f_pin_dir_change | f_changed | (f_started & f_reset[0] & (f_dir != f_dir_q));
wire f_active = f_pin_edge & ~f_changed & (f_both | f_step);  // makes a step
always @(posedge clk) begin
  f_step_pin_q         <= step_pin;
  f_dir_pin_q          <= dir_pin;
  f_step_inverted      <= step_inverted;
  f_direction_inverted <= direction_inverted;
  f_both               <= both_edges;
  f_step_q             <= f_step;
  f_dir_q              <= f_dir;
end

always @(posedge clk)
  if (f_started && f_reset[0])
    reset_moves_no_pin : assert (!f_pin_edge && !f_pin_dir_change);

`ifndef WRITTEN
// --- How long the levels have lasted, this clock included; before the first change: F_EVER
localparam [17:0] F_EVER = 18'h3FFFF;
reg [17:0] f_step_lasted_q = F_EVER;
reg [17:0] f_dir_lasted_q = F_EVER;
reg f_was_reset_q = 1'b1;
wire f_was_reset = f_was_reset_q & ~f_active;  // there was a reset in this pulse
reg [17:0] f_since_reset = 18'd0;
wire [17:0] f_step_lasted = f_edge ? 18'd1 : f_step_lasted_q == F_EVER ? F_EVER : f_step_lasted_q + 18'd1;
wire [17:0] f_dir_lasted = f_dir_change ? 18'd1 : f_dir_lasted_q == F_EVER ? F_EVER : f_dir_lasted_q + 18'd1;
always @(posedge clk) begin
  f_step_lasted_q <= f_step_lasted;
  f_dir_lasted_q  <= f_dir_lasted;
  f_was_reset_q   <= rst | f_was_reset;
  f_since_reset   <= rst ? 18'd0 : f_since_reset == F_EVER ? F_EVER : f_since_reset + 18'd1;
end
wire [17:0] f_level_q = f_step_q ? f_high : f_low;  // minimum of the level before this clock

always @(posedge clk)
  if (f_started) begin
    if (!f_both && f_pin_edge && !f_step && !f_changed)
      high_exact : assert (f_was_reset ? f_step_lasted_q >= f_high : f_step_lasted_q == f_high);
    if (!f_both && f_step) high_ends : assert (f_was_reset ? f_since_reset <= f_high + 18'd2 : f_step_lasted <= f_high);
    if (!f_both && f_active) low_kept : assert (f_step_lasted_q >= f_low);
    if (!f_both && f_pin_dir_change) dir_changes_at_low : assert (!f_step && (!f_step_q || f_changed));
    if (f_both && f_active) both_levels_kept : assert (f_step_lasted_q >= f_level_q);
    if (f_active) setup_kept : assert (!f_dir_change && f_dir_lasted_q >= f_setup);
    if (f_pin_dir_change) hold_kept : assert ((!f_edge || f_changed) && f_step_lasted_q >= f_level_q + f_hold);
  end
`else
// --- The timings as they run at the pins, and which are over after this clock. A running one restarts four clocks
// after a write (the pins are two clocks late), with the new value; the values of two clocks before count, as the next
// pin change was decided then. After a change of polarity or mode they start two clocks later.
reg [17:0] f_high_qq;
reg [17:0] f_low_qq;
reg [17:0] f_setup_qq;
reg [17:0] f_hold_qq;
reg [17:0] f_level_run_q;
reg [17:0] f_hold_run_q;  // from the end of the level on
reg [17:0] f_setup_run_q;
reg f_level_over_q = 1'b0;
reg f_hold_over_q = 1'b0;
reg f_setup_over_q = 1'b0;
wire f_anew = f_restarted[2];
wire f_may_end = ~f_restarted[1] & ~f_changed & ~f_reset[0];
wire f_level_begins = f_edge | f_reset[0];
wire f_setup_begins = f_dir_change | f_reset[0];
wire [17:0] f_level_run = f_level_begins || (f_anew && !f_level_over_q) ? 18'd1 : f_level_run_q + 18'd1;
wire f_level_over = (f_level_over_q & ~f_level_begins) | (f_level_run >= (f_step ? f_high_qq : f_low_qq) && f_may_end);
wire f_hold_runs = f_level_over_q & ~f_level_begins;
wire [17:0] f_hold_run = !f_hold_runs ? 18'd0 : f_anew && !f_hold_over_q ? 18'd1 : f_hold_run_q + 18'd1;
wire f_hold_over = f_hold_runs & (f_hold_over_q | (f_hold_run >= f_hold_qq && f_may_end));
wire [17:0] f_setup_run = f_setup_begins || (f_anew && !f_setup_over_q) ? 18'd1 : f_setup_run_q + 18'd1;
wire f_setup_over = (f_setup_over_q & ~f_setup_begins) | (f_setup_run >= f_setup_qq && f_may_end);
always @(posedge clk) begin
  f_high_qq      <= f_high_q;
  f_low_qq       <= f_low_q;
  f_setup_qq     <= f_setup_q;
  f_hold_qq      <= f_hold_q;
  // a timing that is over stays over: its counter may stop
  f_level_run_q  <= f_level_over ? 18'd0 : f_level_run;
  f_hold_run_q   <= f_hold_over ? 18'd0 : f_hold_run;
  f_setup_run_q  <= f_setup_over ? 18'd0 : f_setup_run;
  f_level_over_q <= f_level_over;
  f_hold_over_q  <= f_hold_over;
  f_setup_over_q <= f_setup_over;
  if (f_started) begin
    if (!f_both && f_step_q && !f_changed && !f_reset[0]) high_ends_when_over : assert (f_edge == f_level_over_q);
    else if (f_pin_edge && !f_changed) level_ends_when_over : assert (f_level_over_q);
    if (f_active) step_when_setup_over : assert (!f_dir_change && f_setup_over_q);
    if (f_pin_dir_change)
      dir_changes_when_hold_over : assert ((!f_edge || f_changed) && f_hold_over_q && (f_both || !f_step || f_changed));
  end
end
`endif

// --- The queue: four directions, two clocks late, as seen at the pins
reg [3:0] f_waiting;
reg [2:0] f_waiting_count = 3'd0;
reg [1:0] f_request = 2'b00;  // of one and of two clocks ago
reg [1:0] f_direction;
reg [1:0] f_drop = 2'b00;
reg [1:0] f_full = 2'b00;
wire [2:0] f_place = f_waiting_count - {2'd0, f_active};
wire f_accepted = f_request[1] && f_waiting_count != 3'd4;
always @(posedge clk) begin
  f_request   <= {f_request[0], step_request};
  f_direction <= {f_direction[0], direction};
  f_drop      <= {f_drop[0], drop};
  f_full      <= {f_full[0], full};
  if (f_active) f_waiting <= f_waiting >> 1;
  if (f_accepted) f_waiting[f_place[1:0]] <= f_direction[1];
  f_waiting_count <= f_drop[1] ? 3'd0 : f_place + {2'd0, f_accepted};
  if (f_started && f_active) begin
    step_was_asked_for : assert (f_waiting_count != 3'd0);
    right_direction : assert (f_dir == f_waiting[0]);
  end
  if (f_started)
    full_told : assert (f_full[1] == (f_waiting_count == 3'd4));
  if (rst) begin
    f_waiting_count <= 3'd0;

    {f_request, f_drop, f_full} <= 6'd0;
  end
end

// a waiting step leaves within the time of a pulse and a direction change (two, if one has just begun)
reg [19:0] f_waited = 20'd0;
wire [19:0] f_patience = {2'd0, f_high} + {2'd0, f_low} + {2'd0, f_hold} + {1'b0, f_setup, 1'b0} + 20'd4;
always @(posedge clk) begin
  f_waited <= (f_active || f_drop[1] || f_waiting_count == 3'd0 || f_disturbed || rst) ? 20'd0 : f_waited + 20'd1;
  if (f_started) step_not_lost : assert (f_waited <= f_patience);
end

// --- `step_made` is what leaves the pin one clock later
always @(posedge clk)
  if (f_started && !f_reset[0]) begin
    made_is_what_leaves : assert ($past(step_made) == f_active);
    if (f_active) made_with_its_direction : assert ($past(step_direction) == f_dir);
  end

// --- Lost steps
reg [3:0] f_lost = 4'd0;
always @(posedge clk) begin
  f_lost <= clear || rst ? 4'd0 : f_lost + {3'd0, step_request && full && f_lost != 4'd15};
  if (f_started) lost_steps_counted : assert (lost == f_lost);
end

// --- While nothing waits, DIR follows the line, and then `quiet` rises
reg [19:0] f_still = 20'd0;
always @(posedge clk) begin
  f_still <= f_started && !rst && !f_disturbed && f_waiting_count == 3'd0 && f_request == 2'b00 && !step_request && !f_active
             && f_direction[0] == direction && f_direction[1] == direction
             ? (f_still[19] ? f_still : f_still + 20'd1) : 20'd0;
  if (f_still > f_patience) dir_follows_the_line : assert (f_dir == f_direction[0]);
  if (f_still > f_patience) quiet_comes : assert (quiet);
end

// --- Quiet: nothing waits or is in progress, the pins are stable and stay so
reg f_quiet_q = 1'b0;
always @(posedge clk) begin
  f_quiet_q <= quiet & ~rst;
  if (f_started && quiet) 
    nothing_waits_when_quiet : assert (!f_request[0] && (f_drop[1] || (f_waiting_count == 3'd0 && !f_request[1])));
  if (f_started && (quiet || f_quiet_q)) pins_stand_when_quiet : assert (!f_pin_edge && !f_pin_dir_change);
  if (f_quiet_q && !f_request[0] && !f_pins[0] && f_direction[1] == $past(direction, 3))
    quiet_until_asked : assert (quiet);
end

// --- EN follows its register
reg f_enable_q;
always @(posedge clk) begin
  f_enable_q <= enable != enable_inverted;
  if (f_started) enable_follows : assert (enable_pin == f_enable_q);
end

// --- Invariants, for the induction
wire [15:0] f_elapsed = timer - 16'd1;  // clocks of the state, this one included
wire [17:0] f_timer = {2'd0, f_elapsed};
wire [17:0] f_level = step ? f_high_q : f_low_q;
wire f_step_shown = f_step == step;
wire f_dir_shown = f_dir == dir;
wire f_is_pulse = high | low;
wire f_is_hold = hold;
wire f_is_setup = setup;
wire f_is_ready = idle & ~hold;
wire f_dir_right = waiting[0] == dir && !unsettled;
wire f_clean = ~f_reset[0] & ~f_reset[1];
wire [2:0] f_count = {2'd0, waits[0]} + {2'd0, waits[1]} + {2'd0, waits[2]} + {2'd0, waits[3]};
// clocks until the next active edge, or until DIR is right
wire [17:0] f_time = f_is_hold ? f_hold_q : f_is_setup ? f_setup_q : f_level;
wire [19:0] f_left = {2'd0, f_time} - {2'd0, f_timer} + 20'd1;
wire [19:0] f_setup_time = {2'd0, f_setup} + 20'd1;
wire [19:0] f_rank =
    f_is_pulse ? f_left + (step && !both_edges ? {2'd0, f_low} : 20'd0)
                 + (f_dir_right ? 20'd0 : {2'd0, f_hold} + f_setup_time) :
    f_is_hold  ? (f_dir_right ? 20'd0 : f_left + f_setup_time) :
    f_is_setup ? f_left + (f_dir_right ? 20'd0 : f_setup_time) :
                 (f_dir_right ? 20'd0 : f_setup_time);
wire [19:0] f_setup_left = f_dir_right ? 20'd0 : f_setup_time;
wire [19:0] f_until_quiet =
    f_is_pulse ? f_left + (step && !both_edges ? {2'd0, f_low} : 20'd0) + {2'd0, f_hold} + f_setup_left :
    f_is_ready ? f_setup_left : f_left + f_setup_left;
always @(posedge clk)
  if (f_started) begin
    assert (waits == 4'b0000 || waits == 4'b0001 || waits == 4'b0011 || waits == 4'b0111 || waits == 4'b1111);
    assert (f_waiting_count <= 3'd4);
    assert (f_restarted[0] || !f_reset[0]);
    assert (restart == f_restart && (f_restart || !(f_timing_written || f_pins[0] || f_reset[0])));
    assert (f_high_q < 18'd16 && f_low_q < 18'd16 && f_setup_q < 18'd16 && f_hold_q < 18'd16);
    assert (f_high_q != 18'd0 && f_low_q != 18'd0 && f_setup_q != 18'd0 && f_hold_q != 18'd0);
    if (!f_timing_written) assert (f_high_q == f_high && f_low_q == f_low && f_setup_q == f_setup && f_hold_q == f_hold);
    assert (f_reset[0] == $past(rst));
    assert (settle == f_pins[0]);
    assert (f_quiet_q == $past(quiet && !rst));
    if (settle) assert (f_is_ready && f_dir_right && waits == 4'd0 && !quiet && f_dir_shown && f_request[0] == 1'b0);
    if (quiet) assert (f_is_ready || f_is_setup && f_timer == 18'd1 || settle);
    if (!both_edges) assert (step == high);
    assert ({2'd0, high} + {2'd0, low} + {2'd0, setup} + {2'd0, idle} == 3'd1 && (idle || !hold));
    assert (!high || (step && !both_edges));
    if (unsettled) assert (!setup);
    if (!f_is_ready) begin
      assert (f_restarted[0] ? f_elapsed == 16'd0 : f_timer >= 18'd1 && f_timer <= f_time);
      assert ((f_is_pulse ? level_done : dir_done) == (f_timer == f_time));
    end
    // the timing that would begin next
    if (!f_is_pulse && !settle) assert (level_done == ((step ? f_low_q : f_high_q) == 18'd1 && !f_restarted[0]));
    if (f_is_ready) assert (dir_done == (f_setup_q == 18'd1 && !f_restarted[0]));
    assert (waits_up == (waits[0] & ~waiting[0]) && waits_down == (waits[0] & waiting[0]));
    if (f_reset[0]) assert (f_is_pulse && f_step_shown && f_dir_shown && unsettled && waits == 4'd0 && !step_made);
`ifndef WRITTEN
    if (!f_step_shown && !settle) begin
      assert (f_is_pulse && f_timer == 18'd1);
      assert (f_step_lasted >= (f_step ? f_high : f_low));
      if (!both_edges && f_step && !f_was_reset) assert (f_step_lasted == f_high);
      if (!both_edges && f_step && f_was_reset) assert (f_since_reset <= f_high + 18'd2);
    end else begin
      if (high && !f_was_reset) assert (f_step_lasted + 18'd1 == f_timer);
      if (high && f_was_reset) assert (f_since_reset == (f_restart ? 18'd0 : f_timer + 18'd1));
      if (f_is_pulse) assert ({1'b0, f_step_lasted} + 19'd1 >= {1'b0, f_timer});
      if (f_is_hold) assert ({1'b0, f_step_lasted} + 19'd1 >= {1'b0, f_level + f_timer});
    end
    if (!f_is_pulse && !settle) assert (f_step_shown);
    if ((f_is_ready && !settle) || f_is_setup) assert (f_step_lasted >= f_level + f_hold);
    if (settle) assert (f_step_lasted >= (f_step ? f_high : f_low) + f_hold);
    if (!f_is_setup) assert (f_dir_shown && (unsettled || f_dir_lasted >= f_setup || f_changed));
    else if (!f_dir_shown) assert (f_timer == 18'd1);
    else assert ({1'b0, f_dir_lasted} + 19'd1 >= {1'b0, f_timer});
`else
    assert (f_high_qq < 18'd16 && f_low_qq < 18'd16 && f_setup_qq < 18'd16 && f_hold_qq < 18'd16);
    if (!f_restarted[0]) assert (f_high_qq == f_high_q && f_low_qq == f_low_q && f_setup_qq == f_setup_q && f_hold_qq == f_hold_q);
    if (!f_step_shown && !settle) assert (f_is_pulse && f_level_over && (f_restarted[0] || f_timer == 18'd1));
    else begin
      assert (f_level_over == !f_is_pulse);
      if (f_is_pulse && f_restarted[1:0] == 2'b00) assert (f_level_run + 18'd1 == f_timer);
      if (f_is_hold && f_restarted[1:0] == 2'b00) assert (f_hold_run + 18'd1 == f_timer);
      if (!f_is_pulse) assert (f_hold_over == !f_is_hold);
    end
    if (!f_is_setup) assert (f_dir_shown && (unsettled || f_setup_over));
    else if (!f_dir_shown) assert (f_restarted[0] || f_timer == 18'd1);
    else if (!f_setup_over && f_restarted[1:0] == 2'b00) assert (f_setup_run + 18'd1 >= f_timer);
`endif
    if (f_changed) assert (unsettled && low && f_step_shown);
    if (f_clean) begin
      assert (f_waiting_count == $past(f_count, 2));
      if (f_waiting_count > 3'd0) assert (f_waiting[0] == $past(waiting[0], 2));
      if (f_waiting_count > 3'd1) assert (f_waiting[1] == $past(waiting[1], 2));
      if (f_waiting_count > 3'd2) assert (f_waiting[2] == $past(waiting[2], 2));
      if (f_waiting_count > 3'd3) assert (f_waiting[3] == $past(waiting[3], 2));
      assert (f_active == $past(step_begins, 2));
      assert (f_full[1] == $past(full, 2));
      assert (f_request[1] == $past(step_request, 2) && f_drop[1] == $past(drop, 2));
      if (f_waiting_count == 3'd0 || f_restart || f_restarted != 3'b000) assert (f_waited == 20'd0);
      if (f_waiting_count != 3'd0 && !f_restart && f_restarted[1:0] == 2'b00) assert (f_waited + $past(f_rank, 2) <= f_patience);
      if (f_restart || f_restarted != 3'b000) assert (f_still == 20'd0);
      if (f_still > 20'd2) begin
        assert (f_waiting_count == 3'd0 && waits == 4'd0);
        assert ($past(waiting[0], 2) == f_direction[1]);
        assert (f_still[19] || f_dir == f_direction[1] || f_still + $past(f_rank, 2) <= f_patience);
        if (f_still[19]) assert (f_dir == f_direction[1]);
        assert (quiet || (!f_still[19] && f_still + $past(f_until_quiet, 2) <= f_patience));
      end
    end else assert (!f_active && f_waiting_count == 3'd0 && !f_request[1] && f_waited == 20'd0 && f_still <= 20'd1);
  end
`endif
