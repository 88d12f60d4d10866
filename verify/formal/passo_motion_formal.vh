// SPDX-License-Identifier: MIT
// Promises of the motion states; included at the end of passo_motion.v.

// --- Assumptions: a reset at the beginning, then any inputs; requests of inputs have a cause
reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) motion_reset : assume (rst);
  motion_causes : assume (input_hard_cause != CAUSE_NONE && input_soft_cause != CAUSE_NONE);
end

wire f_too_far = following_hard & occupied;
wire f_abort = command_abort | estop | input_hard | f_too_far;
wire f_stop_hard = f_abort | ((moving | tracking) & step_overrun) | (moving & line_underrun);

// --- How long RUN has lasted
reg [3:0] f_run_age;
always @(posedge clk)
  f_run_age <= state != STATE_RUN ? 4'd0 : f_run_age == 4'd15 ? 4'd15 : f_run_age + 4'd1;

// --- How long nothing has counted or moved, up to 7 clocks; and whether that is since a stop or a reset
reg [2:0] f_uncounted;
reg [2:0] f_unmoved;
reg f_stilled;
reg [2:0] f_settle_age;
always @(posedge clk) begin
  f_uncounted  <= counting ? 3'd0 : f_uncounted == 3'd7 ? 3'd7 : f_uncounted + 3'd1;
  f_unmoved    <= moving ? 3'd0 : f_unmoved == 3'd7 ? 3'd7 : f_unmoved + 3'd1;
  f_stilled    <= rst | stopped | (f_stilled & ~counting);
  f_settle_age <= state != STATE_SETTLE ? 3'd0 : f_settle_age == 3'd7 ? 3'd7 : f_settle_age + 3'd1;
  if (rst) {f_uncounted, f_unmoved} <= 6'd0;
end

// --- After ABORT, or a hard request, steps may be requested until the clock after `stopped`, which ends the substeps in
// flight
reg f_aborted = 1'b0;  // and steps may still come
reg f_stopped_q = 1'b0;
reg [3:0] f_soft = 4'd0;  // cause of the last soft request of an input
wire f_abort_lasts = f_abort | (f_aborted & ~f_stopped_q);
always @(posedge clk) begin
  f_aborted   <= f_abort_lasts & ~rst;
  if (!stopping && !command_stop && input_soft) f_soft <= input_soft_cause;
  f_stopped_q <= stopped;
end

always @(posedge clk)
  if (f_begun) begin
    if (stopped)
      stopped_stands :
      assert (!moving && !counting && !prepare && !begin_profile && !drain && !release_line && !running);
    cause_when_stopped : assert ((cause != CAUSE_NONE) == stopped);
    counts_in_run_and_drain : assert (counting == (state == STATE_RUN || state == STATE_DRAIN));
    if (f_abort_lasts) drops_until_no_step_can_come : assert (drop);
    if (prepare) nothing_counts_before : assert (f_uncounted >= (f_stilled ? 3'd1 : 3'd5));
    if (release_line) settled_before_release : assert (f_uncounted >= 3'd4 && f_settle_age >= 3'd4);
    if (moving && f_unmoved != 3'd0) rests_before_it_moves : assert (f_unmoved >= 3'd3);
    if (begin_profile)
      begins_only_armed :
      assert (state == STATE_ARMED && $past(state == STATE_ARMED && may_begin && known && (f_synced || sync_edge || !wait_sync)));
  end

// --- A sync edge while it was ARMED, since the inputs are known
reg f_synced = 1'b0;
always @(posedge clk) f_synced <= state == STATE_ARMED && known && (f_synced || sync_edge) && !rst;

// --- From one clock to the next
always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if ($past(stopped)) stopped_until_clear : assert (stopped == !$past(command_clear));
    if ($past(stopped) && stopped) cause_stays : assert (cause == $past(cause));
    if ($past(input_soft) && !$past(stopped)) request_is_heard : assert (stopping || stopped);
    if ($past(command_stop) && !$past(stopped)) stop_is_heard : assert (stopping || stopped);
    if ($past(stopping)) stop_is_kept : assert (stopping || stopped);
    if (state != $past(state) && !stopped)
      case (state)
        STATE_IDLE:
        idle_comes_from :
        assert ($past(stopped && command_clear) || $past(state == STATE_SETTLE && release_line));
        STATE_PREPARE: prepare_comes_from : assert ($past(state == STATE_IDLE && prepare));
        STATE_ARMED: armed_comes_from : assert ($past(state == STATE_PREPARE && ramp_ready));
        STATE_RUN: run_comes_from : assert ($past(state == STATE_ARMED && begin_profile));
        STATE_SETTLE:
        settle_comes_from :
        assert ($past(begin_profile && ramp_ended) || $past(state == STATE_RUN && ramp_ended)
                || $past(state == STATE_DRAIN && line_ended));
        default:
        drain_comes_from : assert ($past(state == STATE_SETTLE) && $past(!line_ended && !line_endless, 2));
      endcase
    if ($past(state == STATE_ARMED && may_begin && known && (f_synced || sync_edge || !wait_sync) && !stop_due && !begin_profile))
      begins_when_it_may :
      assert (begin_profile);
    if ($past(begin_profile) && !$past(f_stop_hard, 2) && !$past(stopping, 2))
      begins_when_told : assert (state == STATE_RUN || state == STATE_SETTLE);
    if (drop) drops_only_after_abort : assert (f_abort || $past(f_abort) || $past(f_abort, 2));
    if ($past(hold || !known)) none_prepared_in_hold : assert (!prepare);
    if ($past(hold) && $past(hold && f_begun, 2) && !$past(occupied)) none_begins_in_hold : assert (!occupied);
    if (drain && !$past(drain)) drains_after_settling : assert (f_uncounted >= 3'd5);
    if (prepare) prepared_only_with_both : assert ($past(run && line_valid && ramp_valid && state == STATE_IDLE));
    if (release_line) released_at_the_end : assert ($past(line_ended || line_endless));
    drained_counts :
    assert (drained == $past(drained) + {14'd0, $past(drain && substep_made && !line_ended)});
    if ($past(stopped) && $past(state) == STATE_STOPPED) no_move_out_of_stopped : assert (!running);
    if (state == STATE_RUN && f_run_age < 4'd7 && !$past(running) && $past(state) == STATE_RUN)
      running_not_before_7 : assert (!running);
    if (state == STATE_RUN && f_run_age >= 4'd7) running_from_7_on : assert (running);
    if (!$past(moving)) not_running_at_rest : assert (!running);
    running_is_foretold : assert (running == $past(running_next));
  end

// --- From a fault to STOPPED: two clocks. A channel that was stopped in the clock between may be cleared already.
always @(posedge clk)
  if (f_begun && $past(f_begun) && $past(f_begun, 2)) begin
    if (!$past(stopped) && !$past(stopped, 2)) begin
      if ($past(f_abort, 2)) abort_stops : assert (stopped);
      if ($past(stopping, 2) && stopped) first_cause_stays : assert (cause == $past(soft_cause, 2));
      if ($past(estop && !stopping, 2)) estop_is_the_cause : assert (cause == CAUSE_ESTOP);
      if ($past(command_abort && !estop && !stopping, 2)) abort_is_the_cause : assert (cause == CAUSE_ABORT);
      if ($past(input_hard && !command_abort && !estop && !((moving || tracking) && step_overrun) && !stopping, 2))
        input_is_the_cause : assert (cause == $past(input_hard_cause, 2));
      if ($past(f_stop_hard, 2)) fault_stops : assert (stopped);
      if ($past((moving || tracking) && step_overrun && !command_abort && !estop && !stopping, 2))
        overrun_is_the_cause : assert (cause == CAUSE_STEP_OVERRUN);
      if ($past(moving && line_underrun && !step_overrun && !f_abort && !stopping, 2))
        underrun_is_the_cause : assert (cause == CAUSE_LINE_UNDERRUN);
      if ($past(f_too_far && !stopping && !estop && !command_abort && !input_hard && !((moving || tracking) && step_overrun), 2))
        too_far_is_the_cause : assert (cause == CAUSE_FOLLOWING_ERROR);
      if ($past(stopping && !tracking, 2) && ($past(!moving, 2) || ($past(rate_is_zero, 3) && $past(f_begun, 3))))
        stop_ends_in_stopped : assert (stopped);
    end
    if (stopped && !$past(stopped)) begin
      stopped_for_a_reason : assert ($past(f_stop_hard, 2) || $past(stopping, 2));
      if (!$past(f_stop_hard, 2))
        soft_cause_told :
        assert (cause == CAUSE_STOP || cause == CAUSE_RAMP_UNDERRUN || cause == CAUSE_FOLLOWING_ERROR || cause == f_soft);
    end
  end

wire [2:0] f_states = {2'd0, idle} + {2'd0, preparing} + {2'd0, armed} + {2'd0, runs} + {2'd0, settles}
                      + {2'd0, drains} + {2'd0, stopped};
always @(posedge clk)
  if (f_begun) begin
    assert (f_states == 3'd1);
    assert (synced == f_synced);
    assert (moving == (runs | settles | drains));
    assert (soft_cause == CAUSE_STOP || soft_cause == CAUSE_RAMP_UNDERRUN || soft_cause == CAUSE_FOLLOWING_ERROR || soft_cause == f_soft || !stopping);
    if (stopping) assert (soft_cause != CAUSE_NONE);
    if (stop_due && !stopped) assert (cause_due != CAUSE_NONE);
    assert (!stopping || !stopped);
    if (state == STATE_RUN) assert (f_run_age >= 4'd6 ? count == 3'd6 : {1'b0, count} == f_run_age);
    assert ((!settled || state == STATE_SETTLE) && (!finished || settled));
    if (settled && $past(f_begun)) assert (finished == $past(line_ended || line_endless));
    assert (!settled || $past(f_begun));
    if (startable) assert (state == STATE_IDLE);
    if (state == STATE_SETTLE) begin
      assert (settling == (f_settle_age == 3'd0 ? 3'b000 : f_settle_age == 3'd1 ? 3'b001 : f_settle_age == 3'd2 ? 3'b011 : 3'b111));
      assert (f_settle_age <= 3'd4 && settled == (f_settle_age == 3'd4) && f_uncounted >= f_settle_age);
    end
    if (!moving && !stopped && !f_stilled) assert (f_uncounted >= 3'd5);
    if (state == STATE_IDLE && startable) assert (f_unmoved >= 3'd1 && f_uncounted >= 3'd1);
    if (state == STATE_PREPARE) assert (f_unmoved >= 3'd2);
    if (state == STATE_ARMED) assert (f_unmoved >= 3'd3);
    if (f_stopped_q) assert (f_stilled);
    assert (f_aborted ? aborted != 2'b00 || f_stopped_q : 1'b1);
    if (f_aborted && !f_stopped_q) assert (stopped || (aborted[0] && stop_due));
    if (state == STATE_RUN && f_run_age == 4'd0) assert (!running);
  end
