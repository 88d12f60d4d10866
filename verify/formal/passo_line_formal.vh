// SPDX-License-Identifier: MIT
// Promises of the line counter; included at the end of passo_line.v. passo_dda_formal.vh assumes what is asserted
// here of A, B and `line_addend`.

// --- Assumptions: motion, path and line queue. The contents of a line are chosen freely when it is taken; flags and
// M are valid from one clock later until the next line is taken, directions from two clocks later while the line is
// current. The motion releases an ENDLESS line when it is over; then no substep comes until the next start.
(* anyseq *) reg f_next_last;
(* anyseq *) reg f_next_endless;
(* anyseq *) reg [29:0] f_next_last_substep;
(* anyseq *) reg [AXES-1:0] f_next_directions;
(* anyseq *) reg f_release;
reg f_rests = 1'b1;
reg f_started = 1'b0;
wire f_begun = ~rst;
reg f_taken = 1'b0;  // in the clock before
reg f_substep = 1'b0;
reg f_shown = 1'b0;  // a line was taken
always @(posedge clk) begin
  f_started <= 1'b1;
  f_taken   <= f_take & f_begun;
  f_substep <= substep & ~rst;
  if (!f_started) line_reset : assume (rst);
  if (start && !rst)
    line_starts_at_rest :
    assume (next_valid && !stop && !(f_active && !f_rests) && !add_n && !decide_step && !substep);
  if (f_release) line_released_at_rest : assume (!substep && !f_substep && !decide_step && !f_taken && !start);
  f_rests <= rst | ((f_rests | f_release) & ~start);
  if (f_rests) line_rests : assume (!substep);
  if (substep) line_never_two_in_a_row : assume (!f_substep && !(f_taken && !f_substep));
  if (f_shown) line_flags_stand : assume (last == f_last && endless == f_endless && last_substep == f_last_substep);
  if (f_active && !f_taken && !f_rests) line_directions_stand : assume (current_directions == f_directions);
end

// --- The current line: its contents, and its substeps so far
reg            f_active = 1'b0;
reg            f_ended = 1'b0;
reg [    29:0] f_number;  // of the next substep
reg            f_last;
reg            f_endless;
reg [    29:0] f_last_substep;
reg [AXES-1:0] f_directions;
reg [AXES-1:0] f_directions_a;  // of the substep in A
reg [AXES-1:0] f_directions_b;  // of the substep in B
wire           f_counts = substep & f_active;
wire           f_done = f_counts && f_number == f_last_substep;
wire           f_repeats = f_done & f_endless & ~f_last;  // it repeats
wire           f_needs_next = f_done & ~f_endless & ~f_last;
wire           f_take = start | (f_needs_next & next_valid);
always @(posedge clk) begin
  f_directions_a <= f_directions;
  f_directions_b <= f_directions_a;
  if (f_counts) f_number <= f_number + 30'd1;
  if (f_done && !f_repeats && !f_take) f_active <= 1'b0;
  if (f_done && f_last) f_ended <= 1'b1;
  if (f_repeats) f_number <= 30'd0;
  if (start) f_ended <= 1'b0;
  if (f_take) begin
    f_active       <= 1'b1;
    f_shown        <= 1'b1;
    f_number       <= 30'd0;
    f_last         <= f_next_last;
    f_endless      <= f_next_endless;
    f_last_substep <= f_next_last_substep;
    f_directions   <= f_next_directions;
  end
  if (rst || stop) begin
    f_active  <= 1'b0;
    f_ended   <= 1'b0;
  end
  if (rst) f_shown <= 1'b0;
end

reg f_stopped = 1'b1;
always @(posedge clk) f_stopped <= rst | stop;

wire signed [31:0] f_minus_m = -($signed({2'b00, f_last_substep}) + 32'sd1);
wire signed [31:0] f_minus_m_half = f_minus_m >>> 1;  // floor

always @(posedge clk)
  if (f_begun) begin
    line_has_m_substeps : assert (take == f_take);
    if (f_active) substep_number_in_line : assert (f_number <= f_last_substep);
    if (f_stopped) idle_after_stop : assert (!add_n && !load_start && !decide_step && !load_start_q && !underrun);
    else begin
      a_for_each_substep : assert (add_n == $past(f_counts));
      a_loads_the_next_line : assert (load_start == $past(f_take || f_repeats));
      if ($past(f_repeats)) endless_begins_anew : assert (add_n && load_start);
      b_follows_a : assert (decide_step == $past(add_n) && load_start_q == $past(load_start));
      underrun_told : assert (underrun == $past(f_needs_next && !next_valid));
    end
    if (f_repeats) endless_takes_no_other : assert (!take);
    a_and_b_alternate : assert (!(decide_step && add_n) && !(load_start_q && load_start));
    if (add_n && !load_start) adds_minus_m : assert ({line_addend[30], line_addend} == f_minus_m);
    if (load_start) loads_half_of_minus_m : assert ({line_addend[30], line_addend} == f_minus_m_half);
    if (decide_step) step_has_its_directions : assert (directions == f_directions_b);
    ended_after_last : assert (ended == f_ended);
    if (f_shown && !f_taken) endless_is_of_the_line : assert (current_endless == f_endless);
  end

always @(posedge clk)
  if (f_begun) begin
    assert (active == f_active);
    if (!f_taken && !f_substep) assert (repeats == (f_active && f_endless && !f_last));
    if (!f_taken && !f_substep) assert (goes_on == (f_active && !f_endless && !f_last));
    if (f_active) begin
      assert (f_shown && substep_number == f_number);
      if (!f_substep && !f_taken) assert (on_last == (f_number == f_last_substep));
    end
    assert (!(f_ended && f_active));
    if (add_n && !load_start && !load_start_q) assert (directions == f_directions_a);
    if (f_active && !load_start && !load_start_q) assert (directions == f_directions);
    if (add_n && f_active && !load_start) assert (f_directions_a == f_directions);
  end
