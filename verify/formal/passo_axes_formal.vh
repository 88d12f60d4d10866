// SPDX-License-Identifier: MIT
// Promises of the axes of a channel together; included at the end of passo_axes.v. Each axis may do anything.

reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) axes_reset : assume (rst);
end

reg [AXES-1:0] f_lost;
integer f_n;
always @* for (f_n = 0; f_n < AXES; f_n = f_n + 1) f_lost[f_n] = lost[f_n*4+:4] != 4'd0;

always @* begin
  quiet_with_all : assert (quiet == &axis_quiet);
  lost_is_told : assert (lost_steps == f_lost);
  if (!answers_position) lost_is_read : assert (read_data == {28'd0, lost_read});
  if (lost_read == 4'd0 && answers_position) position_is_read : assert (read_data == position);
end

always @(posedge clk)
  if (f_started) lost_is_an_overrun : assert (step_overrun == $past(!rst && |(step_request & full)));
