// SPDX-License-Identifier: MIT
// What the line counter promises; included at the end of passo_line. passo_dda_formal.vh assumes what is
// asserted here of the slots and of `broadcast`.

// --- Assumptions: how motion, path and line queue behave
reg f_begun = 1'b0;
reg f_taken = 1'b0;  // in the clock before
reg f_substep = 1'b0;
always @(posedge clk) begin
  f_begun   <= 1'b1;
  f_taken   <= take & f_begun;
  f_substep <= substep;
  assume (rst == !f_begun);
  if (start) assume (next_valid && !stop && !f_active && !f_ended && !slot_add && !slot_step && !substep);
  if (substep) assume (!f_substep && !(f_taken && !f_substep));
  if (f_begun && !f_taken) assume ($stable(last_substep));
  if (!f_begun) assume (!start && !substep);
`ifdef SMALL
  assume (last_substep <= 32'd2);
`endif
end

// --- The current line: its substeps so far, and its control
reg            f_active = 1'b0;
reg            f_ended = 1'b0;
reg [    31:0] f_number;  // of the next substep
reg            f_last;
reg            f_endless = 1'b0;
reg [AXES-1:0] f_directions;
reg [AXES-1:0] f_directions_a;  // of the substep in A
reg [AXES-1:0] f_directions_b;  // of the substep in B
wire           f_counts = substep & f_active;
wire           f_done = f_counts && f_number == last_substep;
wire           f_follows = f_done & ~f_last & next_valid;
always @(posedge clk) begin
  f_directions_a <= f_directions;
  f_directions_b <= f_directions_a;
  if (f_counts) f_number <= f_number + 32'd1;
  if (f_done && !f_follows) f_active <= 1'b0;
  if (f_done && f_last) f_ended <= 1'b1;
  if (start || f_follows) begin
    f_active     <= 1'b1;
    f_number     <= 32'd0;
    f_last       <= next_last;
    f_endless    <= next_endless;
    f_directions <= next_directions;
  end
  if (rst || stop) begin
    f_active  <= 1'b0;
    f_ended   <= 1'b0;
    f_endless <= 1'b0;
  end
end

reg f_stopped = 1'b1;
always @(posedge clk) f_stopped <= rst | stop;

wire signed [33:0] f_minus_m = -($signed({2'b00, last_substep}) + 34'sd1);
wire signed [33:0] f_minus_m_half = f_minus_m >>> 1;  // floor

always @(posedge clk)
  if (f_begun) begin
    line_has_m_substeps : assert (take == (start | f_follows));
    if (f_active) substep_number_in_line : assert (f_number <= last_substep);
    if (f_stopped) no_slot_after_stop : assert (!slot_add && !slot_load && !slot_step && !slot_load_q && !underrun);
    else begin
      a_for_each_substep : assert (slot_add == $past(f_counts));
      a_loads_the_next_line : assert (slot_load == $past(take));
      b_follows_a : assert (slot_step == $past(slot_add) && slot_load_q == $past(slot_load));
      underrun_told : assert (underrun == $past(f_done && !f_last && !next_valid));
    end
    a_and_b_alternate : assert (!(slot_step && slot_add) && !(slot_load_q && slot_load));
    if (slot_add && !slot_load) adds_minus_m : assert ({broadcast[32], broadcast} == f_minus_m);
    if (slot_load) loads_half_of_minus_m : assert ({broadcast[32], broadcast} == f_minus_m_half);
    if (slot_step) step_has_its_directions : assert (directions == f_directions_b);
    ended_after_last : assert (ended == f_ended);
    endless_is_of_the_line : assert (endless == f_endless);
  end

`ifdef INVARIANTS
always @(posedge clk)
  if (f_begun) begin
    assert (active == f_active && goes_on == (f_active && !f_last));
    if (f_active) begin
      assert (substep_number == f_number);
      assert (last == f_last && directions_next == f_directions);
      if (!f_substep && !f_taken) assert (on_last == (f_number == last_substep));
    end
    assert (!(f_ended && f_active));
    assert (!(slot_add && f_directions_a != directions_next && !slot_load));
    if (slot_add && !slot_load && !slot_load_q) assert (directions == f_directions_a);
    if (f_active && !slot_load && !slot_load_q) assert (directions == directions_next);
  end
`endif
