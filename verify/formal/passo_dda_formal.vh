// SPDX-License-Identifier: MIT
// Promises of the DDA; included at the end of passo_dda.v. Its assumptions are proved of the line counter in
// passo_line_formal.vh, of the step counts in passo_line_queue_formal.vh.

// --- A line as driven by the line counter: M substeps of A and B; the next line (an ENDLESS one: itself) is loaded
// with the last one. A stop ends A and B immediately; the release of an ENDLESS line ends it anywhere.
(* anyseq *) reg [29:0] f_m_next;
(* anyseq *) reg f_stop;
reg         f_stopped = 1'b0;
reg         f_begun = 1'b0;
reg         f_line = 1'b0;  // there is a line
reg  [29:0] f_m;
reg  [29:0] f_substeps;  // made, in A
reg         f_add_q = 1'b0;
reg         f_load_q = 1'b0;
wire        f_is_last = f_substeps == f_m - 30'd1;
always @(posedge clk) begin
  f_begun  <= 1'b1;
  f_stopped <= f_stop;
  f_add_q  <= add_n & f_begun & ~f_stop;
  f_load_q <= load_start & f_begun & ~f_stop;
  dda_b_follows_a : assume (decide_step == f_add_q && load_start_q == f_load_q);
  if (!f_begun || f_stopped) dda_idle_after_stop : assume (!add_n && !load_start);
  if (add_n || load_start) dda_a_and_b_alternate : assume (!f_add_q && !f_load_q);
  if (add_n) dda_only_in_a_line : assume (f_line);
  if (load_start) dda_loads_with_the_last : assume (add_n ? f_is_last : !f_line);
  if (add_n && !load_start) dda_adds_minus_m : assume (line_addend == -$signed({1'b0, f_m}));
  if (load_start)
    dda_loads_half_of_minus_m :
    assume (f_m_next != 30'd0 && $signed({line_addend[30], line_addend}) == -$signed({2'b00, f_m_next}) >>> 1);
`ifdef NARROW
  dda_narrow : assume (f_m_next < 30'd`NARROW);
`endif
  // N is valid in B
  if (f_line) dda_n_at_most_m : assume (steps <= f_m);
  if (f_line && !f_load_q && f_begun) dda_n_stands : assume ($stable(steps));

  if (add_n) f_substeps <= f_substeps + 30'd1;
  if (add_n && f_is_last) f_line <= 1'b0;
  if (load_start) begin
    f_line     <= 1'b1;
    f_m        <= f_m_next;
    f_substeps <= 30'd0;
  end
  if (f_stop) f_line <= 1'b0;
end

// --- The promise: e as it should be, and e - start = N * substeps made - M * steps made
// f_balance = N * substeps - M * steps, accumulated; with 0 <= e, start < M it is less than M, so after
// M substeps M * (N - steps) lies between -M and M: steps = N. NARROW counts them.
reg  [29:0] f_e;  // 0 .. M - 1
reg  [29:0] f_m_q;  // M and N of the substep in B
reg  [29:0] f_n_q;
reg         f_last_q = 1'b0;
reg  signed [31:0] f_balance;
reg  [29:0] f_steps;  // made
wire signed [31:0] f_balance_next = f_balance - (step_request ? $signed({2'b00, f_m_q}) : 32'sd0);
wire signed [31:0] f_start = $signed({3'b000, f_m[29:1]});
wire signed [31:0] f_start_q = $signed({3'b000, f_m_q[29:1]});
wire [29:0] f_steps_next = f_steps + {29'd0, step_request};
wire [30:0] f_e_sum = {1'b0, f_e} + {1'b0, f_n_q};
wire [30:0] f_e_next = f_e_sum - (step_request ? {1'b0, f_m_q} : 31'd0);
always @(posedge clk) begin
  if (add_n) begin
    f_m_q    <= f_m;
    f_n_q    <= steps;
    f_last_q <= f_is_last;
    f_balance <= f_balance + $signed({2'b00, steps});
  end
  if (decide_step) begin
    f_e     <= f_e_next[29:0];
    f_balance <= f_balance_next;
    f_steps <= f_steps_next;
    step_if_m_is_reached : assert (step_request == (f_e_sum >= {1'b0, f_m_q}));
    e_stays_in_range : assert (f_e_next < {1'b0, f_m_q});
    sums_agree : assert ($signed({1'b0, f_e_next}) == f_start_q + f_balance_next);
`ifdef NARROW
    if (f_last_q) n_steps_in_m_substeps : assert (f_steps_next == f_n_q);
    if (f_last_q) e_is_back_at_start : assert (f_e_next == {2'b00, f_m_q[29:1]});
`endif
  end else no_step_outside_b : assert (!step_request);
  if (load_start_q) begin
    f_e     <= {1'b0, f_m[29:1]};
    f_balance <= 32'sd0;
    f_steps <= 30'd0;
  end
end

always @(posedge clk) begin
  if (f_line && !load_start_q && !decide_step) begin
    assert (f_e < f_m && e_minus_m == f_e - f_m);
    assert (addend == {1'b0, steps});
    assert ($signed({2'b00, f_e}) == f_start + f_balance);
  end
  if (load_start_q) assert (f_line && f_m != 30'd0 && f_substeps == 30'd0);
  if (load_start_q) assert (e_minus_m == 30'd0 && $signed(addend) == -$signed({2'b00, f_m}) >>> 1);
  if (f_line) assert (f_m != 30'd0 && f_substeps < f_m);
  if (decide_step) begin
    assert (f_m_q != 30'd0 && f_n_q <= f_m_q && f_e < f_m_q);
    assert (e_minus_m == (load_start_q ? 30'd0 : f_e + f_n_q - f_m_q));
    assert (reached == ({1'b0, f_e} + {1'b0, f_n_q} >= {1'b0, f_m_q}));
    if (!load_start_q) assert (addend == -{1'b0, f_m_q});
    if (f_line && !load_start_q) assert (f_m == f_m_q && f_n_q == steps);
    assert ($signed({2'b00, f_e}) + $signed({2'b00, f_n_q}) == f_start_q + f_balance);
    if (!f_last_q) assert (f_line && !load_start_q);
    else assert (load_start_q || !f_line);
  end
`ifdef NARROW
  // the sums are products; with few bits the solver can divide by M
  if (f_line) assert (f_m < 30'd`NARROW);
  if (decide_step) assert (f_m_q < 30'd`NARROW && f_steps < f_m_q);
  if (f_line && !decide_step && !load_start_q) assert (f_steps <= f_substeps && f_substeps < 30'd`NARROW);
  if (f_line && !load_start_q && !decide_step)
    assert (f_balance == {24'd0, f_substeps[7:0]} * {24'd0, steps[7:0]} - {24'd0, f_steps[7:0]} * {24'd0, f_m[7:0]});
  if (decide_step)
    assert (f_balance == {24'd0, f_last_q ? f_m_q[7:0] : f_substeps[7:0]} * {24'd0, f_n_q[7:0]}
            - {24'd0, f_steps[7:0]} * {24'd0, f_m_q[7:0]});
`endif
end
