// SPDX-License-Identifier: MIT
// Promises of the e-stop; included at the end of passo_estop.v.

reg f_started = 1'b0;
reg f_two = 1'b0;
reg f_three = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  f_two     <= f_started;
  f_three   <= f_two;
end

always @(posedge clk) begin
  if (!estop_n) pressed_asynchronously : assert (pressed);
  if (f_three && $past(pressed) && !pressed)
    only_cleared_when_released : assert ($past(clear || rst) && $past(estop_n) && $past(estop_n, 2) && $past(estop_n, 3));
  if (f_three && $past(clear || rst) && $past(estop_n) && $past(estop_n, 2) && $past(estop_n, 3) && estop_n)
    cleared : assert (!pressed);
  if (f_two && $past(pressed, 2)) stops_after_two : assert (stop);
  if (f_two && stop) stops_for_a_reason : assert ($past(pressed, 2));
end

always @(posedge clk)
  if (f_started) begin
    if (released[0]) assert ($past(estop_n));
    if (f_two && released[1]) assert ($past(estop_n, 2) && released[0]);
    if (!f_two) assert (!released[1]);
  end
