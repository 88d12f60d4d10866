// SPDX-License-Identifier: MIT
// Promises of the link; included at the end of passo_link.v.

(* anyconst *) reg [5:0] f_watch;  // any one word of the payload

`include "passo_link_schedule.vh"

// --- Signals of the blocks
(* keep *) wire [7:0] f_kept_length;
(* keep *) wire [7:0] f_index;
(* keep *) wire f_frame_waits;
(* keep *) wire f_begin_read;
(* keep *) wire f_begin_rotate;
(* keep *) wire f_begin_rest;
(* keep *) wire f_in_crc_wrong;
(* keep *) wire f_in_answer_due;
(* keep *) wire f_in_answer_came;
(* keep *) wire f_in_objects;
(* keep *) wire f_sequence_known;
(* keep *) wire f_answered;
(* keep *) wire [1:0] f_counter;
(* keep *) wire f_in_header_ok;
(* keep *) wire [3:0] f_in_header_verdict;
(* keep *) wire f_in_header_is_known;
(* keep *) wire f_in_header_fits;
(* keep *) wire f_in_header_repeats;

// --- Assumptions: passo_spi. Half-words are at least 60 clocks apart, and as far from the start of their frame.
// `frame_start` and `frame_end` alternate; after a reset either may come first. The last half-word of a frame may
// come with frame_end or one clock later, but before the next frame, as chip select is high for two clocks. After a
// reset the halves of a word begun before it may still come.
localparam [6:0] F_GAP = 7'd60;
localparam [5:0] F_COMMIT = 6'd35;
reg       f_started = 1'b0;
wire      f_begun = ~rst;
(* anyseq *) reg f_select;
reg       f_selected;
reg       f_ended = 1'b0;  // a frame, in the clock before
reg       f_framed = 1'b0;  // a frame has begun since reset
reg       f_upper = 1'b0;  // the upper half of a word has come
reg [6:0] f_gap = F_GAP;  // clocks since the last half-word or the start of the frame, up to 60
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) link_reset : assume (rst);
  if (frame_start) link_starts_apart : assume (!f_selected && !half_valid);
  if (frame_end) link_ends_once : assume (f_selected);
  if (half_valid) link_halves_in_a_frame : assume (f_selected || f_ended);
  f_ended <= frame_end;
  if (frame_start) {f_selected, f_framed} <= 2'b11;
  if (frame_end) f_selected <= 1'b0;
  if (half_valid && f_framed) link_halves_in_turn : assume (half_low == f_upper);
  if (half_valid) link_halves_apart : assume (f_gap >= F_GAP);
  if (half_valid) f_upper <= !half_low;
  if (frame_start) f_upper <= 1'b0;
  if (rst) {f_selected, f_framed} <= {f_select, 1'b0};
  f_gap <= frame_start || half_valid ? 7'd0 : f_gap >= F_GAP ? F_GAP : f_gap + 7'd1;
end

// --- The frame being received: its words, and the answers to them
(* keep *) wire [5:0] f_place = f_watch;
(* keep *) wire [31:0] f_memory_header;
(* keep *) wire [31:0] f_memory_word;
(* keep *) wire [31:0] f_held;
reg  [31:0] f_header;
reg  [31:0] f_word;
reg  [ 8:0] f_words = 9'd0;  // received, the header included; up to 511
reg  [ 8:0] f_checks = 9'd0;
reg         f_objection = 1'b0;
reg         f_asked = 1'b0;  // a check strobe was in the clock before
reg         f_incomplete;  // when the frame was judged
reg         f_busy_then;
reg  [ 7:0] f_last;  // sequence number of the last frame executed
reg         f_any = 1'b0;  // there is one
wire [ 7:0] f_length = f_header[19:12];
wire        f_is_push = f_header[31:28] == OPERATION_PUSH;
wire        f_is_write = f_header[31:28] == OPERATION_WRITE;
wire        f_word_ends = half_valid & half_low;
wire        f_judged = in_crc && count == COUNT_ACT - 7'd1;
wire        f_good = f_words == {1'b0, f_length} + 9'd2 && !f_in_crc_wrong && !f_objection && !f_incomplete
                     && f_checks == {1'b0, f_length} && (f_is_push || f_is_write)
                     && f_length != 8'd0 && f_length <= 8'd60 && !(f_any && f_header[27:20] == f_last);
always @(posedge clk) begin
  f_asked <= bus_check & ~rst;
  if (half_valid && f_words == 9'd0) begin
    if (half_low) f_header[15:0] <= half;
    else f_header[31:16] <= half;
  end
  if (half_valid && f_words == {3'd0, f_watch} + 9'd1) begin
    if (half_low) f_word[15:0] <= half;
    else f_word[31:16] <= half;
  end
  if (f_word_ends && f_words != 9'd511) f_words <= f_words + 9'd1;
  if (bus_check && f_words != 9'd0) f_checks <= f_checks + 9'd1;
  if (f_asked && f_words != 9'd0 && (!bus_claim || bus_refusal != VERDICT_OK)) f_objection <= 1'b1;
  if (f_judged) {f_incomplete, f_busy_then} <= {bus_incomplete, bus_busy};
  if (frame_start) begin
    f_words     <= 9'd0;
    f_checks    <= 9'd0;
    f_objection <= 1'b0;
  end
end

// --- What is executed: the second pass of a frame
reg        f_runs = 1'b0;
reg [ 7:0] f_run_length;
reg [ 7:0] f_written;  // words
reg [11:0] f_address;
reg        f_run_push;
reg [31:0] f_run_word;
wire       f_starts = f_begun && in_ack && act && verdict_ok;
reg [ 5:0] f_commit_age = 6'd0;  // clocks of bus_commit before this one, up to 63
reg        f_commits = 1'b0;  // since a frame was judged
reg        f_frame_told = 1'b0;  // bus_frame has come for the frame being received
reg [ 2:0] f_since_strobe = 3'd7;  // clocks, up to 7
always @(posedge clk) begin
  if (f_starts) begin
    only_good_frames : assert (f_good && verdict == VERDICT_OK);  // as acknowledged
    only_if_not_busy : assert (!f_busy_then);
    f_runs       <= 1'b1;
    f_run_length <= f_length;
    f_run_word   <= f_word;
    f_run_push   <= f_is_push;
    f_address    <= f_header[11:0];
    f_written    <= 8'd0;
    f_last       <= f_header[27:20];
    f_any        <= 1'b1;
  end
  if (bus_write && f_begun) begin
    writes_only_what_runs : assert (f_runs && f_written < f_run_length);
    address_as_sent : assert (bus_address == f_address + (f_run_push ? 12'd0 : {4'd0, f_written}));
    push_as_sent : assert (bus_push == f_run_push);
    if (f_written == {2'd0, f_watch}) word_as_sent : assert (bus_data == f_run_word);
    f_written <= f_written + 8'd1;
  end
  if (f_begun && !in_replay && !f_starts && f_runs) begin
    every_word_once : assert (f_written + {7'd0, bus_write} == f_run_length);
    f_runs <= bus_write;
  end
  if (f_begun && f_any) last_sequence_told : assert (last_sequence == f_last || f_starts);
  if (rst) {f_runs, f_any} <= 2'b00;
  if (f_begun && bus_check && f_words != 9'd0 && f_checks == {3'd0, f_watch} && f_length <= 8'd60) check_as_sent : assert (bus_data == f_word);
  if (f_begun && (bus_check || bus_write))
    stands_before_strobe : assert ({bus_address, bus_data} == $past({bus_address, bus_data}));
  if (f_begun && (bus_check || bus_write))
    address_stands_before_strobe : assert ({bus_push, bus_address} == $past({bus_push, bus_address}, 2));
  if (f_begun && bus_check) stands_before_check : assert ({bus_address, bus_data} == $past({bus_address, bus_data}, 2));
  if (f_begun && $past(f_begun && (bus_check || bus_write))) stands_after_strobe : assert (bus_data == $past(bus_data));
end

// --- The commit, and the start of both passes
always @(posedge clk) begin
  f_commit_age   <= !bus_commit || rst ? 6'd0 : f_commit_age == 6'd63 ? 6'd63 : f_commit_age + 6'd1;
  f_commits      <= (f_judged | f_commits) & bus_commit & ~rst;
  f_frame_told   <= ((bus_frame & ~bus_commit) | f_frame_told) & ~frame_start & ~rst;
  f_since_strobe <= bus_check || bus_write || bus_frame ? 3'd0 : f_since_strobe == 3'd7 ? 3'd7 : f_since_strobe + 3'd1;
  if (f_begun) begin
    if (f_judged && !is_read) commits_before_the_verdict : assert (bus_commit && f_commit_age >= F_COMMIT);
    if (f_starts) commits_until_it_runs : assert (f_commits && bus_commit);
    if (f_runs) commits_while_it_runs : assert (f_commits && bus_commit);
    if ($past(f_starts)) accepted_is_told : assert (bus_frame && bus_commit);
    else commits_only_accepted : assert (!bus_frame || !bus_commit);
    if (bus_check) checks_what_has_begun : assert (f_frame_told);
    if (bus_check) checks_before_commit : assert (!bus_commit);
    strobes_one_at_a_time : assert (bus_check + bus_write + bus_frame <= 2'd1);
    if (bus_check || bus_write || bus_frame) strobes_apart : assert (f_since_strobe >= 3'd3);
    if (f_starts) frames_apart : assert (f_since_strobe == 3'd7);
  end
end

`ifdef ROTATE
// --- What the payload buffer requires of rotating words
reg       f_rotate_q = 1'b0;
reg       f_load_q = 1'b0;
reg [4:0] f_bit_index_q;
reg       f_count_q;
reg [1:0] f_counter_q;
wire      f_first_rotation = rotate & ~f_rotate_q;
always @(posedge clk) begin
  f_rotate_q    <= rotate & ~rst;
  f_load_q    <= load & ~rst;
  f_bit_index_q   <= count[4:0];
  f_count_q   <= in_count;
  f_counter_q <= f_counter;
  if (f_begun && rotate) begin
    rotates_whole :
    assert (!load && !f_load_q && count[4:0] == (f_first_rotation ? 5'd0 : f_bit_index_q + 5'd1) && (f_first_rotation || f_bit_index_q != 5'd31));
    if (!f_first_rotation || in_count) counts_as_told : assert (in_count == f_count_q && f_counter == f_counter_q);
    if (f_first_rotation && in_count) counts_after_31 : assert (f_bit_index_q == 5'd31);
  end
end
`endif

wire [7:0] f_states = {in_header, in_payload, in_crc, in_ack, in_replay, in_read, in_sum, in_count};
wire f_idle = f_states == 8'd0;
wire f_busy = !f_begin_rest && (begin_load || (count >= COUNT_LOAD && count <= COUNT_ACT));  // a word is in progress
wire f_loaded = !f_begin_rest && !begin_load && count >= COUNT_LOADED;
wire f_rotates = !f_begin_rest && !begin_load && count >= COUNT_ROTATE && count <= COUNT_ACT;
wire f_receives = in_header || in_payload || in_crc;
wire f_has_payload = (f_is_push || f_is_write || f_header[31:28] != OPERATION_READ) && f_length != 8'd0;
wire f_repeats = f_any && f_header[27:20] == f_last;
wire f_header_fits = (f_is_push || f_is_write) && f_length != 8'd0 && f_length <= 8'd60 && !f_repeats;
always @(posedge clk)
  if (f_begun) begin
    assert ((f_states & (f_states - 8'd1)) == 8'd0);
    if (!f_idle || f_frame_waits) assert (f_framed);
    // the commit: from the clock after the CRC word begins to be handled
    if (in_crc && !begin_load && !f_begin_rest && count <= COUNT_ACT)
      assert (bus_commit == (count > COUNT_LOAD) && (!bus_commit || {1'b0, f_commit_age} == count - 7'd29));
    if (in_ack && verdict_ok) assert (bus_commit && f_commits && !f_busy_then);
    if (in_crc && count == COUNT_ACT && !begin_load) assert (f_commits);
    if (in_crc && count == COUNT_ACT && !begin_load) assert (!executes || !f_busy_then);
    if (in_replay || f_runs) assert (bus_commit && f_commits);
    if (bus_frame) assert (!bus_check && !bus_write && (count == COUNT_ACT + 7'd1 || f_idle));
    if ((f_receives || in_ack) && !f_begin_rest && !begin_load && count >= COUNT_LOAD && count <= COUNT_ACT)
      assert (f_since_strobe == 3'd7 || {4'd0, f_since_strobe} >= count - COUNT_LOAD);
    if (in_replay && count != COUNT_LOAD && count <= COUNT_LOADED) assert ({4'd0, f_since_strobe} >= count - 7'd29);
    if (bus_write) assert (f_since_strobe >= 3'd3);
    if (in_payload && !bus_frame) assert (f_frame_told);
    if (bus_check) assert (f_frame_told && f_since_strobe == 3'd7);
    assert (f_gap <= F_GAP);
    assert (f_sequence_known == f_any);
    if (f_any) assert (last_sequence == f_last);
    assert (!f_frame_waits || in_replay || in_count || in_header);
    assert (!f_frame_waits || f_selected && f_words == 9'd0 && f_checks == 9'd0 && !f_objection);
    assert (f_in_answer_due == f_asked);
    // the clocks of each state
    assert (count <= COUNT_REST);
    if (act) assert (count == COUNT_ACT && !f_idle);
    if (!f_idle && !f_begin_rest) assert (act == (count == COUNT_ACT));
    if (!f_idle && !in_header) assert (!f_begin_rest);
    if (f_begin_rest == 1'b0) begin
      if (begin_load) assert (f_receives || in_ack || in_replay || in_count);
      assert (!f_begin_read || in_read);
      assert (!f_begin_rotate || in_sum);
      if (f_idle) assert (count > COUNT_ACT);
      if (f_receives) assert (count >= COUNT_LOAD);
      if (in_ack || in_count) assert (begin_load || (count >= COUNT_LOAD && count <= COUNT_ACT));
      if (in_sum) assert (f_begin_rotate || (count >= COUNT_ROTATE && count <= COUNT_ACT));
      if (in_read) assert (count >= COUNT_READ);
    end
    assert (!f_answered || (in_read && count == COUNT_LOADED && !f_begin_read));
    if (in_read && load_ends) assert (count == COUNT_LOADED - 7'd1 && !f_begin_read);
    if ((f_receives || in_ack) && f_busy) assert (!bus_check && !f_in_answer_due && !f_in_answer_came);
    // no word ends while one is fetched for the reply
    if (in_read && (f_begin_read || count <= COUNT_ACT)) assert (!f_upper || (!f_begin_read && f_gap < count - COUNT_READ));
    if (in_read || in_sum || in_ack) assert (f_selected);
    // the verdict so far
    if (!f_idle && !in_header && !in_sum) assert (verdict_ok == (verdict == VERDICT_OK));
    // receiving
    if (f_receives) begin
      assert (f_selected);
      if (f_busy) assert (!f_upper && f_gap == (begin_load ? 7'd0 : count - 7'd27));
      if ((in_payload || in_crc) && count <= COUNT_ACT + 7'd1) assert (begin_load || (!f_upper && f_gap == count - 7'd27));
    end
    if (in_header) begin
      assert (f_words == {8'd0, f_busy} && f_checks == 9'd0 && !f_objection);
      if (f_words == 9'd1) assert (f_memory_header == f_header);
      if (f_rotates) begin
        assert (header_is_read == (f_header[31:28] == OPERATION_READ));
        assert (f_in_header_is_known == (header_is_read || f_is_push || f_is_write));
        assert (header_is_empty == (f_length == 8'd0) && f_in_header_fits == (f_length <= 8'd60));
        assert (f_in_header_repeats == f_repeats);
      end
      if (f_rotates && count > COUNT_ROTATE) begin
        assert (f_in_header_ok == (f_in_header_verdict == VERDICT_OK));
        assert (!f_in_header_ok || (header_is_read ? f_length != 8'd0 && f_length <= 8'd60 : f_header_fits));
      end
    end
    if (f_words == 9'd0 && f_upper && f_selected && (in_header || f_frame_waits))
      assert (f_memory_header[31:16] == f_header[31:16]);
    if (in_count && f_frame_waits) assert (!begin_load && !f_upper && f_gap <= count - COUNT_LOAD);
    if ((in_header || (in_ack && verdict_ok)) && f_loaded && f_busy) assert (f_held == f_header);
    if (in_payload || in_crc || in_ack || in_read) begin
      assert (f_memory_header == f_header && f_words != 9'd0);
      assert (f_kept_length == f_length && bus_push == f_is_push && is_read == (f_header[31:28] == OPERATION_READ));
    end
    if ((in_payload || in_crc || in_ack) && verdict_ok)
      assert (is_read ? f_length != 8'd0 && f_length <= 8'd60 :
                        f_header_fits && (!f_objection || (f_in_answer_came && f_in_objects)));
    if (in_payload) begin
      assert (f_has_payload);
      assert (f_words == {1'b0, f_index} + 9'd1 + {8'd0, f_busy});
      assert (f_checks + {8'd0, bus_check} == {1'b0, f_index});
      assert (f_index < f_kept_length || (f_index == f_kept_length && !f_busy && (count == COUNT_ACT + 7'd1 || all_words)));
      if (all_words) assert (f_index == f_kept_length && count == COUNT_REST && !bus_check);
    end
    if (bus_check && f_words != 9'd0) assert ((count == COUNT_ACT + 7'd1 && in_payload) || f_idle);
    if (in_crc && f_has_payload) begin
      assert (f_words == {1'b0, f_kept_length} + 9'd1 + {8'd0, f_busy} && f_index == f_kept_length);
      assert (f_checks == {1'b0, f_kept_length} && !bus_check);
    end
    if (in_ack && verdict_ok) begin
      assert (f_words == {1'b0, f_length} + 9'd2 && !f_in_crc_wrong && !f_incomplete && f_checks == {1'b0, f_length} && !is_read);
      if (begin_load) assert (!f_upper && f_gap == 7'd39);
      else assert (f_upper ? count > 7'd48 && f_gap < count - 7'd48 : f_gap == (count > 7'd48 ? 7'd60 : count + 7'd12));
    end
    // the payload in its place
    if ((in_payload || in_crc || (in_ack && verdict_ok)) && f_length <= 8'd60 && !is_read) begin
      if (f_words > {3'd0, f_watch} + 9'd1 && {2'd0, f_watch} < f_length) assert (f_memory_word == f_word);
      if (f_words == {3'd0, f_watch} + 9'd1 && f_upper && in_payload) assert (f_memory_word[31:16] == f_word[31:16]);
      if (in_payload && f_loaded && f_busy && f_index == {2'd0, f_watch}) assert (f_held == f_word);
      if (in_payload && count == COUNT_ACT + 7'd1 && f_index == {2'd0, f_watch} + 8'd1) assert (f_held == f_word);
    end
    // executing: load in 28 .. 31, the strobe in the next 28
    assert (!bus_write || in_replay);
    if (in_replay) begin
      assert (f_runs && f_run_length == f_kept_length && f_kept_length != 8'd0 && f_kept_length <= 8'd60 && bus_push == f_run_push);
      if (count == COUNT_ACT + 7'd1) assert (begin_load && f_index == 8'd0 && !bus_write);
      else assert (count >= COUNT_LOAD && begin_load == (count == COUNT_LOADED) && count <= COUNT_LOADED);
      assert (load_ends == (count == COUNT_LOADED - 7'd1));
      assert (bus_write == (count == COUNT_LOAD && f_index != 8'd0));
      assert (f_index == f_written + {7'd0, bus_write || count == COUNT_LOADED});
      assert (f_index < f_kept_length || (f_index == f_kept_length && (bus_write || count == COUNT_LOADED)));
      assert (all_words == (f_index == f_kept_length && bus_write));
      assert (bus_address == f_address + (f_run_push ? 12'd0 : {4'd0, f_written}));
      if ({2'd0, f_watch} < f_kept_length) assert (f_memory_word == f_run_word);
      if ((count == COUNT_LOADED || bus_write) && f_index == {2'd0, f_watch} + 8'd1) assert (f_held == f_run_word);
      if (f_words == 9'd0 && f_selected && f_upper) assert (f_memory_header[31:16] == f_header[31:16]);
      assert (f_frame_waits || f_words != 9'd0 || !f_selected);
    end
    if (f_runs && !in_replay) assert (f_written == f_run_length);
  end
