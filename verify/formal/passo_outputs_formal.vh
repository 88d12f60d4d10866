// SPDX-License-Identifier: MIT
// Promises of the outputs of a channel; included at the end of passo_outputs.v. Only the PWM is what it is: raster,
// changes, power and compare do anything.

// --- Assumptions: of the motion, and the step of the PWM
reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) outputs_reset : assume (rst);
  if (f_started) outputs_running : assume (running == $past(running_next && !rst));
end

// --- Clocks since something moved; a line with power since the motion began
reg [2:0] f_still = 3'd0;
reg       f_lit = 1'b0;
reg       f_lost = 1'b0;
always @(posedge clk) begin
  f_still <= velocity != 32'd0 && rate != 17'd0 && !waits || rst ? 3'd0 : f_still == 3'd7 ? 3'd7 : f_still + 3'd1;
  f_lit   <= ~rst & running & (f_lit | hit);
  f_lost  <= ~rst & ~clear & (f_lost | lost);
end

always @(posedge clk)
  if (f_started && !$past(rst)) begin
    if (!running) no_power_without_motion : assert (!power);
    if (f_still == 3'd7) no_power_at_rest : assert (!power);
    if (running && !f_lit) no_power_before_a_line : assert (!power);
    if ($past(f_lost)) no_power_after_a_loss : assert (!power);
    if (outputs != $past(outputs)) levels_change_when_told : assert ($past(hit || write_levels, 2) || $past(rst, 2));
  end

integer n;
always @(posedge clk)
  if (f_started && !$past(rst)) begin
    assert (overflow == f_lost);
    if (lit) assert (f_lit);
    for (n = 1; n < 7; n = n + 1) if (f_still >= n) assert (still[n]);
  end
