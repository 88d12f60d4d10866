// SPDX-License-Identifier: MIT
// Promises of the line queue; included at the end of passo_line_queue.v.

// --- Assumptions: the link. A frame is checked word by word; if no word is refused and it ends with a whole line, it
// may be written: as many words, the checked and valid ones. Data are stable from one clock before their strobe to
// one clock after it, checked data from two clocks before; `bus_msb` is valid in the strobe and the clock before.
localparam [1:0] F_GAP = 2'd3;
reg       f_started = 1'b0;
wire      f_begun = ~rst;
reg       f_strobe_q = 1'b0;
reg [1:0] f_gap = 2'd0;  // clocks since the last strobe or frame, up to 3
reg       f_checking = 1'b0;
reg       f_writing = 1'b0;
reg       f_refused = 1'b0;
reg [7:0] f_words = 8'd0;  // checked, and not yet written
reg       f_select = 1'b0;
reg [1:0] f_index = 2'd0;  // word of the line, 0 .. AXES + 1
reg [3:0] f_since_take = 4'd0;
reg [2:0] f_since_write = 3'd0;
(* anyseq *) reg f_go;
wire f_strobe = (bus_check | bus_write) & select;
wire f_last_index = f_index == AXES + 1;
wire f_msb_right = bus_msb == 5'd0 ? bus_data <= 32'd1 : bus_data >> bus_msb == 32'd1;
wire f_good = f_checking && !f_refused && refusal == VERDICT_OK && f_index == 2'd0 && f_words != 8'd0;
always @(posedge clk) begin
  f_started  <= 1'b1;
  f_strobe_q <= (bus_check | bus_write) & ~rst;
  f_gap      <= bus_check | bus_write | bus_frame ? 2'd0 : f_gap == 2'd3 ? 2'd3 : f_gap + 2'd1;
  f_since_take <= take ? 4'd0 : f_since_take == 4'd15 ? 4'd15 : f_since_take + 4'd1;
  f_since_write <= bus_write | f_writing | (bus_frame & bus_commit) ? 3'd0 : f_since_write == 3'd7 ? 3'd7 : f_since_write + 3'd1;
  if (!f_started) line_queue_reset : assume (rst);
  if (bus_write || bus_frame) line_queue_strobes_apart : assume (f_gap >= F_GAP);
  if (bus_check) line_queue_checks_apart : assume (f_gap == 2'd3);
  line_queue_one_strobe : assume (bus_check + bus_write + bus_frame <= 2'd1);
  if (bus_frame) line_queue_commits_good : assume (bus_commit == (f_good && f_go));
  if (bus_check || bus_write || f_strobe_q) line_queue_data_stand : assume ($stable(bus_data));
  if (bus_check)
    line_queue_msb :
    assume ($past(bus_data, 2) == bus_data && f_msb_right && $past(f_msb_right));
  if (bus_check) line_queue_frame_has_begun : assume (f_checking);
  if (bus_write) line_queue_writes_good : assume (f_writing == select);
  if (f_checking && f_words != 8'd0) line_queue_select_stands : assume (select == f_select);
  if (f_writing) line_queue_writes_all : assume (!bus_frame || f_words == 8'd0);
  if (f_strobe) f_index <= f_last_index ? 2'd0 : f_index + 2'd1;
  if (refusal != VERDICT_OK) f_refused <= 1'b1;
  if (bus_check) begin
    f_words  <= f_words == 8'd255 ? 8'd255 : f_words + 8'd1;
    f_select <= select;
  end
  if (bus_write && f_writing) f_words <= f_words - 8'd1;
  if (bus_write && f_writing && f_words == 8'd1) f_writing <= 1'b0;
  if (bus_frame) begin
    f_index    <= 2'd0;
    f_refused  <= 1'b0;
    f_checking <= !bus_commit;
    f_writing  <= bus_commit && f_select;
    if (!bus_commit) f_words <= 8'd0;
  end
  if (rst) begin
    {f_checking, f_writing, f_refused} <= 3'b000;

    f_index <= 2'd0;
    f_words <= 8'd0;
  end
  // line counter and motion
  line_queue_blocked : assume (blocked == flush);
  if (take) line_queue_takes_the_next : assume (next_valid && !release_line);
  if (release_line) line_queue_releases_current : assume (f_current && f_since_take >= 4'd2 && !flush);
  // a channel stays stopped while a frame is written: only another frame can clear it
  if ($past(flush && !rst) && f_since_write != 3'd7) line_queue_stays_flushed : assume (flush || rst);
end

// --- Reference queue: lines from the next one on, and the place of the current line
reg  [DEPTH_LOG2:0] f_lines = 0;
reg                 f_current = 1'b0;  // there is one, and it occupies a place
wire f_written = bus_write & select & f_last_index;
reg  [DEPTH_LOG2:0] f_checked = 0;  // lines of this frame
reg  [DEPTH_LOG2:0] f_to_come = 0;  // lines of an accepted frame, still to be written
wire [DEPTH_LOG2:0] f_free = (1 << DEPTH_LOG2) - f_lines - f_current - f_to_come;
reg  [DEPTH_LOG2:0] f_free_q = 1 << DEPTH_LOG2;  // a clock ago
always @(posedge clk) begin
  f_free_q <= f_free;
  if (f_written) f_to_come <= f_to_come - 1'b1;
  if (bus_frame && bus_commit) f_to_come <= f_checked;
  f_lines <= f_lines + f_written - take;
  if (release_line) f_current <= 1'b0;
  if (take) f_current <= 1'b1;
  if (bus_check && select && f_last_index) f_checked <= f_checked + 1'b1;
  if (bus_frame) f_checked <= 0;
  if (rst) f_checked <= 0;
  if (rst || flush) begin
    f_to_come <= 0;
    f_lines   <= 0;
    f_current <= 1'b0;
  end
end

reg [2:0] f_quiet = 3'd0;  // clocks in which nothing was written, taken or flushed
always @(posedge clk) f_quiet <= take | flush | rst | f_written ? 3'd0 : f_quiet == 3'd7 ? 3'd7 : f_quiet + 3'd1;

always @(posedge clk)
  if (f_begun) begin
    if ($past(f_begun)) room_is_what_is_free : assert (room == f_free_q);
    if (next_valid && !flush && !$past(flush || rst)) next_only_if_there : assert (f_lines != 0);
    if (f_quiet >= 3'd2 && f_lines != 0) line_not_lost : assert (next_valid);
    if (incomplete != (f_index != 2'd0)) incomplete_told : assert (bus_frame);
  end

// --- Refusals
localparam [31:0] F_M_LIMIT = 32'd1 << 30;
reg [31:0] f_m;
wire [31:0] f_defined = {{(24 - AXES) {1'b0}}, {AXES{1'b1}}, 6'd0, 2'b11};
wire f_bad = f_index == 2'd0 ? (bus_data & ~f_defined) != 32'd0 :
             f_index == 2'd1 ? bus_data == 32'd0 || bus_data >= F_M_LIMIT : bus_data > f_m;
always @(posedge clk) begin
  if (f_strobe && f_index == 2'd1) f_m <= bus_data;
  if (bus_write && select) line_queue_as_checked : assume (!f_bad);
  if (f_begun && $past(f_begun)) begin
    if ($past(!(bus_check && select))) refuses_only_checks : assert (refusal == VERDICT_OK);
    else if ($past(blocked)) busy_when_stopped : assert (refusal == VERDICT_BUSY);
    else begin
      if (refusal == VERDICT_OK && !f_refused) room_for_all_checked : assert ($past(f_checked) < $past(room));
      if (refusal == VERDICT_QUEUE_FULL) full_only_without_room : assert ($past(f_checked) == $past(f_free_q, 2));
      else bad_value_refused : assert (refusal == ($past(f_bad) ? VERDICT_BAD_VALUE : VERDICT_OK) || f_refused);
    end
  end
end

// --- Any one line is tracked from its first word on
(* anyconst *) reg [DEPTH_LOG2-1:0] f_slot;  // its place; the script connects it to the memories
(* anyseq *) reg f_choose;
(* keep *) wire [31:0] f_substep_word;
(* keep *) wire [30:0] f_steps_word;
reg f_recording = 1'b0;
reg f_queued = 1'b0;
reg f_shown = 1'b0;  // it was taken last
reg f_taken = 1'b0;  // it is the current line: shown, and not released or flushed
reg [DEPTH_LOG2:0] f_ahead;  // lines before it
reg [1:0] f_taken_for = 2'd0;  // clocks, up to 3
reg f_line_last;
reg f_line_endless;
reg [AXES-1:0] f_line_directions;
reg [31:0] f_line_substeps;
reg [31:0] f_line_steps;
wire f_watch = !f_recording && !f_queued && !f_shown && f_choose && bus_write && select && f_index == 2'd0
               && write_line[DEPTH_LOG2-1:0] == f_slot;
wire f_is_next = f_queued && f_ahead == 0;
always @(posedge clk) begin
  if (f_watch) begin
    f_recording       <= 1'b1;
    f_line_last       <= bus_data[0];
    f_line_endless    <= bus_data[1];
    f_line_directions <= bus_data[8+:AXES];
  end
  if (f_recording && f_strobe) begin
    if (f_index == 2'd1) f_line_substeps <= bus_data;
    else f_line_steps <= bus_data;
  end
  if (f_recording && f_written) begin
    f_recording <= 1'b0;
    f_queued    <= 1'b1;
    f_ahead     <= f_lines - take;
  end
  if (f_queued && take) begin
    if (f_is_next) f_queued <= 1'b0;
    else f_ahead <= f_ahead - 1'b1;
  end
  if (take) {f_shown, f_taken} <= {2{f_is_next}};
  f_taken_for <= take ? 2'd0 : f_taken_for == 2'd3 ? 2'd3 : f_taken_for + 2'd1;
  if (release_line) f_taken <= 1'b0;
  if (rst || flush) {f_recording, f_queued, f_taken} <= 3'b000;
  if (rst) f_shown <= 1'b0;

  if (f_shown) begin
    flags_as_written : assert (last == f_line_last && endless == f_line_endless);
    substeps_as_written : assert ({2'b00, last_substep} == f_line_substeps - 32'd1);
  end
  if (f_taken && f_taken_for >= 2'd1) begin
    steps_as_written : assert ({2'b00, steps} == f_line_steps);
    directions_as_written : assert (directions == f_line_directions);
  end
end

wire [29:0] f_stored_last = f_line_substeps[29:0] - 30'd1;
wire [31:0] f_stored_substeps = {f_line_last, f_line_endless, f_stored_last};
always @(posedge clk)
  if (f_begun) begin
    assert (32'd0 + f_lines + f_current + f_to_come <= 1 << DEPTH_LOG2);
    if ($past(f_begun)) assert (room == f_free_q);
    assert (write_end == write_line + f_to_come);
    if (!f_writing) assert (f_to_come == 0);
    assert (f_lines == write_line - next_line);
    assert (has_place == f_current);
    if (f_current) assert (current_line == next_line[DEPTH_LOG2-1:0] - 1'b1);
    assert (index == 3'd1 << f_index && f_index <= 2'd2);
    assert (!(f_checking && f_writing));
    if (f_writing) assert (f_select);
    if (!f_checking && !f_writing) assert (f_index == 0);
    if (f_writing || f_checking) assert (checked == f_checked || f_writing);
    assert (f_index == 0 || (f_words != 0 || f_checking));
    if (f_checking && (f_words == 0 || !f_select)) assert (f_checked == 0 && f_index == 0);
    // the words to be written fit
    if (f_checking && f_select && !f_refused && refusal == VERDICT_OK && f_words != 0) begin
      assert (f_words == 3 * f_checked + f_index);
      assert (32'd0 + f_checked + (f_index != 0) <= f_free);
      if (f_index == 2'd2) assert (f_m != 32'd0 && f_m < F_M_LIMIT);
    end
    if (f_writing && !flush && f_since_write == 3'd0) assert (32'd0 + f_words + f_index == 3 * f_to_come);
    if (f_writing) assert ((f_words + f_index) % 3 == 0 && f_words != 0 && f_since_write == 3'd0);
    if (f_recording) assert (f_writing && f_index != 0 && write_line[DEPTH_LOG2-1:0] == f_slot && f_ahead == f_ahead);
    if (f_recording) assert (!f_queued && !f_shown);
    if (f_taken) assert (f_shown);
    if (f_shown) assert (!f_queued);
    if (f_recording) begin
      assert (write_last == f_line_last && write_endless == f_line_endless);
      assert (write_directions == f_line_directions);
    end
    if (f_recording && f_index == 2'd2)
      assert ((write_substeps ? {write_last, write_endless, difference[29:0]} : f_substep_word)
              == f_stored_substeps && f_line_substeps != 32'd0 && f_line_substeps < F_M_LIMIT && f_m == f_line_substeps);
    if (f_queued || f_taken) begin
      assert (f_substep_word == f_stored_substeps);
      assert (f_steps_word == {f_line_directions, f_line_steps[29:0]});
    end
    if (f_queued || f_shown) begin
      assert (f_line_substeps != 32'd0 && f_line_substeps < F_M_LIMIT && f_line_steps < F_M_LIMIT);
    end
    if (f_queued) assert (f_ahead < f_lines && f_slot == next_line[DEPTH_LOG2-1:0] + f_ahead[DEPTH_LOG2-1:0]);
    if (f_taken) assert (current_line == f_slot && f_current);
    if ($past(f_begun)) assert (load_substeps == (f_strobe_q && $past(select) && f_index == 2'd2));
    if ($past(f_begun)) assert (write_substeps == (load_substeps && $past(bus_write)));
    if (load_substeps && $past(f_begun)) assert (bus_data == f_m);
    if (f_index == 2'd2 && !load_substeps) assert (not_substeps == ~f_m[29:0]);
    if (f_index == 2'd1 || (f_index == 2'd0 && f_gap != 2'd0 && $past(f_begun))) assert (not_substeps == ~30'd0);
  end
