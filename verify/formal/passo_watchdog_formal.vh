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
    if ($past(moving && !fed && f_age > f_stop_time && stop_after != 10'd0))
      stops_a_motion_in_time : assert (stop);
    if (disable_drives && !$past(disable_drives))
      disables_after_the_stop : assert ($past(stop) && $past(f_stopped) >= $past(f_disable_time));
    if (disable_drives) only_if_wanted : assert (disable_after != 10'd0 || fed);
    if ($past(fed)) fed_is_calm : assert (!stop && !disable_drives);
  end

wire [UNIT_LOG2+9:0] f_time = stop ? f_stopped[UNIT_LOG2+9:0] : f_age[UNIT_LOG2+9:0];
always @(posedge clk)
  if (f_begun && $past(f_begun)) begin
    assert (stops == (stop_after != 10'd0) && disables == (disable_after != 10'd0));
    if (!fed && f_small) assert ({count, unit} == f_time);
    if (!fed && !stop && f_age > f_stop_time) assert (silent == stops);
    if (!fed && silent) assert (stops && f_age > f_stop_time);
    if (stop && !fed) assert (silent);
    if (disable_drives && !fed) assert (stop);
  end
