// SPDX-License-Identifier: MIT
// Promises of the registers of the core; included at the end of passo_registers.v.

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) registers_reset : assume (rst);
  if (bus_write || bus_read) registers_address_stands : assume (f_started && $stable(bus_address));
end

// --- What the host has written to RUN, and what it reads
wire [7:0] f_run = {{(8 - CHANNELS) {1'b0}}, run};
wire [7:0] f_wait_sync = {{(8 - CHANNELS) {1'b0}}, wait_sync};
wire [7:0] f_others = 8'hFF << CHANNELS;  // channels that are not present
wire       f_bad = (bus_data[7:0] & f_others) != 8'd0 || (bus_data[15:8] & f_others) != 8'd0
                   || bus_data[18:16] >= CHANNELS;
reg  [8:0] f_line_room;
reg  [8:0] f_ramp_room;
integer f_channel;
always @* begin
  {f_line_room, f_ramp_room} = 18'd0;
  for (f_channel = 0; f_channel < CHANNELS; f_channel = f_channel + 1)
    if (status_channel == f_channel) begin
      f_line_room = line_room[f_channel*(LINE_QUEUE_LOG2+1)+:LINE_QUEUE_LOG2+1];
      f_ramp_room = ramp_room[f_channel*(RAMP_QUEUE_LOG2+1)+:RAMP_QUEUE_LOG2+1];
    end
end
wire [31:0] f_status = {
  2'd2, any_stopped, any_occupied, 1'b0, status_channel, last_sequence,
  f_line_room > 9'd255 ? 8'd255 : f_line_room[7:0],
  f_ramp_room > 9'd255 ? 8'd255 : f_ramp_room[7:0]
};
reg [31:0] f_word;
always @*
  case (bus_address)
    ADDRESS_IDENTIFICATION: f_word = "PASO";
    ADDRESS_VERSION: f_word = {8'd0, VERSION_MAJOR_RESET, VERSION_MINOR_RESET, VERSION_PATCH_RESET};
    ADDRESS_PARAMETERS: f_word = PARAMETERS;
    ADDRESS_CLOCK: f_word = CLOCK_HZ;
    ADDRESS_BUILD: f_word = BUILD;
    ADDRESS_RUN: f_word = {13'd0, status_channel, f_wait_sync, f_run};
    default: f_word = 32'd0;
  endcase

wire [2*CHANNELS+2:0] f_kept = {status_channel, wait_sync, run};
always @(posedge clk)
  if (f_ran) begin
    if (!$past(bus_read)) status_without_asking : assert (read_data == f_status);
    if ($past(bus_read) && !$past(bus_write) && $stable(bus_address))
      register_is_read : assert (read_data == f_word);
    if ($stable(bus_address)) begin
      refuses_other_channels : assert (!$stable(bus_data) || bad_value == (bus_address == ADDRESS_RUN && f_bad));
      counters_are_known :
      assert (is_counters == (bus_address == ADDRESS_REFUSALS_0 || bus_address == ADDRESS_REFUSALS_1));
    end
    run_is_kept :
    assert (f_kept == ($past(bus_write && bus_address == ADDRESS_RUN)
      ? {$past(bus_data[18:16]), $past(bus_data[8+:CHANNELS]), $past(bus_data[CHANNELS-1:0])} : $past(f_kept)));
  end else if (f_started) reset_run : assert (f_kept == {2 * CHANNELS + 3{1'b0}});

// --- What the induction relies on
always @(posedge clk)
  if (f_ran) begin
    assert (is_run == ($past(bus_address) == ADDRESS_RUN));
    assert (is_counters == ($past(bus_address[11:1]) == ADDRESS_REFUSALS_0[11:1]));
    assert (known == ($past(bus_address) <= ADDRESS_BUILD));
  end
