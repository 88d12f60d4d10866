// SPDX-License-Identifier: MIT
// Promises of an input; included at the end of passo_input.v.

// --- Assumptions: a reset at the beginning; ticks every f_length clocks, 1 .. 15
reg f_started = 1'b0;
wire f_begun = ~rst;
(* anyconst *) reg [3:0] f_length;
reg [3:0] f_since = 4'd0;  // clocks since the last tick
always @(posedge clk) begin
  f_started <= 1'b1;
  f_since   <= tick ? 4'd0 : f_since + 4'd1;
  if (!f_started) input_reset : assume (rst);
  input_ticks : assume (f_length != 4'd0 && tick == (f_since == f_length - 4'd1));
end

// --- On how many clocks up to the last one the input has differed from the level
wire f_differs = second[0] ^ level[0];
wire f_changes = f_differs & pending[0] & tick;
reg [5:0] f_run = 6'd0;
always @(posedge clk) f_run <= f_differs && !f_changes && !rst ? f_run + 6'd1 : 6'd0;

// --- For how many clocks up to the last one the input has not changed, none has, and since when the settings hold
reg [5:0] f_still = 6'd0;
reg [5:0] f_calm = 6'd0;
reg [5:0] f_settings = 6'd0;
always @(posedge clk) begin
  f_still    <= rst || (f_still != 6'd0 && second[0] != $past(second[0])) ? 6'd1 : f_still + (f_still != 6'd63);
  f_calm     <= rst || forget || pins != $past(pins) || inverted != $past(inverted) ? 6'd0 : f_calm + (f_calm != 6'd63);
  f_settings <= rst || forget ? 6'd0 : f_settings + (f_settings != 6'd63);
end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (level[0] != $past(level[0])) longer_than_the_filter : assert ($past(f_run) >= {2'd0, f_length});
    if ($past(f_changes)) acts_on_the_tick : assert (level[0] != $past(level[0]));
    if (f_differs) acts_by_twice_the_filter : assert (f_run < {1'b0, f_length, 1'b0});
    if ($past(f_begun, 2) && $past(f_begun, 3)) two_flip_flops : assert (synced[0] == $past(pins[0] ^ inverted[0], 2));
    if ($past(level[0])) active_is_remembered : assert (was_active[0]);
    if ($past(was_active[0]) && !$past(clear[0])) flag_stays : assert (was_active[0]);
    if (was_active[0]) flag_for_a_reason : assert ($past(level[0] || was_active[0]));
    if ($past(forget)) change_of_settings_forgets : assert (unknown);
    if (!$past(unknown || forget)) known_stays_known : assert (!unknown);
    if ($past(unknown) && !unknown) begin
      known_is_right : assert (level[0] == $past(second[0]));
      known_by_a_period : assert ($past(f_still) >= {2'd0, f_length});
      known_with_new_settings : assert (f_settings > 6'd2);
    end
    if (f_calm > {1'b0, f_length, 1'b0} + 6'd2) still_is_known : assert (!unknown);
  end
  else if (f_started && $past(rst)) reset_forgets : assert (unknown);

always @(posedge clk)
  if (f_started) begin
    assert (f_since < f_length);
    if (!rst && pending[0])
      assert (f_run >= {2'd0, f_since} + 6'd1 && f_run <= {2'd0, f_since} + {2'd0, f_length});
    if (!rst && !pending[0]) assert (f_run <= {2'd0, f_since});
    if (f_begun && $past(f_begun)) begin
      if (f_calm > 6'd1) assert (first[0] == second[0]);
      if (!changed) assert (f_still > {2'd0, f_since} && pending[0] == f_differs);
      if (f_calm > {2'd0, f_since} + 6'd3) assert (!changed);
      if (f_calm > {2'd0, f_since} + {2'd0, f_length} + 6'd3) assert (!unknown);
      assert (forgot == (f_settings == 6'd0));
      if (f_settings < 6'd2) assert (changed);
      if (f_settings < 6'd3) assert (unknown);
    end
  end
