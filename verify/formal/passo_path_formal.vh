// SPDX-License-Identifier: MIT
// Promises of the path; included at the end of passo_path.v.

localparam [47:0] F_HALF = 48'h8000_0000_0000;

// --- Assumptions: velocities are at most 1/2; a velocity that is taken is stable for two clocks; no clock counts
// before the first restart, after a stop, when a drain has just ended, or in the clock of a restart. The drain
// velocity may be written at any time: its upper 24 bits change one clock after the lower ones.
reg  f_started = 1'b0;
wire f_begun = ~rst;
reg  f_live = 1'b0;
reg  f_known = 1'b0;  // a velocity was taken since reset
reg  f_drain_q = 1'b0;
reg  f_refresh = 1'b0;
wire f_take = begin_profile | tick | f_refresh;
(* anyseq *) wire [31:0] f_drain_velocity;  // as it was written
reg  [31:0] f_drain_velocity_q;
always @(posedge clk) begin
  f_started <= 1'b1;
  f_known   <= (f_known | f_take) & ~rst;
  f_live    <= (f_live | (restart & f_known)) & ~stop & ~rst;
  f_drain_q <= drain & ~rst;
  f_refresh <= rst | stop | drain;
  f_drain_velocity_q <= f_drain_velocity;
  if (!f_started) path_reset : assume (rst);
  path_velocity : assume (velocity_next <= F_HALF);
  path_drain_velocity :
  assume (f_drain_velocity <= 32'h8000_0000 && (f_started || f_drain_velocity_q <= 32'h8000_0000));
  path_drain_halves : assume (!f_live || drain_velocity == {f_drain_velocity_q[31:8], f_drain_velocity[7:0]});
  if ($past(f_take && f_begun) && f_started)
    path_taken_stands : assume ($stable(rest) && (rest || drain || $stable(velocity_next)));
  if (!f_live || stop || restart || (f_drain_q && !drain)) path_counts_in_motion : assume (!advance);
  if (!f_live || restart) path_begins_in_motion : assume (!begin_profile && !drain);
  if (!advance) path_ticks_when_counting : assume (!tick);
  if ($past(f_take && f_begun) && f_started && !f_drain_q)
    path_drains_after_settling : assume (!drain);
end

// --- Velocity and phase, not split into halves
reg  [47:0] f_velocity;
reg  [47:0] f_phase;
reg         f_carry = 1'b0;  // of the clock before
reg         f_carry_q = 1'b0;
wire [48:0] f_sum = {1'b0, f_phase} + {1'b0, f_velocity};
always @(posedge clk) begin
  if (f_take) f_velocity <= drain ? {f_drain_velocity, 16'd0} : rest ? 48'd0 : velocity_next;
  if (advance) f_phase <= f_sum[47:0];
  f_carry   <= advance & f_sum[48];
  f_carry_q <= f_carry;
  if (rst || restart) begin
    f_phase   <= {2'b01, 46'd0};
    f_carry   <= 1'b0;
    f_carry_q <= 1'b0;
  end
end

always @(posedge clk)
  if (f_begun && f_live) begin
    substep_is_the_carry : assert (substep == f_carry_q);
    if ($past(f_begun && f_live)) never_two_in_a_row : assert (!substep || !$past(substep));
  end

wire [24:0] f_pending = {1'b0, velocity_high} + {24'd0, phase_low_carry};
always @(posedge clk)
  if (f_begun) begin
    assert (refresh == f_refresh);
    assert (!f_live || f_known);
    if (f_known) assert (f_velocity <= F_HALF && velocity_low == f_velocity[23:0]);
    if (f_known && !take_q) assert (velocity_high == f_velocity[47:24]);
    if (f_live) begin
      assert (f_pending <= F_HALF >> 24);
      assert (phase_low == f_phase[23:0]);
      if (!advance_q) assert (phase_high == f_phase[47:24] && !f_carry);
      else assert ({1'b0, phase_high} + f_pending == {f_carry, f_phase[47:24]});
      assert (!f_carry || f_phase < F_HALF);
      assert (!(f_carry && f_carry_q));
    end
  end
