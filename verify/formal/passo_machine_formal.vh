// SPDX-License-Identifier: MIT
// Promises of what all channels of a machine share; included at the end of passo_machine.v. The e-stop may do
// anything, the watchdog gives back what comes in (passo_watchdog_model.v).

reg f_started = 1'b0;
reg f_ran = 1'b0;  // no reset in the clock before
always @(posedge clk) begin
  f_started <= 1'b1;
  f_ran     <= f_started & ~rst;
  if (!f_started) machine_reset : assume (rst);
  if (bus_write || bus_read) registers_address_stands : assume (f_started && $stable(bus_address));
end

wire f_sets = bus_write && bus_address == ADDRESS_INPUT_FILTER;
reg [15:0] f_since = 16'd0;  // clocks since the filter began its period
reg f_due = 1'b0;
always @(posedge clk) begin
  f_due   <= f_started && !rst && !f_sets && f_since == filter;
  f_since <= rst || f_sets || f_since == filter ? 16'd0 : f_since + 16'd1;
end

// the model gives back the parity
always @* begin
  watchdog_takes_each_bit : assert (watchdog_stop == ^{write_watchdog, bus_data});
  watchdog_sees_the_motion : assert (disable_drives == ^{slew_tick, bus_write | bus_read, moving});
end

always @(posedge clk) begin
  if (f_started) tick_is_due : assert (tick == f_due);
  if (f_ran) begin
    filter_is_kept : assert (filter == ($past(f_sets) ? $past(bus_data[15:0]) : $past(filter)));
    if (bus_write) tells_a_new_filter : assert (write_filter == f_sets);
    if (bus_write) writes_the_watchdog : assert (write_watchdog == (bus_address == ADDRESS_WATCHDOG));
    if (bus_write) clears_the_estop : assert (write_clear == (bus_address == ADDRESS_ESTOP_CLEAR && bus_data[0]));
    if (!bus_write) writes_nothing : assert (!write_filter && !write_watchdog && !write_clear);
    estop_is_read :
    assert (read_data == {31'd0, estop & $past(bus_read && bus_address == ADDRESS_ESTOP)});
  end else if (f_started) filter_outlives_a_reset : assert (filter == $past(filter));
end

// --- What the induction relies on
always @(posedge clk) if (f_started) begin
  assert (begins ? f_since == 16'd0 && !f_due : f_since == (count == 16'd0 ? 16'd0 : filter + 16'd1 - count));
  assert (f_since <= filter && (begins || (count <= filter && f_due == (f_since == 16'd0))));
end
