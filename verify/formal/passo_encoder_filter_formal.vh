// SPDX-License-Identifier: MIT
// Promises of the filter of a line of an encoder; included at the end of passo_encoder_filter.v.

// --- Assumptions: a reset of 3 clocks at the beginning, any later; the length is constant
reg  [1:0] f_clocks = 2'd0;
wire       f_ready = f_clocks == 2'd3;
always @(posedge clk) begin
  if (!f_ready) f_clocks <= f_clocks + 2'd1;
  if (!f_ready) encoder_filter_reset : assume (rst);
  if (f_clocks != 2'd0) encoder_filter_length : assume ($stable(length));
end

// --- The pin, 2 clocks late, and for how many clocks it has been so, up to 256; the level follows from these alone
reg       f_pin_q;
reg       f_pin;
reg [8:0] f_since;
reg       f_level;
always @(posedge clk) begin
  f_pin_q <= pin;
  f_pin   <= f_pin_q;
  f_since <= f_pin_q != f_pin ? 9'd1 : f_since == 9'd256 ? 9'd256 : f_since + 9'd1;
  if (f_since > {1'b0, length}) f_level <= f_pin;
  if (rst) begin
    f_since <= 9'd1;  // it starts again
    f_level <= f_pin;
  end
end

always @(posedge clk)
  if (!rst && f_ready) begin
    filtered : assert (level == f_level);
    sampled_late : assert (sampled == f_pin);
  end

always @(posedge clk) begin
  if (f_clocks != 2'd0) assert (sync[0] == f_pin_q);
  if (f_clocks[1]) assert (sync[1] == f_pin);
  if (!rst && f_ready) begin
    assert (f_since != 9'd0 && f_since <= 9'd256);
    if (level != f_pin) assert (f_since <= {1'b0, length} + 9'd1 && {1'b0, count} == f_since - 9'd1);
  end
end
