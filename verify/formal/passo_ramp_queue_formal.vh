// SPDX-License-Identifier: MIT
// Promises of the ramp queue; included at the end of passo_ramp_queue.v.

// --- Assumptions: the link. A frame is checked word by word; if no word is refused and it ends with a whole ramp, it
// may be written, with as many words. Data are stable from one clock before their strobe to one clock after it;
// `bus_msb` of checked data is valid in the strobe and the clock before.
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
reg [2:0] f_index = 3'd0;  // word of the ramp, 0 .. 4
reg [2:0] f_since_write = 3'd0;
(* anyseq *) reg f_go;
wire f_strobe = (bus_check | bus_write) & select;
wire f_last_index = f_index == 3'd4;
wire f_msb_right = bus_msb == 5'd0 ? bus_data <= 32'd1 : bus_data >> bus_msb == 32'd1;
wire f_good = f_checking && !f_refused && refusal == VERDICT_OK && f_index == 3'd0 && f_words != 8'd0;
always @(posedge clk) begin
  f_started  <= 1'b1;
  f_strobe_q <= (bus_check | bus_write) & ~rst;
  f_gap      <= bus_check | bus_write | bus_frame ? 2'd0 : f_gap == 2'd3 ? 2'd3 : f_gap + 2'd1;
  f_since_write <= bus_write | f_writing | (bus_frame & bus_commit) ? 3'd0 : f_since_write == 3'd7 ? 3'd7 : f_since_write + 3'd1;
  if (!f_started) ramp_queue_reset : assume (rst);
  if (bus_check || bus_write || bus_frame) ramp_queue_strobes_apart : assume (f_gap >= F_GAP);
  ramp_queue_one_strobe : assume (bus_check + bus_write + bus_frame <= 2'd1);
  if (bus_frame) ramp_queue_commits_good : assume (bus_commit == (f_good && f_go));
  if (bus_check || bus_write || f_strobe_q) ramp_queue_data_stand : assume ($stable(bus_data));
  if (bus_check) ramp_queue_msb : assume (f_msb_right && $past(f_msb_right));
  if (bus_check) ramp_queue_frame_has_begun : assume (f_checking);
  if (bus_write) ramp_queue_writes_good : assume (f_writing == select);
  if (f_checking && f_words != 8'd0) ramp_queue_select_stands : assume (select == f_select);
  if (f_writing) ramp_queue_writes_all : assume (!bus_frame || f_words == 8'd0);
  if (f_strobe) f_index <= f_last_index ? 3'd0 : f_index + 3'd1;
  if (refusal != VERDICT_OK) f_refused <= 1'b1;
  if (bus_check) begin
    f_words  <= f_words == 8'd255 ? 8'd255 : f_words + 8'd1;
    f_select <= select;
  end
  if (bus_write && f_writing) f_words <= f_words - 8'd1;
  if (bus_write && f_writing && f_words == 8'd1) f_writing <= 1'b0;
  if (bus_frame) begin
    f_index    <= 3'd0;
    f_refused  <= 1'b0;
    f_checking <= !bus_commit;
    f_writing  <= bus_commit && f_select;
    if (!bus_commit) f_words <= 8'd0;
  end
  if (rst) begin
    {f_checking, f_writing, f_refused} <= 3'b000;

    f_index <= 3'd0;
    f_words <= 8'd0;
  end
  // ramp and motion: a ramp is taken only if it is there, and not a NOW ramp before take_now
  ramp_queue_blocked : assume (blocked == flush);
  if (take)
    ramp_queue_takes_the_oldest : assume (f_ramps != 0 && !take_now && !(now_pending && f_now_ahead == 0));
  if (take_now) ramp_queue_takes_now_when_pending : assume (now_pending);
  // a channel stays stopped while a frame is written: only another frame can clear it
  if ($past(flush && !rst) && f_since_write != 3'd7) ramp_queue_stays_flushed : assume (flush || rst);
end

// --- Reference queue
reg [DEPTH_LOG2:0] f_ramps = 0;
reg [DEPTH_LOG2:0] f_ramps_q = 0;
reg [DEPTH_LOG2:0] f_to_come = 0;  // ramps of an accepted frame, still to be written
reg [DEPTH_LOG2:0] f_free_q = 1 << DEPTH_LOG2;  // a clock ago
reg                f_flush_q = 1'b0;
reg [DEPTH_LOG2:0] f_now_ahead = 0;  // ramps before the last NOW
reg                f_now = 1'b0;
reg                f_is_now = 1'b0;
reg                f_written = 1'b0;  // a ramp is whole one clock after its last strobe
reg [DEPTH_LOG2:0] f_checked = 0;  // ramps of this frame
wire [DEPTH_LOG2:0] f_pops = take_now ? f_now_ahead : {{DEPTH_LOG2{1'b0}}, take};
always @(posedge clk) begin
  f_written <= bus_write & select & f_last_index & ~rst;
  f_ramps_q <= rst ? 0 : f_ramps;
  f_free_q  <= rst ? 1 << DEPTH_LOG2 : (1 << DEPTH_LOG2) - f_ramps - f_to_come;
  f_flush_q <= flush & ~rst;
  if (f_written) f_to_come <= f_to_come - 1'b1;
  if (bus_frame && bus_commit) f_to_come <= f_checked;
  f_ramps   <= f_ramps + f_written - f_pops;
  if (f_strobe && f_index == 3'd0) f_is_now <= bus_data[1];
  f_now_ahead <= f_now_ahead - f_pops;
  if (take_now) f_now <= 1'b0;
  if (f_written && f_is_now) begin
    f_now       <= 1'b1;
    f_now_ahead <= f_ramps - f_pops;
  end
  if (bus_check && select && f_last_index) f_checked <= f_checked + 1'b1;
  if (bus_frame || rst) f_checked <= 0;
  if (rst || flush) f_to_come <= 0;
  if (rst || flush) f_ramps <= rst ? 0 : f_written;
  if (rst || flush) f_now <= 1'b0;
end

always @(posedge clk)
  if (f_begun) begin
    if ($past(f_begun) && !f_flush_q && !$past(f_flush_q)) room_is_what_is_free : assert (room == f_free_q);
    if ($past(f_begun) && f_flush_q && $past(f_flush_q)) all_free_when_flushed : assert (room == 1 << DEPTH_LOG2);
    valid_if_there : assert (valid == (f_ramps_q != 0));
    now_told : assert (now_pending == f_now);
    needs_motion_told : assert (needs_motion == (bus_check && select && f_index == 3'd0 && bus_data[1]));
    if (incomplete != (f_index != 3'd0)) incomplete_told : assert (bus_frame || f_strobe_q);
  end

// --- Refusals
reg f_is_max;
wire f_bad = f_index == 3'd0 ? (bus_data[15:0] & 16'hFFC8) != 16'd0 || bus_data[31:16] > 16'h8000 :
             f_index == 3'd1 ? f_is_max && bus_data != 32'd0 :
             f_index == 3'd3 ? bus_data[31:16] != 16'd0 : 1'b0;
always @(posedge clk) begin
  if (f_strobe && f_index == 3'd0) f_is_max <= bus_data[31:16] == 16'h8000;
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

// --- Any one half-word of any one ramp is tracked from its first word on
(* anyconst *) reg [DEPTH_LOG2-1:0] f_slot;  // its place
(* anyconst *) reg [3:0] f_half;  // 0 .. 9
(* anyseq *) reg f_choose;
(* keep *) wire [DEPTH_LOG2+3:0] f_memory_address = {f_slot, f_half};
(* keep *) wire [15:0] f_memory_word;
reg f_recording = 1'b0;
reg f_queued = 1'b0;
reg [DEPTH_LOG2:0] f_ahead;  // ramps before it
reg f_mirror;
reg [15:0] f_word;  // the half-word as the ramp needs it
reg [2:0] f_shown = 3'b000;  // one, two and three clocks ago: the index was that of the tracked one
reg [15:0] f_shown_word;  // what it was then
reg [15:0] f_shown_word_q;
reg [15:0] f_shown_word_qq;
wire f_watch = !f_recording && !f_queued && f_choose && bus_write && select && f_index == 3'd0
               && write_ramp[DEPTH_LOG2-1:0] == f_slot;
wire [15:0] f_data = f_half[0] ? bus_data[15:0] : bus_data[31:16];
wire f_inverted = f_index == 3'd2 || (f_mirror && f_index >= 3'd3);  // T always, du if mirrored
always @(posedge clk) begin
  ramp_queue_any_half : assume (f_half <= 4'd9);
  if (f_watch) begin
    f_recording <= 1'b1;
    f_mirror    <= bus_data[2];
  end
  if ((f_watch || f_recording) && f_strobe && f_index == f_half[3:1]) f_word <= f_data ^ {16{f_inverted & ~f_watch}};
  if (f_recording && f_written) begin
    f_recording <= 1'b0;
    f_queued    <= 1'b1;
    f_ahead     <= f_ramps - f_pops;
  end
  if (f_queued) begin
    f_ahead <= f_ahead - f_pops;
    if (f_ahead < f_pops) f_queued <= 1'b0;
  end
  f_shown <= {f_shown[1:0], f_queued && f_ahead == 0 && half_index == f_half};
  f_shown_word <= f_word;
  f_shown_word_q <= f_shown_word;
  f_shown_word_qq <= f_shown_word_q;
  if (rst || flush) {f_recording, f_queued} <= 2'b00;
  if (rst) f_shown <= 3'b000;
  if (f_shown[2]) half_as_written : assert (half == f_shown_word_qq);
end

always @(posedge clk)
  if (f_begun) begin
    assert (32'd0 + f_ramps + f_to_come <= 1 << DEPTH_LOG2);
    assert (write_end == write_ramp + f_to_come || f_flush_q);
    if (!f_writing && !f_written) assert (f_to_come == 0);
    if (f_flush_q && !flush) assert (f_to_come == 0 && write_end == write_ramp && !f_writing && !f_written);
    assert (f_ramps == write_ramp - read_ramp);
    assert (index == f_index || f_strobe_q && index == (f_index == 0 ? 4 : f_index - 1) || f_index == 0);
    assert (f_index <= 3'd4);
    assert (!(f_checking && f_writing));
    if (f_writing) assert (f_select);
    if (!f_checking && !f_writing) assert (f_index == 0);
    if (f_checking) assert (checked == f_checked && index == f_index);
    if (f_checking && (f_words == 0 || !f_select)) assert (f_checked == 0 && f_index == 0);
    if (f_checking && f_select && !f_refused && refusal == VERDICT_OK && f_words != 0) begin
      assert (f_words == 5 * f_checked + f_index);
      assert (32'd0 + f_checked + (f_index != 0) <= (1 << DEPTH_LOG2) - f_ramps);
    end
    if (f_writing && !flush) assert (32'd0 + f_words + f_index + (f_written ? 5 : 0) == 5 * f_to_come);
    if (f_writing) assert ((f_words + f_index) % 5 == 0 && f_words != 0 && f_since_write == 3'd0);
    if (f_written) assert (f_since_write <= 3'd1 && (flush || f_to_come != 0));
    if (f_written) assert (f_ramps < 1 << DEPTH_LOG2 && f_index == 0 && f_strobe_q);
    if (f_now) assert (f_now_ahead < f_ramps && now_ramp == read_ramp + f_now_ahead);
    if (write_low) assert (f_strobe_q && index == (f_index == 0 ? 4 : f_index - 1));
    assert (write_low == (f_strobe_q && $past(bus_write && select)));
    if (!write_low && !$past(bus_frame)) assert (index == f_index);
    assert (f_written == (write_low && index == 4));
    if (f_writing || f_written) assert (f_index == 0 && !f_written || is_now == f_is_now);
    if (f_index != 0 || f_written) assert (is_now == f_is_now);
    if (f_index == 1) assert (velocity_is_max == f_is_max);
    if (f_recording) assert (!f_queued && write_ramp[DEPTH_LOG2-1:0] == f_slot && (f_writing || f_written)
                             && (f_index != 0 || f_written) && is_mirror == f_mirror);
    if (f_recording && (f_written || f_index > f_half[3:1] + 1 || (f_index > f_half[3:1] && !write_low)))
      assert (f_memory_word == f_word || (f_written && f_half[3:1] == 4));
    if (f_recording && write_low && f_half[3:1] == index && !f_half[0]) assert (f_memory_word == f_word);
    if (f_recording && write_low && f_half[3:1] == index && f_half[0]) assert (f_word == bus_data[15:0] ^ {16{invert}});
    if (f_shown[1]) assert (word == f_shown_word_q);
    if (write_low) assert (invert == (index == 3'd2 || (is_mirror && index >= 3'd3)));
    if (f_queued) begin
      assert (f_memory_word == f_word);
      assert (f_ahead < f_ramps && f_slot == read_ramp[DEPTH_LOG2-1:0] + f_ahead[DEPTH_LOG2-1:0]);
    end
  end
