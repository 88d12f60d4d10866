// SPDX-License-Identifier: MIT
// Promises of the watchdog; included at the end of passo_watchdog.v.

// --- Assumptions: a reset at the beginning; settings come in a frame, which feeds it; ticks are apart
reg f_started = 1'b0;
reg [1:0] f_since_tick = 2'd0;  // clocks, saturating
wire f_begun = ~rst;
always @(posedge clk) begin
  f_started    <= 1'b1;
  f_since_tick <= tick ? 2'd1 : f_since_tick == 2'd3 ? 2'd3 : f_since_tick + 2'd1;
  if (!f_started) watchdog_reset : assume (rst);
  if (write) watchdog_feeds : assume (feed);
  if (tick) watchdog_ticks_apart : assume (f_since_tick == 2'd3);
end

// --- Ticks since it was fed, and since it stopped a motion; not that of the clock after
reg [31:0] f_age = 32'd0;
reg [31:0] f_stopped = 32'd0;
reg f_new = 1'b1;
always @(posedge clk) begin
  f_new     <= feed | trips | rst;
  f_age     <= feed || rst ? 32'd0 : f_age[31] ? f_age : f_age + {31'd0, tick & ~f_new};
  f_stopped <= !stop || feed || rst ? 32'd0 : f_stopped[31] ? f_stopped : f_stopped + {31'd0, tick};
end
wire [31:0] f_stop_time = {22'd0, stop_after} << UNIT_LOG2;
wire [31:0] f_disable_time = {22'd0, disable_after} << UNIT_LOG2;
wire f_small = f_age < 32'h4000_0000 && f_stopped < 32'h4000_0000;

always @(posedge clk)
  if (f_begun && $past(f_begun) && f_small) begin
    if (stop && !$past(stop))
      not_before_its_time : assert ($past(f_age) >= $past(f_stop_time) && $past(tick && moving));
    if (stop) never_when_off : assert (stop_after != 10'd0);
    if ($past(moving && tick && !feed && f_age >= f_stop_time && stop_after != 10'd0))
      stops_a_motion_in_time : assert (stop);
    if (disable_drives && !$past(disable_drives))
      disables_after_the_stop : assert ($past(stop) && $past(f_stopped) >= $past(f_disable_time));
    if (disable_drives) only_if_wanted : assert (disable_after != 10'd0);
    if ($past(stop && tick && !feed && f_stopped >= f_disable_time && disable_after != 10'd0))
      disables_in_time : assert (disable_drives);
    if ($past(feed)) fed_is_calm : assert (!stop && !disable_drives);
  end

always @(posedge clk)
  if (f_started) begin
    times_as_written :
    assert ({disable_after, stop_after} == ($past(rst) ? 20'd0 : $past(write) ? $past(bus_data) : $past({disable_after, stop_after})));
  end

// --- What the induction relies on
wire [31:0] f_time = stop ? f_stopped : f_age;
wire [31:0] f_end = stop ? f_disable_time : f_stop_time;
always @(posedge clk)
  if (f_begun && $past(f_begun) && f_small) begin
    assert (f_new == $past(feed || trips));
    assert ({{(22 - UNIT_LOG2) {1'b0}}, count} == (f_time < f_end ? f_time : f_end));
    if (f_new) assert (holds && count == 0);
    else if (holds) assert (over && (stop ? disable_drives == (disable_after != 10'd0) : silent == (stop_after != 10'd0)));
    else if (over) assert (wanted != 10'd0 && f_since_tick == 2'd1);
    if (!f_new && wanted == 10'd0) assert (holds);
    if (silent && !stop) assert (over && holds && stop_after != 10'd0);
    if (stop) assert (silent && stop_after != 10'd0);
    if (disable_drives) assert (stop && over && holds && disable_after != 10'd0);
  end
