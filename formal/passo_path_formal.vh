// SPDX-License-Identifier: MIT
// What the path promises; included at the end of passo_path.

localparam [47:0] F_HALF = 48'h8000_0000_0000;

// --- Assumptions: velocities are at most 1/2; what is taken stands for two clocks; after a stop comes a restart
reg f_begun = 1'b0;
reg f_live = 1'b0;
always @(posedge clk) begin
  f_begun <= 1'b1;
  f_live  <= (f_live & ~stop) | rst | restart;
  assume (rst == !f_begun);
  assume (velocity_next <= F_HALF && drain_velocity <= 32'h8000_0000);
  if (f_begun && $past(take)) assume ($stable(velocity_next) && $stable(rest));
  if (f_begun && $past(drain)) assume ($stable(drain_velocity));
  if (rst || restart) assume (!stop && !advance && !take && !drain);
end

// --- Velocity and phase, each in one piece
reg  [47:0] f_velocity;
reg  [47:0] f_phase;
reg         f_carry = 1'b0;  // of the clock before
reg         f_carry_q = 1'b0;
wire [48:0] f_sum = {1'b0, f_phase} + {1'b0, f_velocity};
always @(posedge clk) begin
  if (take) f_velocity <= rest ? 48'd0 : velocity_next;
  if (drain) f_velocity <= {drain_velocity, 16'd0};
  if (advance) f_phase <= f_sum[47:0];
  f_carry   <= advance & f_sum[48];
  f_carry_q <= f_carry;
  if (rst || restart) begin
    f_velocity <= 48'd0;
    f_phase    <= {2'b01, 46'd0};
    f_carry    <= 1'b0;
    f_carry_q  <= 1'b0;
  end
end

always @(posedge clk)
  if (f_begun && f_live) begin
    substep_is_the_carry : assert (substep == f_carry_q);
    if ($past(f_begun && f_live)) never_two_in_a_row : assert (!substep || !$past(substep));
  end

`ifdef INVARIANTS
reg [23:0] f_velocity_high_q;
always @(posedge clk) f_velocity_high_q <= rst || restart ? 24'd0 : f_velocity[47:24];
wire [24:0] f_pending = {1'b0, velocity_high} + {24'd0, phase_low_carry};
always @(posedge clk)
  if (f_begun && f_live) begin
    assert (f_velocity <= F_HALF && f_velocity_high_q <= F_HALF >> 24);
    assert (velocity_low == f_velocity[23:0]);
    assert (velocity_high == f_velocity_high_q);
    if (!take_q && !drain_q) assert (f_velocity_high_q == f_velocity[47:24]);
    if (take_q && !drain_q) assert (f_velocity == (rest ? 48'd0 : velocity_next) || take || drain);
    if (drain_q) assert (f_velocity == {drain_velocity, 16'd0});
    assert (phase_low == f_phase[23:0]);
    if (!advance_q) assert (phase_high == f_phase[47:24] && !f_carry);
    else assert ({1'b0, phase_high} + f_pending == {f_carry, f_phase[47:24]});
    assert (!f_carry || f_phase < F_HALF);
    assert (!(f_carry && f_carry_q));
  end
`endif
