// SPDX-License-Identifier: MIT
// Promises of the raster; included at the end of passo_raster.v.

// --- Assumptions: substeps are at least two clocks apart, also from the beginning of a line; no pitch is 0
reg f_started = 1'b0;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) raster_reset : assume (rst);
  if (f_started) raster_substeps_apart : assume (!(substep && $past(substep || line_begins)));
  raster_pitch_above_0 : assume (pitch != 30'd0);
end

// --- Substeps of the line so far, those since the last value, the pitch when it was taken
reg        f_new = 1'b0;  // no substep of the line yet
reg        f_taken = 1'b0;  // a value of this line
reg [29:0] f_since;
reg [29:0] f_pitch;
wire f_due = f_new || (f_taken && f_since == f_pitch);
always @(posedge clk) begin
  if (substep) begin
    f_new   <= 1'b0;
    f_since <= take ? 30'd1 : f_since + 30'd1;
  end
  if (take) begin
    f_taken <= 1'b1;
    f_pitch <= pitch;
  end
  if (line_begins) begin
    f_new   <= 1'b1;
    f_taken <= 1'b0;
  end
  if (rst || flush) begin
    f_new   <= 1'b0;
    f_taken <= 1'b0;
  end
end

// --- A line keeps its kind
reg f_raster = 1'b0;
always @(posedge clk) begin
  if (substep) f_raster <= raster;
  if (substep && !f_new) raster_line_keeps_its_kind : assume (raster == f_raster && (f_taken || !raster));
end

always @(posedge clk)
  if (f_started && !$past(rst || flush)) begin
    first_of_the_line : assert (first == f_new);
    takes_when_due : assert (take == (substep && raster && f_due));
    if ($past(take && !available)) missing_is_told : assert (missed);
    else not_missing_is_not : assert (!missed);
    if (!available) nothing_is_0 : assert (value == 8'd0);
  end

// --- A word is left with its last value, or with the beginning of a line
reg [1:0] f_index = 2'd0;  // values taken of the present word
always @(posedge clk) begin
  if (take && available) f_index <= f_index + 2'd1;
  if (line_begins || rst || flush) f_index <= 2'd0;
end
always @(posedge clk)
  if (f_started && !$past(rst || flush)) begin
    if (!$past(line_begins))
      word_left_after_four :
      assert (read_word == $past(read_word) + $past(take && available && f_index == 2'd3));
    else
      line_begins_a_word :
      assert (read_word == $past(read_word) + $past((take && available) || f_index != 2'd0));
  end

always @(posedge clk)
  if (f_started && !$past(rst || flush)) begin
    assert (index == f_index);
    if (f_taken) assert (f_since != 30'd0 && f_since <= f_pitch && left == f_pitch - f_since + 30'd1);
    if (!$past(substep)) assert (due == (left == 30'd1) || !f_taken);
    assert (!(f_new && f_taken));
    if (f_taken) assert (f_raster);
  end
