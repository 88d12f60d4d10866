// SPDX-License-Identifier: MIT
// Promises of the encoder; included at the end of passo_encoder.v, about its lines after their filters.

// --- Assumptions: a reset of 3 clocks at the beginning, any later; the settings of the index and the direction are
// constant
reg  [1:0] f_clocks = 2'd0;
wire       f_begun = ~rst;
always @(posedge clk) begin
  if (f_clocks != 2'd3) f_clocks <= f_clocks + 2'd1;
  if (f_clocks != 2'd3) encoder_reset : assume (rst);
  if (f_clocks != 2'd0)
    encoder_settings_stand : assume ($stable(inverted) && $stable(index_inverted) && $stable(index_gated));
end

// --- Quadrature: the place in the cycle 00 10 11 01 of A and B, and how far it moves
function [1:0] f_place;
  input [1:0] f_ba;
  f_place = {f_ba[1], f_ba[1] ^ f_ba[0]};
endfunction
reg  [1:0] f_level_q;  // B and A
wire [1:0] f_level = {level_b, level_a};
wire [1:0] f_move = f_place(f_level) - f_place(f_level_q);
wire       f_active = (level_index ^ index_inverted) && (!index_gated || f_level == 2'b11);
reg  [1:0] f_moved;  // what the outputs must say
reg        f_active_q;
reg        f_event;
reg  [1:0] f_sum;  // of the counts, modulo 4
reg  [1:0] f_jumps;  // by two
reg  [1:0] f_first;  // place at the reset
reg  [7:0] f_illegal;
always @(posedge clk) begin
  f_level_q  <= f_level;
  f_moved    <= f_move;
  f_active_q <= f_active;
  f_event    <= f_active & ~f_active_q;
  f_sum      <= f_sum + (!count_made ? 2'd0 : count_down ^ inverted ? 2'd3 : 2'd1);
  f_jumps    <= f_jumps + (f_moved == 2'd2 ? 2'd2 : 2'd0);
  f_illegal  <= clear ? 8'd0 : f_move == 2'd2 && f_illegal != 8'hFF ? f_illegal + 8'd1 : f_illegal;
  if (rst) begin
    f_level_q  <= {sampled_b, sampled_a};
    f_moved    <= 2'd0;
    f_active_q <= 1'b1;
    f_event    <= 1'b0;
    f_sum      <= 2'd0;
    f_jumps    <= 2'd0;
    f_first    <= f_place({sampled_b, sampled_a});
    f_illegal  <= 8'd0;
  end
end

always @(posedge clk)
  if (f_begun && f_clocks == 2'd3) begin
    if ($past(rst)) levels_at_reset : assert (f_level == f_level_q);
    one_count_for_each_edge : assert (count_made == (f_moved == 2'd1 || f_moved == 2'd3));
    if (count_made) in_its_direction : assert (count_down == ((f_moved == 2'd3) ^ inverted));
    count_is_the_place : assert (f_first + f_sum + f_jumps + f_moved == f_place(f_level_q));
    illegal_counted : assert (illegal == f_illegal);
    index_told : assert (index_event == f_event);
  end

always @(posedge clk)
  if (f_begun && f_clocks == 2'd3)
    assert (a_q == f_level_q[0] && b_q == f_level_q[1] && active_q == f_active_q);
