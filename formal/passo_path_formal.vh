// SPDX-License-Identifier: MIT
// What the path promises; included at the end of passo_path.

// --- Assumptions: the velocity is at most 1/2
reg f_begun = 1'b0;
always @(posedge clk) begin
  f_begun <= 1'b1;
  assume (rst == !f_begun);
  assume (velocity <= 48'h8000_0000_0000);
end

// --- The same sum in one piece
reg  [47:0] f_phase;
reg         f_carry = 1'b0;  // of the clock before
reg         f_carry_q = 1'b0;
wire [48:0] f_sum = {1'b0, f_phase} + {1'b0, velocity};
always @(posedge clk) begin
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
  if (f_begun) begin
    substep_is_the_carry : assert (substep == f_carry_q);
    if ($past(f_begun)) never_two_in_a_row : assert (!substep || !$past(substep));
  end

`ifdef INVARIANTS
wire [24:0] f_pending = {1'b0, velocity_high_q} + {24'd0, phase_low_carry};
always @(posedge clk)
  if (f_begun) begin
    assert (phase_low == f_phase[23:0]);
    assert (velocity_high_q <= 24'h800000 || !advance_q);
    if (!advance_q) assert (phase_high == f_phase[47:24] && !f_carry);
    else assert ({1'b0, phase_high} + f_pending == {f_carry, f_phase[47:24]});
    assert (!f_carry || f_phase < 48'h8000_0000_0000);
    assert (!(f_carry && f_carry_q));
  end
`endif
