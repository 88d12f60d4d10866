// SPDX-License-Identifier: MIT
// Promises of the watchdog; included at the end of passo_watchdog.v.

// --- Assumptions: a reset at the beginning; settings come in a frame, which feeds it
reg f_started = 1'b0;
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started <= 1'b1;
  if (!f_started) watchdog_reset : assume (rst);
  if (write) watchdog_feeds : assume (feed);
end

// --- Clocks since it was fed, and since it stopped a motion
reg [31:0] f_age = 32'd0;
reg [31:0] f_stopped = 32'd0;
always @(posedge clk) begin
  f_age     <= fed || rst ? 32'd0 : f_age[31] ? f_age : f_age + 32'd1;
  f_stopped <= !stop || fed || rst ? 32'd0 : f_stopped[31] ? f_stopped : f_stopped + 32'd1;
end
wire [31:0] f_stop_time = {22'd0, stop_after} << UNIT_LOG2;
wire [31:0] f_disable_time = {22'd0, disable_after} << UNIT_LOG2;
wire f_small = f_age < 32'h4000_0000 && f_stopped < 32'h4000_0000;

always @(posedge clk)
  if (f_begun && $past(f_begun) && f_small) begin
    if (stop && !$past(stop)) not_before_its_time : assert ($past(f_age) >= $past(f_stop_time) && $past(moving));
    if (stop) never_when_off : assert (stop_after != 10'd0 || fed);
    if ($past(moving && !fed && f_age >= f_stop_time && stop_after != 10'd0))
      stops_a_motion_in_time : assert (stop);
    if (disable_drives && !$past(disable_drives))
      disables_after_the_stop : assert ($past(stop) && $past(f_stopped) >= $past(f_disable_time));
    if (disable_drives) only_if_wanted : assert (disable_after != 10'd0 || fed);
    if ($past(fed)) fed_is_calm : assert (!stop && !disable_drives);
  end

`ifdef INVARIANTS
wire [31:0] f_left = ({22'd0, count} << UNIT_LOG2) - {{(32 - UNIT_LOG2) {1'b0}}, unit};
always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    assert (unit_ends == &unit);
    if (!fed && !stop && f_age <= f_stop_time)
      assert (count != 10'd0 ? f_left == f_stop_time - f_age : f_age == f_stop_time);
    if (!fed && !stop && f_age > f_stop_time) assert (count == 10'd0);
    if (!fed && stop && f_stopped <= f_disable_time)
      assert (count != 10'd0 ? f_left == f_disable_time - f_stopped : f_stopped == f_disable_time);
    if (stop && !fed) assert (stop_after != 10'd0);
    if (stop && !fed && f_stopped > f_disable_time) assert (count == 10'd0);
    if (disable_drives && !fed) assert (stop);
  end
`endif
