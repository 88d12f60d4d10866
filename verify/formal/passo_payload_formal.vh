// SPDX-License-Identifier: MIT
// Promises of the payload buffer; included at the end of passo_payload.v.

// --- Assumptions: the link. A word rotates for 32 clocks or is abandoned; in the clock before, nothing is loaded or
// rotates and, if the word counts, `bit_index` is 31 and `count` already set.
reg       f_begun = 1'b0;
reg       f_rotate_q = 1'b0;
reg       f_load_q = 1'b0;
reg       f_fresh = 1'b0;  // loaded, and not yet rotated
reg       f_told = 1'b0;  // the word that rotates, or last rotated, was fresh
reg       f_whole = 1'b0;  // 32 rotations are over; nothing has been loaded since
reg [4:0] f_bit_index_q;
reg       f_count;
reg [1:0] f_counter;
wire      f_first = rotate & ~f_rotate_q;
always @(posedge clk) begin
  f_begun   <= 1'b1;
  f_rotate_q  <= rotate & f_begun;
  f_load_q  <= load & f_begun;
  f_bit_index_q <= bit_index;
  f_count   <= count;
  f_counter <= counter;
  f_fresh   <= f_begun & (load | (f_fresh & ~rotate));
  if (rotate)
    payload_rotates_whole :
    assume (!load && !f_load_q && bit_index == (f_first ? 5'd0 : f_bit_index_q + 5'd1) && (f_first || f_bit_index_q != 5'd31));
  if (rotate && (!f_first || count)) payload_counts_as_told : assume (count == f_count && counter == f_counter);
  if (f_first && count) payload_counts_after_31 : assume (f_bit_index_q == 5'd31);
  f_whole <= f_begun && ((rotate && bit_index == 5'd31) || (f_whole && !rotate && !load));
  if (f_first) f_told <= f_fresh;
end

// --- The word before its first rotation, and as it should be after the last
function [7:0] f_mirrored(input [7:0] byte_in);
  f_mirrored = {byte_in[0], byte_in[1], byte_in[2], byte_in[3], byte_in[4], byte_in[5], byte_in[6], byte_in[7]};
endfunction

reg  [31:0] f_before_q;
reg  [31:0] f_after_q;
wire [31:0] f_before = f_first ? data : f_before_q;
wire [ 7:0] f_old = f_before >> {counter, 3'd0};
wire [ 7:0] f_new = f_mirrored(f_mirrored(f_old) + 8'd1);
wire [31:0] f_after = count ? f_before ^ ({24'd0, f_old ^ f_new} << {counter, 3'd0}) : f_before;
wire [31:0] f_readable = {
  f_mirrored(f_before[31:24]), f_mirrored(f_before[23:16]), f_mirrored(f_before[15:8]), f_mirrored(f_before[7:0])
};
reg         f_counted;
always @(posedge clk) begin
  f_before_q <= f_before;
  if (rotate) begin
    f_after_q <= f_after;
    f_counted <= count;
    if (f_begun && !count) counters_readable : assert (counter_bit == f_readable[~bit_index]);
  end
  if (f_whole) begin
    if (!f_counted) rotation_keeps_the_word : assert (data == f_after_q);
    else one_counter_counts : assert (data == f_after_q);
    if (f_told) begin
      msb_told : assert (msb == 5'd0 ? f_before_w <= 32'd1 : f_before_w >> msb == 32'd1);
      one_hot_told : assert (one_hot == ((f_before_w & (f_before_w - 32'd1)) == 32'd0));
    end
  end
end

// the word that rotated last
reg  [31:0] f_before_w;
always @(posedge clk) if (rotate) f_before_w <= f_before;

// --- Any one half-word in the memory
(* anyconst *) reg [7:0] f_address;
(* keep *) wire [15:0] f_memory_word;
reg  [15:0] f_kept;  // as it was last stored
reg         f_stored = 1'b0;
reg         f_named = 1'b0;  // it was selected in the clock before
reg  [15:0] f_named_word;
reg         f_shown = 1'b0;  // two clocks before
reg  [15:0] f_shown_word;
reg         f_shown_q = 1'b0;  // and loaded
reg  [15:0] f_shown_word_q;
wire        f_put = put && {put_word, put_low} == f_address;
wire        f_store = store && !put && {store_word, store_low} == f_address;
always @(posedge clk) begin
  if (f_put) f_kept <= data[15:0];
  if (f_store) f_kept <= half;
  f_stored       <= f_begun & (f_stored | f_put | f_store);
  f_named        <= f_stored && {load_word, load_low} == f_address && !f_put && !f_store;
  f_named_word   <= f_kept;
  f_shown        <= f_named;
  f_shown_word   <= f_named_word;
  f_shown_q      <= f_shown & load & ~load_zero;
  f_shown_word_q <= f_shown_word;
  if (f_shown_q) loaded_as_stored : assert (data[15:0] == f_shown_word_q);
  if (f_begun && $past(f_begun && load && !load_zero)) upper_half_follows : assert (data[31:16] == $past(data[15:0]));
  if (f_begun && $past(f_begun && load && load_zero)) zero_loaded : assert (data == 32'd0);
end

wire [31:0] f_passed = ~(32'hFFFFFFFF >> bit_index);  // bits rotated so far
wire [31:0] f_mixed = (f_after & f_passed) | (f_before & ~f_passed);
wire [63:0] f_rotated = {f_mixed, f_mixed} << bit_index;
wire [31:0] f_seen = f_before & f_passed;
always @(posedge clk)
  if (f_begun) begin
    if (f_stored) assert (f_memory_word == f_kept);
    if (f_shown) assert (loaded == f_shown_word);
    if (f_fresh && !(rotate && !f_first)) assert (!some_bit && one_hot && msb == 5'd0);
    assert (!(f_fresh && (f_whole || (rotate && !f_first))));
    if (rotate) begin
      assert (data == f_rotated[63:32]);
      if (!f_first) assert (f_before_q == f_before_w);
      if (!f_first) assert (f_counted == count && f_after_q == f_after);
      if (in_counter) assert (carry == ((f_old | (8'hFF >> bit_index[2:0])) == 8'hFF));
      if (!f_first && f_told) begin
        assert (some_bit == (f_seen != 32'd0));
        assert (msb == 5'd0 ? f_seen <= 32'd1 : f_seen >> msb == 32'd1);
        assert (one_hot == ((f_seen & (f_seen - 32'd1)) == 32'd0));
      end
    end
  end
