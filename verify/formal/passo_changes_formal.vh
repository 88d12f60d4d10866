// SPDX-License-Identifier: MIT
// Promises of the changes on their way; included at the end of passo_changes.v. The memory is replaced by its promise.

// --- Changes that went in and have not come out
reg [DEPTH_LOG2:0] f_waiting = {(DEPTH_LOG2 + 1) {1'b0}};
always @(posedge clk) begin
  f_waiting <= f_waiting + {{DEPTH_LOG2{1'b0}}, push} - {{DEPTH_LOG2{1'b0}}, hit};
  if (rst || flush) f_waiting <= {(DEPTH_LOG2 + 1) {1'b0}};
end

// --- Assumptions: changes are at least two clocks apart; the lag is below 16 and stands while one waits; a memory keeps
// what it is given
reg             f_started = 1'b0;
reg [15:0]      f_times[0:DEPTH-1];
reg [WIDTH-1:0] f_words[0:DEPTH-1];
wire [DEPTH_LOG2-1:0] f_writes = write_place[DEPTH_LOG2-1:0];
reg                   f_defined = 1'b0;  // the place that was read was not being written
reg [15:0]            f_time;
reg [WIDTH-1:0]       f_word;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) changes_reset : assume (rst);
  if (f_started && change) changes_apart : assume ($past(!change && !rst));
  if (f_started && !$stable(lag)) changes_lag_stands : assume (f_waiting == 0 && !change);
  changes_narrow : assume (lag < 16'd16);
  if (push) f_times[f_writes] <= due;
  if (push) f_words[f_writes] <= data_in;
  f_defined <= !push || f_writes != reads[DEPTH_LOG2-1:0];
  f_time    <= f_times[reads[DEPTH_LOG2-1:0]];
  f_word    <= f_words[reads[DEPTH_LOG2-1:0]];
  if (f_started && f_defined) changes_memory : assume (time_out == f_time && data == f_word);
end

// --- Any one clock is watched, with or without a change
(* anyseq *) reg f_pick;
reg             f_watched = 1'b0;
reg             f_came;
reg [WIDTH-1:0] f_data;
reg [5:0]      f_age;  // clocks since then
wire [5:0]     f_due = lag[5:0] + 6'd3;
always @(posedge clk) begin
  f_age <= f_age + 6'd1;
  if (!f_watched && f_pick) begin
    f_watched <= 1'b1;
    f_came    <= push;
    f_data    <= data_in;
    f_age     <= 6'd1;
  end
  // one before any change is not watched further when the lag changes
  if (rst || flush || (f_watched && f_age == f_due) || !$stable(lag)) f_watched <= 1'b0;
end

always @(posedge clk)
  if (f_started && !$past(rst || flush)) begin
    if (f_watched && f_age == f_due && $stable(lag)) comes_out_on_its_clock : assert (hit == f_came);
    if (f_watched && f_age == f_due && $stable(lag) && hit) comes_out_as_it_went_in : assert (data == f_data);
    lost_only_when_full : assert (overflow == $past(change && f_full));
    if (empty) empty_when_none_waits : assert (f_waiting == 0);
    if (f_waiting == 0 && !$past(change)) none_waits_is_empty : assert (empty);
  end else if (f_started) flushed : assert (!hit && empty && f_waiting == 0);

// --- A place is free again the clock after next
reg f_full = 1'b0;
always @(posedge clk) f_full <= f_waiting == DEPTH && !rst && !flush;

// Place by place: clocks since its change went in
reg [5:0] f_ages[0:DEPTH-1];
reg        f_clean = 1'b0;  // a reset is two clocks ago
integer n;
always @(posedge clk) begin
  for (n = 0; n < DEPTH; n = n + 1) f_ages[n] <= push && f_writes == n ? 6'd1 : f_ages[n] + 6'd1;
  f_clean <= ~rst;
end
wire [DEPTH_LOG2-1:0] f_head = read_place[DEPTH_LOG2-1:0];
reg [DEPTH_LOG2:0] f_offset, f_ahead;
always @(posedge clk)
  if (f_started) begin
    assert (f_waiting == write_place - read_place && f_waiting <= DEPTH && full == f_full);
    assert (read_next == read_place + 1'b1);
    if ($past(!rst)) assert (ahead == now + 16'd3 && f_clean);
    if ($past(!rst) && $past(f_clean)) assert (due == now + $past(lag) + 16'd2);
    if (hit) assert (f_waiting != 0 && f_ages[f_head] == f_due && data == f_words[f_head]);
    if (valid) assert (f_waiting != 0 && f_ages[f_head] >= 2 && f_defined && f_time == f_times[f_head] && f_word == f_words[f_head]);
    else if (f_waiting != 0) assert (f_ages[f_head] == 1);
    if (f_watched) assert (f_age != 0 && (f_age <= f_due || !$stable(lag)));
    if (f_watched && f_came) assert (f_waiting != 0);
    f_ahead = 0;
    for (n = 0; n < DEPTH; n = n + 1) begin
      f_offset = {1'b0, n[DEPTH_LOG2-1:0] - f_head};
      if (f_offset < f_waiting) begin
        assert (f_ages[n] != 0 && f_ages[n] < f_due || hit && n == f_head);
        assert (f_times[n] == now - {10'd0, f_ages[n]} + lag + 16'd2);
        if (f_offset + 1 < f_waiting) assert (f_ages[n] >= f_ages[(n+1)%DEPTH] + 2);
        if (f_offset + 1 == f_waiting && !$past(change)) assert (f_ages[n] >= 2);
        if (f_watched && f_ages[n] == f_age) assert (f_came && f_words[n] == f_data);
        if (f_ages[n] == f_age) f_ahead = f_ahead + 1'b1;
      end
    end
    if (f_watched && f_came) assert (f_ahead == 1);
  end
