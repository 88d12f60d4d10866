// SPDX-License-Identifier: MIT
// Promises of the core outside its blocks; included at the end of passo_core.v. The blocks may do anything.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) core_reset : assume (rst);
end

reg [TICK_LOG2-1:0] f_clocks = {TICK_LOG2{1'b0}};  // of a tick of the slew rates
reg [2:0] f_sync = 3'b111;  // the pin 1, 2 and 3 clocks ago
always @(posedge clk) begin
  f_clocks <= rst ? {TICK_LOG2{1'b0}} : f_clocks + 1'b1;
  f_sync   <= rst ? 3'b111 : {f_sync[1:0], sync};
end

reg [3:0] f_refusal;
reg [31:0] f_read_data;
integer f_n;
always @* begin
  f_refusal   = rules_refusal;
  f_read_data = registers_read_data | machine_read_data;
  for (f_n = 0; f_n < CHANNELS; f_n = f_n + 1) begin
    f_refusal   = f_refusal | channel_refusal[f_n*4+:4];
    f_read_data = f_read_data | channel_read_data[f_n*32+:32];
  end
end

always @(posedge clk) begin
  if (f_ran) begin
    interrupts_when_stopped : assert (irq == $past(stopped != {CHANNELS{1'b0}}));
    slews_each_tick : assert (slew_tick == $past(f_clocks == {TICK_LOG2{1'b1}}));
    reply_is_read : assert (bus_read_data == $past(f_read_data));
  end else if (f_started) interrupt_after_reset : assert (!irq && !slew_tick);
  if (f_started) begin
    starts_with_the_edge : assert (sync_edge == (f_sync[1] && !f_sync[2]));
    refusal_is_told : assert (bus_refusal == f_refusal);
  end
end

// --- What the induction relies on
always @(posedge clk) if (f_started) assert (f_clocks == slew_count && f_sync == sync_q);
