// SPDX-License-Identifier: MIT
// Promises of the ramp; included at the end of passo_ramp.v.

// --- Assumptions: motion and timescale
localparam [1:0] F_REST = 2'd0;
localparam [1:0] F_PREPARED = 2'd1;  // the first velocity is being computed, or ready
localparam [1:0] F_RUNS = 2'd2;
reg       f_started = 1'b0;
wire      f_begun = ~rst;
reg [1:0] f_motion;
reg       f_stop_q;
reg       f_ready_q;
reg       f_loaded_q;
always @(posedge clk) begin
  f_started  <= 1'b1;
  f_stop_q   <= rst | stop;
  f_ready_q  <= ready;
  f_loaded_q <= loaded;
  if (prepare) f_motion <= F_PREPARED;
  if (begin_profile) f_motion <= F_RUNS;
  if (ended || rst || stop) f_motion <= F_REST;
  if (!f_started) ramp_reset : assume (rst);
  if (stop && !rst) ramp_stopped_stands : assume (!prepare && !begin_profile && !drain && !advance);
  if (prepare && !rst) ramp_prepared_at_rest : assume (f_motion == F_REST && !f_stop_q && !drain);
  if (begin_profile && !rst) ramp_begins_when_ready : assume (f_motion == F_PREPARED && f_ready_q);
  if (drain && !rst) ramp_drains_at_rest : assume (f_motion == F_REST);
  if (advance && !rst) ramp_counts_in_motion : assume (!stall && (f_motion == F_RUNS || drain));
  ramp_ticks : assume (tick == (advance & tick_ends));
end

// --- Assumption: the tables answer after the request
always @(posedge clk)
  if (table_served) ramp_served_later : assume (rst || $past(table_request && !rst));

// --- Assumptions: the ramp queue, as its proof promises. Only the oldest ramp is visible.
reg         f_there;
reg         f_valid;
reg         f_now;  // a NOW ramp waits ...
reg         f_oldest_now;  // ... and is the oldest
reg  [15:0] f_control;
reg  [47:0] f_end;
reg  [31:0] f_ticks;
reg  [15:0] f_word;
reg  [15:0] f_next;
reg  [15:0] f_half;  // three clocks after its index
(* anyseq *) reg f_arrives;
(* anyseq *) reg f_arrives_now;
(* anyseq *) reg f_more;  // behind the oldest ramp there is another one
(* anyseq *) reg f_more_now;  // which is the NOW ramp
(* anyseq *) reg [95:0] f_another;
(* anyseq *) reg [15:0] f_any_half;
wire f_take = ramp_take & ~stop;
wire f_take_now = ramp_take_now & ~stop;
wire f_new_now = f_arrives & f_arrives_now;
always @(posedge clk) begin
  if (!f_there || f_take || f_take_now) {f_control, f_end, f_ticks} <= f_another;
  f_there <= (f_take ? f_more : f_there) | f_arrives;
  f_valid <= f_there;
  f_now   <= (f_now & ~f_take_now) | f_new_now;
  if (f_new_now) f_oldest_now <= (!f_there && !f_take_now) || (f_take && !f_more);
  else if (f_take) f_oldest_now <= f_now & f_more_now;
  else if (f_take_now) f_oldest_now <= 1'b0;
  if (f_take && f_now) ramp_now_waits_behind : assume (f_more);
  if (f_take_now) f_there <= 1'b1;
  if (rst || stop) {f_there, f_now} <= 2'b00;
  if (rst) f_valid <= 1'b0;
  case (ramp_half_index)
    4'd0:    f_word <= f_end[47:32];
    4'd1:    f_word <= f_control;
    4'd2:    f_word <= f_end[31:16];
    4'd3:    f_word <= f_end[15:0];
    4'd4:    f_word <= ~f_ticks[31:16];
    4'd5:    f_word <= ~f_ticks[15:0];
    default: f_word <= f_any_half;
  endcase
  ramp_queue_valid : assume (ramp_valid == f_valid);
  ramp_queue_now : assume (ramp_now_pending == f_now);
  f_next <= f_word;
  f_half <= f_next;
  ramp_queue_half : assume (ramp_half == f_half);
end

always @(posedge clk)
  if (f_begun) begin
    if (ramp_take) takes_what_is_there : assert (f_there && !ramp_take_now && !(f_now && f_oldest_now));
    if (ramp_take_now) takes_now_when_told : assert (f_now);
  end

// --- Ticks: velocities computed from the oldest ramp
reg  [31:0] f_made;
reg  [ 3:0] f_over_for;  // clocks since the last of them was ready, from 1
wire        f_makes = ready & ~f_ready_q & ~ends_next;  // a velocity becomes ready
wire [31:0] f_made_now = f_made + {31'd0, f_makes & f_loaded_q};
wire        f_all_made = f_makes && f_loaded_q && f_made_now == f_ticks;
always @(posedge clk) begin
  f_made     <= f_made_now;
  f_over_for <= f_all_made || (f_over_for != 4'd0 && f_over_for != 4'd15) ? f_over_for + 4'd1 : f_over_for;
  if (f_take || f_take_now || rst || stop) begin
    f_made     <= 32'd0;
    f_over_for <= 4'd0;
  end
  if (f_begun) begin
    if (f_take) ticks_exact : assert (f_made_now == f_ticks);
    if (f_there && f_motion != F_REST) never_more_ticks : assert (f_made_now <= f_ticks);
    leaves_when_over : assert (f_over_for < 4'd8);
  end
end

// --- Velocities: where the ramps are, and the present one
reg  [47:0] f_start;  // v_end of the ramp that left last
reg  [47:0] f_present;
wire        f_takes = begin_profile | tick;  // what is ready takes effect in the next clock
reg         f_without;  // the ready velocity was computed without a ramp
reg  [ 5:0] f_bit;
(* keep *) wire f_a_bit;
(* keep *) wire f_b_bit;
wire        f_takes_end = loaded & mirror;
always @(posedge clk) begin
  if (f_take_now) f_start <= f_present;
  if (f_take) f_start <= f_end;
  if (f_takes) f_present <= velocity_next;
  if (prepare) begin
    f_start   <= 48'd0;
    f_present <= 48'd0;
  end
  if (f_makes) f_without <= !f_loaded_q;
  f_bit <= moving && !shaping ? f_bit + 6'd1 : 6'd0;
  if (f_begun && f_motion != F_REST) begin
    if (ready && f_ready_q && !ends_next && f_without) stays_at_the_end : assert (velocity_next == f_start);
    if (stage == STAGE_SCALE && moving && !shaping && f_bit < 6'd48) begin
      first_is_the_start : assert (f_a_bit == (loaded && f_control[2] ? f_end[f_bit] : f_start[f_bit]));
      second_is_the_end : assert (f_b_bit == (loaded && !f_control[2] ? f_end[f_bit] : f_start[f_bit]));
    end
    dry_told : assert (dry == (f_makes && !f_loaded_q && f_start != 48'd0));
  end
end

// --- The tick, its end, the end of the profile
localparam [TICK_LOG2:0] F_TICK_LAST = (1 << TICK_LOG2) - 1;
reg [TICK_LOG2:0] f_clocks;  // enabled clocks of the tick
reg               f_due;  // a velocity is ready and has not taken effect
reg               f_last;  // the LAST ramp has left
reg         [6:0] f_busy;
wire              f_running = f_motion == F_RUNS;
always @(posedge clk) begin
  if (advance) f_clocks <= f_clocks + 1'b1;
  if (f_takes) f_clocks <= 0;
  f_due <= (f_due | f_makes) & ~f_takes;
  if (f_take) f_last <= f_control[0];
  if (prepare || f_take_now || ended || rst || stop) f_last <= 1'b0;
  if (prepare || rst || stop) f_due <= 1'b0;
  f_busy <= rst || prepare || f_motion == F_REST || ready || f_take || f_take_now ? 7'd0 :
            f_busy + {6'd0, stage != STAGE_LOOK_UP && !(f_last && ramp_now_coming)};
  if (f_begun && f_motion != F_REST) begin
    if (f_running && advance) tick_is_whole : assert ((f_clocks == F_TICK_LAST) == f_takes);
    if (f_running && stall) stalls_only_there : assert (f_clocks == F_TICK_LAST && !f_ready_q);
    if (f_takes) only_ready_is_taken : assert (ready && f_ready_q);
    if (ended) ended_after_last : assert (f_takes && f_last && !f_due);
    if (f_takes && f_last && !f_due) last_is_told : assert (ended);
    if (f_last && ready && !f_ready_q) nothing_after_last : assert (ends_next);
    if ($past(ready && !f_takes && !stop)) ready_is_kept : assert (ready);
    if ($past(ready) && $past(f_ready_q)) taken_stands : assert ($stable(velocity_next) && $stable(ends_next));
    ready_in_time : assert (f_busy <= 7'd105);
  end
  ticks_only_when_it_counts : assert (!f_begun || f_motion == F_REST || !(stall && tick_ends));
  if (f_begun && f_motion == F_REST && !f_stop_q) no_next_tick_at_rest : assert (ends_next);
  if (f_begun && f_motion == F_REST && !drain) not_ended_at_rest : assert (!ended);
  if (f_begun && f_motion != F_REST && $past(f_motion != F_REST && ramp_now_coming && !prepare))
    now_is_waited_for : assert (!ends_next || $past(ends_next));
end

// --- The interpolation is used as its own proof assumes: for the points of a table, or not, then for the velocities
localparam [1:0] F_UNUSED = 2'd0;
localparam [1:0] F_LOADED = 2'd1;
localparam [1:0] F_SHAPE = 2'd2;
localparam [1:0] F_SCALE = 2'd3;
reg  [ 1:0] f_use_q;  // the next use, unless one begins or is abandoned
reg  [ 5:0] f_use_clock_q;
reg  [ 1:0] f_unused_for;  // clocks, up to 3
reg         f_shaped;
reg  [32:0] f_progress;
wire        f_scales = f_use_q == F_UNUSED && moving;  // begins to
wire [ 1:0] f_use = f_scales ? F_SCALE : f_use_q[1] && !moving ? F_UNUSED : f_use_q;
wire [ 5:0] f_use_clock = f_scales ? 6'd1 : f_use_clock_q;
wire        f_scale_begins = f_use == F_SCALE && f_use_clock == 6'd1;
wire        f_loads = stage == STAGE_LOOK_UP && table_served;
always @(posedge clk) begin
  f_use_clock_q <= f_use_clock + 6'd1;
  f_unused_for  <= f_use != F_UNUSED ? 2'd0 : f_unused_for == 2'd3 ? 2'd3 : f_unused_for + 2'd1;
  f_progress    <= progress;
  case (f_use)
    F_UNUSED: f_use_q <= f_loads ? F_LOADED : F_UNUSED;
    F_LOADED: begin
      f_use_q       <= F_SHAPE;
      f_use_clock_q <= 6'd1;
    end
    F_SHAPE:
    if (f_use_clock == 6'd19) begin
      f_use_q       <= F_SCALE;
      f_use_clock_q <= 6'd1;
    end else f_use_q <= F_SHAPE;
    default: f_use_q <= f_use_clock == 6'd50 ? F_UNUSED : F_SCALE;
  endcase
  if (f_use == F_UNUSED) f_shaped <= 1'b0;
  if (f_use == F_SHAPE) f_shaped <= 1'b1;
  if (f_begun && f_motion != F_REST && !f_stop_q) begin
    if (f_scales) used_after_rest : assert (f_unused_for == 2'd3 && !shaping);
    moves_when_used : assert (moving == f_use[1] && shaping == (f_use == F_SHAPE));
    fraction_is_loaded_first : assert (load_fraction == f_scale_begins);
    if (f_use != F_UNUSED) cleared_first : assert (clear == f_scale_begins && result_move == moving);
    if (f_loads) points_after_rest : assert (f_use == F_UNUSED && f_unused_for == 2'd3 && clear && result_move);
    if (f_use == F_LOADED || f_use == F_SHAPE || (f_scale_begins && f_shaped))
      progress_stands : assert (progress == f_progress);
    if (f_scale_begins) linear_or_shaped : assert ((shape == SHAPE_LINEAR) == !f_shaped || !loaded);
  end
end

// --- Invariants, for the induction
(* keep *) wire [47:0] f_v_start;
(* keep *) wire [TICK_LOG2-1:0] f_tick_count;
(* keep *) wire f_tick_last;
(* keep *) wire f_is_last;
(* keep *) wire [15:0] f_ticks_high;
(* keep *) wire [15:0] f_ticks_low;
(* keep *) wire f_b;
(* keep *) wire f_both;
(* keep *) wire [24:0] f_addend;
wire f_is_choose = stage == STAGE_CHOOSE;
wire f_is_copy = stage == STAGE_COPY;
wire f_is_fetch = stage == STAGE_FETCH;
wire f_is_take = stage == STAGE_TAKE;
wire f_is_look_up = stage == STAGE_LOOK_UP;
wire f_is_shape = stage == STAGE_SHAPE;
wire f_is_scale = stage == STAGE_SCALE;
wire f_is_advance = stage == STAGE_ADVANCE;
wire [32:0] f_counted = {over, f_ticks_high, f_ticks_low} - {1'b0, ~f_ticks};  // how often 1 was added
wire [5:0] f_last_count = f_is_copy ? 6'd24 : f_is_take ? 6'd5 : f_is_shape ? 6'd19 : f_is_scale ? 6'd50 : 6'd8;
integer k;
always @(posedge clk)
  if (f_begun) begin
    // stages
    if (f_is_copy) assert (count >= 6'd1 && count <= 6'd24);
    if (f_is_fetch || f_is_advance) assert (count >= 6'd1 && count <= 6'd8);
    if (f_is_take) assert (count >= 6'd1 && count <= 6'd5);
    if (f_is_look_up) assert (count == 6'd1);
    if (f_is_shape) assert (count >= 6'd1 && count <= 6'd19);
    if (f_is_scale) assert (count >= 6'd1 && count <= 6'd50);
    if (!f_is_choose && !f_is_look_up) assert (stage_ends == (count == f_last_count));
    if (f_motion == F_REST) assert (f_is_choose && !ready && ends_next || f_stop_q && !$past(f_begun));
    if (f_motion == F_REST && !f_stop_q) assert (!moving);
    assert (f_motion <= F_RUNS);
    if (f_motion == F_REST) assert (f_made_now == 32'd0 && f_over_for == 4'd0 && !f_last);
    if (f_now) assert (f_there);
  end
always @(posedge clk)
  if (f_begun && f_motion != F_REST) begin
    if (ready) assert (f_is_choose || ((f_is_take || f_is_advance) && !ends_next));
    if (ready && f_ready_q) assert (!result_move);
    if (ends_next) assert (ready && f_is_choose && !loaded && f_is_last);
    assert (f_due == (ready && f_ready_q && !ends_next));
    assert (stall == (f_tick_last & ~tick_ends) && (f_tick_last || !tick_ends));
    assert (!f_tick_last || stall == !f_ready_q || $past(f_motion == F_REST));
    if (f_running) assert (f_clocks == {1'b0, f_tick_count} && f_tick_last == (f_tick_count == F_TICK_LAST[TICK_LOG2-1:0]));
    assert (ramp_take == (f_is_take && count == 6'd4));
    if (ramp_take_now) assert (f_is_copy && count == 6'd1 && f_now);
    // the ramp being made
    if (loaded) assert (f_there || (f_is_take && count >= 6'd5));
    if (loaded && !f_is_take)
      assert (f_there && mirror == f_control[2] && shape == f_control[5:4] && f_is_last == f_control[0]);
    if (loaded) assert (!f_is_copy && !f_is_fetch);
    if (f_is_copy) assert (!f_is_last);
    if (loaded && !f_is_take || f_is_take && count <= 6'd4 || f_is_scale) assert (!f_last);
    if (f_is_look_up || f_is_shape || f_is_advance) assert (loaded);
    if (!loaded && !ramp_take_now && !f_is_take && !f_is_fetch) assert (f_is_last == f_last);
    if (!loaded && !ramp_take_now && !f_is_take) assert (f_made_now == 32'd0);
    if (f_is_fetch) assert (f_there && !f_last && (count >= 6'd7 || !f_is_last));
    if (f_is_fetch && count >= 6'd7)
      assert (mirror == f_control[2] && shape == f_control[5:4] && f_is_last == f_control[0]);
    if (f_is_scale && !loaded) assert (!f_is_last);
    if (f_is_take) assert (f_is_last == (count <= 6'd4 ? f_control[0] : f_last));
    if (f_is_take && count <= 6'd4) assert (f_there && f_made_now == f_ticks);
    assert (f_over_for == 4'd0 || (f_is_take && count <= 6'd4 && f_over_for == count - 6'd1));
    if (f_is_take && count >= 6'd5) assert (f_made_now == 32'd0);
    // clocks since progress was made
    if (!ready || f_ready_q)
    case (stage)
      STAGE_CHOOSE:  assert (f_busy <= (loaded ? 7'd33 : 7'd24));
      STAGE_COPY:    assert (f_busy <= (count == 6'd1 ? 7'd34 : count - 7'd1));
      STAGE_FETCH:   assert (f_busy <= 7'd24 + count);
      STAGE_TAKE:    assert (f_busy <= (count <= 6'd4 ? 7'd32 + count : count - 7'd5));
      STAGE_LOOK_UP: assert (f_busy <= 7'd34);
      STAGE_SHAPE:   assert (f_busy <= 7'd34 + count);
      STAGE_SCALE:   assert (f_busy <= 7'd53 + count);
      default:      assert (f_busy <= {1'b0, count});
    endcase
    // NOW ramps
    if ((loaded && !f_is_take) || f_is_fetch || (f_is_take && count <= 6'd4)) assert (!(f_now && f_oldest_now));
    // ticks
    if (loaded && (f_is_choose || f_is_look_up || f_is_shape || f_is_advance || (f_is_scale && count <= 6'd2)))
      assert (f_counted == {1'b0, f_made_now} + 33'd1 && !over && f_made_now < f_ticks);
    if (loaded && f_is_scale) assert (f_made_now < f_ticks);
    if (loaded && f_is_scale && count >= 6'd4) assert (f_counted == {1'b0, f_made_now} + 33'd2);
    if (f_is_fetch && count == 6'd1) assert (ramp_half_index == 4'd5);
    if (f_is_fetch && count == 6'd2) assert (f_word == ~f_ticks[15:0] && ramp_half_index == 4'd4);
    if (f_is_fetch && count == 6'd3)
      assert (f_next == ~f_ticks[15:0] && f_word == ~f_ticks[31:16] && ramp_half_index == 4'd1);
    if (f_is_fetch && count == 6'd4)
      assert (f_half == ~f_ticks[15:0] && f_next == ~f_ticks[31:16] && f_word == f_control);
    if (f_is_fetch && count == 6'd5)
      assert (f_ticks_low == ~f_ticks[15:0] && f_half == ~f_ticks[31:16] && f_next == f_control);
    if (f_is_fetch && count == 6'd6) assert (f_half == f_control);
    if (f_is_fetch && count >= 6'd7) assert (f_counted == 33'd1);
    if (f_is_fetch && count == 6'd8) assert (!over);
  end

// the use of the interpolation
wire f_shapes = loaded && shape != SHAPE_LINEAR;
always @(posedge clk)
  if (f_begun && f_motion != F_REST) begin
    if (f_is_shape) begin
      assert (f_use == (count == 6'd1 ? F_LOADED : F_SHAPE) && (count == 6'd1 || f_use_clock == count - 6'd1));
      assert (moving == (count != 6'd1) && shaping == moving && f_shapes && !clear && !load_fraction && result_move == moving);
    end else if (f_is_scale) begin
      if (count == 6'd1) assert (f_shapes ? f_use == F_SHAPE && f_use_clock == 6'd19 && shaping && moving && !clear && result_move : f_use == F_UNUSED && f_unused_for >= 2'd2);
      else assert (f_use == F_SCALE && f_use_clock == count - 6'd1 && moving && !shaping && f_shaped == f_shapes && result_move);
      if (count == 6'd1) assert (!load_fraction);
      if (count >= 6'd2) assert (load_fraction == (count == 6'd2) && clear == load_fraction);
    end else if (f_use != F_UNUSED) assert (f_use == F_SCALE && f_use_clock == 6'd50 && moving && !shaping && !load_fraction && !clear && result_move && count == 6'd1 && !f_is_look_up);
    else assert (!moving && !load_fraction);
    if (f_is_look_up) assert (f_use == F_UNUSED && f_unused_for >= 2'd2 && f_shapes);
    if (f_is_choose && !ready && !ends_next) assert (f_use == F_UNUSED && f_unused_for >= 2'd1);
    if (f_is_copy || f_is_fetch) assert (f_use == F_UNUSED && (f_unused_for >= 2'd1));
  end

// the half-word of v_end that SCALE selects in each clock; before the first one (counts wrap) the lowest
function [15:0] f_end_half(input [5:0] clocks);
  f_end_half = clocks <= 6'd13 || clocks > 6'd45 ? f_end[15:0] : clocks <= 6'd29 ? f_end[31:16] : f_end[47:32];
endfunction

// the numbers as they rotate
always @(posedge clk)
  if (f_begun && f_motion != F_REST) begin
    if ((f_is_choose && !start_copy) || f_is_fetch || f_is_look_up || f_is_shape || f_is_advance) assert (f_v_start == f_start);
    if (f_is_take) begin
      if (count == 6'd1) assert (f_word == f_end[15:0] && ramp_half_index == 4'd2);
      if (count == 6'd2) assert (f_next == f_end[15:0] && f_word == f_end[31:16] && ramp_half_index == 4'd0);
      if (count <= 6'd3) assert (f_v_start == f_start);
      if (count == 6'd3) assert (f_half == f_end[15:0] && f_next == f_end[31:16] && f_word == f_end[47:32]);
      if (count == 6'd4)
        assert (f_v_start[47:32] == f_end[15:0] && f_half == f_end[31:16] && f_next == f_end[47:32]);
      if (count == 6'd5) assert (f_v_start[47:16] == f_start[31:0] && f_half == f_start[47:32]);
    end
    if ((f_is_fetch || f_is_advance) && count >= 6'd7) assert (ramp_half_index == 4'd3);
    if ((f_is_fetch || f_is_advance) && count == 6'd8) assert (f_word == f_end[15:0]);
    if (loaded && (f_is_choose || f_is_look_up || f_is_shape))
      assert (ramp_half_index == 4'd3 && f_word == f_end[15:0] && f_next == f_end[15:0]);
    if (loaded && (f_is_look_up || f_is_shape)) assert (f_half == f_end[15:0]);
    if (loaded && f_is_scale) begin
      assert (ramp_half_index == (count <= 6'd13 ? 4'd3 : count <= 6'd29 ? 4'd2 : count <= 6'd45 ? 4'd0 : 4'd3));
      assert (f_word == f_end_half(count - 6'd1));
      assert (f_next == f_end_half(count - 6'd2));
      assert (f_half == f_end_half(count - 6'd3));
    end
    if (f_is_scale) begin
      for (k = 0; k <= 48; k = k + 1)
        if (count == k + 2 || (k == 0 && count == 6'd1)) assert (f_v_start == ((f_start >> k) | (f_start << (48 - k))));
      if (count >= 6'd2) assert (moving && !shaping);
      assert (f_bit == (count >= 6'd2 ? count - 6'd2 : 6'd0));
    end
    if (f_is_choose && !ready) assert (!moving && !velocity_bit && !f_b);
    // the present velocity rotates once while v_start copies it, in two halves
    if (f_is_copy || (f_is_choose && start_copy)) begin
      assert (!loaded && !ready);
      if (count >= 6'd2) assert (!moving && !velocity_bit && !f_b && f_addend == 25'd0 && !f_both);
      if (count == 6'd1) assert (ramp_take_now ? velocity_next == f_present : clear && result_move && f_start == 48'd0);
      for (k = 0; k <= 23; k = k + 1)
        if (count == k + 2) begin
          assert (f_start == f_present);
          assert (velocity_next[47:24] == (f_start[47:24] >> k | f_start[47:24] << (24 - k)));
          assert (velocity_next[23:0] == (f_start[23:0] >> k | f_start[23:0] << (24 - k)));
          assert ((f_v_start[47:24] ^ (f_start[47:24] << (24 - k))) >> (24 - k) == 24'd0);
          assert ((f_v_start[23:0] ^ (f_start[23:0] << (24 - k))) >> (24 - k) == 24'd0);
        end
    end
    if (!ready && ((f_is_choose && !start_copy) || f_is_fetch || f_is_take || f_is_advance))
      assert (velocity_next == f_present && !result_move);
    // without a ramp the bits of v_start become the velocity
    if (f_is_scale && !loaded) begin
      if (count == 6'd1) assert (!moving && !velocity_bit && !f_b);
      if (count == 6'd2) assert (!velocity_bit && !f_b && clear && result_move);
      if (count >= 6'd3) assert (velocity_bit == f_start[count - 3] && f_b == velocity_bit && f_addend == 25'd0 && result_move);
      if (count == 6'd3) assert (!f_both && velocity_next == 48'd0);
      if (count >= 6'd4) assert (f_both == f_start[count - 4]);
      for (k = 0; k <= 46; k = k + 1)
        if (count == k + 4) assert (velocity_next == f_start << (48 - k));
    end
    if (ready && f_ready_q && !ends_next && f_without) assert (f_is_choose && !loaded);
    if (f_makes && !f_loaded_q) assert (f_is_choose && !loaded && velocity_next == f_start << 1 && f_both == f_start[47] && f_addend == 25'd0 && result_move);
    if (f_is_scale && !loaded && count >= 6'd3)
      assert (not_zero == ((f_start & ((48'd1 << (count - 3)) - 48'd1)) != 48'd0));
    if (f_is_scale && count == 6'd2 && !loaded) assert (!not_zero);
    if (f_is_scale && count == 6'd1) assert (!not_zero);
  end
