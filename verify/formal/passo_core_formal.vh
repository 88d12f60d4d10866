// SPDX-License-Identifier: MIT
// Promises of the core outside its blocks; included at the end of passo_core.v. The blocks may do anything.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) core_reset : assume (rst);
end

always @(posedge clk) begin
  if (f_ran) begin
    interrupts_when_stopped : assert (irq == $past(stopped != {CHANNELS{1'b0}}));
    reply_is_read : assert (bus_read_data == $past(registers_read_data | channels_read_data));
  end else if (f_started) interrupt_after_reset : assert (!irq);
  if (f_started) refusal_is_told : assert (bus_refusal == (rules_refusal | channels_refusal));
end
