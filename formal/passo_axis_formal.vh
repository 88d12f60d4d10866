// SPDX-License-Identifier: MIT
// What the axis promises, seen from its ports; included at the end of passo_axis.

// --- Assumptions: the settings stand still; with WRITTEN the timings change at any time, a clock after
// `timing_written`
reg f_begun = 1'b0;
reg [2:0] f_written = 3'b000;  // one, two and three clocks ago
wire f_disturbed = timing_written | (f_written[1:0] != 2'b00);
always @(posedge clk) begin
  f_begun <= 1'b1;
  assume (rst == !f_begun);
  if (f_begun) begin
    if (!f_written[0]) assume ($stable(step_high) && $stable(step_low) && $stable(dir_setup) && $stable(dir_hold));
    assume ($stable(both_edges) && $stable(step_inverted) && $stable(direction_inverted));
  end
  f_written <= {f_written[1:0], timing_written & ~rst};
`ifndef WRITTEN
  assume (!timing_written);
`endif
  assume (step_high != 16'd0 && step_low != 16'd0 && dir_setup != 16'd0 && dir_hold != 16'd0);
  assume (short_high == (step_high == 16'd1) && short_low == (step_low == 16'd1));
  assume (short_setup == (dir_setup == 16'd1) && short_hold == (dir_hold == 16'd1));
`ifdef NARROW
  assume (step_high < 16'd`NARROW && step_low < 16'd`NARROW && dir_setup < 16'd`NARROW && dir_hold < 16'd`NARROW);
`endif
`ifdef SMALL
  assume (step_high <= 16'd2 && step_low <= 16'd2 && dir_setup <= 16'd3 && dir_hold <= 16'd2);
`endif
end

wire [17:0] f_high = {2'd0, step_high};
wire [17:0] f_low = {2'd0, step_low};
wire [17:0] f_setup = {2'd0, dir_setup};
wire [17:0] f_hold = {2'd0, dir_hold};

// --- Pins without their polarity; in the clock after reset they have not got it yet
reg f_pins_valid = 1'b0;
always @(posedge clk) f_pins_valid <= f_begun;
wire f_step = f_pins_valid & (step_pin ^ step_inverted);
wire f_dir = f_pins_valid & (dir_pin ^ direction_inverted);

reg f_step_q = 1'b0;
reg f_dir_q = 1'b0;
always @(posedge clk) begin
  f_step_q <= f_step;
  f_dir_q  <= f_dir;
end
wire f_edge = f_step != f_step_q;
wire f_turn = f_dir != f_dir_q;
wire f_active = f_edge & (both_edges | f_step);

`ifndef WRITTEN
// --- How long the levels have lasted, this clock included; before the first change: for ever
localparam [17:0] F_EVER = 18'h3FFFF;
reg [17:0] f_step_lasted_q = F_EVER;
reg [17:0] f_dir_lasted_q = F_EVER;
wire [17:0] f_step_lasted = f_edge ? 18'd1 : f_step_lasted_q == F_EVER ? F_EVER : f_step_lasted_q + 18'd1;
wire [17:0] f_dir_lasted = f_turn ? 18'd1 : f_dir_lasted_q == F_EVER ? F_EVER : f_dir_lasted_q + 18'd1;
always @(posedge clk) begin
  f_step_lasted_q <= f_step_lasted;
  f_dir_lasted_q  <= f_dir_lasted;
end
wire [17:0] f_level_q = f_step_q ? f_high : f_low;  // how long the level before this clock had to last

always @(posedge clk)
  if (f_pins_valid) begin
    if (!both_edges) begin
      if (f_edge && !f_step) high_exact : assert (f_step_lasted_q == f_high);
      if (f_step) high_ends : assert (f_step_lasted <= f_high);
      if (f_edge && f_step) low_kept : assert (f_step_lasted_q >= f_low);
      if (f_turn) dir_turns_at_low : assert (!f_step && !f_step_q);
    end else if (f_edge) both_levels_kept : assert (f_step_lasted_q >= f_level_q);
    if (f_active) setup_kept : assert (!f_turn && f_dir_lasted_q >= f_setup);
    if (f_turn) hold_kept : assert (!f_edge && f_step_lasted_q >= f_level_q + f_hold);
  end
`else
// --- The times as they run on the pins, and which of them are over after this clock. One that runs begins anew three
// clocks after a write (the pins are two clocks late), with the new timing; the timings of the clock before count, as
// the next change of the pins was decided then.
reg [17:0] f_high_q;
reg [17:0] f_low_q;
reg [17:0] f_setup_q;
reg [17:0] f_hold_q;
reg [17:0] f_level_run_q;
reg [17:0] f_hold_run_q;  // from the end of the level on
reg [17:0] f_setup_run_q;
reg f_level_over_q = 1'b1;
reg f_hold_over_q = 1'b1;
reg f_setup_over_q = 1'b1;
wire f_may_end = ~f_written[1];
wire [17:0] f_level_run = f_edge || (f_written[2] && !f_level_over_q) ? 18'd1 : f_level_run_q + 18'd1;
wire f_level_over = (f_level_over_q & ~f_edge) | (f_level_run >= (f_step ? f_high_q : f_low_q) && f_may_end);
wire f_hold_runs = f_level_over_q & ~f_edge;
wire [17:0] f_hold_run = !f_hold_runs ? 18'd0 : f_written[2] && !f_hold_over_q ? 18'd1 : f_hold_run_q + 18'd1;
wire f_hold_over = f_hold_runs & (f_hold_over_q | (f_hold_run >= f_hold_q && f_may_end));
wire [17:0] f_setup_run = f_turn || (f_written[2] && !f_setup_over_q) ? 18'd1 : f_setup_run_q + 18'd1;
wire f_setup_over = (f_setup_over_q & ~f_turn) | (f_setup_run >= f_setup_q && f_may_end);
always @(posedge clk) begin
  f_high_q       <= f_high;
  f_low_q        <= f_low;
  f_setup_q      <= f_setup;
  f_hold_q       <= f_hold;
  // what has run once is over; the counters need not go on
  f_level_run_q  <= f_level_over ? 18'd0 : f_level_run;
  f_hold_run_q   <= f_hold_over ? 18'd0 : f_hold_run;
  f_setup_run_q  <= f_setup_over ? 18'd0 : f_setup_run;
  f_level_over_q <= f_level_over | ~f_begun;
  f_hold_over_q  <= f_hold_over | ~f_begun;
  f_setup_over_q <= f_setup_over | ~f_begun;
  if (f_pins_valid) begin
    if (!both_edges && f_step_q) high_ends_when_over : assert (f_edge == f_level_over_q);
    else if (f_edge) level_ends_when_over : assert (f_level_over_q);
    if (f_active) step_when_setup_over : assert (!f_turn && f_setup_over_q);
    if (f_turn) turn_when_hold_over : assert (!f_edge && f_hold_over_q && (both_edges || !f_step));
  end
end
`endif

// --- The queue: four directions, seen two clocks late, as the pins show it
reg [3:0] f_waiting;
reg [2:0] f_waiting_count = 3'd0;
reg [1:0] f_request = 2'b00;  // of one and of two clocks ago
reg [1:0] f_direction;
reg [1:0] f_drop = 2'b00;
reg [1:0] f_full = 2'b00;
wire [2:0] f_place = f_waiting_count - {2'd0, f_active};
wire f_accepted = f_request[1] && f_waiting_count != 3'd4;
always @(posedge clk) begin
  f_request   <= {f_request[0], step_request & ~rst};
  f_direction <= {f_direction[0], direction};
  f_drop      <= {f_drop[0], drop};
  f_full      <= {f_full[0], full & ~rst};
  if (f_active) f_waiting <= f_waiting >> 1;
  if (f_accepted) f_waiting[f_place[1:0]] <= f_direction[1];
  f_waiting_count <= f_drop[1] ? 3'd0 : f_place + {2'd0, f_accepted};
  if (f_active) begin
    step_was_asked_for : assert (f_waiting_count != 3'd0);
    right_direction : assert (f_dir == f_waiting[0]);
  end
  if (f_pins_valid)
    full_told : assert (f_full[1] == (f_waiting_count == 3'd4));
end

// a step that waits leaves within the time of a pulse and a turn (of two turns, when one has just begun)
reg [19:0] f_waited = 20'd0;
wire [19:0] f_patience = {2'd0, f_high} + {2'd0, f_low} + {2'd0, f_hold} + {1'b0, f_setup, 1'b0} + 20'd4;
always @(posedge clk) begin
  f_waited <= (f_active || f_drop[1] || f_waiting_count == 3'd0 || f_disturbed) ? 20'd0 : f_waited + 20'd1;
  step_not_lost : assert (f_waited <= f_patience);
end

// --- What is counted as made is what leaves the pin one clock later
always @(posedge clk)
  if (f_pins_valid) begin
    made_is_what_leaves : assert ($past(step_made) == f_active);
    if (f_active) made_with_its_direction : assert ($past(step_direction) == f_dir);
  end

// --- Lost steps
reg       f_refused = 1'b0;  // a step, a clock ago
reg [3:0] f_lost = 4'd0;
always @(posedge clk) begin
  f_refused <= step_request & full & ~rst;
  f_lost <= clear || rst ? 4'd0 : f_lost + {3'd0, f_refused && f_lost != 4'd15};
  if (f_begun) lost_steps_counted : assert (lost == f_lost);
end

// --- While nothing waits, DIR goes where the line goes
reg [19:0] f_still = 20'd0;
always @(posedge clk) begin
  f_still <= f_pins_valid && !f_disturbed && f_waiting_count == 3'd0 && f_request == 2'b00 && !step_request && !f_active
             && f_direction[0] == direction && f_direction[1] == direction
             ? (f_still[19] ? f_still : f_still + 20'd1) : 20'd0;
  if (f_still > f_patience) dir_follows_the_line : assert (f_dir == f_direction[0]);
end

// --- EN is what the register says
always @(posedge clk)
  if (f_pins_valid) enable_follows : assert (enable_pin == ($past(enable) ^ $past(enable_inverted)));

`ifdef INVARIANTS
// --- What holds inside, for the induction
wire [15:0] f_elapsed = timer - 16'd1;  // clocks of the state, this one included
wire [17:0] f_timer = {2'd0, f_elapsed};
wire [17:0] f_level = step ? f_high : f_low;
wire f_step_shown = f_step == step;
wire f_dir_shown = f_dir == dir;
wire f_is_pulse = high | low;
wire f_is_hold = hold;
wire f_is_setup = setup;
wire f_is_ready = idle & ~hold;
wire f_dir_right = waiting[0] == dir;
wire [2:0] f_count = {2'd0, waits[0]} + {2'd0, waits[1]} + {2'd0, waits[2]} + {2'd0, waits[3]};
// clocks until the next active edge, or until DIR is right
wire [17:0] f_time = f_is_hold ? f_hold : f_is_setup ? f_setup : f_level;
wire [19:0] f_left = {2'd0, f_time} - {2'd0, f_timer} + 20'd1;
wire [19:0] f_turn_time = {2'd0, f_setup} + 20'd1;
wire [19:0] f_rank =
    f_is_pulse ? f_left + (step && !both_edges ? {2'd0, f_low} : 20'd0)
                 + (f_dir_right ? 20'd0 : {2'd0, f_hold} + f_turn_time) :
    f_is_hold  ? (f_dir_right ? 20'd0 : f_left + f_turn_time) :
    f_is_setup ? f_left + (f_dir_right ? 20'd0 : f_turn_time) :
                 (f_dir_right ? 20'd0 : f_turn_time);
always @(posedge clk)
  if (f_begun) begin
    assert (f_pins_valid || (f_is_ready && !step && !dir && waits == 4'd0 && f_waiting_count == 3'd0
                             && f_request == 2'b00 && f_written == 3'b000 && !f_step_q && !f_dir_q && !step_made && waiting == 4'd0
                             && !overrun && !f_refused && f_waited == 20'd0 && f_still == 20'd0));
    assert (waits == 4'b0000 || waits == 4'b0001 || waits == 4'b0011 || waits == 4'b0111 || waits == 4'b1111);
    assert (f_waiting_count <= 3'd4);
    if (!both_edges) assert (step == high);
    assert ({2'd0, high} + {2'd0, low} + {2'd0, setup} + {2'd0, idle} == 3'd1 && (idle || !hold));
    assert (!high || (step && !both_edges));
    if (!f_is_ready) begin
      assert (f_written[0] ? f_elapsed == 16'd0 : f_timer >= 18'd1 && f_timer <= f_time);
      assert ((f_is_pulse ? level_done : dir_done) == (f_timer == f_time));
    end
    // the time that would begin next
    if (f_pins_valid && !f_is_pulse) assert (level_done == ((step ? short_low : short_high) & ~f_written[0]));
    if (f_pins_valid && f_is_ready) assert (dir_done == (short_setup & ~f_written[0]));
    assert (waits_up == (waits[0] & ~waiting[0]) && waits_down == (waits[0] & waiting[0]));
    assert (overrun == f_refused);
`ifndef WRITTEN
    assert (f_pins_valid || (f_step_lasted_q == F_EVER && f_dir_lasted_q == F_EVER));
    if (!f_step_shown) begin
      assert (f_is_pulse && f_timer == 18'd1);
      assert (f_step_lasted >= (f_step ? f_high : f_low));
      if (!both_edges && f_step) assert (f_step_lasted == f_high);
    end else begin
      if (f_is_pulse) assert (f_step_lasted + 18'd1 == f_timer);
      if (f_is_hold) assert (f_step_lasted + 18'd1 == f_level + f_timer);
    end
    if (!f_is_pulse) assert (f_step_shown);
    if (f_is_ready || f_is_setup) assert (f_step_lasted >= f_level + f_hold);
    if (!f_is_setup) assert (f_dir_shown && f_dir_lasted >= f_setup);
    else if (!f_dir_shown) assert (f_timer == 18'd1);
    else assert (f_dir_lasted + 18'd1 == f_timer);
`else
    assert (f_pins_valid || (f_level_over_q && f_hold_over_q && f_setup_over_q));
    assert (f_high_q < 18'd16 && f_low_q < 18'd16 && f_setup_q < 18'd16 && f_hold_q < 18'd16);
    if (!f_written[0])
      assert (f_high_q == f_high && f_low_q == f_low && f_setup_q == f_setup && f_hold_q == f_hold || !f_pins_valid);
    if (!f_step_shown) assert (f_is_pulse && f_level_over && (f_written[0] || f_timer == 18'd1));
    else begin
      assert (f_level_over == !f_is_pulse);
      if (f_is_pulse && f_written[1:0] == 2'b00) assert (f_level_run + 18'd1 == f_timer);
      if (f_is_hold && f_written[1:0] == 2'b00) assert (f_hold_run + 18'd1 == f_timer);
      if (!f_is_pulse) assert (f_hold_over == !f_is_hold);
    end
    if (!f_is_setup) assert (f_dir_shown && f_setup_over);
    else if (!f_dir_shown) assert (f_written[0] || f_timer == 18'd1);
    else begin
      assert (!f_setup_over);
      if (f_written[1:0] == 2'b00) assert (f_setup_run + 18'd1 == f_timer);
    end
`endif
    if (f_pins_valid && $past(f_pins_valid)) begin
      assert (f_waiting_count == $past(f_count, 2));
      if (f_waiting_count > 3'd0) assert (f_waiting[0] == $past(waiting[0], 2));
      if (f_waiting_count > 3'd1) assert (f_waiting[1] == $past(waiting[1], 2));
      if (f_waiting_count > 3'd2) assert (f_waiting[2] == $past(waiting[2], 2));
      if (f_waiting_count > 3'd3) assert (f_waiting[3] == $past(waiting[3], 2));
      assert (f_active == $past(step_begins, 2));
      assert (f_full[1] == $past(full, 2));
      assert (f_request[1] == $past(step_request, 2) && f_drop[1] == $past(drop, 2));
      if (f_waiting_count == 3'd0 || f_written != 3'b000) assert (f_waited == 20'd0);
      if (f_waiting_count != 3'd0 && f_written[1:0] == 2'b00) assert (f_waited + $past(f_rank, 2) <= f_patience);
      if (f_written != 3'b000) assert (f_still == 20'd0);
      if (f_still > 20'd2) begin
        assert (f_waiting_count == 3'd0 && waits == 4'd0);
        assert ($past(waiting[0], 2) == f_direction[1]);
        assert (f_still[19] || f_dir == f_direction[1] || f_still + $past(f_rank, 2) <= f_patience);
        if (f_still[19]) assert (f_dir == f_direction[1]);
      end
    end else assert (f_waited == 20'd0 && f_still <= 20'd1);
  end
`endif
