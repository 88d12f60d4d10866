// SPDX-License-Identifier: MIT
// Promises of the encoder of an axis; included at the end of passo_encoder_axis.v. Encoder and following error may do
// anything.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) encoder_axis_reset : assume (rst);
end

// --- What the host reads, in counts and revolutions since `zero`
reg [15:0] f_count = 16'd0;
reg [15:0] f_latch = 16'd0;
reg [ 7:0] f_indexes = 8'd0;
reg        f_indexed = 1'b0;  // an index in the clock before
always @(posedge clk) begin
  f_indexed <= index_event;
  if (count_made) f_count <= count_down ? f_count - 16'd1 : f_count + 16'd1;
  if (f_indexed) begin
    f_latch   <= f_count;
    f_indexes <= f_indexes + 8'd1;
  end
  if (rst || zero) begin
    {f_count, f_latch, f_indexes} <= 40'd0;
    f_indexed                     <= 1'b0;
  end
end

wire [4:0] f_setup = {stops_hard, stops_soft, index_gated, index_inverted, inverted};
always @(posedge clk) begin
  if (f_started) begin
    if (!read_error && !read_greatest && !read_index) reads_nothing : assert (read_data == 32'd0);
    if (read_error && !read_greatest && !read_index)
      reads_error : assert ($signed(read_data) == $signed(error) >>> 8);
    if (read_greatest && !read_error && !read_index)
      reads_greatest : assert (read_data == {exceeded, 13'd0, greatest});
    if (read_index && !read_error && !read_greatest)
      reads_index : assert (read_data == {illegal, f_indexes, f_latch});
    stops_softly : assert (stop_soft == (exceeded && f_setup[3]));
    stops_hardly : assert (stop_hard == (exceeded && f_setup[4]));
  end
  if (f_ran) begin
    setup_is_kept : assert (f_setup == ($past(write_setup) ? $past(bus_data[4:0]) : $past(f_setup)));
    ratio_is_kept : assert (ratio == ($past(write_ratio) ? $past(bus_data) : $past(ratio)));
    limit_is_kept : assert (limit == ($past(write_limit) ? $past(bus_data[15:0]) : $past(limit)));
  end else if (f_started)
    reset_settings : assert (f_setup == 5'd0 && ratio == ENCODER_RATIO_RESET && limit == ENCODER_LIMIT_RESET);
end

// --- What the induction relies on
always @(posedge clk)
  if (f_started) begin
    assert (count == f_count && latch == f_latch && indexes == f_indexes);
    assert (index_event_q == f_indexed);
  end
