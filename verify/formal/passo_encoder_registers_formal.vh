// SPDX-License-Identifier: MIT
// Promises of the registers of the encoders; included at the end of passo_encoder_registers.v.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
wire f_access = bus_write | bus_read;
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) encoder_registers_reset : assume (rst);
  if (f_access) registers_address_stands : assume (f_started && $stable(bus_address) && $stable(select));
end

// --- Which register an access means
reg [AXES-1:0] f_at_setup, f_at_ratio, f_at_limit, f_at_error, f_at_greatest, f_at_index;
integer f_axis;
always @* begin
  for (f_axis = 0; f_axis < AXES; f_axis = f_axis + 1) begin
    f_at_setup[f_axis]    = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE;
    f_at_ratio[f_axis]    = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE + 8'd1;
    f_at_limit[f_axis]    = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE + 8'd2;
    f_at_error[f_axis]    = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE + 8'd3;
    f_at_greatest[f_axis] = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE + 8'd4;
    f_at_index[f_axis]    = select && bus_address == CHANNEL_ENCODER_BASE + f_axis[7:0] * CHANNEL_ENCODER_STRIDE + 8'd5;
  end
end
wire f_at_position = select && bus_address >= CHANNEL_ENCODER_POSITION_BASE
                     && bus_address < CHANNEL_ENCODER_POSITION_BASE + AXES[7:0];
wire [AXES-1:0] f_write = {AXES{bus_write}};
wire [AXES-1:0] f_read = {AXES{bus_read}};

// --- The settings as the host wrote them
reg f_set_follow, f_set_limit, f_set_filter;
always @(posedge clk) begin
  f_set_follow <= ~rst & bus_write & select & bus_address == CHANNEL_FOLLOW;
  f_set_limit  <= ~rst & bus_write & select & bus_address == CHANNEL_FOLLOW_LIMIT;
  f_set_filter <= ~rst & bus_write & select & bus_address == CHANNEL_ENCODER_FILTER;
end
wire [7:0] f_follow = {scale, source, wait_index, follow};

always @(posedge clk)
  if (f_ran) begin
    setup_is_written : assert (write_setup == $past(f_write & f_at_setup));
    ratio_is_written : assert (write_ratio == $past(f_write & f_at_ratio));
    limit_is_written : assert (write_limit == $past(f_write & f_at_limit));
    error_is_read : assert (read_error == $past(f_read & f_at_error));
    greatest_is_read : assert (read_greatest == $past(f_read & f_at_greatest));
    index_is_read : assert (read_index == $past(f_read & f_at_index));
    position_is_read : assert (read_position == $past(bus_read && f_at_position));
    follow_is_read : assert (read_follow == $past(bus_read && select && bus_address == CHANNEL_FOLLOW_STATE));
    follow_is_kept : assert (f_follow == ($past(f_set_follow) ? $past(bus_data[7:0]) : $past(f_follow)));
    follow_limit_is_kept : assert (follow_limit == ($past(f_set_limit) ? $past(bus_data) : $past(follow_limit)));
    filter_is_kept : assert (filter == ($past(f_set_filter) ? $past(bus_data[7:0]) : $past(filter)));
  end else if (f_started) begin
    reset_strobes :
    assert (!write_setup && !write_ratio && !write_limit && !read_error && !read_greatest && !read_index
            && !read_position && !read_follow);
    reset_settings :
    assert (f_follow == 8'd0 && follow_limit == CHANNEL_FOLLOW_LIMIT_LIMIT_RESET
            && filter == CHANNEL_ENCODER_FILTER_FILTER_RESET);
  end

// --- What the induction relies on
always @(posedge clk) begin
  assert (f_set_follow == write_follow || !f_started);
  assert (f_set_limit == write_follow_limit || !f_started);
  assert (f_set_filter == write_filter || !f_started);
end
