// SPDX-License-Identifier: MIT
// What the link promises; included at the end of passo_link.

(* anyconst *) reg [5:0] f_watch;  // one word of the payload, any one

// --- Assumptions: chip select and words as passo_spi gives them. Half words are at least 60 clocks apart.
`ifdef SMALL
localparam [6:0] F_GAP = 7'd8;  // the search turns a word in one clock
localparam [6:0] F_GAP_LOW = 7'd1;
`else
localparam [6:0] F_GAP = 7'd60;
localparam [6:0] F_GAP_LOW = 7'd60;
`endif
reg       f_begun = 1'b0;
reg       f_selected = 1'b0;
reg       f_upper = 1'b0;  // the upper half of a word has come
reg [6:0] f_gap = 7'd0;  // clocks since the last half word or the start of the frame, up to 60
always @(posedge clk) begin
  f_begun <= 1'b1;
  assume (rst == !f_begun);
  if (rst) assume (!frame_start && !frame_end && !half_valid);
  assume (frame_start + frame_end + half_valid <= 2'd1);
  if (frame_start) assume (!f_selected);
  if (frame_end || half_valid) assume (f_selected);
  if (frame_start) f_selected <= 1'b1;
  if (frame_end) f_selected <= 1'b0;
  if (half_valid) assume (half_low == f_upper && f_gap >= (half_low ? F_GAP_LOW : F_GAP));
  if (half_valid) f_upper <= !half_low;
  if (frame_start) f_upper <= 1'b0;
`ifdef SMALL
  // a few numbers are enough to find a bug: operations 0 .. 3, sequence 0 .. 1, length 0 .. 2, address 0 .. 3
  if (half_valid && !half_low) assume ((half & 16'hCFEF) == 16'd0);
  if (half_valid && half_low) assume ((half & 16'hCFFC) == 16'd0 && half[13:12] != 2'd3);
  assume (f_watch == 6'd0 && !(half_valid && step == STEP_ACK));
`endif
  f_gap <= frame_start || half_valid ? 7'd0 : f_gap == F_GAP ? F_GAP : f_gap + 7'd1;
end

// --- The frame that is being received: its words, and what was said of them
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
reg         f_incomplete;  // when the CRC had turned
reg  [ 7:0] f_last;  // sequence number of the last frame that was executed
reg         f_any = 1'b0;  // there is one
wire [ 7:0] f_length = f_header[19:12];
wire        f_is_push = f_header[31:28] == OPERATION_PUSH;
wire        f_is_write = f_header[31:28] == OPERATION_WRITE;
wire        f_word_ends = half_valid & half_low;
wire        f_good = f_words == {1'b0, f_length} + 9'd2 && !crc_wrong && !f_objection && !f_incomplete
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
  if (step == STEP_CRC && count == COUNT_ACT - 6'd1) f_incomplete <= bus_incomplete;
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
wire       f_starts = f_begun && step == STEP_ACK && act && verdict == VERDICT_OK;
always @(posedge clk) begin
  if (f_starts) begin
    only_good_frames : assert (f_good);
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
  if (f_begun && step != STEP_REPLAY && !f_starts && f_runs) begin
    every_word_once : assert (f_written + {7'd0, bus_write} == f_run_length);
    f_runs <= bus_write;
  end
  if (f_begun && f_any) last_sequence_told : assert (last_sequence == f_last || f_starts);
  if (rst) {f_runs, f_any} <= 2'b00;
  if (f_begun && bus_check && f_words != 9'd0 && f_checks == {3'd0, f_watch} && f_length <= 8'd60) check_as_sent : assert (bus_data == f_word);
  if (f_begun && (bus_check || bus_write))
    stands_before_strobe : assert ({bus_address, bus_data} == $past({bus_address, bus_data}));
  if (f_begun && bus_check) stands_before_check : assert ({bus_address, bus_data} == $past({bus_address, bus_data}, 2));
  if (f_begun && $past(f_begun && (bus_check || bus_write))) stands_after_strobe : assert (bus_data == $past(bus_data));
end

`ifdef INVARIANTS
wire f_busy = count >= COUNT_LOAD || count <= COUNT_ACT;  // a word is being handled
wire [6:0] f_c = {count <= COUNT_ACT, count};
wire f_loaded = count >= COUNT_LOADED || count <= COUNT_ACT;
wire f_receives = step == STEP_HEADER || step == STEP_PAYLOAD || step == STEP_CRC;
wire f_has_payload = (f_is_push || f_is_write || f_header[31:28] != OPERATION_READ) && f_length != 8'd0;
wire f_header_fits = (f_is_push || f_is_write) && f_length != 8'd0 && f_length <= 8'd60 && !(f_any && f_header[27:20] == f_last);
always @(posedge clk)
  if (f_begun) begin
    assert (step <= STEP_COUNT);
    assert (f_gap <= F_GAP);
    assert (sequence_known == f_any);
    if (f_any) assert (last_sequence == f_last);
    assert (!frame_waits || step == STEP_REPLAY || step == STEP_COUNT || step == STEP_HEADER);
    if (frame_waits) assert (f_selected && f_words == 9'd0 && f_checks == 9'd0 && !f_objection);
    assert (answer_due == f_asked);
    assert (act == (count == COUNT_ACT) || (act && step == STEP_IDLE && count == COUNT_REST));
    if (step == STEP_IDLE) assert (count > COUNT_ACT && count <= COUNT_REST);
    if ((f_receives || step == STEP_ACK) && f_busy) assert (!bus_check && !answer_due && !answer_came);
    if (f_receives) assert (count <= COUNT_REST || count >= COUNT_LOAD);
    // no word ends while one is fetched for the reply
    if (step == STEP_READ) assert (count <= COUNT_REST || count >= COUNT_READ);
    if (step == STEP_READ && (count >= COUNT_READ || count <= COUNT_ACT)) assert (!f_upper || f_gap < f_c - {1'b0, COUNT_READ});
    if (step == STEP_READ || step == STEP_SUM || step == STEP_ACK) assert (f_selected);
    // receiving
    if (f_receives) begin
      assert (f_selected);
      if (f_busy) assert (!f_upper && f_gap == f_c - 7'd28);
    end
    if (step == STEP_HEADER) begin
      assert (f_words == {8'd0, f_busy} && f_checks == 9'd0 && !f_objection);
      if (f_words == 9'd1) assert (f_memory_header == f_header);
    end
    if (f_words == 9'd0 && f_upper && f_selected && (step == STEP_HEADER || frame_waits))
      assert (f_memory_header[31:16] == f_header[31:16]);
    if (step == STEP_COUNT) assert (f_busy);
    if (step == STEP_COUNT && frame_waits)
      assert (!f_upper && f_gap < f_c - 7'd28);
    if ((step == STEP_HEADER || (step == STEP_ACK && verdict == VERDICT_OK)) && f_loaded) assert (f_held == f_header);
    if (step == STEP_PAYLOAD || step == STEP_CRC || step == STEP_ACK || step == STEP_READ) begin
      assert (f_memory_header == f_header && f_words != 9'd0);
      assert (length == f_length && bus_push == f_is_push && is_read == (f_header[31:28] == OPERATION_READ));
    end
    if (step == STEP_PAYLOAD || step == STEP_CRC || step == STEP_ACK)
      if (verdict == VERDICT_OK) assert (is_read ? f_length != 8'd0 && f_length <= 8'd60 : f_header_fits && (!f_objection || (answer_came && answer != VERDICT_OK)));
    if (step == STEP_PAYLOAD) begin
      assert (f_has_payload);
      assert (f_words == {1'b0, index} + 9'd1 + {8'd0, f_busy});
      assert (f_checks + {8'd0, bus_check} == {1'b0, index});
      assert (index < length || (index == length && count == COUNT_ACT + 6'd1));
    end
    if (bus_check && f_words != 9'd0) assert ((count == COUNT_ACT + 6'd1 && step == STEP_PAYLOAD) || step == STEP_IDLE);
    if (step == STEP_CRC && f_has_payload) begin
      assert (f_words == {1'b0, length} + 9'd1 + {8'd0, f_busy} && index == length);
      assert (f_checks == {1'b0, length} && !bus_check);
    end
    if (step == STEP_ACK && verdict == VERDICT_OK) begin
      assert (f_words == {1'b0, f_length} + 9'd2 && !crc_wrong && !f_incomplete && f_checks == {1'b0, f_length} && !is_read);
      assert (f_busy && f_selected);
      assert (f_upper ? f_c > 7'd50 && f_gap < f_c - 7'd50 : f_gap == (f_c > 7'd50 ? 7'd60 : f_c + 7'd10));
    end
    if (step == STEP_ACK) assert (f_words != 9'd0);
    // the payload in its place
    if ((step == STEP_PAYLOAD || step == STEP_CRC || step == STEP_ACK) && f_length <= 8'd60 && !is_read
        && (step != STEP_ACK || verdict == VERDICT_OK)) begin
      if (f_words > {3'd0, f_watch} + 9'd1 && {2'd0, f_watch} < f_length) assert (f_memory_word == f_word);
      if (f_words == {3'd0, f_watch} + 9'd1 && f_upper && step == STEP_PAYLOAD) assert (f_memory_word[31:16] == f_word[31:16]);
      if (step == STEP_PAYLOAD && f_loaded && index == {2'd0, f_watch}) assert (f_held == f_word);
      if (step == STEP_PAYLOAD && count == COUNT_ACT + 6'd1 && index == {2'd0, f_watch} + 8'd1) assert (f_held == f_word);
    end
    // executing
    assert (!bus_write || step == STEP_REPLAY);
    if (step == STEP_REPLAY) begin
      assert (f_runs && f_run_length == length && length != 8'd0 && length <= 8'd60 && bus_push == f_run_push);
      assert (index <= length && f_written + {7'd0, bus_write} == index);
      assert (count >= COUNT_LOAD && count <= COUNT_LOADED);
      assert (bus_address == f_address + (f_run_push ? 12'd0 : {4'd0, f_written}));
      if (index == length) assert (count == COUNT_LOAD && bus_write);
      if (bus_write) assert (count == COUNT_LOAD);
      if ({2'd0, f_watch} < length) assert (f_memory_word == f_run_word);
      if (count == COUNT_LOADED && index == {2'd0, f_watch}) assert (f_held == f_run_word);
      if (bus_write && index == {2'd0, f_watch} + 8'd1) assert (f_held == f_run_word);
      if (f_words == 9'd0 && f_selected && f_upper) assert (f_memory_header[31:16] == f_header[31:16]);
      if (!frame_waits) assert (f_words != 9'd0 || !f_selected);
    end
    if (f_runs && step != STEP_REPLAY) assert (f_written == f_run_length);
  end
`endif
