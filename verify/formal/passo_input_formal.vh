// SPDX-License-Identifier: MIT
// Promises of an input; included at the end of passo_input.v.

(* anyconst *) reg [5:0] f_bit;  // any one input
always @* input_exists : assume (f_bit < WIDTH);

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
wire f_differs = second[f_bit] ^ level[f_bit];
wire f_changes = f_differs & pending[f_bit] & tick;
reg [5:0] f_run = 6'd0;
always @(posedge clk) f_run <= f_differs && !f_changes && !rst ? f_run + 6'd1 : 6'd0;

// --- For how many clocks up to the last one the input has not changed, none has, and since when the settings hold
reg [5:0] f_still = 6'd0;
reg [5:0] f_calm = 6'd0;
reg [5:0] f_settings = 6'd0;
always @(posedge clk) begin
  f_still    <= rst || (f_still != 6'd0 && second[f_bit] != $past(second[f_bit])) ? 6'd1 : f_still + (f_still != 6'd63);
  f_calm     <= rst || forget || pins != $past(pins) || inverted != $past(inverted) ? 6'd0 : f_calm + (f_calm != 6'd63);
  f_settings <= rst || forget ? 6'd0 : f_settings + (f_settings != 6'd63);
end

always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    if (level[f_bit] != $past(level[f_bit])) longer_than_the_filter : assert ($past(f_run) >= {2'd0, f_length});
    if ($past(f_changes)) acts_on_the_tick : assert (level[f_bit] != $past(level[f_bit]));
    if (f_differs) acts_by_twice_the_filter : assert (f_run < {1'b0, f_length, 1'b0});
    if ($past(f_begun, 2) && $past(f_begun, 3)) two_flip_flops : assert (synced[f_bit] == $past(pins[f_bit] ^ inverted[f_bit], 2));
    if ($past(level[f_bit])) active_is_remembered : assert (was_active[f_bit]);
    if ($past(was_active[f_bit]) && !$past(clear[f_bit])) flag_stays : assert (was_active[f_bit]);
    if ($past(clear[f_bit] && !level[f_bit])) flag_is_cleared : assert (!was_active[f_bit]);
    if (was_active[f_bit]) flag_for_a_reason : assert ($past(level[f_bit] || was_active[f_bit]));
    if ($past(forget)) change_of_settings_forgets : assert (unknown);
    if (!$past(unknown || forget)) known_stays_known : assert (!unknown);
    if ($past(unknown) && !unknown) begin
      known_is_right : assert (level[f_bit] == $past(second[f_bit]));
      known_by_a_period : assert ($past(f_still) >= {2'd0, f_length});
      known_with_new_settings : assert (f_settings > 6'd2);
    end
    if (f_calm > {1'b0, f_length, 1'b0} + 6'd2) still_is_known : assert (!unknown);
  end
  else if (f_started && $past(rst)) reset_forgets : assert (unknown);

always @(posedge clk)
  if (f_started) begin
    assert (f_since < f_length);
    if (!rst && pending[f_bit])
      assert (f_run >= {2'd0, f_since} + 6'd1 && f_run <= {2'd0, f_since} + {2'd0, f_length});
    if (!rst && !pending[f_bit]) assert (f_run <= {2'd0, f_since});
    if (f_begun && $past(f_begun)) begin
      if (f_calm > 6'd1) assert (first[f_bit] == second[f_bit]);
      if (!changed) assert (f_still > {2'd0, f_since} && pending[f_bit] == f_differs);
      if (f_calm > {2'd0, f_since} + 6'd3) assert (!changed);
      if (f_calm > {2'd0, f_since} + {2'd0, f_length} + 6'd3) assert (!unknown);
      assert (forgot == (f_settings == 6'd0));
      if (f_settings < 6'd2) assert (changed);
      if (f_settings < 6'd3) assert (unknown);
    end
  end
