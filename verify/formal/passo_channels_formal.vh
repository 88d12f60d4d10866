// SPDX-License-Identifier: MIT
// Promises of the channels outside their blocks; included at the end of passo_channels.v. The blocks may do anything.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) channels_reset : assume (rst);
end

reg [TICK_LOG2-1:0] f_clocks = {TICK_LOG2{1'b0}};  // of a tick of the slew rates
reg [2:0] f_sync = 3'b111;  // the pin 1, 2 and 3 clocks ago
always @(posedge clk) begin
  f_clocks <= rst ? {TICK_LOG2{1'b0}} : f_clocks + 1'b1;
  f_sync   <= rst ? 3'b111 : {f_sync[1:0], sync};
end

(* anyconst *) reg [4:0] f_bit;  // any one bit of an answer
reg f_refusal;
reg f_read_data;
integer f_n;
always @* begin
  f_refusal   = 1'b0;
  f_read_data = machine_read_data[f_bit];
  for (f_n = 0; f_n < CHANNELS; f_n = f_n + 1) begin
    f_refusal   = f_refusal | channel_refusal[f_n*4+f_bit[1:0]];
    f_read_data = f_read_data | channel_read_data[f_n*32+f_bit];
  end
end

always @(posedge clk) begin
  if (f_ran) slews_each_tick : assert (slew_tick == $past(f_clocks == {TICK_LOG2{1'b1}}));
  else if (f_started) no_slew_after_reset : assert (!slew_tick);
  if (f_started) begin
    starts_with_the_edge : assert (sync_edge == (f_sync[1] && !f_sync[2]));
    any_answer_is_read : assert (read_data[f_bit] == f_read_data);
    any_refusal_is_told : assert (refusal[f_bit[1:0]] == f_refusal);
    any_objection_is_told : assert (bad_value == |channel_bad_value);
  end
end

// --- What the induction relies on
always @(posedge clk) if (f_started) assert (f_clocks == slew_count && f_sync == sync_q);
