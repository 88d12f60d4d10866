// SPDX-License-Identifier: MIT
// Promises of the host interface of a bus; included at the end of passo_words.v. The only assumption about the
// master: a request is stable until it is done.

localparam [6:0] F_APART = 7'd63;
reg f_started = 1'b0;
wire f_begun = f_started && !rst;
wire f_access = request && !done;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) words_reset : assume (rst);
  if (f_begun && $past(f_access && !rst) && !done)
    words_request_stands :
    assume (request && $stable(write) && $stable(address) && $stable(lanes) && $stable(write_data));
end

// --- What the link sees, and what it relies on
reg       f_selected = 1'b0;
reg       f_upper = 1'b0;  // the upper half of a word has come
reg [6:0] f_gap = 7'd127;  // clocks since the last half-word or the start or end of a frame
always @(posedge clk)
  if (f_begun) begin
    if (frame_start) starts_apart : assert (!f_selected && !half_valid && !frame_end);
    if (frame_end) ends_once : assert (f_selected && !half_valid);
    if (half_valid) halves_in_a_frame : assert (f_selected);
    if (half_valid) halves_in_turn : assert (half_low == f_upper);
    if (half_valid || frame_start || frame_end) halves_apart : assert (f_gap >= F_APART);
    if (half_valid) f_upper <= !half_low;
    if (frame_start) {f_selected, f_upper} <= 2'b10;
    if (frame_end) f_selected <= 1'b0;
    f_gap <= half_valid || frame_start || frame_end ? 7'd0 : f_gap == 7'd127 ? f_gap : f_gap + 7'd1;
  end else begin
    {f_selected, f_upper} <= 2'b00;
    f_gap                 <= 7'd127;
  end

// --- What the master sees: an access is done within 128 clocks, once; an accepted word is passed on unchanged and is
// exchanged for the reply latched when the word before it had gone
reg  [ 7:0] f_waits = 8'd0;
reg         f_open = 1'b0;  // as the master wrote it
reg         f_goes = 1'b0;  // the halves of f_word are still to come
reg  [31:0] f_word;
reg  [31:0] f_reply;
reg         f_replied = 1'b0;
always @(posedge clk)
  if (f_begun) begin
    f_waits <= f_access ? f_waits + 8'd1 : 8'd0;
    done_in_time : assert (f_waits <= 8'd128);
    if (done) done_when_asked : assert ($past(request && !done));
    if (done) errors_told : assert (error == $past(write && (lanes != 4'hF || (address && !f_open))));
    if (done && $past(write && !address) && !error) f_open <= $past(write_data[0]);
    if (done && $past(write && address) && !error) begin
      word_by_word : assert (!f_goes);
      f_goes <= 1'b1;
      f_word <= $past(write_data);
    end
    if (half_valid) begin
      halves_of_the_word :
      assert (half == (half_low ? f_word[15:0] : done ? $past(write_data[31:16]) : f_word[31:16]));
      if (half_low) f_goes <= 1'b0;
    end
    if (half_valid && half_low) {f_replied, f_reply} <= {1'b1, reply_word};
    if (frame_start || frame_end) f_replied <= 1'b0;
    if (done && f_replied && $past(!write && address)) reply_exchanged : assert (read_data == f_reply);
    if (frame_start || frame_end) opened_and_closed : assert (frame_start == (done ? $past(write_data[0]) : f_open));
  end else begin
    f_waits              <= 8'd0;
    {f_open, f_goes}     <= 2'b00;
    f_replied            <= 1'b0;
  end

wire f_sending = sending && count >= 7'd2 && count <= 7'd65;  // the first half has gone
always @(posedge clk)
  if (f_begun) begin
    if (!done) assert (f_waits <= {1'b0, count} - 8'd1);
    assert (selected == (done && $past(write && !address) && !error ? $past(write_data[0]) : f_open));
    assert (f_selected == (begins && !sending ? !selected : selected));
    if (sending && count != 7'd0) assert (selected);
    assert (f_upper == f_sending && f_goes == f_sending);
    if (f_sending) assert (word == f_word);
    if (count >= 7'd2) assert (f_gap == (sending && count >= 7'd66 ? count - 7'd66 : count - 7'd2));
    else assert (f_gap >= 7'd62 + {6'd0, begins});
    if (f_replied) assert (reply == f_reply && (sending || count < 7'd2));
    if (begins) assert (done && $past(write) && !error);
    if (begins && sending) assert ($past(address) && word == $past(write_data));
    if (begins && !sending) assert ($past(!address));
    if (done && $past(write && address) && !error) assert (begins && sending);
    if (done && $past(write && !address) && !error) assert (count <= 7'd1);
  end
